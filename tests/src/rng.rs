//! The testbed's only source of chance. The seed draws the configuration too, not only the events.

/// A seeded generator (a thin coat over `fastrand`, so that its use is in one place).
#[derive(Clone, Debug)]
pub struct Rng(fastrand::Rng);

impl Rng {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Rng(fastrand::Rng::with_seed(seed))
    }

    /// True with probability `p`.
    pub fn chance(&mut self, p: f64) -> bool {
        self.0.f64() < p
    }

    /// From `low` up to, not including, `high`.
    pub fn range(&mut self, low: u64, high: u64) -> u64 {
        self.0.u64(low..high.max(low + 1))
    }

    /// From 0 to `max`, evenly.
    pub fn fraction(&mut self, max: f64) -> f64 {
        self.0.f64() * max
    }
}
