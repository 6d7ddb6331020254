//! How much may be spent on a shorter schedule and on the proof that there is none.

use std::time::Duration;

/// What a plan in a task without conditional effects is worth at least, for each operator, and at most: some tenths of a
/// second, most of it for the proof, and some seconds. A task that is solved to the end takes what that takes.
const LEAST_WORK: u64 = 2_500_000;
const WORK_PER_OPERATOR: u64 = 700;
const MOST_WORK: u64 = 25_000_000;

/// Long schedules of large tasks get more than that: the square of (operators times squared steps, divided by this). What
/// it takes to look at a part of a schedule grows with the operators, and how much there is to gain with the steps; so
/// half of the tasks of a set take tenths of a second, and those that are worth it some seconds.
const LENGTH_UNIT: u64 = 500;

/// What is spent beyond that as long as the schedule is much longer than the bound: up to some seconds in all.
const WIDE_WORK: u64 = 50_000_000;

/// A formula may have a literal for so much work: it takes a unit to load one, and it is to be solved, too.
pub(super) const WORK_PER_LITERAL: u64 = 4;

/// How much may be spent. All but the last are the same on every machine.
#[derive(Clone, Debug)]
pub struct MakespanLimits {
    /// Conflicts of the solver, over all formulas.
    pub conflicts: u64,
    /// Literals of a formula: about 20 bytes and, to build and load, 50 ns each.
    pub size: u64,
    /// Work on making a known plan shorter: literals of formulas, and what the solver looks at. A million takes
    /// about 0.13 s.
    pub work: u64,
    /// The same, in all, where the schedule is still much longer than the bound when `work` is used up.
    pub wide_work: u64,
    /// Time on the clock.
    pub time: Option<Duration>,
}

impl Default for MakespanLimits {
    fn default() -> Self {
        MakespanLimits { conflicts: 20_000, size: 4_000_000, work: 500_000, wide_work: 0, time: None }
    }
}

impl MakespanLimits {
    /// These limits and what a task of so many operators, with a plan of so many steps, is worth beyond them.
    pub fn worth(&self, operators: usize, steps: u32) -> Self {
        let (operators, steps) = (operators as u64, u64::from(steps));
        let length = operators.saturating_mul(steps.saturating_mul(steps)) / LENGTH_UNIT;
        let length = length.saturating_mul(length);
        let more = LEAST_WORK.max(operators.saturating_mul(WORK_PER_OPERATOR)).max(length).min(MOST_WORK);
        let work = self.work.saturating_add(more);
        let size = self.size.max(more / WORK_PER_LITERAL);
        MakespanLimits { work, wide_work: self.wide_work.max(WIDE_WORK), size, ..self.clone() }
    }
}
