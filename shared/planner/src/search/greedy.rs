//! Lazy greedy best-first search with preferred operators and several heuristics: a state is estimated when
//! it is taken from the open list, its successors inherit its estimate; the queues take turns, those for
//! preferred operators favoured after progress (Richter & Helmert 2009, "Preferred operators and deferred
//! evaluation in satisficing planning"; Richter & Westphal 2010, section 5). Where no progress is made the queues are
//! served alike, and one turn in five goes to a successor picked without trusting the estimates.

use super::limits::Meter;
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use super::type_buckets::TypeBuckets;
use super::{Progress, Slice};
use crate::heuristic::{LandmarkGraph, Relaxation, Status};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// How many more choices the preferred queues get after progress.
const BOOST: i64 = 1000;

#[derive(Default)]
struct Queue {
    open: OpenList<(StateId, OperatorId)>,
    /// The queue with the lowest priority is served next.
    priority: i64,
}

/// One search; it can be run in slices.
pub(super) struct LazyGreedy<'a, 't> {
    task: &'t Task,
    successors: &'a Successors,
    heuristic: Relaxation<'t>,
    landmarks: &'a LandmarkGraph,
    status: Status,
    registry: Registry,
    /// For each heuristic a queue of all successors and one of those by preferred operators.
    queues: [Queue; 4],
    /// The expanded states by h_FF and depth, and the priority of picking one of them.
    kinds: TypeBuckets,
    kinds_priority: i64,
    depth: Vec<u32>,
    best: [u32; 2],
    preferred: Vec<OperatorId>,
    applicable: Vec<OperatorId>,
    started: bool,
}

impl<'a, 't> LazyGreedy<'a, 't> {
    /// A search with h_FF and the count of landmarks.
    pub fn new(
        task: &'t Task,
        successors: &'a Successors,
        landmarks: &'a LandmarkGraph,
        heuristic: Relaxation<'t>,
    ) -> Self {
        LazyGreedy {
            task,
            successors,
            heuristic,
            landmarks,
            status: Status::new(landmarks),
            registry: Registry::new(task),
            queues: Default::default(),
            kinds: TypeBuckets::default(),
            kinds_priority: 0,
            depth: vec![0],
            best: [u32::MAX; 2],
            preferred: Vec::new(),
            applicable: Vec::new(),
            started: false,
        }
    }

    /// Goes on for `slice` expansions.
    pub fn run(&mut self, slice: u64, meter: &mut Meter<'_>) -> Slice {
        let mut next = self.task.init.clone();
        if !std::mem::replace(&mut self.started, true) {
            if self.task.is_goal(&next) {
                return Ok(Progress::Solved(Vec::new()));
            }
            self.status.start(self.landmarks);
            self.expand(StateId(0), &next);
        }
        let mut done = 0;
        while done < slice {
            let Some((parent, operator)) = self.pop() else { return Ok(Progress::Exhausted { proof: true }) };
            self.task.apply(self.registry.state(parent), operator, &mut next);
            let (state, new) = self.registry.insert(&next, parent, operator);
            if !new {
                continue;
            }
            self.depth.push(self.depth[parent.0 as usize] + 1);
            if self.task.is_goal(&next) {
                return Ok(Progress::Solved(self.registry.path(state)));
            }
            self.status.reach(self.task, self.landmarks, parent.0 as usize, &next);
            done += 1;
            // The state is expanded in any case: the search may be resumed after it ran out of memory.
            let spent = meter.expand(|| self.bytes());
            self.expand(state, &next);
            spent?;
        }
        Ok(Progress::Paused)
    }

    /// The bytes in use.
    pub fn bytes(&self) -> usize {
        let open: usize = self.queues.iter().map(|queue| queue.open.bytes()).sum();
        let kinds = self.kinds.bytes() + self.depth.capacity() * size_of::<u32>();
        open + self.registry.bytes() + self.status.bytes() + kinds
    }

    /// What to look at next; nothing if all successors of all states were.
    fn pop(&mut self) -> Option<(StateId, OperatorId)> {
        let filled = (0..self.queues.len()).filter(|&at| !self.queues[at].open.is_empty());
        let at = filled.min_by_key(|&at| self.queues[at].priority)?;
        if self.kinds_priority < self.queues[at].priority {
            self.kinds_priority += 1;
            if let Some(picked) = self.pick() {
                return Some(picked);
            }
        }
        let queue = &mut self.queues[at];
        queue.priority += 1;
        queue.open.pop().map(|(_, entry)| entry)
    }

    /// Some successor of some state.
    fn pick(&mut self) -> Option<(StateId, OperatorId)> {
        let state = self.kinds.pick()?;
        self.applicable.clear();
        self.successors.applicable(self.task, self.registry.state(state), &mut self.applicable);
        self.kinds.any(&self.applicable).map(|operator| (state, operator))
    }

    fn expand(&mut self, id: StateId, state: &[u64]) {
        self.preferred.clear();
        let Some(estimate) = self.heuristic.hff(state, &mut self.preferred) else { return };
        let landmarks = self.status.count(self.task, self.landmarks, id.0 as usize, state);
        self.kinds.push((estimate, self.depth[id.0 as usize]), id);
        let estimates = [estimate, landmarks];
        let mut progress = false;
        for (best, &estimate) in self.best.iter_mut().zip(&estimates) {
            progress |= estimate < *best;
            *best = estimate.min(*best);
        }
        self.applicable.clear();
        self.successors.applicable(self.task, state, &mut self.applicable);
        for (pair, &estimate) in self.queues.chunks_mut(2).zip(&estimates) {
            if progress {
                pair[1].priority -= BOOST;
            }
            for &operator in &self.applicable {
                pair[0].open.push(estimate, (id, operator));
            }
            for &operator in &self.preferred {
                pair[1].open.push(estimate, (id, operator));
            }
        }
    }
}
