//! `lamma host NAME`: one host's part of a prepared run whose team is spread over several.

use crate::cli::HostArgs;
use crate::error::Failure;

/// Starts this host's processes and sees them to their end. The hub's prints the outcome.
#[cfg(feature = "zenoh")]
pub fn host(args: &HostArgs) -> Result<u8, Failure> {
    use crate::spec::{HUB, RunSpec};

    let spec = RunSpec::read(&args.run_dir)?;
    let known = spec.away.keys().map(String::as_str).chain([HUB]);
    if !known.clone().any(|name| name == args.name) {
        let known: Vec<&str> = known.collect();
        let text = format!("this run has no host {:?}: it has {}", args.name, known.join(", "));
        return Err(Failure::bad_input(text));
    }
    match args.name == HUB {
        true => spread::hub(args, &spec),
        false => spread::other(args, &spec),
    }
}

/// As above.
#[cfg(not(feature = "zenoh"))]
pub fn host(_args: &HostArgs) -> Result<u8, Failure> {
    Err(Failure::bad_input(crate::process::join::NOT_BUILT))
}

#[cfg(feature = "zenoh")]
mod spread {
    use std::sync::Arc;

    use lamma_bus::iceoryx::Run;

    use super::{Failure, HostArgs};
    use crate::cli::BusArg;
    use crate::exit;
    use crate::host::Host;
    use crate::launch::{agents, see_through};
    use crate::process_host::{ProcessHost, member};
    use crate::spec::RunSpec;
    use crate::supervise::{Ending, Event, Patience, Supervisor};

    /// Starts of a bridge that fails again and again.
    const TRIES: u32 = 5;

    /// The coordinator's, the simulator's and the supervisor's host.
    pub fn hub(args: &HostArgs, spec: &Arc<RunSpec>) -> Result<u8, Failure> {
        let listen =
            args.listen.as_ref().ok_or_else(|| Failure::bad_input("the hub needs --listen ENDPOINT"))?;
        let bridge = vec!["--listen".into(), listen.into()];
        let start = || -> Result<Box<dyn Host>, Failure> {
            Ok(Box::new(ProcessHost::start_hub(spec, &args.run_dir, bridge)?))
        };
        see_through(start, spec, BusArg::Iceoryx2, &args.run_dir, args.format)
    }

    /// A host of robots. Ends when they have.
    pub fn other(args: &HostArgs, spec: &Arc<RunSpec>) -> Result<u8, Failure> {
        let connect =
            args.connect.as_ref().ok_or_else(|| Failure::bad_input("--connect ENDPOINT is missing"))?;
        std::fs::create_dir_all(args.run_dir.join("logs"))
            .map_err(|e| Failure::io("create", &args.run_dir.join("logs"), &e))?;
        lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
        let run = Run::create(spec.team_size()).map_err(Failure::fault)?;
        let (supervisor, events) = Supervisor::start(None).map_err(Failure::fault)?;
        let join = vec!["--scope".into(), run.scope().to_string().into()];
        let place =
            [join.clone(), vec!["--host".into(), (&args.name).into(), "--connect".into(), connect.into()]];
        let bridge = member("bridge", "bridge", &args.run_dir, place.concat(), None);
        supervisor.spawn(bridge.clone()).map_err(Failure::fault)?;
        let mut living = 0;
        for (agent, name) in agents(spec) {
            if spec.away.get(&args.name).is_some_and(|here| here.contains(&agent.0)) {
                let robot = member("robot", name, &args.run_dir, join.clone(), Some(agent));
                supervisor.spawn(robot).map_err(Failure::fault)?;
                living += 1;
            }
        }
        let mut tries = 0;
        while living > 0 {
            match events.recv().map_err(Failure::fault)? {
                Event::Interrupted { .. } => break,
                Event::Ended { name, how, .. } if name == "bridge" => {
                    run.bury_the_dead();
                    tries += 1;
                    // One that ends in order has heard that the run is over.
                    if how != Ending::Exited(0) && tries < TRIES {
                        tracing::warn!("the bridge {how}: it is started again");
                        supervisor.spawn(bridge.clone()).map_err(Failure::fault)?;
                    } else if how != Ending::Exited(0) {
                        return Err(Failure::fault(format!(
                            "the bridge {how}, again and again; see its log"
                        )));
                    }
                }
                Event::Ended { name, how, .. } => {
                    run.bury_the_dead();
                    if how != Ending::Exited(0) {
                        tracing::warn!("{name} {how}");
                    }
                    living -= 1;
                }
            }
        }
        supervisor.end(Patience::default());
        run.end().map_err(Failure::fault)?;
        Ok(exit::SUCCESS)
    }
}
