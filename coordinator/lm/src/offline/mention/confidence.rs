//! How sure a reading is.

/// How much what is taken for granted counts beyond the boldest of it.
const REST: f64 = 0.3;

/// Doubts multiply: each is a part that was not understood. Assumptions do not, or a long instruction would be
/// asked about for its length: the boldest counts in full, the others little.
#[derive(Clone, Copy, Debug)]
pub struct Confidence {
    doubts: f64,
    boldest: f64,
    others: f64,
}

impl Default for Confidence {
    fn default() -> Self {
        Self { doubts: 1.0, boldest: 1.0, others: 1.0 }
    }
}

impl Confidence {
    /// Something was not understood.
    pub fn doubt(&mut self, factor: f64) {
        self.doubts *= factor;
    }

    /// Something was taken for granted.
    pub fn assume(&mut self, factor: f64) {
        self.others *= self.boldest.max(factor);
        self.boldest = self.boldest.min(factor);
    }

    /// From 0 to 1.
    pub fn value(self) -> f64 {
        self.doubts * self.boldest * self.others.powf(REST)
    }
}
