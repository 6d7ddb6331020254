//! Starting, watching and ending the processes of a run.
//!
//! One thread, the *keeper*, spawns every child and outlives all of them: the kernel's parent-death signal
//! fires when the spawning thread ends, not the process. It learns of deaths from process descriptors and
//! of Ctrl-C from a pipe, in one `poll`, and tells its owner over a channel. It ends when all children
//! have ended.
//!
//! The order of a run: [`RunDir::create`], [`lamma_bus::process::raise_open_files_limit`], the bus's
//! memory (`lamma_bus::iceoryx::Run::create`), [`Supervisor::start`], [`Supervisor::spawn`] for each
//! member, ..., a stop over the bus, [`Supervisor::end`], and the bus's memory again (`Run::end`), which
//! removes all of it once nobody is left.

mod keeper;
mod run_dir;
mod signals;
#[cfg(test)]
mod tests;

use std::ffi::OsString;
use std::fmt;
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::task::Waker;
use std::thread::JoinHandle;
use std::time::Duration;

use rustix::process::Signal;
use thiserror::Error;

use keeper::{Bell, Keeper, Order};
pub use run_dir::{RunDir, log_file};
pub use signals::Interrupts;

/// A member of the run to be started.
#[derive(Clone, Debug, Default)]
pub struct Spec {
    /// Unique among the living; names the log file too.
    pub name: String,
    /// The program; by default this one again.
    pub program: Option<PathBuf>,
    /// Its arguments.
    pub args: Vec<OsString>,
    /// Added to its environment.
    pub env: Vec<(OsString, OsString)>,
    /// Where its output goes; a restart appends.
    pub log: PathBuf,
    /// The program calls [`lamma_bus::process::tie_self_to_parent`] when it starts, which makes starting it cheap.
    pub ties_itself: bool,
}

/// What the keeper tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A child has ended and was reaped; whatever it had started in its process group was killed.
    Ended {
        /// Its name.
        name: String,
        /// The process it was.
        pid: u32,
        /// How.
        how: Ending,
    },
    /// Ctrl-C, SIGTERM or SIGHUP. The first: end in order. Again: all children were killed just now.
    /// (The third ends this process as if nobody listened.)
    Interrupted {
        /// Not the first.
        again: bool,
    },
}

/// How a process ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// By itself, with this code.
    Exited(i32),
    /// By this signal.
    Killed(i32),
}

impl From<ExitStatus> for Ending {
    fn from(status: ExitStatus) -> Ending {
        match status.signal() {
            Some(signal) => Ending::Killed(signal),
            None => Ending::Exited(status.code().unwrap_or_default()),
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Ending::Exited(code) => write!(f, "exited with code {code}"),
            Ending::Killed(number) => match signals::name(*number) {
                Some(name) => write!(f, "was killed by {name}"),
                None => write!(f, "was killed by signal {number}"),
            },
        }
    }
}

/// How long each rung of the ladder lasts before the next: asked over the bus, SIGTERM, SIGKILL.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// For children that were asked to leave.
    pub ask: Duration,
    /// For children that were sent SIGTERM and whose standard input was closed.
    pub term: Duration,
}

impl Patience {
    /// Straight to SIGKILL.
    pub const NONE: Patience = Patience { ask: Duration::ZERO, term: Duration::ZERO };
}

impl Default for Patience {
    fn default() -> Self {
        Patience { ask: Duration::from_secs(2), term: Duration::from_secs(1) }
    }
}

/// Why the keeper, or a child, could not be started, or a child not be reached.
#[derive(Debug, Error)]
pub enum SuperviseError {
    /// The operating system gives no thread, pipe or handler.
    #[error("cannot watch over child processes ({0}): raise the limits (`ulimit -n`, `ulimit -u`)")]
    Keeper(std::io::Error),
    /// A child was not started.
    #[error("cannot start {name} ({reason}): {cure}")]
    Spawn {
        /// Which.
        name: String,
        /// What the system said.
        reason: String,
        /// What to do.
        cure: &'static str,
    },
    /// No living child has the name.
    #[error("no process of this run is called {name}: it may have ended already")]
    Unknown {
        /// The name.
        name: String,
    },
    /// The run is ending.
    #[error("the run is ending: nothing is started or signalled any more")]
    Ending,
}

/// The owner's handle on the keeper. Dropping it kills all children and waits for their end.
pub struct Supervisor {
    orders: Sender<Order>,
    bell: Arc<Bell>,
    keeper: Option<JoinHandle<()>>,
}

impl Supervisor {
    /// Starts the keeper and takes over Ctrl-C. Events come over the channel; each wakes `waker`, which may
    /// be the one of the owner's bus endpoint.
    pub fn start(waker: Option<Waker>) -> Result<(Supervisor, Receiver<Event>), SuperviseError> {
        let (orders, ordered) = channel();
        let (events, told) = channel();
        let bell = Arc::new(Bell::new().map_err(SuperviseError::Keeper)?);
        let keeper = Keeper::new(ordered, Arc::clone(&bell), events, waker);
        let keeper = keeper.map_err(SuperviseError::Keeper)?;
        let thread = std::thread::Builder::new().name("keeper".into()).spawn(move || keeper.run());
        let keeper = Some(thread.map_err(SuperviseError::Keeper)?);
        Ok((Supervisor { orders, bell, keeper }, told))
    }

    /// Starts a child and gives its process number.
    pub fn spawn(&self, spec: Spec) -> Result<u32, SuperviseError> {
        self.ask(|reply| Order::Spawn(Box::new(spec), reply))
    }

    /// Sends a signal to one child alone: for fault experiments, and to kill who does not answer.
    #[cfg_attr(not(test), expect(dead_code, reason = "the fault engine, which comes next, sends them"))]
    pub fn signal(&self, name: &str, signal: Signal) -> Result<(), SuperviseError> {
        self.ask(|reply| Order::Signal(name.to_owned(), signal, reply))
    }

    /// Climbs the ladder until all children have ended, and waits for that. Their last events are in the
    /// channel then.
    pub fn end(mut self, patience: Patience) {
        self.finish(patience);
    }

    fn ask<T>(
        &self,
        order: impl FnOnce(Sender<Result<T, SuperviseError>>) -> Order,
    ) -> Result<T, SuperviseError> {
        let (reply, replied) = channel();
        self.orders.send(order(reply)).map_err(|_| SuperviseError::Ending)?;
        self.bell.ring();
        replied.recv().map_err(|_| SuperviseError::Ending)?
    }

    fn finish(&mut self, patience: Patience) {
        // Neither can fail while the keeper lives, and there is nothing to do if it does not.
        let _ = self.orders.send(Order::End(patience));
        self.bell.ring();
        if let Some(keeper) = self.keeper.take()
            && keeper.join().is_err()
        {
            tracing::error!("the keeper has panicked; the kernel has killed its children");
        }
    }
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        if self.keeper.is_some() {
            self.finish(Patience::NONE);
        }
    }
}
