//! A run as processes: one for the simulator, one for the coordinator, one for each robot.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use lamma_bus::Bus;
use lamma_bus::iceoryx::{Endpoint, Run};
use lamma_protocol::Node;

use crate::error::Failure;
use crate::host::{Death, Host};
use crate::launch::{ProcessRecord, agents};
use crate::spec::RunSpec;
use crate::supervise::{Event, Patience, Spec, Supervisor, log_file};

/// The processes of a run and the shared memory they meet in.
pub struct ProcessHost {
    // Order matters when this is dropped: first the processes end, then their memory goes.
    supervisor: Supervisor,
    events: Receiver<Event>,
    bus: Endpoint,
    run: Run,
    nodes: BTreeMap<String, Node>,
    records: Vec<ProcessRecord>,
    deaths: Vec<Death>,
    interrupted: bool,
}

impl ProcessHost {
    /// Creates the memory, then starts the processes.
    pub fn start(spec: &Arc<RunSpec>, folder: &Path) -> Result<Self, Failure> {
        let team = spec.team.len() as u16;
        lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
        let run = Run::create(team).map_err(Failure::fault)?;
        let bus = run.open(Node::Supervisor).map_err(Failure::fault)?;
        let (supervisor, events) = Supervisor::start(Some(bus.waker())).map_err(Failure::fault)?;
        let scope = run.scope().to_string();
        let mut host = ProcessHost {
            supervisor,
            events,
            bus,
            run,
            nodes: BTreeMap::new(),
            records: Vec::new(),
            deaths: Vec::new(),
            interrupted: false,
        };
        host.spawn(Node::Simulator, "simulator", "simulator", folder, &scope)?;
        host.spawn(Node::Coordinator, "coordinator", "coordinator", folder, &scope)?;
        for (agent, name) in agents(spec) {
            host.spawn(Node::Robot(agent), "robot", name, folder, &scope)?;
        }
        Ok(host)
    }

    fn spawn(
        &mut self,
        node: Node,
        role: &'static str,
        name: &str,
        folder: &Path,
        scope: &str,
    ) -> Result<(), Failure> {
        let mut args: Vec<OsString> =
            vec![role.into(), "--run-dir".into(), folder.into(), "--scope".into(), scope.into()];
        if let Node::Robot(agent) = node {
            args.extend(["--agent".into(), agent.0.to_string().into()]);
        }
        let log = log_file(folder, name);
        let spec = Spec { name: name.into(), args, log, ..Spec::default() };
        let pid = self.supervisor.spawn(spec).map_err(Failure::fault)?;
        self.nodes.insert(name.into(), node);
        self.records.push(ProcessRecord { role, name: name.into(), pid, restarts: 0 });
        Ok(())
    }

    fn listen(&mut self) {
        for event in self.events.try_iter() {
            match event {
                Event::Ended { name, how, .. } => {
                    if let Some(&node) = self.nodes.get(&name) {
                        self.deaths.push(Death { node, how: how.to_string() });
                        self.run.bury_the_dead();
                    }
                }
                Event::Interrupted { .. } => self.interrupted = true,
            }
        }
    }
}

impl Host for ProcessHost {
    fn bus(&mut self) -> &mut dyn Bus {
        &mut self.bus
    }

    fn deaths(&mut self) -> Vec<Death> {
        self.listen();
        std::mem::take(&mut self.deaths)
    }

    fn interrupted(&mut self) -> bool {
        self.listen();
        self.interrupted
    }

    fn processes(&self) -> Vec<ProcessRecord> {
        self.records.clone()
    }

    fn end(self: Box<Self>) -> Result<(), Failure> {
        let ProcessHost { supervisor, bus, run, .. } = *self;
        supervisor.end(Patience::default());
        drop(bus);
        run.end().map_err(Failure::fault)
    }
}
