//! What a language model answers, once it has been checked against the scene.

use lamma_domains::goal::GoalEntry;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// One sub-task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subtask {
    /// `s1`, `s2`, …
    pub id: String,
    /// The part of the instruction it stands for, in words.
    pub text: String,
    /// What holds when it is done.
    pub goal: Vec<GoalEntry>,
    /// Sub-tasks that must be done before it starts.
    #[serde(default)]
    pub after: Vec<String>,
    /// Robots the model would give it to; advice only.
    #[serde(default)]
    pub robots: Vec<String>,
    /// False when a later sub-task undoes it ("open the blinds, then close them"): its goal is reached on
    /// the way but is not part of the final goal.
    #[serde(default = "yes")]
    pub lasting: bool,
}

fn yes() -> bool {
    true
}

/// What nobody may do on the way.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ban {
    /// The skill, by its AI2-THOR name: `OpenObject`.
    pub skill: String,
    /// What it may not be done to: a type (each of them), or one object.
    pub object: String,
    /// Only with this: what may not be put into the object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub item: Option<String>,
}

/// A reading of the instruction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Decomposition {
    /// In the order of the instruction.
    pub subtasks: Vec<Subtask>,
    /// What was taken for granted.
    #[serde(default)]
    pub assumptions: Vec<String>,
    /// From 0 to 1.
    #[serde(default)]
    pub confidence: f64,
    /// What must not be done on the way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bans: Vec<Ban>,
}

/// Why no reading is good enough to act on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clarification {
    /// One question for the person.
    pub question: String,
    /// What was understood.
    pub understood: Vec<String>,
    /// What was not.
    pub not_understood: Vec<String>,
    /// Up to three readings, best first.
    pub readings: Vec<Decomposition>,
}

/// An answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Act on this.
    Understood(Decomposition),
    /// Ask first.
    Clarify(Clarification),
}

/// No answer.
#[derive(Debug, Error)]
pub enum LmError {
    /// The endpoint could not be reached or answered with an error, and the tries are used up.
    #[error("language model endpoint: {0}")]
    Endpoint(String),
    /// The answers did not pass the checks, and the tries are used up.
    #[error("language model answer not usable after {tries} tries: {last}")]
    Unusable {
        /// How many answers were read.
        tries: u32,
        /// What was wrong with the last.
        last: String,
    },
    /// Out of time.
    #[error("language model: no answer within {0} s")]
    Deadline(u64),
    /// The run is over.
    #[error("cancelled")]
    Cancelled,
    /// A setting is missing or wrong.
    #[error("{0}")]
    Configuration(String),
}
