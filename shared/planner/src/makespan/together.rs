//! Operators of one agent and one action that have much in common.
//!
//! *They undo the same.* Whoever goes anywhere leaves where it was. "In this step the agent does one of these" is one
//! variable for many clauses: where all of a set undo a literal or make it true, and an agent does at most one thing
//! in a step, a literal that holds after one of the set is done holds because a maker of the set was at work.
//!
//! *They are in vain twice.* Who goes somewhere and then elsewhere, with nothing done in between, need not have gone
//! the first time; nor who goes and then does nothing more. A set is such if what its operators make is relied on by
//! nobody but the agent, and by none of the set, and each of the set undoes or makes anew all that another makes. Then
//! a schedule stays one without the first of two, so a shortest schedule exists in which there are no two, and none at
//! the end.

use std::collections::{BTreeMap, BTreeSet};

use super::model::{Lit, Maker, Model};
use crate::task::Task;

/// Smaller sets are not worth a variable.
const FEW: usize = 2;

/// The sets.
#[derive(Debug, Default)]
pub(super) struct Together {
    pub sets: Vec<Vec<u32>>,
    set_of: Vec<Option<usize>>,
    /// Literals that all operators of a set undo, whatever else holds, or make true.
    whole: BTreeSet<(Lit, usize)>,
    /// For each set that is in vain twice: what its operators make true.
    in_vain: BTreeMap<usize, BTreeSet<Lit>>,
}

impl Together {
    pub fn new(task: &Task, model: &Model) -> Self {
        let mut groups: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
        for (operator, of) in task.operators.iter().enumerate() {
            groups.entry((model.agent_of[operator], of.schema)).or_default().push(operator as u32);
        }
        let sets: Vec<Vec<u32>> = groups.into_values().filter(|set| set.len() >= FEW).collect();
        let mut together = Together { set_of: vec![None; task.operators.len()], sets, ..Together::default() };
        for (set, operators) in together.sets.iter().enumerate() {
            operators.iter().for_each(|&operator| together.set_of[operator as usize] = Some(set));
        }
        // What each set makes, and what each of it settles: undoes for sure or makes for sure.
        let mut made: Vec<BTreeSet<Lit>> = vec![BTreeSet::new(); together.sets.len()];
        let mut settled: BTreeMap<(Lit, usize), BTreeSet<u32>> = BTreeMap::new();
        for lit in (0..model.literals_count() as u32).map(Lit) {
            for maker in &model.makers[lit.index()] {
                let operator = model.operator_of(*maker);
                let Some(set) = together.set_of[operator as usize] else { continue };
                made[set].insert(lit);
                if matches!(maker, Maker::Operator(_)) {
                    settled.entry((lit, set)).or_default().insert(operator);
                }
            }
            for threat in model.threats[lit.index()].iter().filter(|t| t.harmless_if.is_empty()) {
                if let Some(set) = together.set_of[threat.operator as usize] {
                    settled.entry((lit, set)).or_default().insert(threat.operator);
                }
            }
        }
        let all = |(_, set): &(Lit, usize), by: &BTreeSet<u32>| by.len() == together.sets[*set].len();
        together.whole = settled.iter().filter(|(key, by)| all(key, by)).map(|(key, _)| *key).collect();
        let relying = relying(model);
        for (set, made) in made.into_iter().enumerate() {
            let agent = model.agent_of[together.sets[set][0] as usize];
            let own = |lit: &Lit| {
                together.whole.contains(&(*lit, set))
                    && relying[lit.index()].iter().all(|by| {
                        by.is_some_and(|o| {
                            model.agent_of[o as usize] == agent && together.set_of[o as usize] != Some(set)
                        })
                    })
            };
            if made.iter().all(own) {
                together.in_vain.insert(set, made);
            }
        }
        together
    }

    /// The set of an operator, if all of it undo the literal or make it true.
    pub fn settling(&self, operator: u32, lit: Lit) -> Option<usize> {
        self.set(operator).filter(|&set| self.whole.contains(&(lit, set)))
    }

    fn set(&self, operator: u32) -> Option<usize> {
        *self.set_of.get(operator as usize)?
    }

    /// Whether the operator is of the set.
    pub fn is_of(&self, operator: u32, set: usize) -> bool {
        self.set(operator) == Some(set)
    }

    /// The sets of which two in a row, or one at the end, are in vain for this goal.
    pub fn in_vain<'a>(&'a self, goal: &'a [Lit]) -> impl Iterator<Item = usize> + 'a {
        let free = move |made: &BTreeSet<Lit>| !goal.iter().any(|lit| made.contains(lit));
        self.in_vain.iter().filter(move |(_, made)| free(made)).map(|(&set, _)| set)
    }
}

/// For each literal the operators that rely on it, as a precondition, for a conditional effect or as an excuse;
/// `None` for a derivation.
fn relying(model: &Model) -> Vec<BTreeSet<Option<u32>>> {
    let mut relying = vec![BTreeSet::new(); model.literals_count()];
    for operator in 0..model.preconditions.len() {
        for lit in model.preconditions.row(operator) {
            relying[lit.index()].insert(Some(operator as u32));
        }
    }
    for event in &model.events {
        for lit in &event.condition {
            relying[lit.index()].insert(Some(event.operator));
        }
    }
    for threat in model.threats.iter().flatten() {
        for lit in &threat.harmless_if {
            relying[lit.index()].insert(Some(threat.operator));
        }
    }
    for lit in model.derivations.values().flatten().flatten() {
        relying[lit.index()].insert(None);
    }
    relying
}
