//! All states seen by a search, in one arena.

use crate::id_table::{IdTable, Slot, hash_words};
use crate::task::{OperatorId, Task};

/// A state's number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct StateId(pub u32);

/// No operator: the mark of the initial state.
const NO_OPERATOR: u32 = u32::MAX;

/// The states and how each was reached.
#[derive(Debug)]
pub(crate) struct Registry {
    words: usize,
    arena: Vec<u64>,
    table: IdTable,
    /// Parent and operator of each state.
    origin: Vec<(StateId, u32)>,
}

impl Registry {
    pub fn new(task: &Task) -> Self {
        Self::rooted(task, &task.init)
    }

    /// A registry whose first state is another than the initial one.
    pub fn rooted(task: &Task, root: &[u64]) -> Self {
        let mut registry = Registry {
            words: task.state_words(),
            arena: Vec::new(),
            table: IdTable::default(),
            origin: Vec::new(),
        };
        registry.insert(root, StateId(0), OperatorId(NO_OPERATOR));
        registry
    }

    #[inline]
    pub fn state(&self, id: StateId) -> &[u64] {
        &self.arena[id.0 as usize * self.words..(id.0 as usize + 1) * self.words]
    }

    /// Stores a state; returns its number and whether it is new.
    #[inline]
    pub fn insert(&mut self, state: &[u64], parent: StateId, operator: OperatorId) -> (StateId, bool) {
        let hash = hash_words(state);
        let (arena, words) = (&self.arena, self.words);
        let row = |id: u32| &arena[id as usize * words..(id as usize + 1) * words];
        match self.table.find(hash, |id| row(id) == state) {
            Slot::Found(id) => (StateId(id), false),
            Slot::Free(at) => {
                let id = self.origin.len() as u32;
                self.table.insert(at, hash, id, |id| hash_words(row(id)));
                self.arena.extend_from_slice(state);
                self.origin.push((parent, operator.0));
                (StateId(id), true)
            }
        }
    }

    /// Records a cheaper way to reach a state.
    pub fn set_origin(&mut self, state: StateId, parent: StateId, operator: OperatorId) {
        self.origin[state.0 as usize] = (parent, operator.0);
    }

    /// The state that `state` was reached from, and by which operator; `None` for the initial state.
    pub fn origin(&self, state: StateId) -> Option<(StateId, OperatorId)> {
        let (parent, operator) = self.origin[state.0 as usize];
        (operator != NO_OPERATOR).then_some((parent, OperatorId(operator)))
    }

    /// The operators that lead from the initial state to `state`.
    pub fn path(&self, mut state: StateId) -> Vec<OperatorId> {
        let mut path = Vec::new();
        loop {
            let (parent, operator) = self.origin[state.0 as usize];
            if operator == NO_OPERATOR {
                path.reverse();
                return path;
            }
            path.push(OperatorId(operator));
            state = parent;
        }
    }

    /// The bytes in use.
    pub fn bytes(&self) -> usize {
        self.arena.capacity() * 8 + self.origin.capacity() * 8 + self.table.bytes()
    }
}
