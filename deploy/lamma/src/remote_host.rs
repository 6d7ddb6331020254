//! A run whose processes were started by hand, on this host or others, seen from the coordinator's process: the
//! coordinator's machine in a thread, and beside it the supervisor's part, over the network.

#[cfg(feature = "zenoh")]
pub use network::coordinate;

use crate::cli::CoordinatorArgs;
use crate::error::Failure;
use crate::process::Parts;
use crate::spec::RunSpec;

/// As with Zenoh, where it was left out.
#[cfg(not(feature = "zenoh"))]
pub fn coordinate<M, Job, Done>(
    _args: &CoordinatorArgs,
    _spec: &RunSpec,
    _parts: Parts<M, Job, Done>,
) -> Result<u8, Failure> {
    Err(Failure::bad_input(crate::process::join::NOT_BUILT))
}

#[cfg(feature = "zenoh")]
mod network {
    use std::collections::BTreeSet;
    use std::sync::mpsc::Receiver;
    use std::thread::JoinHandle;
    use std::time::{Duration, Instant};

    use lamma_bus::Bus;
    use lamma_bus::driver::{DriverError, End, Settings, Stop, drive};
    use lamma_bus::zenoh::Endpoint;
    use lamma_coordinator::{Coordinator, CoordinatorDone, CoordinatorJob};
    use lamma_protocol::Node;

    use super::{CoordinatorArgs, Failure, Parts, RunSpec};
    use crate::cli::BusArg;
    use crate::host::{Death, Host};
    use crate::launch::{ProcessRecord, see_through};
    use crate::process::join::{Place, behind_faults, network};
    use crate::supervise::{Event, Patience, Supervisor};

    /// How long the others have to hear that the run is over.
    const FAREWELL: Duration = Duration::from_secs(3);

    /// Runs the coordinator and watches over the run; prints the outcome as `lamma run` does.
    pub fn coordinate(
        args: &CoordinatorArgs,
        spec: &RunSpec,
        parts: Parts<Coordinator, CoordinatorJob, CoordinatorDone>,
    ) -> Result<u8, Failure> {
        if args.child.bus != BusArg::Zenoh {
            return Err(Failure::bad_input(
                "without a launcher a coordinator needs --bus zenoh; see `lamma run`",
            ));
        }
        let start =
            || -> Result<Box<dyn Host>, Failure> { Ok(Box::new(RemoteHost::start(args, spec, parts)?)) };
        see_through(start, spec, BusArg::Zenoh, &args.child.run_dir, args.format)
    }

    /// See the module above.
    struct RemoteHost {
        bus: Endpoint,
        supervisor: Supervisor,
        events: Receiver<Event>,
        stop: Stop,
        coordinator: Option<JoinHandle<Result<End, DriverError>>>,
        lost_after: Duration,
        told: BTreeSet<Node>,
        interrupted: bool,
    }

    impl RemoteHost {
        fn start(
            args: &CoordinatorArgs,
            spec: &RunSpec,
            parts: Parts<Coordinator, CoordinatorJob, CoordinatorDone>,
        ) -> Result<Self, Failure> {
            let open = |node| network::open(&args.child.network, Place::of(spec), node);
            let (bus, own) = (open(Node::Supervisor)?, open(Node::Coordinator)?);
            let mut own = behind_faults(own, spec)?;
            let (supervisor, events) = Supervisor::start(Some(bus.waker())).map_err(Failure::fault)?;
            let stop = Stop::default();
            let settings = Settings { stop: stop.clone(), ..Settings::default() };
            let waker = bus.waker();
            let Parts { mut machine, workers } = parts;
            let work = move || {
                let end = drive(&mut machine, own.as_mut(), settings, workers);
                waker.wake();
                end
            };
            let thread = std::thread::Builder::new().name("coordinator".into()).spawn(work);
            Ok(RemoteHost {
                bus,
                supervisor,
                events,
                stop,
                coordinator: Some(thread.map_err(Failure::fault)?),
                lost_after: Duration::from_secs_f64(args.lost_after),
                told: BTreeSet::new(),
                interrupted: false,
            })
        }

        /// The coordinator's thread, if it has ended.
        fn ended(&mut self) -> Option<Death> {
            let thread = self.coordinator.take_if(|thread| thread.is_finished())?;
            let how = match thread.join() {
                Ok(Ok(end)) => format!("{end:?}"),
                Ok(Err(error)) => error.to_string(),
                Err(_) => "panicked".into(),
            };
            Some(Death { node: Node::Coordinator, how })
        }
    }

    impl Host for RemoteHost {
        fn bus(&mut self) -> &mut dyn Bus {
            &mut self.bus
        }

        fn deaths(&mut self) -> Vec<Death> {
            let mut deaths: Vec<Death> = self.ended().into_iter().collect();
            for (node, time) in self.bus.absent() {
                if node != Node::Coordinator && time > self.lost_after && self.told.insert(node) {
                    deaths.push(Death { node, how: format!("not heard of for {:.0} s", time.as_secs_f64()) });
                }
            }
            deaths
        }

        fn interrupted(&mut self) -> bool {
            self.interrupted |= self.events.try_iter().any(|e| matches!(e, Event::Interrupted { .. }));
            self.interrupted
        }

        fn processes(&self) -> Vec<ProcessRecord> {
            // The others were not started here.
            let pid = std::process::id();
            vec![ProcessRecord { role: "coordinator", name: "coordinator".into(), pid, restarts: 0 }]
        }

        fn end(mut self: Box<Self>) -> Result<(), Failure> {
            let until = Instant::now() + FAREWELL;
            while !self.bus.present().is_empty() && Instant::now() < until {
                self.bus.wait(Some(Duration::from_millis(20))).map_err(Failure::fault)?;
                self.bus.receive(&mut |_| {});
            }
            self.stop.stop();
            if let Some(thread) = self.coordinator.take() {
                // How it ended was told, or is of no interest any more.
                let _ = thread.join();
            }
            self.supervisor.end(Patience::NONE);
            Ok(())
        }
    }
}
