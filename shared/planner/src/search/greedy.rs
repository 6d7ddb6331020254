//! Lazy greedy best-first search with preferred operators and several heuristics: a state is estimated when
//! it is taken from the open list, its successors inherit its estimate; the queues take turns, those for
//! preferred operators favoured after progress (Richter & Helmert 2009, "Preferred operators and deferred
//! evaluation in satisficing planning"; Richter & Westphal 2010, section 5).

use super::limits::{GaveUp, Meter};
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use crate::heuristic::{Estimate, Heuristic, LandmarkGraph, Status};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// How many more choices the preferred queues get after progress.
const BOOST: i64 = 1000;

/// A search's result: a plan, or a proof that there is none.
pub(crate) type Found = Result<Option<Vec<OperatorId>>, GaveUp>;

/// Searches for any plan; `landmarks` are counted as a second estimate.
pub(crate) fn lazy_greedy(
    task: &Task,
    successors: &Successors,
    heuristic: &mut dyn Heuristic,
    landmarks: Option<&LandmarkGraph>,
    meter: &mut Meter<'_>,
) -> Found {
    let pairs = 1 + usize::from(landmarks.is_some());
    Search {
        task,
        successors,
        heuristic,
        landmarks: landmarks.map(|graph| (graph, Status::new(graph))),
        registry: Registry::new(task),
        queues: (0..2 * pairs).map(|_| Queue::default()).collect(),
        best: [u32::MAX; 2],
        preferred: Vec::new(),
        applicable: Vec::new(),
    }
    .run(meter)
}

#[derive(Default)]
struct Queue {
    open: OpenList<(StateId, OperatorId)>,
    /// The queue with the lowest priority is served next.
    priority: i64,
}

struct Search<'a> {
    task: &'a Task,
    successors: &'a Successors,
    heuristic: &'a mut dyn Heuristic,
    landmarks: Option<(&'a LandmarkGraph, Status)>,
    registry: Registry,
    /// For each heuristic a queue of all successors and one of those by preferred operators.
    queues: Vec<Queue>,
    best: [u32; 2],
    preferred: Vec<OperatorId>,
    applicable: Vec<OperatorId>,
}

impl Search<'_> {
    fn run(mut self, meter: &mut Meter<'_>) -> Found {
        let mut next = self.task.init.clone();
        if self.task.is_goal(&next) {
            return Ok(Some(Vec::new()));
        }
        if let Some((graph, status)) = &mut self.landmarks {
            status.start(graph);
        }
        self.expand(StateId(0), &next);
        while let Some((parent, operator)) = self.pop() {
            self.task.apply(self.registry.state(parent), operator, &mut next);
            let (state, new) = self.registry.insert(&next, parent, operator);
            if !new {
                continue;
            }
            if self.task.is_goal(&next) {
                return Ok(Some(self.registry.path(state)));
            }
            if let Some((graph, status)) = &mut self.landmarks {
                status.reach(self.task, graph, parent.0 as usize, &next);
            }
            meter.expand(|| self.bytes())?;
            self.expand(state, &next);
        }
        Ok(None)
    }

    fn bytes(&self) -> usize {
        let open: usize = self.queues.iter().map(|queue| queue.open.bytes()).sum();
        open + self.registry.bytes() + self.landmarks.as_ref().map_or(0, |(_, status)| status.bytes())
    }

    fn pop(&mut self) -> Option<(StateId, OperatorId)> {
        let filled = self.queues.iter_mut().filter(|queue| !queue.open.is_empty());
        let queue = filled.min_by_key(|queue| queue.priority)?;
        queue.priority += 1;
        queue.open.pop().map(|(_, entry)| entry)
    }

    fn expand(&mut self, id: StateId, state: &[u64]) {
        self.preferred.clear();
        let Estimate::Cost(estimate) = self.heuristic.estimate(state, &mut self.preferred) else { return };
        let mut estimates = [estimate, 0];
        if let Some((graph, status)) = &self.landmarks {
            estimates[1] = status.count(self.task, graph, id.0 as usize, state);
        }
        let heuristics = self.queues.len() / 2;
        let mut progress = false;
        for (best, &estimate) in self.best.iter_mut().zip(&estimates[..heuristics]) {
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
