//! Where the machines of a run live: as processes over shared memory, or as threads of this process.

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use lamma_bus::Bus;
use lamma_bus::driver::{DriverError, End, Settings, Stop, drive};
use lamma_bus::inproc::{Hub, Inproc};
use lamma_protocol::{Machine, Node};

use crate::error::Failure;
use crate::launch::{ProcessRecord, agents};
use crate::process::join::behind_faults;
use crate::process::{Parts, arbiter_parts, coordinator_parts, robot_parts};
use crate::spec::RunSpec;
use crate::world::World;

pub use crate::process_host::ProcessHost;

/// The end of a member that the supervisor had not asked for.
#[derive(Debug)]
pub struct Death {
    /// Who.
    pub node: Node,
    /// `killed by signal 9`, `exit status 30`.
    pub how: String,
}

/// A place where a run's machines live.
pub trait Host {
    /// The supervisor's endpoint.
    fn bus(&mut self) -> &mut dyn Bus;

    /// Members that have ended since the last call.
    fn deaths(&mut self) -> Vec<Death>;

    /// Whether the person wants the run to end.
    fn interrupted(&mut self) -> bool;

    /// Who takes part.
    fn processes(&self) -> Vec<ProcessRecord>;

    /// Ends everything and removes what the run used.
    fn end(self: Box<Self>) -> Result<(), Failure>;
}

/// All machines as threads of this process.
pub struct InprocHost {
    bus: Inproc,
    stop: Stop,
    threads: Vec<(Node, JoinHandle<Result<End, DriverError>>)>,
    records: Vec<ProcessRecord>,
}

impl InprocHost {
    /// Starts a thread for each machine.
    pub fn start(spec: &Arc<RunSpec>, world: &Arc<World>, folder: &Path) -> Result<Self, Failure> {
        let hub = Hub::new(spec.team_size());
        let endpoint = |node| hub.open(node).ok_or_else(|| Failure::fault(format!("no endpoint for {node}")));
        let mut host = InprocHost {
            bus: endpoint(Node::Supervisor)?,
            stop: Stop::default(),
            threads: Vec::new(),
            records: Vec::new(),
        };
        let endpoint =
            |node| -> Result<Box<dyn Bus + Send>, Failure> { behind_faults(endpoint(node)?, spec) };
        host.run(Node::Simulator, "simulator", endpoint(Node::Simulator)?, arbiter_parts(spec, world)?)?;
        let parts = coordinator_parts(spec, || Ok(world.clone()))?;
        host.run(Node::Coordinator, "coordinator", endpoint(Node::Coordinator)?, parts)?;
        for (agent, name) in agents(spec) {
            let parts = robot_parts(spec, folder, agent)?;
            host.run(Node::Robot(agent), name, endpoint(Node::Robot(agent))?, parts)?;
        }
        Ok(host)
    }

    fn run<M>(
        &mut self,
        node: Node,
        name: &str,
        mut bus: Box<dyn Bus + Send>,
        parts: Parts<M, M::Job, M::Done>,
    ) -> Result<(), Failure>
    where
        M: Machine + Send + 'static,
        M::Job: Send + 'static,
        M::Done: Send + 'static,
    {
        let settings = Settings { start: Instant::now(), stop: self.stop.clone(), ..Settings::default() };
        let Parts { mut machine, workers } = parts;
        let thread = std::thread::Builder::new()
            .name(name.to_string())
            .spawn(move || drive(&mut machine, bus.as_mut(), settings, workers))
            .map_err(|e| Failure::fault(format!("no thread for {name}: {e}")))?;
        self.threads.push((node, thread));
        let role = match node {
            Node::Robot(_) => "robot",
            Node::Coordinator => "coordinator",
            Node::Simulator | Node::Supervisor => "simulator",
        };
        self.records.push(ProcessRecord { role, name: name.into(), pid: std::process::id(), restarts: 0 });
        Ok(())
    }
}

impl Host for InprocHost {
    fn bus(&mut self) -> &mut dyn Bus {
        &mut self.bus
    }

    fn deaths(&mut self) -> Vec<Death> {
        let (ended, running) = self.threads.drain(..).partition(|(_, thread)| thread.is_finished());
        self.threads = running;
        let ended: Vec<(Node, JoinHandle<_>)> = ended;
        ended
            .into_iter()
            .map(|(node, thread)| {
                let how = match thread.join() {
                    Ok(Ok(end)) => format!("{end:?}"),
                    Ok(Err(error)) => error.to_string(),
                    Err(_) => "panicked".into(),
                };
                Death { node, how }
            })
            .collect()
    }

    fn interrupted(&mut self) -> bool {
        // The signal ends this one process as a whole.
        false
    }

    fn processes(&self) -> Vec<ProcessRecord> {
        self.records.clone()
    }

    fn end(self: Box<Self>) -> Result<(), Failure> {
        self.stop.stop();
        for (_, thread) in self.threads {
            // What went wrong in a thread before the end was told by `deaths`.
            let _ = thread.join();
        }
        Ok(())
    }
}
