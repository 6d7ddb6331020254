//! How a process joins its run: the endpoint its arguments describe.

use lamma_bus::Bus;
use lamma_bus::faulty::FaultyBus;
use lamma_bus::iceoryx::Endpoint;
use lamma_protocol::Node;

use crate::cli::{BusArg, ChildArgs};
use crate::error::Failure;
use crate::spec::RunSpec;

/// What is said where Zenoh was left out of the build.
#[cfg(not(feature = "zenoh"))]
pub const NOT_BUILT: &str = "this build has no Zenoh: build with the feature `zenoh`, or use iceoryx2 (one host) or inproc (one process)";

/// Fewer threads for a process with one session: Zenoh's own choice is seven.
#[cfg(feature = "zenoh")]
pub const RUNTIME: &str = "(app: (handover: rx), acc: (handover: rx), net: (handover: rx), tx: (handover: rx), rx: (worker_threads: 1))";

/// A run, for who joins it.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Its id.
    pub run: &'a str,
    /// The size of its team.
    pub agents: u16,
}

impl<'a> Place<'a> {
    /// Of a run's spec.
    pub fn of(spec: &'a RunSpec) -> Self {
        Place { run: &spec.id, agents: spec.team_size() }
    }
}

/// The endpoint of `node`.
pub fn open(args: &ChildArgs, place: Place<'_>, node: Node) -> Result<Box<dyn Bus>, Failure> {
    match args.bus {
        BusArg::Inproc => Err(Failure::bad_input("a process of its own needs --bus iceoryx2 or zenoh")),
        BusArg::Iceoryx2 => {
            let scope = args.scope.as_ref().ok_or_else(|| Failure::bad_input("--scope is missing"))?;
            Ok(Box::new(Endpoint::open(scope, node).map_err(Failure::fault)?))
        }
        #[cfg(feature = "zenoh")]
        BusArg::Zenoh => Ok(Box::new(network::open(&args.network, place, node)?)),
        #[cfg(not(feature = "zenoh"))]
        BusArg::Zenoh => {
            let _ = place;
            Err(Failure::bad_input(NOT_BUILT))
        }
    }
}

/// The endpoint of `node`, behind the faults of the spec.
pub fn join(args: &ChildArgs, spec: &RunSpec, node: Node) -> Result<Box<dyn Bus>, Failure> {
    let bus = open(args, Place::of(spec), node)?;
    Ok(match spec.faults()? {
        Some(plan) => Box::new(FaultyBus::new(bus, plan, spec.seed)),
        None => bus,
    })
}

/// Puts the faults of the spec in front of a bus that is used in another thread.
pub fn behind_faults<B: Bus + Send + 'static>(
    bus: B,
    spec: &RunSpec,
) -> Result<Box<dyn Bus + Send>, Failure> {
    Ok(match spec.faults()? {
        Some(plan) => Box::new(FaultyBus::new(bus, plan, spec.seed)),
        None => Box::new(bus),
    })
}

/// Joining over a network.
#[cfg(feature = "zenoh")]
pub mod network {
    use std::time::Duration;

    use lamma_bus::zenoh::{Endpoint, Identity, Join, RunId};
    use lamma_protocol::Node;

    use super::Place;
    use crate::cli::NetworkArgs;
    use crate::error::Failure;

    /// The endpoint of `node`.
    pub fn open(args: &NetworkArgs, place: Place<'_>, node: Node) -> Result<Endpoint, Failure> {
        let connect = args.connect.clone().ok_or_else(|| Failure::bad_input("--connect is missing"))?;
        let run = match &args.run_id {
            Some(id) => id.parse().map_err(Failure::bad_input)?,
            None => RunId::lossy(place.run),
        };
        let name = || args.identity_name.clone().unwrap_or_else(|| node.to_string());
        let identity = args.identity.clone().map(|folder| Identity { folder, name: name() });
        let patience = Duration::from_secs_f64(args.connect_limit);
        let join = Join { run, agents: place.agents, connect, identity, patience };
        Endpoint::open(&join, node).map_err(Failure::fault)
    }
}
