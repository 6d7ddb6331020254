//! Processes of one host over shared memory (iceoryx2).
//!
//! - Few services carry many topics ([`layout`]): one towards each robot, and one from every 64 robots to
//!   the coordinator and to the simulator. Each publisher has its own buffer at each reader; with history
//!   and safe overflow the newest statement replaces the one before it, nothing ever waits for a reader,
//!   and a late joiner gets the newest.
//! - One *bell* per endpoint ([`bell`]): a few words of shared memory and a futex. Who publishes rings its readers;
//!   the event says which service, so a node with thousands of topics looks only at what has changed. A node that
//!   joins rings the peers it exchanges something with, and publishers then hand it what they last said.
//! - An endpoint may be the *seat* of many robots in one process. Its topics share buffers that can
//!   overflow; the reader notices the gap in the numbers and rings like one that has just joined.
//! - All limits follow from the size of the team. All names carry the run's tag ([`Scope`]), so runs never
//!   meet, and what a crash leaves is found by its tag ([`sweep_stale`]).
//! - Nobody but the [`Run`] cleans up after the dead: with every process doing so, starting a thousand of
//!   them takes minutes.

mod bell;
mod endpoint;
mod layout;
mod reader;
mod scope;
mod services;
mod sweep;
mod writer;

use std::path::PathBuf;

use lamma_protocol::Node;
use thiserror::Error;

pub use endpoint::Endpoint;
pub use scope::{Scope, ScopeParseError};
pub use services::Run;
#[cfg(feature = "zenoh")]
pub(crate) use sweep::Claim;
pub use sweep::{SweepError, left_over, sweep, sweep_stale};

/// Why the shared memory of a run, or an endpoint on it, could not be opened.
#[derive(Debug, Error)]
pub enum OpenError {
    /// The team has no such member.
    #[error("no {node} in a team of {agents}: check the agent's index against the roster")]
    NoSuchNode {
        /// Who.
        node: Node,
        /// The size of the team.
        agents: u16,
    },
    /// Past the limit the transport would reach only some readers, and say nothing.
    #[error(
        "{node} needs {needed} open files in a team of {agents}, the limit is {limit}: raise it (`ulimit -n`)"
    )]
    OpenFiles {
        /// Who.
        node: Node,
        /// The size of the team.
        agents: u16,
        /// How many it may have open at once.
        needed: u64,
        /// The limit.
        limit: u64,
    },
    /// No folder can hold the run's files.
    #[error(
        "cannot create a folder for the run's shared memory in any of {tried:?} ({reason}): make one writable"
    )]
    NoRoot {
        /// Where it was tried.
        tried: Vec<PathBuf>,
        /// What the system said last.
        reason: String,
    },
    /// The run is over, or its owner has died.
    #[error("run {tag} has ended: start a new one; `lamma clean` removes what an owner that died has left")]
    Ended {
        /// Which run.
        tag: String,
    },
    /// Something of the run cannot be opened.
    #[error(
        "cannot open {what} of run {tag} ({reason}): has the run ended? A new run starts with new memory"
    )]
    Service {
        /// The service or port.
        what: String,
        /// Which run.
        tag: String,
        /// What the transport said.
        reason: String,
    },
}
