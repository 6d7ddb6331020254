//! Ground conditions: when they hold, and what is missing.

use std::collections::BTreeMap;
use std::fmt;

use lamma_pddl::ast::{ArithmeticOp, Comparison, GroundAtom};

use super::error::Unmet;
use super::state::{View, WorldState};
use crate::plan::Literal;

/// A condition without variables, in negation normal form.
#[derive(Clone, Debug, PartialEq)]
pub enum GroundCondition {
    /// All of them; empty means true.
    And(Vec<GroundCondition>),
    /// Any of them; empty means false.
    Or(Vec<GroundCondition>),
    /// A fact that holds or does not.
    Literal(Literal),
    /// A comparison; false where a function has no value.
    Compare(Comparison, GroundExpr, GroundExpr),
}

/// A number, or how to work one out.
#[derive(Clone, Debug, PartialEq)]
pub enum GroundExpr {
    /// A number.
    Number(f64),
    /// The value of a function.
    Value(GroundAtom),
    /// Arithmetic from left to right; a single operand under `-` is negation.
    Operation(ArithmeticOp, Vec<GroundExpr>),
}

impl GroundCondition {
    /// Always holds.
    pub const TRUE: GroundCondition = GroundCondition::And(Vec::new());
    /// Never holds.
    pub const FALSE: GroundCondition = GroundCondition::Or(Vec::new());

    /// Whether this is the condition that always holds.
    pub fn is_true(&self) -> bool {
        matches!(self, GroundCondition::And(parts) if parts.is_empty())
    }

    /// Whether this is the condition that never holds.
    pub fn is_false(&self) -> bool {
        matches!(self, GroundCondition::Or(parts) if parts.is_empty())
    }

    /// Literals that hold in `state` and make the condition true, whatever else changes but numbers; `None` if
    /// it is false. Of a disjunction, those of the first part that is true. Of a domain with axioms only basic
    /// facts are seen here: a derived fact counts as false.
    pub fn witness(&self, state: &WorldState) -> Option<Vec<Literal>> {
        self.witness_by(state, &|_| ())
    }

    /// [`Self::witness`], but of a disjunction the true part whose dearest literal is cheapest by `cost`; the
    /// first of several.
    pub fn witness_by<C: Ord + Default>(
        &self,
        state: &WorldState,
        cost: &impl Fn(&Literal) -> C,
    ) -> Option<Vec<Literal>> {
        match self {
            GroundCondition::And(parts) => {
                let witnesses =
                    parts.iter().map(|part| part.witness_by(state, cost)).collect::<Option<Vec<_>>>()?;
                Some(witnesses.concat())
            }
            GroundCondition::Or(parts) => {
                let mut holding = parts.iter().filter_map(|part| part.witness_by(state, cost));
                let first = holding.next()?;
                let Some(second) = holding.next() else { return Some(first) };
                let dearest = |witness: &Vec<Literal>| witness.iter().map(cost).max().unwrap_or_default();
                [first, second].into_iter().chain(holding).min_by_key(dearest)
            }
            GroundCondition::Literal(literal) => {
                (state.facts.contains(&literal.atom) == literal.holds).then(|| vec![literal.clone()])
            }
            GroundCondition::Compare(..) => {
                self.compare(&state.values).is_ok_and(|holds| holds).then(Vec::new)
            }
        }
    }

    /// Every literal in it, in the order of the text, repetitions included.
    pub fn literals(&self) -> Vec<&Literal> {
        match self {
            GroundCondition::And(parts) | GroundCondition::Or(parts) => {
                parts.iter().flat_map(GroundCondition::literals).collect()
            }
            GroundCondition::Literal(literal) => vec![literal],
            GroundCondition::Compare(..) => Vec::new(),
        }
    }

    pub(super) fn holds_in(&self, view: &View<'_>) -> bool {
        match self {
            GroundCondition::And(parts) => parts.iter().all(|part| part.holds_in(view)),
            GroundCondition::Or(parts) => parts.iter().any(|part| part.holds_in(view)),
            GroundCondition::Literal(literal) => view.contains(&literal.atom) == literal.holds,
            GroundCondition::Compare(..) => self.compare(&view.state.values).is_ok_and(|holds| holds),
        }
    }

    /// The conjuncts that do not hold.
    pub(super) fn unmet(&self, view: &View<'_>) -> Vec<Unmet> {
        match self {
            GroundCondition::And(parts) => parts.iter().flat_map(|part| part.unmet(view)).collect(),
            _ if self.holds_in(view) => Vec::new(),
            GroundCondition::Literal(literal) => vec![Unmet::Literal(literal.clone())],
            GroundCondition::Or(_) => vec![Unmet::Condition(self.clone())],
            GroundCondition::Compare(..) => match self.compare(&view.state.values) {
                Ok(_) => vec![Unmet::Condition(self.clone())],
                Err(undefined) => vec![undefined],
            },
        }
    }

    fn compare(&self, values: &BTreeMap<GroundAtom, f64>) -> Result<bool, Unmet> {
        let GroundCondition::Compare(op, left, right) = self else { return Ok(false) };
        let (left, right) = (left.value(values)?, right.value(values)?);
        Ok(match op {
            Comparison::Less => left < right,
            Comparison::LessEqual => left <= right,
            Comparison::Equal => left == right,
            Comparison::GreaterEqual => left >= right,
            Comparison::Greater => left > right,
        })
    }
}

impl GroundExpr {
    /// Its value, if every function in it has one and it is finite.
    pub fn value(&self, values: &BTreeMap<GroundAtom, f64>) -> Result<f64, Unmet> {
        let value = match self {
            GroundExpr::Number(number) => *number,
            GroundExpr::Value(function) => {
                *values.get(function).ok_or_else(|| Unmet::Undefined(function.clone()))?
            }
            GroundExpr::Operation(op, operands) => {
                let operands =
                    operands.iter().map(|operand| operand.value(values)).collect::<Result<Vec<_>, _>>()?;
                operate(*op, &operands)
            }
        };
        if value.is_finite() { Ok(value) } else { Err(Unmet::NotFinite(self.to_string())) }
    }
}

/// The value of an operation; not finite where it has none.
pub(crate) fn operate(op: ArithmeticOp, operands: &[f64]) -> f64 {
    match operands {
        [] => f64::NAN,
        [only] if op == ArithmeticOp::Subtract => -only,
        [first, others @ ..] => others.iter().fold(*first, |left, right| match op {
            ArithmeticOp::Add => left + right,
            ArithmeticOp::Subtract => left - right,
            ArithmeticOp::Multiply => left * right,
            ArithmeticOp::Divide => left / right,
        }),
    }
}

impl fmt::Display for GroundCondition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GroundCondition::And(parts) => write_list(f, "and", parts),
            GroundCondition::Or(parts) => write_list(f, "or", parts),
            GroundCondition::Literal(Literal { atom, holds: true }) => write!(f, "{atom}"),
            GroundCondition::Literal(Literal { atom, holds: false }) => write!(f, "(not {atom})"),
            GroundCondition::Compare(op, left, right) => write!(f, "({op} {left} {right})"),
        }
    }
}

impl fmt::Display for GroundExpr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GroundExpr::Number(number) => write!(f, "{number}"),
            GroundExpr::Value(function) => write!(f, "{function}"),
            GroundExpr::Operation(op, operands) => write_list(f, op, operands),
        }
    }
}

fn write_list<T: fmt::Display>(
    f: &mut fmt::Formatter<'_>,
    head: impl fmt::Display,
    items: &[T],
) -> fmt::Result {
    write!(f, "({head}")?;
    items.iter().try_for_each(|item| write!(f, " {item}"))?;
    f.write_str(")")
}
