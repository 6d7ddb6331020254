//! Better and better plans until nobody waits any more: restarting weighted A* (Richter, Thayer & Ruml 2010,
//! "The joy of forgetting: faster anytime search via restarting"), as LAMA does it.

use std::rc::Rc;
use std::sync::atomic::AtomicBool;

use super::improve::{Effort, Improvement, Improver, Step, cost, eliminate};
use super::limits::{Limits, Meter, Outcome, Unsolvable};
use super::{Prepared, Statistics, portfolio, prepare};
use crate::heuristic::{Costs, LandmarkGraph, Relaxation};
use crate::plan::Plan;
use crate::task::{OperatorId, Task};

/// The weights of h_FF, from quick to thorough. Only the last one is searched to the end.
const WEIGHTS: [u64; 4] = [5, 3, 2, 1];

/// How a search for better plans ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Anytime {
    /// The best plan found, or why there is none.
    pub outcome: Outcome,
    /// Whether it is proved that no plan is cheaper.
    pub optimal: bool,
}

/// Searches until the best plan is proved to be one or the limits are reached. `better` is called with each
/// plan that is cheaper than all before.
pub fn solve_anytime(
    task: &Task,
    limits: &Limits,
    cancel: &AtomicBool,
    better: &mut dyn FnMut(&Plan),
) -> Anytime {
    let prepared = match prepare(task) {
        Ok(prepared) => prepared,
        Err(reason) => return Anytime { outcome: Outcome::Unsolvable(reason), optimal: false },
    };
    let mut meter = Meter::new(limits, cancel);
    let Prepared { graph, successors } = &prepared;
    let mut statistics = Statistics::default();
    let first = portfolio::first_plan(
        task,
        graph,
        successors,
        &LandmarkGraph::new(task, graph),
        &mut meter,
        &mut statistics,
    );
    let mut best: Vec<OperatorId> = match first {
        Ok(Some(path)) => eliminate(task, path),
        Ok(None) => {
            return Anytime { outcome: Outcome::Unsolvable(Unsolvable::Exhausted), optimal: false };
        }
        Err(reason) => return Anytime { outcome: Outcome::GaveUp(reason), optimal: false },
    };
    let mut plan = task.plan(&best);
    better(&plan);
    let effort = Effort::Share(statistics.work);
    best = Improver { task, graph, successors }.improve(best, effort, &mut meter);
    let improved = task.plan(&best);
    if improved.cost < plan.cost {
        plan = improved;
        better(&plan);
    }
    let mut relaxation = Relaxation::on(task, Rc::clone(graph), Costs::PlusOne);
    let mut weights = WEIGHTS.into_iter();
    let mut weight = weights.next().unwrap_or(1);
    let mut optimal = false;
    let mut unlimited = u64::MAX;
    loop {
        let search = Improvement {
            task,
            successors,
            relaxation: &mut relaxation,
            weight,
            costs: Costs::Real,
            bound: cost(task, Costs::Real, &best),
            left: &mut unlimited,
        };
        match search.run(&mut meter) {
            Step::Better(path) => {
                best = eliminate(task, path);
                plan = task.plan(&best);
                better(&plan);
                weight = weights.next().unwrap_or(1);
            }
            // Only states that cost too much already and dead ends were left out.
            Step::Nothing => {
                optimal = true;
                break;
            }
            Step::Stopped => break,
        }
    }
    Anytime { outcome: Outcome::Found(plan), optimal }
}
