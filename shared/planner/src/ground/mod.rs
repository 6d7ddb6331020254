//! Grounding: from a lifted task to a finite-domain one.
//!
//! The stages, each a file: what can matter for the goal ([`relevance`]), the rules' fixpoint without deletes
//! ([`reach`], over [`relation`] and [`join`]), its instances as propositional operators ([`instantiate`], [`quantified`]), the removal of what is
//! constant or irrelevant ([`simplify`]), mutex groups ([`invariant`]) and finite-domain packing ([`encode`]).

mod bounds;
mod encode;
mod inline;
mod instantiate;
mod invariant;
mod join;
mod layers;
mod limits;
mod needed;
mod numbers;
mod patterns;
mod propositional;
mod quantified;
mod reach;
mod relation;
mod relevance;
mod simplify;

use lamma_pddl::ast::{Domain, Problem};

pub use limits::GroundLimits;

use invariant::Groups;

use crate::lifted;
use crate::search::GaveUp;
use crate::task::Task;

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
    /// The caller's time or memory is used up, or the caller cancelled.
    #[error("grounding stopped: {0}")]
    GaveUp(GaveUp),
}

/// Grounds a task. A goal that can never hold is not an error: the task then says so
/// ([`Task::impossible`]).
pub fn ground(domain: &Domain, problem: &Problem, limits: &GroundLimits<'_>) -> Result<Task, GroundError> {
    let lifted = lifted::lift(domain, problem)?;
    let filters = relevance::filters(&lifted);
    let reached = reach::reach(&lifted, &filters, limits)?;
    let mut ground = instantiate::instantiate(&lifted, &reached, limits)?;
    simplify::simplify(&mut ground);
    limits.check_time()?;
    let possible = ground.impossible.is_empty();
    let groups = if possible {
        invariant::mutex_groups(&ground, &reached.relations, limits)?
    } else {
        Groups::default()
    };
    encode::encode(lifted, &reached.relations, ground, &groups, limits)
}
