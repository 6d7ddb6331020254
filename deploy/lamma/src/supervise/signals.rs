//! Ctrl-C and its like: as bytes in a pipe, to be polled, and as a flag.

use std::io::{self, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::SigId;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use signal_hook::low_level::{emulate_default_handler, pipe, signal_name, unregister};

/// What asks a run to end.
const ENDING: [i32; 3] = [SIGINT, SIGTERM, SIGHUP];

/// These signals of this process, for as long as it lives.
pub(super) struct Signals {
    pipe: UnixStream,
    handlers: Handlers,
}

/// Handlers of signals that are taken back when this is dropped.
struct Handlers(Vec<SigId>);

impl Drop for Handlers {
    fn drop(&mut self) {
        for handler in self.0.drain(..) {
            unregister(handler);
        }
    }
}

impl Signals {
    pub(super) fn new() -> io::Result<Signals> {
        let (pipe, write) = UnixStream::pair()?;
        pipe.set_nonblocking(true)?;
        let mut signals = Signals { pipe, handlers: Handlers(Vec::new()) };
        for signal in ENDING {
            signals.handlers.0.push(pipe::register(signal, write.try_clone()?)?);
        }
        Ok(signals)
    }

    /// How many have come since the last look.
    pub(super) fn take(&mut self) -> usize {
        self.pipe.read(&mut [0; 64]).unwrap_or(0)
    }
}

impl AsFd for Signals {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.pipe.as_fd()
    }
}

/// These signals of this process, noted in a flag for as long as this lives: for what is made of many runs, each of
/// which sees only the signals of its own time.
pub struct Interrupts {
    _handlers: Handlers,
}

impl Interrupts {
    /// Sets the flag when one comes.
    pub fn noted_in(flag: &Arc<AtomicBool>) -> Interrupts {
        // It fails only for signals that cannot be handled, which these are not.
        let handler = |signal: &i32| flag::register(*signal, Arc::clone(flag)).ok();
        Interrupts { _handlers: Handlers(ENDING.iter().filter_map(handler).collect()) }
    }
}

/// Ends this process as SIGINT does where nobody handles it.
pub(super) fn give_up() {
    let _ = emulate_default_handler(SIGINT);
}

/// `SIGKILL` for 9.
pub(super) fn name(signal: i32) -> Option<&'static str> {
    signal_name(signal)
}
