//! States by what is known of them, to pick from without trusting it: first any of the kinds there are, then any state
//! of that kind (Xie, Müller, Holte & Imai 2014, "Type-based exploration with multiple search queues for satisficing
//! planning"). Rare kinds are picked as often as common ones, so a search that follows a misleading heuristic into
//! a large plateau still looks elsewhere.

use std::collections::HashMap;

use super::registry::StateId;

/// The states of each kind. Nothing is ever taken out.
#[derive(Debug, Default)]
pub(super) struct TypeBuckets {
    index: HashMap<(u32, u32), usize>,
    buckets: Vec<Vec<StateId>>,
    len: usize,
    random: Random,
}

impl TypeBuckets {
    /// Adds a state of a kind.
    pub fn push(&mut self, kind: (u32, u32), state: StateId) {
        let at = *self.index.entry(kind).or_insert(self.buckets.len());
        if at == self.buckets.len() {
            self.buckets.push(Vec::new());
        }
        self.buckets[at].push(state);
        self.len += 1;
    }

    /// Some state, of some kind.
    pub fn pick(&mut self) -> Option<StateId> {
        let kind = self.random.below(self.buckets.len())?;
        let bucket = &self.buckets[kind];
        self.random.below(bucket.len()).map(|at| bucket[at])
    }

    /// Some of these.
    pub fn any<T: Copy>(&mut self, of: &[T]) -> Option<T> {
        self.random.below(of.len()).map(|at| of[at])
    }

    /// The bytes in use, roughly.
    pub fn bytes(&self) -> usize {
        self.len * size_of::<StateId>() * 3 / 2 + self.buckets.len() * 64
    }
}

/// Numbers without a pattern, the same ones in every search (splitmix64; Steele, Lea & Flood 2014).
#[derive(Debug, Default)]
struct Random(u64);

impl Random {
    /// A number below `end`, if there is one.
    fn below(&mut self, end: usize) -> Option<usize> {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^= mixed >> 31;
        (end > 0).then(|| (mixed % end as u64) as usize)
    }
}
