//! A goal cut into parts that different robots can reach independently.

use std::collections::BTreeSet;

use lamma_pddl::Name;
use lamma_pddl::ast::Condition;
use lamma_planner::Literal;
use lamma_planner::interpreter::GroundCondition;

use crate::split::condition_of;

/// The conjuncts of a goal, those about the same thing together: what happens to one thing is one robot's
/// affair. A literal is about its first argument; a disjunction that leaves a choice stays whole.
pub fn independent_parts(goal: &GroundCondition) -> Vec<GroundCondition> {
    let mut conjuncts = Vec::new();
    flatten(goal, &mut conjuncts);
    let mut parts: Vec<(BTreeSet<Name>, Vec<GroundCondition>)> = Vec::new();
    for conjunct in conjuncts {
        let about = subjects(&conjunct);
        let (mut same, rest): (Vec<_>, Vec<_>) =
            parts.into_iter().partition(|(names, _)| !names.is_disjoint(&about));
        parts = rest;
        let mut merged = (about, Vec::new());
        for (names, conditions) in same.drain(..) {
            merged.0.extend(names);
            merged.1.extend(conditions);
        }
        merged.1.push(conjunct);
        parts.push(merged);
    }
    parts.into_iter().map(|(_, conditions)| and(conditions)).collect()
}

fn and(mut conditions: Vec<GroundCondition>) -> GroundCondition {
    if conditions.len() == 1 { conditions.remove(0) } else { GroundCondition::And(conditions) }
}

fn flatten(goal: &GroundCondition, out: &mut Vec<GroundCondition>) {
    match goal {
        GroundCondition::And(parts) => parts.iter().for_each(|p| flatten(p, out)),
        // A choice of one is none: "some fridge" where there is one fridge.
        GroundCondition::Or(parts) if parts.len() == 1 => flatten(&parts[0], out),
        other => out.push(other.clone()),
    }
}

fn subjects(condition: &GroundCondition) -> BTreeSet<Name> {
    let first = |literal: &Literal| literal.atom.args.first().cloned();
    condition.literals().into_iter().filter_map(first).collect()
}

/// The condition as the syntax tree has it. Comparisons are left out; goals of sub-tasks have none.
pub fn condition_from(ground: &GroundCondition) -> Condition {
    match ground {
        GroundCondition::And(parts) => Condition::And(parts.iter().map(condition_from).collect()),
        GroundCondition::Or(parts) => Condition::Or(parts.iter().map(condition_from).collect()),
        GroundCondition::Literal(literal) => condition_of(literal),
        GroundCondition::Compare(..) => Condition::TRUE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamma_pddl::ast::GroundAtom;

    fn fact(predicate: &str, args: &[&str]) -> GroundCondition {
        let atom = GroundAtom::new(predicate, args.iter().copied());
        GroundCondition::Literal(Literal { atom, holds: true })
    }

    #[test]
    fn things_are_parted_and_what_is_about_one_thing_stays_together() {
        let goal = GroundCondition::Or(vec![GroundCondition::And(vec![
            fact("in", &["tomato", "fridge"]),
            fact("in", &["lettuce", "fridge"]),
            fact("sliced", &["tomato"]),
        ])]);
        let parts = independent_parts(&goal);
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[1].literals().len(), 2, "{parts:?}");
    }

    #[test]
    fn a_choice_stays_whole() {
        let choice = GroundCondition::Or(vec![fact("in", &["cup", "shelf"]), fact("in", &["mug", "shelf"])]);
        let goal = GroundCondition::And(vec![choice.clone(), fact("dark", &["room"])]);
        assert_eq!(independent_parts(&goal), [choice, fact("dark", &["room"])]);
    }
}
