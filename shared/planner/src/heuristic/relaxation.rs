//! Heuristics from the task without deletes: h_max and h_add (Bonet & Geffner 2001, "Planning as heuristic
//! search"), and h_FF, the size of a relaxed plan read off h_add's best supporters (Hoffmann & Nebel 2001,
//! "The FF planning system"; Keyder & Geffner 2008, "Heuristics for planning with action costs revisited").

use std::rc::Rc;

use super::bucket_queue::BucketQueue;
use super::graph::{Graph, NO_NODE, Spread};
use super::{Estimate, Heuristic, Properties};
use crate::task::{FactId, OperatorId, Task};

const UNREACHED: u32 = u32::MAX;

/// An effect on a number counts at most so often.
const MAX_REPETITIONS: f64 = 1e6;

/// What an operator costs to a heuristic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Costs {
    /// One each.
    Unit,
    /// Its own cost.
    Real,
    /// Its own cost plus one, so that free operators count too.
    PlusOne,
}

impl Costs {
    pub(crate) fn of(self, task: &Task, operator: OperatorId) -> u32 {
        let cost = task.operators[operator.index()].units;
        match self {
            Costs::Unit => 1,
            Costs::Real => cost,
            Costs::PlusOne if task.has_costs => cost.saturating_add(1),
            Costs::PlusOne => 1,
        }
    }
}

/// What is known of a fact.
#[derive(Clone, Copy, Debug, Default)]
struct Label {
    cost: u32,
    supporter: u32,
    done: bool,
}

/// What is known of a node with many conditions.
#[derive(Clone, Copy, Debug)]
struct Wait {
    /// Conditions not reached yet.
    missing: u32,
    /// What those reached cost together.
    cost: u32,
}

#[inline]
fn reach(labels: &mut [Label], queue: &mut BucketQueue, fact: FactId, cost: u32, supporter: u32) {
    let label = &mut labels[fact.index()];
    if cost < label.cost {
        *label = Label { cost, supporter, done: false };
        queue.push(cost, fact);
    }
}

/// The delete relaxation of a task, with the work space to evaluate states on it.
#[derive(Debug)]
pub struct Relaxation<'a> {
    task: &'a Task,
    graph: Rc<Graph>,
    /// What the nodes cost by themselves, without repetitions.
    plain: Vec<u32>,
    /// The nodes with many conditions before anything is reached.
    fresh: Vec<Wait>,
    /// What is to be reached: the goal of the task, unless told otherwise.
    goals: Vec<FactId>,
    is_goal: Vec<bool>,
    // The rest is work space, valid for the state evaluated last.
    labels: Vec<Label>,
    /// What the nodes cost by themselves.
    base: Vec<u32>,
    waits: Vec<Wait>,
    queue: BucketQueue,
    marked_facts: Stamps,
    marked_nodes: Stamps,
    marked_operators: Stamps,
    agenda: Vec<FactId>,
    /// The operators of the last relaxed plan.
    relaxed_plan: Vec<OperatorId>,
    /// What it makes true and needs.
    relaxed_facts: Vec<FactId>,
}

impl<'a> Relaxation<'a> {
    /// Builds the relaxation.
    pub fn new(task: &'a Task, costs: Costs) -> Self {
        Self::on(task, Rc::new(Graph::new(task)), costs)
    }

    /// The same on a graph that is there already.
    pub(crate) fn on(task: &'a Task, graph: Rc<Graph>, costs: Costs) -> Self {
        let cost =
            |&operator: &u32| if operator == NO_NODE { 0 } else { costs.of(task, OperatorId(operator)) };
        let count = graph.operator_of.len();
        let mut is_goal = vec![false; task.facts.len()];
        task.goal.iter().for_each(|fact| is_goal[fact.index()] = true);
        let plain: Vec<u32> = graph.operator_of.iter().map(cost).collect();
        let many = graph.triggers.many.iter();
        let fresh: Vec<Wait> = many.map(|&(_, missing)| Wait { missing, cost: 0 }).collect();
        Relaxation {
            task,
            base: plain.clone(),
            plain,
            waits: fresh.clone(),
            fresh,
            labels: vec![Label::default(); task.facts.len()],
            queue: BucketQueue::default(),
            marked_facts: Stamps::new(task.facts.len()),
            marked_nodes: Stamps::new(count),
            marked_operators: Stamps::new(task.operators.len()),
            agenda: Vec::new(),
            relaxed_plan: Vec::new(),
            relaxed_facts: Vec::new(),
            graph,
            goals: task.goal.clone(),
            is_goal,
        }
    }

    /// Other facts to reach from now on, without doubles. Those that no condition and not the task's goal asks for are
    /// left out: nothing leads to them here.
    pub(crate) fn set_goals(&mut self, goals: impl Iterator<Item = FactId>) {
        let (graph, task) = (&self.graph, self.task);
        let is_asked =
            |fact: &FactId| !graph.waiting.row(fact.index()).is_empty() || task.goal.contains(fact);
        self.goals.drain(..).for_each(|fact| self.is_goal[fact.index()] = false);
        self.goals.extend(goals.filter(is_asked));
        self.goals.iter().for_each(|fact| self.is_goal[fact.index()] = true);
    }

    /// What one estimate costs, roughly in nanoseconds.
    pub(crate) fn work(&self) -> u64 {
        2 * self.graph.size() as u64 + 1000
    }

    /// Other costs of operators from now on.
    pub(crate) fn set_costs(&mut self, costs: impl Fn(OperatorId) -> u32) {
        for (cost, &operator) in self.plain.iter_mut().zip(&self.graph.operator_of) {
            if operator != NO_NODE {
                *cost = costs(OperatorId(operator));
            }
        }
        self.base.copy_from_slice(&self.plain);
    }

    /// Works out the costs of facts, until all goals are final or (`exhaustive`) everything is reached.
    /// `MAX`: a node costs as much as its dearest condition; else as all of them together.
    fn propagate<const MAX: bool>(&mut self, state: &[u64], exhaustive: bool) {
        // Plain locals: this loop is where searches spend their time.
        let Self { task, graph, plain, fresh, base, waits, labels, queue, goals, is_goal, .. } = self;
        let graph = &**graph;
        labels.fill(Label { cost: UNREACHED, supporter: NO_NODE, done: false });
        waits.copy_from_slice(fresh);
        if !MAX && !graph.repeated.is_empty() {
            let numeric = graph.first_numeric as usize;
            base[numeric..].copy_from_slice(&plain[numeric..]);
            repeat(task, graph, state, base);
        }
        queue.clear();
        let labels = &mut labels[..];
        let (base, waits) = (&base[..], &mut waits[..]);
        for fact in task.facts_of(state).chain(graph.free_facts.iter().copied()) {
            reach(labels, queue, fact, 0, NO_NODE);
        }
        let fire = |labels: &mut [Label], queue: &mut BucketQueue, node: u32, conditions: u32| {
            let cost = base[node as usize].saturating_add(conditions).min(UNREACHED - 1);
            graph.effects.row(node as usize).iter().for_each(|&fact| reach(labels, queue, fact, cost, node));
        };
        graph.free_nodes.iter().for_each(|&node| fire(labels, queue, node, 0));
        let triggers = &graph.triggers;
        let mut goals = goals.len();
        while let Some((cost, fact)) = queue.pop() {
            if labels[fact.index()].cost != cost || std::mem::replace(&mut labels[fact.index()].done, true) {
                continue;
            }
            if is_goal[fact.index()] {
                goals -= 1;
                if goals == 0 && !exhaustive {
                    return;
                }
            }
            for &Spread { effect, node } in triggers.alone.row(fact.index()) {
                let known = labels[effect.index()].cost;
                if known > cost {
                    let cost = base[node as usize].saturating_add(cost).min(UNREACHED - 1);
                    reach(labels, queue, effect, cost, node);
                }
            }
            for &(other, Spread { effect, node }) in triggers.in_pairs.row(fact.index()) {
                let other = labels[other.index()];
                let known = labels[effect.index()].cost;
                // Facts come out by rising cost, so the last condition of a node is the dearest.
                let cost = if MAX { cost } else { cost.saturating_add(other.cost) };
                if other.done && known > cost {
                    let cost = base[node as usize].saturating_add(cost).min(UNREACHED - 1);
                    reach(labels, queue, effect, cost, node);
                }
            }
            for &at in triggers.among_many.row(fact.index()) {
                let wait = &mut waits[at as usize];
                wait.missing -= 1;
                wait.cost = if MAX { cost } else { wait.cost.saturating_add(cost) };
                if wait.missing == 0 {
                    let cost = wait.cost;
                    fire(labels, queue, triggers.many[at as usize].0, cost);
                }
            }
        }
    }

    /// h_max of a state with this graph's costs; `None` if the goal is out of reach.
    pub fn hmax(&mut self, state: &[u64]) -> Option<u32> {
        self.propagate::<true>(state, false);
        let dearest = self.goals.iter().map(|fact| self.labels[fact.index()].cost).max().unwrap_or(0);
        (dearest != UNREACHED).then_some(dearest)
    }

    /// The goal facts that cannot be reached from a state even if nothing is ever deleted.
    pub fn unreachable_goals(&mut self, state: &[u64]) -> Vec<FactId> {
        self.propagate::<true>(state, true);
        let goal = self.goals.iter();
        goal.copied().filter(|fact| self.labels[fact.index()].cost == UNREACHED).collect()
    }

    /// The operators of the relaxed plan of the state evaluated last.
    pub fn relaxed_plan(&self) -> &[OperatorId] {
        &self.relaxed_plan
    }

    /// The facts that the relaxed plan of the state evaluated last makes true and needs.
    pub(crate) fn relaxed_facts(&self) -> &[FactId] {
        &self.relaxed_facts
    }

    /// h_FF of a state; the relaxed plan is then at [`Relaxation::relaxed_plan`].
    pub fn hff(&mut self, state: &[u64], preferred: &mut Vec<OperatorId>) -> Option<u32> {
        self.propagate::<false>(state, false);
        self.relaxed_plan.clear();
        self.relaxed_facts.clear();
        if self.goals.iter().any(|fact| self.labels[fact.index()].cost == UNREACHED) {
            return None;
        }
        self.marked_facts.clear();
        self.marked_nodes.clear();
        self.marked_operators.clear();
        let mut total = 0u32;
        self.agenda.clear();
        self.agenda.extend_from_slice(&self.goals);
        while let Some(fact) = self.agenda.pop() {
            let node = self.labels[fact.index()].supporter;
            if !self.marked_facts.mark(fact.index()) || node == NO_NODE {
                continue;
            }
            self.relaxed_facts.push(fact);
            if !self.marked_nodes.mark(node as usize) {
                continue;
            }
            self.agenda.extend_from_slice(self.graph.conditions.row(node as usize));
            let operator = self.graph.operator_of[node as usize];
            if operator == NO_NODE {
                continue;
            }
            let again = !self.marked_operators.mark(operator as usize);
            if again && node < self.graph.first_numeric {
                continue;
            }
            total = total.saturating_add(self.base[node as usize]).min(UNREACHED - 1);
            if again {
                continue;
            }
            let operator = OperatorId(operator);
            self.relaxed_plan.push(operator);
            if self.task.applicable(state, operator) {
                preferred.push(operator);
            }
        }
        Some(total)
    }
}

/// Charges nodes that change numbers for as many repetitions as it takes from `state` on (Scala, Haslum &
/// Thiébaux 2016, "Heuristics for numeric planning via subgoaling", section 4).
fn repeat(task: &Task, graph: &Graph, state: &[u64], base: &mut [u32]) {
    for (comparison, by_gain) in &graph.repeated {
        let gap = task.numeric.comparisons[*comparison as usize].1.gap(task.numeric.of(state));
        for &(node, gain) in by_gain {
            let times = (gap / gain).ceil().clamp(1.0, MAX_REPETITIONS);
            let base = &mut base[node as usize];
            // Without a gap (a number without a value) it counts once.
            *base = base.saturating_mul(if times.is_nan() { 1 } else { times as u32 });
        }
    }
}

impl Heuristic for Relaxation<'_> {
    fn properties(&self) -> Properties {
        Properties { admissible: false, consistent: false, safe: true }
    }

    fn estimate(&mut self, state: &[u64], preferred: &mut Vec<OperatorId>) -> Estimate {
        self.hff(state, preferred).map_or(Estimate::DeadEnd, Estimate::Cost)
    }
}

/// Marks that are all forgotten at once.
#[derive(Debug)]
pub(crate) struct Stamps {
    stamps: Vec<u32>,
    now: u32,
}

impl Stamps {
    pub fn new(len: usize) -> Self {
        Stamps { stamps: vec![0; len], now: 1 }
    }

    pub fn clear(&mut self) {
        self.now = self.now.wrapping_add(1);
        if self.now == 0 {
            self.stamps.fill(0);
            self.now = 1;
        }
    }

    /// Marks; false if it was marked already.
    #[inline]
    pub fn mark(&mut self, at: usize) -> bool {
        std::mem::replace(&mut self.stamps[at], self.now) != self.now
    }
}
