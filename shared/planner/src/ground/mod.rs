//! Grounding: from a lifted task to a finite-domain one.
//!
//! The stages, each a file: the rules' fixpoint without deletes ([`reach`], over [`relation`] and [`join`]),
//! its instances as propositional operators ([`instantiate`], [`quantified`]), the removal of what is
//! constant or irrelevant ([`simplify`]), mutex groups ([`invariant`]) and finite-domain packing ([`encode`]).

mod bounds;
mod encode;
mod inline;
mod instantiate;
mod invariant;
mod join;
mod layers;
mod numbers;
mod propositional;
mod quantified;
mod reach;
mod relation;
mod simplify;

use lamma_pddl::ast::{Domain, Problem};

use crate::lifted;
use crate::task::Task;

/// How large a grounded task may become.
#[derive(Clone, Debug)]
pub struct GroundLimits {
    /// Reachable facts.
    pub facts: usize,
    /// Reachable instances of actions, conditional effects and axioms.
    pub instances: usize,
    /// Steps of joining facts, a measure of time that is the same on every machine.
    pub steps: u64,
}

impl Default for GroundLimits {
    fn default() -> Self {
        GroundLimits { facts: 20_000_000, instances: 20_000_000, steps: 20_000_000_000 }
    }
}

/// Why a task could not be grounded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GroundError {
    /// The task contradicts itself: an undeclared object, a wrong number of arguments, an unknown variable.
    #[error("{0}")]
    Malformed(String),
    /// The task uses a part of PDDL that the planner does not search with.
    #[error("{0}")]
    Unsupported(String),
    /// A limit was reached.
    #[error("grounding needs more than {limit} {what}; use fewer objects or raise the limit")]
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// The limit.
        limit: u64,
    },
}

/// Grounds a task. A goal that can never hold is not an error: the task then says so
/// ([`Task::impossible`]).
pub fn ground(domain: &Domain, problem: &Problem, limits: &GroundLimits) -> Result<Task, GroundError> {
    let lifted = lifted::lift(domain, problem)?;
    let reached = reach::reach(&lifted, limits)?;
    let mut ground = instantiate::instantiate(&lifted, &reached, limits)?;
    simplify::simplify(&mut ground);
    let possible = ground.impossible.is_empty();
    let groups = if possible { invariant::mutex_groups(&ground, &reached.relations) } else { Vec::new() };
    encode::encode(lifted, &reached.relations, ground, &groups)
}
