//! Transports under one trait, and the driver that runs a machine on one.
//!
//! A [`Bus`] is the endpoint of one node of a run. Messages are levels: on every topic the newest wins, and
//! who joins late still gets it. Everything that knows clocks, threads, shared memory or file descriptors
//! is in this crate; the machines know none of it.
//!
//! | module | what |
//! |---|---|
//! | [`inproc`] | many endpoints in one process, for tests and single-process runs |
//! | [`iceoryx`] | processes of one host over shared memory (iceoryx2); nothing big is copied |
//! | `zenoh` | processes of one host or of many, over a network (feature `zenoh`) |
//! | [`bridge`] | between the shared memory of two hosts, everything in few messages |
//! | [`faulty`] | a bad network in front of any of them, for experiments |
//! | [`driver`] | feeds a [`Machine`](lamma_protocol::Machine) from a bus, a clock and its worker threads |
//! | [`process`] | what the processes of a run need from the operating system |
//! | [`trace`] | inputs as JSON lines, to replay a run |

pub mod bridge;
pub mod content;
pub mod driver;
mod error;
pub mod faulty;
pub mod iceoryx;
mod inbox;
pub mod inproc;
pub mod process;
pub mod trace;
#[cfg(feature = "zenoh")]
pub mod zenoh;

use std::task::Waker;
use std::time::Duration;

use lamma_protocol::{AgentId, Awaits, Envelope, Frame, Node, Topic, codec};

pub use error::{PublishError, WaitError};
pub use inbox::{Inbox, Stats};

/// The endpoint of one node of a run.
///
/// What every implementation keeps, and `tests/conformance.rs` checks for each of them:
///
/// - On one topic the newest wins: a reader may miss what was replaced, never what is newest.
/// - Who joins late gets the newest of every topic whose publisher lives.
/// - Either side may end, be killed or start again; the other goes on.
/// - Nothing here waits for a peer: a reader that never reads, is stopped or is dead delays nobody.
/// - Only the topic's own publisher writes to it, only its readers read it.
/// - Bytes that are not a message of this wire version are counted in [`Stats`], logged and dropped.
pub trait Bus {
    /// Whose endpoint this is.
    fn node(&self) -> Node;

    /// Publishes bytes as they are: the primitive below [`Bus::publish`], also for what injects faults.
    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError>;

    /// As [`Bus::publish_bytes`], of what its readers learn by a frame anyway: a transport may let them sleep until
    /// that comes.
    fn publish_quietly(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        self.publish_bytes(topic, bytes)
    }

    /// Publishes the words of a world frame; one copy, into memory that all readers share.
    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError>;

    /// Hands over the newest of each topic that has something new, in the order of [`Topic::all`], and
    /// returns how many that were.
    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize;

    /// Sleeps until something may have arrived, [`Bus::waker`] is used, or the time is over (`None`:
    /// without limit). False if it was the time. May return early for no reason.
    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError>;

    /// Which frames need end a [`Bus::wait`] from now on. A hint: others may end it too, and whatever ends it, the
    /// newest frame is received.
    fn await_frames(&mut self, awaits: Awaits) {
        let _ = awaits;
    }

    /// Ends a [`Bus::wait`], now or the next one, from any thread.
    fn waker(&self) -> Waker;

    /// What this endpoint has seen.
    fn stats(&self) -> &Stats;

    /// Publishes a message, replacing what was said on the topic before.
    fn publish(&mut self, topic: Topic, envelope: &Envelope) -> Result<(), PublishError> {
        let bytes = codec::encode(envelope).map_err(|source| PublishError::Encode { topic, source })?;
        self.publish_bytes(topic, &bytes)
    }
}

impl<B: Bus + ?Sized> Bus for Box<B> {
    fn node(&self) -> Node {
        (**self).node()
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        (**self).publish_bytes(topic, bytes)
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        (**self).publish_frame(words)
    }

    fn publish_quietly(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        (**self).publish_quietly(topic, bytes)
    }

    fn await_frames(&mut self, awaits: Awaits) {
        (**self).await_frames(awaits);
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        (**self).receive(sink)
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        (**self).wait(timeout)
    }

    fn waker(&self) -> Waker {
        (**self).waker()
    }

    fn stats(&self) -> &Stats {
        (**self).stats()
    }
}

/// Something new on a topic.
#[derive(Debug)]
pub enum Received<'a> {
    /// A message.
    Message(Topic, Envelope),
    /// The world, read where the publisher wrote it; gone when the sink returns.
    Frame(Frame<'a>),
    /// The transport believes that a member has gone. A hint: certainty comes from the supervisor.
    PeerHint(AgentId),
}

/// Checks that `node` may publish `topic` in a team of `agents`.
fn check_publisher(node: Node, topic: Topic, agents: u16) -> Result<(), PublishError> {
    let known = match topic {
        Topic::Directive(a) | Topic::Report(a) | Topic::Request(a) | Topic::Ack(a) => a.0 < agents,
        Topic::Command | Topic::Outcome | Topic::Grant | Topic::Vocabulary | Topic::Frame => true,
    };
    match () {
        () if !known => Err(PublishError::NoSuchTopic { topic, agents }),
        () if topic.publisher() != node => {
            Err(PublishError::NotPublisher { node, topic, publisher: topic.publisher() })
        }
        () => Ok(()),
    }
}

/// As [`check_publisher`], for bytes of a message.
fn check_bytes(node: Node, topic: Topic, agents: u16, bytes: &[u8]) -> Result<(), PublishError> {
    check_publisher(node, topic, agents)?;
    if topic == Topic::Frame {
        return Err(PublishError::BytesOnFrame);
    }
    if bytes.len() > codec::MAX_MESSAGE_BYTES {
        let source = codec::CodecError::TooLarge(bytes.len());
        return Err(PublishError::Encode { topic, source });
    }
    Ok(())
}

/// The topics that `node` reads in a team of `agents`, in the order of [`Topic::all`].
fn topics_read_by(node: Node, agents: u16) -> Vec<Topic> {
    Topic::all(agents).into_iter().filter(|t| t.read_by(node)).collect()
}
