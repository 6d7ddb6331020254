//! How far numbers can go when an effect once possible may happen any number of times (repetition
//! relaxation: Aldinger, Mattmüller & Göbelbecker 2015, "Complexity of interval relaxed numeric planning").

use lamma_pddl::ast::{ArithmeticOp, AssignOp};

use super::numbers::GroundNumericEffect;
use super::propositional::{Ground, Stretch};
use crate::numeric::{Comparison, Expression, Relation};

/// Passes over the operators before a bound that still grows becomes infinite.
const PATIENCE: usize = 8;

/// All values from the first to the second.
type Interval = (f64, f64);

const EVERYTHING: Interval = (f64::NEG_INFINITY, f64::INFINITY);

/// The values each number can have; `None`: it never has one.
pub(super) struct Bounds {
    numbers: Vec<Option<Interval>>,
    possible: Vec<bool>,
}

impl Bounds {
    /// The values at first.
    pub fn new(ground: &Ground) -> Self {
        let initial = ground.numbers.initial.iter();
        let numbers = initial.map(|&value| (!value.is_nan()).then_some((value, value))).collect();
        let mut bounds = Bounds { numbers, possible: vec![false; ground.numbers.comparisons.len()] };
        bounds.compare(ground);
        bounds
    }

    /// The atoms of the comparisons that can hold.
    pub fn possible<'a>(&'a self, ground: &'a Ground) -> impl Iterator<Item = usize> + 'a {
        let all = ground.numbers.comparisons.iter().zip(&self.possible);
        all.filter(|(_, possible)| **possible).map(|((atom, ..), _)| *atom as usize)
    }

    /// Widens the bounds by the operators that are possible where `reached` atoms are. True if a comparison
    /// became possible.
    pub fn widen(&mut self, ground: &Ground, reached: &[bool]) -> bool {
        if ground.numbers.comparisons.is_empty() {
            return false;
        }
        let met =
            |stretch: Stretch| ground.lits(stretch).iter().all(|lit| !lit.holds() || reached[lit.atom()]);
        let operators = ground.operators.iter().filter(|o| o.numeric.len > 0 && met(o.precondition));
        let effects: Vec<&GroundNumericEffect> = operators
            .flat_map(|operator| &ground.numbers.effects[operator.numeric.range()])
            .filter(|effect| met(effect.condition))
            .collect();
        for pass in 0.. {
            let mut changed = false;
            for effect in &effects {
                changed |= self.apply(effect, pass >= PATIENCE);
            }
            if !changed {
                break;
            }
        }
        self.compare(ground)
    }

    /// One effect; true if its target can have more values now. With `jump` a bound that moves goes to
    /// infinity, so that the passes end.
    fn apply(&mut self, effect: &GroundNumericEffect, jump: bool) -> bool {
        let Some(value) = self.of(&effect.value) else { return false };
        let target = self.numbers[effect.target as usize];
        let reached = match (effect.op, target) {
            (AssignOp::Assign, _) => value,
            (_, None) => return false,
            (AssignOp::Increase, Some(now)) => repeated(now, value.0, value.1),
            (AssignOp::Decrease, Some(now)) => repeated(now, -value.1, -value.0),
            (AssignOp::ScaleUp, Some(now)) => product(now, value),
            (AssignOp::ScaleDown, Some(now)) => quotient(now, value),
        };
        let jump = jump || matches!(effect.op, AssignOp::ScaleUp | AssignOp::ScaleDown);
        let (low, high) = target.unwrap_or(reached);
        let mut wider = (low.min(reached.0), high.max(reached.1));
        if jump && target.is_some() {
            wider.0 = if wider.0 < low { f64::NEG_INFINITY } else { low };
            wider.1 = if wider.1 > high { f64::INFINITY } else { high };
        }
        let changed = target != Some(wider);
        self.numbers[effect.target as usize] = Some(wider);
        changed
    }

    fn of(&self, of: &Expression) -> Option<Interval> {
        match of {
            Expression::Constant(value) => (!value.is_nan()).then_some((*value, *value)),
            Expression::Variable(variable) => self.numbers[*variable as usize],
            Expression::Operation(op, parts) => {
                let mut values = parts.iter().map(|part| self.of(part));
                let first = values.next()??;
                if parts.len() == 1 && *op == ArithmeticOp::Subtract {
                    return Some((-first.1, -first.0));
                }
                values.try_fold(first, |left, right| right.map(|right| operate(*op, left, right)))
            }
        }
    }

    /// Works out which comparisons can hold; true if there are more than before.
    fn compare(&mut self, ground: &Ground) -> bool {
        let mut more = false;
        for (at, (_, comparison, _)) in ground.numbers.comparisons.iter().enumerate() {
            if !self.possible[at] && self.can_hold(comparison) {
                self.possible[at] = true;
                more = true;
            }
        }
        more
    }

    fn can_hold(&self, comparison: &Comparison) -> bool {
        let (Some(left), Some(right)) = (self.of(&comparison.left), self.of(&comparison.right)) else {
            return false;
        };
        match comparison.relation {
            Relation::AtLeast => left.1 >= right.0,
            Relation::Above => left.1 > right.0,
            Relation::Differs => left != right || left.0 != left.1,
        }
    }
}

/// Where adding something between `low` and `high` again and again leads.
fn repeated(now: Interval, low: f64, high: f64) -> Interval {
    (if low < 0.0 { f64::NEG_INFINITY } else { now.0 }, if high > 0.0 { f64::INFINITY } else { now.1 })
}

fn operate(op: ArithmeticOp, left: Interval, right: Interval) -> Interval {
    match op {
        ArithmeticOp::Add => sane((left.0 + right.0, left.1 + right.1)),
        ArithmeticOp::Subtract => sane((left.0 - right.1, left.1 - right.0)),
        ArithmeticOp::Multiply => product(left, right),
        ArithmeticOp::Divide => quotient(left, right),
    }
}

fn product(left: Interval, right: Interval) -> Interval {
    let ends = [left.0 * right.0, left.0 * right.1, left.1 * right.0, left.1 * right.1];
    if ends.iter().any(|end| end.is_nan()) {
        return EVERYTHING;
    }
    (
        ends.iter().copied().fold(f64::INFINITY, f64::min),
        ends.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    )
}

fn quotient(left: Interval, right: Interval) -> Interval {
    if right.0 <= 0.0 && right.1 >= 0.0 {
        return EVERYTHING;
    }
    product(left, (1.0 / right.1, 1.0 / right.0))
}

fn sane(interval: Interval) -> Interval {
    if interval.0.is_nan() || interval.1.is_nan() { EVERYTHING } else { interval }
}
