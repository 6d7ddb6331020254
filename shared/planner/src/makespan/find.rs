//! Finding a schedule where none is known: formulas of several lengths in turns.
//!
//! Searches that walk from state to state lose their way where what is used up never comes back (energy, fuel, a
//! seat): each step looks good until nothing is left. A formula sees the whole schedule at once. Of which length it
//! must be is not known, and formulas that are a little too short are the hardest, so several lengths take turns,
//! each with few conflicts at first (Rintanen, Heljanko & Niemelä, "Planning as satisfiability: parallel plans and
//! algorithms for plan search", AIJ 170, 2006, on evaluating several lengths at once).

use std::sync::atomic::AtomicBool;

use super::sat::Fuel;
use super::{Answer, MakespanLimits, Schedule, Scheduler};

/// Lengths that take turns; each is a third longer than the one before.
const LENGTHS: usize = 6;

/// Conflicts of each formula in the first round; each round has thrice as many.
const CONFLICTS: u64 = 1_000;

impl Scheduler<'_> {
    /// Some schedule, not the shortest; `None` if there is none within the limits (those of conflicts, size and time).
    pub fn find(&self, limits: &MakespanLimits, cancel: &AtomicBool) -> Option<Schedule> {
        let mut fuel = Fuel::new(&MakespanLimits { work: u64::MAX, ..limits.clone() }, cancel);
        let mut shortest = self.depth().max(1);
        let mut conflicts = CONFLICTS;
        while !fuel.is_empty() {
            let before = (fuel.work, shortest);
            let longer = |length: &u32| Some(length + length.div_ceil(3));
            let lengths: Vec<u32> = std::iter::successors(Some(shortest), longer).take(LENGTHS).collect();
            // Long ones first: they are larger, but there is room in them.
            for length in lengths.into_iter().rev() {
                if length < shortest {
                    break;
                }
                match fuel.at_most(conflicts, |fuel| self.of_length(length, fuel)) {
                    Answer::Schedule(schedule) => return Some(schedule),
                    Answer::None => shortest = shortest.max(length + 1),
                    Answer::Unknown => {}
                }
            }
            // All of them are too large, now and later.
            if before == (fuel.work, shortest) {
                return None;
            }
            conflicts = conflicts.saturating_mul(3);
        }
        None
    }
}
