//! What the processes say to each other.
//!
//! Messages are levels, not edges: each states the sender's whole current view, and a receiver keeps the
//! one with the greatest [`Revision`]. Loss, duplication, reordering and overwriting in shared memory are
//! then harmless by construction, and a retransmission is a timer that says it again.

use serde::{Deserialize, Serialize};

use crate::id::{AgentId, Epoch, PackageId, Revision, StepIndex};

/// A message with its place in the sender's sequence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Envelope {
    /// Orders it among what the same publisher says on the same topic.
    pub revision: Revision,
    /// What is said.
    pub message: Message,
}

/// One kind for each topic that carries messages.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Message {
    /// See [`Command`].
    Command(Command),
    /// See [`Outcome`].
    Outcome(Outcome),
    /// See [`Grant`].
    Grant(Grant),
    /// See [`Directive`].
    Directive(Directive),
    /// See [`Report`].
    Report(Report),
    /// See [`Request`].
    Request(Request),
    /// See [`Ack`].
    Ack(Ack),
    /// See [`Vocabulary`].
    Vocabulary(Vocabulary),
}

impl Message {
    /// Whether a frame comes with it that says the same: then nobody need be woken twice.
    pub fn is_shown_by_a_frame(&self) -> bool {
        matches!(self, Message::Ack(Ack { verdict: Verdict::Applied { .. }, .. }))
    }
}

/// What the supervisor wants and knows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Members whose process has ended for good.
    pub lost: Vec<AgentId>,
    /// The user wants the run to end.
    pub stop: bool,
}

/// Where the run is, and how it ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The coordinator's phase, for people.
    pub phase: String,
    /// The number of the first entry of `events`.
    pub first_event: u64,
    /// What happened, oldest first; a window of the most recent.
    pub events: Vec<Event>,
    /// Set once the run is over: the result as JSON (the coordinator's `RunResult`).
    pub result: Option<String>,
}

/// A line for the person who watches.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// Microseconds since the run began.
    pub tick_us: u64,
    /// What kind of line.
    pub kind: EventKind,
    /// The line.
    pub text: String,
}

/// Kinds of [`Event`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// A phase began.
    Phase,
    /// Something about the plan or the understanding.
    Note,
    /// A robot's step was applied; `done` of `total` steps of this epoch are.
    Step {
        /// Steps applied.
        done: u32,
        /// Steps planned.
        total: u32,
    },
    /// A fault was noticed or mended.
    Fault,
}

/// The coordinator asks for a new epoch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Grant {
    /// The epoch to open; the arbiter takes it if it is greater than its own.
    pub epoch: Epoch,
    /// Members that are gone: what they held is put down.
    pub lost: Vec<AgentId>,
}

/// What one robot shall do. Whatever an earlier epoch said is void.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Directive {
    /// The epoch it belongs to.
    pub epoch: Epoch,
    /// What to do.
    pub order: Order,
}

/// The kinds of [`Directive`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Nothing, for now.
    Stand,
    /// Plan for each of these; the list only grows within an epoch, and replanning is a new package.
    Plan(Vec<Package>),
    /// Carry these out, in order, each when its gates are open.
    Execute(Vec<Step>),
    /// The run is over.
    Leave,
}

/// A problem for one robot to plan in its own domain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Package {
    /// Which package of this epoch.
    pub id: PackageId,
    /// The PDDL problem, as text: the robot parses it against its own domain.
    pub problem: String,
}

/// A ground action, by name: PDDL names cross the wire, never indices.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Act {
    /// The action.
    pub action: String,
    /// Its arguments.
    pub args: Vec<String>,
}

impl Act {
    /// The act of these names.
    pub fn new<T: std::fmt::Display>(
        action: impl std::fmt::Display,
        args: impl IntoIterator<Item = T>,
    ) -> Self {
        Act { action: action.to_string(), args: args.into_iter().map(|a| a.to_string()).collect() }
    }
}

impl std::fmt::Display for Act {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.action)?;
        self.args.iter().try_for_each(|a| write!(f, " {a}"))
    }
}

/// Open when `agent` has done at least `done` steps of the epoch (an event count: Reed & Kanodia,
/// "Synchronization with eventcounts and sequencers", CACM 22(2), 1979). A barrier is a set of gates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Gate {
    /// Whose progress.
    pub agent: AgentId,
    /// How many steps it must have done.
    pub done: StepIndex,
}

/// One step of a robot's part of the team's plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Step {
    /// What to do.
    pub act: Act,
    /// When it may be done.
    pub gates: Vec<Gate>,
}

/// How far a robot is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The epoch of the directive it follows; 0 before the first: "I am here".
    pub epoch: Epoch,
    /// The process that speaks, for the record.
    pub pid: u32,
    /// What became of each package of this epoch so far, in order of completion.
    pub plans: Vec<PackageReport>,
    /// Steps of this epoch that it knows to be applied.
    pub done: StepIndex,
    /// Set when the arbiter refused a step: the robot stands still until the next epoch.
    pub refused: Option<Refusal>,
    /// Set when the robot cannot work at all (its own domain does not parse, say).
    pub broken: Option<String>,
    /// What it tells the coordinator of its own task; only while it joins (epoch 0).
    pub share: Option<Share>,
}

/// One agent's own part of a factored task, as PDDL text: for the coordinator, which it trusts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Its domain.
    pub domain: String,
    /// Its problem.
    pub problem: String,
}

/// What became of a package.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackageReport {
    /// Which.
    pub id: PackageId,
    /// How planning ended.
    pub result: PlanResult,
    /// How long it took in the robot's process, in microseconds.
    pub elapsed_us: u64,
}

/// How planning a package ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PlanResult {
    /// A plan, in order.
    Found(Vec<Act>),
    /// There is none, and why.
    Infeasible(String),
    /// None was found within the limits.
    GaveUp(String),
    /// The problem text was not understood.
    Malformed(String),
}

/// A robot asks for a step.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Request {
    /// The epoch it plans in.
    pub epoch: Epoch,
    /// Which of its steps.
    pub step: StepIndex,
    /// What it wants to do.
    pub act: Act,
    /// The step's gates, which the arbiter checks again.
    pub gates: Vec<Gate>,
}

/// What became of a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ack {
    /// The epoch of the request.
    pub epoch: Epoch,
    /// Its step.
    pub step: StepIndex,
    /// What became of it.
    pub verdict: Verdict,
}

/// What became of a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Verdict {
    /// The world has changed; the frame of this version shows it.
    Applied {
        /// The version of the world after it.
        version: u64,
    },
    /// The world has not changed.
    Refused(Refusal),
}

/// Why a step was refused.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refusal {
    /// The step.
    pub step: StepIndex,
    /// What was asked.
    pub act: Act,
    /// The kind of reason.
    pub kind: RefusalKind,
    /// The reason in words, with the missing facts.
    pub reason: String,
}

/// Kinds of refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RefusalKind {
    /// Another epoch is open.
    StaleEpoch,
    /// A gate is closed, or an earlier step is not done.
    TooEarly,
    /// The robot has no such skill, or the action is somebody else's.
    NotAllowed,
    /// A precondition does not hold.
    Precondition,
}

/// The facts behind the bits of the frame: bit `i` is `facts[i]`. The list only grows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Vocabulary {
    /// Ground atoms as PDDL text: `(in Apple_1 Fridge_1)`.
    pub facts: Vec<String>,
}
