//! The embedded default steps in when a model fails, and says so.

use std::sync::atomic::AtomicBool;

use crate::chat::Usage;
use crate::{Answer, LanguageModel, LmError, Offline, Request, Script, ScriptRequest};

/// A model with the embedded default behind it.
pub struct Fallback<M> {
    model: M,
    offline: Offline,
}

impl<M: LanguageModel> Fallback<M> {
    /// Puts the embedded default behind a model.
    pub fn new(model: M, offline: Offline) -> Self {
        Self { model, offline }
    }
}

impl<M: LanguageModel> LanguageModel for Fallback<M> {
    fn name(&self) -> String {
        self.model.name()
    }

    fn decompose(&mut self, request: &Request, cancel: &AtomicBool) -> Result<Answer, LmError> {
        let error = match self.model.decompose(request, cancel) {
            Ok(answer) => return Ok(answer),
            // What the person must see, the embedded default must not hide.
            Err(error @ (LmError::Cancelled | LmError::Configuration(_))) => return Err(error),
            Err(error) => error,
        };
        let note = format!("{} failed ({error}); this is the embedded default's reading", self.model.name());
        Ok(match self.offline.read(request) {
            Answer::Understood(mut decomposition) => {
                decomposition.assumptions.insert(0, note);
                Answer::Understood(decomposition)
            }
            Answer::Clarify(mut clarification) => {
                clarification.not_understood.insert(0, note);
                Answer::Clarify(clarification)
            }
        })
    }

    /// A plan of the model's own has nothing to fall back on.
    fn write(
        &mut self,
        asked: &ScriptRequest,
        check: &dyn Fn(&Script) -> Vec<String>,
        cancel: &AtomicBool,
    ) -> Result<Script, LmError> {
        self.model.write(asked, check, cancel)
    }

    fn usage(&self) -> Usage {
        self.model.usage()
    }
}
