//! Holds a command that computes to its limits of time and memory, and lets Ctrl-C end it with what it has.
//!
//! A thread of its own looks at the clock, the resident memory and the signals, so that the limits hold
//! wherever the work is: reading, grounding, searching, inside one long step. Without limits it is started only for
//! work that may have long steps.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};

use crate::error::Failure;

/// How often the memory is looked at. A process fills about two gigabytes a second at most, so that the limit is
/// overrun by a few mebibytes.
const LOOK_AT_MEMORY: Duration = Duration::from_millis(2);

/// How often the signals are looked at.
const LOOK_AT_SIGNALS: Duration = Duration::from_millis(20);

/// What the work may use.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// Until when.
    pub deadline: Option<Instant>,
    /// Resident bytes of the whole process.
    pub memory_bytes: Option<usize>,
}

/// Why the work has to end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The time is up.
    Time,
    /// Too much memory is in use.
    Memory,
    /// Ctrl-C, or a request to terminate.
    Signal,
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Stop::Time => "the time limit is used up",
            Stop::Memory => "the memory limit is used up",
            Stop::Signal => "it was interrupted",
        })
    }
}

/// Watches over the work.
pub struct Guard {
    allowance: Allowance,
    signalled: Arc<AtomicBool>,
    /// What to do at the end, until the thread has it.
    stop: Option<Box<dyn FnOnce(Stop) + Send>>,
}

impl Guard {
    /// Takes note of signals from now on; watches, if there is a limit. `stop` is to print what there is and to end the
    /// process.
    pub fn new(allowance: Allowance, stop: impl FnOnce(Stop) + Send + 'static) -> Result<Self, Failure> {
        let signalled = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&signalled))
                .map_err(|error| Failure::fault(format!("cannot handle signals: {error}")))?;
        }
        let mut guard = Guard { allowance, signalled, stop: Some(Box::new(stop)) };
        if guard.allowance.deadline.is_some() || guard.allowance.memory_bytes.is_some() {
            guard.watch()?;
        }
        Ok(guard)
    }

    /// Calls `stop` from a thread of its own when the allowance is used up or a signal comes. To be called before work
    /// that may take long without a look at [`Guard::signalled`]: a thread takes longer to start than a small task to
    /// ground.
    pub fn watch(&mut self) -> Result<(), Failure> {
        let Some(stop) = self.stop.take() else { return Ok(()) };
        let (allowance, signalled) = (self.allowance, Arc::clone(&self.signalled));
        std::thread::Builder::new()
            .name("guard".into())
            .spawn(move || stop(wait(allowance, &signalled)))
            .map_err(|error| Failure::fault(format!("cannot start a thread: {error}")))?;
        Ok(())
    }

    /// Whether a signal came.
    pub fn signalled(&self) -> &AtomicBool {
        &self.signalled
    }
}

/// Returns when the work has to end.
fn wait(allowance: Allowance, signalled: &AtomicBool) -> Stop {
    let pause = if allowance.memory_bytes.is_some() { LOOK_AT_MEMORY } else { LOOK_AT_SIGNALS };
    loop {
        let now = Instant::now();
        if allowance.deadline.is_some_and(|deadline| now >= deadline) {
            return Stop::Time;
        }
        if signalled.load(Ordering::Relaxed) {
            return Stop::Signal;
        }
        if allowance.memory_bytes.is_some_and(|limit| resident_bytes().is_some_and(|bytes| bytes >= limit)) {
            return Stop::Memory;
        }
        let left = allowance.deadline.map_or(pause, |deadline| deadline.saturating_duration_since(now));
        std::thread::sleep(pause.min(left));
    }
}

/// The resident memory of this process; `None` where the host does not say.
fn resident_bytes() -> Option<usize> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: usize = text.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(pages * rustix::param::page_size())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_limit_reached_is_the_one_named() {
        let quiet = AtomicBool::new(false);
        let soon = Instant::now().checked_add(Duration::from_millis(30));
        let used = resident_bytes().expect("this host has /proc");
        assert!(used > 100_000, "{used} bytes for a whole process");
        let both = Allowance { deadline: soon, memory_bytes: Some(used / 2) };
        assert_eq!(wait(both, &quiet), Stop::Memory);
        let time = Allowance { deadline: soon, memory_bytes: Some(usize::MAX) };
        assert_eq!(wait(time, &quiet), Stop::Time);
        let interrupted = Allowance { deadline: None, memory_bytes: None };
        assert_eq!(wait(interrupted, &AtomicBool::new(true)), Stop::Signal);
    }
}
