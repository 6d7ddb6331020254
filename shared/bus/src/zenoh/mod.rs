//! Processes of one host or of many, over Zenoh.
//!
//! - Every node is a *client* of a [`Router`]: peers do not relay for each other, routers do. Nothing is searched
//!   for on the network; who joins is told where ([`Join`]).
//! - One key per topic ([`keys`]), whose bytes are those of shared memory. Every publication carries a stamp of
//!   its publisher's session, so that a reader keeps the newest and drops repeats.
//! - Nothing waits for a reader: what finds no room on the way is dropped. What makes the newest arrive after all
//!   is that its publisher says it again: at once to a reader that appears (its liveliness token does, which it
//!   declares once its subscriptions stand), and to all at growing intervals until it is replaced. The owner's
//!   [`Bus::wait`](crate::Bus::wait) does that, so an endpoint has no thread of its own.
//! - Messages larger than the limit are refused before they are put together.

mod config;
mod endpoint;
pub mod keys;
mod mailbox;
mod router;
mod wire;

use lamma_protocol::Node;
use thiserror::Error;

pub use config::{Identity, Join, RunId, RunIdError};
pub use endpoint::Endpoint;
pub use router::Router;
pub use wire::Wire;

/// Why a router or an endpoint could not be opened.
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
    /// A setting that Zenoh does not take.
    #[error(
        "Zenoh does not take the setting `{key}` ({reason}): check the endpoint and the identity's files"
    )]
    Setting {
        /// Which.
        key: String,
        /// What Zenoh said.
        reason: String,
    },
    /// The other end cannot be reached, or refuses.
    #[error(
        "{node} cannot join at {at} ({reason}): is the router up, the address right, and the certificate one of \
         its own?"
    )]
    Connect {
        /// Who.
        node: Node,
        /// Where.
        at: String,
        /// What Zenoh said.
        reason: String,
    },
    /// The router's rules do not take the session for this node's.
    #[error(
        "the router refuses this session as {node}: its certificate is that of {name}, or there is no answer; give \
         {node} a certificate of its own"
    )]
    NotItself {
        /// Who it says it is.
        node: Node,
        /// Whose certificate it has.
        name: String,
    },
    /// No router can be had there.
    #[error("no router at {at} ({reason}): is the address taken, or a file of the identity missing?")]
    Listen {
        /// Where.
        at: String,
        /// What Zenoh said.
        reason: String,
    },
    /// Something else of the session cannot be opened.
    #[error("{node} cannot declare `{key}` ({reason}): do the router's access rules allow it?")]
    Declare {
        /// Who.
        node: Node,
        /// What.
        key: String,
        /// What Zenoh said.
        reason: String,
    },
    /// The session of a host's bridge cannot be opened.
    #[error("the bridge of {host} cannot join ({reason}): is the hub up, and the address right?")]
    Bridge {
        /// Whose.
        host: String,
        /// What Zenoh said.
        reason: String,
    },
    /// The folder of a router's socket cannot be had.
    #[error(transparent)]
    Folder(#[from] crate::iceoryx::OpenError),
}
