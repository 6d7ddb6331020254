//! Operators that undo much the same: whoever goes anywhere leaves where it was.
//!
//! "In this step the agent does one of these" is one variable for many clauses. A set of operators may stand for all
//! that undo a literal if it holds them and, beyond them, only operators that make the literal true: an agent does at
//! most one thing in a step, so where one of the set is done and the literal holds after it, a maker was at work.

use std::collections::{BTreeMap, BTreeSet};

use super::model::{Lit, Maker, Model};

/// Fewer operators get a clause each.
const FEW: usize = 3;

/// The sets, and which stands for what undoes a literal.
#[derive(Debug, Default)]
pub(super) struct Together {
    /// Operators of one agent.
    pub sets: Vec<Vec<u32>>,
    of: BTreeMap<(Lit, u32), usize>,
}

/// A set that is being found: what must be in it, and what may.
struct Growing {
    agent: u32,
    must: BTreeSet<u32>,
    may: BTreeSet<u32>,
}

impl Together {
    pub fn new(model: &Model) -> Self {
        let mut growing: Vec<Growing> = Vec::new();
        let mut of = BTreeMap::new();
        for lit in (0..model.literals_count() as u32).map(Lit) {
            for (agent, must) in undone_by(model, lit) {
                if must.len() < FEW {
                    continue;
                }
                let makers = model.makers[lit.index()].iter().filter_map(|maker| match *maker {
                    Maker::Operator(o) if model.agent_of[o as usize] == agent => Some(o),
                    Maker::Operator(_) | Maker::Event(_) => None,
                });
                let may: BTreeSet<u32> = must.iter().copied().chain(makers).collect();
                let fits = |g: &Growing| g.agent == agent && must.is_subset(&g.may) && g.must.is_subset(&may);
                let at = growing.iter().position(fits).unwrap_or_else(|| {
                    growing.push(Growing { agent, must: must.clone(), may: may.clone() });
                    growing.len() - 1
                });
                let set = &mut growing[at];
                set.must.extend(&must);
                set.may.retain(|operator| may.contains(operator));
                of.insert((lit, agent), at);
            }
        }
        Together { sets: growing.into_iter().map(|g| g.must.into_iter().collect()).collect(), of }
    }

    /// The set that stands for what the agent may do to undo the literal without an excuse.
    pub fn of(&self, lit: Lit, agent: u32) -> Option<usize> {
        self.of.get(&(lit, agent)).copied()
    }
}

/// The operators of each agent that undo the literal whatever else holds.
fn undone_by(model: &Model, lit: Lit) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut by: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for threat in model.threats[lit.index()].iter().filter(|t| t.harmless_if.is_empty()) {
        by.entry(model.agent_of[threat.operator as usize]).or_default().insert(threat.operator);
    }
    by
}
