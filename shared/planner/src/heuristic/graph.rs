//! The task without deletes as an and/or graph, shared by everything that reasons on it.

use crate::csr::Csr;
use crate::task::{FactId, OperatorId, Task};

/// The mark of "no node" and "no operator".
pub(crate) const NO_NODE: u32 = u32::MAX;

/// A node is an operator, a conditional effect of one, or an axiom: when all its conditions are reached, so
/// are its effects. Effects that no condition and no goal asks for are left out.
#[derive(Debug)]
pub(crate) struct Graph {
    /// The nodes that wait for each fact.
    pub waiting: Csr<u32>,
    pub conditions: Csr<FactId>,
    pub effects: Csr<FactId>,
    /// The operator of each node; [`NO_NODE`] for axioms.
    pub operator_of: Vec<u32>,
    pub condition_count: Vec<u32>,
    /// Nodes without conditions.
    pub free_nodes: Vec<u32>,
    /// Facts that are taken to hold always: that a derived atom does not hold.
    pub free_facts: Vec<FactId>,
}

impl Graph {
    pub fn new(task: &Task) -> Self {
        let mut wanted = vec![false; task.facts.len()];
        let asked = task.preconditions.items().iter().chain(task.effect_conditions.items());
        for fact in asked.chain(task.axiom_bodies.items()).chain(&task.goal) {
            wanted[fact.index()] = true;
        }
        let mut nodes = Nodes { wanted: &wanted, ..Nodes::default() };
        for index in 0..task.operators.len() {
            let operator = OperatorId(index as u32);
            let precondition = task.preconditions(operator);
            nodes.add(precondition, &[], task.effects(operator), index as u32);
            for (condition, fact) in task.conditional_effects(operator) {
                nodes.add(precondition, condition, &[fact], index as u32);
            }
        }
        for axiom in &task.axioms {
            nodes.add(task.axiom_bodies.row(axiom.body as usize), &[], &[axiom.head], NO_NODE);
        }
        let Nodes { conditions, effects, operator_of, .. } = nodes;
        let count = operator_of.len();
        let pairs =
            (0..count).flat_map(|node| conditions.row(node).iter().map(move |fact| (fact.0, node as u32)));
        let waiting = Csr::from_pairs(task.facts.len(), pairs);
        let condition_count: Vec<u32> = conditions.rows().map(|row| row.len() as u32).collect();
        let derived = &task.variables[task.primary_variables..];
        Graph {
            waiting,
            free_nodes: (0..count as u32).filter(|&node| condition_count[node as usize] == 0).collect(),
            free_facts: derived.iter().map(|v| v.first).filter(|fact| wanted[fact.index()]).collect(),
            conditions,
            effects,
            operator_of,
            condition_count,
        }
    }

    /// How much there is to look at.
    pub fn size(&self) -> usize {
        self.condition_count.len() + self.conditions.items().len() + self.effects.items().len()
    }
}

/// The nodes while they are collected.
#[derive(Default)]
struct Nodes<'a> {
    wanted: &'a [bool],
    conditions: Csr<FactId>,
    effects: Csr<FactId>,
    operator_of: Vec<u32>,
    buffer: Vec<FactId>,
}

impl Nodes<'_> {
    fn add(&mut self, conditions: &[FactId], more: &[FactId], effects: &[FactId], operator: u32) {
        // Effects that no condition and no goal asks for are not followed.
        if !effects.iter().any(|fact| self.wanted[fact.index()]) {
            return;
        }
        let wanted = self.wanted;
        self.effects.push_row(effects.iter().copied().filter(|fact| wanted[fact.index()]));
        self.buffer.clear();
        self.buffer.extend(conditions.iter().chain(more));
        if !more.is_empty() {
            self.buffer.sort_unstable();
            self.buffer.dedup();
        }
        self.conditions.push_row(self.buffer.iter().copied());
        self.operator_of.push(operator);
    }
}
