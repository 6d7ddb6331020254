//! Language models behind one trait: the embedded default and a chat-completions client.

pub mod answer;
pub mod cassette;
pub mod chat;
pub mod decode;
pub mod fallback;
pub mod http;
pub mod offline;
pub mod prompt;
pub mod request;
pub mod script;
pub mod spec;

pub use answer::{Answer, Ban, Clarification, Decomposition, LmError, Subtask};
pub use chat::{ChatModel, Usage};
pub use fallback::Fallback;
pub use offline::Offline;
pub use prompt::Wording;
pub use request::{ObjectView, Request, RobotView};
pub use script::{Allotted, Script, ScriptRequest, ScriptStep};
pub use spec::{Options, from_spec};

use std::sync::atomic::AtomicBool;

/// Something that turns an instruction into sub-tasks. A lossy peer: whatever it answers is checked.
pub trait LanguageModel: Send {
    /// A name for the record: `offline`, `openai gpt-4o`.
    fn name(&self) -> String;

    /// Decomposes the instruction. Returns within the request's deadline, or soon after `cancel` is set.
    fn decompose(&mut self, request: &Request, cancel: &AtomicBool) -> Result<Answer, LmError>;

    /// Writes the plan of the whole team itself. What `check` finds wrong with an answer is sent back with it. Only
    /// chat models can.
    fn write(
        &mut self,
        asked: &ScriptRequest,
        check: &dyn Fn(&Script) -> Vec<String>,
        cancel: &AtomicBool,
    ) -> Result<Script, LmError> {
        let _ = (asked, check, cancel);
        Err(LmError::Configuration(format!(
            "{} writes no plans: name a model with --lm openai, record:FILE or replay:FILE",
            self.name()
        )))
    }

    /// Tokens used so far; none for what is no model.
    fn usage(&self) -> Usage {
        Usage::default()
    }
}
