//! Endpoints of one process: the same semantics as the other transports, over a mutex and a condition
//! variable. Messages are encoded here too, so that what does not survive the wire fails here first.

use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Wake, Waker};
use std::time::{Duration, Instant};

use lamma_protocol::{Node, Topic};

use crate::{Bus, Inbox, PublishError, Received, Stats, WaitError};

/// The bus of one run: open an endpoint on it for every node.
#[derive(Clone, Debug)]
pub struct Hub {
    agents: u16,
    levels: Arc<Mutex<BTreeMap<Topic, Level>>>,
    bells: Arc<BTreeMap<Node, Arc<Bell>>>,
}

/// The newest on a topic, and which statement it was.
#[derive(Clone, Debug)]
struct Level {
    number: u64,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    Bytes(Arc<[u8]>),
    Words(Arc<[u64]>),
}

/// A flag to wait for.
#[derive(Debug, Default)]
struct Bell {
    rung: Mutex<bool>,
    changed: Condvar,
}

/// A panic elsewhere leaves whole values behind: levels are replaced in one assignment.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Wake for Bell {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        *lock(&self.rung) = true;
        self.changed.notify_all();
    }
}

impl Hub {
    /// The bus of a team of `agents`.
    pub fn new(agents: u16) -> Hub {
        let bells = Topic::nodes(agents).into_iter().map(|n| (n, Arc::default())).collect();
        Hub { agents, levels: Arc::default(), bells: Arc::new(bells) }
    }

    /// The endpoint of `node`. None if the team has no such member.
    pub fn open(&self, node: Node) -> Option<Inproc> {
        let bell = Arc::clone(self.bells.get(&node)?);
        let reads = crate::topics_read_by(node, self.agents).into_iter().map(|t| (t, 0)).collect();
        Some(Inproc { hub: self.clone(), node, bell, reads, inbox: Inbox::default() })
    }

    fn publish(&self, topic: Topic, content: Content) {
        {
            let mut levels = lock(&self.levels);
            let number = levels.get(&topic).map_or(0, |l| l.number) + 1;
            levels.insert(topic, Level { number, content });
        }
        for (_, bell) in self.bells.iter().filter(|(node, _)| topic.read_by(**node)) {
            bell.wake_by_ref();
        }
    }

    /// What is newer than statement `seen` on `topic`.
    fn newer(&self, topic: Topic, seen: u64) -> Option<Level> {
        lock(&self.levels).get(&topic).filter(|l| l.number > seen).cloned()
    }
}

/// An endpoint in this process.
#[derive(Debug)]
pub struct Inproc {
    hub: Hub,
    node: Node,
    bell: Arc<Bell>,
    /// Each topic read, with the number of the statement last handed over.
    reads: Vec<(Topic, u64)>,
    inbox: Inbox,
}

impl Bus for Inproc {
    fn node(&self) -> Node {
        self.node
    }

    fn publish_bytes(&mut self, topic: Topic, bytes: &[u8]) -> Result<(), PublishError> {
        crate::check_bytes(self.node, topic, self.hub.agents, bytes)?;
        self.hub.publish(topic, Content::Bytes(bytes.into()));
        self.inbox.stats.published += 1;
        Ok(())
    }

    fn publish_frame(&mut self, words: &[u64]) -> Result<(), PublishError> {
        crate::check_publisher(self.node, Topic::Frame, self.hub.agents)?;
        self.hub.publish(Topic::Frame, Content::Words(words.into()));
        self.inbox.stats.published += 1;
        Ok(())
    }

    fn receive(&mut self, sink: &mut dyn FnMut(Received<'_>)) -> usize {
        let mut count = 0;
        for (topic, seen) in &mut self.reads {
            let Some(level) = self.hub.newer(*topic, *seen) else { continue };
            *seen = level.number;
            let handed_on = match level.content {
                Content::Bytes(bytes) => self.inbox.message(*topic, &bytes, sink),
                Content::Words(words) => self.inbox.frame(&words, sink),
            };
            count += usize::from(handed_on);
        }
        count
    }

    fn wait(&mut self, timeout: Option<Duration>) -> Result<bool, WaitError> {
        let deadline = timeout.and_then(|t| Instant::now().checked_add(t));
        let mut rung = lock(&self.bell.rung);
        while !*rung {
            rung = match deadline.map(|d| d.saturating_duration_since(Instant::now())) {
                None => self.bell.changed.wait(rung).unwrap_or_else(PoisonError::into_inner),
                Some(Duration::ZERO) => return Ok(false),
                Some(left) => {
                    self.bell.changed.wait_timeout(rung, left).unwrap_or_else(PoisonError::into_inner).0
                }
            };
        }
        *rung = false;
        Ok(true)
    }

    fn waker(&self) -> Waker {
        Waker::from(Arc::clone(&self.bell))
    }

    fn stats(&self) -> &Stats {
        &self.inbox.stats
    }
}
