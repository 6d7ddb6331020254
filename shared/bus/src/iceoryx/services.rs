//! The services of a run: their names and sizes, and the owner that creates and removes them.

use std::sync::{Mutex, PoisonError};

use iceoryx2::prelude::*;
use iceoryx2::service::port_factory::{event, publish_subscribe};
use lamma_protocol::{Node as Member, Topic};

use super::sweep::{Claim, SweepError, remove_half_made};
use super::{Endpoint, OpenError, Scope, sweep};

pub(super) type TopicService<T> = publish_subscribe::PortFactory<ipc::Service, [T], ()>;
pub(super) type BellService = event::PortFactory<ipc::Service>;

/// Ports that the dead may hold on to until [`Run::bury_the_dead`], per service.
const SPARE: usize = 6;

/// How often the dead are buried before they are left to the end of the run.
const TRIES: usize = 3;

/// What one reader holds at once: the newest so far, and one to compare it with.
const BORROWED: usize = 2;

/// A process's handle on the run's services. Everything it creates ends with it.
pub(super) struct Handle {
    node: Node<ipc::Service>,
    scope: Scope,
}

impl Handle {
    pub(super) fn new(scope: &Scope) -> Result<Handle, OpenError> {
        // iceoryx2 warns at every ring of a bell whose owner is stopped; that is our daily business.
        set_log_level(LogLevel::Error);
        let fail = |reason: String| error(scope, "the node".into(), reason);
        let config = scope.config().map_err(fail)?;
        let node = NodeBuilder::new()
            .config(&config)
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<ipc::Service>()
            .map_err(|e| fail(e.to_string()))?;
        Ok(Handle { node, scope: scope.clone() })
    }

    /// An error about `what`.
    pub(super) fn error(&self, what: impl std::fmt::Display, reason: impl std::fmt::Display) -> OpenError {
        error(&self.scope, what.to_string(), reason.to_string())
    }

    fn name(&self, text: &str) -> Result<ServiceName, OpenError> {
        ServiceName::new(text).map_err(|e| self.error(text, e))
    }

    /// The service of a topic, whose elements are bytes or, for the frame, words.
    pub(super) fn topic<T>(&self, topic: Topic, create: bool) -> Result<TopicService<T>, OpenError>
    where
        T: std::fmt::Debug + ZeroCopySend + 'static,
    {
        let agents = self.scope.agents();
        let readers = Topic::nodes(agents).into_iter().filter(|n| topic.read_by(*n)).count();
        let spare = SPARE + readers / 4;
        let builder = self.node.service_builder(&self.name(&topic.to_string())?);
        let builder = builder.publish_subscribe::<[T]>();
        if !create {
            return builder.open().map_err(|e| self.error(topic, e));
        }
        let builder = builder
            .history_size(1)
            .subscriber_max_buffer_size(1)
            .subscriber_max_borrowed_samples(BORROWED)
            .enable_safe_overflow(true)
            .max_publishers(1 + SPARE)
            .max_subscribers(readers + spare)
            .max_nodes(readers + 2 + SPARE + spare);
        builder.create().map_err(|e| self.error(topic, e))
    }

    /// The service that wakes `member`.
    pub(super) fn bell(&self, member: Member, create: bool) -> Result<BellService, OpenError> {
        let what = format!("bell/{member}");
        let builder = self.node.service_builder(&self.name(&what)?).event();
        if !create {
            return builder.open().map_err(|e| self.error(what, e));
        }
        let agents = self.scope.agents();
        let peers = peers_of(member, agents).len();
        let spare = SPARE + peers / 4;
        let builder = builder
            .max_listeners(1 + SPARE)
            .max_notifiers(peers + spare)
            .max_nodes(peers + 2 + SPARE + spare)
            .event_id_max_value(Rings::new(member, agents).count() - 1)
            .disable_deadline();
        builder.create().map_err(|e| self.error(what, e))
    }
}

fn error(scope: &Scope, what: String, reason: String) -> OpenError {
    OpenError::Service { what, tag: scope.tag().to_owned(), reason }
}

/// The nodes that `member` exchanges something with, in the order of [`Topic::nodes`].
pub(super) fn peers_of(member: Member, agents: u16) -> Vec<Member> {
    let topics = Topic::all(agents);
    let exchange = |peer: &Member| {
        topics.iter().any(|t| {
            (t.publisher() == member && t.read_by(*peer)) || (t.publisher() == *peer && t.read_by(member))
        })
    };
    Topic::nodes(agents).into_iter().filter(exchange).collect()
}

/// Refuses to begin where descriptors would run out later.
pub(super) fn check_open_files(node: Member, agents: u16) -> Result<(), OpenError> {
    // A robot was seen to use 50; the others 13 per agent and some (services, ports, connections).
    let needed = match node {
        Member::Robot(_) => 128,
        Member::Supervisor | Member::Coordinator | Member::Simulator => 256 + 16 * u64::from(agents),
    };
    let limit = crate::process::open_files_limit();
    if limit < needed { Err(OpenError::OpenFiles { node, agents, needed, limit }) } else { Ok(()) }
}

/// What the event ids of one node's bell mean: first the topics it reads, then the nodes that may join.
#[derive(Clone, Debug)]
pub(super) struct Rings {
    topics: Vec<Topic>,
    nodes: Vec<Member>,
}

/// Why a bell rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ring {
    /// The topic at this index of those the node reads has something new.
    News(usize),
    /// A node has joined.
    Joined(Member),
}

impl Rings {
    pub(super) fn new(member: Member, agents: u16) -> Rings {
        Rings { topics: crate::topics_read_by(member, agents), nodes: Topic::nodes(agents) }
    }

    pub(super) fn count(&self) -> usize {
        self.topics.len() + self.nodes.len()
    }

    pub(super) fn meaning(&self, id: usize) -> Option<Ring> {
        match id.checked_sub(self.topics.len()) {
            None => Some(Ring::News(id)),
            Some(node) => self.nodes.get(node).copied().map(Ring::Joined),
        }
    }

    /// The id that says that there is news on `topic`.
    pub(super) fn news(&self, topic: Topic) -> Option<EventId> {
        self.topics.iter().position(|t| *t == topic).map(EventId::new)
    }

    /// The id that says that `node` has joined.
    pub(super) fn joined(&self, node: Member) -> Option<EventId> {
        self.nodes.iter().position(|n| *n == node).map(|i| EventId::new(self.topics.len() + i))
    }
}

/// The shared memory of one run, owned by the process that starts the others. Dropping it removes all of
/// it; so it must outlive them.
pub struct Run {
    /// Services live while somebody has them open. None only while this is dropped.
    services: Option<Services>,
    claim: Claim,
}

struct Services {
    handle: Handle,
    _words: TopicService<u64>,
    _bytes: Vec<TopicService<u8>>,
    _bells: Vec<BellService>,
}

impl Run {
    /// Creates everything that a team of `agents` needs, under names that no other run has.
    pub fn create(agents: u16) -> Result<Run, OpenError> {
        check_open_files(Member::Supervisor, agents)?;
        let claim = Claim::new(agents)?;
        match Services::create(&claim.scope) {
            Ok(services) => Ok(Run { services: Some(services), claim }),
            Err(error) => {
                let _ = sweep(&claim.scope);
                Err(error)
            }
        }
    }

    /// What the other processes need to join: pass it on as text.
    pub fn scope(&self) -> &Scope {
        &self.claim.scope
    }

    /// The owner's own endpoint, as any other node's.
    pub fn open(&self, node: Member) -> Result<Endpoint, OpenError> {
        Endpoint::open(self.scope(), node)
    }

    /// Frees what dead processes of the run hold, so that their successors find room and nobody waits for
    /// what they left half made. Call it after every death, before the process is started again.
    pub fn bury_the_dead(&self) {
        let Some(services) = &self.services else { return };
        // The transport cleans only once at a time in a process, and skips the dead otherwise.
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        remove_half_made(self.scope().tag());
        let mut failed = 0;
        for _ in 0..TRIES {
            failed = services.handle.node.try_cleanup_dead_nodes().failed_cleanups;
            if failed == 0 {
                return;
            }
        }
        tracing::warn!("{failed} dead processes still hold shared memory");
    }

    /// Removes everything of the run. All its other processes must have ended.
    pub fn end(self) -> Result<(), SweepError> {
        let scope = self.scope().clone();
        drop(self);
        sweep(&scope)
    }
}

impl Services {
    fn create(scope: &Scope) -> Result<Services, OpenError> {
        let handle = Handle::new(scope)?;
        let topics = Topic::all(scope.agents()).into_iter().filter(|t| *t != Topic::Frame);
        let bytes = topics.map(|t| handle.topic(t, true)).collect::<Result<_, _>>()?;
        let words = handle.topic(Topic::Frame, true)?;
        let nodes = Topic::nodes(scope.agents()).into_iter();
        let bells = nodes.map(|n| handle.bell(n, true)).collect::<Result<_, _>>()?;
        Ok(Services { handle, _words: words, _bytes: bytes, _bells: bells })
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        // The services must end before their files are swept.
        self.services = None;
        if let Err(error) = sweep(&self.claim.scope) {
            tracing::error!("{error}");
        }
    }
}
