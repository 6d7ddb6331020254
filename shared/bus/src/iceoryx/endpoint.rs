//! The endpoint of one process.

use std::collections::BTreeMap;
use std::task::Waker;
use std::time::Duration;

use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use lamma_protocol::{Node as Member, Topic};

use super::bell::{Bell, Woken};
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
    /// The bells of the peers.
    peers: BTreeMap<Party, Notifier<ipc::Service>>,
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
        let listener = handle.bell(party, false)?.listener_builder().create();
        let bell = Bell::new(listener.map_err(|e| handle.error("the bell", e))?);
        let bell = bell.map_err(|e| handle.error("the bell", e))?;
        let readers = layout.read_by(party).into_iter().map(|l| Reader::open(&handle, layout, l));
        let readers = readers.collect::<Result<_, _>>()?;
        let writers = layout.published_by(party).into_iter();
        let writers = writers.map(|l| Ok((l, Writer::open(&handle, layout, l)?)));
        let writers = writers.collect::<Result<_, OpenError>>()?;
        let peers = layout.peers(party).into_iter().map(|peer| {
            let port = handle.bell(peer, false)?.notifier_builder().create();
            Ok((peer, port.map_err(|e| handle.error(format!("bell/{peer}"), e))?))
        });
        let peers = peers.collect::<Result<_, OpenError>>()?;
        let inbox = Inbox::default();
        let endpoint =
            Endpoint { node, party, layout, writers, readers, peers, bell, inbox, _handle: handle };
        endpoint.peers.keys().for_each(|peer| endpoint.tell_joined(*peer));
        Ok(endpoint)
    }

    /// Tells `peer` that this endpoint wants to hear all that `peer` said last.
    fn tell_joined(&self, peer: Party) {
        if let Some(id) = self.layout.joined(peer, self.party) {
            self.ring(peer, EventId::new(id));
        }
    }

    /// Rings a bell. That nobody listens, or that it rings already, is no failure.
    fn ring(&self, peer: Party, id: EventId) {
        let Some(port) = self.peers.get(&peer) else { return };
        if let Err(error) = port.notify_with_custom_event_id(id) {
            tracing::warn!("a bell does not ring: {error}");
        }
    }

    fn send(&mut self, topic: Topic, content: Content<'_>) -> Result<(), PublishError> {
        // The callers have checked that the topic is one of this endpoint's own.
        let Some(writer) = self.writers.get_mut(&self.layout.line(topic)) else {
            return Err(PublishError::NoSuchTopic { topic, agents: self.layout.agents });
        };
        self.inbox.stats.published += 1;
        let rings = writer.send(topic, content)?;
        for (peer, id) in rings {
            if let Some(port) = self.peers.get(peer)
                && let Err(error) = port.notify_with_custom_event_id(*id)
            {
                tracing::warn!("a bell does not ring: {error}");
            }
        }
        Ok(())
    }

    /// The member of this endpoint that may publish the topic, or the one it is named after.
    fn speaker(&self, topic: Topic) -> Member {
        let publisher = topic.publisher();
        if self.layout.party(publisher) == Some(self.party) { publisher } else { self.node }
    }

    fn heed(&mut self, events: Vec<usize>) {
        let joined: Vec<Party> = events.into_iter().filter_map(|event| self.hear(event)).collect();
        if !joined.is_empty() {
            self.welcome(&joined);
        }
    }

    /// Takes an event: news, or a peer that has joined.
    fn hear(&mut self, event: usize) -> Option<Party> {
        match event.checked_sub(self.readers.len()) {
            None => {
                self.readers[event].news = true;
                None
            }
            Some(place) => match (place, self.party) {
                (0, _) => Some(Party::Supervisor),
                (1, _) => Some(Party::Coordinator),
                (2, _) => Some(Party::Simulator),
                (_, Party::Seat(_)) => None,
                (seat, _) => u16::try_from(seat - 3).ok().map(Party::Seat),
            },
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
                let news = |party| Some((party, EventId::new(self.layout.news(party, line)?)));
                parties.into_iter().filter_map(news).for_each(|(party, id)| self.ring(party, id));
            }
        }
    }
}

impl Bus for Endpoint {
    fn node(&self) -> Member {
        self.node
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.speaker(topic), topic, self.layout.agents, bytes)?;
        self.send(topic, Content::Bytes(bytes))
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        crate::check_publisher(self.node, Topic::Frame, self.layout.agents)?;
        self.send(Topic::Frame, Content::Words(words))
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        if !self.readers.iter().any(|r| r.news) {
            // For who looks without waiting, and to take wake-ups left over. A bell that cannot be heard is
            // an error of the next wait.
            let mut rung = Vec::new();
            while self.bell.hear(|event| rung.push(event)).unwrap_or(false) {}
            self.heed(rung);
        }
        let mut lost = Vec::new();
        let readers = self.readers.iter_mut().filter(|r| r.news);
        let count = readers.map(|r| r.receive(&mut self.inbox, sink, &mut lost)).sum();
        lost.sort_unstable();
        lost.dedup();
        lost.into_iter().for_each(|peer| self.tell_joined(peer));
        count
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let mut rung = Vec::new();
        let woken = self.bell.wait(timeout, |event| rung.push(event))?;
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
