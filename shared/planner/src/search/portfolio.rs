//! Which search runs when: slices of searches that are good at different tasks, in a fixed order.

use std::rc::Rc;

use super::greedy::LazyGreedy;
use super::limits::{GaveUp, Meter};
use super::novelty::WidthSearch;
use super::{Progress, Statistics};
use crate::heuristic::{Costs, Graph, LandmarkGraph, Relaxation};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// The work of the first slice, in parts of the relaxed task looked at: some milliseconds.
const FIRST_SLICE: u64 = 4_000_000;

/// Searches until a first plan is found; `None` is a proof that there is none.
pub(super) fn first_plan(
    task: &Task,
    graph: &Rc<Graph>,
    successors: &Successors,
    landmarks: &LandmarkGraph,
    meter: &mut Meter<'_>,
    statistics: &mut Statistics,
) -> Result<Option<Vec<OperatorId>>, GaveUp> {
    statistics.landmarks = landmarks.len();
    let relaxation = || Relaxation::on(task, Rc::clone(graph), Costs::Unit);
    // What a state costs, measured in the same unit (about a nanosecond): h_FF looks at the whole graph,
    // novelty at the variables and the landmarks.
    let greedy_cost = graph.size() as u64 + 500;
    let width_cost = 15 * (task.variables.len() + landmarks.len()) as u64 + 500;
    let mut greedy = LazyGreedy::new(task, successors, landmarks, relaxation());
    let mut slice = FIRST_SLICE;
    let first = greedy.run(slice / greedy_cost + 20, meter)?;
    statistics.work = meter.expanded * greedy_cost;
    if let Some(result) = finished(first) {
        return Ok(result);
    }
    statistics.slice = 1;
    let mut width = WidthSearch::new(task, successors, landmarks, relaxation(), 1, true);
    let quick = width.run(10 * slice / width_cost, meter)?;
    statistics.work += width.seen() * width_cost;
    if let Some(result) = finished(quick) {
        return Ok(result);
    }
    drop(width);
    let mut width = Some(WidthSearch::new(task, successors, landmarks, relaxation(), 2, false));
    loop {
        slice = slice.saturating_mul(4);
        statistics.slice += 1;
        statistics.work = statistics.work.saturating_add(slice);
        meter.reserve(width.as_ref().map_or(0, WidthSearch::bytes));
        match greedy.run(slice / greedy_cost + 20, meter) {
            // Greedy search goes on with all of the memory.
            Err(GaveUp::Memory) if width.is_some() => width = None,
            progress => {
                if let Some(result) = finished(progress?) {
                    return Ok(result);
                }
            }
        }
        statistics.slice += 1;
        meter.reserve(greedy.bytes());
        let Some(search) = &mut width else { continue };
        match search.run(slice / width_cost / 2 + 20, meter) {
            Err(GaveUp::Memory) => width = None,
            progress => {
                if let Some(result) = finished(progress?) {
                    return Ok(result);
                }
            }
        }
    }
}

/// The result, if there is one; searches that pruned prove nothing.
fn finished(progress: Progress) -> Option<Option<Vec<OperatorId>>> {
    match progress {
        Progress::Solved(path) => Some(Some(path)),
        Progress::Exhausted { proof: true } => Some(None),
        Progress::Exhausted { proof: false } | Progress::Paused => None,
    }
}
