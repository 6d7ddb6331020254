//! The Sub-Plan Combiner: a valid linear plan of the team becomes a partial order with gates.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::interpreter::{GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::{PartialOrder, TeamStep, deorder};
use lamma_protocol::message::{Act, Gate, Step};
use lamma_protocol::{AgentId, StepIndex};

use crate::allocation::PackageSpec;
use crate::merge::Merger;
use crate::team::Team;

/// The team's plan, ready to be handed out.
#[derive(Clone, Debug, PartialEq)]
pub struct TeamPlan {
    /// Each member's steps, in roster order.
    pub steps: Vec<Vec<Step>>,
    /// All steps in a valid linear order, with their earliest start.
    pub timeline: Vec<TimedStep>,
    /// When each package is done.
    pub ends: Vec<PackageEnd>,
    /// When the last step ends if everybody acts as soon as the order allows, in steps.
    pub makespan: f64,
}

/// A package is done when its member has done so many steps.
#[derive(Clone, Debug, PartialEq)]
pub struct PackageEnd {
    /// The sub-tasks it serves, by index.
    pub subgoals: Vec<usize>,
    /// Whose.
    pub member: usize,
    /// Steps of the member up to its end.
    pub done: StepIndex,
}

/// A step on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedStep {
    /// Earliest start.
    pub start: f64,
    /// How long it takes.
    pub duration: f64,
    /// Which member.
    pub member: usize,
    /// Which of its steps.
    pub index: StepIndex,
    /// What is done.
    pub act: Act,
}

/// Deorders the merged plan. `packages` are those that were merged, by the index the merger knows.
pub fn combine(
    team: &Team,
    interpreter: &Interpreter,
    merger: &Merger,
    packages: &[PackageSpec],
    goal: &Condition,
    cancel: &AtomicBool,
) -> Result<TeamPlan, String> {
    let ground = interpreter.ground_condition(goal).map_err(|e| e.to_string())?;
    let merger = &without_idle_steps(interpreter, merger, &ground, cancel);
    let keep = asked_order(interpreter, merger, packages)?;
    let order = deorder(interpreter, &merger.initial, merger.steps.clone(), &ground, &keep)
        .map_err(|(i, violation)| format!("step {i} of the merged plan: {violation}"))?;
    let ends = merger.packages.iter().map(|merged| {
        let spec = &packages[merged.package];
        let own = order.steps[..merged.steps.end].iter().filter(|s| s.agent == spec.member).count();
        PackageEnd { subgoals: spec.subgoals.clone(), member: spec.member, done: StepIndex(own as u32) }
    });
    let ends = ends.collect();
    Ok(team_plan(team, &order, ends))
}

/// Steps beyond which idle ones are not looked for: the search is quadratic.
const MAX_ELIMINATION: usize = 120;

/// Leaves out steps without which everything still works, as a way to a fridge that somebody else has
/// opened (action elimination, Nakhost & Müller, "Action elimination and plan neighborhood graph search",
/// ICAPS 2010). Every package's own goal stays reached where its steps end.
fn without_idle_steps(
    interpreter: &Interpreter,
    merger: &Merger,
    goal: &GroundCondition,
    cancel: &AtomicBool,
) -> Merger {
    let mut best = merger.clone();
    if best.steps.len() > MAX_ELIMINATION {
        return best;
    }
    // What is left out lies behind, so the states before a step stay as they are.
    let mut states = vec![best.initial.clone()];
    for step in &best.steps {
        let mut next = states[states.len() - 1].clone();
        if interpreter.apply(&mut next, &step.action).is_err() {
            return best;
        }
        states.push(next);
    }
    for i in (0..best.steps.len()).rev() {
        if cancel.load(Ordering::Relaxed) {
            break;
        }
        let shorter = best.without(i);
        if shorter.is_valid_from(interpreter, i, states[i].clone(), goal) {
            best = shorter;
        }
    }
    best
}

/// The orderings the instruction asks for: where one package is to be done after another, the steps that
/// bring its goal about come after the other's last step. Steps that only prepare may run ahead.
fn asked_order(
    interpreter: &Interpreter,
    merger: &Merger,
    packages: &[PackageSpec],
) -> Result<Vec<(usize, usize)>, String> {
    let mut keep = Vec::new();
    for later in &merger.packages {
        let spec = &packages[later.package];
        let goal = interpreter.ground_condition(&spec.goal).map_err(|e| e.to_string())?;
        let atoms: BTreeSet<_> = goal.literals().into_iter().map(|l| l.atom.clone()).collect();
        let decisive: Vec<usize> =
            later.steps.clone().filter(|&i| touches(&merger.steps[i], &atoms)).collect();
        for last in last_steps_before(spec, merger, packages) {
            keep.extend(decisive.iter().map(|&d| (last, d)));
        }
    }
    Ok(keep)
}

/// The last steps of the packages that `spec` was asked to follow. One without steps stands for those it was
/// to follow itself.
fn last_steps_before(spec: &PackageSpec, merger: &Merger, packages: &[PackageSpec]) -> BTreeSet<usize> {
    let mut last = BTreeSet::new();
    let mut queue = spec.asked_after.clone();
    while let Some(package) = queue.pop() {
        let steps =
            merger.packages.iter().find(|p| p.package == package).and_then(|p| p.steps.clone().last());
        match steps {
            Some(step) => drop(last.insert(step)),
            None => queue.extend(&packages[package].asked_after),
        }
    }
    last
}

fn touches(step: &TeamStep, atoms: &BTreeSet<GroundAtom>) -> bool {
    step.action.literal_effects().any(|(_, effect)| atoms.contains(&effect.atom))
}

/// The order as steps with gates, for each member.
pub(crate) fn team_plan(team: &Team, order: &PartialOrder, ends: Vec<PackageEnd>) -> TeamPlan {
    let gates = order.gates();
    let starts = order.earliest_starts();
    let mut steps: Vec<Vec<Step>> = vec![Vec::new(); team.members.len()];
    let mut timeline = Vec::with_capacity(order.steps.len());
    for (i, step) in order.steps.iter().enumerate() {
        let ground = &step.action.act;
        let act = Act::new(&ground.action, &ground.args);
        let gates = gates[i]
            .iter()
            .map(|&(agent, done)| Gate { agent: AgentId(agent as u16), done: StepIndex(done) });
        let index = StepIndex(steps[step.agent].len() as u32);
        let (start, duration) = (starts[i], order.durations[i]);
        timeline.push(TimedStep { start, duration, member: step.agent, index, act: act.clone() });
        steps[step.agent].push(Step { act, gates: gates.collect() });
    }
    timeline.sort_by(|a, b| a.start.total_cmp(&b.start).then(a.member.cmp(&b.member)));
    TeamPlan { steps, timeline, ends, makespan: order.makespan() }
}

/// The act as the planner knows it.
pub fn ground_act(act: &Act) -> lamma_planner::GroundAct {
    lamma_planner::GroundAct::new(act.action.as_str(), act.args.iter().map(String::as_str))
}

/// The state of the world from its facts.
pub fn world_state(facts: &BTreeSet<GroundAtom>) -> WorldState {
    WorldState { facts: facts.clone(), values: Default::default() }
}
