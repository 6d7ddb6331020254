//! States and how they change.

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::ast::GroundAtom;

/// What holds, and the numbers. Derived facts are not among the facts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorldState {
    /// The facts that hold.
    pub facts: BTreeSet<GroundAtom>,
    /// The values of numeric functions.
    pub values: BTreeMap<GroundAtom, f64>,
}

/// What an action changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// What holds now and did not before.
    pub added: Vec<GroundAtom>,
    /// What held before and does not now.
    pub deleted: Vec<GroundAtom>,
    /// Numbers with their new values.
    pub values: Vec<(GroundAtom, f64)>,
}

/// The effects of an action in one state, as evaluated before any of them happens.
#[derive(Debug, Default)]
pub(super) struct Effects {
    pub adds: BTreeSet<GroundAtom>,
    pub deletes: BTreeSet<GroundAtom>,
    pub values: BTreeMap<GroundAtom, f64>,
}

/// A state with what follows from it.
pub(super) struct View<'a> {
    pub state: &'a WorldState,
    pub derived: BTreeSet<GroundAtom>,
}

impl View<'_> {
    pub fn contains(&self, atom: &GroundAtom) -> bool {
        self.state.facts.contains(atom) || self.derived.contains(atom)
    }
}

impl WorldState {
    /// Deletes before adds.
    pub(super) fn change(&mut self, effects: Effects) -> Change {
        let Effects { adds, deletes, values } = effects;
        let deleted = deletes.into_iter().filter(|atom| !adds.contains(atom));
        let deleted: Vec<GroundAtom> = deleted.filter(|atom| self.facts.remove(atom)).collect();
        let added: Vec<GroundAtom> =
            adds.into_iter().filter(|atom| self.facts.insert(atom.clone())).collect();
        self.values.extend(values.iter().map(|(function, value)| (function.clone(), *value)));
        Change { added, deleted, values: values.into_iter().collect() }
    }
}
