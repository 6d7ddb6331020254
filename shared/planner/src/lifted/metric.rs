//! What the problem's metric makes actions cost.

use std::collections::BTreeSet;

use lamma_pddl::Name;
use lamma_pddl::ast::{
    Action, ArithmeticOp, AssignOp, Condition, Decimal, Domain, Effect, Init, NumericExpr, Problem,
};

use super::{Role, Symbols};
use crate::ground::GroundError;

/// Expressions deeper than this are no metric the search minimises.
const MAX_DEPTH: usize = 64;

/// A metric that is a sum over the actions: each function counts with a weight, and time with another.
#[derive(Debug, Default)]
pub(super) struct Metric {
    weights: Vec<(Name, f64)>,
    /// What a unit of time costs.
    time: f64,
    /// Functions of the metric whose values nothing else reads, so that the search need not keep them.
    unread: BTreeSet<Name>,
}

impl Metric {
    /// What one action pays for increasing this function by one.
    pub fn weight(&self, function: &Name) -> Option<f64> {
        self.weights.iter().find(|(name, _)| name == function).map(|&(_, weight)| weight)
    }

    /// Whether an increase of this function is nothing but a cost.
    pub fn only_costs(&self, function: &Name) -> bool {
        self.unread.contains(function)
    }

    /// What an action pays for the time it takes.
    pub fn cost_of_time(&self, action: &Action) -> Option<NumericExpr> {
        if self.time == 0.0 {
            return None;
        }
        let number = |value: f64| NumericExpr::Number(Decimal(value.to_string()));
        let duration = action.duration.clone().unwrap_or_else(|| number(1.0));
        Some(NumericExpr::Operation(ArithmeticOp::Multiply, vec![number(self.time), duration]))
    }
}

/// The metric as costs of actions. `Ok(None)`: actions cost one each, because there is no metric. The error is
/// why this one cannot be minimised.
pub(super) fn metric(
    symbols: &mut Symbols,
    domain: &Domain,
    problem: &Problem,
) -> Result<Result<Option<Metric>, String>, GroundError> {
    let Some(wanted) = &problem.metric else { return Ok(Ok(None)) };
    let refused = |why: &str| {
        let direction = if wanted.minimize { "minimize" } else { "maximize" };
        Ok(Err(format!("the metric ({direction} {}) {why}; the search counts actions", wanted.expression)))
    };
    let mut metric = Metric::default();
    let factor = if wanted.minimize { 1.0 } else { -1.0 };
    if !metric.add(&wanted.expression, factor, 0) {
        return refused("is no weighted sum of numbers without arguments");
    }
    if metric.time < 0.0 || metric.weights.iter().any(|&(_, weight)| weight < 0.0) {
        return refused("rewards long plans");
    }
    if metric.time > 0.0 {
        let mut durations = domain.actions.iter().filter_map(|action| action.duration.as_ref());
        if !durations.all(|duration| is_static(symbols, duration)) {
            return refused("counts durations that change");
        }
    }
    if !domain.actions.iter().all(|action| only_increases(symbols, action, &metric)) {
        return refused("counts numbers that change in more ways than by fixed increases");
    }
    let read = functions_read(domain, problem);
    for (name, _) in &metric.weights {
        symbols.function(name, 0)?;
        let has_value = *name == "total-cost"
            || problem.init.iter().any(|item| matches!(item, Init::Value(of, _) if of.predicate == *name));
        if has_value && !read.contains(name) {
            metric.unread.insert(name.clone());
        }
    }
    Ok(Ok(Some(metric)))
}

impl Metric {
    /// Adds `factor` times the expression; false where it is not a weighted sum.
    fn add(&mut self, of: &NumericExpr, factor: f64, depth: usize) -> bool {
        if depth > MAX_DEPTH {
            return false;
        }
        match of {
            // A constant makes no plan better than another.
            NumericExpr::Number(_) => true,
            NumericExpr::Function(function) if function.function == "total-time" => {
                self.time += factor;
                true
            }
            NumericExpr::Function(function) => {
                match self.weights.iter_mut().find(|(name, _)| *name == function.function) {
                    Some((_, weight)) => *weight += factor,
                    None => self.weights.push((function.function.clone(), factor)),
                }
                function.args.is_empty()
            }
            NumericExpr::Operation(ArithmeticOp::Add, parts) => {
                parts.iter().all(|part| self.add(part, factor, depth + 1))
            }
            NumericExpr::Operation(ArithmeticOp::Subtract, parts) => {
                let negated = |at: usize| at > 0 || parts.len() == 1;
                parts
                    .iter()
                    .enumerate()
                    .all(|(at, part)| self.add(part, if negated(at) { -factor } else { factor }, depth + 1))
            }
            NumericExpr::Operation(ArithmeticOp::Multiply, parts) => match &parts[..] {
                [NumericExpr::Number(by), part] | [part, NumericExpr::Number(by)] => {
                    self.add(part, factor * by.value(), depth + 1)
                }
                _ => false,
            },
            NumericExpr::Operation(ArithmeticOp::Divide, parts) => match &parts[..] {
                [part, NumericExpr::Number(by)] if by.value() != 0.0 => {
                    self.add(part, factor / by.value(), depth + 1)
                }
                _ => false,
            },
        }
    }
}

/// Whether the action changes the metric's functions only by increases, in any case and by known amounts.
fn only_increases(symbols: &mut Symbols, action: &Action, metric: &Metric) -> bool {
    let mut agenda = vec![(&action.effect, true)];
    while let Some((effect, plain)) = agenda.pop() {
        match effect {
            Effect::And(parts) => agenda.extend(parts.iter().map(|part| (part, plain))),
            Effect::Forall(_, inner) | Effect::When(_, inner) => agenda.push((inner, false)),
            Effect::Assign(op, target, value) => {
                let known = plain && *op == AssignOp::Increase && is_static(symbols, value);
                if metric.weight(&target.function).is_some() && !known {
                    return false;
                }
            }
            Effect::Add(_) | Effect::Delete(_) => {}
        }
    }
    true
}

fn is_static(symbols: &mut Symbols, value: &NumericExpr) -> bool {
    match value {
        NumericExpr::Number(_) => true,
        NumericExpr::Function(of) => symbols
            .function(&of.function, of.args.len())
            .is_ok_and(|id| symbols.functions[id as usize].role == Role::Static),
        NumericExpr::Operation(_, parts) => parts.iter().all(|part| is_static(symbols, part)),
    }
}

/// The functions that a condition or the value of an effect reads.
fn functions_read<'t>(domain: &'t Domain, problem: &'t Problem) -> BTreeSet<&'t Name> {
    let mut conditions: Vec<&Condition> = domain.axioms.iter().map(|axiom| &axiom.body).collect();
    conditions.push(&problem.goal);
    let mut values: Vec<&NumericExpr> = Vec::new();
    let mut effects: Vec<&Effect> = Vec::new();
    for action in &domain.actions {
        conditions.push(&action.precondition);
        effects.push(&action.effect);
    }
    while let Some(effect) = effects.pop() {
        match effect {
            Effect::And(parts) => effects.extend(parts),
            Effect::Forall(_, inner) => effects.push(inner),
            Effect::When(condition, inner) => {
                conditions.push(condition);
                effects.push(inner);
            }
            Effect::Assign(_, _, value) => values.push(value),
            Effect::Add(_) | Effect::Delete(_) => {}
        }
    }
    while let Some(condition) = conditions.pop() {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => conditions.extend(parts),
            Condition::Not(inner) | Condition::Exists(_, inner) | Condition::Forall(_, inner) => {
                conditions.push(inner);
            }
            Condition::Imply(premise, conclusion) => conditions.extend([&**premise, &**conclusion]),
            Condition::Compare(_, left, right) => values.extend([left, right]),
            Condition::Atom(_) | Condition::Equal(..) => {}
        }
    }
    let mut read = BTreeSet::new();
    while let Some(value) = values.pop() {
        match value {
            NumericExpr::Number(_) => {}
            NumericExpr::Function(of) => {
                read.insert(&of.function);
            }
            NumericExpr::Operation(_, parts) => values.extend(parts),
        }
    }
    read
}
