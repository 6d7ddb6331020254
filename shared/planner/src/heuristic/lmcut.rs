//! The landmark-cut heuristic (Helmert & Domshlak 2009, "Landmarks, critical paths and abstractions: what's
//! the difference anyway?", section 4). Deviation: costs are lowered by operator, not by node of the
//! relaxed graph, so that the sum stays admissible for operators with conditional effects.

use std::rc::Rc;

use super::bucket_queue::BucketQueue;
use super::graph::{Graph, NO_NODE};
use super::{Costs, Estimate, Heuristic, Properties};
use crate::csr::Csr;
use crate::task::{FactId, OperatorId, Task};

const UNREACHED: u32 = u32::MAX;

/// The heuristic and its work space.
#[derive(Debug)]
pub struct LandmarkCut<'a> {
    task: &'a Task,
    graph: Rc<Graph>,
    /// The nodes with each fact as an effect.
    makers: Csr<u32>,
    nodes_of: Csr<u32>,
    goal_conditions: Vec<FactId>,
    full_cost: Vec<u32>,
    /// What each operator still costs; the last entry is for axioms: nothing.
    cost: Vec<u32>,
    fact_cost: Vec<u32>,
    missing: Vec<u32>,
    /// The dearest condition of each node, and its cost.
    supporter: Vec<FactId>,
    supporter_cost: Vec<u32>,
    queue: BucketQueue,
    zone: Vec<Zone>,
    agenda: Vec<FactId>,
    cut: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Zone {
    Unknown,
    /// The goal follows from it without cost.
    Goal,
    /// Reached from the state without entering the goal zone.
    Before,
}

impl<'a> LandmarkCut<'a> {
    /// Prepares the heuristic.
    pub fn new(task: &'a Task, costs: Costs) -> Self {
        let graph = Rc::new(Graph::complete(task));
        let count = graph.operator_of.len();
        let pairs =
            (0..count).flat_map(|node| graph.effects.row(node).iter().map(move |f| (f.0, node as u32)));
        let makers = Csr::from_pairs(task.facts.len(), pairs);
        let real = (0..count).filter(|&node| graph.operator_of[node] != NO_NODE);
        let nodes_of =
            Csr::from_pairs(task.operators.len(), real.map(|node| (graph.operator_of[node], node as u32)));
        let operators = (0..task.operators.len() as u32).map(OperatorId);
        let full_cost: Vec<u32> = operators.map(|operator| costs.of(task, operator)).chain([0]).collect();
        LandmarkCut {
            task,
            makers,
            nodes_of,
            goal_conditions: task.goal.clone(),
            cost: full_cost.clone(),
            full_cost,
            fact_cost: vec![UNREACHED; task.facts.len()],
            missing: vec![0; count],
            supporter: vec![FactId(0); count],
            supporter_cost: vec![0; count],
            queue: BucketQueue::default(),
            zone: vec![Zone::Unknown; task.facts.len()],
            agenda: Vec::new(),
            cut: Vec::new(),
            graph,
        }
    }

    fn node_cost(&self, node: usize) -> u32 {
        let operator = self.graph.operator_of[node];
        self.cost[if operator == NO_NODE { self.cost.len() - 1 } else { operator as usize }]
    }

    fn reach(&mut self, fact: FactId, cost: u32) {
        if cost < self.fact_cost[fact.index()] {
            self.fact_cost[fact.index()] = cost;
            self.queue.push(cost, fact);
        }
    }

    fn fire(&mut self, node: usize) {
        let cost = self.supporter_cost[node] + self.node_cost(node);
        for at in self.graph.effects.range(node) {
            self.reach(self.graph.effects.items()[at], cost);
        }
    }

    /// h_max from scratch.
    fn explore(&mut self, state: &[u64]) {
        self.fact_cost.fill(UNREACHED);
        self.queue.clear();
        self.missing.copy_from_slice(&self.graph.condition_count);
        let task = self.task;
        task.facts_of(state).for_each(|fact| self.reach(fact, 0));
        let graph = Rc::clone(&self.graph);
        graph.free_facts.iter().for_each(|&fact| self.reach(fact, 0));
        for &node in &graph.free_nodes {
            self.supporter_cost[node as usize] = 0;
            self.fire(node as usize);
        }
        while let Some((cost, fact)) = self.queue.pop() {
            if self.fact_cost[fact.index()] != cost {
                continue;
            }
            for &node in graph.waiting.row(fact.index()) {
                let node = node as usize;
                self.missing[node] -= 1;
                if self.missing[node] == 0 {
                    // Facts come out by rising cost: the last one is the dearest.
                    self.supporter[node] = fact;
                    self.supporter_cost[node] = cost;
                    self.fire(node);
                }
            }
        }
    }

    /// h_max again, after the operators of the cut became cheaper.
    fn explore_again(&mut self) {
        self.queue.clear();
        let graph = Rc::clone(&self.graph);
        for at in 0..self.cut.len() {
            let operator = graph.operator_of[self.cut[at] as usize] as usize;
            for of in self.nodes_of.range(operator) {
                let node = self.nodes_of.items()[of] as usize;
                if self.missing[node] == 0 {
                    self.fire(node);
                }
            }
        }
        while let Some((cost, fact)) = self.queue.pop() {
            if self.fact_cost[fact.index()] != cost {
                continue;
            }
            for &node in graph.waiting.row(fact.index()) {
                let node = node as usize;
                if self.missing[node] > 0 || self.supporter[node] != fact || self.supporter_cost[node] <= cost
                {
                    continue;
                }
                let before = self.supporter_cost[node];
                let conditions = graph.conditions.row(node);
                let dearest = conditions.iter().copied().max_by_key(|f| self.fact_cost[f.index()]);
                let Some(dearest) = dearest else { continue };
                self.supporter[node] = dearest;
                self.supporter_cost[node] = self.fact_cost[dearest.index()];
                if self.supporter_cost[node] < before {
                    self.fire(node);
                }
            }
        }
    }

    /// The dearest goal: what supports reaching all of them.
    fn dearest_goal(&self) -> Option<FactId> {
        self.goal_conditions.iter().copied().max_by_key(|fact| self.fact_cost[fact.index()])
    }

    /// Marks what leads to `goal` without cost.
    fn mark_goal_zone(&mut self, goal: FactId) {
        self.zone.fill(Zone::Unknown);
        self.agenda.clear();
        self.agenda.push(goal);
        self.zone[goal.index()] = Zone::Goal;
        while let Some(fact) = self.agenda.pop() {
            for at in self.makers.range(fact.index()) {
                let node = self.makers.items()[at] as usize;
                if self.missing[node] > 0 || self.node_cost(node) > 0 || self.graph.condition_count[node] == 0
                {
                    continue;
                }
                let supporter = self.supporter[node];
                if self.zone[supporter.index()] == Zone::Unknown {
                    self.zone[supporter.index()] = Zone::Goal;
                    self.agenda.push(supporter);
                }
            }
        }
    }

    /// The nodes that cross into the goal zone on the way from the state.
    fn find_cut(&mut self, state: &[u64]) {
        let graph = Rc::clone(&self.graph);
        self.cut.clear();
        self.agenda.clear();
        let task = self.task;
        for fact in task.facts_of(state).chain(graph.free_facts.iter().copied()) {
            if self.zone[fact.index()] == Zone::Unknown {
                self.zone[fact.index()] = Zone::Before;
                self.agenda.push(fact);
            }
        }
        for &node in &graph.free_nodes {
            self.cross(&graph, node);
        }
        while let Some(fact) = self.agenda.pop() {
            for &node in graph.waiting.row(fact.index()) {
                if self.missing[node as usize] == 0 && self.supporter[node as usize] == fact {
                    self.cross(&graph, node);
                }
            }
        }
    }

    fn cross(&mut self, graph: &Graph, node: u32) {
        let effects = graph.effects.row(node as usize);
        if effects.iter().any(|fact| self.zone[fact.index()] == Zone::Goal) {
            self.cut.push(node);
            return;
        }
        for &fact in effects {
            if self.zone[fact.index()] == Zone::Unknown {
                self.zone[fact.index()] = Zone::Before;
                self.agenda.push(fact);
            }
        }
    }

    /// The estimate; `None` at a dead end.
    pub fn value(&mut self, state: &[u64]) -> Option<u32> {
        self.cost.copy_from_slice(&self.full_cost);
        self.explore(state);
        let mut total = 0u32;
        while let Some(goal) = self.dearest_goal() {
            match self.fact_cost[goal.index()] {
                UNREACHED => return None,
                0 => break,
                _ => {}
            }
            self.mark_goal_zone(goal);
            self.find_cut(state);
            let least = self.cut.iter().map(|&node| self.node_cost(node as usize)).min().unwrap_or(0);
            if least == 0 {
                // Only rounding of saturated costs could bring this about; stopping keeps the sum admissible.
                break;
            }
            total = total.saturating_add(least);
            self.lower(least);
            self.explore_again();
        }
        Some(total)
    }

    /// Lowers the operators of the cut, each once.
    fn lower(&mut self, by: u32) {
        let graph = Rc::clone(&self.graph);
        self.cut.sort_unstable_by_key(|&node| graph.operator_of[node as usize]);
        self.cut.dedup_by_key(|node| graph.operator_of[*node as usize]);
        for &node in &self.cut {
            self.cost[graph.operator_of[node as usize] as usize] -= by;
        }
    }
}

impl Heuristic for LandmarkCut<'_> {
    fn properties(&self) -> Properties {
        Properties { admissible: true, consistent: false, safe: true }
    }

    fn estimate(&mut self, state: &[u64], _preferred: &mut Vec<OperatorId>) -> Estimate {
        self.value(state).map_or(Estimate::DeadEnd, Estimate::Cost)
    }
}
