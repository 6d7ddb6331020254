//! The order that an instruction asks for, in schedules that are made anew.
//!
//! Where one sub-task is to follow another, what it asks for and does not hold yet is brought about while the other
//! holds (see [`lamma_planner::Milestone`]). A schedule that keeps to this is deordered as if the steps that bring the
//! later one about relied on the earlier one.

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::interpreter::{GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::TeamStep;
use lamma_planner::{FactId, Literal, Milestone, Need, all_before};

use crate::bound::JointTask;
use crate::shorten::Wanted;

/// A sub-task with its goal grounded.
pub(crate) struct Ordered {
    pub goal: Condition,
    pub condition: GroundCondition,
    after: Vec<usize>,
}

impl Ordered {
    pub fn new(interpreter: &Interpreter, wanted: &Wanted) -> Option<Self> {
        let condition = interpreter.ground_condition(&wanted.goal).ok()?;
        Some(Ordered { goal: wanted.goal.clone(), condition, after: wanted.after.clone() })
    }
}

/// The sub-tasks in terms of the team's task.
pub(crate) fn milestones(joint: &JointTask, initial: &WorldState, wanted: &[Ordered]) -> Vec<Milestone> {
    let mut facts: BTreeMap<GroundAtom, (FactId, bool)> = BTreeMap::new();
    for fact in (0..joint.task.facts.len() as u32).map(FactId) {
        if let Some(Literal { atom, holds }) = joint.task.literal(fact) {
            // A fact that the atom holds is preferred to one that it does not.
            let known = facts.entry(atom).or_insert((fact, holds));
            if holds {
                *known = (fact, true);
            }
        }
    }
    let need = |ordered: &Ordered| need(&facts, initial, &ordered.condition);
    wanted.iter().map(|w| Milestone { need: need(w), after: w.after.clone() }).collect()
}

fn need(
    facts: &BTreeMap<GroundAtom, (FactId, bool)>,
    initial: &WorldState,
    condition: &GroundCondition,
) -> Need {
    let all = |parts: &[GroundCondition]| parts.iter().map(|part| need(facts, initial, part)).collect();
    match condition {
        GroundCondition::And(parts) => Need::All(all(parts)),
        GroundCondition::Or(parts) => Need::Any(all(parts)),
        GroundCondition::Literal(literal) => match facts.get(&literal.atom) {
            Some(&(fact, positive)) => Need::Fact(fact, positive == literal.holds),
            // What the task does not know never changes.
            None if initial.facts.contains(&literal.atom) == literal.holds => Need::All(Vec::new()),
            None => Need::Any(Vec::new()),
        },
        // Goals of sub-tasks compare no numbers.
        GroundCondition::Compare(..) => Need::All(Vec::new()),
    }
}

/// What steps rely on because of the order asked for; `None` if they do not keep to it.
pub(crate) fn relied_on(
    interpreter: &Interpreter,
    initial: &WorldState,
    steps: &[TeamStep],
    wanted: &[Ordered],
) -> Option<Vec<(usize, Literal)>> {
    let mut states = vec![initial.clone()];
    for step in steps {
        let mut next = states[states.len() - 1].clone();
        interpreter.apply(&mut next, &step.action).ok()?;
        states.push(next);
    }
    let mut relied_on = Vec::new();
    for later in wanted.iter().filter(|w| !w.after.is_empty()) {
        let own = new_literals(later, wanted, initial);
        for (at, step) in steps.iter().enumerate() {
            let brings_about = |(condition, effect): (&GroundCondition, &Literal)| {
                own.contains(effect) && interpreter.holds(&states[at], condition)
            };
            if !step.action.literal_effects().any(brings_about) {
                continue;
            }
            for earlier in before(later, wanted).into_iter().map(|before| &wanted[before].condition) {
                relied_on.extend(earlier.witness(&states[at])?.into_iter().map(|literal| (at, literal)));
            }
        }
    }
    Some(relied_on)
}

/// What a sub-task asks for that neither holds at the start nor is asked for by one that it follows.
fn new_literals(later: &Ordered, wanted: &[Ordered], initial: &WorldState) -> BTreeSet<Literal> {
    let earlier: BTreeSet<&Literal> =
        before(later, wanted).into_iter().flat_map(|before| wanted[before].condition.literals()).collect();
    let literals = later.condition.literals().into_iter();
    let new = literals.filter(|l| !earlier.contains(l) && initial.facts.contains(&l.atom) != l.holds);
    new.cloned().collect()
}

/// All that a sub-task follows, the next one's predecessors included: the next one may hold already.
fn before(later: &Ordered, wanted: &[Ordered]) -> BTreeSet<usize> {
    all_before(&later.after, |next| &wanted[next].after)
}
