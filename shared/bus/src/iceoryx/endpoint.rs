//! The endpoint of one process.

use std::collections::BTreeMap;
use std::task::Waker;
use std::time::Duration;

use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::*;
use lamma_protocol::{Envelope, Frame, Node as Member, Topic, codec};

use super::bell::{Bell, Woken};
use super::services::{Handle, Ring, Rings, TopicService, check_open_files, peers_of};
use super::sweep::is_owned;
use super::{OpenError, Scope};
use crate::{Bus, Inbox, PublishError, Received, Stats, WaitError};

/// Bytes that a publisher has room for before its memory has to grow.
const ROOM: usize = 4 << 10;

/// Room for the one message that may grow at the very end: memory that grows when its owner leaves is
/// gone before the reader has mapped it. Untouched room costs nothing.
const ROOM_FOR_LAST_WORDS: usize = codec::MAX_MESSAGE_BYTES;

/// Words that the frame has room for before its memory has to grow.
const ROOM_FOR_FRAME: usize = 1 << 10;

/// How often a look at one topic may find something newer before the others have their turn.
const PATIENCE: usize = 16;

type Port<T> = Publisher<ipc::Service, [T], ()>;

/// The endpoint of one node, over shared memory. It stays in the thread that opened it.
pub struct Endpoint {
    node: Member,
    agents: u16,
    writers: BTreeMap<Topic, Writer>,
    readers: Vec<Reader>,
    rings: Rings,
    /// The bells of the peers.
    peers: BTreeMap<Member, Notifier<ipc::Service>>,
    bell: Bell,
    inbox: Inbox,
    // Last, so that it goes last: ports tell the node of their end.
    _handle: Handle,
}

/// A topic that this node publishes.
struct Writer {
    port: WriterPort,
    /// Whose bells to ring, and how.
    readers: Vec<(Member, EventId)>,
    /// Whether anything was said yet.
    said: bool,
}

enum WriterPort {
    Bytes(Port<u8>),
    Words(Port<u64>),
}

/// A topic that this node reads.
struct Reader {
    topic: Topic,
    port: ReaderPort,
    /// Whether there may be news.
    news: bool,
}

enum ReaderPort {
    Bytes(Subscriber<ipc::Service, [u8], ()>),
    Words(Subscriber<ipc::Service, [u64], ()>),
}

impl Endpoint {
    /// Joins the run of `scope` as `node`.
    pub fn open(scope: &Scope, node: Member) -> Result<Endpoint, OpenError> {
        let agents = scope.agents();
        if !Topic::nodes(agents).contains(&node) {
            return Err(OpenError::NoSuchNode { node, agents });
        }
        check_open_files(node, agents)?;
        if !is_owned(scope) {
            return Err(OpenError::Ended { tag: scope.tag().to_owned() });
        }
        let handle = Handle::new(scope)?;
        let listener = handle.bell(node, false)?.listener_builder().create();
        let bell = Bell::new(listener.map_err(|e| handle.error("the bell", e))?);
        let bell = bell.map_err(|e| handle.error("the bell", e))?;
        let readers = crate::topics_read_by(node, agents).into_iter();
        let readers = readers.map(|t| Reader::open(&handle, t)).collect::<Result<_, _>>()?;
        let writers = crate::topics_published_by(node, agents).into_iter();
        let writers = writers.map(|t| Ok((t, Writer::open(&handle, t, agents)?)));
        let writers = writers.collect::<Result<_, OpenError>>()?;
        let peers = peers_of(node, agents).into_iter().map(|peer| {
            let port = handle.bell(peer, false)?.notifier_builder().create();
            Ok((peer, port.map_err(|e| handle.error(format!("bell/{peer}"), e))?))
        });
        let peers: BTreeMap<_, _> = peers.collect::<Result<_, OpenError>>()?;
        for (peer, port) in &peers {
            if let Some(id) = Rings::new(*peer, agents).joined(node) {
                ring(port, id);
            }
        }
        let rings = Rings::new(node, agents);
        let inbox = Inbox::default();
        Ok(Endpoint { node, agents, writers, readers, rings, peers, bell, inbox, _handle: handle })
    }

    fn send(&mut self, topic: Topic, content: Content<'_>) -> Result<(), PublishError> {
        // The callers have checked that the topic is one of this node's own.
        let Some(writer) = self.writers.get_mut(&topic) else {
            return Err(PublishError::NoSuchTopic { topic, agents: self.agents });
        };
        match (&writer.port, content) {
            (WriterPort::Bytes(port), Content::Bytes(bytes)) => send(port, topic, bytes)?,
            (WriterPort::Words(port), Content::Words(words)) => send(port, topic, words)?,
            _ => return Err(PublishError::BytesOnFrame),
        }
        writer.said = true;
        self.inbox.stats.published += 1;
        for (reader, id) in &writer.readers {
            if let Some(port) = self.peers.get(reader) {
                ring(port, *id);
            }
        }
        Ok(())
    }

    fn heed(&mut self, rung: Vec<Ring>) {
        for ring in rung {
            match ring {
                Ring::News(reader) => {
                    if let Some(reader) = self.readers.get_mut(reader) {
                        reader.news = true;
                    }
                }
                Ring::Joined(node) => self.welcome(node),
            }
        }
    }

    /// A node has joined, perhaps again: let it have what was said, and look for what it says.
    fn welcome(&mut self, joined: Member) {
        for reader in self.readers.iter_mut().filter(|r| r.topic.publisher() == joined) {
            reader.news = true;
        }
        for (topic, writer) in self.writers.iter().filter(|(topic, _)| topic.read_by(joined)) {
            if let Err(reason) = writer.connect() {
                tracing::warn!(%topic, "{joined} has joined but cannot be reached: {reason}");
            }
            let ids = writer.readers.iter().filter(|(reader, _)| *reader == joined && writer.said);
            for (reader, id) in ids {
                if let Some(port) = self.peers.get(reader) {
                    ring(port, *id);
                }
            }
        }
    }
}

enum Content<'a> {
    Bytes(&'a [u8]),
    Words(&'a [u64]),
}

/// Rings a bell. That nobody listens, or that it rings already, is no failure.
fn ring(port: &Notifier<ipc::Service>, id: EventId) {
    if let Err(error) = port.notify_with_custom_event_id(id) {
        tracing::warn!("a bell does not ring: {error}");
    }
}

/// Fills a loan of shared memory and sends it.
fn send<T>(port: &Port<T>, topic: Topic, content: &[T]) -> Result<(), PublishError>
where
    T: Copy + std::fmt::Debug + ZeroCopySend + 'static,
{
    let bytes = size_of_val(content);
    let loan = port.loan_slice_uninit(content.len());
    let loan = loan.map_err(|e| PublishError::Memory { topic, bytes, reason: e.to_string() })?;
    let sent = loan.write_from_slice(content).send();
    sent.map(|_| ()).map_err(|e| PublishError::Transport { topic, reason: e.to_string() })
}

impl Writer {
    fn open(handle: &Handle, topic: Topic, agents: u16) -> Result<Writer, OpenError> {
        let port = match topic {
            Topic::Frame => WriterPort::Words(port(handle, topic, ROOM_FOR_FRAME)?),
            Topic::Outcome => WriterPort::Bytes(port(handle, topic, ROOM_FOR_LAST_WORDS)?),
            _ => WriterPort::Bytes(port(handle, topic, ROOM)?),
        };
        let nodes = Topic::nodes(agents).into_iter().filter(|n| topic.read_by(*n));
        let readers = nodes.filter_map(|n| Some((n, Rings::new(n, agents).news(topic)?))).collect();
        Ok(Writer { port, readers, said: false })
    }

    /// Connects to readers that have come since, and hands them what was said last.
    fn connect(&self) -> Result<(), String> {
        let connected = match &self.port {
            WriterPort::Bytes(port) => port.update_connections(),
            WriterPort::Words(port) => port.update_connections(),
        };
        connected.map_err(|e| e.to_string())
    }
}

fn port<T>(handle: &Handle, topic: Topic, room: usize) -> Result<Port<T>, OpenError>
where
    T: std::fmt::Debug + ZeroCopySend + 'static,
{
    let service: TopicService<T> = handle.topic(topic, false)?;
    let builder = service.publisher_builder().initial_max_slice_len(room).max_loaned_samples(1);
    let builder = builder.allocation_strategy(AllocationStrategy::PowerOfTwo);
    // Overflow makes it needless; it says that sending never waits whatever the service is set to.
    let builder = builder.backpressure_strategy(BackpressureStrategy::DiscardData);
    builder.create().map_err(|e| handle.error(topic, e))
}

impl Reader {
    fn open(handle: &Handle, topic: Topic) -> Result<Reader, OpenError> {
        let fail = |e| handle.error(topic, e);
        let port = match topic {
            Topic::Frame => {
                ReaderPort::Words(handle.topic(topic, false)?.subscriber_builder().create().map_err(fail)?)
            }
            _ => ReaderPort::Bytes(handle.topic(topic, false)?.subscriber_builder().create().map_err(fail)?),
        };
        Ok(Reader { topic, port, news: true })
    }

    /// Hands over the newest, if there is one.
    fn receive(&mut self, inbox: &mut Inbox, sink: &mut dyn FnMut(Received<'_>)) -> bool {
        self.news = false;
        match &self.port {
            ReaderPort::Bytes(port) => {
                let newest = newest_message(self.topic, port, inbox);
                newest.is_some_and(|e| inbox.envelope(self.topic, e, sink))
            }
            ReaderPort::Words(port) => receive_frame(port, inbox, sink),
        }
    }
}

/// The newest message on the topic. There is more than one only where a publisher has been followed by
/// another: the revision tells which is newer.
fn newest_message(
    topic: Topic,
    port: &Subscriber<ipc::Service, [u8], ()>,
    inbox: &mut Inbox,
) -> Option<Envelope> {
    let mut newest: Option<Envelope> = None;
    for _ in 0..PATIENCE {
        let decoded = match port.receive() {
            Ok(None) => break,
            Ok(Some(sample)) => codec::decode(sample.payload()).map_err(|e| e.to_string()),
            Err(error) => Err(error.to_string()),
        };
        match decoded {
            Ok(envelope) if newest.as_ref().is_none_or(|n| n.revision <= envelope.revision) => {
                newest = Some(envelope);
            }
            Ok(_) => {}
            Err(reason) => {
                inbox.refuse(topic, &reason);
            }
        }
    }
    newest
}

/// Hands over the newest frame where it lies.
fn receive_frame(
    port: &Subscriber<ipc::Service, [u64], ()>,
    inbox: &mut Inbox,
    sink: &mut dyn FnMut(Received<'_>),
) -> bool {
    let mut newest = None;
    for _ in 0..PATIENCE {
        let sample = match port.receive() {
            Ok(None) => break,
            Ok(Some(sample)) => sample,
            Err(error) => {
                inbox.refuse(Topic::Frame, &error);
                continue;
            }
        };
        match Frame::new(sample.payload()).map(|f| f.version()) {
            Ok(version) if newest.as_ref().is_none_or(|(v, _)| *v <= version) => {
                newest = Some((version, sample));
            }
            Ok(_) => {}
            Err(error) => {
                inbox.refuse(Topic::Frame, &error);
            }
        }
    }
    newest.is_some_and(|(_, sample)| inbox.frame(sample.payload(), sink))
}

impl Bus for Endpoint {
    fn node(&self) -> Member {
        self.node
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.node, topic, self.agents, bytes)?;
        self.send(topic, Content::Bytes(bytes))
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        crate::check_publisher(self.node, Topic::Frame, self.agents)?;
        self.send(Topic::Frame, Content::Words(words))
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        if !self.readers.iter().any(|r| r.news) {
            // For who looks without waiting, and to take wake-ups left over. A bell that cannot be heard is
            // an error of the next wait.
            let mut rung = Vec::new();
            while self.bell.hear(|id| rung.extend(self.rings.meaning(id))).unwrap_or(false) {}
            self.heed(rung);
        }
        let readers = self.readers.iter_mut().filter(|r| r.news);
        readers.map(|r| usize::from(r.receive(&mut self.inbox, sink))).sum()
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let mut rung = Vec::new();
        let woken = self.bell.wait(timeout, |id| rung.extend(self.rings.meaning(id)))?;
        self.heed(rung);
        if woken == Woken::TimedOut {
            // A bell that was not rung (its owner may have died between sending and ringing) costs time,
            // not news.
            self.readers.iter_mut().for_each(|r| r.news = true);
        }
        Ok(woken == Woken::Rung)
    }

    fn waker(&self) -> Waker {
        self.bell.waker()
    }

    fn stats(&self) -> &Stats {
        &self.inbox.stats
    }
}
