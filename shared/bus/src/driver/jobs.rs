//! The worker threads: a bounded queue of jobs in, answers out, and a flag each to cancel.

use std::any::Any;
use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::Waker;
use std::time::Duration;

use lamma_protocol::{JobId, Node};

use super::DriverError;

/// Does one job after the other on a thread of its own. The flag is set when the answer is no longer
/// wanted: long work looks at it now and then, and returns anything.
pub type Worker<Job, Done> = Box<dyn FnMut(Job, &AtomicBool) -> Done + Send>;

/// A job: which machine of the driver has asked for it, and as what.
pub(super) type Ticket = (usize, JobId);

/// A machine has a few jobs at a time; a queue this long means that it has lost count.
const MAX_WAITING: usize = 1 << 16;

/// How long a cancelled job may hold up the end of the driver.
const PATIENCE: Duration = Duration::from_secs(1);

/// The worker threads of one driver.
pub(super) struct Pool<Job, Done> {
    node: Node,
    shared: Arc<Shared<Job, Done>>,
    /// What was spawned and not cancelled or answered.
    wanted: BTreeMap<Ticket, Arc<AtomicBool>>,
}

struct Shared<Job, Done> {
    state: Mutex<State<Job, Done>>,
    changed: Condvar,
    waker: Waker,
}

struct State<Job, Done> {
    waiting: VecDeque<(Ticket, Job, Arc<AtomicBool>)>,
    answers: Vec<Answer<Done>>,
    workers: usize,
    closed: bool,
}

struct Answer<Done> {
    job: Ticket,
    cancelled: Arc<AtomicBool>,
    /// The answer, or the panic's message.
    done: Result<Done, String>,
}

impl<Job, Done> Shared<Job, Done> {
    fn lock(&self) -> MutexGuard<'_, State<Job, Done>> {
        // Workers run jobs outside the lock, so a panic leaves the state whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<Job: Send + 'static, Done: Send + 'static> Pool<Job, Done> {
    /// Starts a thread for each worker; answers wake `waker`.
    pub(super) fn start(
        node: Node,
        workers: Vec<Worker<Job, Done>>,
        waker: Waker,
    ) -> Result<Self, DriverError> {
        let state = State { waiting: VecDeque::new(), answers: Vec::new(), workers: 0, closed: false };
        let shared = Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new(), waker });
        let pool = Pool { node, shared, wanted: BTreeMap::new() };
        for (i, worker) in workers.into_iter().enumerate() {
            pool.shared.lock().workers += 1;
            let shared = Arc::clone(&pool.shared);
            let name = format!("{node}-job{i}");
            let thread = std::thread::Builder::new().name(name).spawn(move || work(&shared, worker));
            if let Err(error) = thread {
                pool.shared.lock().workers -= 1;
                return Err(DriverError::NoThread { node, reason: error.to_string() });
            }
        }
        Ok(pool)
    }

    /// Queues a job.
    pub(super) fn spawn(&mut self, job: Ticket, work: Job) -> Result<(), DriverError> {
        let cancelled = Arc::new(AtomicBool::new(false));
        let mut state = self.shared.lock();
        if state.waiting.len() >= MAX_WAITING {
            return Err(DriverError::TooManyJobs { node: self.node, waiting: state.waiting.len() });
        }
        state.waiting.push_back((job, work, Arc::clone(&cancelled)));
        drop(state);
        self.wanted.insert(job, cancelled);
        self.shared.changed.notify_one();
        Ok(())
    }

    /// Drops the job if it waits; otherwise sets its flag, and its answer will be dropped.
    pub(super) fn cancel(&mut self, job: Ticket) {
        if let Some(cancelled) = self.wanted.remove(&job) {
            cancelled.store(true, Ordering::Relaxed);
            self.shared.lock().waiting.retain(|(_, _, flag)| !Arc::ptr_eq(flag, &cancelled));
        }
    }

    /// The answers that have come and are wanted.
    pub(super) fn take_answers(&mut self) -> Vec<(Ticket, Result<Done, String>)> {
        let answers = std::mem::take(&mut self.shared.lock().answers);
        let wanted = answers.into_iter().filter(|a| !a.cancelled.load(Ordering::Relaxed));
        wanted
            .map(|a| {
                self.wanted.remove(&a.job);
                (a.job, a.done)
            })
            .collect()
    }
}

impl<Job, Done> Drop for Pool<Job, Done> {
    fn drop(&mut self) {
        for cancelled in self.wanted.values() {
            cancelled.store(true, Ordering::Relaxed);
        }
        let mut state = self.shared.lock();
        state.closed = true;
        state.waiting.clear();
        self.shared.changed.notify_all();
        let wait = self.shared.changed.wait_timeout_while(state, PATIENCE, |s| s.workers > 0);
        let (state, _) = wait.unwrap_or_else(PoisonError::into_inner);
        if state.workers > 0 {
            tracing::warn!(node = %self.node, jobs = state.workers, "left jobs behind that ignore cancelling");
        }
    }
}

/// What a worker thread does until the pool closes.
fn work<Job, Done>(shared: &Shared<Job, Done>, mut worker: Worker<Job, Done>) {
    let mut state = shared.lock();
    while !state.closed {
        let Some((job, work, cancelled)) = state.waiting.pop_front() else {
            state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        drop(state);
        let done = catch_unwind(AssertUnwindSafe(|| worker(work, &cancelled)));
        let done = done.map_err(|payload| panic_message(payload.as_ref()));
        state = shared.lock();
        state.answers.push(Answer { job, cancelled, done });
        shared.waker.wake_by_ref();
    }
    state.workers -= 1;
    shared.changed.notify_all();
}

fn panic_message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}
