//! A lower bound of the team's makespan: no plan of any team member order can be shorter.

use std::collections::BTreeSet;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::heuristic::{Costs, Estimate, Heuristic, LandmarkCut};

use crate::problem::joint_problem;
use crate::team::Team;

/// The larger of two admissible bounds:
///
/// - the depth of the relaxed plan of the whole team (h_max with unit costs, Bonet & Geffner, "Planning as
///   heuristic search", AIJ 129, 2001): in every time step each robot does at most one action, and without
///   deletes nothing gets in the way;
/// - the work, shared out: the landmark cut (Helmert & Domshlak, ICAPS 2009) bounds the number of actions of any
///   plan, and so many robots do at most so many actions in a time step.
///
/// Exact about neither chains with detours nor uneven skills. `None` if the goal is out of reach.
pub fn makespan_lower_bound(
    team: &Team,
    available: &[usize],
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
) -> Option<u32> {
    let (domain, skills) = team.joint(available);
    let problem = joint_problem(team, facts, &skills, goal);
    let task = lamma_planner::ground::ground(&domain, &problem, &Default::default()).ok()?;
    let depth = lamma_planner::hmax_unit(&task)?;
    let robots = u32::try_from(available.len().max(1)).unwrap_or(u32::MAX);
    let work = match LandmarkCut::new(&task, Costs::Unit).estimate(&task.init, &mut Vec::new()) {
        Estimate::Cost(actions) => actions,
        Estimate::DeadEnd => 0,
    };
    Some(depth.max(work.div_ceil(robots)))
}
