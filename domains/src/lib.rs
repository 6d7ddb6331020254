//! The household: robots, scenes, union domain, task files.

pub mod condition;
pub mod crews;
pub mod error;
mod facts;
pub mod generate;
pub mod goal;
pub mod goal_error;
pub mod kinds;
pub mod matthor;
pub mod nearest;
pub mod place;
pub mod property;
mod resolve;
pub mod robots;
pub mod scene;
mod scribe;
pub mod seed;
pub mod tasks;
pub mod view;
pub mod ways;
pub mod world;

pub use condition::{Goal, GoalFact, GoalGroup, Reached, condition};
pub use error::HouseError;
pub use goal_error::{GoalError, GoalProblem, GoalProblemKind};
pub use world::{WorldSetup, setup};
