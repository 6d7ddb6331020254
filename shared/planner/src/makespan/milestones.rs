//! Parts of a goal that come one after the other.
//!
//! A person says "slice the tomato, then switch off the light". What a later part asks for and does not hold yet is
//! then brought about while the earlier part holds: whatever makes such a literal relies on the earlier part, as on
//! a precondition. What only prepares may run ahead. A literal that an earlier part asks for, too, is free: it must
//! come about first.

use std::collections::BTreeSet;

use super::model::{Lit, Maker, Model};
use crate::csr::Csr;
use crate::task::{FactId, Task};

/// A part of the goal, and what comes before it.
#[derive(Clone, Debug)]
pub struct Milestone {
    /// What holds when it is reached.
    pub need: Need,
    /// Those it comes after, by index; they point backwards.
    pub after: Vec<usize>,
}

/// A condition over the facts of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Need {
    /// The fact holds, or does not.
    Fact(FactId, bool),
    /// All of them hold; of none, that is so.
    All(Vec<Need>),
    /// One of them holds; of none, that is never so.
    Any(Vec<Need>),
}

impl Model {
    /// Adds the order to the task: makers of later literals rely on earlier milestones.
    pub(super) fn put_in_order(&mut self, task: &Task, milestones: &[Milestone]) {
        let own: Vec<BTreeSet<Lit>> = milestones.iter().map(|m| self.literals_of(task, &m.need)).collect();
        let mut reached: Vec<Option<Lit>> = vec![None; milestones.len()];
        let mut relied_on: Vec<Vec<Lit>> = vec![Vec::new(); self.preconditions.len()];
        for at in 0..milestones.len() {
            let before = all_before(&milestones[at].after, |next| &milestones[next].after);
            let earlier: BTreeSet<Lit> =
                before.iter().flat_map(|&before| own[before].iter().copied()).collect();
            let later = own[at].iter().filter(|lit| !earlier.contains(lit) && !self.initially[lit.index()]);
            let later: Vec<Lit> = later.copied().collect();
            // All of them, not the next alone: that one may hold already, and the one before it not.
            for before in before {
                let lit = match reached[before] {
                    Some(lit) => lit,
                    None => self.derived(task, &milestones[before].need),
                };
                reached[before] = Some(lit);
                for maker in later.iter().flat_map(|l| self.makers[l.index()].clone()) {
                    match maker {
                        Maker::Operator(operator) => relied_on[operator as usize].push(lit),
                        Maker::Event(event) => self.events[event as usize].condition.push(lit),
                    }
                }
            }
        }
        let mut preconditions = Csr::default();
        for (operator, more) in relied_on.into_iter().enumerate() {
            let mut row: Vec<Lit> = self.preconditions.row(operator).iter().copied().chain(more).collect();
            row.sort_unstable();
            row.dedup();
            preconditions.push_row(row);
        }
        self.preconditions = preconditions;
        for event in &mut self.events {
            event.condition.sort_unstable();
            event.condition.dedup();
        }
    }

    fn literal_of(&self, task: &Task, fact: FactId, holds: bool) -> Lit {
        if holds { Lit(fact.0) } else { self.negation(task, Lit(fact.0)) }
    }

    fn literals_of(&self, task: &Task, need: &Need) -> BTreeSet<Lit> {
        match need {
            Need::Fact(fact, holds) => BTreeSet::from([self.literal_of(task, *fact, *holds)]),
            Need::All(parts) | Need::Any(parts) => {
                parts.iter().flat_map(|part| self.literals_of(task, part)).collect()
            }
        }
    }

    /// A literal that holds where the condition does.
    fn derived(&mut self, task: &Task, need: &Need) -> Lit {
        let bodies: Vec<Vec<Lit>> = match need {
            Need::Fact(fact, holds) => return self.literal_of(task, *fact, *holds),
            Need::All(parts) => vec![parts.iter().map(|part| self.derived(task, part)).collect()],
            Need::Any(parts) => parts.iter().map(|part| vec![self.derived(task, part)]).collect(),
        };
        let lit = Lit(self.makers.len() as u32);
        self.makers.push(Vec::new());
        self.threats.push(Vec::new());
        self.initially.push(false);
        self.derivations.insert(lit.0, bodies);
        lit
    }
}

/// All that come before some of several things, these included: directly, or through others. `after` says what each
/// comes after.
pub fn all_before<'a>(first: &[usize], after: impl Fn(usize) -> &'a [usize]) -> BTreeSet<usize> {
    let mut before = BTreeSet::new();
    let mut open = first.to_vec();
    while let Some(next) = open.pop() {
        if before.insert(next) {
            open.extend(after(next));
        }
    }
    before
}
