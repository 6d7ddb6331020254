//! One host's bridge at work: a thread for each node that it stands in for, and one that sends.

use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::Waker;
use std::time::{Duration, Instant};

use lamma_protocol::message::Command;
use lamma_protocol::{Envelope, Message, Node, Topic, codec};

use super::{Link, Parcel};
use crate::content::Content;
use crate::driver::Stop;
use crate::{Bus, Received};

/// How often a thread looks at its flag when nothing wakes it.
const PULSE: Duration = Duration::from_secs(1);

/// How long a bridge that has nothing left to carry stays to say again what it has heard: the other end waits for its last
/// acknowledgement, which may have been lost.
const LINGER: Duration = Duration::from_millis(300);

/// The nodes that live on each of the other hosts, by the host's name.
pub type Away = BTreeMap<String, Vec<Node>>;

/// What the threads of a bridge share, and what the network hands parcels to.
pub struct Bridge {
    away: Away,
    state: Mutex<State>,
    changed: Condvar,
    stop: Stop,
}

struct State {
    links: BTreeMap<String, Link>,
    /// What has come for each node that is stood in for, to be said here in its name.
    inboxes: BTreeMap<Node, BTreeMap<Topic, Content>>,
    wakers: BTreeMap<Node, Waker>,
    failed: Option<String>,
    /// The run is over: what has been said is still carried, and then no more.
    ending: bool,
    /// When the last parcel was sent.
    spoke: Instant,
    sent: u64,
}

impl Bridge {
    /// A bridge to the hosts of `away`. A later start has a greater `session`; none is 0.
    pub fn new(away: Away, session: u64, stop: Stop) -> Arc<Bridge> {
        let links = away.keys().map(|host| (host.clone(), Link::new(session))).collect();
        let (inboxes, wakers) = (BTreeMap::new(), BTreeMap::new());
        let state =
            State { links, inboxes, wakers, failed: None, ending: false, spoke: Instant::now(), sent: 0 };
        Arc::new(Bridge { away, state: Mutex::new(state), changed: Condvar::new(), stop })
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // Nobody panics while it is held: values are replaced whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The other hosts.
    pub fn hosts(&self) -> impl Iterator<Item = &str> {
        self.away.keys().map(String::as_str)
    }

    /// Parcels sent so far.
    pub fn sent(&self) -> u64 {
        self.lock().sent
    }

    /// Takes in what has come from `host`. Bytes that are no parcel are dropped, and told.
    pub fn receive(&self, host: &str, bytes: &[u8]) {
        let parcel = match Parcel::from_bytes(bytes) {
            Ok(parcel) => parcel,
            Err(error) => return tracing::warn!("from {host}: {error}"),
        };
        let mut state = self.lock();
        let Some(link) = state.links.get_mut(host) else { return };
        for (topic, content) in link.receive(parcel) {
            let node = topic.publisher();
            // Nobody speaks for who does not live there.
            if !self.away.get(host).is_some_and(|nodes| nodes.contains(&node)) {
                continue;
            }
            state.inboxes.entry(node).or_default().insert(topic, content);
            if let Some(waker) = state.wakers.get(&node) {
                waker.wake_by_ref();
            }
        }
        drop(state);
        self.changed.notify_all();
    }

    /// Works until the supervisor's last word was carried, it is told to stop, or a node cannot be stood in for: says why. `open` gives the endpoint of a
    /// node on this host's own bus, in the thread that calls it; `send` hands bytes for a host to the network.
    pub fn run<B: Bus>(
        self: &Arc<Self>,
        open: impl Fn(Node) -> Result<B, String> + Sync,
        mut send: impl FnMut(&str, Vec<u8>),
    ) -> Result<(), String> {
        std::thread::scope(|scope| {
            for node in self.away.values().flatten() {
                let open = &open;
                let stand_in = move || {
                    if let Err(reason) = self.stand_in(*node, open) {
                        self.lock().failed.get_or_insert(format!("cannot stand in for {node}: {reason}"));
                        self.stop.stop();
                        self.changed.notify_all();
                    }
                };
                let name = format!("as-{node}");
                if let Err(error) = std::thread::Builder::new().name(name).spawn_scoped(scope, stand_in) {
                    self.lock().failed = Some(format!("no thread to stand in for {node}: {error}"));
                    self.stop.stop();
                }
            }
            while !self.stop.is_set() {
                self.send_round(&mut send);
            }
            self.lock().wakers.values().for_each(Waker::wake_by_ref);
        });
        match self.lock().failed.take() {
            Some(reason) => Err(reason),
            None => Ok(()),
        }
    }

    /// Sends what is to be sent now, and sleeps until there may be more.
    fn send_round(&self, send: &mut impl FnMut(&str, Vec<u8>)) {
        let mut state = self.lock();
        let now = Instant::now();
        let parcels: Vec<_> =
            state.links.iter_mut().filter_map(|(host, link)| Some((host.clone(), link.poll(now)?))).collect();
        if parcels.is_empty() {
            let mut due = state.links.values().filter_map(Link::due).min();
            if state.ending && due.is_none() {
                if now >= state.spoke + LINGER {
                    return self.stop.stop();
                }
                due = Some(state.spoke + LINGER);
            }
            let pause = due.map_or(PULSE, |due| due.saturating_duration_since(now)).min(PULSE);
            // What is said between the poll and here holds the lock, so it is not missed.
            drop(self.changed.wait_timeout(state, pause).unwrap_or_else(PoisonError::into_inner));
            return;
        }
        state.sent += parcels.len() as u64;
        state.spoke = now;
        drop(state);
        for (host, parcel) in parcels {
            send(&host, parcel.to_bytes());
        }
    }

    /// Hears on this host's bus what `node` would hear, and says there what `node` has said elsewhere.
    fn stand_in<B: Bus>(&self, node: Node, open: &impl Fn(Node) -> Result<B, String>) -> Result<(), String> {
        let mut bus = open(node)?;
        self.stop.register(&bus.waker());
        self.lock().wakers.insert(node, bus.waker());
        while !self.stop.is_set() {
            let inbox = self.lock().inboxes.remove(&node).unwrap_or_default();
            for (topic, content) in inbox {
                if let Err(error) = content.publish(&mut bus, topic) {
                    tracing::warn!(%topic, "not said for {node}: {error}");
                }
                self.heed(&content);
            }
            let mut news = Vec::new();
            bus.receive(&mut |received| news.extend(self.heard_here(node, received)));
            if news.is_empty() {
                bus.wait(Some(PULSE)).map_err(|e| e.to_string())?;
            } else {
                let last = news.clone();
                self.put(news);
                last.iter().for_each(|(_, content)| self.heed(content));
            }
        }
        Ok(())
    }

    /// Whether the run is over.
    fn heed(&self, content: &Content) {
        if let Content::Bytes(bytes) = content
            && let Ok(Envelope { message: Message::Command(Command { stop: true, .. }), .. }) =
                codec::decode(bytes)
        {
            self.lock().ending = true;
        }
    }

    /// What `node` has heard, if it was said on this host and `node` is the first for whom it is to be carried.
    fn heard_here(&self, node: Node, received: Received<'_>) -> Option<(Topic, Content)> {
        let (topic, content) = match received {
            Received::Message(topic, envelope) => (topic, Content::Bytes(codec::encode(&envelope).ok()?)),
            Received::Frame(frame) => (Topic::Frame, Content::Words(frame.words().to_vec())),
            Received::PeerHint(_) => return None,
        };
        let mut away = self.away.values().flatten();
        let first = away.clone().find(|n| topic.read_by(**n));
        (first == Some(&node) && away.all(|n| *n != topic.publisher())).then_some((topic, content))
    }

    /// Hands what was said here to all links behind which somebody reads it.
    fn put(&self, news: Vec<(Topic, Content)>) {
        let mut state = self.lock();
        for (topic, content) in news {
            for (host, nodes) in &self.away {
                if nodes.iter().any(|n| topic.read_by(*n))
                    && let Some(link) = state.links.get_mut(host)
                {
                    link.put(topic, content.clone());
                }
            }
        }
        drop(state);
        self.changed.notify_all();
    }
}
