//! The facts of one predicate, indexed for joins.

use crate::id_table::{IdTable, Slot, hash_words};

/// A growing set of rows of objects. A row is found by [`Relation::find`] as soon as it is inserted, but
/// joins see it only once it was shown: semi-naive evaluation shows facts one by one.
#[derive(Debug, Default)]
pub(crate) struct Relation {
    arity: usize,
    objects: usize,
    rows: Vec<u32>,
    len: usize,
    table: IdTable,
    /// The rows that joins see are the first `shown`.
    shown: usize,
    /// For each position and each object the shown rows with that object there.
    index: Vec<Vec<Vec<u32>>>,
}

impl Relation {
    pub fn new(arity: usize, objects: usize) -> Self {
        Relation { arity, objects, ..Relation::default() }
    }

    pub fn len(&self) -> usize {
        self.len
    }

    /// The number of rows that joins see.
    pub fn shown(&self) -> usize {
        self.shown
    }

    #[inline]
    pub fn row(&self, row: u32) -> &[u32] {
        &self.rows[row as usize * self.arity..(row as usize + 1) * self.arity]
    }

    /// The number of the row with these arguments, shown or not.
    #[inline]
    pub fn find(&self, args: &[u32]) -> Option<u32> {
        if self.arity == 0 {
            return (self.len > 0).then_some(0);
        }
        match self.table.find(hash_words(args), |id| self.row(id) == args) {
            Slot::Found(id) => Some(id),
            Slot::Free(_) => None,
        }
    }

    /// Adds a row; returns its number if it is new.
    pub fn insert(&mut self, args: &[u32]) -> Option<u32> {
        if self.arity == 0 {
            self.len += 1;
            let new = self.len == 1;
            self.len = 1;
            return new.then_some(0);
        }
        let hash = hash_words(args);
        let Slot::Free(at) = self.table.find(hash, |id| self.row(id) == args) else { return None };
        let id = self.len as u32;
        self.rows.extend_from_slice(args);
        self.len += 1;
        let (rows, arity) = (&self.rows, self.arity);
        self.table
            .insert(at, hash, id, |id| hash_words(&rows[id as usize * arity..(id as usize + 1) * arity]));
        Some(id)
    }

    /// Shows the next row to joins. Rows are shown in the order of insertion.
    pub fn show_next(&mut self) {
        if self.index.is_empty() && self.arity > 0 {
            self.index = vec![vec![Vec::new(); self.objects]; self.arity];
        }
        let row = self.shown;
        for position in 0..self.arity {
            let object = self.rows[row * self.arity + position];
            self.index[position][object as usize].push(row as u32);
        }
        self.shown += 1;
    }

    /// The shown rows with `object` at `position`.
    #[inline]
    pub fn with(&self, position: usize, object: u32) -> &[u32] {
        match self.index.get(position) {
            Some(by_object) => &by_object[object as usize],
            None => &[],
        }
    }
}
