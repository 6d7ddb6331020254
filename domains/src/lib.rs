//! The household: robots, scenes, union domain, task files.

pub mod goal;
