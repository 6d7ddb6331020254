//! A run as processes: one for the simulator, one for the coordinator, one for each robot.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use lamma_bus::Bus;
use lamma_bus::iceoryx::{Endpoint, Run};
use lamma_protocol::{AgentId, Node};

use crate::error::Failure;
use crate::host::{Death, Host};
use crate::launch::ProcessRecord;
use crate::spec::RunSpec;
use crate::supervise::{Event, Patience, Spec, Supervisor, log_file};

/// The processes of a run and the shared memory they meet in.
pub struct ProcessHost {
    // Order matters when this is dropped: first the processes end, then their memory goes.
    supervisor: Supervisor,
    events: Receiver<Event>,
    bus: Endpoint,
    run: Run,
    /// Which members of the team a process is, by its name.
    nodes: BTreeMap<String, Vec<Node>>,
    records: Vec<ProcessRecord>,
    deaths: Vec<Death>,
    interrupted: bool,
}

impl ProcessHost {
    /// Creates the memory, then starts the processes.
    pub fn start(spec: &Arc<RunSpec>, folder: &Path) -> Result<Self, Failure> {
        let team = spec.team.len() as u16;
        lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
        let per_seat = spec.workers.map_or(1, |workers| team.div_ceil(workers.max(1)).max(1));
        let run = Run::create_seated(team, per_seat).map_err(Failure::fault)?;
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
        host.spawn("simulator", "simulator", vec![Node::Simulator], folder, &scope)?;
        host.spawn("coordinator", "coordinator", vec![Node::Coordinator], folder, &scope)?;
        for (worker, seat) in host.run.scope().seats().into_iter().enumerate() {
            let robots: Vec<Node> = seat.clone().map(|a| Node::Robot(AgentId(a))).collect();
            let names = spec.team.get(usize::from(seat.start)..usize::from(seat.end)).unwrap_or_default();
            let pid = match names {
                [one] => host.spawn("robot", &one.name, robots, folder, &scope)?,
                _ => host.spawn("robot", &format!("worker{worker}"), robots, folder, &scope)?,
            };
            let record = |name: String| ProcessRecord { role: "robot", name, pid, restarts: 0 };
            host.records.extend(names.iter().map(|r| record(r.name.clone())));
        }
        Ok(host)
    }

    fn spawn(
        &mut self,
        role: &'static str,
        name: &str,
        nodes: Vec<Node>,
        folder: &Path,
        scope: &str,
    ) -> Result<u32, Failure> {
        let mut args: Vec<OsString> =
            vec![role.into(), "--run-dir".into(), folder.into(), "--scope".into(), scope.into()];
        if let Some(Node::Robot(agent)) = nodes.first() {
            args.extend(["--agent".into(), agent.0.to_string().into()]);
        }
        let log = log_file(folder, name);
        let spec = Spec { name: name.into(), args, log, ties_itself: true, ..Spec::default() };
        let pid = self.supervisor.spawn(spec).map_err(Failure::fault)?;
        if !matches!(nodes.first(), Some(Node::Robot(_))) {
            self.records.push(ProcessRecord { role, name: name.into(), pid, restarts: 0 });
        }
        self.nodes.insert(name.into(), nodes);
        Ok(pid)
    }

    fn listen(&mut self) {
        for event in self.events.try_iter() {
            match event {
                Event::Ended { name, how, .. } => {
                    if let Some(nodes) = self.nodes.get(&name) {
                        let how = how.to_string();
                        self.deaths.extend(nodes.iter().map(|&node| Death { node, how: how.clone() }));
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
