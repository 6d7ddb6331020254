//! Whether a plan is one: every action possible where it stands, the goal reached at the end.
//!
//! Only the plain interpreter is asked, never what the search used to find the plan.

mod plan_text;

use std::fmt;

use lamma_pddl::ast::{Domain, NumericExpr, Problem};

pub use plan_text::{CostKind, read_plan, write_plan};

use crate::interpreter::{ActError, InterpretError, Interpreter, Unmet, Violation, WorldState, operate};
use crate::plan::GroundAct;

/// What there is to say about a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Every action is possible and the goal holds at the end.
    Valid {
        /// The metric's value at the end, or without a metric the number of actions.
        cost: f64,
        /// Which of the two it is.
        kind: CostKind,
    },
    /// An action is not possible, or is none.
    Impossible {
        /// Which one, from 0.
        step: usize,
        /// The action.
        act: GroundAct,
        /// Why.
        reason: Refusal,
    },
    /// Every action is possible, and the goal does not hold at the end.
    GoalNotReached {
        /// The parts of the goal that do not hold.
        missing: Vec<Unmet>,
    },
}

/// Why an action cannot be done.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The domain and the objects have no such action.
    NoSuchAction(ActError),
    /// What it needs does not hold.
    Violation(Violation),
}

impl Verdict {
    /// Whether the plan is valid.
    pub fn is_valid(&self) -> bool {
        matches!(self, Verdict::Valid { .. })
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Valid { cost, kind } => write!(f, "the plan is valid; cost {cost} ({kind})"),
            Verdict::Impossible { step, act, reason } => {
                write!(f, "step {} {act}: ", step + 1)?;
                match reason {
                    Refusal::NoSuchAction(error) => write!(f, "{error}"),
                    Refusal::Violation(violation) => write_unmet(f, &violation.unmet),
                }
            }
            Verdict::GoalNotReached { missing } => {
                f.write_str("the goal is not reached: ")?;
                write_unmet(f, missing)
            }
        }
    }
}

fn write_unmet(f: &mut fmt::Formatter<'_>, unmet: &[Unmet]) -> fmt::Result {
    let unmet: Vec<String> = unmet.iter().map(Unmet::to_string).collect();
    f.write_str(&unmet.join(", "))
}

/// Executes the acts from the problem's initial state on.
pub fn validate(domain: &Domain, problem: &Problem, acts: &[GroundAct]) -> Result<Verdict, InterpretError> {
    let interpreter = Interpreter::new(domain, &problem.objects)?;
    let goal = interpreter.ground_condition(&problem.goal)?;
    let mut state = interpreter.initial(&problem.init)?;
    let mut total_time = 0.0;
    for (step, act) in acts.iter().enumerate() {
        match execute(&interpreter, &mut state, act) {
            Ok(duration) => total_time += duration,
            Err(reason) => return Ok(Verdict::Impossible { step, act: act.clone(), reason }),
        }
    }
    let missing = interpreter.missing(&state, &goal);
    if !missing.is_empty() {
        return Ok(Verdict::GoalNotReached { missing });
    }
    let Some(metric) = &problem.metric else {
        return Ok(Verdict::Valid { cost: acts.len() as f64, kind: CostKind::Unit });
    };
    let cost = interpreter.metric_value(&state, &metric.expression, total_time)?;
    Ok(Verdict::Valid { cost, kind: CostKind::Metric })
}

/// The duration of the act, which is done.
fn execute(interpreter: &Interpreter, state: &mut WorldState, act: &GroundAct) -> Result<f64, Refusal> {
    let action = interpreter.instantiate(act).map_err(Refusal::NoSuchAction)?;
    let duration = interpreter.duration(state, &action).map_err(Refusal::Violation)?;
    interpreter.apply(state, &action).map_err(Refusal::Violation)?;
    Ok(duration)
}

impl Interpreter {
    /// The value of a metric in a state that was reached in `total_time`.
    pub fn metric_value(
        &self,
        state: &WorldState,
        metric: &NumericExpr,
        total_time: f64,
    ) -> Result<f64, InterpretError> {
        let value = match metric {
            NumericExpr::Function(function) if function.function == "total-time" => total_time,
            NumericExpr::Operation(op, operands) => {
                let values = operands.iter().map(|operand| self.metric_value(state, operand, total_time));
                operate(*op, &values.collect::<Result<Vec<_>, _>>()?)
            }
            _ => self
                .ground_expression(metric)?
                .value(&state.values)
                .map_err(|unmet| InterpretError::Metric { reason: unmet.to_string() })?,
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(InterpretError::Metric { reason: format!("{metric} is not a finite number") })
        }
    }
}

#[cfg(test)]
mod properties;
#[cfg(test)]
mod tests;
