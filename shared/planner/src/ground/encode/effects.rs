//! What an operator does to variables: deletes before adds, once atoms are values.

use std::collections::BTreeSet;

use super::super::propositional::{GroundEffect, GroundOperator, Lit};
use super::Encoder;
use crate::task::FactId;

/// What an operator does to variables.
#[derive(Default)]
pub(super) struct Effects {
    /// In any case.
    pub plain: Vec<FactId>,
    /// Where a condition holds; of several that set a variable, the last counts.
    pub conditional: Vec<(Vec<FactId>, FactId)>,
}

impl Encoder<'_> {
    /// An operator's effects on variables. PDDL's deletes before adds becomes: where an operator adds an
    /// atom of a group, deletes of the group's other atoms are already said.
    pub(super) fn effects(&self, operator: &GroundOperator, precondition: &[FactId]) -> Effects {
        let (lits, sometimes) = self.always_and_sometimes(operator, precondition);
        let mut effects = Effects::default();
        for &lit in lits.iter().filter(|lit| lit.holds()) {
            effects.plain.extend(self.facts_to_set(self.atoms[lit.atom()], true).into_iter().flatten());
        }
        for &lit in lits.iter().filter(|lit| !lit.holds()) {
            self.delete(lit.atom(), &[], precondition, &mut effects);
        }
        let of_adds = |effect: &&GroundEffect| effect.effect.holds();
        let (adds, deletes): (Vec<&GroundEffect>, Vec<&GroundEffect>) =
            sometimes.into_iter().partition(of_adds);
        for effect in deletes {
            let condition = self.conditions(effect.condition);
            if !self.contradictory(&condition) {
                self.delete(effect.effect.atom(), &condition, precondition, &mut effects);
            }
        }
        for effect in adds {
            let condition = self.conditions(effect.condition);
            if !self.contradictory(&condition) {
                for fact in self.facts_to_set(self.atoms[effect.effect.atom()], true).into_iter().flatten() {
                    effects.conditional.push((condition.clone(), fact));
                }
            }
        }
        for (condition, _) in &mut effects.conditional {
            condition.retain(|fact| precondition.binary_search(fact).is_err());
        }
        effects.plain.sort_unstable();
        effects.plain.dedup();
        effects
    }

    /// What the operator does in any case, and what under a condition that may fail. Conditions on facts that never
    /// change are no conditions; what is added in any case is deleted in none.
    fn always_and_sometimes(
        &self,
        operator: &GroundOperator,
        precondition: &[FactId],
    ) -> (Vec<Lit>, Vec<&GroundEffect>) {
        let conditional = &self.ground.conditional[operator.conditional.range()];
        let given = |fact: &FactId| precondition.binary_search(fact).is_ok();
        let (always, mut sometimes): (Vec<&GroundEffect>, Vec<&GroundEffect>) =
            conditional.iter().partition(|effect| self.conditions(effect.condition).iter().all(given));
        let mut lits = self.ground.lits(operator.effects).to_vec();
        lits.extend(always.iter().map(|effect| effect.effect));
        let added: BTreeSet<usize> = lits.iter().filter(|lit| lit.holds()).map(|lit| lit.atom()).collect();
        lits.retain(|lit| lit.holds() || !added.contains(&lit.atom()));
        sometimes.retain(|effect| !added.contains(&effect.effect.atom()));
        (lits, sometimes)
    }

    fn delete(&self, atom: usize, condition: &[FactId], precondition: &[FactId], effects: &mut Effects) {
        let place = self.atoms[atom];
        // Where a group's variable gets a value in any case, it does not become "none".
        let settled = place.group.is_some_and(|value| {
            let (variable, none) = (self.variable(value), self.none_of(value));
            effects.plain.iter().any(|&fact| fact != none && self.variable(fact) == variable)
        });
        let mut happens = |condition: Vec<FactId>, fact: FactId| {
            if condition.is_empty() {
                effects.plain.push(fact);
            } else {
                effects.conditional.push((condition, fact));
            }
        };
        if let Some(own) = place.own {
            happens(condition.to_vec(), own);
        }
        let Some(value) = place.group.filter(|_| !settled) else { return };
        let (variable, none) = (self.variable(value), self.none_of(value));
        let same = |fact: &&FactId| self.variable(**fact) == variable;
        let known = condition.iter().find(same).or_else(|| precondition.iter().find(same));
        match known {
            Some(&known) if known != value => {}
            Some(_) => happens(condition.to_vec(), none),
            None => {
                let mut condition = condition.to_vec();
                condition.push(value);
                condition.sort_unstable();
                happens(condition, none);
            }
        }
    }
}
