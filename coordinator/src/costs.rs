//! Costs that nothing depends on, left out.
//!
//! `(increase (total-cost) …)` says what a plan costs and not what is possible. A team is planned for by time, and
//! two steps that both add to the cost are not in each other's way.

use std::collections::BTreeSet;

use lamma_pddl::Name;
use lamma_pddl::ast::{Action, Condition, Domain, Effect, NumericExpr};

/// The domain without effects on functions that neither a condition nor a duration reads, directly or through
/// another function.
pub(crate) fn without_costs(domain: &Domain, goal: &Condition) -> Domain {
    let mut read = BTreeSet::new();
    in_condition(goal, &mut read);
    domain.axioms.iter().for_each(|axiom| in_condition(&axiom.body, &mut read));
    for action in &domain.actions {
        in_condition(&action.precondition, &mut read);
        action.duration.iter().for_each(|duration| in_number(duration, &mut read));
        conditions_of(&action.effect, &mut read);
    }
    loop {
        let before = read.len();
        domain.actions.iter().for_each(|action| sources(&action.effect, &mut read));
        if read.len() == before {
            break;
        }
    }
    let mut domain = domain.clone();
    for action in &mut domain.actions {
        action.effect = kept(&action.effect, &read);
    }
    domain
}

/// Whether any action changes a number.
pub(crate) fn changes_numbers(domain: &Domain) -> bool {
    fn assigns(effect: &Effect) -> bool {
        match effect {
            Effect::And(parts) => parts.iter().any(assigns),
            Effect::Forall(_, inner) | Effect::When(_, inner) => assigns(inner),
            Effect::Add(_) | Effect::Delete(_) => false,
            Effect::Assign(..) => true,
        }
    }
    domain.actions.iter().any(|action: &Action| assigns(&action.effect))
}

/// Whether the condition compares numbers.
pub(crate) fn compares_numbers(condition: &Condition) -> bool {
    let mut read = BTreeSet::new();
    in_condition(condition, &mut read);
    !read.is_empty()
}

fn in_condition(condition: &Condition, read: &mut BTreeSet<Name>) {
    match condition {
        Condition::And(parts) | Condition::Or(parts) => parts.iter().for_each(|p| in_condition(p, read)),
        Condition::Not(inner) | Condition::Exists(_, inner) | Condition::Forall(_, inner) => {
            in_condition(inner, read);
        }
        Condition::Imply(left, right) => {
            in_condition(left, read);
            in_condition(right, read);
        }
        Condition::Compare(_, left, right) => {
            in_number(left, read);
            in_number(right, read);
        }
        Condition::Atom(_) | Condition::Equal(..) => {}
    }
}

fn in_number(number: &NumericExpr, read: &mut BTreeSet<Name>) {
    match number {
        NumericExpr::Number(_) => {}
        NumericExpr::Function(term) => drop(read.insert(term.function.clone())),
        NumericExpr::Operation(_, operands) => operands.iter().for_each(|o| in_number(o, read)),
    }
}

/// What the conditions of conditional effects read.
fn conditions_of(effect: &Effect, read: &mut BTreeSet<Name>) {
    match effect {
        Effect::And(parts) => parts.iter().for_each(|part| conditions_of(part, read)),
        Effect::Forall(_, inner) => conditions_of(inner, read),
        Effect::When(condition, inner) => {
            in_condition(condition, read);
            conditions_of(inner, read);
        }
        Effect::Add(_) | Effect::Delete(_) | Effect::Assign(..) => {}
    }
}

/// What the new values of functions that matter are worked out from.
fn sources(effect: &Effect, read: &mut BTreeSet<Name>) {
    match effect {
        Effect::And(parts) => parts.iter().for_each(|part| sources(part, read)),
        Effect::Forall(_, inner) | Effect::When(_, inner) => sources(inner, read),
        Effect::Assign(_, term, value) if read.contains(&term.function) => in_number(value, read),
        Effect::Add(_) | Effect::Delete(_) | Effect::Assign(..) => {}
    }
}

fn kept(effect: &Effect, read: &BTreeSet<Name>) -> Effect {
    match effect {
        Effect::And(parts) => Effect::And(parts.iter().map(|part| kept(part, read)).collect()),
        Effect::Forall(names, inner) => Effect::Forall(names.clone(), Box::new(kept(inner, read))),
        Effect::When(condition, inner) => Effect::When(condition.clone(), Box::new(kept(inner, read))),
        Effect::Assign(_, term, _) if !read.contains(&term.function) => Effect::And(Vec::new()),
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamma_pddl::{Source, parse_domain};

    #[test]
    fn costs_go_and_numbers_that_matter_stay() {
        let text = "(define (domain d) (:requirements :numeric-fluents)
          (:predicates (p)) (:functions (total-cost) (fuel) (rate))
          (:action a :parameters () :precondition (> (fuel) 0)
            :effect (and (p) (increase (total-cost) (rate)) (decrease (fuel) (rate)))))";
        let domain = parse_domain(&Source::new("d", text)).unwrap_or_else(|r| panic!("{r}")).value;
        let without = without_costs(&domain, &Condition::TRUE);
        let effect = without.actions[0].effect.to_string();
        assert!(effect.contains("fuel") && !effect.contains("total-cost"), "{effect}");
        assert!(changes_numbers(&without));
    }
}
