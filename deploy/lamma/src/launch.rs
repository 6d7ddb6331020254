//! A run from start to end, seen from the outside: start the team, watch, tear down.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use lamma_bus::{Bus, Received};
use lamma_coordinator::result::{OutcomeKind, RunResult};
use lamma_protocol::message::{Command, Outcome};
use lamma_protocol::{AgentId, Envelope, Message, Node, Revision, Topic};
use serde::Serialize;

use crate::cli::BusArg;
#[cfg(feature = "zenoh")]
use crate::cli::Format;
use crate::error::Failure;
use crate::host::{Host, InprocHost, ProcessHost};
use crate::spec::RunSpec;
use crate::watch::Watcher;
use crate::world::World;
#[cfg(feature = "zenoh")]
use crate::{commands::run::lines, exit, json, out::say, show};

/// How long the team may take beyond its own limit before it counts as hung.
const GRACE: Duration = Duration::from_secs(10);
/// How often the supervisor repeats itself and looks for the dead when nothing wakes it.
const PULSE: Duration = Duration::from_millis(50);

/// How long the coordinator has for its last word after an interrupt.
const LAST_WORD: Duration = Duration::from_millis(500);

/// A process of the run, for the record.
#[derive(Clone, Debug, Serialize)]
pub struct ProcessRecord {
    /// `robot`, `coordinator` or `simulator`.
    pub role: &'static str,
    /// `robot1`, or the role.
    pub name: String,
    /// Its process id.
    pub pid: u32,
    /// How often it was started again.
    pub restarts: u32,
}

/// What a run leaves.
#[derive(Debug)]
pub struct Launched {
    /// The outcome.
    pub result: RunResult,
    /// Who took part.
    pub processes: Vec<ProcessRecord>,
    /// Logs and artefacts.
    pub folder: PathBuf,
    /// From the call to the end of the teardown.
    pub elapsed: Duration,
}

/// Runs the spec. Whatever happens, nothing of the run is left when this returns.
pub fn launch(
    spec: RunSpec,
    world: Arc<World>,
    bus: BusArg,
    folder: &Path,
    watcher: &mut dyn Watcher,
) -> Result<Launched, Failure> {
    let start = Instant::now();
    spec.write(folder, &world)?;
    let limit = limit(&spec);
    let spec = Arc::new(spec);
    if spec.workers.is_some() && bus != BusArg::Iceoryx2 {
        return Err(Failure::bad_input(
            "--workers is for --bus iceoryx2: the others host all robots their own way",
        ));
    }
    let host: Box<dyn Host> = match bus {
        BusArg::Inproc => Box::new(InprocHost::start(&spec, &world, folder)?),
        BusArg::Iceoryx2 | BusArg::Zenoh => Box::new(ProcessHost::start(&spec, bus, folder)?),
    };
    let (mut result, processes) = supervise(host, limit, watcher)?;
    spec.source.unveil(&mut result)?;
    Ok(Launched { result, processes, folder: folder.to_path_buf(), elapsed: start.elapsed() })
}

/// Watches over a run that has been started, to its end, and ends everything whatever comes of it.
pub fn supervise(
    mut host: Box<dyn Host>,
    limit: Duration,
    watcher: &mut dyn Watcher,
) -> Result<(RunResult, Vec<ProcessRecord>), Failure> {
    let watched = Supervisor::new(limit).watch(host.as_mut(), watcher);
    let processes = host.processes();
    let ended = host.end();
    let result = watched?;
    ended?;
    Ok((result, processes))
}

/// Starts a run whose processes are not all on this host, watches over it, writes and prints its outcome, and gives
/// the exit code.
#[cfg(feature = "zenoh")]
pub fn see_through(
    start: impl FnOnce() -> Result<Box<dyn Host>, Failure>,
    spec: &RunSpec,
    bus: BusArg,
    folder: &Path,
    format: Format,
) -> Result<u8, Failure> {
    let started = Instant::now();
    let (result, processes) = supervise(start()?, limit(spec), lines(format).as_mut())?;
    let launched = Launched { result, processes, folder: folder.to_path_buf(), elapsed: started.elapsed() };
    let json = json::run_of(&launched, bus, spec.seed, &spec.lm.spec);
    let file = launched.folder.join("result.json");
    let text = serde_json::to_string_pretty(&json).map_err(Failure::fault)?;
    std::fs::write(&file, text).map_err(|e| Failure::io("write", &file, &e))?;
    match format {
        Format::Json => say(serde_json::to_string(&json).map_err(Failure::fault)?),
        Format::Text => say(show::result(&launched.result).trim_end()),
    }
    Ok(exit::of(launched.result.outcome))
}

/// How long a run may take in all.
pub fn limit(spec: &RunSpec) -> Duration {
    Duration::from_millis(spec.time_limit_ms) + GRACE
}

/// The supervisor's side of the conversation.
struct Supervisor {
    started: Instant,
    limit: Duration,
    command: Command,
    revision: u64,
    outcome: Option<(Revision, Outcome)>,
    next_event: u64,
    interrupted: Option<Instant>,
}

impl Supervisor {
    fn new(limit: Duration) -> Self {
        Supervisor {
            started: Instant::now(),
            limit,
            command: Command::default(),
            revision: 0,
            outcome: None,
            next_event: 0,
            interrupted: None,
        }
    }

    fn watch(&mut self, host: &mut dyn Host, watcher: &mut dyn Watcher) -> Result<RunResult, Failure> {
        loop {
            let received = self.receive(host.bus());
            self.tell(watcher);
            if let Some(result) = self.result()? {
                self.command.stop = true;
                self.say(host.bus())?;
                return Ok(result);
            }
            // Who was told to stop may end.
            let deaths = if self.command.stop { Vec::new() } else { host.deaths() };
            for death in deaths {
                self.died(death.node, &death.how)?;
                self.say(host.bus())?;
            }
            if host.interrupted() && self.interrupted.is_none() {
                self.interrupted = Some(Instant::now());
                self.command.stop = true;
                self.say(host.bus())?;
            }
            // The coordinator says how far the run had come, if it still can.
            if self.interrupted.is_some_and(|at| at.elapsed() > LAST_WORD) {
                return Ok(RunResult::unfinished(OutcomeKind::GaveUp, "interrupted"));
            }
            if self.started.elapsed() > self.limit {
                return Err(Failure::fault(
                    "the coordinator has not answered within the time limit; see its log in the run's folder",
                ));
            }
            if !received {
                host.bus().wait(Some(PULSE)).map_err(Failure::fault)?;
            }
        }
    }

    fn died(&mut self, node: Node, how: &str) -> Result<(), Failure> {
        match node {
            Node::Robot(agent) => {
                self.command.lost.push(agent);
                Ok(())
            }
            Node::Coordinator | Node::Simulator | Node::Supervisor => Err(Failure::fault(format!(
                "the {node} has ended unexpectedly ({how}); see its log in the run's folder"
            ))),
        }
    }

    fn say(&mut self, bus: &mut dyn Bus) -> Result<(), Failure> {
        self.revision += 1;
        let revision = Revision { incarnation: 0, number: self.revision };
        let envelope = Envelope { revision, message: Message::Command(self.command.clone()) };
        bus.publish(Topic::Command, &envelope).map_err(Failure::fault)
    }

    /// Takes what has come; false if nothing has.
    fn receive(&mut self, bus: &mut dyn Bus) -> bool {
        let newest = &mut self.outcome;
        bus.receive(&mut |received| {
            if let Received::Message(Topic::Outcome, envelope) = received
                && let Message::Outcome(outcome) = envelope.message
                && newest.as_ref().is_none_or(|(seen, _)| envelope.revision > *seen)
            {
                *newest = Some((envelope.revision, outcome));
            }
        }) > 0
    }

    fn tell(&mut self, watcher: &mut dyn Watcher) {
        let Some((_, outcome)) = &self.outcome else { return };
        for (number, event) in (outcome.first_event..).zip(&outcome.events) {
            if number >= self.next_event {
                watcher.event(event);
                self.next_event = number + 1;
            }
        }
    }

    fn result(&self) -> Result<Option<RunResult>, Failure> {
        let Some(json) = self.outcome.as_ref().and_then(|(_, outcome)| outcome.result.as_ref()) else {
            return Ok(None);
        };
        serde_json::from_str(json)
            .map(Some)
            .map_err(|e| Failure::fault(format!("the coordinator's result: {e}")))
    }
}

/// The members of the team that a run has.
pub fn agents(spec: &RunSpec) -> impl Iterator<Item = (AgentId, &str)> {
    (0..).map(AgentId).zip(spec.source.names())
}
