//! Words put in between that change nothing, and turns of phrase of a hurry: ", though,", "straight into the bin", "get
//! the mug ready on the counter".

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

/// Between commas they only link what is said to what was said.
const BETWEEN: [&[&str]; 7] = [
    &["though"],
    &["however"],
    &["in", "turn"],
    &["meanwhile"],
    &["of", "course"],
    &["as", "usual"],
    &["for", "its", "part"],
];

impl Rewriting<'_> {
    /// Leaves them out.
    pub(super) fn words_between(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let word = self.at(index).to_owned();
            if ["till", "til"].contains(&word.as_str()) {
                self.say(index, index + 1, &["until"]);
            } else if word == "," && index > 0 && self.noun_before(index).is_some() {
                let length = self.one_of(index + 1, &BETWEEN).unwrap_or(0);
                let end = self.next_mark(index + 1, &[",", "."]);
                let being = (index + 2..end).any(|at| self.at(at) == "being");
                if length > 0 && self.at(index + 1 + length) == "," {
                    self.say(index, index + 2 + length, &[]);
                } else if self.starts(index + 1, &["as", "opposed", "to"]) && self.at(end) == "," {
                    self.say(index, end + 1, &[]);
                } else if being && self.at(end) == "," && end - index <= LONGEST_ASIDE {
                    self.say(index, end, &[]);
                }
            } else if ["straight", "directly", "right"].contains(&word.as_str())
                && ["into", "in", "onto", "to"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
            } else if word == "ready"
                && index > 0
                && self.noun_before(index).is_some()
                && ["on", "in"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
                if let Some(get) = (index.saturating_sub(4)..index).rev().find(|&at| self.at(at) == "get") {
                    self.say(get, get + 1, &["put"]);
                }
            } else if self.starts(index, &["the", "following", "done"]) && self.at(index + 3) == "," {
                // "I need the following done: …"
                let start = (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1);
                self.say(start, index + 4, &[]);
                index = start;
                continue;
            } else if word == "down"
                && index > 1
                && ["wiped", "washed", "cleaned", "scrubbed", "dusted"].contains(&self.at(index - 1))
                && self.is_mark(index + 1)
            {
                self.say(index, index + 1, &[]);
            } else if ["wants", "want"].contains(&word.as_str())
                && index > 0
                && self.noun_before(index).is_some()
                && (self.starts(index + 1, &["to", "be"])
                    || self.at(index + 1).ends_with("ing")
                        && !self.lexicon.verbs(self.at(index + 1)).is_empty())
            {
                self.say(index, index + 1, &["needs"]);
            } else if self.starts(index, &["out", "with"])
                && is_determiner(self.at(index + 2))
                && (index == 0 || [",", ".", "and"].contains(&self.at(index - 1)))
            {
                self.say(index, index + 2, &["take", "out"]);
            }
            index += 1;
        }
    }

    /// "once the tomato has been sliced and the slices have been put on the plate": they should be put there; "then light
    /// off": the light is turned off.
    pub(super) fn hasty_parts(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let length = self.noun_before(index).map_or(0, |noun| noun.len());
            let first = index.saturating_sub(length);
            let first = first - usize::from(length > 0 && first > 0 && is_determiner(self.at(first - 1)));
            let before = if first > 0 { self.at(first - 1) } else { "" };
            let slices = self.starts(index.saturating_sub(3), &["and", "the", "slices"]);
            let start = (0..index).rev().find(|&at| self.at(at) == ".").map_or(0, |at| at + 1);
            let shall_be = (start..first).any(|at| {
                self.at(at) == "be"
                    && at > start
                    && (SHALL.contains(&self.at(at - 1)) || self.at(at - 1) == "to")
            });
            let behind = self.at(index + 1);
            if length > 0
                && [",", "and"].contains(&before)
                && shall_be
                && self.is_participle(index)
                && (self.is_place(index + 1) || ["away", "back", "out"].contains(&behind))
            {
                // "the cup is to be washed, the plate put on the table"
                self.say(index, index, &["should", "be"]);
                index += 2;
            } else if (length > 0 && before == "and" || slices)
                && ["has", "have"].contains(&self.at(index))
                && self.at(index + 1) == "been"
                && self.is_participle(index + 2)
            {
                self.say(index, index + 2, &["should", "be"]);
            } else if length > 0
                && before == "then"
                && ["on", "off"].contains(&self.at(index))
                && (self.is_mark(index + 1) || ["thx", "thanks", "please"].contains(&self.at(index + 1)))
            {
                let thing = self.words(first..index);
                let mut order = vec!["turn".to_owned(), self.at(index).to_owned()];
                order.extend(thing);
                let order: Vec<&str> = order.iter().map(String::as_str).collect();
                self.say(first, index + 1, &order);
            }
            index += 1;
        }
    }

    /// "a slice goes in the toaster": put it there; "when cooked put on plate": then put it there; "into the fridge with the
    /// egg": put it there; "the mug then goes …": it goes there.
    pub(super) fn orders_in_disguise(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and", "then"].contains(&self.at(index - 1));
            let sliced = ["slice", "slices", "piece", "pieces"].contains(&self.at(index + 1));
            let counted =
                is_determiner(self.at(index)) || crate::offline::inflect::number(self.at(index)).is_some();
            if opens && counted && sliced && is_going(self.at(index + 2)) && self.is_place(index + 3) {
                self.say(index + 2, index + 3, &[]);
                self.say(index, index, &["put"]);
            } else if opens
                && ["when", "once", "after"].contains(&self.at(index))
                && (self.is_participle(index + 1) || self.lexicon.adjective(&[self.at(index + 1)]).is_some())
                && self.is_order(index + 2)
            {
                self.say(index, index + 2, &["then"]);
            } else if (index == 0 || self.at(index - 1) == ".")
                && ["into", "onto"].contains(&self.at(index))
                && is_determiner(self.at(index + 1))
                && let Some(with) = (index + 3..index + 6).find(|&at| self.at(at) == "with")
                && self.noun_before(with).is_some()
                && is_determiner(self.at(with + 1))
            {
                let end = self.next_mark(with, &[",", "."]);
                let mut order = vec!["put".to_owned()];
                order.extend(self.words(with + 1..end));
                order.extend(self.words(index..with));
                let order: Vec<&str> = order.iter().map(String::as_str).collect();
                self.say(index, end, &order);
            } else if self.starts(index, &["and", "then"])
                && is_going(self.at(index + 2))
                && self.is_place(index + 3)
            {
                let it = if self.at(index + 2).ends_with('s') { "it" } else { "them" };
                self.say(index + 2, index + 3, &["put", it]);
            } else if self.at(index) == "then"
                && index > 0
                && is_going(self.at(index + 1))
                && self.noun_before(index).is_some()
            {
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
    }
}
