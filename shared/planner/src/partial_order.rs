//! From a linear plan of a team to a partial order that keeps only what is needed.
//!
//! The plan is explained on the plain semantics: every fact that a step or the goal needs gets a causal
//! link from the step that made it true (McAllester & Rosenblitt, "Systematic nonlinear planning", AAAI
//! 1991), and every step that could make it false again stays where the linear plan had it: before the
//! producer or after the consumer. All other orderings are dropped (deordering, Bäckström, "Computational
//! aspects of reordering plans", JAIR 9, 1998). A conditional effect that did not fire but could threaten a
//! link is confronted: the reason why it did not fire becomes a need of its own (Penberthy & Weld, "UCPOP",
//! KR 1992). Each linearisation of the result reaches the goal from the same state.
//!
//! Deviations: durations do not split a step into start and end; numbers and derived predicates are not
//! linked but keep the linear order of the steps that touch them.

use std::cmp::Reverse;
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use crate::interpreter::{GroundAction, GroundCondition, Interpreter, Outcome, Violation, WorldState};
use crate::plan::Literal;

/// A step of a team's plan.
#[derive(Clone, Debug)]
pub struct TeamStep {
    /// Who does it: an index into the team.
    pub agent: usize,
    /// What is done.
    pub action: Arc<GroundAction>,
}

/// Steps in a valid linear order, and for each the steps that must come before it.
#[derive(Clone, Debug)]
pub struct PartialOrder {
    /// The steps, in the linear order they were given.
    pub steps: Vec<TeamStep>,
    /// How long each step takes.
    pub durations: Vec<f64>,
    /// Direct predecessors of each step, by index; transitively reduced.
    pub before: Vec<BTreeSet<usize>>,
    /// Why the order is as it is: who makes what true for whom.
    pub links: Vec<CausalLink>,
}

/// One step relies on what another made true.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CausalLink {
    /// The step that made the literal true; none if it was so at the start.
    pub producer: Option<usize>,
    /// The step that needs it; one past the last step stands for the goal.
    pub consumer: usize,
    /// What is needed.
    pub literal: Literal,
}

/// A step, or the goal (one past the last step), relies on a literal.
struct Need {
    consumer: usize,
    literal: Literal,
}

struct Explainer<'a> {
    states: Vec<WorldState>,
    steps: &'a [TeamStep],
    /// `before[i]` holds `j` when `j` must come before `i`.
    before: Vec<BTreeSet<usize>>,
    queue: VecDeque<Need>,
    seen: BTreeSet<(usize, Literal)>,
    links: Vec<CausalLink>,
}

/// Drops every ordering of the linear plan `steps` that neither a causal link, a threat, an agent's own
/// sequence nor `keep` asks for. `keep` holds pairs (earlier, later) of step indices.
///
/// Errors with the violated step if the linear plan is not valid from `initial`.
pub fn deorder(
    interpreter: &Interpreter,
    initial: &WorldState,
    steps: Vec<TeamStep>,
    goal: &GroundCondition,
    keep: &[(usize, usize)],
) -> Result<PartialOrder, (usize, Violation)> {
    deorder_with(interpreter, initial, steps, goal, keep, &[])
}

/// [`deorder`] where steps rely on more than their preconditions: pairs of a step and what holds when it runs.
pub fn deorder_with(
    interpreter: &Interpreter,
    initial: &WorldState,
    steps: Vec<TeamStep>,
    goal: &GroundCondition,
    keep: &[(usize, usize)],
    relied_on: &[(usize, Literal)],
) -> Result<PartialOrder, (usize, Violation)> {
    let states = trace(interpreter, initial, &steps)?;
    deorder_along(interpreter, states, steps, goal, keep, relied_on)
}

/// [`deorder_with`] where the states that the plan passes are known: one before each step, and the last.
pub fn deorder_along(
    interpreter: &Interpreter,
    states: Vec<WorldState>,
    steps: Vec<TeamStep>,
    goal: &GroundCondition,
    keep: &[(usize, usize)],
    relied_on: &[(usize, Literal)],
) -> Result<PartialOrder, (usize, Violation)> {
    let duration = |(i, step): (usize, &TeamStep)| {
        interpreter.duration(&states[i], &step.action).map_err(|violation| (i, violation))
    };
    let durations = steps.iter().enumerate().map(duration).collect::<Result<_, _>>()?;
    let mut explainer = Explainer {
        states,
        before: vec![BTreeSet::new(); steps.len()],
        steps: &steps,
        queue: VecDeque::new(),
        seen: BTreeSet::new(),
        links: Vec::new(),
    };
    for (step, literal) in relied_on {
        explainer.need(*step, vec![literal.clone()]);
    }
    explainer.link_all(goal);
    explainer.order_threats();
    explainer.order_own_sequences();
    explainer.order_untracked(interpreter);
    for &(earlier, later) in keep {
        if earlier < later {
            explainer.before[later].insert(earlier);
        }
    }
    let before = transitive_reduction(&explainer.before);
    let links = explainer.links;
    Ok(PartialOrder { steps, durations, before, links })
}

fn trace(
    interpreter: &Interpreter,
    initial: &WorldState,
    steps: &[TeamStep],
) -> Result<Vec<WorldState>, (usize, Violation)> {
    let mut states = vec![initial.clone()];
    for (i, step) in steps.iter().enumerate() {
        let mut next = states[i].clone();
        interpreter.apply(&mut next, &step.action).map_err(|violation| (i, violation))?;
        states.push(next);
    }
    Ok(states)
}

impl Explainer<'_> {
    fn link_all(&mut self, goal: &GroundCondition) {
        for (i, step) in self.steps.iter().enumerate() {
            let witness = self.witness(i, &step.action.precondition);
            self.need(i, witness.unwrap_or_default());
        }
        let end = self.steps.len();
        let witness = self.witness(end, goal);
        self.need(end, witness.unwrap_or_default());
        while let Some(Need { consumer, literal }) = self.queue.pop_front() {
            let producer = self.producer(consumer, &literal);
            if let Some(p) = producer {
                if consumer < end {
                    self.before[consumer].insert(p);
                }
                let reason = self.reason_of_effect(p, &literal);
                self.need(p, reason);
            }
            self.confront(producer, consumer, &literal);
            self.links.push(CausalLink { producer, consumer, literal });
        }
    }

    /// Why the condition holds before a step. Where there is a choice, what became true earliest and stays true
    /// longest ties the step least to others.
    fn witness(&self, at: usize, condition: &GroundCondition) -> Option<Vec<Literal>> {
        let ties = |literal: &Literal| {
            let after = at + 1..self.steps.len();
            let undone = after.clone().find(|&i| can_undo(&self.steps[i].action, literal));
            (self.producer(at, literal), Reverse(undone.unwrap_or(after.end)))
        };
        condition.witness_by(&self.states[at], &|literal| Some(ties(literal)))
    }

    fn need(&mut self, consumer: usize, literals: Vec<Literal>) {
        for literal in literals {
            if self.seen.insert((consumer, literal.clone())) {
                self.queue.push_back(Need { consumer, literal });
            }
        }
    }

    /// The step that made the literal true for the last time before the consumer; none if it was so at
    /// the start.
    fn producer(&self, consumer: usize, literal: &Literal) -> Option<usize> {
        (0..consumer).rev().find(|&i| {
            holds(&self.states[i + 1], literal)
                && (!holds(&self.states[i], literal) || self.makes_good(i, literal))
        })
    }

    /// Whether the step undoes the literal and makes it true again under a condition, as who goes from the
    /// table to the apple on the table is at the table still: elsewhere in the order it might not be.
    fn makes_good(&self, step: usize, literal: &Literal) -> bool {
        let action = &self.steps[step].action;
        can_undo(action, literal) && undoing(action, literal).any(|c| c.witness(&self.states[step]).is_some())
    }

    /// What had to be true for the step to have that effect, beyond its precondition.
    fn reason_of_effect(&self, step: usize, literal: &Literal) -> Vec<Literal> {
        let effects = self.steps[step].action.effects_on(&literal.atom);
        effects
            .filter(|(_, effect)| *effect == literal)
            .find_map(|(condition, _)| self.witness(step, condition))
            .unwrap_or_default()
    }

    /// Conditional effects between producer and consumer that did not fire, but would undo the literal if
    /// they did: why they did not becomes a need.
    fn confront(&mut self, producer: Option<usize>, consumer: usize, literal: &Literal) {
        for i in producer.map_or(0, |p| p + 1)..consumer {
            let reasons: Vec<Literal> = undoing(&self.steps[i].action, literal)
                .flat_map(|condition| self.witness(i, &negated(condition)).unwrap_or_default())
                .collect();
            self.need(i, reasons);
        }
    }

    fn order_threats(&mut self) {
        let end = self.steps.len();
        let links = std::mem::take(&mut self.links);
        for CausalLink { producer, consumer, literal } in &links {
            for t in 0..end {
                if Some(t) == *producer || t == *consumer || !can_undo(&self.steps[t].action, literal) {
                    continue;
                }
                match producer {
                    Some(p) if t < *p => {
                        self.before[*p].insert(t);
                    }
                    _ if t > *consumer => {
                        self.before[t].insert(*consumer);
                    }
                    // Between the two: confronted, so that it cannot fire.
                    _ => {}
                }
            }
        }
        self.links = links;
    }

    fn order_own_sequences(&mut self) {
        let mut last: Vec<Option<usize>> = Vec::new();
        for (i, step) in self.steps.iter().enumerate() {
            if step.agent >= last.len() {
                last.resize(step.agent + 1, None);
            }
            if let Some(previous) = last[step.agent].replace(i) {
                self.before[i].insert(previous);
            }
        }
    }

    /// Numbers and derived predicates: the linear order stays.
    fn order_untracked(&mut self, interpreter: &Interpreter) {
        let all = interpreter.has_axioms();
        let untracked: Vec<usize> =
            (0..self.steps.len()).filter(|&i| all || touches_numbers(&self.steps[i].action)).collect();
        for pair in untracked.windows(2) {
            self.before[pair[1]].insert(pair[0]);
        }
    }
}

/// Whether the action reads or changes a number.
fn touches_numbers(action: &GroundAction) -> bool {
    fn compares(condition: &GroundCondition) -> bool {
        match condition {
            GroundCondition::And(parts) | GroundCondition::Or(parts) => parts.iter().any(compares),
            GroundCondition::Literal(_) => false,
            GroundCondition::Compare(..) => true,
        }
    }
    compares(&action.precondition)
        || action.effects.iter().any(|e| matches!(e.outcome, Outcome::Assign(..)) || compares(&e.condition))
}

/// The negation, again in negation normal form. Comparisons are left out (as if they failed): the steps
/// that touch numbers keep their order anyway.
fn negated(condition: &GroundCondition) -> GroundCondition {
    match condition {
        GroundCondition::And(parts) => GroundCondition::Or(parts.iter().map(negated).collect()),
        GroundCondition::Or(parts) => GroundCondition::And(parts.iter().map(negated).collect()),
        GroundCondition::Literal(literal) => {
            GroundCondition::Literal(Literal { atom: literal.atom.clone(), holds: !literal.holds })
        }
        GroundCondition::Compare(..) => GroundCondition::TRUE,
    }
}

fn holds(state: &WorldState, literal: &Literal) -> bool {
    state.facts.contains(&literal.atom) == literal.holds
}

/// Conditions of the effects that would make the literal false.
fn undoing<'a>(
    action: &'a GroundAction,
    literal: &'a Literal,
) -> impl Iterator<Item = &'a GroundCondition> + 'a {
    let effects = action.effects_on(&literal.atom);
    effects.filter(|(_, effect)| effect.holds != literal.holds).map(|(condition, _)| condition)
}

/// Whether the action might make the literal false in some state. A delete that is always made good by an
/// unconditional add of the same action does not count.
fn can_undo(action: &GroundAction, literal: &Literal) -> bool {
    let makes_good = literal.holds
        && action.effects_on(&literal.atom).any(|(condition, effect)| effect.holds && condition.is_true());
    !makes_good && undoing(action, literal).next().is_some()
}

fn transitive_reduction(before: &[BTreeSet<usize>]) -> Vec<BTreeSet<usize>> {
    // All predecessors of each step; the linear order is a topological one.
    let mut all: Vec<BTreeSet<usize>> = Vec::with_capacity(before.len());
    let mut reduced = Vec::with_capacity(before.len());
    for direct in before {
        let mut closure = BTreeSet::new();
        let mut kept = BTreeSet::new();
        for &p in direct.iter().rev() {
            if !closure.contains(&p) {
                kept.insert(p);
                closure.extend(all[p].iter().copied());
                closure.insert(p);
            }
        }
        all.push(closure);
        reduced.push(kept);
    }
    reduced
}

impl PartialOrder {
    /// The earliest start of each step when everybody acts as soon as the order allows, in steps.
    pub fn earliest_starts(&self) -> Vec<f64> {
        let mut starts: Vec<f64> = Vec::with_capacity(self.steps.len());
        for before in &self.before {
            let start = before.iter().map(|&p| starts[p] + self.durations[p]).fold(0.0, f64::max);
            starts.push(start);
        }
        starts
    }

    /// When the last step ends.
    pub fn makespan(&self) -> f64 {
        self.earliest_starts()
            .iter()
            .zip(&self.durations)
            .map(|(start, duration)| start + duration)
            .fold(0.0, f64::max)
    }

    /// For each step: the other agents it waits for, and how many of their steps must be done.
    pub fn gates(&self) -> Vec<Vec<(usize, u32)>> {
        let mut count: Vec<u32> = Vec::new();
        let mut position = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            if step.agent >= count.len() {
                count.resize(step.agent + 1, 0);
            }
            count[step.agent] += 1;
            position.push(count[step.agent]);
        }
        let gate = |i: usize| {
            let mut needed: std::collections::BTreeMap<usize, u32> = Default::default();
            for &p in &self.before[i] {
                let other = self.steps[p].agent;
                if other != self.steps[i].agent {
                    let done = needed.entry(other).or_insert(0);
                    *done = (*done).max(position[p]);
                }
            }
            needed.into_iter().collect()
        };
        (0..self.steps.len()).map(gate).collect()
    }
}
