//! Searching for plans.

mod greedy;
mod improve;
mod limits;
mod open_list;
mod registry;

use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Domain, Problem};

pub use limits::{GaveUp, Limits, Outcome, Unsolvable};

use crate::ground::{GroundError, GroundLimits, ground};
use crate::heuristic::{Costs, Relaxation};
use crate::successor::Successors;
use crate::task::Task;
use limits::Meter;

/// How to search.
#[derive(Clone, Debug)]
pub struct SearchOptions {
    /// Expansions spent on making the first plan better. Zero: only useless actions are dropped.
    pub improvement_expansions: u64,
}

impl Default for SearchOptions {
    fn default() -> Self {
        SearchOptions { improvement_expansions: 2_000 }
    }
}

/// Searches for a plan.
pub fn solve(task: &Task, options: &SearchOptions, limits: &Limits, cancel: &AtomicBool) -> Outcome {
    if !task.impossible.is_empty() {
        return Outcome::Unsolvable(Unsolvable::Unreachable(task.impossible.clone()));
    }
    let mut relaxation = Relaxation::new(task, Costs::PlusOne);
    let unreachable = relaxation.unreachable_goals(&task.init);
    if !unreachable.is_empty() {
        let facts = unreachable.into_iter().map(|fact| task.fact_text(fact)).collect();
        return Outcome::Unsolvable(Unsolvable::Unreachable(facts));
    }
    let successors = Successors::new(task);
    let mut meter = Meter::new(limits, cancel);
    match greedy::lazy_greedy(task, &successors, &mut relaxation, &mut meter) {
        Err(reason) => Outcome::GaveUp(reason),
        Ok(None) => Outcome::Unsolvable(Unsolvable::Exhausted),
        Ok(Some(path)) => {
            let effort = options.improvement_expansions;
            let path = improve::improve(task, &successors, &mut relaxation, path, effort, &mut meter);
            Outcome::Found(task.plan(&path))
        }
    }
}

/// Grounds a task and searches with the default options.
pub fn plan(
    domain: &Domain,
    problem: &Problem,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Result<Outcome, GroundError> {
    let task = ground(domain, problem, &GroundLimits::default())?;
    Ok(solve(&task, &SearchOptions::default(), limits, cancel))
}

/// h_FF of the initial state with every action at cost one: how many actions a relaxed plan has. `None` if
/// the goal is out of reach.
pub fn relaxed_plan_cost(task: &Task) -> Option<u32> {
    if !task.impossible.is_empty() {
        return None;
    }
    Relaxation::new(task, Costs::Unit).hff(&task.init, &mut Vec::new())
}

/// h_max of the initial state with every action at cost one: no schedule of the task takes fewer steps.
/// `None` if the goal is out of reach.
pub fn hmax_unit(task: &Task) -> Option<u32> {
    if !task.impossible.is_empty() {
        return None;
    }
    Relaxation::new(task, Costs::Unit).hmax(&task.init)
}
