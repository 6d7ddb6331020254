//! The simulator's core: the one authority over the world.

mod arbiter;
mod clock;
mod vocabulary;

pub use arbiter::{AgentSpec, Arbiter, ArbiterError, WorldConfig};
