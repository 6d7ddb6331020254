//! A* (Hart, Nilsson & Raphael 1968): with an admissible heuristic the first plan found is a cheapest one.
//! States are opened again when a cheaper way to them is found, so the heuristic need not be consistent.

use std::collections::{BTreeMap, VecDeque};

use super::limits::Meter;
use super::registry::{Registry, StateId};
use super::{Progress, Slice};
use crate::heuristic::{Costs, Estimate, Heuristic};
use crate::successor::Successors;
use crate::task::Task;

/// Searches for a cheapest plan, as the metric counts.
pub(super) fn astar(
    task: &Task,
    successors: &Successors,
    heuristic: &mut dyn Heuristic,
    meter: &mut Meter<'_>,
) -> Slice {
    let mut registry = Registry::new(task);
    let mut preferred = Vec::new();
    let Estimate::Cost(start) = heuristic.estimate(&task.init, &mut preferred) else {
        return Ok(Progress::Exhausted { proof: true });
    };
    let mut costs: Vec<u64> = vec![0];
    let mut estimates = vec![Estimate::Cost(start)];
    // By f, then by h: among equals the one that seems nearest to the goal.
    let mut open: BTreeMap<(u64, u32), VecDeque<(StateId, u64)>> = BTreeMap::new();
    open.entry((u64::from(start), start)).or_default().push_back((StateId(0), 0));
    let mut entries = 1usize;
    let (mut state, mut next, mut applicable) = (task.init.clone(), task.init.clone(), Vec::new());
    while let Some(mut lowest) = open.first_entry() {
        let bound = lowest.key().0;
        let Some((id, cost)) = lowest.get_mut().pop_front() else {
            lowest.remove();
            continue;
        };
        entries -= 1;
        if cost != costs[id.0 as usize] {
            continue;
        }
        state.copy_from_slice(registry.state(id));
        if task.is_goal(&state) {
            return Ok(Progress::Solved(registry.path(id)));
        }
        meter.expand(|| registry.bytes() + entries * 24 + costs.len() * 16)?;
        applicable.clear();
        successors.applicable(task, &state, &mut applicable);
        for &operator in &applicable {
            let cost = cost + u64::from(Costs::Real.of(task, operator));
            task.apply(&state, operator, &mut next);
            let (successor, new) = registry.insert(&next, id, operator);
            let index = successor.0 as usize;
            if new {
                costs.push(cost);
                preferred.clear();
                estimates.push(heuristic.estimate(&next, &mut preferred));
            } else if cost < costs[index] {
                costs[index] = cost;
                registry.set_origin(successor, id, operator);
            } else {
                continue;
            }
            // Nothing left is cheaper than the lowest f.
            if cost <= bound && task.is_goal(&next) {
                return Ok(Progress::Solved(registry.path(successor)));
            }
            if let Estimate::Cost(h) = estimates[index] {
                open.entry((cost + u64::from(h), h)).or_default().push_back((successor, cost));
                entries += 1;
            }
        }
    }
    Ok(Progress::Exhausted { proof: true })
}
