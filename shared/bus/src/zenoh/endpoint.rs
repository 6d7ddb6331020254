//! The endpoint of one process.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;
use std::task::Waker;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use lamma_protocol::{Awaits, Node, Topic, codec};
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Session, Wait};

use super::keys::{Keys, Stamp};
use super::mailbox::{Content, Mail, Mailbox, words};
use super::{Join, OpenError, config};
use crate::{Bus, Inbox, PublishError, Received, Stats, WaitError};

/// How soon a statement is said again, and how seldom it may be said in the end.
const FIRST_REPEAT: Duration = Duration::from_millis(100);
const LAST_REPEAT: Duration = Duration::from_secs(2);

/// How long joining may take after the connection stands, and leaving.
const PATIENCE: Duration = Duration::from_secs(10);
const LAST_PATIENCE: Duration = Duration::from_secs(1);

/// The endpoint of one node, as a client of a router.
pub struct Endpoint {
    node: Node,
    agents: u16,
    keys: Keys,
    session: Session,
    /// For large messages, from the first on: it waits for room where the other drops.
    large: Option<Session>,
    join: Join,
    opened: u64,
    at_once: bool,
    said: BTreeMap<Topic, Said>,
    mailbox: Arc<Mailbox>,
    inbox: Inbox,
    left: VecDeque<Node>,
    // Both end when they are dropped.
    _subscribers: Vec<Subscriber<()>>,
    _token: LivelinessToken,
}

/// What was said last on a topic, and when it is to be said again.
struct Said {
    on: Publisher<'static>,
    large: bool,
    payload: ZBytes,
    number: u64,
    again: Instant,
    pause: Duration,
}

impl Endpoint {
    /// Joins a run as `node`. Returns when the router knows what this node reads: what is published through it
    /// from then on arrives here.
    pub fn open(join: &Join, node: Node) -> Result<Endpoint, OpenError> {
        let agents = join.agents;
        if !Topic::nodes(agents).contains(&node) {
            return Err(OpenError::NoSuchNode { node, agents });
        }
        let fail = |reason: String| OpenError::Connect { node, at: join.connect.clone(), reason };
        let session = zenoh::open(config::client(join, config::Room::AtOnce)?)
            .wait()
            .map_err(|e| fail(e.to_string()))?;
        let keys = Keys::new(&join.run);
        let mailbox = Arc::new(Mailbox::new(crate::topics_read_by(node, agents)));
        let mut subscribers = Vec::new();
        for key in keys.read_by(node) {
            let take = deliver(keys.clone(), Arc::clone(&mailbox));
            let declared = session.declare_subscriber(key.clone()).callback(take).wait();
            subscribers.push(declared.map_err(|e| refused(node, key, &e))?);
        }
        for key in keys.live_readers_of(node) {
            let take = meet(node, keys.clone(), Arc::clone(&mailbox));
            let watch = session.liveliness().declare_subscriber(key.clone()).history(true).callback(take);
            subscribers.push(watch.wait().map_err(|e| refused(node, key, &e))?);
        }
        let opened = now();
        let live = keys.live(node, opened);
        let token = session.liveliness().declare_token(live.clone()).wait();
        let token = token.map_err(|e| refused(node, live, &e))?;
        match (sync(&session, &keys, node, PATIENCE), &join.identity) {
            (Heard::Answered, _) | (Heard::Ended, None) => {}
            (_, Some(identity)) => return Err(OpenError::NotItself { node, name: identity.name.clone() }),
            (Heard::Nothing, None) => return Err(fail("the router does not answer".into())),
        }
        Ok(Endpoint {
            node,
            agents,
            keys,
            session,
            large: None,
            join: join.clone(),
            opened,
            at_once: config::at_once(agents),
            said: BTreeMap::new(),
            mailbox,
            inbox: Inbox::default(),
            left: VecDeque::new(),
            _subscribers: subscribers,
            _token: token,
        })
    }

    /// Of the nodes that read what this one publishes: who is there.
    pub fn present(&self) -> BTreeSet<Node> {
        self.mailbox.present()
    }

    /// Of the same: who was there and is not, and for how long. It may have ended, or its link may be down.
    pub fn absent(&self) -> BTreeMap<Node, Duration> {
        self.mailbox.absent()
    }

    fn send(&mut self, topic: Topic, payload: Vec<u8>) -> Result<(), PublishError> {
        let fail = |e: zenoh::Error| PublishError::Transport { topic, reason: e.to_string() };
        let (again, pause) = (Instant::now() + FIRST_REPEAT, FIRST_REPEAT);
        let number = self.inbox.stats.published + 1;
        let large = payload.len() >= config::LARGE;
        let same = |said: &Said| said.large == large;
        let on = match self.said.get(&topic).is_some_and(same).then(|| self.said.remove(&topic)).flatten() {
            Some(said) => said.on,
            None => self.declare(topic, large).map_err(fail)?,
        };
        let said = Said { on, large, payload: payload.into(), number, again, pause };
        let sent = said.send(self.opened);
        self.said.insert(topic, said);
        self.inbox.stats.published = number;
        sent.map_err(fail)
    }

    /// Where a publisher is declared, the router keeps the way for its key. For a key that it meets in messages only,
    /// it works out the way of each message anew, from all the keys it knows.
    fn declare(&mut self, topic: Topic, large: bool) -> zenoh::Result<Publisher<'static>> {
        if large && self.large.is_none() {
            self.large = Some(zenoh::open(config::client(&self.join, config::Room::Awaited)?).wait()?);
        }
        let session = self.large.as_ref().filter(|_| large).unwrap_or(&self.session);
        let on = session.declare_publisher(self.keys.topic(topic));
        on.congestion_control(CongestionControl::Drop).express(self.at_once).wait()
    }

    /// Says again what is due, and to who has come all that it reads. Gives when to do so next.
    fn repeat(&mut self) -> Option<Instant> {
        let joined = self.mailbox.take_joined();
        let now = Instant::now();
        for (topic, said) in &mut self.said {
            let welcome = joined.iter().any(|node| topic.read_by(*node));
            if !welcome && said.again > now {
                continue;
            }
            if let Err(error) = said.send(self.opened) {
                tracing::debug!(%topic, "not said again: {error}");
            }
            said.pause = if welcome { FIRST_REPEAT } else { (said.pause * 2).min(LAST_REPEAT) };
            said.again = now + said.pause;
        }
        self.said.values().map(|said| said.again).min()
    }
}

impl Said {
    fn send(&self, opened: u64) -> zenoh::Result<()> {
        let stamp = Stamp { session: opened, number: self.number };
        self.on.put(self.payload.clone()).attachment(&stamp.to_bytes()[..]).wait()
    }
}

/// Microseconds since 1970.
fn now() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
}

fn refused(node: Node, key: String, reason: &zenoh::Error) -> OpenError {
    OpenError::Declare { node, key, reason: reason.to_string() }
}

/// What a subscription does with what arrives, in a thread of Zenoh's.
fn deliver(keys: Keys, mailbox: Arc<Mailbox>) -> impl Fn(Sample) + Send + Sync + 'static {
    move |sample| {
        let Some(topic) = keys.topic_of(sample.key_expr()) else { return };
        if sample.kind() != SampleKind::Put {
            return;
        }
        let stamp = sample.attachment().and_then(|a| Stamp::from_bytes(&a.to_bytes()));
        let payload = sample.payload();
        mailbox.deliver(topic, stamp, payload.len(), |to| {
            payload.slices().for_each(|slice| to.extend_from_slice(slice));
        });
    }
}

/// What a watch over tokens does with them.
fn meet(own: Node, keys: Keys, mailbox: Arc<Mailbox>) -> impl Fn(Sample) + Send + Sync + 'static {
    move |sample| {
        let token = keys.node_of_token(sample.key_expr()).filter(|(node, _)| *node != own);
        match (token, sample.kind()) {
            (Some((node, session)), SampleKind::Put) => mailbox.joined(node, session),
            (Some((node, session)), SampleKind::Delete) => mailbox.left(node, session),
            (None, _) => {}
        }
    }
}

/// What came of asking the router whether it has seen all that this session sent before.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Heard {
    /// It has, and takes this session for who it says it is.
    Answered,
    /// The question has ended without an answer: the router is one that gives none, or its rules have dropped it.
    Ended,
    /// Nothing came in time.
    Nothing,
}

/// Waits until the router has seen all that this session sent before.
fn sync(session: &Session, keys: &Keys, node: Node, patience: Duration) -> Heard {
    let (tell, told) = std::sync::mpsc::channel::<bool>();
    // The query ends when its callback, which holds the sender, is dropped. When its time is over it is answered by
    // an error.
    let ask = session.get(keys.sync(node)).timeout(patience);
    let asked = ask.congestion_control(CongestionControl::Block).callback(move |reply| {
        let _ = tell.send(reply.result().is_ok());
    });
    match asked.wait().map(|()| told.recv_timeout(patience)) {
        Ok(Ok(true)) => Heard::Answered,
        Ok(Err(std::sync::mpsc::RecvTimeoutError::Disconnected)) => Heard::Ended,
        Ok(Ok(false) | Err(std::sync::mpsc::RecvTimeoutError::Timeout)) | Err(_) => Heard::Nothing,
    }
}

impl Bus for Endpoint {
    fn node(&self) -> Node {
        self.node
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.node, topic, self.agents, bytes)?;
        self.send(topic, bytes.to_vec())
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        crate::check_publisher(self.node, Topic::Frame, self.agents)?;
        let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        if bytes.len() > codec::MAX_MESSAGE_BYTES {
            let source = codec::CodecError::TooLarge(bytes.len());
            return Err(PublishError::Encode { topic: Topic::Frame, source });
        }
        self.send(Topic::Frame, bytes)
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        let Mail { mut news, left } = self.mailbox.take();
        self.left.extend(left);
        // The order of `Topic::all`, which is not that of the enumeration.
        news.sort_by_key(|(topic, _)| rank(*topic));
        let mut count = 0;
        for (topic, content) in news {
            let handed_on = match content {
                Content::Refused(reason) => self.inbox.refuse(topic, &reason),
                Content::Bytes(bytes) if topic == Topic::Frame => match words(&bytes) {
                    Some(words) => self.inbox.frame(&words, sink),
                    None => self.inbox.refuse(topic, &"no whole number of words"),
                },
                Content::Bytes(bytes) => self.inbox.message(topic, &bytes, sink),
            };
            count += usize::from(handed_on);
        }
        while let Some(node) = self.left.pop_front() {
            if let Node::Robot(agent) = node {
                sink(Received::PeerHint(agent));
                count += 1;
            }
        }
        count
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let end = timeout.and_then(|t| Instant::now().checked_add(t));
        loop {
            let again = self.repeat();
            let until = [end, again].into_iter().flatten().min();
            if self.mailbox.wait(until) {
                // Who has come is told what was said before the owner says more.
                self.repeat();
                return Ok(true);
            }
            if end.is_some_and(|end| end <= Instant::now()) {
                return Ok(false);
            }
        }
    }

    fn await_frames(&mut self, awaits: Awaits) {
        self.mailbox.await_frames(awaits);
    }

    fn waker(&self) -> Waker {
        Waker::from(Arc::clone(&self.mailbox))
    }

    fn stats(&self) -> &Stats {
        &self.inbox.stats
    }
}

/// Where a topic stands in [`Topic::all`].
fn rank(topic: Topic) -> (u32, u8) {
    match topic {
        Topic::Command => (0, 0),
        Topic::Outcome => (0, 1),
        Topic::Grant => (0, 2),
        Topic::Vocabulary => (0, 3),
        Topic::Frame => (0, 4),
        Topic::Directive(a) => (1 + u32::from(a.0), 0),
        Topic::Report(a) => (1 + u32::from(a.0), 1),
        Topic::Request(a) => (1 + u32::from(a.0), 2),
        Topic::Ack(a) => (1 + u32::from(a.0), 3),
    }
}

impl Drop for Endpoint {
    fn drop(&mut self) {
        // Last words are heard: what was sent reaches the router before the session ends.
        for session in [Some(&self.session), self.large.as_ref()].into_iter().flatten() {
            let _ = sync(session, &self.keys, self.node, LAST_PATIENCE);
            if let Err(error) = session.close().wait() {
                tracing::debug!("{} leaves without a word: {error}", self.node);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_rank_as_they_are_listed() {
        assert!(Topic::all(300).windows(2).all(|pair| rank(pair[0]) < rank(pair[1])));
    }
}
