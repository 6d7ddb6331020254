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

use std::path::Path;

use lamma_pddl::Source;

use crate::error::Failure;

/// A file the user named, as PDDL source.
pub fn read_source(path: &Path) -> Result<Source, Failure> {
    Source::read(path).map_err(|e| Failure::unreadable(path, &e))
}
