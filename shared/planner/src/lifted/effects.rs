//! Effects: the plain ones apart from those with quantifiers or conditions, and costs apart from both.

use lamma_pddl::ast::{ArithmeticOp, AssignOp, Domain, Effect, NumericExpr, Problem};

use super::resolve::{Scope, and, atom, expression, formula, function};
use super::rules::Lifter;
use super::{Change, Expr, Formula, LiftedAtom, Symbols};
use crate::ground::GroundError;

/// An effect under quantified variables and a condition.
pub(super) type Conditional = (Vec<u32>, Formula, Change);

/// The functions whose sum the metric minimises, if every action changes them by an amount that is known
/// beforehand; empty where actions cost one each.
pub(super) fn cost_functions(
    symbols: &mut Symbols,
    domain: &Domain,
    problem: &Problem,
) -> Result<Vec<LiftedAtom>, GroundError> {
    let Some(metric) = problem.metric.as_ref().filter(|metric| metric.minimize) else {
        return Ok(Vec::new());
    };
    let mut functions = Vec::new();
    let mut agenda = vec![&metric.expression];
    while let Some(part) = agenda.pop() {
        match part {
            NumericExpr::Function(of) if of.args.is_empty() => {
                functions.push(function(symbols, &Scope::default(), of)?);
            }
            NumericExpr::Operation(ArithmeticOp::Add, parts) => agenda.extend(parts),
            // Other metrics do not change which plans are right; the search then counts actions.
            _ => return Ok(Vec::new()),
        }
    }
    let names: Vec<_> =
        functions.iter().map(|f| symbols.functions[f.predicate as usize].name.clone()).collect();
    let only_increased = domain.actions.iter().all(|action| {
        let mut agenda = vec![(&action.effect, true)];
        while let Some((effect, plain)) = agenda.pop() {
            match effect {
                Effect::And(parts) => agenda.extend(parts.iter().map(|part| (part, plain))),
                Effect::Forall(_, inner) | Effect::When(_, inner) => agenda.push((inner, false)),
                Effect::Assign(op, target, value) => {
                    let known = plain && *op == AssignOp::Increase && is_static(symbols, value);
                    if names.contains(&target.function) && !known {
                        return false;
                    }
                }
                Effect::Add(_) | Effect::Delete(_) => {}
            }
        }
        true
    });
    Ok(if only_increased { functions } else { Vec::new() })
}

fn is_static(symbols: &mut Symbols, value: &NumericExpr) -> bool {
    match value {
        NumericExpr::Number(_) => true,
        NumericExpr::Function(of) => symbols
            .function(&of.function, of.args.len())
            .is_ok_and(|id| symbols.functions[id as usize].role == super::Role::Static),
        NumericExpr::Operation(_, parts) => parts.iter().all(|part| is_static(symbols, part)),
    }
}

/// Splits an effect into plain changes, conditional ones, and the action's cost.
pub(super) fn split(
    lifter: &mut Lifter,
    scope: &mut Scope,
    effect: &Effect,
    metric: &[LiftedAtom],
) -> Result<Parts, GroundError> {
    let mut parts = Parts { plain: Vec::new(), conditional: Vec::new(), cost: Vec::new() };
    let context = Context { quantified: Vec::new(), condition: Formula::And(Vec::new()) };
    parts.collect(lifter, scope, effect, &context, metric, 0)?;
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
        metric: &[LiftedAtom],
        depth: usize,
    ) -> Result<(), GroundError> {
        if depth > 200 {
            return Err(GroundError::Malformed("an effect is nested deeper than 200 levels".into()));
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
            Effect::Assign(_, target, value) => {
                let target = function(symbols, scope, target)?;
                let value = expression(symbols, scope, value, 0)?;
                if metric.contains(&target) {
                    self.cost.push(value);
                    return Ok(());
                }
                Change::Assign
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
