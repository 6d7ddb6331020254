//! The landmark-cut heuristic (Helmert & Domshlak 2009, "Landmarks, critical paths and abstractions: what's
//! the difference anyway?", section 4). Deviation: costs are lowered by operator, not by node of the
//! relaxed graph, so that the sum stays admissible for operators with conditional effects.

use super::bucket_queue::BucketQueue;
use super::graph::{Graph, NO_NODE};
use super::relaxation::Stamps;
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
    /// The facts of the goal zone.
    goal_zone: Vec<FactId>,
    agenda: Vec<FactId>,
    seen: Stamps,
    /// The operators of the cut.
    cut: Vec<u32>,
    /// The estimate of the state looked at last.
    total: u32,
    /// Its cuts, one after the other: what each counts, how many operators it has, and these.
    cuts: Vec<u32>,
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
    /// Reached through the goal zone only.
    Behind,
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
            goal_zone: Vec::new(),
            agenda: Vec::new(),
            seen: Stamps::new(task.facts.len()),
            cut: Vec::new(),
            total: 0,
            cuts: Vec::new(),
            graph,
        }
    }

    /// Other costs from now on.
    pub(crate) fn set_costs(&mut self, costs: impl Iterator<Item = u32>) {
        self.full_cost.iter_mut().zip(costs).for_each(|(own, cost)| *own = cost);
    }

    /// The dearest goal: what supports reaching all of them. Of several, one that no operator without cost makes: its
    /// zone is itself alone, so its cut has only its own makers and leaves those of other goals to theirs.
    fn dearest_goal(&self) -> Option<FactId> {
        let cost = |fact: &FactId| self.wave.fact_cost[fact.index()];
        let goals = || self.task.goal.iter().copied();
        let dearest = goals().map(|fact| cost(&fact)).max()?;
        let alone = |fact: &FactId| {
            self.makers.row(fact.index()).iter().all(|&id| {
                let node = self.wave.nodes[id as usize];
                self.cost[node.operator as usize] > 0 || node.missing > 0
            })
        };
        let equal = || goals().filter(|fact| cost(fact) == dearest);
        equal().find(alone).or_else(|| equal().next_back())
    }

    /// Marks what leads to `goal` without cost.
    fn mark_goal_zone(&mut self, goal: FactId) {
        let Self { graph, makers, wave, zone, goal_zone, cost, .. } = self;
        zone.fill(Zone::Unknown);
        zone[goal.index()] = Zone::Goal;
        goal_zone.clear();
        goal_zone.push(goal);
        let mut next = 0;
        while let Some(&fact) = goal_zone.get(next) {
            next += 1;
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
                    goal_zone.push(node.supporter);
                }
            }
        }
    }

    /// The operators that cross into the goal zone on the way from the state.
    fn find_cut(&mut self, goal_cost: u32) {
        self.cut.clear();
        for at in 0..self.goal_zone.len() {
            for maker in self.makers.range(self.goal_zone[at].index()) {
                let id = self.makers.items()[maker] as usize;
                let node = self.wave.nodes[id];
                // Those without cost start in the zone.
                if node.missing > 0 || self.cost[node.operator as usize] == 0 {
                    continue;
                }
                if self.graph.condition_count[id] == 0 || self.is_before(node.supporter, goal_cost) {
                    self.cut.push(node.operator);
                }
            }
        }
        self.cut.sort_unstable();
        self.cut.dedup();
    }

    /// Whether a fact outside the goal zone is reached from the state without entering it. All of the zone costs
    /// at least what the goal does, so cheaper facts are reached without it. For the others it is looked for
    /// backwards: what is cheaper is mostly a step or two away.
    fn is_before(&mut self, fact: FactId, goal_cost: u32) -> bool {
        let Self { graph, makers, wave, zone, agenda, seen, .. } = self;
        let known = |zone: Zone, fact: FactId| match zone {
            Zone::Before => Some(true),
            Zone::Goal | Zone::Behind => Some(false),
            Zone::Unknown => (wave.fact_cost[fact.index()] < goal_cost).then_some(true),
        };
        if let Some(known) = known(zone[fact.index()], fact) {
            return known;
        }
        seen.clear();
        seen.mark(fact.index());
        agenda.clear();
        agenda.push(fact);
        let mut next = 0;
        while let Some(&at) = agenda.get(next) {
            next += 1;
            for &id in makers.row(at.index()) {
                let node = wave.nodes[id as usize];
                let from = node.supporter;
                let free = graph.condition_count[id as usize] == 0;
                let start = if free { Some(true) } else { known(zone[from.index()], from) };
                // What enters the zone is in the cut, whatever else it makes true.
                let enters = || graph.effects.row(id as usize).iter().any(|f| zone[f.index()] == Zone::Goal);
                if node.missing > 0 || start == Some(false) || enters() {
                    continue;
                }
                if start == Some(true) {
                    zone[fact.index()] = Zone::Before;
                    return true;
                }
                if seen.mark(from.index()) {
                    agenda.push(from);
                }
            }
        }
        agenda.iter().for_each(|fact| zone[fact.index()] = Zone::Behind);
        false
    }

    /// The estimate; `None` at a dead end.
    pub fn value(&mut self, state: &[u64]) -> Option<u32> {
        self.forget();
        self.go_on(state)
    }

    /// The estimate for the state that `operator` leads to from one with these cuts: those without the operator
    /// are landmarks here too, and only what is missing beside them is looked for (Pommerening & Helmert 2013,
    /// "Incremental LM-cut", section 3).
    fn value_after(&mut self, state: &[u64], cuts: &[u32], operator: OperatorId) -> Option<u32> {
        self.forget();
        let mut rest = cuts;
        while let [least, count, after @ ..] = rest {
            let (cut, after) = after.split_at(*count as usize);
            rest = after;
            if cut.binary_search(&operator.0).is_err() {
                self.count(*least, cut);
            }
        }
        self.go_on(state)
    }

    fn forget(&mut self) {
        self.cost.copy_from_slice(&self.full_cost);
        self.total = 0;
        self.cuts.clear();
    }

    /// Counts a cut.
    fn count(&mut self, least: u32, cut: &[u32]) {
        self.total = self.total.saturating_add(least);
        self.cuts.extend([least, cut.len() as u32]);
        self.cuts.extend_from_slice(cut);
        cut.iter().for_each(|&operator| self.cost[operator as usize] -= least);
    }

    /// Finds cuts until the goal costs nothing more.
    fn go_on(&mut self, state: &[u64]) -> Option<u32> {
        self.wave.explore(self.task, &self.graph, &self.fresh, &self.cost, state);
        while let Some(goal) = self.dearest_goal() {
            let goal_cost = self.wave.fact_cost[goal.index()];
            match goal_cost {
                UNREACHED => return None,
                0 => break,
                _ => {}
            }
            self.mark_goal_zone(goal);
            self.find_cut(goal_cost);
            let least = self.cut.iter().map(|&operator| self.cost[operator as usize]).min().unwrap_or(0);
            if least == 0 {
                // Only rounding of saturated costs could bring this about; stopping keeps the sum admissible.
                break;
            }
            let cut = std::mem::take(&mut self.cut);
            self.count(least, &cut);
            self.cut = cut;
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

    /// The cuts without the operator are landmarks of the next state too; what the others count is what the
    /// operator's cost was lowered by.
    fn bound_after(&self, operator: OperatorId) -> u32 {
        let counted = self.full_cost[operator.index()] - self.cost[operator.index()];
        self.total.saturating_sub(counted)
    }

    fn findings(&self) -> &[u32] {
        &self.cuts
    }

    fn estimate_after(
        &mut self,
        state: &[u64],
        findings: &[u32],
        operator: OperatorId,
        _preferred: &mut Vec<OperatorId>,
    ) -> Estimate {
        self.value_after(state, findings, operator).map_or(Estimate::DeadEnd, Estimate::Cost)
    }
}
