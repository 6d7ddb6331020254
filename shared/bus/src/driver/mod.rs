//! Runs one machine on one bus: messages, frames, time and the answers of jobs in, outputs out.
//!
//! The machine is handled by one thread, the caller's. Long work goes to worker threads; their answers and
//! [`Stop`] wake the driver through the same bell as messages, so it sleeps whenever there is nothing to do.

mod jobs;
mod stop;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use lamma_protocol::{Envelope, Input, Machine, Node, Output, Revision, Tick};
use thiserror::Error;

use crate::{Bus, PublishError, Received, WaitError};
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
    let waker = bus.waker();
    settings.stop.register(&waker);
    let jobs = Pool::start(node, workers, waker)?;
    let revision = Revision { incarnation: settings.incarnation, number: 0 };
    let Settings { start, stop, record, .. } = settings;
    let feed = Feed { machine, node, start, record, pending: VecDeque::new() };
    Driver { feed, bus, jobs, revision, stop }.run()
}

struct Driver<'a, M: Machine, B: Bus + ?Sized> {
    feed: Feed<'a, M>,
    bus: &'a mut B,
    jobs: Pool<M::Job, M::Done>,
    revision: Revision,
    stop: Stop,
}

/// The machine with its inputs, apart from the bus, which is busy while it hands something over.
struct Feed<'a, M: Machine> {
    machine: &'a mut M,
    node: Node,
    start: Instant,
    record: Option<Recorder<'a, M::Done>>,
    pending: VecDeque<Output<M::Job>>,
}

impl<M: Machine> Feed<'_, M> {
    fn now(&self) -> Tick {
        Tick(u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    /// One mutation, then drain.
    fn handle(&mut self, input: Input<'_, M::Done>) {
        let now = self.now();
        if let Some(record) = &mut self.record {
            record(now, self.node, &input);
        }
        self.machine.handle(now, input);
        self.drain();
    }

    fn drain(&mut self) {
        while let Some(output) = self.machine.poll_output() {
            self.pending.push_back(output);
        }
    }

    /// Feeds a timeout if one is due.
    fn handle_timeout(&mut self) -> bool {
        let due = self.machine.poll_timeout().is_some_and(|t| t <= self.now());
        if due {
            self.handle(Input::Timeout);
        }
        due
    }

    /// How long there is nothing to do by itself; None: for ever.
    fn idle_time(&self) -> Option<Duration> {
        self.machine.poll_timeout().map(|t| Duration::from_micros(t.since_us(self.now())))
    }
}

impl<M, B> Driver<'_, M, B>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
    B: Bus + ?Sized,
{
    fn run(&mut self) -> Result<End, DriverError> {
        self.feed.drain();
        loop {
            if self.act()? {
                return Ok(End::Finished);
            }
            if self.stop.is_set() {
                return Ok(End::Stopped);
            }
            if !self.feed_all()? {
                self.bus.wait(self.feed.idle_time())?;
            }
        }
    }

    /// Feeds whatever is there; false if nothing was.
    fn feed_all(&mut self) -> Result<bool, DriverError> {
        let feed = &mut self.feed;
        let mut some = self.bus.receive(&mut |received| match received {
            Received::Message(topic, envelope) => feed.handle(Input::Message(topic, envelope)),
            Received::Frame(frame) => feed.handle(Input::Frame(frame)),
            Received::PeerHint(agent) => feed.handle(Input::PeerHint(agent)),
        }) > 0;
        for (job, answer) in self.jobs.take_answers() {
            match answer {
                Ok(done) => self.feed.handle(Input::Done(job, done)),
                Err(message) => {
                    return Err(DriverError::JobPanicked { node: self.feed.node, job: job.0, message });
                }
            }
            some = true;
        }
        Ok(self.feed.handle_timeout() || some)
    }

    /// Does what the machine asked for. True if it has finished.
    fn act(&mut self) -> Result<bool, DriverError> {
        let node = self.feed.node;
        let is_frame = |o: &Output<M::Job>| matches!(o, Output::PublishFrame(_));
        let mut frames = self.feed.pending.iter().filter(|o| is_frame(o)).count();
        let mut finished = false;
        while let Some(output) = self.feed.pending.pop_front() {
            match output {
                Output::Publish(topic, message) => {
                    self.revision = self.revision.next();
                    let envelope = Envelope { revision: self.revision, message };
                    let result = self.bus.publish(topic, &envelope);
                    self.tolerate(result)?;
                }
                Output::PublishFrame(words) => {
                    // A frame replaces the one before it: of several, readers need only the last.
                    frames -= 1;
                    if frames == 0 {
                        let result = self.bus.publish_frame(&words);
                        self.tolerate(result)?;
                    }
                }
                Output::Spawn(job, work) => self.jobs.spawn(job, work)?,
                Output::Cancel(job) => self.jobs.cancel(job),
                Output::Log(line) => tracing::info!(%node, "{line}"),
                Output::Finish => finished = true,
            }
        }
        Ok(finished)
    }

    /// What the transport could not send now is said again by the machine's own timers; what the machine
    /// may not say at all is a fault.
    fn tolerate(&self, result: Result<(), PublishError>) -> Result<(), DriverError> {
        let node = self.feed.node;
        match result {
            Ok(()) => Ok(()),
            Err(error @ (PublishError::Memory { .. } | PublishError::Transport { .. })) => {
                tracing::warn!(%node, "{error}");
                Ok(())
            }
            Err(source) => Err(DriverError::Publish { node, source }),
        }
    }
}
