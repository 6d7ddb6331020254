//! The thread that spawns the children, hears of their ends, and sees them all out.

use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError};
use std::task::Waker;
use std::time::{Duration, Instant};

use lamma_bus::process::{tie_own_program, tie_to_parent};
use rustix::event::{EventfdFlags, PollFd, PollFlags, Timespec, eventfd, poll};
use rustix::io::Errno;
use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open, pidfd_send_signal};

use super::signals::{self, Signals};
use super::{Ending, Event, Patience, Spec, SuperviseError};

/// How long a killed process may take to end before the keeper leaves it to the kernel: it may hang in a
/// driver or on a dead network disk, where not even SIGKILL reaches it.
const LAST_PATIENCE: Duration = Duration::from_secs(10);

/// What the owner asks for.
pub(super) enum Order {
    /// Start this and reply with its process number.
    Spawn(Box<Spec>, Sender<Result<u32, SuperviseError>>),
    /// Send this to the child of that name.
    Signal(String, Signal, Sender<Result<(), SuperviseError>>),
    /// End all, with this patience.
    End(Patience),
}

/// Tells the keeper that there is an order.
pub(super) struct Bell(OwnedFd);

impl Bell {
    pub(super) fn new() -> io::Result<Bell> {
        Ok(Bell(eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK)?))
    }

    pub(super) fn ring(&self) {
        // The only failure is a counter near 2^64: it rings already.
        let _ = rustix::io::write(&self.0, &1u64.to_ne_bytes());
    }
}

pub(super) struct Keeper {
    orders: Receiver<Order>,
    bell: Arc<Bell>,
    events: Sender<Event>,
    waker: Option<Waker>,
    signals: Signals,
    interrupts: usize,
    children: BTreeMap<String, Member>,
    ladder: Option<Ladder>,
}

/// A living child, or one that waits to be reaped.
struct Member {
    child: Child,
    pid: Pid,
    pidfd: OwnedFd,
}

/// Where the end of the run is.
struct Ladder {
    rung: Rung,
    until: Instant,
    patience: Patience,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Rung {
    Asked,
    Terminated,
    Killed,
}

impl Keeper {
    pub(super) fn new(
        orders: Receiver<Order>,
        bell: Arc<Bell>,
        events: Sender<Event>,
        waker: Option<Waker>,
    ) -> io::Result<Keeper> {
        let (signals, children) = (Signals::new()?, BTreeMap::new());
        Ok(Keeper { orders, bell, events, waker, signals, interrupts: 0, children, ladder: None })
    }

    pub(super) fn run(mut self) {
        loop {
            self.take_orders();
            self.climb();
            if self.over() {
                return;
            }
            let ended = match self.wait() {
                Ok(ended) => ended,
                Err(error) => {
                    tracing::error!("cannot watch the children ({error}): all are killed");
                    return;
                }
            };
            ended.iter().for_each(|name| self.reap(name));
            self.heed_signals();
        }
    }

    /// Whether there is nothing more to wait for.
    fn over(&self) -> bool {
        let Some(ladder) = &self.ladder else { return false };
        let given_up = ladder.rung == Rung::Killed && ladder.until <= Instant::now();
        if given_up && !self.children.is_empty() {
            let names: Vec<_> = self.children.keys().collect();
            tracing::error!("not even SIGKILL ends {names:?}: the kernel will, when it can");
        }
        self.children.is_empty() || given_up
    }

    /// Sleeps until something has happened, and gives the names of children that have ended.
    fn wait(&self) -> io::Result<Vec<String>> {
        let own = [self.bell.0.as_fd(), self.signals.as_fd()];
        let theirs = self.children.values().map(|m| m.pidfd.as_fd());
        let fds = own.into_iter().chain(theirs);
        let mut fds: Vec<_> = fds.map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN)).collect();
        let left = self.ladder.as_ref().map(|l| l.until.saturating_duration_since(Instant::now()));
        let left =
            left.map(|l| Timespec { tv_sec: l.as_secs().cast_signed(), tv_nsec: l.subsec_nanos().into() });
        match poll(&mut fds, left.as_ref()) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        let _ = rustix::io::read(&self.bell.0, &mut [0; 8]);
        let names = self.children.keys().zip(&fds[2..]);
        Ok(names.filter(|(_, fd)| !fd.revents().is_empty()).map(|(name, _)| name.clone()).collect())
    }

    fn tell(&self, event: Event) {
        // An owner that does not listen any more is no reason to leave children alone.
        let _ = self.events.send(event);
        if let Some(waker) = &self.waker {
            waker.wake_by_ref();
        }
    }

    fn take_orders(&mut self) {
        loop {
            match self.orders.try_recv() {
                Ok(Order::Spawn(spec, reply)) => {
                    let _ = reply.send(self.spawn(&spec));
                }
                Ok(Order::Signal(name, signal, reply)) => {
                    let _ = reply.send(self.signal(name, signal));
                }
                Ok(Order::End(patience)) => self.begin_the_end(patience),
                Err(TryRecvError::Empty) => return,
                // The owner is gone without a word: it has panicked.
                Err(TryRecvError::Disconnected) => return self.begin_the_end(Patience::NONE),
            }
        }
    }

    fn spawn(&mut self, spec: &Spec) -> Result<u32, SuperviseError> {
        if self.ladder.is_some() {
            return Err(SuperviseError::Ending);
        }
        if self.children.contains_key(&spec.name) {
            let reason = "it runs already".to_owned();
            return Err(SuperviseError::Spawn {
                name: spec.name.clone(),
                reason,
                cure: "give it another name",
            });
        }
        let member = Member::start(spec).map_err(|error| SuperviseError::Spawn {
            name: spec.name.clone(),
            reason: error.to_string(),
            cure: cure(&error),
        })?;
        let pid = member.child.id();
        self.children.insert(spec.name.clone(), member);
        Ok(pid)
    }

    fn signal(&self, name: String, signal: Signal) -> Result<(), SuperviseError> {
        let sent = self.children.get(&name).map(|member| pidfd_send_signal(&member.pidfd, signal));
        match sent {
            Some(Ok(())) => Ok(()),
            Some(Err(_)) | None => Err(SuperviseError::Unknown { name }),
        }
    }

    fn reap(&mut self, name: &str) {
        let Some(mut member) = self.children.remove(name) else { return };
        // Whatever it has started itself. Until it is reaped its number cannot become another's.
        member.signal_group(Signal::KILL);
        match member.child.wait() {
            Ok(status) => {
                let (name, pid) = (name.to_owned(), member.child.id());
                self.tell(Event::Ended { name, pid, how: Ending::from(status) });
            }
            Err(error) => tracing::error!("cannot learn how {name} has ended: {error}"),
        }
    }

    fn heed_signals(&mut self) {
        for _ in 0..self.signals.take() {
            self.interrupts += 1;
            if self.interrupts >= 3 {
                signals::give_up();
            }
            let again = self.interrupts > 1;
            if again {
                self.children.values().for_each(|m| m.signal_group(Signal::KILL));
            }
            self.tell(Event::Interrupted { again });
        }
    }

    fn begin_the_end(&mut self, patience: Patience) {
        if self.ladder.is_none() {
            let until = Instant::now() + patience.ask;
            self.ladder = Some(Ladder { rung: Rung::Asked, until, patience });
        }
    }

    /// Takes the next rung of the ladder if it is time.
    fn climb(&mut self) {
        let Some(ladder) = &mut self.ladder else { return };
        while ladder.until <= Instant::now() && ladder.rung != Rung::Killed {
            let (rung, signal, time) = match ladder.rung {
                Rung::Asked => (Rung::Terminated, Signal::TERM, ladder.patience.term),
                Rung::Terminated | Rung::Killed => (Rung::Killed, Signal::KILL, LAST_PATIENCE),
            };
            (ladder.rung, ladder.until) = (rung, Instant::now() + time);
            for (name, member) in &mut self.children {
                tracing::debug!("{name} is sent {signal:?}");
                drop(member.child.stdin.take());
                member.signal_group(signal);
            }
        }
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        // Children normally have ended by now. If not, the end of this thread kills them; their groups
        // go with them.
        self.children.values().for_each(|m| m.signal_group(Signal::KILL));
    }
}

impl Member {
    fn start(spec: &Spec) -> io::Result<Member> {
        let program = spec.program.clone().map_or_else(std::env::current_exe, Ok)?;
        let log = OpenOptions::new().create(true).append(true).open(&spec.log)?;
        let mut command = Command::new(program);
        command.args(&spec.args).envs(spec.env.iter().map(|(k, v)| (k, v)));
        command.stdin(Stdio::piped()).stdout(log.try_clone()?).stderr(log);
        let command =
            if spec.ties_itself { tie_own_program(&mut command) } else { tie_to_parent(&mut command) };
        let mut child = command.spawn()?;
        let pid = Pid::from_child(&child);
        match pidfd_open(pid, PidfdFlags::empty()) {
            Ok(pidfd) => Ok(Member { child, pid, pidfd }),
            Err(error) => {
                let _ = child.kill();
                let _ = child.wait();
                Err(error.into())
            }
        }
    }

    fn signal_group(&self, signal: Signal) {
        // An empty group is what is wanted.
        let _ = kill_process_group(self.pid, signal);
    }
}

/// What to do when a child cannot be started.
fn cure(error: &io::Error) -> &'static str {
    match error.raw_os_error().map(Errno::from_raw_os_error) {
        Some(Errno::AGAIN | Errno::NOMEM) => "raise the limit on processes (`ulimit -u`), or use fewer",
        Some(Errno::MFILE | Errno::NFILE) => "raise the limit on open files (`ulimit -n`)",
        Some(Errno::NOENT | Errno::ACCESS | Errno::PERM) => "check that program and log folder can be used",
        _ => "see `lamma doctor`",
    }
}
