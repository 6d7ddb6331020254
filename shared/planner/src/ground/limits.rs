//! How much grounding may use.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::GroundError;
use crate::search::GaveUp;

/// How large a grounded task may become, and how long that may take.
#[derive(Clone, Debug)]
pub struct GroundLimits<'a> {
    /// Reachable facts.
    pub facts: usize,
    /// Reachable instances of actions, conditional effects and axioms.
    pub instances: usize,
    /// Steps of joining facts, a measure of time that is the same on every machine.
    pub steps: u64,
    /// Bytes of facts and instances, roughly. `None` means no limit.
    pub memory_bytes: Option<usize>,
    /// When to give up. The clock is read only where this is given.
    pub deadline: Option<Instant>,
    /// Grounding stops soon after this becomes true.
    pub cancel: Option<&'a AtomicBool>,
}

impl Default for GroundLimits<'_> {
    fn default() -> Self {
        GroundLimits {
            facts: 20_000_000,
            instances: 20_000_000,
            steps: 20_000_000_000,
            memory_bytes: None,
            deadline: None,
            cancel: None,
        }
    }
}

impl GroundLimits<'_> {
    /// Says if the caller's time is up or the caller cancelled. Loops ask every few thousand steps.
    pub(super) fn check_time(&self) -> Result<(), GroundError> {
        if self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
            return Err(GroundError::GaveUp(GaveUp::Cancelled));
        }
        if self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            return Err(GroundError::GaveUp(GaveUp::Time));
        }
        Ok(())
    }

    /// Says if `bytes` are too many.
    pub(super) fn check_memory(&self, bytes: usize) -> Result<(), GroundError> {
        match self.memory_bytes {
            Some(limit) if bytes > limit => Err(GroundError::GaveUp(GaveUp::Memory)),
            _ => Ok(()),
        }
    }
}

/// Asks for the time only every so often.
#[derive(Debug, Default)]
pub(super) struct Ticks(u32);

impl Ticks {
    const BETWEEN: u32 = 4096;

    /// Counts a step.
    #[inline]
    pub fn tick(&mut self, limits: &GroundLimits<'_>) -> Result<(), GroundError> {
        self.0 += 1;
        if self.0 < Self::BETWEEN {
            return Ok(());
        }
        self.0 = 0;
        limits.check_time()
    }
}
