//! The contract that coordinator, robot and arbiter keep.
//!
//! A machine is plain state: no I/O, no clock, no thread, no randomness, no hash-map order. A driver feeds
//! it one input at a time and then drains its outputs to `None`; the same code runs over shared memory,
//! over Zenoh and in the deterministic testbed, and a recorded run replays step by step.

use crate::frame::Frame;
use crate::id::{AgentId, JobId, Tick};
use crate::message::{Envelope, Gate, Message};
use crate::topic::Topic;

/// What a driver feeds to a machine.
#[derive(Debug)]
pub enum Input<'a, Done> {
    /// The newest that was said on a topic. Repeats and stale ones may come; the machine sorts them out.
    Message(Topic, Envelope),
    /// The newest frame of the world, read in place.
    Frame(Frame<'a>),
    /// A job has ended.
    Done(JobId, Done),
    /// The transport believes that a peer has gone. A hint only: certainty comes from the supervisor.
    PeerHint(AgentId),
    /// The tick that `poll_timeout` gave has come.
    Timeout,
}

/// What a machine asks of its driver.
#[derive(Clone, Debug, PartialEq)]
pub enum Output<Job> {
    /// Say this; it replaces what was said on the topic before. The driver adds the revision.
    Publish(Topic, Message),
    /// Publish these words on [`Topic::Frame`].
    PublishFrame(Vec<u64>),
    /// Do this elsewhere and come back with [`Input::Done`].
    Spawn(JobId, Job),
    /// The job's answer is no longer wanted.
    Cancel(JobId),
    /// A line for the log and the trace.
    Log(String),
    /// The machine has nothing left to do; its process may end.
    Finish,
}

/// Which frames a machine waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Awaits {
    /// Each.
    AnyFrame,
    /// One in which this gate is open.
    Opening(Gate),
    /// None: only messages and its timeout concern it now.
    NoFrame,
}

/// A state machine without side effects.
pub trait Machine {
    /// Long work that it hands out.
    type Job;
    /// What comes back from it.
    type Done;

    /// One change of state.
    fn handle(&mut self, now: Tick, input: Input<'_, Self::Done>);

    /// What follows from it; called until it gives `None`.
    fn poll_output(&mut self) -> Option<Output<Self::Job>>;

    /// When [`Input::Timeout`] is wanted, if at all.
    fn poll_timeout(&self) -> Option<Tick>;

    /// Which frame it wants to be woken for. A hint that spares a large team from being woken by everybody's steps:
    /// it may be handed other frames, and whatever else it is handed, the newest frame comes with it (without its
    /// facts, where one process hosts many machines).
    fn awaits(&self) -> Awaits {
        Awaits::AnyFrame
    }
}
