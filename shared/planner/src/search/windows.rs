//! Cheaper ways for parts of a plan: a stretch of its steps is replaced by a cheaper one that does what the rest
//! needs (Siddiqui & Haslum 2015, "Continuing plan quality optimisation", for windows of a plan; what the rest needs is
//! regressed from the goal, so a replacement may leave anything else behind than the stretch did).
//!
//! Windows are taken from the end of the plan to its beginning, short ones first, then twice as long ones; when all were
//! tried, all of them with more effort each.

use std::collections::HashSet;
use std::ops::Range;

use super::improve::cost;
use super::limits::Meter;
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use super::regression::{Needs, states_along};
use crate::heuristic::{Costs, Relaxation};
use crate::id_table::hash_words;
use crate::task::{OperatorId, Task};

/// The steps of the shortest windows.
const SHORTEST: usize = 4;

/// States estimated for one window at first, and how many times as many when all windows were tried.
const STATES: usize = 400;
const MORE: usize = 4;

/// At first a window has to save one in so many parts of the plan's cost.
const GAIN: u64 = 300;

/// The search counts costs in at most so many steps.
const COARSE: u32 = 1000;

/// Looks for cheaper stretches of plans.
pub(super) struct Windows<'a, 't> {
    task: &'t Task,
    relaxation: &'a mut Relaxation<'t>,
    costs: Costs,
    /// The cost of the dearest operator.
    dearest: u32,
    /// What may still be spent, roughly in nanoseconds.
    work: u64,
    /// States estimated for one window, at most.
    most: usize,
    /// What has to be gained by a window.
    least: u64,
    /// The windows that were tried, by hash, and work space for those.
    tried: HashSet<u64>,
    key: Vec<u64>,
    /// Whether a window was left before everything in it was seen.
    cut: bool,
}

impl<'a, 't> Windows<'a, 't> {
    /// With the costs that the search counts: free operators count, too.
    pub fn new(task: &'t Task, relaxation: &'a mut Relaxation<'t>, work: u64) -> Self {
        let costs = Costs::PlusOne;
        let all = (0..task.operators.len() as u32).map(OperatorId);
        let dearest = all.map(|operator| costs.of(task, operator)).max().unwrap_or(1);
        let windows = Windows {
            task,
            relaxation,
            costs,
            dearest,
            work,
            most: STATES,
            least: 1,
            tried: HashSet::new(),
            key: Vec::new(),
            cut: false,
        };
        let coarse: Vec<u32> =
            (0..task.operators.len() as u32).map(|at| windows.coarse(OperatorId(at))).collect();
        windows.relaxation.set_costs(|operator| coarse[operator.index()]);
        windows
    }

    /// What the search counts: large costs are kept in small numbers, which queues are quick with.
    fn coarse(&self, operator: OperatorId) -> u32 {
        let cost = self.costs.of(self.task, operator);
        if self.dearest <= COARSE {
            cost
        } else {
            (u64::from(cost) * u64::from(COARSE) / u64::from(self.dearest)) as u32 + 1
        }
    }

    /// The plan, or a cheaper one.
    pub fn improve(&mut self, plan: Vec<OperatorId>, meter: &mut Meter<'_>) -> Vec<OperatorId> {
        let mut best = plan;
        loop {
            self.cut = false;
            self.tried.clear();
            let all: u64 = best.iter().map(|&operator| u64::from(self.coarse(operator))).sum();
            self.least = (all * STATES as u64 / (GAIN * self.most as u64)).max(1);
            let mut length = SHORTEST;
            loop {
                best = self.improve_with(best, length, meter);
                if length >= best.len() {
                    break;
                }
                length *= 2;
            }
            if !self.cut && self.least == 1 || self.work == 0 {
                return best;
            }
            self.most = self.most.saturating_mul(MORE);
        }
    }

    /// The same with windows of so many steps, until none of them helps. After a change the windows before it are others.
    fn improve_with(
        &mut self,
        plan: Vec<OperatorId>,
        length: usize,
        meter: &mut Meter<'_>,
    ) -> Vec<OperatorId> {
        let mut best = plan;
        while self.work > 0 {
            let plan = self.pass(&best, length, meter);
            let is_plan = self.task.leads_to(&self.task.init, &plan, &self.task.goal);
            debug_assert!(is_plan, "the rest of a plan needs more than was said");
            if self.cost(&plan) >= self.cost(&best) || !is_plan {
                break;
            }
            best = plan;
        }
        best
    }

    /// What counts: the cost, then the length.
    fn cost(&self, plan: &[OperatorId]) -> (u64, usize) {
        (cost(self.task, Costs::Real, plan), plan.len())
    }

    /// Goes over the windows of so many steps.
    fn pass(&mut self, plan: &[OperatorId], length: usize, meter: &mut Meter<'_>) -> Vec<OperatorId> {
        let mut states = states_along(self.task, &self.task.init, plan);
        let mut open = plan.to_vec();
        let mut needs = Needs::of_goal(self.task, &states[open.len()]);
        // What comes after the window, last step first.
        let mut done = Vec::new();
        while !open.is_empty() {
            let start = open.len().saturating_sub(length);
            if self.work > 0
                && let Some(better) = self.replace(&states[start], &open[start..], &needs, meter)
            {
                let tail = states_along(self.task, &states[start], &better);
                states.truncate(start);
                states.extend(tail);
                open.truncate(start);
                open.extend(better);
            }
            // The next window overlaps this one by half.
            let keep = if start == 0 { 0 } else { start + (open.len() - start) / 2 };
            while open.len() > keep {
                let Some(operator) = open.pop() else { break };
                needs.back(operator, &states[open.len()]);
                done.push(operator);
            }
        }
        done.reverse();
        done
    }

    /// A cheaper way to do for the needs what the window does.
    fn replace(
        &mut self,
        from: &[u64],
        window: &[OperatorId],
        needs: &Needs<'_>,
        meter: &mut Meter<'_>,
    ) -> Option<Vec<OperatorId>> {
        let coarse = |windows: &Self, path: &[OperatorId]| {
            path.iter().map(|&operator| u64::from(windows.coarse(operator))).sum()
        };
        let (mut left, all): (_, u64) = (self.cost(window), coarse(self, window));
        let mut bound = all.saturating_sub(self.least - 1);
        self.key.clear();
        self.key.extend(from);
        self.key.extend(window.iter().map(|operator| u64::from(operator.0)));
        self.key.extend(needs.facts().map(u64::from));
        if !self.tried.insert(hash_words(&self.key)) {
            return None;
        }
        self.relaxation.set_goals(needs.facts());
        let mut better = None;
        while let Some(path) = self.search(from, bound, needs, meter) {
            bound = coarse(self, &path).saturating_sub(self.least - 1);
            let cost = self.cost(&path);
            if cost < left {
                left = cost;
                better = Some(path);
            }
        }
        better
    }

    /// A* with h_FF over the operators of relaxed plans, for a path that costs less than `bound`.
    fn search(
        &mut self,
        from: &[u64],
        bound: u64,
        needs: &Needs<'_>,
        meter: &mut Meter<'_>,
    ) -> Option<Vec<OperatorId>> {
        if needs.are_met(from) {
            return (bound > 0).then(Vec::new);
        }
        let task = self.task;
        let mut registry = Registry::starting_in(task, from);
        let mut open = OpenList::default();
        let mut promising = Vec::new();
        let mut nodes = vec![self.estimate(from, 0, &mut promising)];
        self.offer(&mut open, &nodes, StateId(0), bound);
        let (mut state, mut next) = (from.to_vec(), from.to_vec());
        while let Some((_, (id, cost))) = open.pop() {
            let node = nodes[id.0 as usize].clone();
            if cost != node.cost {
                continue;
            }
            if meter.expand(|| registry.bytes()).is_err() {
                self.work = 0;
            }
            if self.work == 0 || nodes.len() >= self.most {
                self.cut = true;
                return None;
            }
            state.copy_from_slice(registry.state(id));
            for at in node.promising {
                let operator: OperatorId = promising[at];
                let cost = cost + u64::from(self.coarse(operator));
                if cost >= bound {
                    continue;
                }
                task.apply(&state, operator, &mut next);
                let (successor, new) = registry.insert(&next, id, operator);
                if new {
                    if needs.are_met(&next) {
                        return Some(registry.path(successor));
                    }
                    nodes.push(self.estimate(&next, cost, &mut promising));
                } else if cost < nodes[successor.0 as usize].cost {
                    nodes[successor.0 as usize].cost = cost;
                    registry.set_origin(successor, id, operator);
                } else {
                    continue;
                }
                self.offer(&mut open, &nodes, successor, bound);
            }
        }
        None
    }

    fn estimate(&mut self, state: &[u64], cost: u64, promising: &mut Vec<OperatorId>) -> Node {
        self.work = self.work.saturating_sub(self.relaxation.work());
        let start = promising.len();
        let estimate = self.relaxation.hff(state, promising);
        Node { cost, estimate, promising: start..promising.len() }
    }

    /// Puts a state on the open list, unless it is a dead end or seems to lead to nothing cheaper.
    fn offer(&self, open: &mut OpenList<(StateId, u64)>, nodes: &[Node], id: StateId, bound: u64) {
        let node = &nodes[id.0 as usize];
        let Some(estimate) = node.estimate else { return };
        let all = node.cost + u64::from(estimate);
        if all < bound {
            open.push(u32::try_from(all).unwrap_or(u32::MAX), (id, node.cost));
        }
    }
}

/// What is known of a state.
#[derive(Clone)]
struct Node {
    cost: u64,
    /// `None`: a dead end.
    estimate: Option<u32>,
    /// The operators to try, among all promising ones.
    promising: Range<usize>,
}
