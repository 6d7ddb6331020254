//! A reading of an instruction, and the answer it makes.

use super::spelled_out::Told;
use super::{THRESHOLD, text};
use crate::{Answer, Clarification, Decomposition};

/// A reading and what is wrong with it.
pub(super) struct Reading {
    pub(super) decomposition: Decomposition,
    pub(super) problems: Vec<String>,
    /// Readings that were not preferred, best first.
    pub(super) others: Vec<Decomposition>,
    /// Whether it only says where to go.
    pub(super) only_goes: bool,
    /// Whether it says what to do to things of the scene, so that no situation stands for it.
    pub(super) concrete: bool,
    /// How many clauses it was read from.
    pub(super) clauses: usize,
    /// What situations brought about in it, and what was said in so many words.
    pub(super) told: Told,
}

impl Reading {
    /// Of what has no word in it that is known.
    pub(super) fn nothing(instruction: &str) -> Self {
        Self {
            decomposition: Decomposition::default(),
            problems: vec![format!(
                "I do not know what to do for \"{}\"",
                text::shortened(&instruction.to_lowercase())
            )],
            others: Vec::new(),
            only_goes: false,
            concrete: false,
            clauses: 0,
            told: Told::default(),
        }
    }

    /// Whether it is acted upon without a question.
    pub(super) fn is_understood(&self) -> bool {
        !self.decomposition.subtasks.is_empty() && self.decomposition.confidence >= THRESHOLD
    }

    /// Says what was taken for remarks.
    pub(super) fn remark(&mut self, remarks: &[String]) {
        let noted = remarks.iter().map(|remark| format!("took \"{remark}\" as a remark"));
        self.decomposition.assumptions.splice(0..0, noted);
    }

    /// The answer to what was `said`.
    pub(super) fn answer(self, said: &str, assume: bool) -> Answer {
        let Self { decomposition, problems, others, only_goes, .. } = self;
        let empty = decomposition.subtasks.is_empty();
        if !empty && (assume || decomposition.confidence >= THRESHOLD) {
            let mut decomposition = decomposition;
            decomposition.assumptions.extend(problems);
            return Answer::Understood(decomposition);
        }
        let understood = decomposition.subtasks.iter().map(|subtask| subtask.text.clone()).collect();
        let question = match problems.first() {
            Some(problem) => format!("I cannot act on this yet: {problem}. What shall be done?"),
            None if empty && !decomposition.assumptions.is_empty() => {
                format!(
                    "I found nothing to do: {}. What shall be true in the end?",
                    decomposition.assumptions.join("; ")
                )
            }
            None if empty && only_goes => {
                "Going somewhere alone changes nothing that I can check. What shall be done there?".to_owned()
            }
            None if empty => format!("I found nothing to do in \"{said}\". What shall be true in the end?"),
            None => "Is this what you mean?".to_owned(),
        };
        let all = std::iter::once(decomposition).chain(others);
        let readings = all.filter(|reading| !reading.subtasks.is_empty()).take(3).collect();
        Answer::Clarify(Clarification { question, understood, not_understood: problems, readings })
    }
}
