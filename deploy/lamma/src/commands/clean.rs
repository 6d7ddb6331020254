//! `lamma clean`: what only a later process can remove.

use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// Removes the shared memory of runs whose launcher is gone.
pub fn clean() -> Result<u8, Failure> {
    let removed = lamma_bus::iceoryx::sweep_stale().map_err(Failure::fault)?;
    match removed.len() {
        0 => say("nothing to clean"),
        1 => say(format_args!("removed what a crashed run has left: {}", removed.join(", "))),
        n => say(format_args!("removed what {n} crashed runs have left: {}", removed.join(", "))),
    }
    Ok(exit::SUCCESS)
}
