//! The robot: plans in its own domain and carries out its steps.

mod execute;
mod machine;
mod planning;

pub use machine::{Robot, RobotConfig};
pub use planning::{RobotDone, RobotJob};
