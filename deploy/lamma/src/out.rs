//! Standard output that may be closed: `lamma list | head` is no fault.

use std::fmt::Display;
use std::io::Write;

/// Prints a line. A reader that has gone has seen what it wanted.
pub fn say(line: impl Display) {
    let _ = writeln!(anstream::stdout(), "{line}");
}
