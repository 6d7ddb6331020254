//! The simulator's core: the one authority over the world.

mod arbiter;
mod clock;
mod events;
mod vocabulary;

pub use arbiter::{AgentSpec, Arbiter, ArbiterError, WorldConfig};
pub use events::{Event, Happening};
