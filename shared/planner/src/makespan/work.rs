//! A lower bound of the makespan from the work there is.
//!
//! The landmark cut (Helmert & Domshlak, ICAPS 2009) says how much a plan costs at least, whatever the operators
//! cost. Let those of some agents cost one and those of all others nothing: then so many actions must be done by
//! these agents, and in a step each of them does at most one. An agent cannot begin with what counts before the
//! first of it can be reached, and has to end early enough for what its last must be followed by: in a plan from
//! which nothing can be left out, each action leads to the goal by a chain of others, one step each.
//!
//! The bound holds for every set of agents; which one gives most is looked for greedily.

use std::collections::{BTreeMap, BTreeSet};

use super::layers::{NEVER, Reach};
use super::model::{Maker, Model};
use crate::heuristic::{Costs, Heuristic, LandmarkCut};
use crate::task::Task;

/// Bounds from work.
pub(super) struct Work<'a> {
    task: &'a Task,
    model: &'a Model,
    reach: &'a Reach,
    cut: LandmarkCut<'a>,
    /// For each operator, how many steps must follow it at least.
    followed_by: Vec<u32>,
}

impl<'a> Work<'a> {
    pub fn new(task: &'a Task, model: &'a Model, reach: &'a Reach) -> Self {
        let cut = LandmarkCut::new(task, Costs::Unit);
        // Through derived facts and numbers an operator may serve the goal in ways that are not tracked.
        let untracked = !model.derivations.is_empty() || task.has_numbers();
        let followed_by = if untracked { vec![0; task.operators.len()] } else { followed_by(model) };
        Work { task, model, reach, cut, followed_by }
    }

    /// The best bound found by looking at no more than `sets` sets of agents.
    pub fn bound(&mut self, sets: usize) -> u32 {
        let agents = self.model.agents;
        let mut set = vec![true; agents];
        let mut best = self.of(&set);
        let mut left = sets.saturating_sub(1);
        let mut at = 0;
        let mut unchanged = 0;
        // Leaves agents out or takes them in, one at a time, as long as that raises the bound.
        while left > 0 && unchanged < agents {
            set[at] = !set[at];
            let bound = self.of(&set);
            left -= 1;
            if bound > best {
                best = bound;
                unchanged = 0;
            } else {
                set[at] = !set[at];
                unchanged += 1;
            }
            at = (at + 1) % agents;
        }
        for agent in (0..agents).take(left) {
            let alone: Vec<bool> = (0..agents).map(|a| a == agent).collect();
            best = best.max(self.of(&alone));
        }
        best
    }

    /// The bound from the work of these agents.
    fn of(&mut self, set: &[bool]) -> u32 {
        let Work { task, model, reach, cut, followed_by } = self;
        let in_set = |operator: usize| set[model.agent_of[operator] as usize];
        cut.set_costs((0..task.operators.len()).map(|o| u32::from(in_set(o))));
        let Some(work) = cut.value(&task.init) else { return 0 };
        if work == 0 {
            return 0;
        }
        let duties = duties(cut.findings(), |operator| {
            let operator = operator as usize;
            (model.agent_of[operator] as usize, reach.operators[operator], followed_by[operator])
        });
        // Those that cannot be done early, or must have something after them, may bound more than all of them do.
        let heads: BTreeSet<u32> = duties.iter().map(|duty| duty.head).collect();
        let tails: BTreeSet<u32> = duties.iter().map(|duty| duty.tail).collect();
        let mut best = 0;
        for &head in &heads {
            for &tail in &tails {
                let some = duties.iter().filter(|duty| duty.head >= head && duty.tail >= tail);
                best = best.max(steps_for(some, model.agents));
            }
        }
        best
    }
}

/// An action that must be done, one of several that different agents may do.
struct Duty {
    /// For each agent who can do it, the steps that must come before and after.
    by: Vec<(usize, u32, u32)>,
    /// The least of these.
    head: u32,
    tail: u32,
}

/// What must be done, from the cuts of a heuristic in which operators cost one or nothing: no operator is in two.
fn duties(mut cuts: &[u32], of: impl Fn(u32) -> (usize, u32, u32)) -> Vec<Duty> {
    let mut duties = Vec::new();
    while let [_, count, rest @ ..] = cuts {
        let (cut, rest) = rest.split_at(*count as usize);
        cuts = rest;
        let mut by: BTreeMap<usize, (u32, u32)> = BTreeMap::new();
        for (agent, head, tail) in cut.iter().map(|&operator| of(operator)) {
            if head != NEVER && tail != NEVER {
                let own = by.entry(agent).or_insert((head, tail));
                *own = (own.0.min(head), own.1.min(tail));
            }
        }
        let head = by.values().map(|own| own.0).min().unwrap_or(0);
        let tail = by.values().map(|own| own.1).min().unwrap_or(0);
        duties.push(Duty {
            by: by.into_iter().map(|(agent, own)| (agent, own.0, own.1)).collect(),
            head,
            tail,
        });
    }
    duties
}

/// The steps it takes to do all of these: an agent is idle before the first it can do and after the last.
fn steps_for<'a>(duties: impl Iterator<Item = &'a Duty>, agents: usize) -> u32 {
    let mut idle = vec![(NEVER, NEVER); agents];
    let mut work = 0u32;
    for duty in duties {
        work += 1;
        for &(agent, head, tail) in &duty.by {
            idle[agent] = (idle[agent].0.min(head), idle[agent].1.min(tail));
        }
    }
    let idle: Vec<u32> = idle.into_iter().filter(|own| own.0 != NEVER).map(|own| own.0 + own.1).collect();
    let done = |steps: u32| idle.iter().map(|&idle| steps.saturating_sub(idle)).sum::<u32>();
    if work == 0 || idle.is_empty() {
        return 0;
    }
    let mut steps = work.div_ceil(idle.len() as u32);
    while done(steps) < work {
        steps += 1;
    }
    steps
}

/// How many steps must follow each operator in a plan from which nothing can be left out.
fn followed_by(model: &Model) -> Vec<u32> {
    let operators = model.preconditions.len();
    let mut distance = vec![NEVER; operators];
    let mut seen = vec![false; model.literals_count()];
    let mut current = model.goal.clone();
    let mut steps = 0;
    while !current.is_empty() {
        let mut next = Vec::new();
        while let Some(lit) = current.pop() {
            if std::mem::replace(&mut seen[lit.index()], true) {
                continue;
            }
            for &maker in &model.makers[lit.index()] {
                let operator = model.operator_of(maker) as usize;
                if distance[operator] == NEVER {
                    distance[operator] = steps;
                    next.extend(model.preconditions.row(operator));
                }
                if let Maker::Event(event) = maker {
                    next.extend(&model.events[event as usize].condition);
                }
            }
            // What a derived fact rests on is needed in the same step.
            current.extend(model.derivations.get(&lit.0).into_iter().flatten().flatten());
            // Why something does no harm may be needed, too.
            let excuses = model.threats[lit.index()].iter().flat_map(|t| &t.harmless_if);
            current.extend(excuses);
        }
        current = next;
        steps += 1;
    }
    distance
}
