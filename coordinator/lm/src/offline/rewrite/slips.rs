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
            } else if word == "then" && index > 0 && self.at(index - 1) == "and" && next == "another" {
                // "one mug and then another in the sink"
                self.say(index, index + 1, &[]);
            } else if word == "over" && ["cooked", "heated"].contains(&next.as_str()) {
                self.say(index, index + 2, &[&next]);
            }
        }
    }

    /// "put it in the fridge, then (to) the sink", "to the fridge and to the sink": then put it there.
    pub(super) fn places_after_places(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let then = self.at(index) == "then";
            let before = (1..=index).rev().find(|&at| !["and", ","].contains(&self.at(at - 1))).unwrap_or(0);
            let behind = index + usize::from(then);
            let to = preposition(&[self.at(behind), self.at(behind + 1)]).filter(|_| self.is_there(behind));
            let to = to.map_or(0, |(_, length)| length);
            let end = self.next_mark(behind, &[",", ".", "and"]);
            let named = end <= behind + 1 + to + LONGEST_NAME
                && (is_determiner(self.at(behind + to)) || to > 0)
                && self.noun_before(end).is_some()
                && !(behind + to..end).any(|at| self.is_order(at))
                && !(behind + to + 1..end).any(|at| is_determiner(self.at(at)));
            let placed =
                if then { self.placed_before(before) } else { to > 0 && self.passes_through(before, index) };
            if named && placed && self.says_to_put_or_take(self.sentence_start(index)) {
                let order: &[&str] =
                    if to > 0 { &["then", "put", "it"] } else { &["then", "put", "it", "in"] };
                self.say(index, behind, order);
                index += order.len();
            }
            index += 1;
        }
    }

    /// Whether a place ends here: "in the fridge".
    fn placed_before(&self, end: usize) -> bool {
        self.noun_before(end).is_some()
            && (end.saturating_sub(1 + LONGEST_NAME)..end).any(|at| self.is_there(at))
    }

    fn is_there(&self, at: usize) -> bool {
        ["in", "into", "to", "on", "onto", "inside"].contains(&self.at(at))
    }

    /// "to the fridge (and) to …": a thing goes to no fridge and no microwave to stay there, if it goes on.
    fn passes_through(&self, end: usize, index: usize) -> bool {
        let device = self.noun_before(end).is_some_and(|words| {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            self.lexicon.noun(&words).is_some_and(|(noun, _)| {
                noun.kinds.first().is_some_and(|kind| ["Fridge", "Microwave"].contains(&kind.as_str()))
            })
        });
        let goes = |at: usize| match self.at(at) {
            "to" | "into" => true,
            "in" | "inside" => end < index && self.at(index - 1) == "and",
            _ => false,
        };
        device && (end.saturating_sub(LONGEST_NAME)..end).any(goes)
    }

    pub(super) fn says_to_put_or_take(&self, start: usize) -> bool {
        let takes = |at: usize| {
            self.lexicon.verbs(self.at(at)).iter().any(|(_, particles, verb)| {
                particles.is_empty() && matches!(verb.act, Act::Place | Act::Hold)
            })
        };
        takes(start) || self.at(start) == "to" && takes(start + 1)
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
