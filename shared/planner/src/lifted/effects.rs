//! Effects: the plain ones apart from those with quantifiers or conditions, and costs apart from both.

use lamma_pddl::ast::{Action, ArithmeticOp, Effect};

use super::metric::Metric;
use super::resolve::{MAX_DEPTH, Scope, and, atom, expression, formula, function};
use super::rules::Lifter;
use super::{Change, Expr, Formula};
use crate::ground::GroundError;

/// An effect under quantified variables and a condition.
pub(super) type Conditional = (Vec<u32>, Formula, Change);

/// Splits an action's effect into plain changes, conditional ones, and the action's cost.
pub(super) fn split(
    lifter: &mut Lifter,
    scope: &mut Scope,
    action: &Action,
    metric: &Metric,
) -> Result<Parts, GroundError> {
    let mut parts = Parts { plain: Vec::new(), conditional: Vec::new(), cost: Vec::new() };
    let context = Context { quantified: Vec::new(), condition: Formula::And(Vec::new()) };
    parts.collect(lifter, scope, &action.effect, &context, metric, 0)?;
    if let Some(cost) = metric.cost_of_time(action) {
        parts.cost.push(expression(&mut lifter.symbols, scope, &cost, 0)?);
    }
    Ok(parts)
}

/// An effect, taken apart.
pub(super) struct Parts {
    pub plain: Vec<Change>,
    pub conditional: Vec<Conditional>,
    pub cost: Vec<Expr>,
}

#[derive(Clone)]
struct Context {
    quantified: Vec<u32>,
    condition: Formula,
}

impl Parts {
    fn collect(
        &mut self,
        lifter: &mut Lifter,
        scope: &mut Scope,
        effect: &Effect,
        context: &Context,
        metric: &Metric,
        depth: usize,
    ) -> Result<(), GroundError> {
        if depth > MAX_DEPTH {
            return Err(GroundError::Malformed(format!(
                "an effect is nested deeper than {MAX_DEPTH} levels"
            )));
        }
        let symbols = &mut lifter.symbols;
        let change = match effect {
            Effect::And(parts) => {
                return parts
                    .iter()
                    .try_for_each(|part| self.collect(lifter, scope, part, context, metric, depth + 1));
            }
            Effect::Forall(variables, inner) => {
                let slots = scope.open(symbols, variables);
                let mut deeper = context.clone();
                deeper.quantified.extend(slots);
                self.collect(lifter, scope, inner, &deeper, metric, depth + 1)?;
                scope.close(variables.len());
                return Ok(());
            }
            Effect::When(condition, inner) => {
                let condition = formula(symbols, scope, condition, true, 0)?;
                let mut deeper = context.clone();
                deeper.condition = and(vec![deeper.condition, condition]);
                return self.collect(lifter, scope, inner, &deeper, metric, depth + 1);
            }
            Effect::Add(of) => Change::Add(atom(symbols, scope, of)?),
            Effect::Delete(of) => Change::Delete(atom(symbols, scope, of)?),
            Effect::Assign(op, target, value) => {
                let value = expression(symbols, scope, value, 0)?;
                if let Some(weight) = metric.weight(&target.function) {
                    let parts = vec![Expr::Number(weight), value.clone()];
                    self.cost.push(Expr::Operation(ArithmeticOp::Multiply, parts));
                    if metric.only_costs(&target.function) {
                        return Ok(());
                    }
                }
                Change::Numeric(*op, function(symbols, scope, target)?, value)
            }
        };
        let unconditional = matches!(&context.condition, Formula::And(parts) if parts.is_empty());
        if context.quantified.is_empty() && unconditional {
            self.plain.push(change);
        } else {
            self.conditional.push((context.quantified.clone(), context.condition.clone(), change));
        }
        Ok(())
    }
}
