//! Waiting for a ring: the bell's listener and a handle for this process's own threads, in one `poll`.
#![expect(unsafe_code, reason = "the transport gives its descriptor as a bare number")]

use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::Arc;
use std::task::{Wake, Waker};
use std::time::{Duration, Instant};

use iceoryx2::port::listener::{Listener, ListenerWaitError};
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

    /// Sleeps until a ring or the deadline, and gives the ids of the rings so far to `rung`.
    pub(super) fn wait(
        &self,
        timeout: Option<Duration>,
        mut rung: impl FnMut(usize),
    ) -> Result<Woken, WaitError> {
        let deadline = timeout.and_then(|t| Instant::now().checked_add(t));
        let [bell, own] = loop {
            let left = deadline.map(|d| d.saturating_duration_since(Instant::now()));
            // Very long waits are cut into many: the kernel refuses times that do not fit.
            let left = left.map(|l| l.min(Duration::from_secs(3600)));
            let left = left
                .map(|l| Timespec { tv_sec: l.as_secs().cast_signed(), tv_nsec: l.subsec_nanos().into() });
            match self.poll(left.as_ref()) {
                Ok([false, false]) if deadline.is_none_or(|d| Instant::now() < d) => {}
                Ok(ready) => break ready,
                // A signal: let the caller look at its flags.
                Err(Errno::INTR) => return Ok(Woken::Rung),
                Err(error) => return Err(wait_error(error)),
            }
        };
        if own {
            let _ = rustix::io::read(&self.own.0, &mut [0; 8]);
        }
        if bell {
            self.hear(&mut rung)?;
        }
        Ok(if bell || own { Woken::Rung } else { Woken::TimedOut })
    }

    /// Takes the rings so far, and one wake-up; false if there was none. Wake-ups left over make a later
    /// wait end early.
    pub(super) fn hear(&self, mut rung: impl FnMut(usize)) -> Result<bool, WaitError> {
        match self.listener.try_wait(|event| rung(event.id.as_value())) {
            Ok(count) => Ok(count > 0),
            Err(ListenerWaitError::InterruptSignal) => Ok(false),
            Err(error) => Err(WaitError { reason: error.to_string() }),
        }
    }

    /// Whether the bell and whether this process's own threads have rung.
    fn poll(&self, timeout: Option<&Timespec>) -> Result<[bool; 2], Errno> {
        // SAFETY: the descriptor belongs to the listener, which is borrowed for as long as this lives and
        // keeps it open; only `poll` is done with it.
        let bell = unsafe { BorrowedFd::borrow_raw(self.listener.file_descriptor().native_handle()) };
        let mut fds = [
            PollFd::from_borrowed_fd(bell, PollFlags::IN),
            PollFd::from_borrowed_fd(self.own.0.as_fd(), PollFlags::IN),
        ];
        poll(&mut fds, timeout)?;
        Ok(fds.map(|fd| !fd.revents().is_empty()))
    }
}

fn wait_error(error: Errno) -> WaitError {
    WaitError { reason: error.to_string() }
}
