//! Derived predicates: stratified axioms and their least fixpoint (Thiébaux, Hoffmann & Nebel, "In defense of
//! PDDL axioms", AIJ 168, 2005, section 2).

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::Name;
use lamma_pddl::ast::{Axiom, Condition, GroundAtom};

use super::Interpreter;
use super::error::InterpretError;
use super::query::{Facts, Objects, Query, Rule, rules};
use super::state::{View, WorldState};

/// Axioms in strata: those of one may negate only what earlier ones derive.
#[derive(Clone, Debug, Default)]
pub(super) struct Axioms {
    strata: Vec<Vec<Rule>>,
    objects: Objects,
    derived: BTreeSet<Name>,
}

impl Axioms {
    /// Which predicates are derived, and nothing more.
    pub fn named(axioms: &[Axiom]) -> Self {
        let derived = axioms.iter().map(|axiom| axiom.head.name.clone()).collect();
        Axioms { derived, ..Axioms::default() }
    }

    /// Of an interpreter that knows everything but these: their names are declared and their variables bound.
    pub fn new(axioms: &[Axiom], interpreter: &Interpreter) -> Result<Self, InterpretError> {
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
        let mut strata: Vec<Vec<Rule>> = vec![Vec::new(); level.values().max().map_or(0, |top| top + 1)];
        let mut objects = Objects::new(interpreter);
        for axiom in axioms {
            strata[level[&axiom.head.name]].extend(rules(axiom, interpreter, &mut objects));
        }
        Ok(Axioms { strata, objects, derived })
    }

    pub fn is_empty(&self) -> bool {
        self.derived.is_empty()
    }

    pub fn derives(&self, predicate: &Name) -> bool {
        self.derived.contains(predicate)
    }

    /// What follows from the state: stratum by stratum, each to its least fixpoint. After the first round only
    /// what uses a new fact is looked for (semi-naive evaluation).
    pub fn consequences(&self, interpreter: &Interpreter, state: &WorldState) -> BTreeSet<GroundAtom> {
        let mut view = View { state, derived: BTreeSet::new() };
        if self.is_empty() {
            return view.derived;
        }
        let mut facts = Facts::new(self.strata.iter().flatten(), &self.objects, state);
        for stratum in &self.strata {
            let own: BTreeSet<&Name> = stratum.iter().map(|rule| &rule.head).collect();
            let mut first = true;
            loop {
                let mut found = Vec::new();
                for rule in stratum {
                    let mut rows = Vec::new();
                    let query =
                        Query { interpreter, objects: &self.objects, facts: &facts, view: &view, rule };
                    if first || rule.filters_mention(&own) {
                        query.heads(None, &mut rows);
                    } else {
                        rule.positions(&own).for_each(|at| query.heads(Some(at), &mut rows));
                    }
                    found.extend(rows.into_iter().map(|row| (&rule.head, row)));
                }
                first = false;
                facts.settle();
                let mut more = false;
                for (head, row) in found {
                    if view.derived.insert(self.objects.atom(head, &row)) {
                        facts.insert(head, row);
                        more = true;
                    }
                }
                if !more {
                    break;
                }
            }
        }
        view.derived
    }
}

/// The predicates in a condition, and whether each stands under an even number of negations.
pub(super) fn mentions(condition: &Condition) -> Vec<(&Name, bool)> {
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
