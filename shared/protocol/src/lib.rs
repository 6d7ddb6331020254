//! Messages, the world frame and the contract every state machine keeps.
//!
//! Knows no planner and no transport: PDDL names cross the wire, never indices.

pub mod codec;
pub mod frame;
pub mod id;
pub mod machine;
pub mod message;
pub mod repeat;
pub mod topic;

pub use frame::{Frame, FrameHeader};
pub use id::{AgentId, Epoch, JobId, Node, PackageId, Revision, StepIndex, Tick};
pub use machine::{Awaits, Input, Machine, Output};
pub use message::{Act, Envelope, Message};
pub use repeat::{Repeat, SaidToEach};
pub use topic::Topic;
