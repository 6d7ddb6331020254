//! What is to be done only if something holds: "if the lamp is off turn it on", "unless it is clean already".

use super::{LONGEST_ASIDE, Rewriting};
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "if the lamp is off turn it on": what holds, and then what is to be done.
    pub(super) fn conditions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let is =
                (index + 1..end.min(index + LONGEST_ASIDE)).find(|&at| ["is", "are"].contains(&self.at(at)));
            if let Some(is) = is.filter(|_| self.at(index) == "if") {
                let state = is + 1 + usize::from(self.at(is + 1) == "not");
                let next = self.at(state + 2);
                let ordered = self.lexicon.adjective(&[self.at(state)]).is_some()
                    && self.is_base_verb(state + 1)
                    && (is_determiner(next) || ["it", "them"].contains(&next));
                if ordered {
                    self.say(state + 1, state + 1, &[","]);
                }
            }
            // "wash it if it is dirty, otherwise …": the condition first.
            let otherwise = self.at(end) == "," && ["otherwise", "else"].contains(&self.at(end + 1));
            if self.at(index) == "if" && index > 0 && !self.is_mark(index - 1) && otherwise {
                let start = self.clause_start(index);
                let condition = self.words(index..end);
                let mut condition: Vec<&str> = condition.iter().map(String::as_str).collect();
                condition.push(",");
                let thing = self.words(start + 1..index);
                let named = thing.first().is_some_and(|word| is_determiner(word));
                if named && condition.get(1) == Some(&"it") {
                    let is = usize::from(condition.get(2) != Some(&"is"));
                    let is: &[&str] = if is == 1 { &["is"] } else { &[] };
                    condition.splice(1..2, thing.iter().map(String::as_str).chain(is.iter().copied()));
                    self.say(start + 1, end, &["it"]);
                } else {
                    if condition.get(1) == Some(&"it") && condition.get(2) != Some(&"is") {
                        condition.insert(2, "is");
                    }
                    self.say(index, end, &[]);
                }
                self.say(start, start, &condition);
                index = start + condition.len();
            }
            index += 1;
        }
    }

    /// ", if it is dirty, wash it, otherwise …": a sentence of its own.
    pub(super) fn alternatives(&mut self) {
        for index in 1..self.tokens.len() {
            let closes = self.next_mark(index, &[",", "."]);
            let done = self.next_mark(closes + 1, &[",", "."]);
            let otherwise = ["otherwise", "else"].contains(&self.at(done + 1));
            if self.at(index) == "if" && self.at(index - 1) == "," && otherwise {
                self.say(index - 1, index, &["."]);
            }
        }
    }

    /// "unless the fridge is closed": if it is not.
    pub(super) fn exclusions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let is =
                (index + 1..end.min(index + LONGEST_ASIDE)).find(|&at| ["is", "are"].contains(&self.at(at)));
            if let Some(is) = is.filter(|&is| self.at(index) == "unless" && self.at(is + 1) != "not") {
                self.say(is + 1, is + 1, &["not"]);
                self.say(index, index + 1, &["if"]);
            }
            index += 1;
        }
    }

    /// "turn it on if it is not already", "unless it is clean already": as it shall be anyway.
    pub(super) fn needless_conditions(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]).min(self.tokens.len());
            let said: Vec<&str> = (index..end).map(|at| self.at(at)).collect();
            let comma = usize::from(self.at(index - 1) == ",");
            let (opening, rest) = match said.as_slice() {
                [opening @ ("if" | "unless"), "it" | "they", "is" | "are" | "has" | "have", rest @ ..]
                | [opening @ ("if" | "unless"), "it" | "theyre", rest @ ..] => (*opening, rest),
                ["if", rest @ ..] if rest.first() == Some(&"not") => ("if", rest),
                _ => ("", &[][..]),
            };
            let denied = rest.first() == Some(&"not");
            let already = rest.contains(&"already") || rest.contains(&"yet");
            let needless = rest.len() <= LONGEST_ASIDE
                && already
                && (opening == "if" && denied || opening == "unless" && !denied);
            if needless && !self.is_mark(index - 1 - comma) {
                self.say(index - comma, end, &[]);
            }
            index += 1;
        }
    }
}
