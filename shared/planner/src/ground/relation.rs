//! The facts of one predicate, indexed for joins.

use crate::id_table::{IdTable, Slot, hash_words};
use crate::lifted::Range;

/// A predicate has at most so many views; further ones are one for all.
const MAX_VIEWS: usize = 16;

/// The shown rows whose objects are of certain kinds. `at` tells the place of a truck or of one of a thousand
/// parcels: who asks for trucks need not look at parcels.
#[derive(Debug, Default)]
struct View {
    /// For each position the range that the object is in; `None`: any.
    kinds: Vec<Option<u32>>,
    rows: Vec<u32>,
    /// For each position and each object the rows with that object there.
    index: Vec<Vec<Vec<u32>>>,
}

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
    views: Vec<View>,
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

    /// The number of the view of these kinds. Views have to be asked for before a row is shown.
    pub fn view(&mut self, mut kinds: Vec<Option<u32>>) -> u32 {
        if self.views.len() >= MAX_VIEWS {
            kinds.fill(None);
        }
        let known = self.views.iter().position(|view| view.kinds == kinds);
        let at = known.unwrap_or_else(|| {
            self.views.push(View { kinds, ..View::default() });
            self.views.len() - 1
        });
        at as u32
    }

    /// Shows the next row to joins. Rows are shown in the order of insertion.
    pub fn show_next(&mut self, ranges: &[Range]) {
        let row = self.shown as u32;
        self.shown += 1;
        let args = &self.rows[row as usize * self.arity..(row as usize + 1) * self.arity];
        for view in &mut self.views {
            let fits = |(kind, &object): (&Option<u32>, &u32)| {
                kind.is_none_or(|range| ranges[range as usize].contains[object as usize])
            };
            if !view.kinds.iter().zip(args).all(fits) {
                continue;
            }
            if view.index.is_empty() {
                view.index = vec![vec![Vec::new(); self.objects]; self.arity];
            }
            view.rows.push(row);
            for (by_object, &object) in view.index.iter_mut().zip(args) {
                by_object[object as usize].push(row);
            }
        }
    }

    /// The shown rows of a view.
    #[inline]
    pub fn rows_of(&self, view: u32) -> &[u32] {
        &self.views[view as usize].rows
    }

    /// The shown rows of a view with `object` at `position`.
    #[inline]
    pub fn with(&self, view: u32, position: usize, object: u32) -> &[u32] {
        match self.views[view as usize].index.get(position) {
            Some(by_object) => &by_object[object as usize],
            None => &[],
        }
    }
}
