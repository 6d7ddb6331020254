//! Where the time of a run goes.

use lamma_protocol::Tick;

use crate::phase::Phase;
use crate::result::TimeMs;

/// Adds up the time per phase.
#[derive(Debug, Default)]
pub(crate) struct Stopwatch {
    times: TimeMs,
    since: Tick,
    running: Slot,
}

#[derive(Clone, Copy, Debug, Default)]
enum Slot {
    #[default]
    Start,
    Decompose,
    Allocate,
    Plan,
    Combine,
    Execute,
}

impl Stopwatch {
    /// The phase changes.
    pub fn enter(&mut self, now: Tick, phase: &Phase) {
        let spent = now.since_us(self.since) as f64 / 1e3;
        *match self.running {
            Slot::Start => &mut self.times.start,
            Slot::Decompose => &mut self.times.decompose,
            Slot::Allocate => &mut self.times.allocate,
            Slot::Plan => &mut self.times.plan,
            Slot::Combine => &mut self.times.combine,
            Slot::Execute => &mut self.times.execute,
        } += spent;
        self.since = now;
        self.running = match phase {
            Phase::Joining | Phase::Granting => Slot::Start,
            Phase::Decomposing(_) => Slot::Decompose,
            Phase::Allocating(_) => Slot::Allocate,
            Phase::Planning(_) | Phase::PlanningJointly(_) | Phase::Writing(..) => Slot::Plan,
            Phase::Combining(..) => Slot::Combine,
            Phase::Executing(_) | Phase::Finished => Slot::Execute,
        };
    }

    /// When the phase began.
    pub fn since(&self) -> Tick {
        self.since
    }

    /// The sums, and `now` as the total.
    pub fn read(&self, now: Tick) -> TimeMs {
        TimeMs { total: now.0 as f64 / 1e3, ..self.times.clone() }
    }
}
