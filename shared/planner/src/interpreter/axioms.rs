//! Derived predicates: stratified axioms and their least fixpoint (Thiébaux, Hoffmann & Nebel, "In defense of
//! PDDL axioms", AIJ 168, 2005, section 2).

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::Name;
use lamma_pddl::ast::{Axiom, Condition, GroundAtom};

use super::Interpreter;
use super::error::InterpretError;
use super::ground::Grounder;
use super::state::{View, WorldState};

/// Axioms in strata: those of one may negate only what earlier ones derive.
#[derive(Clone, Debug, Default)]
pub(super) struct Axioms {
    strata: Vec<Vec<Axiom>>,
    derived: BTreeSet<Name>,
}

impl Axioms {
    pub fn new(axioms: &[Axiom]) -> Result<Self, InterpretError> {
        let derived: BTreeSet<Name> = axioms.iter().map(|axiom| axiom.head.name.clone()).collect();
        let mut level: BTreeMap<&Name, usize> = derived.iter().map(|name| (name, 0)).collect();
        loop {
            let mut changed = false;
            for axiom in axioms {
                let mut needed = 0;
                for (predicate, positive) in mentions(&axiom.body) {
                    if let Some(below) = level.get(predicate) {
                        needed = needed.max(below + usize::from(!positive));
                    }
                }
                // More levels than predicates are only reached in a circle through a negation.
                if needed > derived.len() {
                    return Err(InterpretError::Unstratified { predicate: axiom.head.name.clone() });
                }
                if let Some(own) = level.get_mut(&axiom.head.name)
                    && *own < needed
                {
                    *own = needed;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        let mut strata: Vec<Vec<Axiom>> = vec![Vec::new(); level.values().max().map_or(0, |top| top + 1)];
        axioms.iter().for_each(|axiom| strata[level[&axiom.head.name]].push(axiom.clone()));
        Ok(Axioms { strata, derived })
    }

    pub fn derives(&self, predicate: &Name) -> bool {
        self.derived.contains(predicate)
    }

    /// What follows from the state. Naive evaluation: right by looking at it, which is what it is for.
    pub fn consequences(&self, interpreter: &Interpreter, state: &WorldState) -> BTreeSet<GroundAtom> {
        let mut view = View { state, derived: BTreeSet::new() };
        for stratum in &self.strata {
            loop {
                let mut found = Vec::new();
                for axiom in stratum {
                    Grounder::new(interpreter, Vec::new()).satisfied(axiom, &view, &mut found);
                }
                if found.is_empty() {
                    break;
                }
                view.derived.extend(found);
            }
        }
        view.derived
    }
}

/// The predicates in a condition, and whether each stands under an even number of negations.
fn mentions(condition: &Condition) -> Vec<(&Name, bool)> {
    let mut found = Vec::new();
    let mut open = vec![(condition, true)];
    while let Some((condition, positive)) = open.pop() {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => {
                open.extend(parts.iter().map(|part| (part, positive)))
            }
            Condition::Not(inner) => open.push((inner, !positive)),
            Condition::Imply(if_, then) => open.extend([(&**if_, !positive), (&**then, positive)]),
            Condition::Exists(_, body) | Condition::Forall(_, body) => open.push((body, positive)),
            Condition::Atom(atom) => found.push((&atom.predicate, positive)),
            Condition::Equal(..) | Condition::Compare(..) => {}
        }
    }
    found
}
