//! Slips of the pen that are words, so that no spelling tells them: "put in on the table", "move to pens to the desk".

use super::Rewriting;
use crate::offline::inflect::{self, VerbForm};
use crate::offline::lexicon::Act;
use crate::offline::syntax::{is_determiner, preposition};

/// A thing is named by no more words than this.
const LONGEST_NAME: usize = 3;

impl Rewriting<'_> {
    /// Mends them.
    pub(super) fn slips(&mut self) {
        for index in 0..self.tokens.len() {
            let (word, next) = (self.at(index).to_owned(), self.at(index + 1).to_owned());
            let put = self.says_to_put(index);
            if put && next == "in" && self.is_inward(index + 2) && is_determiner(self.at(index + 3)) {
                self.say(index + 1, index + 2, &["it"]);
            } else if put && next == "in" && self.at(index + 2) == "it" && is_determiner(self.at(index + 3)) {
                self.say(index + 1, index + 3, &["it", "in"]);
            } else if put && next == "to" && inflect::number(self.at(index + 2)).is_some() {
                self.say(index + 1, index + 2, &[]);
            } else if put && next == "to" && self.several_go_somewhere(index + 2) {
                self.say(index + 1, index + 2, &["two"]);
            } else if word == "over" && ["cooked", "heated"].contains(&next.as_str()) {
                self.say(index, index + 2, &[&next]);
            }
        }
    }

    /// "put it in the fridge, then (to) the sink": then put it there.
    pub(super) fn places_after_then(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let to = usize::from(["to", "in", "into", "on", "onto"].contains(&self.at(index + 1)));
            let end = self.next_mark(index + 1, &[",", ".", "and"]);
            let named = is_determiner(self.at(index + 1 + to))
                && end <= index + 2 + to + LONGEST_NAME
                && self.noun_before(end).is_some()
                && !(index + 1..end).any(|at| self.is_base_verb(at) && self.noun_before(at + 1).is_none());
            let before = if self.at(index - 1) == "and" { index - 1 } else { index };
            let somewhere = (before.saturating_sub(1 + LONGEST_NAME)..before)
                .any(|at| ["in", "into", "to", "on", "onto", "inside"].contains(&self.at(at)));
            let placed = somewhere && self.noun_before(before).is_some();
            let start = self.sentence_start(index);
            let puts = self.says_to_put(start);
            if self.at(index) == "then" && named && placed && puts {
                let order: &[&str] = if to == 1 { &["put", "it"] } else { &["put", "it", "in"] };
                self.say(index + 1, index + 1, order);
            }
            index += 1;
        }
    }

    fn says_to_put(&self, index: usize) -> bool {
        self.lexicon.verbs(self.at(index)).iter().any(|(form, particles, verb)| {
            *form != VerbForm::Past && particles.is_empty() && verb.act == Act::Place
        })
    }

    fn is_inward(&self, index: usize) -> bool {
        ["on", "in", "onto", "into", "inside"].contains(&self.at(index))
    }

    /// "(to) pens to the desk": several things, and where they go.
    fn several_go_somewhere(&self, start: usize) -> bool {
        (start + 1..=start + LONGEST_NAME).any(|end| {
            let words = self.words(start..end);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let several = self.lexicon.noun(&words).is_some_and(|(noun, plural)| plural && !noun.class);
            several && preposition(&[self.at(end)]).is_some() && self.at(end) != "of"
        })
    }
}
