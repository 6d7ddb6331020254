//! Which bit of the frame stands for which fact.

use std::collections::BTreeMap;

use lamma_pddl::ast::GroundAtom;
use lamma_planner::interpreter::WorldState;

/// Facts by bit and bits by fact. Grows when a fact becomes true for the first time, never shrinks: a bit
/// keeps its meaning for the whole run.
#[derive(Debug, Default)]
pub(crate) struct FactTable {
    bits: BTreeMap<GroundAtom, u32>,
    facts: Vec<String>,
}

impl FactTable {
    /// Gives every fact of the state a bit. True if the table has grown.
    pub fn cover<'a>(&mut self, facts: impl IntoIterator<Item = &'a GroundAtom>) -> bool {
        let before = self.facts.len();
        for fact in facts {
            if !self.bits.contains_key(fact) {
                // 2^32 facts do not fit into memory.
                self.bits.insert(fact.clone(), self.facts.len() as u32);
                self.facts.push(fact.to_string());
            }
        }
        self.facts.len() > before
    }

    pub fn facts(&self) -> &[String] {
        &self.facts
    }

    /// The state as bits. Every fact must be covered.
    pub fn encode(&self, state: &WorldState) -> Vec<u64> {
        let mut words = vec![0u64; self.facts.len().div_ceil(64)];
        for bit in state.facts.iter().filter_map(|fact| self.bits.get(fact)) {
            words[(bit / 64) as usize] |= 1 << (bit % 64);
        }
        words
    }
}
