//! Why a goal is out of reach, in words a person can use.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_pddl::{Name, parse_ground_atom};
use lamma_planner::interpreter::Interpreter;
use lamma_planner::{Limits, Outcome, Plan, Unsolvable, explain_unreachable};

use crate::combine::world_state;
use crate::problem::joint_problem;
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
/// stays out of reach is the reason. `None` if the goal is out of reach even without any of them. That it is with
/// all of them is known.
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
    if removed.is_empty() {
        return None;
    }
    let plan_without = |removed: &[Relaxation]| {
        let (team, extra) = relaxed(team, removed);
        match team_plan(&team, available, facts, &extra, goal, limits, cancel) {
            Ok(Outcome::Found(plan)) => Some(plan),
            _ => None,
        }
    };
    let mut plan = plan_without(&removed)?;
    let mut i = 0;
    while i < removed.len() && removed.len() > 1 {
        let one = removed.remove(i);
        // Most obstacles have nothing to do with it: the plan that is known goes through with them in place.
        if !goes_through(obstacles, &removed, facts, goal, &plan) {
            match plan_without(&removed) {
                Some(another) => plan = another,
                None => {
                    removed.insert(i, one);
                    i += 1;
                }
            }
        }
    }
    Some(removed.into_iter().map(|r| r.reason).collect::<Vec<_>>().join("; "))
}

/// The planner's own reason, with the cause of each part that is out of reach where there is a single one.
pub(crate) fn with_causes(
    obstacles: Obstacles<'_>,
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
    why: &Unsolvable,
) -> String {
    let Unsolvable::Unreachable(parts) = why else { return why.to_string() };
    let Obstacles { team, available } = obstacles;
    let (domain, skills) = team.joint(available);
    let problem = joint_problem(team, facts, &skills, goal);
    let cause = |part: &String| {
        if let Some(lasting) = part.strip_prefix("(not ").and_then(|rest| rest.strip_suffix(')')) {
            return Some(format!("; {lasting} holds and nothing that the team can do undoes it"));
        }
        let atom = parse_ground_atom(part).ok()?;
        explain_unreachable(&domain, &problem, &atom).map(|cause| format!("; {cause}"))
    };
    format!("{why}{}", parts.iter().filter_map(cause).collect::<String>())
}

/// The team without these obstacles, and the facts that are then so.
fn relaxed(team: &Team, removed: &[Relaxation]) -> (Team, Vec<GroundAtom>) {
    let kept: Vec<Name> = removed.iter().flat_map(|r| r.kept.clone()).collect();
    (team.keeping(&kept), removed.iter().flat_map(|r| r.facts.clone()).collect())
}

/// Whether the team could carry this plan out if these obstacles were not there.
fn goes_through(
    obstacles: Obstacles<'_>,
    removed: &[Relaxation],
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
    plan: &Plan,
) -> bool {
    let (team, extra) = relaxed(obstacles.team, removed);
    let (domain, skills) = team.joint(obstacles.available);
    let Ok(interpreter) = Interpreter::new(&domain, &team.objects) else { return false };
    let Ok(goal) = interpreter.ground_condition(goal) else { return false };
    let mut state = world_state(facts);
    state.facts.extend(skills.into_iter().chain(extra));
    let possible = plan.acts.iter().all(|act| {
        let action = interpreter.instantiate(act);
        action.is_ok_and(|action| interpreter.apply(&mut state, &action).is_ok())
    });
    possible && interpreter.holds(&state, &goal)
}
