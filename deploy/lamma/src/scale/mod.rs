//! Teams of growing size on a generated task ([`task`]), measured: start-up, memory, meetings, actions, and
//! that nothing is left.

mod coordinator;
mod measure;
mod member;
mod plot;
mod task;

use std::ffi::OsString;
use std::path::Path;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Command, Outcome};
use lamma_protocol::{Envelope, Message, Node, Revision, Topic};

use crate::cli::BusArg;
use crate::error::Failure;
use crate::meeting::Meeting;
use crate::process::join::Place;
use crate::supervise::{Event, Patience, Spec, Supervisor, log_file};
use coordinator::Outcomes;
pub use measure::{Level, Spread};
pub use member::member;
pub use plot::svg;
use task::Rally;

/// How long the supervisor sleeps when nothing happens.
const PULSE: Duration = Duration::from_millis(100);

/// What a rally is called on a network; its router is its own.
const RUN: &str = "rally";

/// How long a team may take beyond its own limit before it counts as hung.
const GRACE: Duration = Duration::from_secs(10);

/// Processes whose memory is looked at: a look costs milliseconds, and they are all alike.
const MEMORY_SAMPLES: usize = 64;

/// What is to be measured.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// Over what.
    pub bus: BusArg,
    /// Robots.
    pub agents: u16,
    /// Processes that host them; as many as there are robots if None.
    pub workers: Option<u16>,
    /// How often all meet.
    pub rounds: u32,
    /// Where they start is drawn from it.
    pub seed: u64,
    /// Give up after this long.
    pub limit: Duration,
}

impl Sizes {
    /// Robots that share a process.
    fn per_seat(&self) -> u16 {
        self.workers.map_or(1, |w| self.agents.div_ceil(w.max(1)).max(1))
    }
}

/// Runs one team. Whatever happens, nothing of it is left when this returns, or the figures say so.
pub fn run(sizes: &Sizes, folder: &Path) -> Result<Level, Failure> {
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    let rally = Rally { agents: sizes.agents, rounds: sizes.rounds, seed: sizes.seed };
    rally.write(folder)?;
    let start = Instant::now();
    let cpu_before = measure::cpu_of_children();
    let place = Place { run: RUN, agents: sizes.agents };
    let meeting = Meeting::create(sizes.bus, place, sizes.per_seat())?;
    let files = meeting.scope().cloned();
    let (watched, pids) = {
        let mut team = Team::start(&meeting, sizes, folder, start)?;
        let watched = team.watch(sizes.limit + GRACE);
        let pids = team.pids.clone();
        team.end();
        (watched, pids)
    };
    meeting.end()?;
    let total = start.elapsed();
    let (outcomes, started, memory) = watched?;
    if let Some(why) = outcomes.failure {
        return Err(Failure::fault(format!("{} robots: {why}; logs in {}", sizes.agents, folder.display())));
    }
    let path = folder.join(member::LEAD_FILE);
    let text = std::fs::read_to_string(&path).map_err(|e| Failure::io("read", &path, &e))?;
    let asked: Vec<u64> = serde_json::from_str(&text).map_err(Failure::fault)?;
    let barriers = measure::barriers_us(&asked, &outcomes);
    Ok(Level {
        agents: sizes.agents,
        processes: pids.len() - 2,
        start_s: started.as_secs_f64(),
        plan_s: outcomes.plan_us as f64 / 1e6,
        act_s: outcomes.act_us as f64 / 1e6,
        private_kib: memory,
        barriers: barriers.len(),
        barrier_us: Spread::of(barriers),
        actions: outcomes.actions,
        actions_per_s: outcomes.actions as f64 * 1e6 / outcomes.act_us.max(1) as f64,
        total_s: total.as_secs_f64(),
        cpu_s: (measure::cpu_of_children() - cpu_before).as_secs_f64(),
        processes_left: measure::alive(&pids),
        files_left: files.map_or(0, |scope| lamma_bus::iceoryx::left_over(&scope).len()),
    })
}

/// The processes of one team, and the supervisor's endpoint.
struct Team {
    supervisor: Option<Supervisor>,
    events: Receiver<Event>,
    bus: Box<dyn Bus>,
    start: Instant,
    pids: Vec<u32>,
    /// Robots that each of the seats hosts, beside its process.
    hosts: Vec<(u32, u16)>,
    stopped: bool,
}

impl Team {
    fn start(meeting: &Meeting, sizes: &Sizes, folder: &Path, start: Instant) -> Result<Team, Failure> {
        let bus = meeting.open(Node::Supervisor)?;
        let (supervisor, events) = Supervisor::start(Some(bus.waker())).map_err(Failure::fault)?;
        let mut team = Team {
            supervisor: Some(supervisor),
            events,
            bus,
            start,
            pids: Vec::new(),
            hosts: Vec::new(),
            stopped: false,
        };
        let limit = sizes.limit.as_millis().to_string();
        let process = |name: String, role: &str, agent: u16| {
            let run_dir = folder.as_os_str().to_owned();
            let mut args: Vec<OsString> =
                ["rally", "--role", role, "--limit-ms", &limit, "--run-dir"].map(OsString::from).into();
            args.extend([run_dir, "--agent".into(), agent.to_string().into(), "--launched".into()]);
            args.extend(meeting.arguments());
            let (log, env) = (log_file(folder, &name), meeting.environment());
            Spec { name, args, log, env, ties_itself: true, ..Spec::default() }
        };
        team.spawn(process("simulator".into(), "simulator", 0))?;
        team.spawn(process("coordinator".into(), "coordinator", 0))?;
        let per_seat = sizes.per_seat();
        for first in (0..sizes.agents).step_by(per_seat.into()) {
            let pid = team.spawn(process(format!("robots-{first}"), "robots", first))?;
            team.hosts.push((pid, per_seat.min(sizes.agents - first)));
        }
        Ok(team)
    }

    fn spawn(&mut self, spec: Spec) -> Result<u32, Failure> {
        let Some(supervisor) = &self.supervisor else { return Err(Failure::fault("the team has ended")) };
        let pid = supervisor.spawn(spec).map_err(Failure::fault)?;
        self.pids.push(pid);
        Ok(pid)
    }

    /// Until the outcome is there; with how long the start took, and the memory at the end.
    fn watch(&mut self, limit: Duration) -> Result<(Outcomes, Duration, Spread), Failure> {
        let mut started = None;
        loop {
            let mut news: Option<Outcome> = None;
            let received = self.bus.receive(&mut |received| {
                if let Received::Message(_, Envelope { message: Message::Outcome(outcome), .. }) = received {
                    news = Some(outcome);
                }
            });
            if let Some(outcome) = news {
                if outcome.phase != "joining" {
                    started.get_or_insert_with(|| self.start.elapsed());
                }
                if let Some(json) = outcome.result {
                    let outcomes = serde_json::from_str(&json).map_err(Failure::fault)?;
                    return Ok((outcomes, started.unwrap_or_default(), self.memory()));
                }
            }
            match self.events.try_recv() {
                Ok(Event::Ended { name, how, .. }) => {
                    return Err(Failure::fault(format!("{name} {how} before the end; see its log")));
                }
                Ok(Event::Interrupted { .. }) => return Err(Failure::fault("interrupted")),
                // Nothing has happened; a keeper that has gone takes the team along.
                Err(_) => {}
            }
            if self.start.elapsed() > limit {
                return Err(Failure::fault("the team has not come to an end within the time limit"));
            }
            if received == 0 {
                self.bus.wait(Some(PULSE)).map_err(Failure::fault)?;
            }
        }
    }

    /// Private memory for each robot.
    fn memory(&self) -> Spread {
        let every = self.hosts.len().div_ceil(MEMORY_SAMPLES).max(1);
        let sample = self.hosts.iter().step_by(every);
        let of = |(pid, robots): &(u32, u16)| {
            let kib = measure::private_kib(*pid).ok()?;
            Some(kib / f64::from((*robots).max(1)))
        };
        Spread::of(sample.filter_map(of).collect())
    }

    /// Tells all to leave, and sees them out.
    fn end(&mut self) {
        self.stopped = true;
        let revision = Revision { incarnation: 0, number: 1 };
        let command = Command { stop: true, ..Command::default() };
        let envelope = Envelope { revision, message: Message::Command(command) };
        if let Err(error) = self.bus.publish(Topic::Command, &envelope) {
            tracing::warn!("the team cannot be told to leave: {error}");
        }
        if let Some(supervisor) = self.supervisor.take() {
            supervisor.end(Patience { ask: Duration::from_secs(10), term: Duration::from_secs(2) });
        }
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        if !self.stopped {
            self.end();
        }
    }
}
