//! What can be wrong with what a person asks of the household, and what to do about it.

use thiserror::Error;

/// A name or a value that the household does not know.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum HouseError {
    /// No such floor plan.
    #[error("unknown scene `{name}`{hint}; scenes are FloorPlan1-30, 201-230, 301-330 and 401-430")]
    UnknownScene {
        /// As given.
        name: String,
        /// `; did you mean …?` or empty.
        hint: String,
    },
    /// No such robot in the catalogue.
    #[error(
        "unknown robot `{name}`{hint}; the catalogue has robot1 to robot28, others are given by their skills"
    )]
    UnknownRobot {
        /// As given.
        name: String,
        /// `; did you mean …?` or empty.
        hint: String,
    },
    /// No such skill.
    #[error("robot `{robot}`: unknown skill `{skill}`{hint}; skills are: {known}")]
    UnknownSkill {
        /// The robot.
        robot: String,
        /// As given.
        skill: String,
        /// `; did you mean …?` or empty.
        hint: String,
        /// All skills.
        known: String,
    },
    /// A robot's description cannot be.
    #[error("robot `{robot}`: {what}")]
    BadRobot {
        /// The robot.
        robot: String,
        /// What is wrong.
        what: String,
    },
    /// The team cannot be.
    #[error("the team {0}")]
    BadTeam(String),
    /// No such object type.
    #[error("unknown object type `{name}`{hint}")]
    UnknownType {
        /// As given.
        name: String,
        /// `; did you mean …?` or empty.
        hint: String,
    },
    /// An object of the task cannot be.
    #[error("objects: {0}")]
    BadObject(String),
    /// A rule of the task cannot be.
    #[error("rules: {0}")]
    BadRule(String),
}
