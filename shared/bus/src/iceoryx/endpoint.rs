//! The endpoint of one process.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::task::Waker;
use std::time::Duration;

use lamma_protocol::{Awaits, Frame, Node as Member, Topic};

use super::bell::{Bell, Bells, Woken};
use super::layout::{Layout, Line, Party};
use super::reader::Reader;
use super::services::{Handle, check_open_files};
use super::sweep::is_owned;
use super::writer::{Content, Writer};
use super::{OpenError, Scope};
use crate::{Bus, Inbox, PublishError, Received, Stats, WaitError};

/// The endpoint of one node, or of all robots of one seat, over shared memory. It stays in the thread that
/// opened it.
pub struct Endpoint {
    node: Member,
    party: Party,
    layout: Layout,
    writers: BTreeMap<Line, Writer>,
    readers: Vec<Reader>,
    bells: Arc<Bells>,
    bell: Bell,
    inbox: Inbox,
    // Last, so that it goes last: ports tell the node of their end.
    _handle: Handle,
}

impl Endpoint {
    /// Joins the run of `scope` as `node`. In a run whose robots share seats, the endpoint of a robot is the
    /// one of its seat: it publishes and hears for all of them.
    pub fn open(scope: &Scope, node: Member) -> Result<Endpoint, OpenError> {
        let layout = scope.layout();
        let party = layout.party(node).ok_or(OpenError::NoSuchNode { node, agents: layout.agents })?;
        check_open_files(node, layout)?;
        if !is_owned(scope) {
            return Err(OpenError::Ended { tag: scope.tag().to_owned() });
        }
        let handle = Handle::new(scope, party)?;
        let bells = Arc::new(Bells::open(scope).map_err(|e| handle.error("the bells", e))?);
        let bell = Bell::new(Arc::clone(&bells), layout, party);
        let readers = layout.read_by(party).into_iter().map(|l| Reader::open(&handle, layout, l));
        let readers = readers.collect::<Result<_, _>>()?;
        let writers = layout.published_by(party).into_iter();
        let writers = writers.map(|l| Ok((l, Writer::open(&handle, layout, l)?)));
        let writers = writers.collect::<Result<_, OpenError>>()?;
        let inbox = Inbox::default();
        let endpoint =
            Endpoint { node, party, layout, writers, readers, bells, bell, inbox, _handle: handle };
        layout.peers(party).into_iter().for_each(|peer| endpoint.tell_joined(peer));
        Ok(endpoint)
    }

    /// Tells `peer` that this endpoint wants to hear all that `peer` said last.
    fn tell_joined(&self, peer: Party) {
        if let Some(id) = self.layout.joined(peer, self.party) {
            self.bells.ring(peer, id);
        }
    }

    fn send(&mut self, topic: Topic, content: Content<'_>, ring: Ring<'_>) -> Result<(), PublishError> {
        // The callers have checked that the topic is one of this endpoint's own.
        let Some(writer) = self.writers.get_mut(&self.layout.line(topic)) else {
            return Err(PublishError::NoSuchTopic { topic, agents: self.layout.agents });
        };
        self.inbox.stats.published += 1;
        for &(party, event) in writer.send(topic, content)? {
            match ring {
                Ring::Loudly => self.bells.ring(party, event),
                Ring::Quietly => self.bells.ring_quietly(party, event),
                Ring::For(frame) => self.bells.ring_for_frame(party, event, &frame),
            }
        }
        Ok(())
    }

    /// The member of this endpoint that may publish the topic, or the one it is named after.
    fn speaker(&self, topic: Topic) -> Member {
        let publisher = topic.publisher();
        if self.layout.party(publisher) == Some(self.party) { publisher } else { self.node }
    }

    /// Takes the rings so far: news, and peers that have joined.
    fn hear(&mut self) {
        let (readers, party) = (&mut self.readers, self.party);
        let mut joined = Vec::new();
        self.bell.hear(|event| match readers.get_mut(event) {
            Some(reader) => reader.news = true,
            None => joined.extend(peer_of(party, event - readers.len())),
        });
        if !joined.is_empty() {
            self.welcome(&joined);
        }
    }

    /// Peers have joined, perhaps again: let them have what was said, and look for what they say.
    fn welcome(&mut self, joined: &[Party]) {
        for reader in &mut self.readers {
            reader.news |= joined.iter().any(|p| self.layout.publishes(*p, reader.line));
        }
        let mut lines: BTreeMap<Line, Vec<Party>> = BTreeMap::new();
        for party in joined {
            for line in self.layout.read_by(*party).into_iter().filter(|l| self.writers.contains_key(l)) {
                lines.entry(line).or_default().push(*party);
            }
        }
        for (line, parties) in lines {
            let Some(writer) = self.writers.get_mut(&line) else { continue };
            let said = writer.welcome().unwrap_or_else(|reason| {
                tracing::warn!(%line, "{parties:?} have joined but cannot be reached: {reason}");
                false
            });
            if said {
                let news = |party| Some((party, self.layout.news(party, line)?));
                parties.into_iter().filter_map(news).for_each(|(party, id)| self.bells.ring(party, id));
            }
        }
    }
}

/// How the readers of a statement are told of it.
#[derive(Clone, Copy)]
enum Ring<'a> {
    /// Now.
    Loudly,
    /// When they next wake.
    Quietly,
    /// Now, those for whom this frame is worth it.
    For(Frame<'a>),
}

/// Who it is that has joined, by its place among the events of `party`'s bell after its news.
fn peer_of(party: Party, place: usize) -> Option<Party> {
    match (place, party) {
        (0, _) => Some(Party::Supervisor),
        (1, _) => Some(Party::Coordinator),
        (2, _) => Some(Party::Simulator),
        (_, Party::Seat(_)) => None,
        (seat, _) => u16::try_from(seat - 3).ok().map(Party::Seat),
    }
}

impl Bus for Endpoint {
    fn node(&self) -> Member {
        self.node
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.speaker(topic), topic, self.layout.agents, bytes)?;
        self.send(topic, Content::Bytes(bytes), Ring::Loudly)
    }

    fn publish_quietly(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.speaker(topic), topic, self.layout.agents, bytes)?;
        self.send(topic, Content::Bytes(bytes), Ring::Quietly)
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        crate::check_publisher(self.node, Topic::Frame, self.layout.agents)?;
        // What is no frame is the readers' affair, who refuse it.
        let ring = Frame::new(words).map_or(Ring::Loudly, Ring::For);
        self.send(Topic::Frame, Content::Words(words), ring)
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        // For who looks without waiting.
        self.hear();
        let mut lost = Vec::new();
        let readers = self.readers.iter_mut().filter(|r| r.news);
        let count = readers.map(|r| r.receive(&mut self.inbox, sink, &mut lost)).sum();
        lost.sort_unstable();
        lost.dedup();
        lost.into_iter().for_each(|peer| self.tell_joined(peer));
        count
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let woken = self.bell.wait(timeout)?;
        self.hear();
        if woken == Woken::TimedOut {
            // A bell that was not rung (its owner may have died between sending and ringing) costs time,
            // not news.
            self.readers.iter_mut().for_each(|r| r.news = true);
        }
        Ok(woken == Woken::Rung)
    }

    fn await_frames(&mut self, awaits: Awaits) {
        self.bell.await_frames(awaits);
    }

    fn waker(&self) -> Waker {
        self.bell.waker()
    }

    fn stats(&self) -> &Stats {
        &self.inbox.stats
    }
}
