//! For every fact of the task without deletes the facts that come true before it whatever one does: all its
//! landmarks there, found by label propagation (Zhu & Givan 2003, "Landmark extraction via planning graph
//! propagation"; Keyder, Richter & Helmert 2010, "Sound and complete landmarks for and/or graphs", section 3).

use std::collections::VecDeque;

use super::graph::Graph;
use crate::task::{FactId, Task};

/// The bytes that the sets may take.
const MAX_BYTES: usize = 64 << 20;
/// The work that finding them may take, in words of sets: some tenths of a second.
const MAX_WORK: usize = 800_000_000;

/// A set of facts for each fact.
pub(super) struct LandmarkSets {
    /// The words of one set.
    words: usize,
    sets: Vec<u64>,
    reached: Vec<bool>,
}

impl LandmarkSets {
    /// The sets from the initial state; `None` where they would take too much time or memory.
    pub fn new(task: &Task, graph: &Graph) -> Option<Self> {
        let facts = task.facts.len();
        let words = facts.div_ceil(64);
        if facts * words * size_of::<u64>() > MAX_BYTES {
            return None;
        }
        let sets = LandmarkSets { words, sets: vec![0; facts * words], reached: vec![false; facts] };
        let missing = graph.condition_count.clone();
        let queued = vec![false; missing.len()];
        Propagation { graph, sets, missing, queue: VecDeque::new(), queued }.run(task)
    }

    /// Whether `landmark` comes true before `fact` does, or is the fact.
    pub fn contains(&self, fact: FactId, landmark: FactId) -> bool {
        self.row(fact)[landmark.index() / 64] >> (landmark.0 % 64) & 1 == 1
    }

    /// Whether a fact can come true at all.
    pub fn reached(&self, fact: FactId) -> bool {
        self.reached[fact.index()]
    }

    /// The landmarks of a fact, itself included.
    pub fn of(&self, fact: FactId) -> impl Iterator<Item = FactId> {
        let bits = |(word, &set): (usize, &u64)| {
            (0..64).filter(move |bit| set >> bit & 1 == 1).map(move |bit| FactId(word as u32 * 64 + bit))
        };
        self.row(fact).iter().enumerate().flat_map(bits)
    }

    fn row(&self, fact: FactId) -> &[u64] {
        &self.sets[fact.index() * self.words..(fact.index() + 1) * self.words]
    }
}

/// Lowers the sets from "everything" to the greatest fixpoint; the order of work does not matter for it.
struct Propagation<'a> {
    graph: &'a Graph,
    sets: LandmarkSets,
    /// Conditions of each node that are not reached yet.
    missing: Vec<u32>,
    /// Nodes whose effects may have fewer landmarks than thought.
    queue: VecDeque<u32>,
    queued: Vec<bool>,
}

impl Propagation<'_> {
    fn run(mut self, task: &Task) -> Option<LandmarkSets> {
        self.queue.extend(&self.graph.free_nodes);
        for fact in task.facts_of(&task.init).chain(self.graph.free_facts.iter().copied()) {
            if !self.sets.reached[fact.index()] {
                self.reach(fact, &vec![0; self.sets.words]);
            }
        }
        let mut before = vec![0; self.sets.words];
        let mut work = 0;
        while let Some(node) = self.queue.pop_front() {
            self.queued[node as usize] = false;
            let conditions = self.graph.conditions.row(node as usize);
            let effects = self.graph.effects.row(node as usize);
            work += (conditions.len() + effects.len()) * self.sets.words;
            if work > MAX_WORK {
                return None;
            }
            before.fill(0);
            for &condition in conditions {
                before.iter_mut().zip(self.sets.row(condition)).for_each(|(word, of)| *word |= of);
            }
            for &effect in effects {
                if self.sets.reached[effect.index()] {
                    self.narrow(effect, &before);
                } else {
                    self.reach(effect, &before);
                }
            }
        }
        Some(self.sets)
    }

    /// A fact is reached for the first time, with these landmarks and itself.
    fn reach(&mut self, fact: FactId, before: &[u64]) {
        let start = fact.index() * self.sets.words;
        self.sets.sets[start..start + self.sets.words].copy_from_slice(before);
        self.sets.sets[start + fact.index() / 64] |= 1 << (fact.0 % 64);
        self.sets.reached[fact.index()] = true;
        for &node in self.graph.waiting.row(fact.index()) {
            self.missing[node as usize] -= 1;
            self.look_at(node);
        }
    }

    /// There is a way to a fact with only these landmarks.
    fn narrow(&mut self, fact: FactId, before: &[u64]) {
        let start = fact.index() * self.sets.words;
        let own = fact.index() / 64;
        let mut removed = 0;
        for (at, (word, before)) in
            self.sets.sets[start..start + self.sets.words].iter_mut().zip(before).enumerate()
        {
            let kept = before | if at == own { 1 << (fact.0 % 64) } else { 0 };
            removed |= *word & !kept;
            *word &= kept;
        }
        if removed != 0 {
            for &node in self.graph.waiting.row(fact.index()) {
                self.look_at(node);
            }
        }
    }

    fn look_at(&mut self, node: u32) {
        if self.missing[node as usize] == 0 && !std::mem::replace(&mut self.queued[node as usize], true) {
            self.queue.push_back(node);
        }
    }
}
