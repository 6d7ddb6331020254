//! Small dense identifiers, each its own type so that one cannot stand for another.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A member of the team: its index in the roster, which is fixed for the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AgentId(pub u16);

impl AgentId {
    /// As an index into per-agent tables.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// One (re)plan of the team. The arbiter is its authority: what belongs to another epoch is refused, so a
/// robot that was paused and wakes late can do no harm (a fencing token, Kleppmann 2016).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Epoch(pub u64);

impl Epoch {
    /// The epoch after this.
    pub fn next(self) -> Epoch {
        Epoch(self.0 + 1)
    }
}

/// The position of a step in one agent's plan of one epoch, from 0. As a count: how many steps are done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct StepIndex(pub u32);

impl StepIndex {
    /// As an index into a plan.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The step after this.
    pub fn next(self) -> StepIndex {
        StepIndex(self.0 + 1)
    }
}

/// Orders what one sender said: a restarted process has a higher incarnation, and within one each new
/// statement a higher number. A receiver keeps the greatest and drops the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Revision {
    /// Which start of the process.
    pub incarnation: u32,
    /// Which statement since.
    pub number: u64,
}

impl Revision {
    /// The next statement.
    pub fn next(self) -> Revision {
        Revision { number: self.number + 1, ..self }
    }
}

/// Microseconds since the run began. (`std::time::Instant` cannot be serialised, so a log of it could not
/// be replayed.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Tick(pub u64);

impl Tick {
    /// This many microseconds later.
    pub fn after_us(self, us: u64) -> Tick {
        Tick(self.0.saturating_add(us))
    }

    /// This many milliseconds later.
    pub fn after_ms(self, ms: u64) -> Tick {
        self.after_us(ms.saturating_mul(1000))
    }

    /// Microseconds since `earlier`, 0 if that is in the future.
    pub fn since_us(self, earlier: Tick) -> u64 {
        self.0.saturating_sub(earlier.0)
    }
}

/// A sub-task with its robot: what one robot plans for at once. Dense within an epoch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct PackageId(pub u32);

/// Long work that a machine has asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct JobId(pub u64);

/// A process of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Node {
    /// The launcher, which starts and watches the others.
    Supervisor,
    /// The coordinator.
    Coordinator,
    /// The process that alone changes the world.
    Simulator,
    /// A robot.
    Robot(AgentId),
}

impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Node::Supervisor => f.write_str("supervisor"),
            Node::Coordinator => f.write_str("coordinator"),
            Node::Simulator => f.write_str("simulator"),
            Node::Robot(a) => write!(f, "robot-{}", a.0),
        }
    }
}
