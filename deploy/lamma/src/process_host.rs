//! A run as processes: one for the simulator, one for the coordinator, one for each robot.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use lamma_bus::Bus;
use lamma_protocol::{AgentId, Node};

use crate::cli::BusArg;
use crate::error::Failure;
use crate::host::{Death, Host};
use crate::launch::{ProcessRecord, agents};
use crate::meeting::Meeting;
use crate::process::join::Place;
use crate::spec::RunSpec;
use crate::supervise::{Event, Patience, Spec, Supervisor, log_file};

/// The processes of a run and the place they meet in.
pub struct ProcessHost {
    // Order matters when this is dropped: first the processes end, then their place goes.
    supervisor: Supervisor,
    events: Receiver<Event>,
    bus: Box<dyn Bus>,
    meeting: Meeting,
    /// Which members of the team a process is, by its name.
    nodes: BTreeMap<String, Vec<Node>>,
    records: Vec<ProcessRecord>,
    deaths: Vec<Death>,
    interrupted: bool,
}

impl ProcessHost {
    /// Creates the place, then starts the processes.
    pub fn start(spec: &Arc<RunSpec>, bus: BusArg, folder: &Path) -> Result<Self, Failure> {
        let mut host = ProcessHost::with_authorities(spec, bus, folder)?;
        host.seat(spec, folder)?;
        Ok(host)
    }

    /// As [`ProcessHost::start`], without the robots that live on other hosts, and with a bridge to these, which is
    /// told where it can be joined.
    #[cfg(feature = "zenoh")]
    pub fn start_hub(spec: &Arc<RunSpec>, folder: &Path, listen: Vec<OsString>) -> Result<Self, Failure> {
        let mut host = ProcessHost::with_authorities(spec, BusArg::Iceoryx2, folder)?;
        let join =
            [host.meeting.arguments(), vec!["--host".into(), crate::spec::HUB.into()], listen].concat();
        let bridge = member("bridge", "bridge", folder, join, None);
        let pid = host.supervisor.spawn(bridge).map_err(Failure::fault)?;
        host.records.push(ProcessRecord { role: "bridge", name: "bridge".into(), pid, restarts: 0 });
        for (agent, name) in agents(spec).filter(|(a, _)| !spec.away.values().flatten().any(|n| *n == a.0)) {
            let pid = host.spawn("robot", name, vec![Node::Robot(agent)], folder)?;
            host.records.push(ProcessRecord { role: "robot", name: name.into(), pid, restarts: 0 });
        }
        Ok(host)
    }

    fn with_authorities(spec: &Arc<RunSpec>, bus: BusArg, folder: &Path) -> Result<Self, Failure> {
        lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
        let meeting = Meeting::create(bus, Place::of(spec), spec.per_seat())?;
        let bus = meeting.open(Node::Supervisor)?;
        let (supervisor, events) = Supervisor::start(Some(bus.waker())).map_err(Failure::fault)?;
        let mut host = ProcessHost {
            supervisor,
            events,
            bus,
            meeting,
            nodes: BTreeMap::new(),
            records: Vec::new(),
            deaths: Vec::new(),
            interrupted: false,
        };
        host.spawn("simulator", "simulator", vec![Node::Simulator], folder)?;
        host.spawn("coordinator", "coordinator", vec![Node::Coordinator], folder)?;
        Ok(host)
    }

    /// One process for each seat of robots.
    fn seat(&mut self, spec: &RunSpec, folder: &Path) -> Result<(), Failure> {
        let team: Vec<(AgentId, &str)> = agents(spec).collect();
        for (worker, seat) in team.chunks(usize::from(spec.per_seat())).enumerate() {
            let robots = seat.iter().map(|&(agent, _)| Node::Robot(agent)).collect();
            let pid = match seat {
                [(_, one)] => self.spawn("robot", one, robots, folder)?,
                _ => self.spawn("robot", &format!("worker{worker}"), robots, folder)?,
            };
            let record = |name: &str| ProcessRecord { role: "robot", name: name.into(), pid, restarts: 0 };
            self.records.extend(seat.iter().map(|(_, name)| record(name)));
        }
        Ok(())
    }

    fn spawn(
        &mut self,
        role: &'static str,
        name: &str,
        nodes: Vec<Node>,
        folder: &Path,
    ) -> Result<u32, Failure> {
        let agent = nodes.first().and_then(|n| if let Node::Robot(agent) = n { Some(*agent) } else { None });
        let spec = Spec {
            env: self.meeting.environment(),
            ties_itself: true,
            ..member(role, name, folder, self.meeting.arguments(), agent)
        };
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
                    self.meeting.bury_the_dead();
                    match self.nodes.get(&name) {
                        Some(nodes) => {
                            let how = how.to_string();
                            self.deaths.extend(nodes.iter().map(|&node| Death { node, how: how.clone() }));
                        }
                        // Those behind it are late then, and are given up by the coordinator in time.
                        None => tracing::error!("the {name} {how}; see its log in the run's folder"),
                    }
                }
                Event::Interrupted { .. } => self.interrupted = true,
            }
        }
    }
}

/// How a process of the run in `folder` is started: its role first, then where it joins.
pub fn member(role: &str, name: &str, folder: &Path, join: Vec<OsString>, agent: Option<AgentId>) -> Spec {
    let mut args: Vec<OsString> = vec![role.into(), "--run-dir".into(), folder.into()];
    args.extend(join);
    args.push("--launched".into());
    if let Some(agent) = agent {
        args.extend(["--agent".into(), agent.0.to_string().into()]);
    }
    Spec { name: name.into(), args, log: log_file(folder, name), ..Spec::default() }
}

/// How long a bridge may take to bring the last word to other hosts: a link may lose it several times.
const LAST_WORD: Duration = Duration::from_secs(10);

impl Host for ProcessHost {
    fn bus(&mut self) -> &mut dyn Bus {
        self.bus.as_mut()
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
        let ProcessHost { supervisor, bus, meeting, records, .. } = *self;
        let mut patience = Patience::default();
        if records.iter().any(|record| record.role == "bridge") {
            // It ends when the other hosts have the last word. Without that their robots would wait for ever.
            patience.ask = LAST_WORD;
        }
        supervisor.end(patience);
        drop(bus);
        meeting.end()
    }
}
