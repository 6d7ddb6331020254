//! A hash table of dense numbers whose keys live elsewhere (in an arena).

/// The hash of a row of words; fast, and the same in every process.
#[inline]
pub(crate) fn hash_words<T: Copy + Into<u64>>(words: &[T]) -> u64 {
    const K: u64 = 0x9E37_79B9_7F4A_7C15;
    let mut hash = K ^ words.len() as u64;
    for &word in words {
        hash = (hash.rotate_left(23) ^ word.into()).wrapping_mul(K);
        hash ^= hash >> 29;
    }
    hash ^ (hash >> 32)
}

/// An open-addressing table of `u32` ids; the caller hashes and compares the keys.
#[derive(Clone, Debug, Default)]
pub(crate) struct IdTable {
    /// The high half of the hash and the id, packed; zero is free.
    slots: Vec<u64>,
    len: usize,
}

/// What a look-up found.
pub(crate) enum Slot {
    /// The key is there, under this id.
    Found(u32),
    /// The key is missing; it belongs at this position.
    Free(usize),
}

impl IdTable {
    /// The bytes the table holds.
    pub fn bytes(&self) -> usize {
        self.slots.len() * 8
    }

    /// Looks for a key; `same` says whether an id of equal hash has that key.
    #[inline]
    pub fn find(&self, hash: u64, same: impl Fn(u32) -> bool) -> Slot {
        if self.slots.is_empty() {
            return Slot::Free(usize::MAX);
        }
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        loop {
            let slot = self.slots[at];
            if slot == 0 {
                return Slot::Free(at);
            }
            if slot >> 32 == hash >> 32 {
                let id = (slot as u32).wrapping_sub(1);
                if same(id) {
                    return Slot::Found(id);
                }
            }
            at = (at + 1) & mask;
        }
    }

    /// Stores `id` under `hash` at the position a failed [`IdTable::find`] gave. `rehash` gives the hash of
    /// a stored id, for growing.
    pub fn insert(&mut self, at: usize, hash: u64, id: u32, rehash: impl Fn(u32) -> u64) {
        let entry = (hash >> 32) << 32 | u64::from(id + 1);
        self.len += 1;
        if at != usize::MAX && self.len * 4 <= self.slots.len() * 3 {
            self.slots[at] = entry;
            return;
        }
        let size = (self.slots.len() * 2).max(16);
        let old = std::mem::replace(&mut self.slots, vec![0; size]);
        for slot in old.into_iter().filter(|&slot| slot != 0) {
            self.place(rehash((slot as u32).wrapping_sub(1)), slot);
        }
        self.place(hash, entry);
    }

    fn place(&mut self, hash: u64, entry: u64) {
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        while self.slots[at] != 0 {
            at = (at + 1) & mask;
        }
        self.slots[at] = entry;
    }
}
