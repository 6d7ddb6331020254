//! Where the processes of one host's run meet: shared memory, or a router in this process.

use std::ffi::OsString;

use lamma_bus::Bus;
use lamma_bus::iceoryx::{Run, Scope};
#[cfg(feature = "zenoh")]
use lamma_bus::zenoh::{Endpoint, Join, Router, RunId};
use lamma_protocol::Node;

use crate::cli::BusArg;
use crate::error::Failure;
use crate::process::join::Place;

/// See the module. Dropping it removes what it made.
pub enum Meeting {
    /// Shared memory.
    Memory(Run),
    /// A Zenoh router behind a socket of this user's own.
    #[cfg(feature = "zenoh")]
    Router(Router, Join),
}

impl Meeting {
    /// Makes the place.
    pub fn create(bus: BusArg, place: Place<'_>, per_seat: u16) -> Result<Meeting, Failure> {
        let agents = place.agents;
        match bus {
            #[cfg(feature = "zenoh")]
            BusArg::Zenoh => {
                let router = Router::local().map_err(Failure::fault)?;
                let join = Join {
                    run: RunId::lossy(place.run),
                    agents,
                    connect: router.endpoint(),
                    identity: None,
                    patience: std::time::Duration::from_secs(10),
                };
                Ok(Meeting::Router(router, join))
            }
            #[cfg(not(feature = "zenoh"))]
            BusArg::Zenoh => Err(Failure::bad_input(crate::process::join::NOT_BUILT)),
            BusArg::Iceoryx2 | BusArg::Inproc => {
                Run::create_seated(agents, per_seat).map(Meeting::Memory).map_err(Failure::fault)
            }
        }
    }

    /// Under what the files of the place are found.
    pub fn scope(&self) -> Option<&Scope> {
        match self {
            Meeting::Memory(run) => Some(run.scope()),
            #[cfg(feature = "zenoh")]
            Meeting::Router(router, _) => router.scope(),
        }
    }

    /// The endpoint of `node` in this process.
    pub fn open(&self, node: Node) -> Result<Box<dyn Bus>, Failure> {
        match self {
            Meeting::Memory(run) => Ok(Box::new(run.open(node).map_err(Failure::fault)?)),
            #[cfg(feature = "zenoh")]
            Meeting::Router(_, join) => Ok(Box::new(Endpoint::open(join, node).map_err(Failure::fault)?)),
        }
    }

    /// What another process must be told to join.
    pub fn arguments(&self) -> Vec<OsString> {
        match self {
            Meeting::Memory(run) => vec!["--scope".into(), run.scope().to_string().into()],
            #[cfg(feature = "zenoh")]
            Meeting::Router(_, join) => ["--bus", "zenoh", "--connect", &join.connect, "--run-id"]
                .into_iter()
                .map(OsString::from)
                .chain([join.run.to_string().into()])
                .collect(),
        }
    }

    /// What another process needs in its environment.
    pub fn environment(&self) -> Vec<(OsString, OsString)> {
        match self {
            Meeting::Memory(_) => Vec::new(),
            #[cfg(feature = "zenoh")]
            Meeting::Router(..) => vec![("ZENOH_RUNTIME".into(), crate::process::join::RUNTIME.into())],
        }
    }

    /// Frees what dead processes hold.
    pub fn bury_the_dead(&self) {
        match self {
            Meeting::Memory(run) => run.bury_the_dead(),
            #[cfg(feature = "zenoh")]
            Meeting::Router(..) => {}
        }
    }

    /// Removes the place. All other processes must have ended.
    pub fn end(self) -> Result<(), Failure> {
        match self {
            Meeting::Memory(run) => run.end().map_err(Failure::fault),
            #[cfg(feature = "zenoh")]
            Meeting::Router(router, _) => {
                drop(router);
                Ok(())
            }
        }
    }
}
