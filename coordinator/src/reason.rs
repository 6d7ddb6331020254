//! Why a goal is out of reach, in words a person can use.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::Name;
use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::Limits;
use lamma_planner::Outcome;

use crate::split::team_plan;
use crate::team::{Relaxation, Team};

/// Whose obstacles are looked at.
#[derive(Clone, Copy)]
pub(crate) struct Obstacles<'a> {
    /// The team.
    pub team: &'a Team,
    /// Members that are alive, by index.
    pub available: &'a [usize],
}

/// What stands between the team and the goal: the skills nobody has and the obstacles the team knows of.
/// Each is removed in thought; a smallest set (by leaving out one after the other) without which the goal
/// stays out of reach is the reason. `None` if the goal is out of reach even without any of them.
pub(crate) fn why_infeasible(
    obstacles: Obstacles<'_>,
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Option<String> {
    let Obstacles { team, available } = obstacles;
    let skills = team.missing_skills(available).into_iter().map(|(skill, facts)| Relaxation {
        reason: format!("nobody who is left has the skill {skill}"),
        facts,
        kept: Vec::new(),
    });
    let mut removed: Vec<Relaxation> = skills.chain(team.relaxations.iter().cloned()).collect();
    let reachable = |removed: &[Relaxation]| {
        let extra: Vec<GroundAtom> = removed.iter().flat_map(|r| r.facts.clone()).collect();
        let kept: Vec<Name> = removed.iter().flat_map(|r| r.kept.clone()).collect();
        let team = team.keeping(&kept);
        let outcome = team_plan(&team, available, facts, &extra, goal, limits, cancel);
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
    Some(removed.into_iter().map(|r| r.reason).collect::<Vec<_>>().join("; "))
}
