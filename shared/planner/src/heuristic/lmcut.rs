//! The landmark-cut heuristic (Helmert & Domshlak 2009, "Landmarks, critical paths and abstractions: what's
//! the difference anyway?", section 4). Deviation: costs are lowered by operator, not by node of the
//! relaxed graph, so that the sum stays admissible for operators with conditional effects.

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
    graph: Graph,
    /// The nodes with each fact as an effect.
    makers: Csr<u32>,
    nodes_of: Csr<u32>,
    /// The nodes before anything is reached.
    fresh: Vec<Node>,
    full_cost: Vec<u32>,
    /// What each operator still costs; the last entry is for axioms: nothing.
    cost: Vec<u32>,
    wave: Wave,
    zone: Vec<Zone>,
    agenda: Vec<FactId>,
    /// The operators of the cut.
    cut: Vec<u32>,
    /// The estimate of the state looked at last.
    total: u32,
}

/// What is known of a node of the relaxed graph.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Its place among the costs.
    operator: u32,
    /// Conditions not reached yet.
    missing: u32,
    /// The dearest condition, once all are reached; the first one where there is none.
    supporter: FactId,
    supporter_cost: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Zone {
    Unknown,
    /// The goal follows from it without cost.
    Goal,
    /// Reached from the state without entering the goal zone.
    Before,
}

/// The costs of facts as h_max has them.
#[derive(Debug)]
struct Wave {
    nodes: Vec<Node>,
    fact_cost: Vec<u32>,
    queue: BucketQueue,
}

impl Wave {
    #[inline]
    fn reach(&mut self, fact: FactId, cost: u32) {
        let known = &mut self.fact_cost[fact.index()];
        if cost < *known {
            *known = cost;
            self.queue.push(cost, fact);
        }
    }

    /// Reaches the effects of a node all of whose conditions are.
    #[inline]
    fn fire(&mut self, graph: &Graph, costs: &[u32], node: usize) {
        let Node { operator, supporter_cost, .. } = self.nodes[node];
        let cost = supporter_cost.saturating_add(costs[operator as usize]).min(UNREACHED - 1);
        for &fact in graph.effects.row(node) {
            self.reach(fact, cost);
        }
    }

    /// h_max from scratch.
    fn explore(&mut self, task: &Task, graph: &Graph, fresh: &[Node], costs: &[u32], state: &[u64]) {
        self.fact_cost.fill(UNREACHED);
        self.queue.clear();
        self.nodes.copy_from_slice(fresh);
        task.facts_of(state).for_each(|fact| self.reach(fact, 0));
        graph.free_facts.iter().for_each(|&fact| self.reach(fact, 0));
        for &node in &graph.free_nodes {
            self.fire(graph, costs, node as usize);
        }
        while let Some((cost, fact)) = self.queue.pop() {
            if self.fact_cost[fact.index()] != cost {
                continue;
            }
            for &id in graph.waiting.row(fact.index()) {
                let node = &mut self.nodes[id as usize];
                node.missing -= 1;
                if node.missing == 0 {
                    // Facts come out by rising cost: the last one is the dearest.
                    node.supporter = fact;
                    node.supporter_cost = cost;
                    self.fire(graph, costs, id as usize);
                }
            }
        }
    }

    /// h_max again, after the operators of the cut became cheaper.
    fn explore_again(&mut self, graph: &Graph, nodes_of: &Csr<u32>, costs: &[u32], cut: &[u32]) {
        self.queue.clear();
        for &operator in cut {
            for &node in nodes_of.row(operator as usize) {
                if self.nodes[node as usize].missing == 0 {
                    self.fire(graph, costs, node as usize);
                }
            }
        }
        while let Some((cost, fact)) = self.queue.pop() {
            if self.fact_cost[fact.index()] != cost {
                continue;
            }
            for &id in graph.waiting.row(fact.index()) {
                let node = self.nodes[id as usize];
                if node.supporter != fact || node.missing > 0 || node.supporter_cost <= cost {
                    continue;
                }
                let conditions = graph.conditions.row(id as usize);
                let dearest = conditions.iter().copied().max_by_key(|f| self.fact_cost[f.index()]);
                let Some(supporter) = dearest else { continue };
                let supporter_cost = self.fact_cost[supporter.index()];
                self.nodes[id as usize] = Node { supporter, supporter_cost, ..node };
                if supporter_cost < node.supporter_cost {
                    self.fire(graph, costs, id as usize);
                }
            }
        }
    }
}

impl<'a> LandmarkCut<'a> {
    /// Prepares the heuristic.
    pub fn new(task: &'a Task, costs: Costs) -> Self {
        let operators = (0..task.operators.len() as u32).map(OperatorId);
        Self::with_costs(task, operators.map(|operator| costs.of(task, operator)))
    }

    /// Prepares the heuristic for other costs of the operators, in their order.
    pub fn with_costs(task: &'a Task, costs: impl Iterator<Item = u32>) -> Self {
        let graph = Graph::complete(task);
        let count = graph.operator_of.len();
        let pairs =
            (0..count).flat_map(|node| graph.effects.row(node).iter().map(move |f| (f.0, node as u32)));
        let makers = Csr::from_pairs(task.facts.len(), pairs);
        let real = (0..count).filter(|&node| graph.operator_of[node] != NO_NODE);
        let nodes_of =
            Csr::from_pairs(task.operators.len(), real.map(|node| (graph.operator_of[node], node as u32)));
        let full_cost: Vec<u32> = costs.chain([0]).collect();
        let axioms = task.operators.len() as u32;
        let fresh: Vec<Node> = (0..count)
            .map(|node| Node {
                operator: graph.operator_of[node].min(axioms),
                missing: graph.condition_count[node],
                supporter: graph.conditions.row(node).first().copied().unwrap_or_default(),
                supporter_cost: 0,
            })
            .collect();
        LandmarkCut {
            task,
            makers,
            nodes_of,
            cost: full_cost.clone(),
            full_cost,
            wave: Wave {
                nodes: fresh.clone(),
                fact_cost: vec![UNREACHED; task.facts.len()],
                queue: BucketQueue::default(),
            },
            fresh,
            zone: vec![Zone::Unknown; task.facts.len()],
            agenda: Vec::new(),
            cut: Vec::new(),
            total: 0,
            graph,
        }
    }

    /// Other costs from now on.
    pub(crate) fn set_costs(&mut self, costs: impl Iterator<Item = u32>) {
        self.full_cost.iter_mut().zip(costs).for_each(|(own, cost)| *own = cost);
    }

    /// The operators that were counted for the state looked at last.
    pub(crate) fn counted(&self) -> impl Iterator<Item = OperatorId> {
        let operators = (0..self.task.operators.len() as u32).map(OperatorId);
        operators.filter(|o| self.cost[o.index()] < self.full_cost[o.index()])
    }

    /// The dearest goal: what supports reaching all of them.
    fn dearest_goal(&self) -> Option<FactId> {
        self.task.goal.iter().copied().max_by_key(|fact| self.wave.fact_cost[fact.index()])
    }

    /// Marks what leads to `goal` without cost.
    fn mark_goal_zone(&mut self, goal: FactId) {
        let Self { graph, makers, wave, zone, agenda, cost, .. } = self;
        zone.fill(Zone::Unknown);
        zone[goal.index()] = Zone::Goal;
        agenda.clear();
        agenda.push(goal);
        while let Some(fact) = agenda.pop() {
            for &id in makers.row(fact.index()) {
                let node = wave.nodes[id as usize];
                if cost[node.operator as usize] > 0
                    || node.missing > 0
                    || graph.condition_count[id as usize] == 0
                {
                    continue;
                }
                let zone = &mut zone[node.supporter.index()];
                if *zone == Zone::Unknown {
                    *zone = Zone::Goal;
                    agenda.push(node.supporter);
                }
            }
        }
    }

    /// The operators that cross into the goal zone on the way from the state.
    fn find_cut(&mut self, state: &[u64]) {
        let Self { task, graph, wave, zone, agenda, cut, .. } = self;
        cut.clear();
        agenda.clear();
        for fact in task.facts_of(state).chain(graph.free_facts.iter().copied()) {
            if zone[fact.index()] == Zone::Unknown {
                zone[fact.index()] = Zone::Before;
                agenda.push(fact);
            }
        }
        let mut cross = |id: u32, operator: u32, agenda: &mut Vec<FactId>| {
            let effects = graph.effects.row(id as usize);
            if effects.iter().any(|fact| zone[fact.index()] == Zone::Goal) {
                cut.push(operator);
                return;
            }
            for &fact in effects {
                if zone[fact.index()] == Zone::Unknown {
                    zone[fact.index()] = Zone::Before;
                    agenda.push(fact);
                }
            }
        };
        for &id in &graph.free_nodes {
            cross(id, wave.nodes[id as usize].operator, agenda);
        }
        while let Some(fact) = agenda.pop() {
            for &id in graph.waiting.row(fact.index()) {
                let node = wave.nodes[id as usize];
                if node.supporter == fact && node.missing == 0 {
                    cross(id, node.operator, agenda);
                }
            }
        }
        cut.sort_unstable();
        cut.dedup();
    }

    /// The estimate; `None` at a dead end.
    pub fn value(&mut self, state: &[u64]) -> Option<u32> {
        self.cost.copy_from_slice(&self.full_cost);
        self.wave.explore(self.task, &self.graph, &self.fresh, &self.cost, state);
        self.total = 0;
        while let Some(goal) = self.dearest_goal() {
            match self.wave.fact_cost[goal.index()] {
                UNREACHED => return None,
                0 => break,
                _ => {}
            }
            self.mark_goal_zone(goal);
            self.find_cut(state);
            let least = self.cut.iter().map(|&operator| self.cost[operator as usize]).min().unwrap_or(0);
            if least == 0 {
                // Only rounding of saturated costs could bring this about; stopping keeps the sum admissible.
                break;
            }
            self.total = self.total.saturating_add(least);
            self.cut.iter().for_each(|&operator| self.cost[operator as usize] -= least);
            self.wave.explore_again(&self.graph, &self.nodes_of, &self.cost, &self.cut);
        }
        Some(self.total)
    }
}

impl Heuristic for LandmarkCut<'_> {
    fn properties(&self) -> Properties {
        Properties { admissible: true, consistent: false, safe: true }
    }

    fn estimate(&mut self, state: &[u64], _preferred: &mut Vec<OperatorId>) -> Estimate {
        self.value(state).map_or(Estimate::DeadEnd, Estimate::Cost)
    }

    /// The cuts without the operator are landmarks of the next state too (Pommerening & Helmert 2013,
    /// "Incremental LM-cut", section 3); what the others count is what the operator's cost was lowered by.
    fn bound_after(&self, operator: OperatorId) -> u32 {
        let counted = self.full_cost[operator.index()] - self.cost[operator.index()];
        self.total.saturating_sub(counted)
    }
}
