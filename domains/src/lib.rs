//! The household: robots, scenes, union domain, task files.

pub mod error;
mod facts;
pub mod goal;
pub mod kinds;
pub mod nearest;
pub mod place;
pub mod property;
pub mod robots;
pub mod scene;
pub mod seed;
pub mod view;
pub mod world;

pub use error::HouseError;
pub use world::{WorldSetup, setup};
