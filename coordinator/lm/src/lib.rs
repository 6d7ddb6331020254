//! Language models behind one trait: the embedded default and a chat-completions client.

pub mod answer;
pub mod offline;
pub mod request;

pub use answer::{Answer, Clarification, Decomposition, LmError, Subtask};
pub use offline::Offline;
pub use request::{ObjectView, Request, RobotView};

use std::sync::atomic::AtomicBool;

/// Something that turns an instruction into sub-tasks. A lossy peer: whatever it answers is checked.
pub trait LanguageModel: Send {
    /// A name for the record: `offline`, `openai gpt-4o`.
    fn name(&self) -> String;

    /// Decomposes the instruction. Returns within the request's deadline, or soon after `cancel` is set.
    fn decompose(&mut self, request: &Request, cancel: &AtomicBool) -> Result<Answer, LmError>;
}
