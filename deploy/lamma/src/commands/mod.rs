//! One module per command.

pub mod bench;
pub mod clean;
pub mod codmap;
pub mod explain;
pub mod host;
pub mod list;
pub mod new;
pub mod pddl_task;
pub mod plan;
pub mod prepare;
pub mod router;
pub mod run;
pub mod scale;
pub mod validate;

use std::io::Read;
use std::path::Path;

use lamma_pddl::Source;

use crate::error::Failure;

/// A file the user named, as PDDL source.
pub fn read_source(path: &Path) -> Result<Source, Failure> {
    // One byte more than can be read is enough to say that it is too much.
    let limit = lamma_pddl::source::MAX_SOURCE_BYTES as u64 + 1;
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(limit).read_to_end(&mut bytes))
        .map_err(|e| Failure::unreadable(path, &e))?;
    // A stray byte in a comment is no reason to refuse a file.
    let text = String::from_utf8_lossy(&bytes).into_owned();
    Ok(Source::new(path.display().to_string(), text))
}
