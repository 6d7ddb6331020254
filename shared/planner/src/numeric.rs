//! Numbers in states (PDDL 2.1 level 2, Fox & Long 2003): expressions over them, comparisons, and how
//! operators change them.
//!
//! A state carries its numbers behind its packed words, as the bits of doubles. A comparison is a derived
//! variable of two values, worked out before the axioms, so that conditions, successor generation and
//! heuristics see a fact like any other ("comparison axioms": Aldinger & Nebel 2017, "Interval based
//! relaxation heuristics for numeric planning with action costs", section 2).

use std::collections::BTreeMap;

use lamma_pddl::ast::{ArithmeticOp, AssignOp};

use crate::csr::Csr;
use crate::task::FactId;

/// How the two sides of a comparison relate. Others are written with these: `a < b` is `b > a`, `a = b` is
/// `a >= b` and `b >= a`. Where a side has no value, none of them holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relation {
    /// `left >= right`
    AtLeast,
    /// `left > right`
    Above,
    /// `left` and `right` are two different numbers.
    Differs,
}

impl Relation {
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Relation::AtLeast => left >= right,
            Relation::Above => left > right,
            Relation::Differs => left != right && !left.is_nan() && !right.is_nan(),
        }
    }
}

/// A number, or how to work one out from the numbers of a state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    Constant(f64),
    /// The number with this index.
    Variable(u32),
    /// From left to right; a single operand under `-` is negation.
    Operation(ArithmeticOp, Box<[Expression]>),
}

impl Expression {
    /// An operation, worked out where its operands are constants.
    pub fn operation(op: ArithmeticOp, parts: Vec<Expression>) -> Expression {
        let whole = Expression::Operation(op, parts.into_boxed_slice());
        if let Expression::Operation(_, parts) = &whole
            && parts.iter().all(|part| part.constant().is_some())
        {
            return Expression::Constant(whole.value(&[]));
        }
        whole
    }

    /// The value, if it does not depend on the state.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Expression::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// The value among `numbers`; NaN where one of them has no value or the result is not finite.
    pub fn value(&self, numbers: &[u64]) -> f64 {
        let value = match self {
            Expression::Constant(value) => *value,
            Expression::Variable(variable) => f64::from_bits(numbers[*variable as usize]),
            Expression::Operation(op, parts) => {
                let mut values = parts.iter().map(|part| part.value(numbers));
                match (values.next(), parts.len()) {
                    (Some(only), 1) if *op == ArithmeticOp::Subtract => -only,
                    (Some(first), _) => values.fold(first, |left, right| calculate(*op, left, right)),
                    (None, _) => f64::NAN,
                }
            }
        };
        if value.is_finite() { value } else { f64::NAN }
    }

    /// Calls `visit` with every variable in it.
    pub fn for_each_variable(&self, visit: &mut impl FnMut(u32)) {
        match self {
            Expression::Constant(_) => {}
            Expression::Variable(variable) => visit(*variable),
            Expression::Operation(_, parts) => parts.iter().for_each(|part| part.for_each_variable(visit)),
        }
    }

    /// The same with other numbers for the variables.
    pub fn renumbered(&self, number: &impl Fn(u32) -> u32) -> Expression {
        match self {
            Expression::Constant(value) => Expression::Constant(*value),
            Expression::Variable(variable) => Expression::Variable(number(*variable)),
            Expression::Operation(op, parts) => {
                Expression::Operation(*op, parts.iter().map(|part| part.renumbered(number)).collect())
            }
        }
    }

    /// Whether a part of it is a division, which may have no result.
    pub fn divides(&self) -> bool {
        match self {
            Expression::Constant(_) | Expression::Variable(_) => false,
            Expression::Operation(op, parts) => {
                *op == ArithmeticOp::Divide || parts.iter().any(Expression::divides)
            }
        }
    }

    /// Adds `factor` times the coefficients of this, if it is linear; says whether it is.
    fn add_linear(&self, factor: f64, coefficients: &mut BTreeMap<u32, f64>) -> bool {
        match self {
            Expression::Constant(_) => true,
            Expression::Variable(variable) => {
                *coefficients.entry(*variable).or_default() += factor;
                true
            }
            Expression::Operation(ArithmeticOp::Add, parts) => {
                parts.iter().all(|part| part.add_linear(factor, coefficients))
            }
            Expression::Operation(ArithmeticOp::Subtract, parts) => {
                let single = parts.len() == 1;
                parts.iter().enumerate().all(|(at, part)| {
                    let sign = if at == 0 && !single { factor } else { -factor };
                    part.add_linear(sign, coefficients)
                })
            }
            Expression::Operation(ArithmeticOp::Multiply, parts) => {
                let constant: f64 = parts.iter().filter_map(Expression::constant).product();
                let mut others = parts.iter().filter(|part| part.constant().is_none());
                match (others.next(), others.next()) {
                    (Some(part), None) => part.add_linear(factor * constant, coefficients),
                    _ => false,
                }
            }
            Expression::Operation(ArithmeticOp::Divide, parts) => match &parts[..] {
                [part, Expression::Constant(by)] => part.add_linear(factor / by, coefficients),
                _ => false,
            },
        }
    }
}

/// `left op right`.
pub(crate) fn calculate(op: ArithmeticOp, left: f64, right: f64) -> f64 {
    match op {
        ArithmeticOp::Add => left + right,
        ArithmeticOp::Subtract => left - right,
        ArithmeticOp::Multiply => left * right,
        ArithmeticOp::Divide => left / right,
    }
}

/// A comparison of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Comparison {
    pub relation: Relation,
    pub left: Expression,
    pub right: Expression,
}

impl Comparison {
    pub fn holds(&self, numbers: &[u64]) -> bool {
        self.relation.holds(self.left.value(numbers), self.right.value(numbers))
    }

    /// How far `left - right` is below zero; NaN where a side has no value.
    pub fn gap(&self, numbers: &[u64]) -> f64 {
        self.right.value(numbers) - self.left.value(numbers)
    }

    /// What `left - right` grows by with each variable, if it is linear.
    pub fn coefficients(&self) -> Option<BTreeMap<u32, f64>> {
        let mut coefficients = BTreeMap::new();
        let linear = self.left.add_linear(1.0, &mut coefficients)
            && self.right.add_linear(-1.0, &mut coefficients)
            && coefficients.values().all(|factor| factor.is_finite());
        linear.then_some(coefficients)
    }

    /// Whether there is a side on which to be: more is better.
    pub fn is_directed(&self) -> bool {
        self.relation != Relation::Differs
    }

    pub fn for_each_variable(&self, visit: &mut impl FnMut(u32)) {
        self.left.for_each_variable(visit);
        self.right.for_each_variable(visit);
    }

    pub fn renumbered(&self, number: &impl Fn(u32) -> u32) -> Comparison {
        let (left, right) = (self.left.renumbered(number), self.right.renumbered(number));
        Comparison { relation: self.relation, left, right }
    }
}

/// Changes a number where its condition held before.
#[derive(Clone, Debug)]
pub(crate) struct NumericEffect {
    /// A row of [`crate::task::Task::effect_conditions`].
    pub condition: u32,
    pub op: AssignOp,
    pub target: u32,
    pub value: Expression,
}

impl NumericEffect {
    /// The new value, from that of `value` before the operator and the target's so far.
    pub fn result(op: AssignOp, before: f64, operand: f64) -> f64 {
        let value = match op {
            AssignOp::Assign => operand,
            AssignOp::Increase => before + operand,
            AssignOp::Decrease => before - operand,
            AssignOp::ScaleUp => before * operand,
            AssignOp::ScaleDown => before / operand,
        };
        // One zero, so that equal states have equal bits.
        if value.is_finite() { value + 0.0 } else { f64::NAN }
    }

    /// What the target grows by, if that is the same in every state.
    pub fn gain(&self) -> Option<f64> {
        let value = self.value.constant()?;
        match self.op {
            AssignOp::Increase => Some(value),
            AssignOp::Decrease => Some(-value),
            AssignOp::Assign | AssignOp::ScaleUp | AssignOp::ScaleDown => None,
        }
    }
}

/// The numbers of a task.
#[derive(Debug, Default)]
pub(crate) struct Numeric {
    /// Where they start in a state.
    pub base: usize,
    /// At first; NaN: no value.
    pub initial: Vec<f64>,
    /// Each with the fact that it holds.
    pub comparisons: Vec<(FactId, Comparison)>,
    /// By operator. All of one operator see the state before it.
    pub effects: Csr<NumericEffect>,
    /// Operators whose effects may have no result, by which they do not apply.
    pub fallible: Vec<bool>,
}

impl Numeric {
    pub fn of<'s>(&self, state: &'s [u64]) -> &'s [u64] {
        &state[self.base..]
    }

    pub fn effects_of(&self, operator: usize) -> &[NumericEffect] {
        if self.initial.is_empty() { &[] } else { self.effects.row(operator) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(op: ArithmeticOp, parts: &[Expression]) -> Expression {
        Expression::operation(op, parts.to_vec())
    }

    #[test]
    fn expressions_have_values_only_where_all_of_them_do() {
        let x = Expression::Variable(0);
        let numbers = [3.0f64.to_bits(), f64::NAN.to_bits()];
        let half = over(ArithmeticOp::Divide, &[x.clone(), Expression::Constant(2.0)]);
        assert_eq!(half.value(&numbers), 1.5);
        let unknown = over(ArithmeticOp::Multiply, &[Expression::Constant(0.0), Expression::Variable(1)]);
        assert!(unknown.value(&numbers).is_nan());
        let divided = over(ArithmeticOp::Divide, &[x.clone(), Expression::Constant(0.0)]);
        assert!(divided.value(&numbers).is_nan(), "a division by zero");
        assert_eq!(over(ArithmeticOp::Subtract, &[x]).value(&numbers), -3.0);
        assert_eq!(over(ArithmeticOp::Subtract, &[Expression::Constant(2.0)]).constant(), Some(-2.0));
        for relation in [Relation::AtLeast, Relation::Above, Relation::Differs] {
            assert!(!relation.holds(f64::NAN, 1.0) && !relation.holds(1.0, f64::NAN), "{relation:?}");
        }
    }

    #[test]
    fn coefficients_are_found_where_there_are_any() {
        let (x, y) = (Expression::Variable(0), Expression::Variable(1));
        let two_x = over(ArithmeticOp::Multiply, &[Expression::Constant(2.0), x.clone()]);
        let left = over(ArithmeticOp::Subtract, &[two_x, y.clone()]);
        let right = over(ArithmeticOp::Add, &[y.clone(), Expression::Constant(1.0)]);
        let comparison = Comparison { relation: Relation::AtLeast, left, right };
        assert_eq!(comparison.coefficients(), Some(BTreeMap::from([(0, 2.0), (1, -2.0)])));
        let product = Comparison {
            relation: Relation::AtLeast,
            left: over(ArithmeticOp::Multiply, &[x, y]),
            right: Expression::Constant(0.0),
        };
        assert_eq!(product.coefficients(), None);
    }
}
