//! The deterministic testbed: coordinator, robots and arbiter in one thread, under virtual time, over a
//! network that loses, doubles, delays and reorders, with robots that crash and pause.
//!
//! The machines are the very ones that run as processes. The same seed gives the same run, to the trace
//! hash.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::sync::atomic::AtomicBool;

use lamma_coordinator::result::{OutcomeKind, RunResult};
use lamma_coordinator::written::{NotWritten, WriteInput};
use lamma_coordinator::{Author, Coordinator, CoordinatorDone, CoordinatorJob, Understood};
use lamma_lm::Script;
use lamma_pddl::ast::GroundAtom;
use lamma_protocol::message::{Command, PlanResult};
use lamma_protocol::{
    AgentId, Envelope, Frame, Input, JobId, Machine, Message, Node, Output, Revision, Tick, Topic, codec,
};
use lamma_robot::{Robot, RobotDone, RobotJob};
use lamma_simulator::Arbiter;

use crate::checker::{Given, Snapshot, invariant_of_arbiter};
use crate::faults::FaultPlan;
use crate::rng::Rng;
use crate::scenario::Scenario;

/// When a run that has not ended counts as stuck, in virtual microseconds.
const HORIZON_US: u64 = 120_000_000;

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Run {
    /// The seed it was drawn from.
    pub seed: u64,
    /// Its faults.
    pub faults: FaultPlan,
    /// The result, unless an invariant was violated.
    pub result: Result<RunResult, String>,
    /// Hash over all inputs of all machines, in order.
    pub trace_hash: u64,
    /// Inputs handled.
    pub inputs: u64,
    /// Virtual time at the end.
    pub ended_us: u64,
}

enum Delivery {
    Message(Topic, Vec<u8>),
    Frame(Vec<u64>),
    RobotDone(JobId, RobotDone),
    CoordinatorDone(JobId, Box<CoordinatorDone>),
    Timer,
    Crash,
    Noticed(AgentId),
}

struct Queued {
    at: Tick,
    order: u64,
    to: Node,
    what: Delivery,
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        (self.at, self.order) == (other.at, other.order)
    }
}
impl Eq for Queued {}
impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Queued {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.at, self.order).cmp(&(other.at, other.order))
    }
}

/// Plans by problem: the same problem comes up in thousands of runs.
pub type PlanCache = BTreeMap<(usize, String), PlanResult>;

struct Testbed<'a> {
    faults: FaultPlan,
    rng: Rng,
    now: Tick,
    order: u64,
    queue: BinaryHeap<Reverse<Queued>>,
    coordinator: Coordinator,
    arbiter: Arbiter,
    robots: Vec<Option<Robot>>,
    revisions: BTreeMap<Topic, u64>,
    timers: BTreeMap<Node, Tick>,
    lost: Vec<AgentId>,
    trace: Trace,
    plans: &'a mut PlanCache,
    violation: Option<String>,
}

/// Runs a scenario under the faults that the seed draws.
pub fn run_seed(scenario: &Scenario, seed: u64, plans: &mut PlanCache) -> Run {
    let mut rng = Rng::new(seed);
    let faults = FaultPlan::draw(&mut rng, scenario.team.members.len());
    run_with(scenario, seed, rng, faults, plans)
}

/// Runs a scenario under given faults.
pub fn run_with(scenario: &Scenario, seed: u64, rng: Rng, faults: FaultPlan, plans: &mut PlanCache) -> Run {
    let robots = (0..scenario.team.members.len()).map(|r| Some(scenario.robot(r))).collect();
    let mut bed = Testbed {
        rng,
        now: Tick(0),
        order: 0,
        queue: BinaryHeap::new(),
        coordinator: scenario.coordinator(),
        arbiter: scenario.arbiter(),
        robots,
        revisions: BTreeMap::new(),
        timers: BTreeMap::new(),
        lost: Vec::new(),
        trace: Trace::default(),
        plans,
        violation: None,
        faults,
    };
    bed.start();
    let result = bed.run_to_end(scenario);
    Run {
        seed,
        faults: bed.faults,
        result,
        trace_hash: bed.trace.hash,
        inputs: bed.trace.inputs,
        ended_us: bed.now.0,
    }
}

impl Testbed<'_> {
    fn start(&mut self) {
        for (robot, at) in self.faults.crashes.clone() {
            self.push(Tick(at), Node::Robot(AgentId(robot as u16)), Delivery::Crash);
        }
        self.drain(Node::Simulator);
        self.drain(Node::Coordinator);
        for robot in 0..self.robots.len() {
            self.drain(Node::Robot(AgentId(robot as u16)));
        }
    }

    fn run_to_end(&mut self, scenario: &Scenario) -> Result<RunResult, String> {
        while let Some(Reverse(next)) = self.queue.pop() {
            if next.at.0 > HORIZON_US {
                break;
            }
            self.now = next.at;
            self.deliver(next.to, next.what);
            if let Some(violation) = self.violation.take() {
                return Err(violation);
            }
            if !scenario.in_order(self.arbiter.state()) {
                return Err("ORDER: a sub-task was reached before what it was asked to follow".into());
            }
            if let Some(json) = self.coordinator.result() {
                let result: RunResult = serde_json::from_str(json).map_err(|e| e.to_string())?;
                return self.truthful(scenario, result);
            }
        }
        Err(format!(
            "TERMINATES: still {} after {} virtual seconds",
            self.coordinator.phase(),
            HORIZON_US / 1_000_000
        ))
    }

    /// Success means the goal holds in the arbiter's state; infeasible is not said of a whole team that can.
    fn truthful(&self, scenario: &Scenario, result: RunResult) -> Result<RunResult, String> {
        let holds = scenario.goal_holds(self.arbiter.state());
        match result.outcome {
            OutcomeKind::Success if !holds => {
                Err("TRUTHFUL: success is claimed and the goal does not hold".into())
            }
            OutcomeKind::Error => Err(format!("NO-ERROR: {:?}", result.reason)),
            OutcomeKind::Infeasible if scenario.feasible_without(&result) => {
                Err(format!("TRUTHFUL: infeasible is claimed: {:?}", result.reason))
            }
            _ => Ok(result),
        }
    }

    fn push(&mut self, at: Tick, to: Node, what: Delivery) {
        self.order += 1;
        self.queue.push(Reverse(Queued { at, order: self.order, to, what }));
    }

    fn paused_until(&self, to: Node) -> Option<Tick> {
        let Node::Robot(agent) = to else { return None };
        self.faults
            .pauses
            .iter()
            .find(|(robot, from, until)| *robot == agent.index() && (*from..*until).contains(&self.now.0))
            .map(|(_, _, until)| Tick(*until))
    }

    fn deliver(&mut self, to: Node, what: Delivery) {
        if let Some(until) = self.paused_until(to) {
            // A stopped process finds its messages when it wakes.
            return self.push(until, to, what);
        }
        match what {
            Delivery::Crash => return self.crash(to),
            Delivery::Noticed(agent) => return self.notice(agent),
            Delivery::Timer if self.timers.get(&to) != Some(&self.now) => return,
            _ => {}
        }
        self.trace.add(self.now, to, &what);
        match to {
            Node::Supervisor => return,
            Node::Simulator => self.feed_arbiter(what),
            Node::Coordinator => self.feed_coordinator(what),
            Node::Robot(agent) => self.feed_robot(agent, what),
        }
        self.drain(to);
    }

    fn crash(&mut self, node: Node) {
        if let Node::Robot(agent) = node {
            self.robots[agent.index()] = None;
            let at = self.now.after_us(self.faults.notice_us);
            self.push(at, Node::Supervisor, Delivery::Noticed(agent));
        }
    }

    fn notice(&mut self, agent: AgentId) {
        self.lost.push(agent);
        let command = Command { lost: self.lost.clone(), stop: false };
        // The supervisor repeats itself too: every 100 ms until well after the network heals.
        for k in 0..60 {
            self.publish_at(self.now.after_ms(100 * k), Topic::Command, Message::Command(command.clone()));
        }
    }

    fn feed_arbiter(&mut self, what: Delivery) {
        let before = Snapshot::of(&self.arbiter);
        let checked = match what {
            Delivery::Message(topic, bytes) => {
                let Ok(envelope) = codec::decode(&bytes) else { return };
                let message = envelope.message.clone();
                self.arbiter.handle(self.now, Input::Message(topic, envelope));
                match (topic, &message) {
                    (Topic::Request(agent), Message::Request(request)) => {
                        invariant_of_arbiter(&before, Given::Request(agent, request), &self.arbiter)
                    }
                    (Topic::Grant, _) => invariant_of_arbiter(&before, Given::Grant, &self.arbiter),
                    _ => invariant_of_arbiter(&before, Given::Other, &self.arbiter),
                }
            }
            _ => {
                self.arbiter.handle(self.now, Input::Timeout);
                invariant_of_arbiter(&before, Given::Other, &self.arbiter)
            }
        };
        self.violation = checked.err();
    }

    fn feed_coordinator(&mut self, what: Delivery) {
        let now = self.now;
        match what {
            Delivery::Message(topic, bytes) => {
                if let Ok(envelope) = codec::decode(&bytes) {
                    self.coordinator.handle(now, Input::Message(topic, envelope));
                }
            }
            Delivery::Frame(words) => {
                if let Ok(frame) = Frame::new(&words) {
                    self.coordinator.handle(now, Input::Frame(frame));
                }
            }
            Delivery::CoordinatorDone(job, done) => self.coordinator.handle(now, Input::Done(job, *done)),
            _ => self.coordinator.handle(now, Input::Timeout),
        }
    }

    fn feed_robot(&mut self, agent: AgentId, what: Delivery) {
        let now = self.now;
        let Some(robot) = &mut self.robots[agent.index()] else { return };
        match what {
            Delivery::Message(topic, bytes) => {
                if let Ok(envelope) = codec::decode(&bytes) {
                    robot.handle(now, Input::Message(topic, envelope));
                }
            }
            Delivery::Frame(words) => {
                if let Ok(frame) = Frame::new(&words) {
                    robot.handle(now, Input::Frame(frame));
                }
            }
            Delivery::RobotDone(job, done) => robot.handle(now, Input::Done(job, done)),
            _ => robot.handle(now, Input::Timeout),
        }
    }

    /// Carries out what a machine asks for, then sets its timer.
    fn drain(&mut self, node: Node) {
        let timeout = match node {
            Node::Supervisor => return,
            Node::Simulator => {
                while let Some(output) = self.arbiter.poll_output() {
                    self.common(output);
                }
                self.arbiter.poll_timeout()
            }
            Node::Coordinator => {
                while let Some(output) = self.coordinator.poll_output() {
                    match output {
                        Output::Spawn(id, job) => self.coordinator_job(id, job),
                        other => self.common(other),
                    }
                }
                self.coordinator.poll_timeout()
            }
            Node::Robot(agent) => {
                let Some(mut robot) = self.robots[agent.index()].take() else { return };
                while let Some(output) = robot.poll_output() {
                    match output {
                        Output::Spawn(id, job) => self.robot_job(agent, id, job),
                        other => self.common(other),
                    }
                }
                let timeout = robot.poll_timeout();
                self.robots[agent.index()] = Some(robot);
                timeout
            }
        };
        if let Some(at) = timeout {
            let at = at.max(self.now.after_us(1));
            if self.timers.insert(node, at) != Some(at) {
                self.push(at, node, Delivery::Timer);
            }
        }
    }

    fn common<J>(&mut self, output: Output<J>) {
        match output {
            Output::Publish(topic, message) => self.publish_at(self.now, topic, message),
            Output::PublishFrame(words) => {
                for reader in self.readers(Topic::Frame) {
                    for at in self.arrivals(self.now) {
                        self.push(at, reader, Delivery::Frame(words.clone()));
                    }
                }
            }
            // A cancelled job answers into the void; the machines know.
            Output::Spawn(..) | Output::Cancel(_) | Output::Log(_) | Output::Finish => {}
        }
    }

    fn publish_at(&mut self, at: Tick, topic: Topic, message: Message) {
        let number = self.revisions.entry(topic).or_insert(0);
        *number += 1;
        let revision = Revision { incarnation: 1, number: *number };
        let Ok(bytes) = codec::encode(&Envelope { revision, message }) else { return };
        for reader in self.readers(topic) {
            for at in self.arrivals(at) {
                self.push(at, reader, Delivery::Message(topic, bytes.clone()));
            }
        }
    }

    fn readers(&self, topic: Topic) -> Vec<Node> {
        Topic::nodes(self.robots.len() as u16)
            .into_iter()
            .filter(|n| *n != Node::Supervisor && topic.read_by(*n))
            .collect()
    }

    /// When a message sent now arrives: never, once or twice.
    fn arrivals(&mut self, sent: Tick) -> Vec<Tick> {
        let faulty = sent.0 < self.faults.heal_us;
        let mut arrivals = Vec::new();
        let copies = if faulty && self.rng.chance(self.faults.duplication) { 2 } else { 1 };
        for _ in 0..copies {
            if faulty && self.rng.chance(self.faults.loss) {
                continue;
            }
            let extra = if faulty { self.rng.range(0, 2 * self.faults.delay_us_mean + 1) } else { 0 };
            arrivals.push(sent.after_us(50 + self.rng.range(0, 20) + extra));
        }
        arrivals
    }

    fn robot_job(&mut self, agent: AgentId, id: JobId, job: RobotJob) {
        let key = (agent.index(), job.package.problem.clone());
        let package = job.package.id;
        let result = match self.plans.get(&key) {
            Some(result) => result.clone(),
            None => {
                let result = job.run(&AtomicBool::new(false)).result;
                self.plans.insert(key, result.clone());
                result
            }
        };
        let done = RobotDone { id: package, result, elapsed_us: 0 };
        let at = self.now.after_us(self.rng.range(100, 40_000));
        self.push(at, Node::Robot(agent), Delivery::RobotDone(id, done));
    }

    fn coordinator_job(&mut self, id: JobId, job: CoordinatorJob) {
        let done = job.run(&mut Nobody, &AtomicBool::new(false));
        let at = self.now.after_us(self.rng.range(100, 20_000));
        self.push(at, Node::Coordinator, Delivery::CoordinatorDone(id, Box::new(done)));
    }
}

/// The testbed has no language.
struct Nobody;

const SILENT: &str = "no language in the testbed";

impl Author for Nobody {
    fn understand(&mut self, _: BTreeSet<GroundAtom>, _: &AtomicBool) -> Understood {
        Understood::Failed(SILENT.into())
    }

    fn write(
        &mut self,
        _: &WriteInput,
        _: &dyn Fn(&Script) -> Vec<String>,
        _: &AtomicBool,
    ) -> Result<Script, NotWritten> {
        Err(NotWritten::Failed(SILENT.into()))
    }
}

/// FNV-1a over what happened: the standard library's hashers may change between releases.
struct Trace {
    hash: u64,
    inputs: u64,
}

impl Default for Trace {
    fn default() -> Self {
        Trace { hash: 0xcbf2_9ce4_8422_2325, inputs: 0 }
    }
}

impl Trace {
    fn add(&mut self, now: Tick, node: Node, what: &Delivery) {
        self.inputs += 1;
        self.bytes(&now.0.to_le_bytes());
        self.bytes(node.to_string().as_bytes());
        match what {
            Delivery::Message(topic, bytes) => {
                self.bytes(topic.to_string().as_bytes());
                self.bytes(bytes);
            }
            Delivery::Frame(words) => words.iter().for_each(|w| self.bytes(&w.to_le_bytes())),
            Delivery::RobotDone(job, _) | Delivery::CoordinatorDone(job, _) => {
                self.bytes(&job.0.to_le_bytes());
            }
            Delivery::Timer | Delivery::Crash | Delivery::Noticed(_) => self.bytes(b"t"),
        }
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.hash = (self.hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
