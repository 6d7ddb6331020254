//! Why a goal is out of reach, in words a person can use.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::Limits;
use lamma_planner::Outcome;

use crate::allocation::AllocateInput;
use crate::split::team_plan;

/// What stands between the team and the goal: the skills nobody has and the obstacles the team knows of.
/// Each is removed in thought; a smallest set (by leaving out one after the other) without which the goal
/// stays out of reach is the reason. `None` if the goal is out of reach even without any of them.
pub(crate) fn why_infeasible(
    input: &AllocateInput,
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Option<String> {
    let skills = input
        .team
        .missing_skills(&input.available)
        .into_iter()
        .map(|(skill, facts)| (format!("nobody who is left has the skill {skill}"), facts));
    let obstacles = input.team.relaxations.iter().map(|r| (r.reason.clone(), r.facts.clone()));
    let mut removed: Vec<(String, Vec<GroundAtom>)> = skills.chain(obstacles).collect();
    let reachable = |removed: &[(String, Vec<GroundAtom>)]| {
        let extra: Vec<GroundAtom> = removed.iter().flat_map(|(_, facts)| facts.clone()).collect();
        let outcome = team_plan(&input.team, &input.available, facts, &extra, goal, limits, cancel);
        matches!(outcome, Ok(Outcome::Found(_)))
    };
    if removed.is_empty() || !reachable(&removed) {
        return None;
    }
    let mut i = 0;
    while i < removed.len() {
        let one = removed.remove(i);
        if !reachable(&removed) {
            removed.insert(i, one);
            i += 1;
        }
    }
    Some(removed.into_iter().map(|(reason, _)| reason).collect::<Vec<_>>().join("; "))
}
