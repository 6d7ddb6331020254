//! Ways from an instruction to a plan: the paper's method, what it is without one of its modules, and the methods it
//! is compared with.
//!
//! The modules are those of the paper's ablation: the Precondition identifier and the PDDL Validator are about what a
//! language model is told and whether its answers are checked, so that part of them lives with the model
//! (`lamma_lm::Options`); the problem Generator and the Decomposition are here.

use serde::{Deserialize, Serialize};

/// A way to a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Method {
    /// Whether the instruction is divided into sub-tasks that may be done side by side. If not, it is one task, given
    /// to one robot if there is one that can do it.
    pub divide: bool,
    /// Who writes the robots' steps.
    pub steps: Steps,
    /// Whether steps that a model has written are checked on the plain semantics, and sent back, before they are
    /// carried out.
    pub checked: bool,
}

/// Who writes the robots' steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Steps {
    /// Each robot's planner, from a PDDL problem.
    Planned,
    /// The language model, for sub-tasks that the allocator has given out.
    WrittenForAllocation,
    /// The language model, for sub-tasks that it has given out itself.
    WrittenForAdvice,
    /// The language model, for the instruction as it is.
    Written,
}

impl Default for Method {
    fn default() -> Self {
        Method { divide: true, steps: Steps::Planned, checked: true }
    }
}
