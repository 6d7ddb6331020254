//! Plans that give all agents of a team something to do.
//!
//! Lazy greedy search with h_FF and preferred operators, as in [`super::greedy`], but an operator of an agent
//! that has done more than others costs the heuristic more. Where several agents can do something, the relaxed
//! plan then takes the one that is free soonest, and the plans found take fewer steps of the team.

use std::rc::Rc;
use std::sync::atomic::AtomicBool;

use super::limits::Meter;
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use super::{Limits, Prepared, eliminate, prepare};
use crate::heuristic::{Costs, Relaxation};
use crate::successor::Successors;
use crate::task::{FactId, OperatorId, Task};

/// How many more choices the queue of preferred operators gets after progress.
const BOOST: i64 = 1000;

/// What an operator costs beside its agent's load, which counts one for each action.
const BASE: u32 = 4;

/// What an operator costs that may not be used: more than all others of a plan.
const FORBIDDEN: u32 = 1 << 20;

/// Looks for such a plan within the limits. The work is counted in states looked at; see [`Limits::expansions`].
pub fn spread(
    task: &Task,
    agent_of: &[u32],
    limits: &Limits,
    cancel: &AtomicBool,
) -> Option<Vec<OperatorId>> {
    let mut spreader = Spreader::new(task, agent_of)?;
    let loads = vec![0; spreader.agents];
    let errand = Errand { start: &task.init, goal: &task.goal, loads: &loads, only: None };
    let plan = spreader.run(&errand, &mut Meter::new(limits, cancel))?;
    Some(eliminate(task, plan))
}

/// Something to be done.
pub(crate) struct Errand<'a> {
    /// The state it begins in.
    pub start: &'a [u64],
    /// What shall hold; no fact is in it twice.
    pub goal: &'a [FactId],
    /// What each agent has to do already.
    pub loads: &'a [u16],
    /// Who does it; `None`: anybody.
    pub only: Option<u32>,
}

/// Looks for plans of a team.
pub(crate) struct Spreader<'a> {
    task: &'a Task,
    successors: Successors,
    relaxation: Relaxation<'a>,
    agent_of: &'a [u32],
    pub agents: usize,
}

impl<'a> Spreader<'a> {
    /// `None` if the task's goal is out of reach.
    pub fn new(task: &'a Task, agent_of: &'a [u32]) -> Option<Self> {
        let Prepared { graph, successors } = prepare(task).ok()?;
        let relaxation = Relaxation::on(task, Rc::clone(&graph), Costs::Unit);
        let agents = agent_of.iter().max().map_or(0, |&a| a as usize + 1);
        Some(Spreader { task, successors, relaxation, agent_of, agents })
    }

    /// A plan for an errand.
    pub fn run(&mut self, errand: &Errand<'_>, meter: &mut Meter<'_>) -> Option<Vec<OperatorId>> {
        self.relaxation.set_goals(errand.goal.iter().copied());
        if let Some(only) = errand.only {
            let agent_of = self.agent_of;
            let cost = |o: OperatorId| if agent_of[o.index()] == only { BASE } else { FORBIDDEN };
            self.relaxation.set_costs(cost);
        }
        let search = Search {
            registry: Registry::starting_in(self.task, errand.start),
            loads: errand.loads.to_vec(),
            spreader: self,
            errand,
            queues: Default::default(),
            priorities: [0; 2],
            best: u32::MAX,
        };
        search.run(meter)
    }
}

struct Search<'s, 'a> {
    spreader: &'s mut Spreader<'a>,
    errand: &'s Errand<'s>,
    registry: Registry,
    /// What each agent has done on the way to each state.
    loads: Vec<u16>,
    /// All successors, and those by preferred operators.
    queues: [OpenList<(StateId, OperatorId)>; 2],
    /// The queue with the lowest priority is served next.
    priorities: [i64; 2],
    best: u32,
}

impl Search<'_, '_> {
    fn run(mut self, meter: &mut Meter<'_>) -> Option<Vec<OperatorId>> {
        let task = self.spreader.task;
        let agents = self.spreader.agents;
        let mut next = self.errand.start.to_vec();
        let is_done = |state: &[u64]| self.errand.goal.iter().all(|&fact| task.holds(state, fact));
        if is_done(&next) {
            return Some(Vec::new());
        }
        self.expand(StateId(0), &next);
        while let Some((parent, operator)) = self.pop() {
            task.apply(self.registry.state(parent), operator, &mut next);
            let (state, new) = self.registry.insert(&next, parent, operator);
            if !new {
                continue;
            }
            if is_done(&next) {
                return Some(self.registry.path(state));
            }
            let from = parent.0 as usize * agents;
            self.loads.extend_from_within(from..from + agents);
            let own = state.0 as usize * agents + self.spreader.agent_of[operator.index()] as usize;
            self.loads[own] = self.loads[own].saturating_add(1);
            meter.expand(|| self.bytes()).ok()?;
            self.expand(state, &next);
        }
        None
    }

    fn bytes(&self) -> usize {
        let open: usize = self.queues.iter().map(OpenList::bytes).sum();
        open + self.registry.bytes() + 2 * self.loads.capacity()
    }

    fn pop(&mut self) -> Option<(StateId, OperatorId)> {
        let filled = (0..2).filter(|&queue| !self.queues[queue].is_empty());
        let queue = filled.min_by_key(|&queue| self.priorities[queue])?;
        self.priorities[queue] += 1;
        self.queues[queue].pop().map(|(_, entry)| entry)
    }

    fn expand(&mut self, id: StateId, state: &[u64]) {
        let Spreader { task, successors, relaxation, agent_of, agents } = &mut *self.spreader;
        if self.errand.only.is_none() {
            let loads = &self.loads[id.0 as usize * *agents..][..*agents];
            let least = loads.iter().copied().min().unwrap_or(0);
            relaxation
                .set_costs(|operator| BASE + u32::from(loads[agent_of[operator.index()] as usize] - least));
        }
        let mut preferred = Vec::new();
        let Some(estimate) = relaxation.hff(state, &mut preferred) else { return };
        let mut applicable = Vec::new();
        if let Some(only) = self.errand.only {
            // What it cannot do alone it cannot do.
            if estimate >= FORBIDDEN {
                return;
            }
            successors.applicable(task, state, &mut applicable);
            applicable.retain(|operator| agent_of[operator.index()] == only);
        } else {
            successors.applicable(task, state, &mut applicable);
        }
        if estimate < self.best {
            self.best = estimate;
            self.priorities[1] -= BOOST;
        }
        applicable.into_iter().for_each(|operator| self.queues[0].push(estimate, (id, operator)));
        preferred.into_iter().for_each(|operator| self.queues[1].push(estimate, (id, operator)));
    }
}
