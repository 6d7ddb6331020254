//! Lights and switches in everyday words, and what is said of an exception.

use super::Rewriting;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "… and finally a dark kitchen", "do without the lamp", "the lamp to shine": lights off, off, on.
    pub(super) fn dark_room(&mut self, index: usize) {
        let dark = self.at(index) == "a" && self.at(index + 1) == "dark";
        let room = self.lexicon.is_small("rooms", &[self.at(index + 2)]);
        let without = self.starts(index, &["do", "without"]);
        // "while the toaster runs", "put the toaster in operation"
        let runs = ["runs", "run"].contains(&self.at(index))
            && index > 1
            && self.at(self.clause_start(index)) == "while"
            && self.noun_before(index).is_some();
        if runs && self.is_mark(index + 1) {
            self.say(index, index + 1, &["is", "running"]);
        }
        let throws = ["throw", "drop", "bring"].contains(&self.at(index)) && self.opens_part(index);
        let lights = (index + 1..index + 5)
            .find(|&at| ["lights", "light"].contains(&self.at(at)) && !self.is_place(at + 1));
        let off = usize::from(self.at(index + 1) == "off");
        if let Some(light) = lights.filter(|&light| throws && self.names_only(index + 1 + off, light + 1)) {
            let down = usize::from(self.at(light + 1) == "down");
            if off + down > 0 || self.at(index) == "drop" {
                self.say(light + 1, light + 1 + down, &[]);
                self.say(index, index + 1 + off, &["turn", "off"]);
            }
        }
        if self.starts(index, &["in", "operation"]) || self.starts(index, &["into", "operation"]) {
            let start = self.clause_start(index);
            let order = (start..index).find(|&at| ["put", "place", "set", "bring"].contains(&self.at(at)));
            if let Some(order) = order.filter(|&order| self.names_only(order + 1, index)) {
                self.say(index, index + 2, &[]);
                self.say(order, order + 1, &["turn", "on"]);
                return;
            }
        }
        let shine = ["shine", "glow", "burn"].contains(&self.at(index + 1)) && self.at(index) == "to";
        if dark && room && index > 0 && self.is_mark(index + 3) {
            self.say(index, index + 3, &["the", "lights", "off"]);
        } else if without && (is_determiner(self.at(index + 2)) || self.at(index + 2) == "both") {
            self.say(index, index + 2, &["turn", "off"]);
        } else if shine && index > 0 && self.noun_before(index).is_some() && self.is_mark(index + 2) {
            self.say(index + 1, index + 2, &["be", "on"]);
        }
    }

    /// "except the mug, which should be full", "except the mug. Fill it": the mug.
    pub(super) fn about_the_exception(&mut self, index: usize) {
        if self.at(index) != "except" {
            return;
        }
        let first = index + 1 + usize::from(self.at(index + 1) == "for");
        let end = self.next_mark(first, &[",", "."]);
        if end == first || !is_determiner(self.at(first)) || !self.names_only(first, end) {
            return;
        }
        let said = self.words(first..end);
        let next = end + 1;
        let it = (next..next + 4).find(|&at| self.at(at) == "it");
        if self.at(end) == "," && self.at(next) == "which" {
            self.say_all(next, next + 1, &said);
            self.say(end, next, &["."]);
        } else if let Some(it) = it.filter(|_| self.at(end) == "." && self.is_order(next)) {
            self.say_all(it, it + 1, &said);
        }
    }
}
