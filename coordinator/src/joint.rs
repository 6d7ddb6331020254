//! Planning for the whole team at once: the way of tasks that come as PDDL, with no sentence to divide.
//!
//! The team is searched for as one actor, the plan is explained on the plain semantics, and what is left of its
//! order becomes gates. (CoDMAP 2015 calls this the centralised track; who acts is part of each action.)

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use lamma_pddl::ast::{Condition, GroundAtom, Init};
use lamma_planner::interpreter::{Interpreter, WorldState};
use lamma_planner::partial_order::{PartialOrder, deorder};
use lamma_planner::{Countdown, Limits, MakespanLimits, Outcome, Plan, SearchOptions, Task};
use lamma_protocol::StepIndex;

use crate::allocation::{Allocation, NoAllocation, PackageSpec};
use crate::bound::JointTask;
use crate::combine::{PackageEnd, TeamPlan, team_plan};
use crate::reason::{Obstacles, why_infeasible, with_causes};
use crate::team::Team;

/// Memory that a search may use: what a small host has left beside the team.
const MEMORY: usize = 3 << 30;
/// Bounds of each search for a reason: without one, "infeasible" is still true.
const REASON_EXPANSIONS: u64 = 20_000;

/// What there is to plan.
#[derive(Clone, Debug)]
pub struct JointInput {
    /// The team.
    pub team: Arc<Team>,
    /// Members that are alive, by index.
    pub available: Vec<usize>,
    /// What holds now.
    pub facts: BTreeSet<GroundAtom>,
    /// What shall hold at the end.
    pub goal: Condition,
    /// How long the search may take, in milliseconds.
    pub time_ms: u64,
    /// What may be spent on a shorter schedule and a better bound after that.
    pub makespan: MakespanLimits,
}

/// The team's plan and what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct JointPlan {
    /// The plan, ready to be handed out.
    pub plan: TeamPlan,
    /// Who takes part, and the bound.
    pub allocation: Allocation,
    /// What holds at its end.
    pub end: BTreeSet<GroundAtom>,
}

/// Plans. The same input gives the same plan, unless the time runs out.
pub fn plan_jointly(input: &JointInput, cancel: &AtomicBool) -> Result<JointPlan, NoAllocation> {
    let team = &input.team;
    let gave_up = |why: &dyn std::fmt::Display| NoAllocation::GaveUp(why.to_string());
    let joint = JointTask::new(team, &input.available, &input.facts, &input.goal).map_err(|e| gave_up(&e))?;
    let countdown = Countdown::from(Duration::from_millis(input.time_ms));
    let plan = search(input, &joint.task, countdown, cancel)?;
    let interpreter = team.interpreter().map_err(|e| gave_up(&e))?;
    let order = explain(input, &interpreter, &plan).map_err(|why| gave_up(&why))?;
    let steps = order.makespan() as u32;
    let limits = within(&input.makespan, joint.task.operators.len(), steps, countdown);
    let (order, bound) = improve(input, &interpreter, &joint, &plan, order, &limits, cancel);
    Ok(handed_out(input, &interpreter, &order, f64::from(bound)))
}

/// What a task of so many operators and a plan of so many steps is worth, and no longer than half of what is left: the
/// plan is still to be carried out.
fn within(limits: &MakespanLimits, operators: usize, steps: u32, countdown: Countdown) -> MakespanLimits {
    let time = [limits.time, countdown.left().map(|left| left / 2)].into_iter().flatten().min();
    MakespanLimits { time, ..limits.worth(operators, steps) }
}

/// The shortest order found and a proved bound, within the limits.
fn improve(
    input: &JointInput,
    interpreter: &Interpreter,
    joint: &JointTask,
    plan: &Plan,
    order: PartialOrder,
    limits: &MakespanLimits,
    cancel: &AtomicBool,
) -> (PartialOrder, u32) {
    let floor = joint.floor().unwrap_or(0);
    // Bounds count steps; where actions take longer or shorter, nothing is known.
    let unit = order.durations.iter().all(|duration| *duration == 1.0);
    if !unit || order.steps.is_empty() {
        return (order, if unit { floor } else { 0 });
    }
    let makespan = order.makespan() as u32;
    if makespan <= floor {
        return (order, floor);
    }
    let Some(found) = joint.improve(plan, makespan, floor, limits, cancel) else {
        return (order, floor);
    };
    let bound = found.lower_bound.unwrap_or(floor).max(floor);
    let better = found.schedule.and_then(|schedule| {
        let operators: Vec<_> = schedule.operators().collect();
        explain(input, interpreter, &joint.task.plan(&operators)).ok()
    });
    match better {
        Some(better) if better.makespan() < order.makespan() => (better, bound),
        _ => (order, bound),
    }
}

fn search(
    input: &JointInput,
    task: &Task,
    countdown: Countdown,
    cancel: &AtomicBool,
) -> Result<Plan, NoAllocation> {
    let limits = Limits { time: countdown.left(), memory_bytes: Some(MEMORY), ..Limits::default() };
    match lamma_planner::solve(task, &SearchOptions::default(), &limits, cancel) {
        Outcome::Found(plan) => Ok(plan),
        Outcome::GaveUp(why) => Err(NoAllocation::GaveUp(why.to_string())),
        Outcome::Unsolvable(why) => {
            let limits = Limits { expansions: Some(REASON_EXPANSIONS), ..Limits::default() };
            let obstacles = Obstacles { team: &input.team, available: &input.available };
            let reason = why_infeasible(obstacles, &input.facts, &input.goal, &limits, cancel);
            let reason = reason.unwrap_or_else(|| with_causes(obstacles, &input.facts, &input.goal, &why));
            Err(NoAllocation::Infeasible(format!("the team cannot reach the goal: {reason}")))
        }
    }
}

/// Where the plan begins.
fn start(input: &JointInput) -> WorldState {
    let value = |item: &Init| match item {
        Init::Value(function, value) => Some((function.clone(), value.value())),
        Init::Fact(_) => None,
    };
    WorldState { facts: input.facts.clone(), values: input.team.numbers.iter().filter_map(value).collect() }
}

fn explain(input: &JointInput, interpreter: &Interpreter, plan: &Plan) -> Result<PartialOrder, String> {
    let steps = input.team.steps(interpreter, plan)?;
    let goal = interpreter.ground_condition(&input.goal).map_err(|e| e.to_string())?;
    deorder(interpreter, &start(input), steps, &goal, &[])
        .map_err(|(i, violation)| format!("the plan found fails at step {i}: {violation}"))
}

/// The plan with who takes part, and the state it leads to.
fn handed_out(
    input: &JointInput,
    interpreter: &Interpreter,
    order: &PartialOrder,
    lower_bound: f64,
) -> JointPlan {
    let mut state = start(input);
    for step in &order.steps {
        // `deorder` has replayed the plan: every step applies.
        let _ = interpreter.apply(&mut state, &step.action);
    }
    let members: BTreeSet<usize> = order.steps.iter().map(|step| step.agent).collect();
    let packages = members.iter().map(|&member| PackageSpec {
        member,
        goal: input.goal.clone(),
        subgoals: vec![0],
        after: Vec::new(),
        asked_after: Vec::new(),
        fallback: None,
    });
    let packages = packages.collect();
    let done = |member: usize| order.steps.iter().filter(|step| step.agent == member).count() as u32;
    let ends =
        members.iter().map(|&member| PackageEnd { subgoals: vec![0], member, done: StepIndex(done(member)) });
    JointPlan {
        plan: team_plan(&input.team, order, ends.collect()),
        allocation: Allocation { packages, lower_bound },
        end: state.facts,
    }
}
