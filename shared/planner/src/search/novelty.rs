//! Best-first width search, BFWS(f5) (Lipovetzky & Geffner 2017, "Best-first width search: exploration and
//! exploitation in classical planning", section 5): states are ordered by novelty, then by the landmarks
//! still to come. A state is novel if it has a fact (or a pair of facts) that no earlier state had among
//! those with the same counts of landmarks to come and of relaxed-plan facts made true since that count
//! last fell. No heuristic is worked out for most states, so many more of them are seen in the same time.

use std::collections::HashMap;

use super::limits::Meter;
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use super::{Progress, Slice};
use crate::heuristic::{LandmarkGraph, Relaxation, Status};
use crate::successor::Successors;
use crate::task::{FactId, OperatorId, Task};

/// The bytes that tables of pairs may take; partitions beyond that see only single facts.
const MAX_PAIR_BYTES: usize = 256 << 20;

/// The mark of a reference that is not worked out yet.
const PENDING: u32 = u32::MAX;

/// One search; it can be run in slices.
pub(super) struct WidthSearch<'a, 't> {
    task: &'t Task,
    successors: &'a Successors,
    landmarks: &'a LandmarkGraph,
    relaxation: Relaxation<'t>,
    /// The largest size of fact sets looked at: 1 or 2.
    width: u32,
    /// States that are not novel are dropped: quick, but no proof when nothing is left.
    prune: bool,
    registry: Registry,
    status: Status,
    nodes: Vec<Node>,
    /// Relaxed-plan facts, sorted, of the states where the count of landmarks fell.
    references: Vec<Vec<FactId>>,
    /// For each state the facts of its reference made true so far, as bits.
    achieved: Vec<u64>,
    partitions: HashMap<(u32, u32), u32>,
    tables: Vec<Table>,
    pair_bytes: usize,
    max_pair_bytes: usize,
    open: OpenList<StateId>,
    /// The variable that each bit of a packed state belongs to.
    variable_of_bit: Vec<u32>,
    applicable: Vec<OperatorId>,
    changed: Vec<FactId>,
    preferred: Vec<OperatorId>,
    started: bool,
}

/// What the search knows of a state.
#[derive(Clone, Copy)]
struct Node {
    landmarks: u32,
    reference: u32,
    /// Where its bits start in `achieved`.
    achieved: u32,
    partition: u32,
}

/// What was seen in one partition.
struct Table {
    facts: Vec<u64>,
    pairs: Vec<u64>,
}

impl<'a, 't> WidthSearch<'a, 't> {
    pub fn new(
        task: &'t Task,
        successors: &'a Successors,
        landmarks: &'a LandmarkGraph,
        relaxation: Relaxation<'t>,
        width: u32,
        prune: bool,
    ) -> Self {
        let mut variable_of_bit = vec![0; task.packed_words() * 64];
        for (index, variable) in task.variables.iter().enumerate() {
            let bits = variable.mask.count_ones();
            let start = variable.word * 64 + variable.shift;
            (start..start + bits).for_each(|bit| variable_of_bit[bit as usize] = index as u32);
        }
        WidthSearch {
            task,
            successors,
            landmarks,
            relaxation,
            width,
            prune,
            registry: Registry::new(task),
            status: Status::new(landmarks),
            nodes: Vec::new(),
            references: Vec::new(),
            achieved: Vec::new(),
            partitions: HashMap::new(),
            tables: Vec::new(),
            pair_bytes: 0,
            max_pair_bytes: 0,
            open: OpenList::default(),
            variable_of_bit,
            applicable: Vec::new(),
            changed: Vec::new(),
            preferred: Vec::new(),
            started: false,
        }
    }

    /// The bytes in use.
    pub fn bytes(&self) -> usize {
        let tables = self.tables.len() * self.task.facts.len() / 8 + self.pair_bytes;
        self.registry.bytes() + self.status.bytes() + self.open.bytes() + tables + self.nodes.capacity() * 16
    }

    /// The states seen so far.
    pub fn seen(&self) -> u64 {
        self.nodes.len() as u64
    }

    /// Goes on for about `slice` states.
    pub fn run(&mut self, mut slice: u64, meter: &mut Meter<'_>) -> Slice {
        let mut state = self.task.init.clone();
        let mut next = state.clone();
        self.max_pair_bytes = MAX_PAIR_BYTES.min(meter.memory_limit() / 4);
        if !std::mem::replace(&mut self.started, true) && self.start() {
            return Ok(Progress::Solved(Vec::new()));
        }
        while slice > 0 {
            let Some((_, id)) = self.open.pop() else {
                return Ok(Progress::Exhausted { proof: !self.prune });
            };
            meter.expand(|| self.bytes())?;
            state.copy_from_slice(self.registry.state(id));
            if self.nodes[id.0 as usize].reference == PENDING && !self.refer(id, &state) {
                continue;
            }
            let mut applicable = std::mem::take(&mut self.applicable);
            applicable.clear();
            self.successors.applicable(self.task, &state, &mut applicable);
            for &operator in &applicable {
                slice = slice.saturating_sub(1);
                self.task.apply(&state, operator, &mut next);
                let (successor, new) = self.registry.insert(&next, id, operator);
                if !new {
                    continue;
                }
                if self.task.is_goal(&next) {
                    return Ok(Progress::Solved(self.registry.path(successor)));
                }
                self.status.reach(self.task, self.landmarks, id.0 as usize, &next);
                self.evaluate(id, successor, &state, &next);
            }
            self.applicable = applicable;
        }
        Ok(Progress::Paused)
    }

    /// Sees the initial state; true if it is a goal.
    fn start(&mut self) -> bool {
        let init = self.task.init.clone();
        self.status.start(self.landmarks);
        let landmarks = self.status.count(self.task, self.landmarks, 0, &init);
        if self.task.is_goal(&init) {
            return true;
        }
        self.nodes.push(Node { landmarks, reference: PENDING, achieved: 0, partition: 0 });
        self.changed.clear();
        self.changed.extend(self.task.facts_of(&init));
        self.partition_of(landmarks, 0);
        self.novelty(0, &init, true);
        self.open.push(0, StateId(0));
        false
    }

    /// Makes the relaxed plan of a state the reference from there on; false at a dead end.
    fn refer(&mut self, id: StateId, state: &[u64]) -> bool {
        self.preferred.clear();
        if self.relaxation.hff(state, &mut self.preferred).is_none() {
            return false;
        }
        let mut facts = self.relaxation.relaxed_facts().to_vec();
        facts.sort_unstable();
        let node = &mut self.nodes[id.0 as usize];
        node.reference = self.references.len() as u32;
        node.achieved = self.achieved.len() as u32;
        self.achieved.resize(self.achieved.len() + facts.len().div_ceil(64), 0);
        self.references.push(facts);
        true
    }

    fn evaluate(&mut self, parent: StateId, id: StateId, state: &[u64], next: &[u64]) {
        let landmarks = self.status.count(self.task, self.landmarks, id.0 as usize, next);
        let from = self.nodes[parent.0 as usize];
        let start = self.achieved.len() as u32;
        self.find_changes(state, next);
        // Where the count falls a new relaxed plan becomes the reference, worked out on expansion.
        let reference = if landmarks < from.landmarks { PENDING } else { from.reference };
        if reference != PENDING {
            let words = self.references[reference as usize].len().div_ceil(64);
            self.achieved.extend_from_within(from.achieved as usize..from.achieved as usize + words);
            for fact in &self.changed {
                if let Ok(at) = self.references[reference as usize].binary_search(fact) {
                    self.achieved[start as usize + at / 64] |= 1 << (at % 64);
                }
            }
        }
        let count: u32 = self.achieved[start as usize..].iter().map(|word| word.count_ones()).sum();
        let partition = self.partition_of(landmarks, count);
        self.nodes.push(Node { landmarks, reference, achieved: start, partition });
        let novelty = self.novelty(partition, next, partition != from.partition);
        if novelty > self.width && self.prune {
            return;
        }
        let most = self.landmarks.len() as u32 + 1;
        self.open.push((novelty - 1) * most + landmarks.min(most - 1), id);
    }

    /// The facts of `next` that do not hold in `state`.
    fn find_changes(&mut self, state: &[u64], next: &[u64]) {
        self.changed.clear();
        let mut last = u32::MAX;
        for (word, (before, after)) in state.iter().zip(next).take(self.task.packed_words()).enumerate() {
            let mut difference = before ^ after;
            while difference != 0 {
                let bit = difference.trailing_zeros();
                difference &= difference - 1;
                let variable = self.variable_of_bit[word * 64 + bit as usize];
                if variable != last {
                    last = variable;
                    self.changed.push(self.task.variables[variable as usize].fact(next));
                }
            }
        }
    }

    fn partition_of(&mut self, landmarks: u32, achieved: u32) -> u32 {
        let facts = self.task.facts.len();
        let tables = &mut self.tables;
        *self.partitions.entry((landmarks, achieved)).or_insert_with(|| {
            tables.push(Table { facts: vec![0; facts.div_ceil(64)], pairs: Vec::new() });
            tables.len() as u32 - 1
        })
    }

    /// The novelty of a state in its partition (one more than the width if it has none); records its facts.
    /// `other`: its parent was in another partition, so that all its facts count, not just the changed ones.
    fn novelty(&mut self, partition: u32, state: &[u64], other: bool) -> u32 {
        let facts = self.task.facts.len();
        let table = &mut self.tables[partition as usize];
        let mut see = |fact: FactId| {
            let word = &mut table.facts[fact.index() / 64];
            let new = *word >> (fact.0 % 64) & 1 == 0;
            *word |= 1 << (fact.0 % 64);
            new
        };
        let mut novel = false;
        if other {
            self.task.facts_of(state).for_each(|fact| novel |= see(fact));
        } else {
            self.changed.iter().for_each(|&fact| novel |= see(fact));
        }
        let mut novelty = if novel { 1 } else { self.width + 1 };
        if self.width >= 2 {
            if table.pairs.is_empty() {
                let bytes = facts * facts / 8;
                if self.pair_bytes + bytes > self.max_pair_bytes {
                    return novelty;
                }
                self.pair_bytes += bytes;
                table.pairs = vec![0; (facts * facts).div_ceil(64)];
            }
            let mut new_pair = false;
            for &a in &self.changed {
                for b in self.task.facts_of(state) {
                    let at = a.0.min(b.0) as usize * facts + a.0.max(b.0) as usize;
                    let word = &mut table.pairs[at / 64];
                    new_pair |= *word >> (at % 64) & 1 == 0;
                    *word |= 1 << (at % 64);
                }
            }
            if new_pair {
                novelty = novelty.min(2);
            }
        }
        novelty
    }
}
