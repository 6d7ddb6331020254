//! Replacing variables by objects, in one action or one condition at a time.

use std::sync::OnceLock;

use lamma_pddl::Name;
use lamma_pddl::ast::{
    Action, AssignOp, Atom, Comparison, Condition, Effect, FunctionTerm, GroundAtom, NumericExpr, Term,
    TypedName,
};

use super::Interpreter;
use super::condition::{GroundCondition, GroundExpr};
use super::error::{Unmet, Violation};
use super::state::{Effects, View};
use crate::plan::{GroundAct, Literal};

/// Ground parts one action or condition may have: nested quantifiers grow as a power.
const MAX_PARTS: usize = 2 << 20;

/// An action without variables.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundAction {
    /// Its name and arguments.
    pub act: GroundAct,
    /// When it may be done.
    pub precondition: GroundCondition,
    /// What it does. All conditions are about the state before; all deletes happen before all adds.
    pub effects: Vec<GroundEffect>,
    /// How long it takes; the number 1 where the domain says nothing. See [`Interpreter::duration`].
    pub duration: GroundExpr,
    by_fact: ByFact,
}

/// The effects on facts in the order of the facts, once somebody has asked: an action over all objects has thousands.
#[derive(Clone, Debug, Default)]
struct ByFact(OnceLock<Box<[u32]>>);

/// It says nothing that the effects do not.
impl PartialEq for ByFact {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// One outcome and when it happens.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundEffect {
    /// Only if this held before the action.
    pub condition: GroundCondition,
    /// What happens.
    pub outcome: Outcome,
}

/// One thing that happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A fact becomes true or false.
    Literal(Literal),
    /// A number changes.
    Assign(AssignOp, GroundAtom, GroundExpr),
}

impl GroundAction {
    /// The effects on facts, each with its condition.
    pub fn literal_effects(&self) -> impl Iterator<Item = (&GroundCondition, &Literal)> {
        self.effects.iter().filter_map(GroundEffect::on_fact)
    }

    /// The effects on one fact, in their order, each with its condition.
    pub fn effects_on(&self, fact: &GroundAtom) -> impl Iterator<Item = (&GroundCondition, &Literal)> {
        let effect = |index: &u32| self.effects[*index as usize].on_fact();
        let by_fact = self.by_fact.0.get_or_init(|| {
            let all = 0..self.effects.len() as u32;
            let mut all: Vec<u32> = all.filter(|index| effect(index).is_some()).collect();
            all.sort_by_key(|index| effect(index).map(|(_, literal)| &literal.atom));
            all.into()
        });
        let start =
            by_fact.partition_point(|i| effect(i).is_some_and(|(_, literal)| literal.atom.cmp(fact).is_lt()));
        let rest = by_fact[start..].iter();
        rest.filter_map(move |i| self.effects[*i as usize].on_fact())
            .take_while(move |(_, literal)| literal.atom == *fact)
    }

    /// What happens in this state, all of it worked out before any of it happens.
    pub(super) fn evaluate(&self, view: &View<'_>) -> Result<Effects, Violation> {
        let mut effects = Effects::default();
        for effect in self.effects.iter().filter(|effect| effect.condition.holds_in(view)) {
            match &effect.outcome {
                Outcome::Literal(Literal { atom, holds }) => {
                    let set = if *holds { &mut effects.adds } else { &mut effects.deletes };
                    set.insert(atom.clone());
                }
                Outcome::Assign(op, function, expression) => {
                    let value = assigned(&effects, view, *op, function, expression)
                        .map_err(|unmet| Violation { act: self.act.clone(), unmet: vec![unmet] })?;
                    effects.values.insert(function.clone(), value);
                }
            }
        }
        Ok(effects)
    }
}

impl GroundEffect {
    fn on_fact(&self) -> Option<(&GroundCondition, &Literal)> {
        match &self.outcome {
            Outcome::Literal(literal) => Some((&self.condition, literal)),
            Outcome::Assign(..) => None,
        }
    }
}

/// The new value. Several changes of one number by one action add up, as PDDL 2.1 demands of `increase` and
/// `decrease`; expressions see only the state before.
fn assigned(
    effects: &Effects,
    view: &View<'_>,
    op: AssignOp,
    function: &GroundAtom,
    expression: &GroundExpr,
) -> Result<f64, Unmet> {
    let operand = expression.value(&view.state.values)?;
    if op == AssignOp::Assign {
        return Ok(operand);
    }
    let before = effects.values.get(function).or_else(|| view.state.values.get(function));
    let before = *before.ok_or_else(|| Unmet::Undefined(function.clone()))?;
    let value = match op {
        AssignOp::Assign => operand,
        AssignOp::Increase => before + operand,
        AssignOp::Decrease => before - operand,
        AssignOp::ScaleUp => before * operand,
        AssignOp::ScaleDown => before / operand,
    };
    let shown = || Unmet::NotFinite(format!("({op} {function} {expression})"));
    if value.is_finite() { Ok(value) } else { Err(shown()) }
}

/// Bindings of variables, the innermost last, and how much may still be built.
pub(super) struct Grounder<'i> {
    interpreter: &'i Interpreter,
    bindings: Vec<(Name, Name)>,
    parts_left: usize,
}

/// `None` where there would be more than `MAX_PARTS`.
impl<'i> Grounder<'i> {
    pub fn new(interpreter: &'i Interpreter, bindings: Vec<(Name, Name)>) -> Self {
        Grounder { interpreter, bindings, parts_left: MAX_PARTS }
    }

    pub fn action(mut self, action: &Action, act: &GroundAct) -> Option<GroundAction> {
        let precondition = self.condition(&action.precondition, true)?;
        let mut effects = Vec::new();
        self.effect(&action.effect, &GroundCondition::TRUE, &mut effects)?;
        let duration = action.duration.as_ref().map_or(GroundExpr::Number(1.0), |e| self.expression(e));
        Some(GroundAction { act: act.clone(), precondition, effects, duration, by_fact: ByFact::default() })
    }

    pub fn condition(&mut self, condition: &Condition, positive: bool) -> Option<GroundCondition> {
        self.parts_left = self.parts_left.checked_sub(1)?;
        Some(match (condition, positive) {
            (Condition::And(parts), true) | (Condition::Or(parts), false) => {
                return self.all(parts.iter().map(|part| (part, positive)));
            }
            (Condition::Or(parts), true) | (Condition::And(parts), false) => {
                return self.any(parts.iter().map(|part| (part, positive)));
            }
            (Condition::Not(inner), _) => return self.condition(inner, !positive),
            (Condition::Imply(if_, then), true) => {
                return self.any([(&**if_, false), (&**then, true)].into_iter());
            }
            (Condition::Imply(if_, then), false) => {
                return self.all([(&**if_, true), (&**then, false)].into_iter());
            }
            (Condition::Forall(params, body), _) => return self.quantified(params, body, positive, positive),
            (Condition::Exists(params, body), _) => {
                return self.quantified(params, body, positive, !positive);
            }
            (Condition::Atom(atom), _) => {
                GroundCondition::Literal(Literal { atom: self.atom(atom), holds: positive })
            }
            (Condition::Equal(left, right), _) => {
                if (self.term(left) == self.term(right)) == positive {
                    GroundCondition::TRUE
                } else {
                    GroundCondition::FALSE
                }
            }
            (Condition::Compare(op, left, right), _) => {
                compare(*op, self.expression(left), self.expression(right), positive)
            }
        })
    }

    fn all<'c>(&mut self, parts: impl Iterator<Item = (&'c Condition, bool)>) -> Option<GroundCondition> {
        let mut ground = Vec::new();
        for (part, positive) in parts {
            let part = self.condition(part, positive)?;
            if join(&mut ground, part, true) {
                return Some(GroundCondition::FALSE);
            }
        }
        Some(single_or(ground, GroundCondition::And))
    }

    fn any<'c>(&mut self, parts: impl Iterator<Item = (&'c Condition, bool)>) -> Option<GroundCondition> {
        let mut ground = Vec::new();
        for (part, positive) in parts {
            let part = self.condition(part, positive)?;
            if join(&mut ground, part, false) {
                return Some(GroundCondition::TRUE);
            }
        }
        Some(single_or(ground, GroundCondition::Or))
    }

    /// `forall` as a conjunction, `exists` as a disjunction, and the other way round under a negation.
    fn quantified(
        &mut self,
        params: &[TypedName],
        body: &Condition,
        positive: bool,
        conjunction: bool,
    ) -> Option<GroundCondition> {
        let mut ground = Vec::new();
        let mut decided = false;
        self.for_each(params, &mut |grounder| {
            if !decided {
                let part = grounder.condition(body, positive)?;
                decided = join(&mut ground, part, conjunction);
            }
            Some(())
        })?;
        Some(match (decided, conjunction) {
            (true, true) => GroundCondition::FALSE,
            (true, false) => GroundCondition::TRUE,
            (false, true) => single_or(ground, GroundCondition::And),
            (false, false) => single_or(ground, GroundCondition::Or),
        })
    }

    /// Calls `visit` with every binding of the parameters.
    fn for_each(
        &mut self,
        params: &[TypedName],
        visit: &mut dyn FnMut(&mut Self) -> Option<()>,
    ) -> Option<()> {
        let Some((first, others)) = params.split_first() else { return visit(self) };
        let interpreter = self.interpreter;
        for object in interpreter.of_types(&first.types).iter() {
            self.parts_left = self.parts_left.checked_sub(1)?;
            self.bindings.push((first.name.clone(), object.clone()));
            let done = self.for_each(others, visit);
            self.bindings.pop();
            done?;
        }
        Some(())
    }

    fn effect(
        &mut self,
        effect: &Effect,
        when: &GroundCondition,
        into: &mut Vec<GroundEffect>,
    ) -> Option<()> {
        self.parts_left = self.parts_left.checked_sub(1)?;
        let outcome = match effect {
            Effect::And(parts) => return parts.iter().try_for_each(|part| self.effect(part, when, into)),
            Effect::Forall(params, body) => {
                return self.for_each(params, &mut |grounder| grounder.effect(body, when, into));
            }
            Effect::When(condition, body) => {
                let mut both = Vec::new();
                let condition = self.condition(condition, true)?;
                if join(&mut both, when.clone(), true) || join(&mut both, condition, true) {
                    return Some(());
                }
                return self.effect(body, &single_or(both, GroundCondition::And), into);
            }
            Effect::Add(atom) => Outcome::Literal(Literal { atom: self.atom(atom), holds: true }),
            Effect::Delete(atom) => Outcome::Literal(Literal { atom: self.atom(atom), holds: false }),
            Effect::Assign(op, function, value) => {
                Outcome::Assign(*op, self.function(function), self.expression(value))
            }
        };
        into.push(GroundEffect { condition: when.clone(), outcome });
        Some(())
    }

    pub fn expression(&self, expression: &NumericExpr) -> GroundExpr {
        match expression {
            NumericExpr::Number(number) => GroundExpr::Number(number.value()),
            NumericExpr::Function(function) => GroundExpr::Value(self.function(function)),
            NumericExpr::Operation(op, operands) => {
                GroundExpr::Operation(*op, operands.iter().map(|operand| self.expression(operand)).collect())
            }
        }
    }

    fn atom(&self, atom: &Atom) -> GroundAtom {
        let args = atom.args.iter().map(|term| self.term(term).clone()).collect();
        GroundAtom { predicate: atom.predicate.clone(), args }
    }

    fn function(&self, function: &FunctionTerm) -> GroundAtom {
        let args = function.args.iter().map(|term| self.term(term).clone()).collect();
        GroundAtom { predicate: function.function.clone(), args }
    }

    fn term<'t>(&'t self, term: &'t Term) -> &'t Name {
        match term {
            Term::Constant(name) => name,
            Term::Variable(name) => self.bound(name),
        }
    }

    fn bound(&self, variable: &Name) -> &Name {
        let bound = self.bindings.iter().rev().find(|(name, _)| name == variable);
        &bound.expect("scopes are checked before anything is grounded").1
    }
}

/// Adds a part to a conjunction (or disjunction), flattened. Whether the whole is now decided: false (or true).
fn join(parts: &mut Vec<GroundCondition>, part: GroundCondition, conjunction: bool) -> bool {
    match part {
        GroundCondition::And(inner) if conjunction => parts.extend(inner),
        GroundCondition::Or(inner) if !conjunction => parts.extend(inner),
        GroundCondition::And(inner) | GroundCondition::Or(inner) if inner.is_empty() => return true,
        part => parts.push(part),
    }
    false
}

fn single_or(
    mut parts: Vec<GroundCondition>,
    whole: fn(Vec<GroundCondition>) -> GroundCondition,
) -> GroundCondition {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        last => {
            parts.extend(last);
            whole(parts)
        }
    }
}

/// A comparison or its negation. Where a function has no value both are false.
fn compare(op: Comparison, left: GroundExpr, right: GroundExpr, positive: bool) -> GroundCondition {
    let op = match (op, positive) {
        (op, true) => op,
        (Comparison::Less, false) => Comparison::GreaterEqual,
        (Comparison::LessEqual, false) => Comparison::Greater,
        (Comparison::GreaterEqual, false) => Comparison::Less,
        (Comparison::Greater, false) => Comparison::LessEqual,
        (Comparison::Equal, false) => {
            return GroundCondition::Or(vec![
                GroundCondition::Compare(Comparison::Less, left.clone(), right.clone()),
                GroundCondition::Compare(Comparison::Greater, left, right),
            ]);
        }
    };
    GroundCondition::Compare(op, left, right)
}

/// Evaluating a lifted condition without building its ground form: axioms have too many instances to keep.
impl Grounder<'_> {
    /// Whether a condition holds under the bindings.
    pub fn holds(&mut self, condition: &Condition, view: &View<'_>) -> bool {
        match condition {
            Condition::And(parts) => parts.iter().all(|part| self.holds(part, view)),
            Condition::Or(parts) => parts.iter().any(|part| self.holds(part, view)),
            Condition::Not(inner) => !self.holds(inner, view),
            Condition::Imply(if_, then) => !self.holds(if_, view) || self.holds(then, view),
            Condition::Exists(params, body) => self.some(params, &mut |grounder| grounder.holds(body, view)),
            Condition::Forall(params, body) => {
                !self.some(params, &mut |grounder| !grounder.holds(body, view))
            }
            Condition::Atom(atom) => view.contains(&self.atom(atom)),
            Condition::Equal(left, right) => self.term(left) == self.term(right),
            Condition::Compare(op, left, right) => {
                compare(*op, self.expression(left), self.expression(right), true).holds_in(view)
            }
        }
    }

    /// Whether `holds` says yes to some binding of the parameters.
    fn some(&mut self, params: &[TypedName], holds: &mut dyn FnMut(&mut Self) -> bool) -> bool {
        let Some((first, others)) = params.split_first() else { return holds(self) };
        let interpreter = self.interpreter;
        interpreter.of_types(&first.types).iter().any(|object| {
            self.bindings.push((first.name.clone(), object.clone()));
            let found = self.some(others, holds);
            self.bindings.pop();
            found
        })
    }
}
