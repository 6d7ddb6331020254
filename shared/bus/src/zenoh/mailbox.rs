//! What Zenoh's threads leave for the endpoint's own: the newest of each topic, who has come and who has gone.
//! Its size follows from the team; nothing that arrives makes it grow beyond.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::Wake;
use std::time::{Duration, Instant};

use lamma_protocol::{Awaits, Frame, Node, Topic, codec};

use super::keys::Stamp;

/// See the module.
#[derive(Debug)]
pub(super) struct Mailbox {
    contents: Mutex<Contents>,
    rung: Condvar,
}

#[derive(Debug)]
struct Contents {
    rung: bool,
    /// Which frames ring.
    awaits: Awaits,
    slots: BTreeMap<Topic, Slot>,
    news: BTreeSet<Topic>,
    /// The sessions of each node that are there. More than one while a node starts again.
    present: BTreeMap<Node, BTreeSet<u64>>,
    joined: BTreeSet<Node>,
    left: BTreeSet<Node>,
    /// Who was there and is not: since when.
    absent: BTreeMap<Node, Instant>,
}

/// Sessions of one node that are kept apart; who has more is told so by a late hint, no worse.
const SESSIONS: usize = 16;

#[derive(Debug, Default)]
struct Slot {
    newest: Option<Stamp>,
    content: Content,
}

/// What lies on a topic.
#[derive(Debug)]
pub(super) enum Content {
    /// Bytes, to be decoded by who takes them.
    Bytes(Vec<u8>),
    /// Bytes that were left where they were: why.
    Refused(String),
}

impl Default for Content {
    fn default() -> Content {
        Content::Bytes(Vec::new())
    }
}

/// All that was there at one look.
#[derive(Debug, Default)]
pub(super) struct Mail {
    /// In the order of [`Topic`]'s own.
    pub(super) news: Vec<(Topic, Content)>,
    /// Who has gone.
    pub(super) left: BTreeSet<Node>,
}

impl Mailbox {
    pub(super) fn new(topics: impl IntoIterator<Item = Topic>) -> Mailbox {
        let slots = topics.into_iter().map(|t| (t, Slot::default())).collect();
        let contents = Contents {
            rung: false,
            awaits: Awaits::AnyFrame,
            slots,
            news: BTreeSet::new(),
            present: BTreeMap::new(),
            joined: BTreeSet::new(),
            left: BTreeSet::new(),
            absent: BTreeMap::new(),
        };
        Mailbox { contents: Mutex::new(contents), rung: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, Contents> {
        // Nobody panics while it is held: values are replaced whole.
        self.contents.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a publication in, unless a newer one of its topic was here. `copy` appends its bytes to a buffer.
    pub(super) fn deliver(
        &self,
        topic: Topic,
        stamp: Option<Stamp>,
        len: usize,
        copy: impl FnOnce(&mut Vec<u8>),
    ) {
        let mut contents = self.lock();
        let awaits = contents.awaits;
        let Some(slot) = contents.slots.get_mut(&topic) else { return };
        if stamp.is_some() && stamp <= slot.newest {
            return;
        }
        slot.content = match stamp {
            None => Content::Refused("no stamp of this software beside the bytes".into()),
            Some(_) if len > codec::MAX_MESSAGE_BYTES => {
                Content::Refused(codec::CodecError::TooLarge(len).to_string())
            }
            Some(_) => {
                let mut bytes = match std::mem::take(&mut slot.content) {
                    Content::Bytes(bytes) => bytes,
                    Content::Refused(_) => Vec::new(),
                };
                bytes.clear();
                copy(&mut bytes);
                Content::Bytes(bytes)
            }
        };
        slot.newest = stamp.or(slot.newest);
        let rings = match &slot.content {
            Content::Bytes(bytes) if topic == Topic::Frame => is_awaited(bytes, awaits),
            _ => true,
        };
        contents.news.insert(topic);
        if rings {
            self.ring(contents);
        }
    }

    /// Which frames ring from now on. Whether one has come that is awaited now and was not before, the owner learns by
    /// looking: the next wait ends at once if there is any.
    pub(super) fn await_frames(&self, awaits: Awaits) {
        let mut contents = self.lock();
        contents.awaits = awaits;
        let here = contents.news.contains(&Topic::Frame);
        contents.rung |= here;
    }

    /// A session of a node is there and hears.
    pub(super) fn joined(&self, node: Node, session: u64) {
        let mut contents = self.lock();
        let sessions = contents.present.entry(node).or_default();
        if sessions.len() < SESSIONS {
            sessions.insert(session);
        }
        contents.left.remove(&node);
        contents.absent.remove(&node);
        contents.joined.insert(node);
        self.ring(contents);
    }

    /// A session of a node cannot be heard of any more.
    pub(super) fn left(&self, node: Node, session: u64) {
        let mut contents = self.lock();
        let sessions = contents.present.entry(node).or_default();
        if sessions.remove(&session) && sessions.is_empty() {
            contents.joined.remove(&node);
            contents.left.insert(node);
            contents.absent.insert(node, Instant::now());
            self.ring(contents);
        }
    }

    fn ring(&self, mut contents: MutexGuard<'_, Contents>) {
        contents.rung = true;
        drop(contents);
        self.rung.notify_all();
    }

    /// Takes what has arrived.
    pub(super) fn take(&self) -> Mail {
        let mut contents = self.lock();
        let Contents { slots, news, left, .. } = &mut *contents;
        let news = std::mem::take(news).into_iter();
        let news = news.filter_map(|t| Some((t, std::mem::take(&mut slots.get_mut(&t)?.content)))).collect();
        Mail { news, left: std::mem::take(left) }
    }

    /// Takes who has come.
    pub(super) fn take_joined(&self) -> BTreeSet<Node> {
        std::mem::take(&mut self.lock().joined)
    }

    /// Who is there.
    pub(super) fn present(&self) -> BTreeSet<Node> {
        let contents = self.lock();
        contents.present.iter().filter(|(_, sessions)| !sessions.is_empty()).map(|(node, _)| *node).collect()
    }

    /// Who was there and is not, and for how long.
    pub(super) fn absent(&self) -> BTreeMap<Node, Duration> {
        self.lock().absent.iter().map(|(node, since)| (*node, since.elapsed())).collect()
    }

    /// Sleeps until somebody rings or the time is over; false if it was the time.
    pub(super) fn wait(&self, until: Option<Instant>) -> bool {
        let mut contents = self.lock();
        while !contents.rung {
            contents = match until.map(|u| u.saturating_duration_since(Instant::now())) {
                None => self.rung.wait(contents).unwrap_or_else(PoisonError::into_inner),
                Some(Duration::ZERO) => return false,
                Some(left) => {
                    self.rung.wait_timeout(contents, left).unwrap_or_else(PoisonError::into_inner).0
                }
            };
        }
        contents.rung = false;
        true
    }
}

fn is_awaited(frame: &[u8], awaits: Awaits) -> bool {
    match awaits {
        Awaits::AnyFrame => true,
        Awaits::NoFrame => false,
        // What is no frame is looked at, and refused, by the owner.
        Awaits::Opening(gate) => words(frame).is_none_or(|w| Frame::new(&w).is_ok_and(|f| f.open(gate))),
    }
}

/// The words of a frame, from the bytes that they travel as.
pub(super) fn words(bytes: &[u8]) -> Option<Vec<u64>> {
    let (words, rest) = bytes.as_chunks::<8>();
    rest.is_empty().then(|| words.iter().map(|w| u64::from_le_bytes(*w)).collect())
}

impl Wake for Mailbox {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.ring(self.lock());
    }
}

#[cfg(test)]
mod tests {
    use lamma_protocol::frame::write_frame;
    use lamma_protocol::message::Gate;
    use lamma_protocol::{AgentId, FrameHeader, StepIndex};

    use super::*;

    fn deliver(mailbox: &Mailbox, session: u64, number: u64) {
        let bytes = [number as u8];
        mailbox.deliver(Topic::Grant, Some(Stamp { session, number }), 1, |to| to.extend(bytes));
    }

    fn taken(mailbox: &Mailbox) -> Vec<u8> {
        let news = mailbox.take().news.into_iter();
        news.map(|(_, c)| if let Content::Bytes(b) = c { b[0] } else { 255 }).collect()
    }

    #[test]
    fn the_newest_wins_whatever_the_order_and_however_often() {
        let mailbox = Mailbox::new([Topic::Grant]);
        for (session, number) in [(1, 2), (1, 1), (1, 2)] {
            deliver(&mailbox, session, number);
        }
        assert_eq!(taken(&mailbox), [2]);
        deliver(&mailbox, 1, 2);
        assert_eq!(taken(&mailbox), Vec::<u8>::new(), "a repeat is no news");
        deliver(&mailbox, 2, 1);
        deliver(&mailbox, 1, 3);
        assert_eq!(taken(&mailbox), [1], "a later session is newer");
    }

    #[test]
    fn a_node_has_left_when_its_last_session_has() {
        let (mailbox, node) = (Mailbox::new([]), Node::Simulator);
        mailbox.joined(node, 1);
        mailbox.joined(node, 2);
        mailbox.left(node, 1);
        mailbox.left(node, 1);
        assert!(mailbox.take().left.is_empty(), "it has started again");
        assert_eq!(mailbox.take_joined(), [node].into());
        mailbox.left(node, 2);
        assert_eq!(mailbox.take().left, [node].into());
    }

    #[test]
    fn only_an_awaited_frame_rings_and_none_is_missed() {
        let mailbox = Mailbox::new([Topic::Frame]);
        let frame = |number: u64, done: u32| {
            let progress = vec![StepIndex(done)];
            let words =
                write_frame(&FrameHeader { version: number, progress, ..FrameHeader::default() }, &[]);
            let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
            mailbox.deliver(Topic::Frame, Some(Stamp { session: 1, number }), bytes.len(), |to| {
                to.extend(&bytes)
            });
        };
        let rings = || mailbox.wait(Some(Instant::now()));
        mailbox.await_frames(Awaits::Opening(Gate { agent: AgentId(0), done: StepIndex(2) }));
        frame(1, 1);
        assert!(!rings(), "the gate is closed");
        frame(2, 2);
        assert!(rings(), "the gate is open");
        mailbox.take();
        mailbox.await_frames(Awaits::NoFrame);
        frame(3, 3);
        assert!(!rings(), "none is awaited");
        mailbox.await_frames(Awaits::AnyFrame);
        assert!(rings(), "one has come before it was awaited");
    }

    #[test]
    fn what_is_foreign_or_too_large_is_not_copied() {
        let mailbox = Mailbox::new([Topic::Grant]);
        let stamp = Some(Stamp { session: 1, number: 1 });
        for (stamp, len) in [(None, 1), (stamp, codec::MAX_MESSAGE_BYTES + 1)] {
            mailbox.deliver(Topic::Grant, stamp, len, |_| panic!("not to be copied"));
            assert!(matches!(&mailbox.take().news[..], [(Topic::Grant, Content::Refused(_))]));
        }
        mailbox.deliver(Topic::Command, stamp, 1, |_| panic!("not a topic of this node"));
        assert!(mailbox.take().news.is_empty());
    }
}
