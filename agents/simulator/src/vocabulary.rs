//! Which bit of the frame stands for which fact.

use std::collections::BTreeMap;

use lamma_pddl::ast::GroundAtom;
use lamma_planner::interpreter::{Change, WorldState};

/// Facts by bit, bits by fact, and the bits of the state. Grows when a fact becomes true for the first time,
/// never shrinks: a bit keeps its meaning for the whole run. It follows the changes, so that an action costs
/// what it changes and not what the world holds.
#[derive(Debug, Default)]
pub(crate) struct FactTable {
    bits: BTreeMap<GroundAtom, u32>,
    facts: Vec<String>,
    words: Vec<u64>,
}

impl FactTable {
    /// The table of a state.
    pub fn of(state: &WorldState) -> Self {
        let mut table = FactTable::default();
        state.facts.iter().for_each(|fact| table.set(fact));
        table
    }

    /// Follows a change. True if the table has grown.
    pub fn change(&mut self, change: &Change) -> bool {
        let before = self.facts.len();
        for bit in change.deleted.iter().filter_map(|fact| self.bits.get(fact)) {
            self.words[(bit / 64) as usize] &= !(1 << (bit % 64));
        }
        change.added.iter().for_each(|fact| self.set(fact));
        self.facts.len() > before
    }

    fn set(&mut self, fact: &GroundAtom) {
        let bit = match self.bits.get(fact) {
            Some(bit) => *bit,
            None => {
                // 2^32 facts do not fit into memory.
                let bit = self.facts.len() as u32;
                self.bits.insert(fact.clone(), bit);
                self.facts.push(fact.to_string());
                self.words.resize(self.facts.len().div_ceil(64), 0);
                bit
            }
        };
        self.words[(bit / 64) as usize] |= 1 << (bit % 64);
    }

    pub fn facts(&self) -> &[String] {
        &self.facts
    }

    /// The state as bits.
    pub fn words(&self) -> &[u64] {
        &self.words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fact(n: usize) -> GroundAtom {
        GroundAtom::new("at", [format!("x{n}")])
    }

    #[test]
    fn bits_follow_the_changes_and_keep_their_meaning() {
        let state = WorldState { facts: (0..70).map(fact).collect(), ..WorldState::default() };
        let mut table = FactTable::of(&state);
        let holds = |table: &FactTable, n: usize| {
            let bit = table.facts().iter().position(|f| *f == fact(n).to_string()).expect("known");
            table.words()[bit / 64] >> (bit % 64) & 1 == 1
        };
        let before = table.facts().to_vec();
        assert!(table.change(&Change { added: vec![fact(99)], deleted: vec![fact(7)], values: vec![] }));
        assert!(holds(&table, 99) && !holds(&table, 7) && holds(&table, 69));
        assert_eq!(table.facts()[..70], before);
        assert!(!table.change(&Change { added: vec![fact(7)], deleted: vec![], values: vec![] }), "known");
        assert!(holds(&table, 7));
    }
}
