//! Heuristics and what they promise.

mod bucket_queue;
mod graph;
mod landmark;
mod landmark_sets;
mod lmcut;
mod numeric;
mod relaxation;

pub(crate) use graph::Graph;
pub(crate) use landmark::{LandmarkGraph, Status};
pub use lmcut::LandmarkCut;
pub use relaxation::{Costs, Relaxation};

use crate::task::OperatorId;

/// What a heuristic promises; property tests hold it to this.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Properties {
    /// Never more than the true cost.
    pub admissible: bool,
    /// Never falls by more than the cost of an operator.
    pub consistent: bool,
    /// Calls a state a dead end only if it is one.
    pub safe: bool,
}

/// An estimate for one state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Estimate {
    /// So far to the goal.
    Cost(u32),
    /// The goal cannot be reached.
    DeadEnd,
}

/// Estimates how far a state is from the goal.
pub trait Heuristic {
    /// What the estimates promise.
    fn properties(&self) -> Properties;
    /// The estimate for a packed state. Operators that look promising are added to `preferred`.
    fn estimate(&mut self, state: &[u64], preferred: &mut Vec<OperatorId>) -> Estimate;
    /// What is known without looking, from estimating the last state, of the state that `operator` leads to
    /// from there: the goal is at least so far. Only admissible heuristics say more than zero.
    fn bound_after(&self, _operator: OperatorId) -> u32 {
        0
    }
    /// What was found out about the last state, for [`Heuristic::estimate_after`]; empty: nothing worth keeping.
    fn findings(&self) -> &[u32] {
        &[]
    }
    /// The estimate for the state that `operator` leads to from one with these findings.
    fn estimate_after(
        &mut self,
        state: &[u64],
        _findings: &[u32],
        _operator: OperatorId,
        preferred: &mut Vec<OperatorId>,
    ) -> Estimate {
        self.estimate(state, preferred)
    }
}

/// Zero everywhere: A* with it is uniform-cost search.
#[derive(Clone, Copy, Debug, Default)]
pub struct Blind;

impl Heuristic for Blind {
    fn properties(&self) -> Properties {
        Properties { admissible: true, consistent: true, safe: true }
    }

    fn estimate(&mut self, _state: &[u64], _preferred: &mut Vec<OperatorId>) -> Estimate {
        Estimate::Cost(0)
    }
}
