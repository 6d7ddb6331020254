//! Exit codes, as the contract lists them.

use lamma_coordinator::result::OutcomeKind;

/// Goal reached, plan found, plan valid.
pub const SUCCESS: u8 = 0;
/// Finished, but not so.
pub const NOT_REACHED: u8 = 1;
/// Proved infeasible or unsolvable.
pub const INFEASIBLE: u8 = 10;
/// Gave up without a proof.
pub const GAVE_UP: u8 = 11;
/// Needs clarification.
pub const CLARIFY: u8 = 12;
/// Bad input.
pub const BAD_INPUT: u8 = 20;
/// A fault in the software or the host.
pub const FAULT: u8 = 30;

/// The code of a benchmark: of whether a task could not be run or its plan was wrong, and whether the user ended it.
pub fn of_batch(broken: bool, interrupted: bool) -> u8 {
    match broken {
        true => FAULT,
        false if interrupted => GAVE_UP,
        false => SUCCESS,
    }
}

/// The code of an outcome.
pub fn of(outcome: OutcomeKind) -> u8 {
    match outcome {
        OutcomeKind::Success => SUCCESS,
        OutcomeKind::GoalNotReached => NOT_REACHED,
        OutcomeKind::Infeasible => INFEASIBLE,
        OutcomeKind::GaveUp => GAVE_UP,
        OutcomeKind::NeedsClarification => CLARIFY,
        OutcomeKind::Error => FAULT,
    }
}
