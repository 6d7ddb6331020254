//! A shorter plan than the combined one, or the proof that there is none.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::Condition;
use lamma_planner::interpreter::{GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::{PartialOrder, TeamStep, deorder_with};
use lamma_planner::{MakespanLimits, Schedule};

use crate::allocation::PackageSpec;
use crate::bound::JointTask;
use crate::combine::{TeamPlan, team_plan};
use crate::merge::Merger;
use crate::sequence::{Ordered, milestones, relied_on};
use crate::team::Team;

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
    let mut merger = Merger::new(initial.clone());
    for operator in schedule.operators() {
        let action = interpreter.instantiate(&joint.task.act(operator)).ok()?;
        interpreter.apply(&mut merger.state, &action).ok()?;
        merger.steps.push(TeamStep { agent: joint.member_of[operator.index()] as usize, action });
    }
    let ground = interpreter.ground_condition(goal).ok()?;
    if !interpreter.holds(&merger.state, &ground) {
        return None;
    }
    let relied_on = relied_on(interpreter, initial, &merger.steps, wanted)?;
    let order = deorder_with(interpreter, initial, merger.steps.clone(), &ground, &[], &relied_on).ok()?;
    let mut packages = Vec::new();
    for (index, wanted) in wanted.iter().enumerate() {
        for member in servants(&order, &wanted.condition, &merger.state) {
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
    Some((team_plan(team, &order, Vec::new()), merger.state, packages))
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
