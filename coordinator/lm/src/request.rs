//! What a language model is told: the instruction, the scene as it is now, and the team.

use std::time::Duration;

use serde::{Deserialize, Serialize};

pub use lamma_domains::view::ObjectView;

/// A question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// What the person said.
    pub instruction: String,
    /// The objects of the scene.
    pub objects: Vec<ObjectView>,
    /// The team.
    pub robots: Vec<RobotView>,
    /// Take the best reading instead of asking.
    pub assume: bool,
    /// How long the answer may take.
    pub deadline: Duration,
}

/// A member of the team.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotView {
    /// `robot1`
    pub name: String,
    /// The skills it has.
    pub skills: Vec<String>,
    /// The heaviest thing it can lift, in kilograms.
    pub capacity_kg: f64,
}
