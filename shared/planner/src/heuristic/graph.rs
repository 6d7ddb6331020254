//! The task without deletes as an and/or graph, shared by everything that reasons on it.

use super::numeric;
use crate::csr::Csr;
use crate::id_table::{IdTable, Slot, hash_words};
use crate::task::{FactId, OperatorId, Task};

/// The mark of "no node" and "no operator".
pub(crate) const NO_NODE: u32 = u32::MAX;

/// All subsets of so many conditions are looked up to find superfluous nodes.
const MAX_SUBSETS_OF: usize = 5;

/// A node is an operator, a conditional effect of one, an axiom, or an operator's effect on a number that
/// brings a comparison nearer to holding: when all its conditions are reached, so
/// are its effects. Effects that no condition and no goal asks for are left out.
#[derive(Debug)]
pub(crate) struct Graph {
    /// The nodes that wait for each fact.
    pub waiting: Csr<u32>,
    /// The same, sorted by how many conditions a node has.
    pub triggers: Triggers,
    pub conditions: Csr<FactId>,
    pub effects: Csr<FactId>,
    /// The operator of each node; [`NO_NODE`] for axioms.
    pub operator_of: Vec<u32>,
    /// Nodes from this one on make comparisons of numbers hold.
    pub first_numeric: u32,
    /// Of these, those that take as many repetitions as the gap of the comparison is wide, with what each
    /// repetition gains, by comparison.
    pub repeated: Vec<(u32, Vec<(u32, f64)>)>,
    pub condition_count: Vec<u32>,
    /// Nodes without conditions.
    pub free_nodes: Vec<u32>,
    /// Facts that are taken to hold always: that a derived atom does not hold.
    pub free_facts: Vec<FactId>,
}

impl Graph {
    /// The graph without conditional effects that are superfluous for reachability.
    pub fn new(task: &Task) -> Self {
        Self::build(task, true)
    }

    /// The graph with everything: an operator already paid for may give an effect that another, cheaper one
    /// gives too, so leaving it out would not keep the cost of relaxed plans.
    pub fn complete(task: &Task) -> Self {
        Self::build(task, false)
    }

    fn build(task: &Task, prune: bool) -> Self {
        let mut wanted = vec![false; task.facts.len()];
        let asked = task.preconditions.items().iter().chain(task.effect_conditions.items());
        for fact in asked.chain(task.axiom_bodies.items()).chain(&task.goal) {
            wanted[fact.index()] = true;
        }
        let mut nodes = Nodes { wanted: &wanted, ..Nodes::default() };
        for index in 0..task.operators.len() {
            let operator = OperatorId(index as u32);
            let precondition = task.preconditions(operator);
            nodes.add(precondition, task.effects(operator), index as u32);
        }
        nodes.add_conditional(&conditional_nodes(task), prune);
        for axiom in &task.axioms {
            nodes.add(task.axiom_bodies.row(axiom.body as usize), &[axiom.head], NO_NODE);
        }
        let first_numeric = nodes.operator_of.len() as u32;
        let mut repeated = Vec::new();
        for (comparison, supports) in numeric::supports(task) {
            let mut by_gain = Vec::new();
            for support in supports {
                let node = nodes.operator_of.len() as u32;
                nodes.add(&support.conditions, &[support.fact], support.operator.0);
                if node as usize == nodes.operator_of.len() {
                    break;
                }
                by_gain.extend(support.gain.map(|gain| (node, gain)));
            }
            if !by_gain.is_empty() {
                repeated.push((comparison, by_gain));
            }
        }
        let Nodes { conditions, effects, operator_of, .. } = nodes.by_condition(first_numeric);
        let count = operator_of.len();
        let pairs =
            (0..count).flat_map(|node| conditions.row(node).iter().map(move |fact| (fact.0, node as u32)));
        let waiting = Csr::from_pairs(task.facts.len(), pairs);
        let condition_count: Vec<u32> = conditions.rows().map(|row| row.len() as u32).collect();
        let derived = &task.variables[task.primary_variables..];
        let triggers = Triggers::new(task.facts.len(), &conditions, &effects);
        Graph {
            waiting,
            triggers,
            free_nodes: (0..count as u32).filter(|&node| condition_count[node as usize] == 0).collect(),
            free_facts: derived.iter().map(|v| v.first).filter(|fact| wanted[fact.index()]).collect(),
            conditions,
            effects,
            operator_of,
            first_numeric,
            repeated,
            condition_count,
        }
    }

    /// How much there is to look at.
    pub fn size(&self) -> usize {
        self.condition_count.len() + self.conditions.items().len() + self.effects.items().len()
    }
}

/// Nodes with more effects are not spread over those.
const MAX_SPREAD: usize = 4;

/// What a fact that was just reached sets off, by how it comes about. Most nodes have one condition or two, and few
/// effects; then there is nothing to count down, and what is looked at lies side by side in memory.
#[derive(Debug, Default)]
pub(crate) struct Triggers {
    /// Effects that need nothing else.
    pub alone: Csr<Spread>,
    /// Effects that need one other fact, and that fact.
    pub in_pairs: Csr<(FactId, Spread)>,
    /// Places in `many`.
    pub among_many: Csr<u32>,
    /// The other nodes, and how many conditions they have.
    pub many: Vec<(u32, u32)>,
}

/// One effect of a node.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spread {
    pub effect: FactId,
    pub node: u32,
}

impl Triggers {
    fn new(facts: usize, conditions: &Csr<FactId>, effects: &Csr<FactId>) -> Self {
        let few = |node: usize| effects.row(node).len() <= MAX_SPREAD;
        let spread = |length: usize| {
            let nodes = (0..conditions.len()).filter(move |&n| conditions.row(n).len() == length && few(n));
            nodes.flat_map(move |node| {
                let of = effects.row(node).iter().map(move |&effect| Spread { effect, node: node as u32 });
                of.map(move |spread| (conditions.row(node), spread))
            })
        };
        let alone = spread(1).map(|(conditions, spread)| (conditions[0].0, spread));
        let pairs = spread(2).flat_map(|(conditions, spread)| {
            [(conditions[0].0, (conditions[1], spread)), (conditions[1].0, (conditions[0], spread))]
        });
        let length = |node: usize| conditions.row(node).len();
        let many = (0..conditions.len()).filter(|&n| length(n) > 2 || length(n) > 0 && !few(n));
        let many: Vec<(u32, u32)> = many.map(|node| (node as u32, length(node) as u32)).collect();
        let members = many.iter().enumerate().flat_map(|(at, &(node, _))| {
            conditions.row(node as usize).iter().map(move |fact| (fact.0, at as u32))
        });
        Triggers {
            alone: Csr::from_pairs(facts, alone),
            in_pairs: Csr::from_pairs(facts, pairs),
            among_many: Csr::from_pairs(facts, members),
            many,
        }
    }
}

/// One conditional effect as a node.
struct Single {
    /// The effect, then the conditions in order.
    row: Vec<FactId>,
    operator: u32,
    cost: u32,
}

fn conditional_nodes(task: &Task) -> Vec<Single> {
    let mut singles = Vec::new();
    for index in 0..task.operators.len() {
        let operator = OperatorId(index as u32);
        for (condition, fact) in task.conditional_effects(operator) {
            let mut row = vec![fact];
            row.extend(task.preconditions(operator).iter().chain(condition));
            row[1..].sort_unstable();
            row.dedup();
            singles.push(Single { row, operator: index as u32, cost: task.operators[index].units });
        }
    }
    singles
}

/// Rows of facts with the least cost of a node of that row.
struct Rows<'a> {
    singles: &'a [Single],
    table: IdTable,
}

impl<'a> Rows<'a> {
    /// Keeps of equal rows the cheapest, of equally cheap ones the first.
    fn new(singles: &'a [Single]) -> Self {
        let mut order: Vec<u32> = (0..singles.len() as u32).collect();
        order.sort_by_key(|&at| singles[at as usize].cost);
        let mut rows = Rows { singles, table: IdTable::default() };
        for id in order {
            let row = &singles[id as usize].row;
            let hash = hash_words(row);
            if let Slot::Free(at) = rows.table.find(hash, |other| singles[other as usize].row == *row) {
                rows.table.insert(at, hash, id, |other| hash_words(&singles[other as usize].row));
            }
        }
        rows
    }

    fn find(&self, row: &[FactId]) -> Option<u32> {
        match self.table.find(hash_words(row), |id| self.singles[id as usize].row == row) {
            Slot::Found(id) => Some(id),
            Slot::Free(_) => None,
        }
    }

    /// Whether another node gives the same effect under fewer conditions, or the same ones, at no more cost.
    fn dominated(&self, at: u32) -> bool {
        let single = &self.singles[at as usize];
        if self.find(&single.row) != Some(at) {
            return true;
        }
        let conditions = single.row.len() - 1;
        if conditions > MAX_SUBSETS_OF {
            return false;
        }
        let mut subset = Vec::with_capacity(conditions + 1);
        (0..(1u32 << conditions) - 1).any(|mask| {
            subset.clear();
            subset.push(single.row[0]);
            subset.extend((0..conditions).filter(|bit| mask >> bit & 1 == 1).map(|bit| single.row[bit + 1]));
            self.find(&subset).is_some_and(|id| self.singles[id as usize].cost <= single.cost)
        })
    }
}

/// The nodes while they are collected.
#[derive(Default)]
struct Nodes<'a> {
    wanted: &'a [bool],
    conditions: Csr<FactId>,
    effects: Csr<FactId>,
    operator_of: Vec<u32>,
}

impl Nodes<'_> {
    /// Adds the nodes, with `prune` without those that others make superfluous: "what the robot holds comes along" is an effect of
    /// going anywhere, and for the relaxed task of going to one place.
    fn add_conditional(&mut self, singles: &[Single], prune: bool) {
        let rows = Rows::new(if prune { singles } else { &[] });
        for (at, single) in singles.iter().enumerate() {
            if self.wanted[single.row[0].index()] && !(prune && rows.dominated(at as u32)) {
                self.add(&single.row[1..], &single.row[..1], single.operator);
            }
        }
    }

    /// The nodes before `end` in the order of their first conditions, so that those that a fact sets off lie
    /// side by side.
    fn by_condition(self, end: u32) -> Self {
        let first = |node: u32| self.conditions.row(node as usize).first().map_or(0, |fact| fact.0);
        let order = Csr::from_pairs(self.wanted.len().max(1), (0..end).map(|node| (first(node), node)));
        let mut sorted = Nodes { wanted: self.wanted, ..Nodes::default() };
        for node in order.items().iter().copied().chain(end..self.operator_of.len() as u32) {
            sorted.conditions.push_row(self.conditions.row(node as usize).iter().copied());
            sorted.effects.push_row(self.effects.row(node as usize).iter().copied());
            sorted.operator_of.push(self.operator_of[node as usize]);
        }
        sorted
    }

    fn add(&mut self, conditions: &[FactId], effects: &[FactId], operator: u32) {
        // Effects that no condition and no goal asks for are not followed.
        if !effects.iter().any(|fact| self.wanted[fact.index()]) {
            return;
        }
        let wanted = self.wanted;
        self.effects.push_row(effects.iter().copied().filter(|fact| wanted[fact.index()]));
        self.conditions.push_row(conditions.iter().copied());
        self.operator_of.push(operator);
    }
}
