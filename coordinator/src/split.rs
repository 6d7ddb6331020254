//! A sub-task that no single robot can do, split where the robots hand over.
//!
//! The team plans it as one actor; the plan is explained by causal links, and every fact that one robot
//! achieves and another (or the goal) needs becomes the goal of a segment of the robot that achieves it.
//! Each robot then plans its segments itself, in its own domain.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::AtomicBool;

use lamma_pddl::Name;
use lamma_pddl::ast::{Atom, Condition, GroundAtom, Term};
use lamma_planner::Limits;
use lamma_planner::Outcome;
use lamma_planner::interpreter::Interpreter;
use lamma_planner::partial_order::{PartialOrder, deorder};
use lamma_planner::{GroundAct, Literal, Plan};

use crate::combine::world_state;
use crate::problem::joint_problem;
use crate::team::Team;

/// One robot's part between two hand-overs.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Whose.
    pub member: usize,
    /// The facts it hands over or that the goal needs.
    pub goal: Condition,
    /// Segments that come before it, by index.
    pub after: Vec<usize>,
    /// What the team's own plan has the robot do, should its own planning fail.
    pub acts: Vec<GroundAct>,
    /// Whether it brings a part of the goal about, and not only what others need.
    pub finishing: bool,
}

/// Plans the goal for the team as one actor.
pub fn team_plan(
    team: &Team,
    available: &[usize],
    facts: &BTreeSet<GroundAtom>,
    extra: &[GroundAtom],
    goal: &Condition,
    limits: &Limits,
    cancel: &AtomicBool,
) -> Result<Outcome, String> {
    let (domain, mut skills) = team.joint(available);
    skills.extend(extra.iter().cloned());
    let problem = joint_problem(team, facts, &skills, goal);
    lamma_planner::plan(&domain, &problem, limits, cancel).map_err(|e| e.to_string())
}

/// Cuts the team's plan into segments.
pub fn segments(
    team: &Team,
    interpreter: &Interpreter,
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
    plan: &Plan,
) -> Result<Vec<Segment>, String> {
    let steps = team.steps(interpreter, plan)?;
    let ground = interpreter.ground_condition(goal).map_err(|e| e.to_string())?;
    let order = deorder(interpreter, &world_state(facts), steps, &ground, &[])
        .map_err(|(i, violation)| format!("the team's plan fails at step {i}: {violation}"))?;
    Ok(cut(team, &order))
}

/// The level of a step is how many hand-overs lie before it; a robot's steps of one level are a segment.
fn cut(team: &Team, order: &PartialOrder) -> Vec<Segment> {
    let level = levels(order);
    let end = order.steps.len();
    let mut goals: BTreeMap<(usize, usize), BTreeSet<Literal>> = BTreeMap::new();
    let mut finishing: BTreeSet<(usize, usize)> = BTreeSet::new();
    for link in &order.links {
        let Some(producer) = link.producer else { continue };
        let agent = order.steps[producer].agent;
        let handed_over = link.consumer == end || order.steps[link.consumer].agent != agent;
        let me = Some(&team.members[agent].name);
        if handed_over && !team.mentions_other(&link.literal.atom, me) {
            goals.entry((level[producer], agent)).or_default().insert(link.literal.clone());
            if link.consumer == end {
                finishing.insert((level[producer], agent));
            }
        }
    }
    let keys: Vec<(usize, usize)> = goals.keys().copied().collect();
    let mut begun: BTreeMap<usize, usize> = BTreeMap::new();
    keys.iter()
        .map(|&(at, member)| {
            // A segment includes the robot's earlier steps that no segment has claimed yet.
            let from = begun.insert(member, at + 1).unwrap_or(0);
            let acts = (0..end)
                .filter(|&i| order.steps[i].agent == member && (from..=at).contains(&level[i]))
                .map(|i| order.steps[i].action.act.clone())
                .collect();
            let goal = Condition::And(goals[&(at, member)].iter().map(condition_of).collect());
            let after = (0..keys.len()).filter(|&k| keys[k].0 < at).collect();
            Segment { member, goal, after, acts, finishing: finishing.contains(&(at, member)) }
        })
        .collect()
}

fn levels(order: &PartialOrder) -> Vec<usize> {
    let mut level = Vec::with_capacity(order.steps.len());
    for (i, before) in order.before.iter().enumerate() {
        let agent = order.steps[i].agent;
        let hop = |&p: &usize| level[p] + usize::from(order.steps[p].agent != agent);
        level.push(before.iter().map(hop).max().unwrap_or(0));
    }
    level
}

/// The literal as a condition.
pub fn condition_of(literal: &Literal) -> Condition {
    let args = literal.atom.args.iter().map(|a: &Name| Term::Constant(a.clone())).collect();
    let atom = Condition::Atom(Atom { predicate: literal.atom.predicate.clone(), args });
    if literal.holds { atom } else { Condition::Not(Box::new(atom)) }
}
