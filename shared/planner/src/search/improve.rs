//! Making a plan better within a bounded effort.

use std::rc::Rc;

use super::limits::Meter;
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use super::windows::Windows;
use crate::heuristic::{Costs, Graph, Relaxation};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// What grounding and preparing take for each part of the relaxed task, and what a unit of the search's work takes,
/// in nanoseconds.
const PREPARATION: u64 = 200;
const WORK: u64 = 2;

/// What searching again for the whole plan may take, in parts of the relaxed task looked at, and what is counted for each
/// state besides. It finds the best plan of a small task and is next to nothing for a large one.
const AGAIN: u64 = 200_000;
const STATE: u64 = 1_000;

/// One part in so many of what everything took may be spent on top.
const SHARE: u64 = 2;

/// How much may be done to make a plan better.
pub(super) enum Effort {
    /// So many states are estimated.
    States(u64),
    /// A share of what everything took so far, where the search took so much work.
    Share(u64),
}

/// Makes plans better.
pub(super) struct Improver<'a, 't> {
    pub task: &'t Task,
    pub graph: &'a Rc<Graph>,
    pub successors: &'a Successors,
}

impl<'t> Improver<'_, 't> {
    /// The plan, or a better one.
    pub fn improve(&self, plan: Vec<OperatorId>, effort: Effort, meter: &mut Meter<'_>) -> Vec<OperatorId> {
        let best = eliminate(self.task, plan);
        match effort {
            Effort::States(states) => self.search_again(best, states, meter),
            Effort::Share(work) => {
                let states = AGAIN / (self.graph.size() as u64 + STATE);
                let best = match self.states_along(&best) <= states {
                    true => self.search_again(best, states, meter),
                    false => best,
                };
                let preparation = PREPARATION * self.graph.size() as u64;
                let work = work.saturating_mul(WORK).saturating_add(preparation) / SHARE;
                let mut relaxation = self.relaxation();
                let mut windows = Windows::new(self.task, &mut relaxation, work);
                eliminate(self.task, windows.improve(best, meter))
            }
        }
    }

    /// Roughly how many states a search estimates that goes straight to the goal.
    fn states_along(&self, plan: &[OperatorId]) -> u64 {
        let mut applicable = Vec::new();
        self.successors.applicable(self.task, &self.task.init, &mut applicable);
        applicable.len() as u64 * plan.len() as u64
    }

    fn relaxation(&self) -> Relaxation<'t> {
        Relaxation::on(self.task, Rc::clone(self.graph), Costs::PlusOne)
    }

    /// Looks for cheaper plans with weighted A* of falling weight.
    fn search_again(&self, plan: Vec<OperatorId>, states: u64, meter: &mut Meter<'_>) -> Vec<OperatorId> {
        let (mut best, mut left) = (plan, states);
        let mut relaxation = self.relaxation();
        // A larger weight only repeats what the greedy search has found.
        for weight in [2, 1] {
            // Ties are broken by length.
            let costs = Costs::PlusOne;
            let bound = cost(self.task, costs, &best);
            let search = Improvement {
                task: self.task,
                successors: self.successors,
                relaxation: &mut relaxation,
                weight,
                costs,
                bound,
                left: &mut left,
            };
            match search.run(meter) {
                Step::Better(path) => best = eliminate(self.task, path),
                Step::Nothing => {}
                Step::Stopped => break,
            }
        }
        best
    }
}

/// The cost of a plan.
pub(super) fn cost(task: &Task, costs: Costs, plan: &[OperatorId]) -> u64 {
    plan.iter().map(|&operator| u64::from(costs.of(task, operator))).sum()
}

/// Drops groups of operators that the plan works without (Nakhost & Müller 2010, "Action elimination and
/// plan neighborhood graph search", section 3): leaving one out, all later ones that then do not apply go
/// too; if the goal still holds, so it stays.
pub(crate) fn eliminate(task: &Task, mut plan: Vec<OperatorId>) -> Vec<OperatorId> {
    let mut state = task.init.clone();
    let mut next = state.clone();
    let mut at = 0;
    while at < plan.len() {
        let mut without = state.clone();
        let mut kept = Vec::with_capacity(plan.len() - at);
        for &operator in &plan[at + 1..] {
            if task.applicable(&without, operator) {
                task.apply(&without, operator, &mut next);
                std::mem::swap(&mut without, &mut next);
                kept.push(operator);
            }
        }
        if task.is_goal(&without) {
            plan.truncate(at);
            plan.extend(kept);
        } else {
            task.apply(&state, plan[at], &mut next);
            std::mem::swap(&mut state, &mut next);
            at += 1;
        }
    }
    plan
}

/// How a search for a cheaper plan ended.
pub(super) enum Step {
    Better(Vec<OperatorId>),
    /// There is none: only states beyond the bound and dead ends were left out.
    Nothing,
    Stopped,
}

/// One weighted A* for a plan cheaper than `bound`.
pub(super) struct Improvement<'a, 't> {
    pub task: &'a Task,
    pub successors: &'a Successors,
    pub relaxation: &'a mut Relaxation<'t>,
    /// What h_FF is multiplied with.
    pub weight: u64,
    /// What the plan shall cost less in.
    pub costs: Costs,
    pub bound: u64,
    /// States that may still be estimated.
    pub left: &'a mut u64,
}

impl Improvement<'_, '_> {
    /// Searches.
    pub fn run(self, meter: &mut Meter<'_>) -> Step {
        let task = self.task;
        let mut registry = Registry::new(task);
        let mut costs = vec![0u64];
        let mut estimates: Vec<Option<u32>> = vec![self.relaxation.hff(&task.init, &mut Vec::new())];
        let mut open = OpenList::default();
        open.push(0, (StateId(0), 0u64));
        let (mut applicable, mut preferred) = (Vec::new(), Vec::new());
        let (mut state, mut next) = (task.init.clone(), task.init.clone());
        while let Some((_, (id, g))) = open.pop() {
            if g != costs[id.0 as usize] {
                continue;
            }
            if *self.left == 0 || meter.expand(|| registry.bytes() + open.bytes()).is_err() {
                return Step::Stopped;
            }
            state.copy_from_slice(registry.state(id));
            applicable.clear();
            self.successors.applicable(task, &state, &mut applicable);
            for &operator in &applicable {
                let cost = g + u64::from(self.costs.of(task, operator));
                if cost >= self.bound {
                    continue;
                }
                task.apply(&state, operator, &mut next);
                let (successor, new) = registry.insert(&next, id, operator);
                let index = successor.0 as usize;
                if new {
                    costs.push(cost);
                    if task.is_goal(&next) {
                        return Step::Better(registry.path(successor));
                    }
                    preferred.clear();
                    *self.left = self.left.saturating_sub(1);
                    estimates.push(self.relaxation.hff(&next, &mut preferred));
                } else if cost < costs[index] {
                    costs[index] = cost;
                    registry.set_origin(successor, id, operator);
                } else {
                    continue;
                }
                // h_FF may overestimate, so it orders the search but prunes only dead ends.
                if let Some(h) = estimates[index] {
                    let key = cost + self.weight * u64::from(h);
                    open.push(u32::try_from(key).unwrap_or(u32::MAX), (successor, cost));
                }
            }
        }
        Step::Nothing
    }
}
