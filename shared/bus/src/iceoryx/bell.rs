//! Waiting for a ring: the bell's listener and a handle for this process's own threads, in one `poll`.
#![expect(unsafe_code, reason = "the transport gives its descriptor as a bare number")]

use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::Arc;
use std::task::{Wake, Waker};
use std::time::{Duration, Instant};

use iceoryx2::port::listener::Listener;
use iceoryx2::prelude::*;
use rustix::event::{EventfdFlags, PollFd, PollFlags, Timespec, eventfd, poll};
use rustix::io::Errno;

use crate::WaitError;

/// The listening end of a node's bell.
pub(super) struct Bell {
    listener: Listener<ipc::Service>,
    own: Arc<Own>,
}

/// What this process's own threads ring.
struct Own(OwnedFd);

impl Wake for Own {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        // The only failure is a counter near 2^64: it rings already.
        let _ = rustix::io::write(&self.0, &1u64.to_ne_bytes());
    }
}

/// How a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Woken {
    /// Somebody rang, or nobody in particular.
    Rung,
    /// It was the time.
    TimedOut,
}

impl Bell {
    pub(super) fn new(listener: Listener<ipc::Service>) -> Result<Bell, WaitError> {
        let own = eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK).map_err(wait_error)?;
        Ok(Bell { listener, own: Arc::new(Own(own)) })
    }

    pub(super) fn waker(&self) -> Waker {
        Waker::from(Arc::clone(&self.own))
    }

    /// Sleeps until a ring or the deadline, and gives the ids of all rings so far to `rung`.
    pub(super) fn wait(
        &self,
        timeout: Option<Duration>,
        mut rung: impl FnMut(usize),
    ) -> Result<Woken, WaitError> {
        let deadline = timeout.and_then(|t| Instant::now().checked_add(t));
        let ready = loop {
            let left = deadline.map(|d| d.saturating_duration_since(Instant::now()));
            // Very long waits are cut into many: the kernel refuses times that do not fit.
            let left = left.map(|l| l.min(Duration::from_secs(3600)));
            let left =
                left.map(|l| Timespec { tv_sec: l.as_secs() as i64, tv_nsec: l.subsec_nanos().into() });
            match self.poll(left.as_ref()) {
                Ok(0) if deadline.is_none_or(|d| Instant::now() < d) => {}
                Ok(ready) => break ready,
                // A signal: let the caller look at its flags.
                Err(Errno::INTR) => return Ok(Woken::Rung),
                Err(error) => return Err(wait_error(error)),
            }
        };
        if ready == 0 {
            return Ok(Woken::TimedOut);
        }
        let _ = rustix::io::read(&self.own.0, &mut [0; 8]);
        self.drain(&mut rung)?;
        Ok(Woken::Rung)
    }

    /// Takes all rings. One look takes one wake-up and all ids, so it looks until there are none; a
    /// wake-up left over costs one wait that ends early.
    pub(super) fn drain(&self, rung: &mut impl FnMut(usize)) -> Result<(), WaitError> {
        loop {
            match self.listener.try_wait(|event| rung(event.id.as_value())) {
                Ok(0) => return Ok(()),
                Ok(_) => {}
                Err(iceoryx2::port::listener::ListenerWaitError::InterruptSignal) => return Ok(()),
                Err(error) => return Err(WaitError { reason: error.to_string() }),
            }
        }
    }

    fn poll(&self, timeout: Option<&Timespec>) -> Result<usize, Errno> {
        // SAFETY: the descriptor belongs to the listener, which is borrowed for as long as this lives and
        // keeps it open; only `poll` is done with it.
        let bell = unsafe { BorrowedFd::borrow_raw(self.listener.file_descriptor().native_handle()) };
        let mut fds = [
            PollFd::from_borrowed_fd(bell, PollFlags::IN),
            PollFd::from_borrowed_fd(self.own.0.as_fd(), PollFlags::IN),
        ];
        poll(&mut fds, timeout)
    }
}

fn wait_error(error: Errno) -> WaitError {
    WaitError { reason: error.to_string() }
}
