//! Rows of different lengths in one allocation.

/// A list of lists, stored as offsets into one vector.
#[derive(Clone, Debug)]
pub(crate) struct Csr<T> {
    offsets: Vec<u32>,
    items: Vec<T>,
}

impl<T> Default for Csr<T> {
    fn default() -> Self {
        Csr { offsets: vec![0], items: Vec::new() }
    }
}

impl<T> Csr<T> {
    /// Adds an item to the row that is being built.
    pub fn push(&mut self, item: T) {
        self.items.push(item);
    }

    /// Ends the row that is being built and starts the next.
    pub fn end_row(&mut self) {
        self.offsets.push(self.items.len() as u32);
    }

    /// Appends a whole row.
    pub fn push_row(&mut self, row: impl IntoIterator<Item = T>) {
        self.items.extend(row);
        self.end_row();
    }

    /// The number of finished rows.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// All items of all rows.
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// The positions of row `row` among [`Csr::items`].
    #[inline]
    pub fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.offsets[row] as usize..self.offsets[row + 1] as usize
    }

    /// Row `row`.
    #[inline]
    pub fn row(&self, row: usize) -> &[T] {
        &self.items[self.range(row)]
    }

    /// Every row in order.
    pub fn rows(&self) -> impl Iterator<Item = &[T]> + Clone {
        (0..self.len()).map(|row| self.row(row))
    }
}

impl<T: Copy + Default> Csr<T> {
    /// Sorts `pairs` of (row, item) into `rows` rows; within a row the order of `pairs` is kept.
    pub fn from_pairs(rows: usize, pairs: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut offsets = vec![0u32; rows + 1];
        for (row, _) in pairs.clone() {
            offsets[row as usize + 1] += 1;
        }
        for row in 0..rows {
            offsets[row + 1] += offsets[row];
        }
        let mut next = offsets.clone();
        let mut items = vec![T::default(); offsets[rows] as usize];
        for (row, item) in pairs {
            items[next[row as usize] as usize] = item;
            next[row as usize] += 1;
        }
        Csr { offsets, items }
    }
}
