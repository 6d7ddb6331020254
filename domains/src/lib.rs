//! The household: robots, scenes, union domain, task files.

pub mod error;
pub mod goal;
pub mod kinds;
pub mod nearest;
pub mod place;
pub mod scene;
pub mod seed;

pub use error::HouseError;
