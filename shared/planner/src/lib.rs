//! Grounding, heuristics, search, validation and partial-order plans for PDDL tasks.

mod csr;
mod explain;
pub mod ground;
pub mod heuristic;
mod id_table;
pub mod interpreter;
mod lifted;
pub mod makespan;
mod numeric;
pub mod partial_order;
pub mod plan;
mod sas;
pub mod search;
mod successor;
pub mod task;
pub mod travel;
pub mod validate;

pub use explain::explain_unreachable;
pub use ground::{GroundError, GroundLimits, ground};
pub use interpreter::{GroundAction, GroundCondition, GroundEffect, Interpreter, WorldState};
pub use makespan::{Makespan, MakespanLimits, Milestone, Need, Schedule, Scheduler, all_before};
pub use plan::{GroundAct, Literal, Plan};
pub use sas::write_sas;
pub use search::{
    Anytime, Countdown, Engine, GaveUp, Limits, Outcome, SearchOptions, Unsolvable, hmax_unit,
    never_together, plan, plan_with, relaxed_plan_cost, solve, solve_anytime,
};
pub use task::{FactId, OperatorId, State, Task};
pub use travel::Travel;
pub use validate::{Verdict, read_plan, validate, write_plan};
