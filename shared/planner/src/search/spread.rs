//! A plan that gives all agents of a team something to do.
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
use crate::task::{OperatorId, Task};

/// How many more choices the queue of preferred operators gets after progress.
const BOOST: i64 = 1000;

/// What an operator costs beside its agent's load, which counts one for each action.
const BASE: u32 = 4;

/// Looks for such a plan within the limits. The work is counted in states looked at; see [`Limits::expansions`].
pub fn spread(
    task: &Task,
    agent_of: &[u32],
    limits: &Limits,
    cancel: &AtomicBool,
) -> Option<Vec<OperatorId>> {
    let Prepared { graph, successors } = prepare(task).ok()?;
    let agents = agent_of.iter().max().map_or(0, |&a| a as usize + 1);
    let mut search = Spread {
        task,
        successors: &successors,
        relaxation: Relaxation::on(task, Rc::clone(&graph), Costs::Unit),
        agent_of,
        agents,
        registry: Registry::new(task),
        loads: vec![0; agents],
        queues: Default::default(),
        priorities: [0; 2],
        best: u32::MAX,
    };
    let plan = search.run(&mut Meter::new(limits, cancel))?;
    Some(eliminate(task, plan))
}

struct Spread<'a> {
    task: &'a Task,
    successors: &'a Successors,
    relaxation: Relaxation<'a>,
    agent_of: &'a [u32],
    agents: usize,
    registry: Registry,
    /// What each agent has done on the way to each state.
    loads: Vec<u16>,
    /// All successors, and those by preferred operators.
    queues: [OpenList<(StateId, OperatorId)>; 2],
    /// The queue with the lowest priority is served next.
    priorities: [i64; 2],
    best: u32,
}

impl Spread<'_> {
    fn run(&mut self, meter: &mut Meter<'_>) -> Option<Vec<OperatorId>> {
        let mut next = self.task.init.clone();
        if self.task.is_goal(&next) {
            return Some(Vec::new());
        }
        self.expand(StateId(0), &next);
        while let Some((parent, operator)) = self.pop() {
            self.task.apply(self.registry.state(parent), operator, &mut next);
            let (state, new) = self.registry.insert(&next, parent, operator);
            if !new {
                continue;
            }
            if self.task.is_goal(&next) {
                return Some(self.registry.path(state));
            }
            let from = parent.0 as usize * self.agents;
            self.loads.extend_from_within(from..from + self.agents);
            let own = state.0 as usize * self.agents + self.agent_of[operator.index()] as usize;
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
        let loads = &self.loads[id.0 as usize * self.agents..][..self.agents];
        let least = loads.iter().copied().min().unwrap_or(0);
        let cost = |operator: OperatorId| {
            let load = loads[self.agent_of[operator.index()] as usize] - least;
            BASE + u32::from(load)
        };
        self.relaxation.set_costs(cost);
        let mut preferred = Vec::new();
        let Some(estimate) = self.relaxation.hff(state, &mut preferred) else { return };
        if estimate < self.best {
            self.best = estimate;
            self.priorities[1] -= BOOST;
        }
        let mut applicable = Vec::new();
        self.successors.applicable(self.task, state, &mut applicable);
        applicable.into_iter().for_each(|operator| self.queues[0].push(estimate, (id, operator)));
        preferred.into_iter().for_each(|operator| self.queues[1].push(estimate, (id, operator)));
    }
}
