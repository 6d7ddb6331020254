//! `lamma bridge`: the one process of a host that speaks with other hosts.

use crate::cli::BridgeArgs;
use crate::error::Failure;

/// Carries what must cross between this host's shared memory and the others', until the run is over.
#[cfg(feature = "zenoh")]
pub fn bridge(args: &BridgeArgs) -> Result<u8, Failure> {
    use std::time::{Duration, SystemTime, UNIX_EPOCH};

    use lamma_bus::bridge::{Away, Bridge};
    use lamma_bus::driver::Stop;
    use lamma_bus::iceoryx::Endpoint;
    use lamma_bus::zenoh::{Join, Router, RunId, Wire};
    use lamma_protocol::{AgentId, Node};

    use crate::spec::{HUB, RunSpec};

    lamma_bus::process::exit_when_stdin_closes().map_err(Failure::fault)?;
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    let spec = RunSpec::read(&args.run_dir)?;
    let robots = |agents: &Vec<u16>| agents.iter().map(|a| Node::Robot(AgentId(*a))).collect();
    let away: Away = match args.host == HUB {
        true => spec.away.iter().map(|(host, agents)| (host.clone(), robots(agents))).collect(),
        false => [(HUB.to_owned(), vec![Node::Supervisor, Node::Coordinator, Node::Simulator])].into(),
    };
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let session = u64::try_from(since.as_nanos()).unwrap_or(u64::MAX);
    let bridge = Bridge::new(away, session, Stop::default());
    let run = RunId::lossy(&spec.id);
    // Lives as long as the bridge.
    let _router;
    let wire = match (&args.listen, &args.connect) {
        (Some(listen), _) => {
            let router =
                Router::open(std::slice::from_ref(listen), &[], None, None).map_err(Failure::bad_input)?;
            let wire = Wire::of_router(&router, &run, &args.host, &bridge).map_err(Failure::fault)?;
            _router = router;
            wire
        }
        (None, Some(connect)) => {
            let (agents, patience) = (spec.team_size(), Duration::from_secs(60));
            let join = Join { run, agents, connect: connect.clone(), identity: None, patience };
            Wire::join(&join, &args.host, &bridge).map_err(Failure::fault)?
        }
        (None, None) => return Err(Failure::bad_input("a bridge needs --listen or --connect")),
    };
    let open = |node| Endpoint::open(&args.scope, node).map_err(|e| e.to_string());
    bridge.run(open, |host, bytes| wire.send(host, bytes)).map_err(Failure::fault)?;
    tracing::info!("{} parcels were sent", bridge.sent());
    Ok(crate::exit::SUCCESS)
}

/// As above.
#[cfg(not(feature = "zenoh"))]
pub fn bridge(_args: &BridgeArgs) -> Result<u8, Failure> {
    Err(Failure::bad_input(crate::process::join::NOT_BUILT))
}
