//! Landmarks: facts (or small sets of facts, one of which) every plan makes true at some time, and the count
//! of those still to come (Richter & Westphal 2010, "The LAMA planner", sections 4 and 5.1).
//!
//! Facts are found by propagation ([`LandmarkSets`]), sets of facts and the orders by backchaining: what all
//! operators ask for that can be the first to make a landmark true comes directly before it.

use std::collections::HashMap;

use super::graph::Graph;
use super::landmark_sets::LandmarkSets;
use crate::csr::Csr;
use crate::task::{AtomText, FactId, Task};

/// Sets of more facts say too little.
const MAX_DISJUNCTION: usize = 4;
/// The work that backchaining may take, in operators looked at.
const MAX_WORK: usize = 20_000_000;

/// The landmarks and their order.
#[derive(Debug, Default)]
pub(crate) struct LandmarkGraph {
    /// The facts of each landmark.
    pub landmarks: Csr<FactId>,
    /// Landmarks that must be accepted before each one is.
    before: Csr<u32>,
    /// For each landmark those that it must hold directly before (greedy-necessary orders).
    needed_for: Csr<u32>,
    is_goal: Vec<bool>,
    /// Landmarks that hold at first.
    at_first: Vec<bool>,
}

impl LandmarkGraph {
    pub fn new(task: &Task, graph: &Graph) -> Self {
        let mut finder = Finder {
            task,
            graph,
            makers: makers(task, graph),
            found: Vec::new(),
            by_facts: HashMap::new(),
            orders: Vec::new(),
            sets: LandmarkSets::new(task, graph),
            work: 0,
        };
        for &goal in &task.goal {
            finder.add(vec![goal]);
            let before: Vec<FactId> = finder.sets.iter().flat_map(|sets| sets.of(goal)).collect();
            for fact in before {
                if !task.holds(&task.init, fact) && !graph.free_facts.contains(&fact) {
                    finder.add(vec![fact]);
                }
            }
        }
        let mut next = 0;
        while next < finder.found.len() {
            finder.backchain(next as u32);
            next += 1;
        }
        finder.finish()
    }

    /// The number of landmarks.
    pub fn len(&self) -> usize {
        self.is_goal.len()
    }

    /// The bits of all landmarks in a word of accepted ones.
    fn all(&self, word: usize) -> u64 {
        let rest = self.len() - word * 64;
        if rest < 64 { (1 << rest) - 1 } else { u64::MAX }
    }

    fn holds(&self, task: &Task, landmark: usize, state: &[u64]) -> bool {
        self.landmarks.row(landmark).iter().any(|&fact| task.holds(state, fact))
    }
}

/// The nodes that have each fact as an effect.
fn makers(task: &Task, graph: &Graph) -> Csr<u32> {
    let nodes = 0..graph.operator_of.len();
    let pairs = nodes.flat_map(|node| graph.effects.row(node).iter().map(move |fact| (fact.0, node as u32)));
    Csr::from_pairs(task.facts.len(), pairs)
}

struct Finder<'a> {
    task: &'a Task,
    graph: &'a Graph,
    makers: Csr<u32>,
    found: Vec<Vec<FactId>>,
    by_facts: HashMap<Vec<FactId>, u32>,
    /// Pairs of landmarks: the first holds directly before the second first does.
    orders: Vec<(u32, u32)>,
    /// The landmarks of each fact, if the task is not too large.
    sets: Option<LandmarkSets>,
    work: usize,
}

impl Finder<'_> {
    fn add(&mut self, facts: Vec<FactId>) -> u32 {
        if let Some(&known) = self.by_facts.get(&facts) {
            return known;
        }
        let id = self.found.len() as u32;
        self.by_facts.insert(facts.clone(), id);
        self.found.push(facts);
        id
    }

    fn backchain(&mut self, landmark: u32) {
        let facts = self.found[landmark as usize].clone();
        if facts.iter().any(|&fact| self.task.holds(&self.task.init, fact)) || self.work > MAX_WORK {
            return;
        }
        let mut achievers: Vec<u32> = Vec::new();
        for fact in &facts {
            achievers.extend(self.makers.row(fact.index()));
        }
        achievers.sort_unstable();
        achievers.dedup();
        self.work += achievers.len() * facts.len();
        achievers.retain(|&node| self.is_first(node, &facts));
        let Some((&first, rest)) = achievers.split_first() else { return };
        let mut shared = self.graph.conditions.row(first as usize).to_vec();
        for &node in rest {
            let conditions = self.graph.conditions.row(node as usize);
            shared.retain(|fact| conditions.binary_search(fact).is_ok());
        }
        for fact in shared {
            let before = self.add(vec![fact]);
            self.orders.push((before, landmark));
        }
        for set in self.disjunctions(&achievers) {
            let before = self.add(set);
            self.orders.push((before, landmark));
        }
    }

    /// Whether a node can be the first to make one of `facts` true: nothing it asks for needs one of them.
    fn is_first(&self, node: u32, facts: &[FactId]) -> bool {
        let Some(sets) = &self.sets else { return true };
        let conditions = self.graph.conditions.row(node as usize);
        conditions.iter().all(|&c| sets.reached(c) && !facts.iter().any(|&fact| sets.contains(c, fact)))
    }

    /// Small sets of facts of one predicate of which every achiever asks for one.
    fn disjunctions(&self, achievers: &[u32]) -> Vec<Vec<FactId>> {
        if achievers.len() < 2 {
            return Vec::new();
        }
        // For each predicate (in order) the facts asked for and the achievers that ask.
        let mut by_predicate: Vec<(u32, Vec<FactId>, usize, u32)> = Vec::new();
        for (at, &node) in achievers.iter().enumerate() {
            for &fact in self.graph.conditions.row(node as usize) {
                let Some(predicate) = self.predicate(fact) else { continue };
                let entry = match by_predicate.iter_mut().find(|entry| entry.0 == predicate) {
                    Some(entry) => entry,
                    None => {
                        by_predicate.push((predicate, Vec::new(), 0, u32::MAX));
                        by_predicate.last_mut().expect("just pushed")
                    }
                };
                if entry.1.len() <= MAX_DISJUNCTION && !entry.1.contains(&fact) {
                    entry.1.push(fact);
                }
                if entry.3 != at as u32 {
                    entry.3 = at as u32;
                    entry.2 += 1;
                }
            }
        }
        let mut sets = Vec::new();
        for (_, mut facts, asking, _) in by_predicate {
            let fits = (2..=MAX_DISJUNCTION).contains(&facts.len()) && asking == achievers.len();
            if fits && !facts.iter().any(|&fact| self.task.holds(&self.task.init, fact)) {
                facts.sort_unstable();
                // A set with a landmark of its own says nothing new.
                if !facts.iter().any(|&fact| self.by_facts.contains_key(&vec![fact])) {
                    sets.push(facts);
                }
            }
        }
        sets
    }

    fn predicate(&self, fact: FactId) -> Option<u32> {
        let (atom, true) = self.task.facts[fact.index()].atom? else { return None };
        match &self.task.names.atoms[atom as usize] {
            AtomText::Atom { predicate, .. } => Some(*predicate),
            AtomText::Condition(_) => None,
        }
    }

    fn finish(mut self) -> LandmarkGraph {
        let count = self.found.len();
        let is_goal: Vec<bool> =
            self.found.iter().map(|facts| facts.len() == 1 && self.task.goal.contains(&facts[0])).collect();
        let at_first = self
            .found
            .iter()
            .map(|facts| facts.iter().any(|&f| self.task.holds(&self.task.init, f)))
            .collect();
        self.orders.sort_unstable();
        self.orders.dedup();
        let reasonable = self.reasonable_orders(&is_goal);
        let needed_for = Csr::from_pairs(count, self.orders.iter().copied());
        let mut before: Vec<(u32, u32)> = self.orders.iter().map(|&(a, b)| (b, a)).collect();
        before.extend(reasonable.into_iter().map(|(a, b)| (b, a)));
        before.sort_unstable();
        before.dedup();
        let before = Csr::from_pairs(count, before.iter().copied());
        let mut landmarks = Csr::default();
        self.found.into_iter().for_each(|facts| landmarks.push_row(facts));
        LandmarkGraph { landmarks, before, needed_for, is_goal, at_first }
    }

    /// Pairs (a, b) where b, a goal, had better come after a: what must hold directly before a excludes b,
    /// so that b made true first would have to be given up. Orders that would close a cycle are left out.
    fn reasonable_orders(&self, is_goal: &[bool]) -> Vec<(u32, u32)> {
        let variable = |fact: FactId| self.task.facts[fact.index()].variable;
        // A goal by its variable: each variable has one at most.
        let mut goals: HashMap<u32, u32> = HashMap::new();
        for (at, facts) in self.found.iter().enumerate() {
            if is_goal[at] {
                goals.insert(variable(facts[0]), at as u32);
            }
        }
        let mut graph: Vec<Vec<u32>> = vec![Vec::new(); self.found.len()];
        self.orders.iter().for_each(|&(a, b)| graph[a as usize].push(b));
        let mut chosen = Vec::new();
        for &(needed, after) in &self.orders {
            // Only goals, and what leads to them, are ordered: they all have to hold at the end.
            let [fact] = self.found[needed as usize][..] else { continue };
            let Some(&goal) = goals.get(&variable(fact)) else { continue };
            if self.found[goal as usize][0] == fact || goal == after {
                continue;
            }
            if !reaches(&graph, goal, after) {
                graph[after as usize].push(goal);
                chosen.push((after, goal));
            }
        }
        chosen
    }
}

fn reaches(graph: &[Vec<u32>], from: u32, to: u32) -> bool {
    let mut seen = vec![false; graph.len()];
    let mut agenda = vec![from];
    while let Some(at) = agenda.pop() {
        if at == to {
            return true;
        }
        if !std::mem::replace(&mut seen[at as usize], true) {
            agenda.extend(&graph[at as usize]);
        }
    }
    false
}

/// Which landmarks each state's path has accepted, by state number.
#[derive(Debug)]
pub(crate) struct Status {
    words: usize,
    accepted: Vec<u64>,
}

impl Status {
    pub fn new(graph: &LandmarkGraph) -> Self {
        Status { words: graph.len().div_ceil(64), accepted: Vec::new() }
    }

    /// The bytes in use.
    pub fn bytes(&self) -> usize {
        self.accepted.capacity() * 8
    }

    /// Adds the initial state.
    pub fn start(&mut self, graph: &LandmarkGraph) {
        self.accepted = vec![0; self.words];
        for landmark in (0..graph.len()).filter(|&l| graph.at_first[l]) {
            self.accepted[landmark / 64] |= 1 << (landmark % 64);
        }
    }

    /// Adds the next state, reached from state number `parent`.
    pub fn reach(&mut self, task: &Task, graph: &LandmarkGraph, parent: usize, state: &[u64]) {
        let (before, start) = (parent * self.words, self.accepted.len());
        self.accepted.extend_from_within(before..before + self.words);
        for word in 0..self.words {
            let open = !self.accepted[before + word] & graph.all(word);
            for landmark in bits(open).map(|bit| word * 64 + bit) {
                let in_parent = |&l: &u32| self.accepted[before + l as usize / 64] >> (l % 64) & 1 == 1;
                if graph.holds(task, landmark, state) && graph.before.row(landmark).iter().all(in_parent) {
                    self.accepted[start + word] |= 1 << (landmark % 64);
                }
            }
        }
    }

    /// The landmarks still to come in state number `id`: those not accepted, and those accepted but false
    /// and needed again, for the goal or directly before one not accepted.
    pub fn count(&self, task: &Task, graph: &LandmarkGraph, id: usize, state: &[u64]) -> u32 {
        let accepted = &self.accepted[id * self.words..(id + 1) * self.words];
        let is_open = |&l: &u32| accepted[l as usize / 64] >> (l % 64) & 1 == 0;
        let mut count = 0;
        for (word, &accepted) in accepted.iter().enumerate() {
            count += (!accepted & graph.all(word)).count_ones();
            for landmark in bits(accepted).map(|bit| word * 64 + bit) {
                let needed = graph.is_goal[landmark] || graph.needed_for.row(landmark).iter().any(is_open);
                count += u32::from(needed && !graph.holds(task, landmark, state));
            }
        }
        count
    }
}

/// The positions of the bits that are set.
fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < u64::BITS).then_some(bit as usize)
    })
}
