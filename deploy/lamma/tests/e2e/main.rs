//! The command as a person uses it: real processes over shared memory, right and wrong input, kills.

mod bad_input;
mod faults;
mod planner;
mod runs;
mod tools;
