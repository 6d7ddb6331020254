//! What is wrong with a goal.

use std::fmt;

use thiserror::Error;

/// What kind of thing is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GoalProblemKind {
    /// A word that is no type, object, property or value.
    Unknown,
    /// A type or object that there is, but not (or not often enough) in this scene.
    Absent,
    /// What can never be: an open tomato, a knife in the microwave.
    Impossible,
    /// A goal that says nothing or contradicts itself.
    Malformed,
}

/// One thing that is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoalProblem {
    /// What kind.
    pub kind: GoalProblemKind,
    /// `goal[0].contains[1]`
    pub path: String,
    /// In words, with what to do.
    pub what: String,
}

impl GoalProblem {
    pub(crate) fn new(kind: GoalProblemKind, path: &str, what: impl Into<String>) -> Self {
        GoalProblem { kind, path: path.to_string(), what: what.into() }
    }

    pub(crate) fn malformed(path: &str, what: &str) -> Self {
        GoalProblem::new(GoalProblemKind::Malformed, path, what)
    }
}

impl fmt::Display for GoalProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path, self.what)
    }
}

/// Everything that is wrong with a goal.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", .problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct GoalError {
    /// At least one.
    pub problems: Vec<GoalProblem>,
}
