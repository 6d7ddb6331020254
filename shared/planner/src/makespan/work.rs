//! A lower bound of the makespan from the work there is.
//!
//! The landmark cut (Helmert & Domshlak, ICAPS 2009) says how much a plan costs at least, whatever the operators
//! cost. Let those of some agents cost one and those of all others nothing: then so many actions must be done by
//! these agents, and in a step each of them does at most one. An agent cannot begin with what counts before the
//! first of it can be reached, and has to end early enough for what its last must be followed by: in a plan from
//! which nothing can be left out, each action leads to the goal by a chain of others, one step each.
//!
//! The bound holds for every set of agents; which one gives most is looked for greedily.

use super::layers::{NEVER, Reach};
use super::model::{Maker, Model};
use crate::heuristic::{Costs, LandmarkCut};
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
        let mut idle = vec![(NEVER, NEVER); model.agents];
        for operator in cut.counted() {
            let idle = &mut idle[model.agent_of[operator.index()] as usize];
            idle.0 = idle.0.min(reach.operators[operator.index()]);
            idle.1 = idle.1.min(followed_by[operator.index()]);
        }
        let idle: Vec<u32> = idle
            .into_iter()
            .filter(|i| i.0 != NEVER && i.1 != NEVER)
            .map(|(head, tail)| head + tail)
            .collect();
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
