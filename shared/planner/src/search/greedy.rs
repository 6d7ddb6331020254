//! Lazy greedy best-first search with preferred operators: a state is estimated when it is taken from the
//! open list, its successors inherit its estimate; two queues, one of them for preferred operators and
//! favoured after progress (Richter & Helmert 2009, "Preferred operators and deferred evaluation in
//! satisficing planning").

use super::limits::{GaveUp, Meter};
use super::open_list::OpenList;
use super::registry::{Registry, StateId};
use crate::heuristic::{Estimate, Heuristic};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// How many more choices the preferred queue gets after progress.
const BOOST: i64 = 1000;

/// A search's result: a plan, or a proof that there is none.
pub(crate) type Found = Result<Option<Vec<OperatorId>>, GaveUp>;

/// Searches for any plan.
pub(crate) fn lazy_greedy(
    task: &Task,
    successors: &Successors,
    heuristic: &mut dyn Heuristic,
    meter: &mut Meter<'_>,
) -> Found {
    Search {
        task,
        successors,
        heuristic,
        registry: Registry::new(task),
        queues: [Queue::default(), Queue::default()],
        best: u32::MAX,
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
    registry: Registry,
    /// All successors, and those by preferred operators.
    queues: [Queue; 2],
    best: u32,
    preferred: Vec<OperatorId>,
    applicable: Vec<OperatorId>,
}

impl Search<'_> {
    fn run(mut self, meter: &mut Meter<'_>) -> Found {
        let mut next = self.task.init.clone();
        if self.task.is_goal(&next) {
            return Ok(Some(Vec::new()));
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
            let (registry, queues) = (&self.registry, &self.queues);
            meter.expand(|| registry.bytes() + queues.iter().map(|q| q.open.bytes()).sum::<usize>())?;
            self.expand(state, &next);
        }
        Ok(None)
    }

    fn pop(&mut self) -> Option<(StateId, OperatorId)> {
        let [all, preferred] = &mut self.queues;
        let first =
            if preferred.open.is_empty() || (!all.open.is_empty() && all.priority <= preferred.priority) {
                all
            } else {
                preferred
            };
        first.priority += 1;
        first.open.pop().map(|(_, entry)| entry)
    }

    fn expand(&mut self, id: StateId, state: &[u64]) {
        self.preferred.clear();
        let Estimate::Cost(estimate) = self.heuristic.estimate(state, &mut self.preferred) else { return };
        if estimate < self.best {
            self.best = estimate;
            self.queues[1].priority -= BOOST;
        }
        self.applicable.clear();
        self.successors.applicable(self.task, state, &mut self.applicable);
        for &operator in &self.applicable {
            self.queues[0].open.push(estimate, (id, operator));
        }
        for &operator in &self.preferred {
            self.queues[1].open.push(estimate, (id, operator));
        }
    }
}
