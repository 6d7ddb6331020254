//! Grounding, heuristics, search, validation and partial-order plans for PDDL tasks.

pub mod interpreter;
pub mod plan;
pub mod validate;

pub use interpreter::{GroundAction, GroundCondition, GroundEffect, Interpreter, WorldState};
pub use plan::{GroundAct, Literal, Plan};
pub use validate::{Verdict, read_plan, validate, write_plan};
