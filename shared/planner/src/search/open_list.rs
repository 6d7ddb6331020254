//! Open lists: what to look at next, by estimate, first come first served among equals.

use std::collections::{BTreeMap, VecDeque};

/// Entries by key: a bucket for each small key, a map for large ones.
#[derive(Debug)]
pub(crate) struct OpenList<T> {
    buckets: Vec<VecDeque<T>>,
    lowest: usize,
    large: BTreeMap<u32, VecDeque<T>>,
    len: usize,
}

impl<T> Default for OpenList<T> {
    fn default() -> Self {
        OpenList { buckets: Vec::new(), lowest: 0, large: BTreeMap::new(), len: 0 }
    }
}

impl<T> OpenList<T> {
    const BUCKETS: usize = 1 << 12;

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The bytes in use, roughly.
    pub fn bytes(&self) -> usize {
        self.len * size_of::<T>() * 3 / 2
    }

    #[inline]
    pub fn push(&mut self, key: u32, entry: T) {
        self.len += 1;
        let at = key as usize;
        if at >= Self::BUCKETS {
            self.large.entry(key).or_default().push_back(entry);
            return;
        }
        if at >= self.buckets.len() {
            self.buckets.resize_with(at + 1, VecDeque::new);
        }
        self.lowest = self.lowest.min(at);
        self.buckets[at].push_back(entry);
    }

    /// The first entry of the lowest key, and the key.
    #[inline]
    pub fn pop(&mut self) -> Option<(u32, T)> {
        while self.lowest < self.buckets.len() {
            if let Some(entry) = self.buckets[self.lowest].pop_front() {
                self.len -= 1;
                return Some((self.lowest as u32, entry));
            }
            self.lowest += 1;
        }
        let mut first = self.large.first_entry()?;
        let key = *first.key();
        let entry = first.get_mut().pop_front();
        if first.get().is_empty() {
            first.remove();
        }
        self.len -= 1;
        entry.map(|entry| (key, entry))
    }
}
