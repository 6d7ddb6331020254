//! What is said in pieces: sentences without a verb, marks between a thing and its state, places that need things.

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "Bin the egg. Also the apple.": the apple too.
    pub(super) fn additions(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let joins = ["also", "and", "plus"].contains(&self.at(index));
            let end = self.next_mark(index + 1, &[",", "."]);
            let plain = (index + 1..end).all(|at| {
                let word = self.at(at);
                !is_going(word) && !SHALL.contains(&word) && !self.is_place(at)
            });
            if self.at(index - 1) == "."
                && joins
                && is_determiner(self.at(index + 1))
                && plain
                && end - index <= LONGEST_ASIDE
                && self.noun_before(end).is_some()
            {
                self.say(index - 1, index + 1, &[","]);
            }
            index += 1;
        }
    }

    /// "the lamp: off", "the pillow: on the bed": no mark between a thing and what it shall be; "the tomato, also cut":
    /// the cut tomato.
    pub(super) fn states_behind_marks(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let noun = self.noun_before(index).map_or(0, |noun| noun.len());
            let next = self.at(index + 1);
            let state = self.lexicon.adjective(&[next]).is_some();
            let colon = self.tokens[index].typed == ":";
            if colon && noun > 0 && (state && self.is_mark(index + 2) || self.is_place(index + 1)) {
                self.say(index, index + 1, &[]);
            } else if self.at(index) == ","
                && noun > 0
                && next == "also"
                && self.lexicon.adjective(&[self.at(index + 2)]).is_some()
                && self.is_mark(index + 3)
            {
                let state = self.at(index + 2).to_owned();
                self.say(index, index + 3, &[]);
                self.say(index - noun, index - noun, &[&state]);
            }
            index += 1;
        }
    }

    /// "the table needs a plate and a fork on it": those should be on the table.
    pub(super) fn places_in_need(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let length = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
                ("has" | "needs", "to", "have") => 3,
                ("should" | "must" | "shall", "have", _) => 2,
                ("needs" | "need" | "wants", _, _) => 1,
                _ => 0,
            };
            let noun = self.noun_before(index).map_or(0, |noun| noun.len());
            let first = index.saturating_sub(noun + 1);
            let end = self.next_mark(index, &["."]);
            let back = (index + length + 1..end)
                .find(|&at| ["on", "in", "inside"].contains(&self.at(at)) && self.at(at + 1) == "it");
            let opens = first == 0
                || self.is_mark(first - 1)
                || ["and", "then", "while", "before", "that"].contains(&self.at(first - 1));
            let plain =
                back.is_some_and(|back| !(index + length..back).any(|at| SHALL.contains(&self.at(at))));
            if let (true, Some(back)) = (length > 0 && noun > 0 && opens && plain, back)
                && is_determiner(self.at(first))
                && is_determiner(self.at(index + length))
            {
                let place = self.words(first..index);
                let joint = self.at(back).to_owned();
                let mut said: Vec<&str> = vec!["should", "be", &joint];
                said.extend(place.iter().map(String::as_str));
                self.say(back, back + 2, &said);
                self.say(first, index + length, &[]);
            }
            index += 1;
        }
    }

    /// "for breakfast, fry …", "while leaving the cup there", "a different one", "turn of the lamp", "no tap may run"
    pub(super) fn loose_words(&mut self) {
        const MEALS: [&str; 6] = ["breakfast", "lunch", "dinner", "supper", "tea", "brunch"];
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || self.at(index - 1) == ".";
            let end = self.next_mark(index, &[",", "."]);
            let clears = self.at(index) == "clear"
                && (opens || self.is_mark(index - 1) || self.at(index - 1) == "and");
            if opens
                && self.at(index) == "for"
                && MEALS.contains(&self.at(end - 1))
                && self.at(end) == ","
                && end - index < 4
                && !self.lexicon.verbs(self.at(end + 1)).is_empty()
            {
                self.say(index, end + 1, &[]);
            } else if index > 0
                && self.at(index) == "while"
                && ["leaving", "keeping"].contains(&self.at(index + 1))
            {
                let last = self.at(end - 1);
                if ["is", "are", "there", "alone", "untouched", "place"].contains(&last) {
                    self.say(index, end, &[]);
                }
            } else if self.starts(index, &["while", "youre", "at", "it"]) {
                self.say(index, index + 4, &[]);
            } else if index > 1
                && self.starts(index, &["a", "little"])
                && (self.is_mark(index + 2) || ["for", "before", "and", "so"].contains(&self.at(index + 2)))
            {
                self.say(index, index + 2, &[]);
            } else if self.starts(index, &["a", "different", "one"]) {
                self.say(index, index + 2, &["another"]);
            } else if ["turn", "switch", "shut"].contains(&self.at(index)) && self.at(index + 1) == "of" {
                self.say(index + 1, index + 2, &["off"]);
            } else if SHALL.contains(&self.at(index))
                && ["run", "burn"].contains(&self.at(index + 1))
                && self.is_mark(index + 2)
            {
                self.say(index + 1, index + 2, &["be", "on"]);
            } else if clears
                && (index..self.next_mark(index, &["."])).any(|at| self.at(at) == "from")
                && (index..self.next_mark(index, &["."])).any(|at| ["to", "into"].contains(&self.at(at)))
            {
                self.say(index, index + 1, &["move"]);
            } else if clears
                && let Some(of) = (index + 2..index + 6).find(|&at| self.at(at) == "of")
                && is_determiner(self.at(index + 1))
                && self.noun_before(of).is_some()
                && self.names_only(of + 1, end)
            {
                // "clear the table of all food"
                let table = self.words(index + 1..of);
                self.say_all(end, end, &table);
                self.say(end, end, &["from"]);
                self.say(index + 1, of + 1, &[]);
            } else if self.at(index) == "where"
                && ["does", "do"].contains(&self.at(index + 1))
                && ["go", "belong", "live"].contains(&self.at(end - 1))
                && end > index + 3
            {
                self.say(end - 1, end, &[]);
                self.say(index, index + 2, &["put", "away"]);
            } else if ["needs", "need"].contains(&self.at(index))
                && self.at(index + 1) == "a"
                && ["bath", "shower", "rinse", "scrub", "clean", "cleaning", "dip"]
                    .contains(&self.at(index + 2))
                && index > 1
                && is_determiner(self.at(0))
            {
                self.say(index + 2, index + 3, &["wash"]);
            }
            index += 1;
        }
    }
}
