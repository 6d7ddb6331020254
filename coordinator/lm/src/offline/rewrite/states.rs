//! Notes of how things shall be: "coffee in the mug, the bread sliced, the toaster off".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

/// What may follow a thing in such a note, apart from states.
const PLACES: [&str; 5] = ["in", "on", "inside", "onto", "into"];

impl Rewriting<'_> {
    /// A sentence of nothing but things and their states or places says what should be so.
    pub(super) fn states_as_notes(&mut self) {
        let mut start = 0;
        while start < self.tokens.len() {
            let end = self.next_mark(start, &["."]);
            let notes = self.notes(start, end);
            let state = notes.iter().flatten().any(|&at| !PLACES.contains(&self.at(at)));
            let told = notes.iter().all(Option::is_some);
            let mut end = end;
            if told && state && notes.len() > 1 {
                for at in notes.into_iter().flatten().rev() {
                    self.say(at, at, &["should", "be"]);
                    end += 2;
                }
            }
            start = end + 1;
        }
    }

    /// "no lights, please": they should be off.
    pub(super) fn no_lights(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and"].contains(&self.at(index - 1));
            let lights = ["light", "lights", "lamp", "lamps"].contains(&self.at(index + 1));
            let running = (index + 2..index + 5).find(|&at| {
                ["running", "burning", "on", "lit"].contains(&self.at(at)) && self.noun_before(at).is_some()
            });
            if opens && self.at(index) == "no" && lights && self.is_mark(index + 2) {
                self.say(index + 2, index + 2, &["should", "be", "on"]);
            } else if let Some(running) =
                running.filter(|&at| opens && self.at(index) == "no" && self.is_mark(at + 1))
            {
                // "no microwave running"
                self.say(running, running + 1, &["should", "be", "on"]);
            }
            index += 1;
        }
    }

    /// "with the stove left cold", ", the stove going cold": the stove cold.
    pub(super) fn left_so(&mut self) {
        for index in 1..self.tokens.len() {
            let start = self.clause_start(index);
            let with = (start..index).any(|at| self.at(at) == "with");
            let first = start + usize::from(self.at(start) == "and");
            let alone = start > 0 && self.names_only(first, index);
            let length = match (self.at(index), self.at(index + 1)) {
                ("having", "been") => 2,
                ("left" | "kept" | "going" | "being" | "staying", _) => 1,
                _ => 0,
            };
            let state = self.lexicon.adjective(&[self.at(index + length)]).is_some();
            // "with the tap not running"
            let denied = match self.at(index + 1) {
                "running" | "on" | "lit" | "burning" => "off",
                "open" => "closed",
                "closed" | "shut" => "open",
                "dirty" => "clean",
                _ => "",
            };
            if self.at(index) == "not"
                && !denied.is_empty()
                && (with || alone)
                && self.noun_before(index).is_some()
            {
                self.say(index, index + 2, &[denied]);
            }
            if length > 0 && (with || alone) && state && self.noun_before(index).is_some() {
                self.say(index, index + length, &[]);
            }
        }
    }

    /// "… with a slice of bread, a fork and a cup on it": those are put on it.
    pub(super) fn laden_with(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &["."]);
            let it = (index + 1..end)
                .find(|&at| ["on", "in", "inside"].contains(&self.at(at)) && self.at(at + 1) == "it");
            let listed = it.is_some_and(|it| {
                (index + 1..it).any(|at| [",", "and"].contains(&self.at(at)))
                    && !(index + 1..it).any(|at| self.is_order(at) || SHALL.contains(&self.at(at)))
            });
            let ordered = self.is_order(self.sentence_start(index));
            if self.at(index) == "with"
                && self.at(index - 1) != ","
                && is_determiner(self.at(index + 1))
                && listed
                && ordered
                && it.is_some_and(|it| self.is_mark(it + 2) && self.noun_before(it).is_some())
            {
                self.say(index, index + 1, &[".", "put"]);
            }
            index += 1;
        }
    }

    /// Where the states begin in what stands between the commas of a range; none where something else is said.
    fn notes(&self, start: usize, end: usize) -> Vec<Option<usize>> {
        let mut notes = Vec::new();
        let mut from = start;
        while from < end {
            let comma = self.next_mark(from, &[","]).min(end);
            let first = from + usize::from(self.at(from) == "and");
            notes.push(self.note(first, comma));
            from = comma + 1;
        }
        notes
    }

    /// Where the state of a note begins: behind the thing that it begins with.
    fn note(&self, start: usize, end: usize) -> Option<usize> {
        let said = |word: &str| SHALL.contains(&word) || is_going(word) || word == "to";
        if self.is_base_verb(start) && self.noun_from(start).is_none()
            || (start..end).any(|at| said(self.at(at)))
        {
            return None;
        }
        let mut at = start;
        while at < end {
            let adjective = self.lexicon.adjective(&[self.at(at)]).is_some();
            if let Some(length) = self.noun_from(at) {
                at += length;
                break;
            }
            if !is_determiner(self.at(at))
                && !adjective
                && !self.lexicon.is_small("modifiers", &[self.at(at)])
            {
                return None;
            }
            at += 1;
        }
        let state = self.lexicon.adjective(&[self.at(at)]).is_some()
            || self.lexicon.adjective(&[self.at(at), self.at(at + 1)]).is_some()
            || self.is_participle(at);
        let place = PLACES.contains(&self.at(at));
        (at < end && at > start && (state || place)).then_some(at)
    }

    /// How many words the noun has that begins here.
    pub(super) fn noun_from(&self, at: usize) -> Option<usize> {
        (1..=super::LONGEST).rev().find(|&length| {
            let words = self.words(at..at + length);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            self.lexicon.noun(&words).is_some()
                || matches!(words.as_slice(), ["slices" | "pieces" | "coffee" | "water" | "wine"])
        })
    }

    /// "make it dark, and the mug should be washed": two sentences, where the first says something of its own.
    pub(super) fn sentences_apart(&mut self) {
        const OPENS: [&str; 9] =
            ["if", "unless", "when", "once", "while", "before", "after", "until", "whilst"];
        let mut index = 2;
        while index < self.tokens.len() {
            let comma = self.at(index) == ",";
            let next = index + 1 + usize::from(comma && self.at(index + 1) == "and");
            let joins = comma || self.at(index) == "and";
            let shall = (next + 2..next + 9).find(|&at| {
                SHALL[..3].contains(&self.at(at)) || is_going(self.at(at)) && self.is_place(at + 1)
            });
            let start = self.sentence_start(index);
            let subject = shall.is_some_and(|shall| {
                is_determiner(self.at(next))
                    && self.names_only(next, shall)
                    && (comma || !(next..shall).any(|at| [",", "and"].contains(&self.at(at))))
            });
            let part = self.clause_start(index);
            let first = (part..index)
                .find(|&at| !["and", "then", "also", "please", "could", "you"].contains(&self.at(at)));
            // "the paper is trash, and the pen goes in the drawer"
            let told = first.is_some_and(|first| {
                let is = (first..index).find(|&at| ["is", "are"].contains(&self.at(at)));
                is.is_some_and(|is| is > first && self.at(is + 1) != "to" && self.names_only(first, is))
            });
            let said = told
                || (part..index).any(|at| SHALL[..3].contains(&self.at(at)))
                || first.is_some_and(|first| self.is_order(first));
            let sure = (start..index).any(|at| ["sure", "ensure", "that"].contains(&self.at(at)));
            let opens = (start..index).any(|at| OPENS.contains(&self.at(at)));
            if joins && subject && said && !opens && !sure {
                self.say(index, next, &["."]);
            }
            index += 1;
        }
    }
}
