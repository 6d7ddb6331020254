//! Derived predicates: known, and in an order in which they can be worked out.

use std::collections::BTreeMap;

use super::Checker;
use crate::ast::Condition;
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::Name;

impl Checker<'_> {
    pub(super) fn axioms(&mut self) {
        for axiom in &self.domain.axioms {
            let head = &axiom.head;
            match self.predicates.get(&head.name) {
                None => {
                    if self.first_report(codes::UNKNOWN_PREDICATE, &head.name) {
                        let message = format!("unknown predicate `{}`", head.name);
                        let found = Diagnostic::error(codes::UNKNOWN_PREDICATE, head.name.span(), message);
                        self.report
                            .push(found.help("derived predicates are declared in (:predicates ...) too"));
                    }
                }
                Some(declared) if declared.params.len() != head.params.len() => {
                    let (expected, found) = (declared.params.len(), head.params.len());
                    let message =
                        format!("the predicate `{}` takes {expected} arguments, not {found}", head.name);
                    let found = Diagnostic::error(codes::WRONG_ARITY, head.name.span(), message);
                    self.report.push(found.help(format!("it is declared as {declared}")));
                }
                Some(_) => {}
            }
            let mut scope = self.parameters(&head.params);
            self.condition(&axiom.body, &mut scope);
        }
        self.stratified();
    }

    /// Levels that only ever grow; above the number of predicates there is a circle through a negation.
    fn stratified(&mut self) {
        let mut level: BTreeMap<&Name, usize> = self.derived.iter().map(|name| (*name, 0)).collect();
        loop {
            let mut changed = false;
            for axiom in &self.domain.axioms {
                let own = level[&axiom.head.name];
                let needed = depends(&axiom.body).into_iter().filter_map(|(predicate, positive)| {
                    level.get(predicate).map(|below| below + usize::from(!positive))
                });
                let needed = needed.max().unwrap_or(0);
                if needed > self.derived.len() {
                    let name = &axiom.head.name;
                    let message = format!("`{name}` depends on its own negation");
                    let found = Diagnostic::error(codes::UNSTRATIFIED, name.span(), message);
                    self.report.push(found.help("remove a `not` from the circle of rules"));
                    return;
                }
                if needed > own {
                    level.insert(&axiom.head.name, needed);
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }
}

/// The predicates in a condition, and whether each stands under an even number of negations.
fn depends(condition: &Condition) -> Vec<(&Name, bool)> {
    let mut found = Vec::new();
    let mut open = vec![(condition, true)];
    while let Some((condition, positive)) = open.pop() {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => {
                open.extend(parts.iter().map(|part| (part, positive)));
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
