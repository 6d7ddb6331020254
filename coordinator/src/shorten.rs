//! A shorter plan than the combined one, or the proof that there is none.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::Condition;
use lamma_planner::interpreter::{GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::{PartialOrder, TeamStep, deorder_with};
use lamma_planner::{MakespanLimits, OperatorId, Schedule};

use crate::allocation::PackageSpec;
use crate::bound::JointTask;
use crate::combine::{TeamPlan, team_plan};
use crate::hurry::Hurry;
use crate::merge::Merger;
use crate::sequence::{Ordered, milestones, relied_on};
use crate::team::Team;

/// Steps that are looked at for a better plan where going takes its time: a fraction of a second.
const HURRY: u64 = 30_000;

/// What may be done about a plan.
#[derive(Clone, Debug)]
pub struct Shorten {
    /// Members that are alive, by index.
    pub available: Vec<usize>,
    /// A proved lower bound of the makespan.
    pub bound: f64,
    /// The sub-tasks, if all of them shall hold at the end: only then may the steps be chosen anew.
    pub wanted: Option<Vec<Wanted>>,
    /// How much may be spent.
    pub limits: MakespanLimits,
}

/// A sub-task as a schedule sees it.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// What holds when it is done, and from then on.
    pub goal: Condition,
    /// Sub-tasks it was asked to follow, by index.
    pub after: Vec<usize>,
}

/// The plan to carry out and what is known about its makespan.
#[derive(Clone, Debug)]
pub struct Combined {
    /// The plan.
    pub plan: TeamPlan,
    /// Where it leads.
    pub end: WorldState,
    /// Who does what in it, where that is no longer what was allocated.
    pub packages: Option<Vec<PackageSpec>>,
    /// No plan of the team is shorter.
    pub bound: f64,
}

/// Raises the bound and looks for a shorter plan, until they meet or the limits are reached.
pub fn shorten(
    team: &Team,
    interpreter: &Interpreter,
    merger: &Merger,
    plan: TeamPlan,
    goal: &Condition,
    how: &Shorten,
    cancel: &AtomicBool,
) -> Combined {
    let mut combined = Combined { plan, end: merger.state.clone(), packages: None, bound: how.bound };
    if team.travel.is_some() {
        return sooner(team, interpreter, merger, combined, goal, how, cancel);
    }
    let unit_steps = team.domain.actions.iter().all(|action| action.duration.is_none());
    if how.limits.conflicts == 0 || combined.plan.makespan <= how.bound || !unit_steps {
        return combined;
    }
    let facts = &merger.initial.facts;
    let Ok(joint) = JointTask::new(team, &how.available, facts, goal) else { return combined };
    let wanted: Option<Vec<Ordered>> =
        how.wanted.iter().flatten().map(|w| Ordered::new(interpreter, w)).collect();
    let Some(wanted) = wanted else { return combined };
    let milestones = milestones(&joint, &merger.initial, &wanted);
    let (from, below) = (how.bound.ceil() as u32, combined.plan.makespan.ceil() as u32);
    // Where steps may not be chosen anew, only the bound is of use, and it is found on the way up.
    let below = how.wanted.is_some().then_some(below);
    let Some(found) = joint.shortest(&milestones, from, below, &how.limits, cancel) else { return combined };
    let bound = found.lower_bound.map_or(how.bound, f64::from);
    // A bound above a plan that is known would be a fault of the proof; never print one.
    combined.bound = bound.min(combined.plan.makespan).max(how.bound);
    if let Some(schedule) = found.schedule.filter(|_| how.wanted.is_some()) {
        let shorter = replan(team, interpreter, &joint, &merger.initial, &schedule, goal, &wanted);
        if let Some((plan, end, packages)) = shorter
            && plan.makespan < combined.plan.makespan
        {
            combined = Combined { plan, end, packages: Some(packages), ..combined };
        }
    }
    combined
}

/// The schedule on the plain semantics: deordered, with who serves which sub-task. `None` if the plain semantics
/// does not agree that it is a plan.
fn replan(
    team: &Team,
    interpreter: &Interpreter,
    joint: &JointTask,
    initial: &WorldState,
    schedule: &Schedule,
    goal: &Condition,
    wanted: &[Ordered],
) -> Option<(TeamPlan, WorldState, Vec<PackageSpec>)> {
    let steps = scheduled(interpreter, joint, schedule)?;
    let mut end = initial.clone();
    for step in &steps {
        interpreter.apply(&mut end, &step.action).ok()?;
    }
    let ground = interpreter.ground_condition(goal).ok()?;
    if !interpreter.holds(&end, &ground) {
        return None;
    }
    let relied_on = relied_on(interpreter, initial, &steps, wanted)?;
    let order = deorder_with(interpreter, initial, steps, &ground, &[], &relied_on).ok()?;
    let packages = serving(&order, &end, wanted);
    Some((team_plan(team, &order, Vec::new()), end, packages))
}

/// The steps of a schedule, one after the other.
fn scheduled(interpreter: &Interpreter, joint: &JointTask, schedule: &Schedule) -> Option<Vec<TeamStep>> {
    let step = |operator: OperatorId| {
        let action = interpreter.instantiate(&joint.task.act(operator)).ok()?;
        Some(TeamStep { agent: joint.member_of[operator.index()] as usize, action: Arc::new(action) })
    };
    schedule.operators().map(step).collect()
}

/// Where going takes its time: the plan improved for that, from the better of the combined plan and the one with the
/// fewest steps. The bound stays as it is.
fn sooner(
    team: &Team,
    interpreter: &Interpreter,
    merger: &Merger,
    combined: Combined,
    goal: &Condition,
    how: &Shorten,
    cancel: &AtomicBool,
) -> Combined {
    let better = || {
        // The search for it knows the end only, no order.
        let wanted = how.wanted.as_ref().filter(|wanted| wanted.iter().all(|w| w.after.is_empty()))?;
        let wanted: Vec<Ordered> =
            wanted.iter().map(|w| Ordered::new(interpreter, w)).collect::<Option<_>>()?;
        let ground = interpreter.ground_condition(goal).ok()?;
        let mut plans = vec![merger.steps.clone()];
        if let Ok(joint) = JointTask::new(team, &how.available, &merger.initial.facts, goal)
            && let Some(found) = joint.shortest(&[], joint.floor().unwrap_or(0), None, &how.limits, cancel)
        {
            plans.extend(found.schedule.and_then(|schedule| scheduled(interpreter, &joint, &schedule)));
        }
        let members = how.available.iter().map(|&m| (m, team.members[m].name.clone())).collect();
        let (initial, budget) = (&merger.initial, HURRY);
        let hurry = Hurry { interpreter, initial, goal: &ground, members, budget };
        let (order, end) = hurry.run(&plans, cancel)?;
        let packages = serving(&order, &end, &wanted);
        Some((team_plan(team, &order, Vec::new()), end, packages))
    };
    match better() {
        Some((plan, end, packages)) if plan.makespan < combined.plan.makespan => {
            Combined { plan, end, packages: Some(packages), ..combined }
        }
        _ => combined,
    }
}

/// Who serves which sub-task.
fn serving(order: &PartialOrder, end: &WorldState, wanted: &[Ordered]) -> Vec<PackageSpec> {
    let mut packages = Vec::new();
    for (index, wanted) in wanted.iter().enumerate() {
        for member in servants(order, &wanted.condition, end) {
            packages.push(PackageSpec {
                member,
                goal: wanted.goal.clone(),
                subgoals: vec![index],
                after: Vec::new(),
                asked_after: Vec::new(),
                fallback: None,
            });
        }
    }
    packages
}

/// Who contributes to a goal: the agents of the steps from which causal links lead to it.
fn servants(order: &PartialOrder, goal: &GroundCondition, end: &WorldState) -> BTreeSet<usize> {
    let wanted = goal.witness(end).unwrap_or_default();
    let last = order.steps.len();
    let decisive = order.links.iter().filter(|l| l.consumer == last && wanted.contains(&l.literal));
    let mut queue: Vec<usize> = decisive.filter_map(|l| l.producer).collect();
    let mut steps = BTreeSet::new();
    while let Some(step) = queue.pop() {
        if steps.insert(step) {
            queue.extend(order.links.iter().filter(|l| l.consumer == step).filter_map(|l| l.producer));
        }
    }
    steps.into_iter().map(|step| order.steps[step].agent).collect()
}
