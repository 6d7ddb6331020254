//! Runs machines on a bus: messages, frames, time and the answers of jobs in, outputs out.
//!
//! Most processes have one machine ([`drive`]); a process that hosts many robots has a crowd of them on one
//! endpoint ([`drive_crowd`]). They are handled by one thread, the caller's. Long work goes to worker threads; their answers and
//! [`Stop`] wake the driver through the same bell as messages, so it sleeps whenever there is nothing to do.

mod crowd;
mod jobs;
mod stop;

use std::time::Instant;

use lamma_protocol::{Envelope, Input, Machine, Node, Output, Tick, Topic, codec};
use thiserror::Error;

use crate::{Bus, PublishError, Received, WaitError};
use crowd::Crowd;
use jobs::Pool;
pub use jobs::Worker;
pub use stop::Stop;

/// How a driver works.
pub struct Settings<'a, Done> {
    /// Which start of this process it is; the supervisor counts.
    pub incarnation: u32,
    /// When tick 0 was.
    pub start: Instant,
    /// Ends the driver from elsewhere.
    pub stop: Stop,
    /// Sees every input before the machine does. See [`crate::trace`].
    pub record: Option<Recorder<'a, Done>>,
}

/// Sees every input, with its tick and its node.
pub type Recorder<'a, Done> = Box<dyn FnMut(Tick, Node, &Input<'_, Done>) + Send + 'a>;

impl<Done> Default for Settings<'_, Done> {
    fn default() -> Self {
        Settings { incarnation: 0, start: Instant::now(), stop: Stop::default(), record: None }
    }
}

/// Why a driver ended in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The machine had nothing left to do.
    Finished,
    /// It was told to stop.
    Stopped,
}

/// Why a driver cannot go on. The process should end and say so; the supervisor may start it again.
#[derive(Debug, Error)]
pub enum DriverError {
    /// See [`WaitError`].
    #[error(transparent)]
    Wait(#[from] WaitError),
    /// The machine published what it may not: a fault in the software.
    #[error("{node} cannot publish: {source}")]
    Publish {
        /// Which machine.
        node: Node,
        /// Why.
        source: PublishError,
    },
    /// A job panicked.
    #[error("{node}: job {job} panicked: {message}; this is a fault in the software, please report it")]
    JobPanicked {
        /// Which machine's.
        node: Node,
        /// Which job.
        job: u64,
        /// The panic's message.
        message: String,
    },
    /// More jobs are waiting than any machine should have.
    #[error("{node}: {waiting} jobs are waiting; this is a fault in the software, please report it")]
    TooManyJobs {
        /// Which machine's.
        node: Node,
        /// How many.
        waiting: usize,
    },
    /// The operating system gives no thread.
    #[error("{node}: no thread for a worker ({reason}): raise the limit on processes (`ulimit -u`)")]
    NoThread {
        /// Which machine's.
        node: Node,
        /// What the system said.
        reason: String,
    },
}

/// Drives `machine` on `bus` until it finishes, [`Stop`] is used, or an error ends it. One thread is
/// started for each of `workers`; jobs still running at the end are cancelled, and waited for briefly.
pub fn drive<M, B>(
    machine: &mut M,
    bus: &mut B,
    settings: Settings<'_, M::Done>,
    workers: Vec<Worker<M::Job, M::Done>>,
) -> Result<End, DriverError>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
    B: Bus + ?Sized,
{
    let node = bus.node();
    drive_all(Crowd::new([(node, machine)], settings), bus, workers)
}

/// As [`drive`], for many machines on one endpoint, each the one of a node: all robots of a seat (see
/// [`Scope::seats`](crate::iceoryx::Scope::seats)). Each hears what its node reads, counts its own
/// revisions and finishes by itself; the workers are shared.
pub fn drive_crowd<M, B>(
    machines: &mut [(Node, M)],
    bus: &mut B,
    settings: Settings<'_, M::Done>,
    workers: Vec<Worker<M::Job, M::Done>>,
) -> Result<End, DriverError>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
    B: Bus + ?Sized,
{
    drive_all(Crowd::new(machines.iter_mut().map(|(node, m)| (*node, m)), settings), bus, workers)
}

fn drive_all<M, B>(
    crowd: Crowd<'_, M>,
    bus: &mut B,
    workers: Vec<Worker<M::Job, M::Done>>,
) -> Result<End, DriverError>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
    B: Bus + ?Sized,
{
    let waker = bus.waker();
    crowd.stop.register(&waker);
    let jobs = Pool::start(bus.node(), workers, waker)?;
    Driver { crowd, bus, jobs }.run()
}

struct Driver<'a, M: Machine, B: Bus + ?Sized> {
    crowd: Crowd<'a, M>,
    bus: &'a mut B,
    jobs: Pool<M::Job, M::Done>,
}

impl<M, B> Driver<'_, M, B>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
    B: Bus + ?Sized,
{
    fn run(&mut self) -> Result<End, DriverError> {
        self.crowd.begin();
        loop {
            self.act()?;
            if self.crowd.finished() {
                return Ok(End::Finished);
            }
            if self.crowd.stop.is_set() {
                return Ok(End::Stopped);
            }
            if !self.feed_all()? {
                self.bus.await_frames(self.crowd.awaits());
                self.bus.wait(self.crowd.idle_time())?;
            }
        }
    }

    /// Feeds whatever is there; false if nothing was.
    fn feed_all(&mut self) -> Result<bool, DriverError> {
        let crowd = &mut self.crowd;
        let mut some = self.bus.receive(&mut |received| match received {
            Received::Message(topic, envelope) => crowd.message(topic, envelope),
            Received::Frame(frame) => crowd.frame(frame),
            Received::PeerHint(agent) => crowd.hint(agent),
        }) > 0;
        for ((machine, job), answer) in self.jobs.take_answers() {
            match answer {
                Ok(done) => self.crowd.handle(machine, Input::Done(job, done)),
                Err(message) => {
                    let node = self.crowd.node(machine);
                    return Err(DriverError::JobPanicked { node, job: job.0, message });
                }
            }
            some = true;
        }
        Ok(self.crowd.handle_timeouts() || some)
    }

    /// Does what the machines asked for. The frame goes first: who is woken by it finds the rest when it looks.
    fn act(&mut self) -> Result<(), DriverError> {
        if let Some((machine, words)) = self.crowd.newest_frame.take() {
            tolerate(self.crowd.node(machine), self.bus.publish_frame(&words))?;
        }
        while let Some((machine, output)) = self.crowd.pending.pop_front() {
            let node = self.crowd.node(machine);
            match output {
                Output::Publish(topic, message) => {
                    let envelope = Envelope { revision: self.crowd.next_revision(machine), message };
                    tolerate(node, self.publish(topic, &envelope))?;
                }
                // Kept apart, in `newest_frame`.
                Output::PublishFrame(_) => {}
                Output::Spawn(job, work) => self.jobs.spawn((machine, job), work)?,
                Output::Cancel(job) => self.jobs.cancel((machine, job)),
                Output::Log(line) => tracing::info!(%node, "{line}"),
                Output::Finish => self.crowd.finish(machine),
            }
        }
        Ok(())
    }

    fn publish(&mut self, topic: Topic, envelope: &Envelope) -> Result<(), PublishError> {
        if !envelope.message.is_shown_by_a_frame() {
            return self.bus.publish(topic, envelope);
        }
        let bytes = codec::encode(envelope).map_err(|source| PublishError::Encode { topic, source })?;
        self.bus.publish_quietly(topic, &bytes)
    }
}

/// What the transport could not send now is said again by the machine's own timers; what the machine
/// may not say at all is a fault.
fn tolerate(node: Node, result: Result<(), PublishError>) -> Result<(), DriverError> {
    match result {
        Ok(()) => Ok(()),
        Err(error @ (PublishError::Memory { .. } | PublishError::Transport { .. })) => {
            tracing::warn!(%node, "{error}");
            Ok(())
        }
        Err(source) => Err(DriverError::Publish { node, source }),
    }
}
