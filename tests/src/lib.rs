//! The deterministic testbed, and the tests that need the whole workspace.

pub mod checker;
pub mod faults;
pub mod house;
pub mod rng;
pub mod scenario;
pub mod testbed;
