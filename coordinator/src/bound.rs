//! A lower bound of the team's makespan: no plan of any team member order can be shorter.

use std::collections::BTreeSet;

use lamma_pddl::ast::{Condition, GroundAtom};

use crate::problem::joint_problem;
use crate::team::Team;

/// The depth of the relaxed plan of the whole team (h_max with unit costs, Bonet & Geffner, "Planning as
/// heuristic search", AIJ 129, 2001). In every time step each robot does at most one action, and without
/// deletes nothing gets in the way, so the first layer in which every goal fact can hold is a bound; it is
/// exact about chains and blind to how much work there is. `None` if the goal is out of reach.
pub fn makespan_lower_bound(
    team: &Team,
    available: &[usize],
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
) -> Option<u32> {
    let (domain, skills) = team.joint(available);
    let problem = joint_problem(team, facts, &skills, goal);
    let task = lamma_planner::ground::ground(&domain, &problem, &Default::default()).ok()?;
    lamma_planner::hmax_unit(&task)
}
