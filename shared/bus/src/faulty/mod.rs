//! A bad network for any transport: [`FaultyBus`] loses, repeats, delays, reorders and corrupts what its owner
//! publishes, and cuts it off in both directions, as a [`Plan`] says. Which statement is hit follows from a seed;
//! times are the clock's.
//!
//! Corrupt messages are such as the checksum finds. A world frame has none (it lies in shared memory, or travels
//! over links with checksums of their own), so only its first word is hit, which every reader checks.

mod plan;

use std::collections::BTreeMap;
use std::task::Waker;
use std::time::{Duration, Instant};

use lamma_protocol::codec::MAX_MESSAGE_BYTES;
use lamma_protocol::{Awaits, Node, Topic};

pub use plan::{Partition, Plan, PlanError};

use crate::content::Content;
use crate::{Bus, PublishError, Received, Stats, WaitError};

/// Statements that may be held back at once; the oldest goes first when there are more.
const HELD: usize = 4_096;

/// See the module.
pub struct FaultyBus<B> {
    inner: B,
    plan: Plan,
    random: Random,
    opened: Instant,
    /// What is held back, by when it may go and in what order it came.
    held: BTreeMap<(Instant, u64), (Topic, Content)>,
    /// What waits for the next statement of its topic.
    overtaken: BTreeMap<Topic, Content>,
    count: u64,
    faults: Faults,
}

/// How often each fault was injected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Statements that never left.
    pub lost: u64,
    /// Statements sent twice.
    pub repeated: u64,
    /// Statements that another overtook.
    pub reordered: u64,
    /// Statements with a bit turned over.
    pub corrupted: u64,
    /// Statements held back.
    pub delayed: u64,
    /// Statements, sent or received, that a partition swallowed.
    pub cut: u64,
}

/// SplitMix64: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators" (OOPSLA 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1, without 1.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

impl<B: Bus> FaultyBus<B> {
    /// Puts `plan` in front of `inner`. Every node of a run draws its own numbers from the same seed.
    pub fn new(inner: B, plan: Plan, seed: u64) -> FaultyBus<B> {
        let node = match inner.node() {
            Node::Supervisor => 0,
            Node::Coordinator => 1,
            Node::Simulator => 2,
            Node::Robot(agent) => 3 + u64::from(agent.0),
        };
        let random = Random(Random(seed).next() ^ Random(!node).next());
        let (held, overtaken) = (BTreeMap::new(), BTreeMap::new());
        let (opened, faults) = (Instant::now(), Faults::default());
        FaultyBus { inner, plan, random, opened, held, overtaken, count: 0, faults }
    }

    /// What was done so far.
    pub fn faults(&self) -> Faults {
        self.faults
    }

    fn is_cut(&self) -> bool {
        self.plan.cuts(self.inner.node(), self.opened.elapsed())
    }

    /// Draws; the numbers used do not depend on what came of earlier ones, so that plans can be compared.
    fn hit(&mut self, share: f64) -> bool {
        self.random.share() < share
    }

    fn inject(&mut self, topic: Topic, mut content: Content) -> Result<(), PublishError> {
        let lost = self.hit(self.plan.loss);
        let repeated = self.hit(self.plan.dup);
        let reordered = self.hit(self.plan.reorder);
        let corrupted = self.hit(self.plan.corrupt);
        let (place, delay) = (self.random.next(), self.plan.delay.mul_f64(self.random.share()));
        if lost {
            self.faults.lost += 1;
            return self.flush();
        }
        if corrupted {
            self.faults.corrupted += 1;
            corrupt(&mut content, place);
        }
        if repeated {
            self.faults.repeated += 1;
            self.hold(topic, content.clone(), delay + self.plan.delay);
        }
        // The one that waits goes after this one.
        let overtaken = self.overtaken.remove(&topic);
        if reordered && overtaken.is_none() {
            self.faults.reordered += 1;
            self.overtaken.insert(topic, content);
            return self.flush();
        }
        self.faults.delayed += u64::from(!delay.is_zero());
        self.hold(topic, content, delay);
        if let Some(older) = overtaken {
            self.hold(topic, older, delay);
        }
        self.flush()
    }

    fn hold(&mut self, topic: Topic, content: Content, delay: Duration) {
        self.count += 1;
        self.held.insert((Instant::now() + delay, self.count), (topic, content));
    }

    /// Sends what is due.
    fn flush(&mut self) -> Result<(), PublishError> {
        let mut result = Ok(());
        while let Some(entry) = self.held.first_entry() {
            if entry.key().0 > Instant::now() && self.held.len() <= HELD {
                break;
            }
            let Some((_, (topic, content))) = self.held.pop_first() else { break };
            if self.is_cut() {
                self.faults.cut += 1;
                continue;
            }
            result = result.and(content.publish(&mut self.inner, topic));
        }
        result
    }
}

/// Turns one bit over, where a reader can notice.
fn corrupt(content: &mut Content, place: u64) {
    match content {
        Content::Bytes(bytes) => {
            let bits = 8 * bytes.len().max(1) as u64;
            let at = (place % bits) as usize;
            if let Some(byte) = bytes.get_mut(at / 8) {
                *byte ^= 1 << (at % 8);
            }
        }
        Content::Words(words) => {
            if let Some(first) = words.first_mut() {
                *first ^= 1 << (place % 64);
            }
        }
    }
}

impl<B: Bus> Bus for FaultyBus<B> {
    fn node(&self) -> Node {
        self.inner.node()
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        if topic.publisher() != self.node() || topic == Topic::Frame || bytes.len() > MAX_MESSAGE_BYTES {
            // A refusal, which nothing may hold back.
            return self.inner.publish_bytes(topic, bytes);
        }
        self.inject(topic, Content::Bytes(bytes.to_vec()))
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        if Topic::Frame.publisher() != self.node() {
            return self.inner.publish_frame(words);
        }
        self.inject(Topic::Frame, Content::Words(words.to_vec()))
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        if self.is_cut() {
            self.faults.cut += self.inner.receive(&mut |_| {}) as u64;
            return 0;
        }
        self.inner.receive(sink)
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let end = timeout.and_then(|t| Instant::now().checked_add(t));
        loop {
            // A refusal now was told when the statement was made, or comes too late to be told.
            if let Err(error) = self.flush() {
                tracing::debug!("what was held back is refused: {error}");
            }
            let due = self.held.keys().next().map(|(due, _)| *due);
            let until = [end, due].into_iter().flatten().min();
            let left = until.map(|u| u.saturating_duration_since(Instant::now()));
            if self.inner.wait(left)? {
                return Ok(true);
            }
            if end.is_some_and(|end| end <= Instant::now()) {
                return Ok(false);
            }
        }
    }

    fn await_frames(&mut self, awaits: Awaits) {
        self.inner.await_frames(awaits);
    }

    fn waker(&self) -> Waker {
        self.inner.waker()
    }

    fn stats(&self) -> &Stats {
        self.inner.stats()
    }
}
