//! Telegrams and slips of people in a hurry, or of those who speak another language: "tv on lights off", "laptop close",
//! "adn put on stove".

use super::Rewriting;
use crate::offline::syntax::is_determiner;

/// What is often typed for another word, and no slip of a letter that spelling mends.
const TYPED_FOR: [(&str, &str); 12] = [
    ("teh", "the"),
    ("hte", "the"),
    ("adn", "and"),
    ("nad", "and"),
    ("wiht", "with"),
    ("tehn", "then"),
    ("thne", "then"),
    ("bothe", "both"),
    ("bith", "both"),
    ("thier", "their"),
    ("besides", "beside"),
    ("unto", "onto"),
];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn terse(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.typed_for(index);
            self.apart_by_states(index);
            let _ = self.close_behind(index)
                || self.make_full(index)
                || self.held_to_be_filled(index)
                || self.waits_till_full(index)
                || self.stands_there(index)
                || self.no_more(index)
                || self.put_it_on_the_stove(index)
                || self.would_be_happy(index);
            index += 1;
        }
    }

    /// "teh mug", "go to the counter an lay it down, than get the towel"
    fn typed_for(&mut self, index: usize) {
        let word = self.at(index);
        if let Some((_, meant)) = TYPED_FOR.iter().find(|(typed, _)| *typed == word) {
            let thing =
                is_determiner(self.at(index + 1)) || self.lexicon.noun(&[self.at(index + 1)]).is_some();
            if *meant != "beside" || thing {
                self.say(index, index + 1, &[meant]);
            }
        } else if word == "an"
            && self.is_order(index + 1)
            && !self.at(index + 1).starts_with(['a', 'e', 'i', 'o', 'u'])
        {
            self.say(index, index + 1, &["and"]);
        } else if word == "than"
            && index > 0
            && [",", ".", "and"].contains(&self.at(index - 1))
            && self.is_order(index + 1)
        {
            self.say(index, index + 1, &["then"]);
        }
    }

    /// "tv on lights off": two parts.
    fn apart_by_states(&mut self, index: usize) {
        const STATES: [&str; 7] = ["on", "off", "out", "open", "closed", "shut", "clean"];
        let state = STATES.contains(&self.at(index)) && index > 0;
        let start = self.clause_start(index);
        let joined = self.is_mark(index + 1) || self.at(index + 1) == "and";
        if !state || joined || !self.names_only(start, index) {
            return;
        }
        let next = (index + 2..index + 5).find(|&at| STATES.contains(&self.at(at)));
        let ends = |at: usize| {
            self.is_mark(at + 1)
                || ["and", "please"].contains(&self.at(at + 1))
                || self.lexicon.noun(&[self.at(at + 1)]).is_some()
        };
        if next.is_some_and(|next| self.names_only(index + 1, next) && ends(next)) {
            self.say(index + 1, index + 1, &[","]);
        }
    }

    /// "laptop close, phone to desk": close it.
    fn close_behind(&mut self, index: usize) -> bool {
        let start = self.clause_start(index);
        let verb = self.at(index) == "close" && self.is_mark(index + 1);
        if !verb || start == index || !self.names_only(start, index) {
            return false;
        }
        self.say(index, index + 1, &["closed"]);
        true
    }

    /// "make sure that the statue stands on the table": is there; no stand.
    fn stands_there(&mut self, index: usize) -> bool {
        let stands =
            ["stands", "sits", "lies", "rests"].contains(&self.at(index)) && self.is_place(index + 1);
        let start = self.sentence_start(index);
        let wished = (start..index).any(|at| ["that", "sure", "ensure"].contains(&self.at(at)));
        if stands && (wished || self.at(index) == "stands") && self.noun_before(index).is_some() {
            self.say(index, index + 1, &["is"]);
            return true;
        }
        // "… and that the watch is kept on the dresser"
        let sure = (start..index).any(|at| ["sure", "ensure", "check", "see"].contains(&self.at(at)));
        if sure && self.starts(index, &["and", "that"]) && is_determiner(self.at(index + 2)) {
            self.say(index, index + 2, &[".", "make", "sure", "that"]);
            return true;
        }
        false
    }

    /// "fill the kettle and put on stove": put it there.
    fn put_it_on_the_stove(&mut self, index: usize) -> bool {
        let goes_on = index > 0 && [",", "and", "then"].contains(&self.at(index - 1));
        let stove = ["stove", "hob", "burner", "cooker"].contains(&self.at(index + 2));
        if !goes_on || !stove || !self.starts(index, &["put", "on"]) {
            return false;
        }
        self.say(index + 1, index + 1, &["it"]);
        true
    }
}
