//! Orders in the short forms of a hurry: "the plate put on the table", "then light off", "when cooked put on plate".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::inflect::number;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "once the tomato has been sliced and the slices have been put on the plate": they should be put there; "then light
    /// off": the light is turned off.
    pub(super) fn hasty_parts(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let length = self.noun_before(index).map_or(0, |noun| noun.len());
            let first = if length > 0 { self.with_determiner(index - length) } else { index };
            let before = if first > 0 { self.at(first - 1) } else { "" };
            let slices = self.starts(index.saturating_sub(3), &["and", "the", "slices"]);
            let start = self.sentence_start(index);
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
            } else if length > 0
                && first < index - length
                && (first == 0 || [",", ".", "and", "then", "afterwards"].contains(&before))
                && ["is", "are"].contains(&self.at(index))
                && ["put", "placed", "served", "brought", "moved"].contains(&self.at(index + 1))
                && self.is_place(index + 2)
                && !["if", "when", "once", "after", "while"].contains(&self.at(start))
            {
                // "afterwards the egg is served on the plate": told as it shall be.
                self.say(index, index + 1, &["should", "be"]);
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
                let mut order = vec!["turn".to_owned(), self.at(index).to_owned()];
                order.extend(self.words(first..index));
                self.say_all(first, index + 1, &order);
            }
            index += 1;
        }
    }

    /// "a slice goes in the toaster": put it there; "when cooked put on plate": then put it there; "into the fridge with the
    /// egg": put it there; "the mug then goes …": it goes there.
    pub(super) fn orders_in_disguise(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = self.opens_part(index);
            let sliced = ["slice", "slices", "piece", "pieces"].contains(&self.at(index + 1));
            let counted = is_determiner(self.at(index)) || number(self.at(index)).is_some();
            if opens && counted && sliced && is_going(self.at(index + 2)) && self.is_place(index + 3) {
                self.say(index + 2, index + 3, &[]);
                self.say(index, index, &["put"]);
            } else if opens
                && ["when", "once", "after"].contains(&self.at(index))
                && (self.is_participle(index + 1) || self.lexicon.adjective(&[self.at(index + 1)]).is_some())
                && self.is_order(index + 2)
            {
                self.say(index, index + 2, &["then"]);
            } else if (index == 0 || self.at(index - 1) == "." || self.tokens[index - 1].typed == ":")
                && ["into", "onto"].contains(&self.at(index))
                && is_determiner(self.at(index + 1))
                && let Some(with) = (index + 3..index + 6).find(|&at| self.at(at) == "with")
                && self.noun_before(with).is_some()
                && (is_determiner(self.at(with + 1)) || ["it", "them"].contains(&self.at(with + 1)))
            {
                let end = self.next_mark(with, &[",", "."]);
                let mut order = vec!["put".to_owned()];
                order.extend(self.words(with + 1..end));
                order.extend(self.words(index..with));
                self.say_all(index, end, &order);
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
