//! Grounding, heuristics, search, validation and partial-order plans for PDDL tasks.

pub mod interpreter;
pub mod plan;

pub use interpreter::{GroundAction, GroundCondition, GroundEffect, Interpreter, WorldState};
pub use plan::{GroundAct, Literal, Plan};
