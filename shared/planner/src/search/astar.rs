//! A* (Hart, Nilsson & Raphael 1968): with an admissible heuristic the first plan found is a cheapest one.
//! States are opened again when a cheaper way to them is found, so the heuristic need not be consistent.
//!
//! A new state goes into the open list with what is known of it already: its parent's estimate less what the
//! operator counted for in it. It is estimated when it comes out, and goes back if it was placed too low (lazy
//! A*; Zhang & Bacchus 2012, "MAXSAT heuristics for cost optimal planning", section 4). States beyond the
//! cheapest plan, most of those generated, are then never estimated.

use std::collections::BTreeMap;

use super::limits::Meter;
use super::registry::{Registry, StateId};
use super::{Progress, Slice};
use crate::heuristic::{Costs, Estimate, Heuristic};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};

/// What the search knows of a state.
#[derive(Clone, Copy)]
struct Node {
    /// The cost of the cheapest way to it.
    cost: u64,
    /// The goal is at least so far.
    bound: u32,
    /// Where what estimating it said of its successors is kept.
    kept: usize,
    /// Where the heuristic's findings on it are kept.
    findings: usize,
}

const NOT_ESTIMATED: usize = usize::MAX;
const NO_FINDINGS: usize = usize::MAX;
/// The part of the memory limit that findings may take; states beyond that are estimated from nothing.
const FINDINGS_PART: usize = 3;

/// The heuristic's findings on states, each after its length.
struct Findings {
    words: Vec<u32>,
    most: usize,
}

impl Findings {
    fn keep(&mut self, findings: &[u32]) -> usize {
        let start = self.words.len();
        if findings.is_empty() || (start + findings.len()) * size_of::<u32>() > self.most {
            return NO_FINDINGS;
        }
        self.words.push(findings.len() as u32);
        self.words.extend_from_slice(findings);
        start
    }

    fn at(&self, start: usize) -> &[u32] {
        &self.words[start + 1..start + 1 + self.words[start] as usize]
    }

    fn bytes(&self) -> usize {
        self.words.capacity() * size_of::<u32>()
    }
}

impl Node {
    fn f(self) -> u64 {
        self.cost + u64::from(self.bound)
    }
}

/// States by f, then by h: among equals the one that seems nearest to the goal, then the newest. An entry
/// holds the cost at which it was made.
#[derive(Default)]
struct Open {
    buckets: BTreeMap<(u64, u32), Vec<(StateId, u64)>>,
    len: usize,
}

impl Open {
    fn push(&mut self, id: StateId, node: Node) {
        self.buckets.entry((node.f(), node.bound)).or_default().push((id, node.cost));
        self.len += 1;
    }

    /// The bytes in use, roughly.
    fn bytes(&self) -> usize {
        self.len * size_of::<(StateId, u64)>() * 3 / 2
    }

    /// The first entry with its f.
    fn pop(&mut self) -> Option<(u64, StateId, u64)> {
        loop {
            let mut lowest = self.buckets.first_entry()?;
            match lowest.get_mut().pop() {
                Some((id, cost)) => {
                    self.len -= 1;
                    return Some((lowest.key().0, id, cost));
                }
                None => {
                    lowest.remove();
                }
            }
        }
    }
}

/// Searches for a cheapest plan, as the metric counts.
pub(super) fn astar(
    task: &Task,
    successors: &Successors,
    heuristic: &mut dyn Heuristic,
    meter: &mut Meter<'_>,
) -> Slice {
    let mut registry = Registry::new(task);
    let mut nodes = vec![Node { cost: 0, bound: 0, kept: NOT_ESTIMATED, findings: NO_FINDINGS }];
    let mut open = Open::default();
    open.push(StateId(0), nodes[0]);
    // What estimating a state said of its successors, kept for states that went back into the open list.
    let mut kept: Vec<u32> = Vec::new();
    let mut findings = Findings { words: Vec::new(), most: meter.memory_limit() / FINDINGS_PART };
    let (mut state, mut next) = (task.init.clone(), task.init.clone());
    let (mut applicable, mut bounds, mut preferred) = (Vec::<OperatorId>::new(), Vec::new(), Vec::new());
    while let Some((f, id, cost)) = open.pop() {
        let mut node = nodes[id.0 as usize];
        if cost != node.cost {
            continue;
        }
        if node.f() > f {
            open.push(id, node);
            continue;
        }
        state.copy_from_slice(registry.state(id));
        if task.is_goal(&state) {
            return Ok(Progress::Solved(registry.path(id)));
        }
        let bytes = nodes.capacity() * size_of::<Node>()
            + kept.capacity() * size_of::<u32>()
            + open.bytes()
            + findings.bytes();
        applicable.clear();
        successors.applicable(task, &state, &mut applicable);
        bounds.clear();
        if node.kept == NOT_ESTIMATED {
            meter.check(|| registry.bytes() + bytes)?;
            preferred.clear();
            let before = registry.origin(id).map(|(parent, by)| (nodes[parent.0 as usize].findings, by));
            let estimate = match before {
                Some((at, by)) if at != NO_FINDINGS => {
                    heuristic.estimate_after(&state, findings.at(at), by, &mut preferred)
                }
                _ => heuristic.estimate(&state, &mut preferred),
            };
            let Estimate::Cost(estimate) = estimate else { continue };
            node.findings = findings.keep(heuristic.findings());
            bounds.extend(applicable.iter().map(|&operator| heuristic.bound_after(operator)));
            node.bound = node.bound.max(estimate);
            if node.f() > f {
                node.kept = kept.len();
                kept.extend_from_slice(&bounds);
                open.push(id, node);
            }
            nodes[id.0 as usize] = node;
            if node.f() > f {
                continue;
            }
        } else {
            bounds.extend_from_slice(&kept[node.kept..node.kept + applicable.len()]);
        }
        meter.expand(|| registry.bytes() + bytes)?;
        for (&operator, &bound) in applicable.iter().zip(&bounds) {
            let units = Costs::Real.of(task, operator);
            let cost = node.cost + u64::from(units);
            task.apply(&state, operator, &mut next);
            let (successor, new) = registry.insert(&next, id, operator);
            let bound = bound.max(node.bound.saturating_sub(units));
            if new {
                nodes.push(Node { cost, bound, kept: NOT_ESTIMATED, findings: NO_FINDINGS });
            } else {
                let known = &mut nodes[successor.0 as usize];
                known.bound = known.bound.max(bound);
                if cost >= known.cost {
                    continue;
                }
                known.cost = cost;
                registry.set_origin(successor, id, operator);
            }
            // Nothing left is cheaper than the lowest f.
            if cost <= f && task.is_goal(&next) {
                return Ok(Progress::Solved(registry.path(successor)));
            }
            open.push(successor, nodes[successor.0 as usize]);
        }
    }
    Ok(Progress::Exhausted { proof: true })
}
