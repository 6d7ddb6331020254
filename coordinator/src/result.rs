//! The outcome of a run, as the contract prints it.

use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutcomeKind {
    /// Every goal fact holds in the simulator's final state.
    Success,
    /// The run has ended and some goal fact does not hold.
    GoalNotReached,
    /// Proved: the team cannot reach the goal.
    Infeasible,
    /// Out of time or tries, without a proof.
    GaveUp,
    /// The instruction was not clear enough to act on.
    NeedsClarification,
    /// A fault in the software or the host.
    Error,
}

/// What `--format json` prints, without what only the launcher knows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// How it ended.
    pub outcome: OutcomeKind,
    /// Why, unless it is a success.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The goal and what is missing of it.
    pub goal: GoalResult,
    /// What was understood.
    pub understood: UnderstoodResult,
    /// SR, GCR, Exe, RU, Eff; the last two only after success.
    pub metrics: Metrics,
    /// What was done.
    pub plan: PlanResult,
    /// Where the time went.
    pub time_ms: TimeMs,
    /// What went wrong on the way.
    pub faults: Vec<FaultResult>,
    /// How it was mended.
    pub recoveries: Vec<FaultResult>,
    /// What to ask the person, when `outcome` is `needs_clarification`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clarification: Option<serde_json::Value>,
}

/// See [`RunResult::goal`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GoalResult {
    /// Facts of the goal.
    pub total: usize,
    /// Facts that hold.
    pub reached: usize,
    /// Facts that do not.
    pub missing: Vec<String>,
}

/// See [`RunResult::understood`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnderstoodResult {
    /// The sub-tasks.
    pub subtasks: Vec<SubtaskResult>,
    /// What was taken for granted.
    pub assumptions: Vec<String>,
}

/// A sub-task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SubtaskResult {
    /// `s1`
    pub id: String,
    /// In words.
    pub text: String,
    /// In PDDL.
    pub goal: Vec<String>,
    /// Sub-tasks it was asked to follow.
    pub after: Vec<String>,
    /// Who did it.
    pub robots: Vec<String>,
}

/// The paper's metrics for one run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// 1 if every goal fact holds at the end.
    pub sr: f64,
    /// Share of the goal facts that hold.
    pub gcr: f64,
    /// Share of the requested actions that were applied.
    pub exe: f64,
    /// Busy robot-steps the reference needs / used; only after success.
    pub ru: Option<f64>,
    /// Reference makespan / achieved makespan; only after success.
    pub eff: Option<f64>,
}

/// See [`RunResult::plan`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanResult {
    /// The steps, by start.
    pub actions: Vec<ActionResult>,
    /// How many.
    pub length: usize,
    /// In steps.
    pub makespan: f64,
    /// No plan of this team from this start can be shorter, in steps.
    pub makespan_lower_bound: f64,
}

/// A step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActionResult {
    /// When, in steps.
    pub start: f64,
    /// For how long, in steps.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub duration: f64,
    /// Who.
    pub robot: String,
    /// What.
    pub action: String,
    /// With what: the acting robot is left out.
    pub args: Vec<String>,
}

fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_one(duration: &f64) -> bool {
    *duration == 1.0
}

impl ActionResult {
    /// When it is done.
    pub fn end(&self) -> f64 {
        self.start + self.duration
    }
}

/// Milliseconds per phase.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimeMs {
    /// Until everybody had joined.
    pub start: f64,
    /// Understanding.
    pub decompose: f64,
    /// Allocating.
    pub allocate: f64,
    /// The robots' planning.
    pub plan: f64,
    /// Combining.
    pub combine: f64,
    /// Carrying out.
    pub execute: f64,
    /// All.
    pub total: f64,
}

/// A fault or a recovery.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaultResult {
    /// Milliseconds since the run began.
    pub at_ms: f64,
    /// What.
    pub text: String,
}

impl RunResult {
    /// The result of a run that has none of its own.
    pub fn unfinished(outcome: OutcomeKind, reason: impl Into<String>) -> Self {
        RunResult {
            outcome,
            reason: Some(reason.into()),
            goal: GoalResult::default(),
            understood: UnderstoodResult::default(),
            metrics: Metrics { exe: 1.0, ..Metrics::default() },
            plan: PlanResult::default(),
            time_ms: TimeMs::default(),
            faults: Vec::new(),
            recoveries: Vec::new(),
            clarification: None,
        }
    }
}
