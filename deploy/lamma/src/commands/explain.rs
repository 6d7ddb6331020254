//! `lamma explain`: what a diagnostic code means.

use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// Prints the paragraph for a code.
pub fn explain(code: &str) -> Result<u8, Failure> {
    match lamma_pddl::explain(code) {
        Some(text) => {
            say(format_args!("{text}"));
            Ok(exit::SUCCESS)
        }
        None => Err(Failure::bad_input(format!(
            "no diagnostic has the code {code:?}; codes look like pddl::unknown-predicate and stand in brackets after a message"
        ))),
    }
}
