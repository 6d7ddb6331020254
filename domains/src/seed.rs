//! Random numbers that are the same everywhere: SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom
//! number generators", OOPSLA 2014), with a seed made of a number and words.

/// A stream of numbers.
#[derive(Clone, Debug)]
pub struct Seed(u64);

impl Seed {
    /// A stream of its own for each number and list of words.
    pub fn new(seed: u64, words: &[&str]) -> Self {
        // FNV-1a folds the words in; a separator keeps ("ab", "c") and ("a", "bc") apart.
        let mut hash = 0xcbf2_9ce4_8422_2325 ^ seed;
        for byte in words.iter().flat_map(|w| w.bytes().chain([0xff])) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        Seed(hash)
    }

    /// The next number.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `limit`, or 0 if there is none.
    pub fn below(&mut self, limit: usize) -> usize {
        // The remainder's bias is below 2^-50 for the sizes of a household.
        usize::try_from(self.next_u64() % (limit.max(1) as u64)).unwrap_or(0)
    }
}
