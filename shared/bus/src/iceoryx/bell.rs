//! Bells: how the endpoints of a run wake each other.
//!
//! One page of shared memory holds a slot for each party: a bit for each event, whether the party sleeps, and which
//! frames are worth waking it for. Who rings sets the event's bit, and enters the kernel only if somebody sleeps there
//! (a futex: Franke, Russell and Kirkwood, "Fuss, futexes and furwocks", 2002). So a party that is awake is rung for
//! the price of a memory access, however many ring, and a bit that was set once is never lost: it is there when the
//! party looks, whether or not it lived, slept or was stopped when it was set.
//!
//! The order that keeps anybody from sleeping through a ring: who goes to sleep says so (and what it waits for) and
//! then looks at its bits; who rings sets the bit and then looks who sleeps. All four are sequentially consistent, so
//! one of the two sees the other.
#![expect(unsafe_code, reason = "memory that processes share and the kernel's futex have no safe interface")]

use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt;
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::task::{Wake, Waker};
use std::time::{Duration, Instant};

use lamma_protocol::{AgentId, Awaits, Frame, StepIndex, message::Gate};

use super::layout::{Layout, Party};
use super::scope::Scope;
use crate::WaitError;

/// Words before the bits of a slot: its state, and what it waits for.
const HEAD: usize = 2;

/// Slots begin at multiples of so many words: a cache line, so that neighbours do not disturb each other.
const LINE: usize = 8;

/// What the state of a slot says. Whatever is no sleeper needs no waking.
const AWAKE: u32 = 0;
const ASLEEP: u32 = 1;

/// Nobody sleeps longer without a look at the bits: a peer that was killed between setting a bit and waking costs
/// this much, not a hung run.
const LONGEST_SLEEP: Duration = Duration::from_secs(1);

/// The page, mapped into this process.
pub(super) struct Bells {
    base: NonNull<AtomicU64>,
    plan: Plan,
}

/// Where the slots are, in words, and how many words of bits they have.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// Of the supervisor, the coordinator and the simulator.
    hubs: [(usize, usize); 3],
    /// Of the first seat, and bits of each; all seats are alike.
    seats: (usize, usize),
    /// Of the page.
    words: usize,
}

// SAFETY: the mapping holds nothing but atomics, and lives until the value is dropped.
unsafe impl Send for Bells {}
// SAFETY: as above.
unsafe impl Sync for Bells {}

/// One party's part of the page.
struct Slot<'a> {
    state: &'a AtomicU32,
    awaits: &'a AtomicU64,
    rung: &'a [AtomicU64],
}

/// How a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Woken {
    /// Somebody rang, or nobody in particular.
    Rung,
    /// It was the time.
    TimedOut,
}

impl Bells {
    /// Makes the page of a run, before anybody joins it. All zeros: nobody has rung, nobody sleeps.
    pub(super) fn create(scope: &Scope) -> io::Result<()> {
        let file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(scope.bells())?;
        file.set_len(Plan::new(scope.layout()).bytes() as u64)
    }

    /// The page of a run that lives.
    pub(super) fn open(scope: &Scope) -> io::Result<Bells> {
        let file = OpenOptions::new().read(true).write(true).open(scope.bells())?;
        let plan = Plan::new(scope.layout());
        if file.metadata()?.len() < plan.bytes() as u64 {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "the bells of another run"));
        }
        Bells::map(&file, plan)
    }

    fn map(file: &File, plan: Plan) -> io::Result<Bells> {
        // SAFETY: a new mapping where the kernel likes; the file is at least as long, and nobody shortens it.
        let base = unsafe {
            libc::mmap(
                std::ptr::null_mut(),
                plan.bytes(),
                libc::PROT_READ | libc::PROT_WRITE,
                libc::MAP_SHARED,
                file.as_raw_fd(),
                0,
            )
        };
        if base == libc::MAP_FAILED {
            return Err(io::Error::last_os_error());
        }
        let base = NonNull::new(base.cast()).ok_or(io::ErrorKind::OutOfMemory)?;
        Ok(Bells { base, plan })
    }

    fn slot(&self, party: Party) -> Slot<'_> {
        let (start, bits) = self.plan.slot(party);
        assert!(start + HEAD + bits <= self.plan.words, "{party} has a slot");
        // SAFETY: within the mapping, as was just checked, and aligned: a mapping begins at a page. The first word is
        // only ever looked at as 32 bits, the others as 64.
        unsafe {
            let at = self.base.as_ptr().add(start);
            Slot {
                state: &*at.cast::<AtomicU32>(),
                awaits: &*at.add(1),
                rung: std::slice::from_raw_parts(at.add(HEAD), bits),
            }
        }
    }

    /// Sets an event of `party`, and wakes it if it sleeps.
    pub(super) fn ring(&self, party: Party, event: usize) {
        let slot = self.slot(party);
        slot.set(event);
        slot.wake();
    }

    /// Sets an event of `party`, which it sees when it next wakes for another reason.
    pub(super) fn ring_quietly(&self, party: Party, event: usize) {
        self.slot(party).set(event);
    }

    /// Sets an event of `party` that means `frame`, and wakes it if that frame is worth it.
    pub(super) fn ring_for_frame(&self, party: Party, event: usize, frame: &Frame<'_>) {
        let slot = self.slot(party);
        slot.set(event);
        let worth_it = match decode(slot.awaits.load(Ordering::SeqCst)) {
            Awaits::AnyFrame => true,
            Awaits::Opening(gate) => frame.open(gate),
            Awaits::NoFrame => false,
        };
        if worth_it {
            slot.wake();
        }
    }
}

impl Drop for Bells {
    fn drop(&mut self) {
        // SAFETY: what was mapped, which nothing refers to any more.
        unsafe { libc::munmap(self.base.as_ptr().cast(), self.plan.bytes()) };
    }
}

impl Slot<'_> {
    fn set(&self, event: usize) {
        if let Some(word) = self.rung.get(event / 64) {
            word.fetch_or(1 << (event % 64), Ordering::SeqCst);
        }
    }

    fn wake(&self) {
        if self.state.compare_exchange(ASLEEP, AWAKE, Ordering::SeqCst, Ordering::SeqCst).is_ok() {
            futex_wake(self.state);
        }
    }

    fn is_rung(&self) -> bool {
        self.rung.iter().any(|word| word.load(Ordering::SeqCst) != 0)
    }
}

/// A party's own end of the page.
pub(super) struct Bell {
    bells: Arc<Bells>,
    party: Party,
    /// The event by which this process's own threads wake it: the one after all others.
    own: usize,
}

/// What this process's own threads ring.
struct Own {
    bells: Arc<Bells>,
    party: Party,
    event: usize,
}

impl Wake for Own {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.bells.ring(self.party, self.event);
    }
}

impl Bell {
    pub(super) fn new(bells: Arc<Bells>, layout: Layout, party: Party) -> Bell {
        // One that was killed may have slept here.
        let slot = bells.slot(party);
        slot.awaits.store(encode(Awaits::AnyFrame), Ordering::SeqCst);
        slot.state.store(AWAKE, Ordering::SeqCst);
        Bell { bells, party, own: layout.events(party) }
    }

    pub(super) fn waker(&self) -> Waker {
        let (bells, party, event) = (Arc::clone(&self.bells), self.party, self.own);
        Waker::from(Arc::new(Own { bells, party, event }))
    }

    /// Which frames end the waits from now on.
    pub(super) fn await_frames(&self, awaits: Awaits) {
        self.bells.slot(self.party).awaits.store(encode(awaits), Ordering::SeqCst);
    }

    /// Sleeps until a ring or the end of the time.
    pub(super) fn wait(&self, timeout: Option<Duration>) -> Result<Woken, WaitError> {
        let slot = self.bells.slot(self.party);
        let deadline = timeout.and_then(|t| Instant::now().checked_add(t));
        let woken = loop {
            slot.state.store(ASLEEP, Ordering::SeqCst);
            if slot.is_rung() {
                break Woken::Rung;
            }
            let left = deadline.map_or(LONGEST_SLEEP, |d| d.saturating_duration_since(Instant::now()));
            if left.is_zero() {
                break Woken::TimedOut;
            }
            match futex_wait(slot.state, ASLEEP, left.min(LONGEST_SLEEP)).map_err(|e| e.raw_os_error()) {
                // Woken, or rung before the kernel looked, or after the longest sleep: look again.
                Ok(()) | Err(Some(libc::EAGAIN | libc::ETIMEDOUT)) => {}
                // A signal: let the caller look at its flags.
                Err(Some(libc::EINTR)) => break Woken::Rung,
                Err(code) => {
                    let reason = io::Error::from_raw_os_error(code.unwrap_or_default()).to_string();
                    return Err(WaitError { reason });
                }
            }
        };
        slot.state.store(AWAKE, Ordering::SeqCst);
        Ok(woken)
    }

    /// Takes the events that were rung so far; this process's own is none.
    pub(super) fn hear(&self, mut rung: impl FnMut(usize)) {
        for (at, word) in self.bells.slot(self.party).rung.iter().enumerate() {
            // A look costs less than taking what is not there.
            if word.load(Ordering::Relaxed) == 0 {
                continue;
            }
            let mut left = word.swap(0, Ordering::SeqCst);
            while left != 0 {
                let event = at * 64 + left.trailing_zeros() as usize;
                left &= left - 1;
                if event != self.own {
                    rung(event);
                }
            }
        }
    }
}

impl Plan {
    fn new(layout: Layout) -> Plan {
        // Of all events, and of the one for this process's own threads.
        let bits = |party| (layout.events(party) + 1).div_ceil(64);
        let mut words = 0;
        let mut next = |bits: usize, slots: usize| {
            let start = words;
            words += slots * Plan::stride(bits);
            (start, bits)
        };
        let hubs = [Party::Supervisor, Party::Coordinator, Party::Simulator].map(|p| next(bits(p), 1));
        let seats = next(bits(Party::Seat(0)), layout.seats().into());
        Plan { hubs, seats, words }
    }

    /// Words of a slot with so many of bits.
    fn stride(bits: usize) -> usize {
        (HEAD + bits).next_multiple_of(LINE)
    }

    /// Where the slot of a party begins, and how many words of bits it has.
    fn slot(&self, party: Party) -> (usize, usize) {
        match party {
            Party::Supervisor => self.hubs[0],
            Party::Coordinator => self.hubs[1],
            Party::Simulator => self.hubs[2],
            Party::Seat(seat) => {
                let (start, bits) = self.seats;
                (start + usize::from(seat) * Plan::stride(bits), bits)
            }
        }
    }

    fn bytes(&self) -> usize {
        self.words * size_of::<u64>()
    }
}

/// Bits 0 to 31: how many steps; 32 to 47: of whom; 48 and 49: which kind.
fn encode(awaits: Awaits) -> u64 {
    match awaits {
        Awaits::AnyFrame => 0,
        Awaits::Opening(gate) => u64::from(gate.done.0) | u64::from(gate.agent.0) << 32 | 1 << 48,
        Awaits::NoFrame => 2 << 48,
    }
}

fn decode(word: u64) -> Awaits {
    match word >> 48 {
        1 => Awaits::Opening(Gate { agent: AgentId((word >> 32) as u16), done: StepIndex(word as u32) }),
        2 => Awaits::NoFrame,
        _ => Awaits::AnyFrame,
    }
}

fn futex_wait(word: &AtomicU32, expected: u32, timeout: Duration) -> io::Result<()> {
    let timeout =
        libc::timespec { tv_sec: timeout.as_secs().cast_signed(), tv_nsec: timeout.subsec_nanos().into() };
    // SAFETY: both pointers are of references that outlive the call.
    let result = unsafe {
        libc::syscall(libc::SYS_futex, word.as_ptr(), libc::FUTEX_WAIT, expected, &raw const timeout)
    };
    if result == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}

fn futex_wake(word: &AtomicU32) {
    // SAFETY: the pointer is of a reference that outlives the call. That nobody sleeps there is no failure.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), libc::FUTEX_WAKE, 1) };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_do_not_overlap() {
        for (agents, per_seat) in [(0, 1), (1, 1), (64, 1), (1000, 1), (10_000, 2500)] {
            let layout = Layout { agents, per_seat };
            let (plan, mut end) = (Plan::new(layout), 0);
            for party in layout.parties() {
                let (start, bits) = plan.slot(party);
                assert!(start >= end, "{party} of {layout:?}");
                assert!(64 * bits > layout.events(party), "{party} of {layout:?}");
                end = start + HEAD + bits;
            }
            assert!(end <= plan.words, "{layout:?}");
        }
    }

    #[test]
    fn what_is_awaited_survives_the_page() {
        let gate = |agent, done| Awaits::Opening(Gate { agent: AgentId(agent), done: StepIndex(done) });
        for awaits in [Awaits::AnyFrame, Awaits::NoFrame, gate(0, 0), gate(u16::MAX, u32::MAX), gate(7, 9)] {
            assert_eq!(decode(encode(awaits)), awaits);
        }
    }
}
