//! The command as a person uses it: real processes over shared memory, right and wrong input, kills.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

mod bad_input;
mod bench;
mod faults;
mod methods;
mod planner;
mod runs;
mod scale;
mod team_tasks;
mod tools;
#[cfg(feature = "zenoh")]
mod zenoh;
