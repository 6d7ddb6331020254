//! The services of a run: their names and sizes, and the owner that creates and removes them.

use std::sync::{Mutex, PoisonError};

use iceoryx2::prelude::*;
use iceoryx2::service::port_factory::publish_subscribe;
use lamma_protocol::Node as Member;

use super::bell::Bells;
use super::layout::{Layout, Line, Party};
use super::sweep::{Claim, SweepError, remove_half_made};
use super::writer::Head;
use super::{Endpoint, OpenError, Scope, sweep};

pub(super) type LineService<T> = publish_subscribe::PortFactory<ipc::Service, [T], Head>;

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
    pub(super) fn new(scope: &Scope, party: Party) -> Result<Handle, OpenError> {
        // What concerns our users is said by us.
        set_log_level(LogLevel::Error);
        let fail = |reason: String| error(scope, "the node".into(), reason);
        let config = scope.config(party).map_err(fail)?;
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

    /// A data service, whose elements are bytes or, for the frame, words.
    pub(super) fn line<T>(&self, line: Line, create: bool) -> Result<LineService<T>, OpenError>
    where
        T: std::fmt::Debug + ZeroCopySend + 'static,
    {
        let builder = self.node.service_builder(&self.name(&line.to_string())?);
        let builder = builder.publish_subscribe::<[T]>().user_header::<Head>();
        if !create {
            return builder.open().map_err(|e| self.error(line, e));
        }
        let layout = self.scope.layout();
        let (readers, publishers) = (layout.readers(line).len(), layout.publishers(line));
        let builder = builder
            .history_size(1)
            .subscriber_max_buffer_size(depth(layout, line))
            .subscriber_max_borrowed_samples(BORROWED)
            .enable_safe_overflow(true)
            .max_publishers(publishers + spare(publishers))
            .max_subscribers(readers + spare(readers))
            .max_nodes(readers + publishers + 1 + 2 * spare(readers + publishers));
        builder.create().map_err(|e| self.error(line, e))
    }
}

/// Room for the dead who are not buried yet, beside `living` ports.
fn spare(living: usize) -> usize {
    SPARE + living / 4
}

/// How many statements of one publisher wait for a reader: the newest of its only topic, or two of each.
pub(super) fn depth(layout: Layout, line: Line) -> usize {
    match layout.topics_per_publisher(line) {
        0 | 1 => 1,
        topics => 2 * topics,
    }
}

fn error(scope: &Scope, what: String, reason: String) -> OpenError {
    OpenError::Service { what, tag: scope.tag().to_owned(), reason }
}

/// Refuses to begin where descriptors would run out later.
pub(super) fn check_open_files(node: Member, layout: Layout) -> Result<(), OpenError> {
    // Measured: a seat has 44 open; the others up to 10 for each seat (services, ports, connections).
    let needed = match node {
        Member::Robot(_) => 128,
        Member::Supervisor | Member::Coordinator | Member::Simulator => 256 + 13 * u64::from(layout.seats()),
    };
    let limit = crate::process::open_files_limit();
    let agents = layout.agents;
    if limit < needed { Err(OpenError::OpenFiles { node, agents, needed, limit }) } else { Ok(()) }
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
    _words: LineService<u64>,
    _bytes: Vec<LineService<u8>>,
}

impl Run {
    /// Creates everything that a team of `agents` needs, under names that no other run has.
    pub fn create(agents: u16) -> Result<Run, OpenError> {
        Run::create_seated(agents, 1)
    }

    /// As [`Run::create`], for robots of which `per_seat` share a process and its endpoint; see
    /// [`Scope::seats`].
    pub fn create_seated(agents: u16, per_seat: u16) -> Result<Run, OpenError> {
        let layout = Layout { agents, per_seat: per_seat.max(1) };
        check_open_files(Member::Supervisor, layout)?;
        let claim = Claim::new(layout)?;
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
        let handle = Handle::new(scope, Party::Supervisor)?;
        let layout = scope.layout();
        let bytes = layout.lines().filter(|l| *l != Line::Frame).map(|l| handle.line(l, true));
        let bytes = bytes.collect::<Result<_, _>>()?;
        let words = handle.line(Line::Frame, true)?;
        Bells::create(scope).map_err(|e| handle.error("the bells", e))?;
        Ok(Services { handle, _words: words, _bytes: bytes })
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
