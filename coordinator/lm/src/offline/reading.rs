//! A reading of an instruction, which of two says more, and the answer it makes.

use lamma_domains::goal::{Content, GoalEntry};

use super::lexicon::Lexicon;
use super::scene::Scene;
use super::spelled_out::Told;
use super::{SURE, THRESHOLD, text};
use crate::{Answer, Clarification, Decomposition};

/// How sure a reading is at most that was put together from parts.
pub(super) const AS_A_GIST: f64 = 0.6;

/// A reading this sure is not replaced by a gist that says no more.
const SURE_OF_ALL: f64 = 0.96;

/// What is said in fewer parts than this is read by its grammar, where that does not ask.
const MANY_PARTS: usize = 3;

/// Nobody says three things in fewer words than this.
const SHORTEST_OF_MANY: usize = 9;

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

    /// How many changes it asks for.
    fn changes(&self) -> usize {
        fn of(entry: &GoalEntry) -> usize {
            let inside = entry.contains.iter().map(|content| match content {
                Content::Named(_) => 1,
                Content::With(inner) => 1 + of(inner),
            });
            entry.is.len() + inside.sum::<usize>()
        }
        let lasting = self.decomposition.subtasks.iter().filter(|subtask| subtask.lasting);
        lasting.flat_map(|subtask| &subtask.goal).map(of).sum()
    }

    /// Whether a gist of so many words may say more: what is short and sure is all that was said.
    pub(super) fn leaves_room_for_more(&self, words: usize) -> bool {
        !self.is_understood() || self.decomposition.confidence < SURE || words >= SHORTEST_OF_MANY
    }

    /// Whether a gist is rather to be acted on than another reading: that one asks or is guessed, or it is of many
    /// parts, and the other leaves out some of it or is not sure of all it says.
    pub(super) fn says_more_than(&self, other: &Self) -> bool {
        let unsure = other.decomposition.confidence < SURE_OF_ALL;
        let many = self.changes() >= MANY_PARTS;
        let guessed = other.decomposition.confidence < SURE && self.changes() > 1;
        !other.is_understood() || guessed || many && (unsure || self.changes() > other.changes())
    }

    /// Whether it wants something on, off, open or shut that can be no such thing.
    pub(super) fn asks_what_cannot_be(&self, scene: &Scene<'_>, lexicon: &Lexicon) -> bool {
        fn any(entry: &GoalEntry, cannot: &dyn Fn(&GoalEntry) -> bool) -> bool {
            let inner = |content: &Content| matches!(content, Content::With(entry) if any(entry, cannot));
            cannot(entry) || entry.contains.iter().any(inner)
        }
        let cannot = |entry: &GoalEntry| {
            let kind =
                scene.named(&entry.object).map_or(entry.object.as_str(), |object| object.kind.as_str());
            let lacks = |property: &str, affordance: &str| {
                entry.is.contains_key(property) && !scene.affords(kind, affordance)
            };
            lacks("isToggled", "toggleable") && lexicon.control(kind).is_none() || lacks("isOpen", "openable")
        };
        self.decomposition.subtasks.iter().flat_map(|subtask| &subtask.goal).any(|entry| any(entry, &cannot))
    }

    /// Takes another reading's place for it, and keeps what it was among the others.
    pub(super) fn give_way_to(&mut self, other: Self) {
        let given_up = std::mem::replace(self, other);
        self.others.push(given_up.decomposition);
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
