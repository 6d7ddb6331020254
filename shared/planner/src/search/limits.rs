//! Limits, options and outcomes of a search.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::ground::GroundLimits;
use crate::plan::Plan;

/// How much a search may use. `None` means no limit.
#[derive(Clone, Debug, Default)]
pub struct Limits {
    /// Expanded states, a measure of time that is the same on every machine.
    pub expansions: Option<u64>,
    /// Wall-clock time. The clock is read only where this is given.
    pub time: Option<Duration>,
    /// Memory for states and open lists.
    pub memory_bytes: Option<usize>,
}

impl Limits {
    /// The same for grounding, from now on.
    pub fn for_grounding<'a>(&self, cancel: &'a AtomicBool) -> GroundLimits<'a> {
        GroundLimits {
            deadline: self.time.and_then(|time| Instant::now().checked_add(time)),
            memory_bytes: self.memory_bytes,
            cancel: Some(cancel),
            ..GroundLimits::default()
        }
    }

    /// What is left of them once grounding under `used` is done.
    pub fn after(&self, used: &GroundLimits<'_>) -> Limits {
        let left = used.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
        Limits { time: left.or(self.time), ..self.clone() }
    }
}

/// Time that runs down, for work in several parts.
#[derive(Clone, Copy, Debug)]
pub struct Countdown(Option<Instant>);

impl Countdown {
    /// Starts with so much time.
    pub fn from(time: Duration) -> Self {
        Countdown(Instant::now().checked_add(time))
    }

    /// What is left; `None` if there is no end.
    pub fn left(&self) -> Option<Duration> {
        self.0.map(|end| end.saturating_duration_since(Instant::now()))
    }
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A plan.
    Found(Plan),
    /// Proved: there is none.
    Unsolvable(Unsolvable),
    /// Neither a plan nor a proof within the limits.
    GaveUp(GaveUp),
}

/// Why no plan exists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unsolvable {
    /// These parts of the goal cannot become true even if nothing were ever deleted.
    Unreachable(Vec<String>),
    /// Every reachable state was seen.
    Exhausted,
    /// Some variables alone, whatever the others are, never come to what the goal asks of them.
    OnAPart,
}

impl std::fmt::Display for Unsolvable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unsolvable::Unreachable(facts) => {
                write!(f, "no sequence of actions can make this part of the goal true: {}", facts.join(", "))
            }
            Unsolvable::Exhausted => {
                f.write_str("every reachable state was searched and none meets the goal")
            }
            Unsolvable::OnAPart => f.write_str(
                "what the goal asks for cannot hold together, whatever is done about everything else",
            ),
        }
    }
}

/// Why a search stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GaveUp {
    /// The limit of expansions.
    Expansions,
    /// The limit of time.
    Time,
    /// The limit of memory.
    Memory,
    /// The caller cancelled.
    Cancelled,
}

impl std::fmt::Display for GaveUp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            GaveUp::Expansions => "the limit of expanded states is used up",
            GaveUp::Time => "the time limit is used up",
            GaveUp::Memory => "the memory limit is used up",
            GaveUp::Cancelled => "the search was cancelled",
        })
    }
}

/// Watches the limits during a search.
pub(crate) struct Meter<'a> {
    limits: &'a Limits,
    cancel: &'a AtomicBool,
    deadline: Option<Instant>,
    pub expanded: u64,
    /// Bytes held by searches that are paused.
    reserved: usize,
    ticks: u32,
}

impl<'a> Meter<'a> {
    pub fn new(limits: &'a Limits, cancel: &'a AtomicBool) -> Self {
        let deadline = limits.time.and_then(|time| Instant::now().checked_add(time));
        Meter { limits, cancel, deadline, expanded: 0, reserved: 0, ticks: 0 }
    }

    /// The limit of memory, if there is one.
    pub fn memory_limit(&self) -> usize {
        self.limits.memory_bytes.unwrap_or(usize::MAX)
    }

    /// Says how much memory is held beside the search that runs.
    pub fn reserve(&mut self, bytes: usize) {
        self.reserved = bytes;
    }

    /// Counts an expansion; says if the search must stop. `bytes` is asked only now and then.
    #[inline]
    pub fn expand(&mut self, bytes: impl FnOnce() -> usize) -> Result<(), GaveUp> {
        if self.limits.expansions.is_some_and(|limit| self.expanded >= limit) {
            return Err(GaveUp::Expansions);
        }
        self.expanded += 1;
        self.ticks += 1;
        if self.ticks < 32 {
            return Ok(());
        }
        self.ticks = 0;
        self.check(bytes)
    }

    /// Checks everything but the expansions.
    pub fn check(&self, bytes: impl FnOnce() -> usize) -> Result<(), GaveUp> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(GaveUp::Cancelled);
        }
        if self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            return Err(GaveUp::Time);
        }
        if self.limits.memory_bytes.is_some_and(|limit| self.reserved + bytes() > limit) {
            return Err(GaveUp::Memory);
        }
        Ok(())
    }
}
