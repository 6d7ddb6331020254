//! Searching for plans.

mod anytime;
mod astar;
mod conflict;
mod greedy;
mod improve;
mod limits;
mod novelty;
mod open_list;
mod portfolio;
mod projection;
mod registry;
mod regression;
mod spread;
mod type_buckets;
mod windows;

use std::rc::Rc;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Domain, Problem};

pub use anytime::{Anytime, solve_anytime};
pub use conflict::never_together;
pub(crate) use improve::eliminate;
pub(crate) use limits::Meter;
pub use limits::{Countdown, GaveUp, Limits, Outcome, Unsolvable};
pub use spread::spread;
pub(crate) use spread::{Errand, Spreader};

use crate::ground::{GroundError, ground};
use crate::heuristic::{Blind, Costs, Graph, Heuristic, LandmarkCut, LandmarkGraph, Relaxation};
use crate::successor::Successors;
use crate::task::{OperatorId, Task};
use improve::{Effort, Improver};

/// How far a search came in its slice.
enum Progress {
    Solved(Vec<OperatorId>),
    /// Nothing is left to look at. A proof that there is no plan only if nothing was pruned.
    Exhausted {
        proof: bool,
    },
    Paused,
}

type Slice = Result<Progress, GaveUp>;

/// How to search.
#[derive(Clone, Debug, Default)]
pub struct SearchOptions {
    /// Which search.
    pub engine: Engine,
    /// States estimated to make the first plan better; zero: only useless actions are dropped. `None`: about half
    /// as much again as finding it took.
    pub improvement: Option<u64>,
}

/// The searches there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// A plan soon: greedy search with h_FF and landmarks in turns with novelty search, then improvement.
    #[default]
    Portfolio,
    /// A cheapest plan: A* with the landmark-cut heuristic.
    AstarLmcut,
    /// A cheapest plan: uniform-cost search.
    AstarBlind,
}

impl Engine {
    /// Every engine with the name it has on command lines.
    pub const ALL: [(&'static str, Engine); 3] = [
        ("portfolio", Engine::Portfolio),
        ("astar-lmcut", Engine::AstarLmcut),
        ("astar-blind", Engine::AstarBlind),
    ];

    /// The engine of a name.
    pub fn named(name: &str) -> Option<Engine> {
        Engine::ALL.iter().find(|(known, _)| *known == name).map(|&(_, engine)| engine)
    }
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Statistics {
    /// Expanded states until the first plan.
    pub expanded: u64,
    /// The same in work, roughly nanoseconds.
    pub work: u64,
    /// Landmarks found.
    pub landmarks: usize,
    /// Which search found it: the number of the slice.
    pub slice: u32,
    /// The parts of the relaxed task.
    pub parts: usize,
    /// The cost of the first plan.
    pub first_cost: f64,
}

/// Searches for a plan.
pub fn solve(task: &Task, options: &SearchOptions, limits: &Limits, cancel: &AtomicBool) -> Outcome {
    solve_with_statistics(task, options, limits, cancel, &mut Statistics::default())
}

/// Searches for a plan and says how it went.
pub fn solve_with_statistics(
    task: &Task,
    options: &SearchOptions,
    limits: &Limits,
    cancel: &AtomicBool,
    statistics: &mut Statistics,
) -> Outcome {
    let Prepared { graph, successors } = match prepare(task) {
        Ok(prepared) => prepared,
        Err(reason) => return Outcome::Unsolvable(reason),
    };
    statistics.parts = graph.size();
    let mut meter = Meter::new(limits, cancel);
    let landmarks = match options.engine {
        Engine::Portfolio => LandmarkGraph::new(task, &graph),
        Engine::AstarLmcut | Engine::AstarBlind => LandmarkGraph::default(),
    };
    let optimal = |heuristic: &mut dyn Heuristic, meter: &mut Meter<'_>| {
        astar::astar(task, &successors, heuristic, meter).map(|progress| match progress {
            Progress::Solved(path) => Some(path),
            Progress::Exhausted { .. } | Progress::Paused => None,
        })
    };
    let found = match options.engine {
        Engine::Portfolio => {
            portfolio::first_plan(task, &graph, &successors, &landmarks, &mut meter, statistics)
        }
        Engine::AstarLmcut => optimal(&mut LandmarkCut::new(task, Costs::Real), &mut meter),
        Engine::AstarBlind => optimal(&mut Blind, &mut meter),
    };
    statistics.expanded = meter.expanded;
    match found {
        Ok(Some(path)) if options.engine != Engine::Portfolio => Outcome::Found(task.plan(&path)),
        Err(reason) if reason != GaveUp::Cancelled && projection::is_out_of_reach(task) => {
            Outcome::Unsolvable(Unsolvable::OnAPart)
        }
        Err(reason) => Outcome::GaveUp(reason),
        Ok(None) => Outcome::Unsolvable(Unsolvable::Exhausted),
        Ok(Some(path)) => {
            statistics.first_cost = path.iter().map(|&o| task.operators[o.index()].cost).sum();
            let improver = Improver { task, graph: &graph, successors: &successors };
            let effort = options.improvement.map_or(Effort::Share(statistics.work), Effort::States);
            let path = improver.improve(path, effort, &mut meter);
            Outcome::Found(task.plan(&path))
        }
    }
}

/// What every search needs.
struct Prepared {
    graph: Rc<Graph>,
    successors: Successors,
}

/// Prepares a search, unless a part of the goal is out of reach.
fn prepare(task: &Task) -> Result<Prepared, Unsolvable> {
    if !task.impossible.is_empty() {
        return Err(Unsolvable::Unreachable(task.impossible.clone()));
    }
    let graph = Rc::new(Graph::new(task));
    let unreachable = Relaxation::on(task, Rc::clone(&graph), Costs::Unit).unreachable_goals(&task.init);
    if !unreachable.is_empty() {
        return Err(Unsolvable::Unreachable(
            unreachable.into_iter().map(|fact| task.fact_text(fact)).collect(),
        ));
    }
    Ok(Prepared { graph, successors: Successors::new(task) })
}

/// Grounds a task and searches with the default options.
pub fn plan(
    domain: &Domain,
    problem: &Problem,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Result<Outcome, GroundError> {
    plan_with(domain, problem, &SearchOptions::default(), limits, cancel)
}

/// Grounds a task and searches.
pub fn plan_with(
    domain: &Domain,
    problem: &Problem,
    options: &SearchOptions,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Result<Outcome, GroundError> {
    let grounding = limits.for_grounding(cancel);
    match ground(domain, problem, &grounding) {
        Ok(task) => Ok(solve(&task, options, &limits.after(&grounding), cancel)),
        Err(GroundError::GaveUp(reason)) => Ok(Outcome::GaveUp(reason)),
        Err(error) => Err(error),
    }
}

/// h_FF of the initial state with every action at cost one: how many actions a relaxed plan has. `None` if
/// the goal is out of reach.
pub fn relaxed_plan_cost(task: &Task) -> Option<u32> {
    if !task.impossible.is_empty() {
        return None;
    }
    Relaxation::new(task, Costs::Unit).hff(&task.init, &mut Vec::new())
}

/// h_max of the initial state with every action at cost one: no schedule of the task takes fewer steps.
/// `None` if the goal is out of reach.
pub fn hmax_unit(task: &Task) -> Option<u32> {
    if !task.impossible.is_empty() {
        return None;
    }
    Relaxation::new(task, Costs::Unit).hmax(&task.init)
}
