//! Grounding, heuristics, search, validation and partial-order plans for PDDL tasks.

pub mod interpreter;
mod csr;
pub mod ground;
pub mod heuristic;
mod id_table;
mod lifted;
pub mod partial_order;
pub mod plan;
pub mod search;
mod successor;
pub mod task;

pub use interpreter::{GroundAction, GroundCondition, GroundEffect, Interpreter, WorldState};
pub use ground::{GroundError, GroundLimits, ground};
pub use plan::{GroundAct, Literal, Plan};
pub use search::{
    GaveUp, Limits, Outcome, SearchOptions, Unsolvable, hmax_unit, plan, relaxed_plan_cost, solve,
};
pub use task::{FactId, OperatorId, State, Task};
