//! Grounding, heuristics, search, validation and partial-order plans for PDDL tasks.

pub mod plan;

pub use plan::{GroundAct, Literal, Plan};
