//! `lamma clean`: what only a later process can remove.

use crate::error::Failure;
use crate::exit;

/// Removes the shared memory of runs whose launcher is gone.
pub fn clean() -> Result<u8, Failure> {
    let removed = lamma_bus::iceoryx::sweep_stale().map_err(Failure::fault)?;
    match removed.len() {
        0 => println!("nothing to clean"),
        n => println!(
            "removed what {n} crashed run{} left: {}",
            if n == 1 { "" } else { "s" },
            removed.join(", ")
        ),
    }
    Ok(exit::SUCCESS)
}
