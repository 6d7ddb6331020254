//! Two things told apart without their names: "the apple and the egg … one … the other", "the first … the last".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::inflect;
use crate::offline::syntax::{is_determiner, preposition};

/// How far back the two are looked for, in words.
const REACH: usize = 28;

/// What gives something to what takes it: "one gets the pillow".
const RECEIVES: [&str; 6] = ["gets", "get", "needs", "need", "wants", "takes"];

impl Rewriting<'_> {
    /// "take the apple and the egg, put one in the fridge and the other in the bin": the former, the latter.
    pub(super) fn one_and_the_other(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let length = self.says_one(index);
            let other = length.and_then(|length| {
                let end = self.next_mark(index, &["."]).max((index + REACH).min(self.tokens.len()));
                (index + length..end).find(|&at| self.says_the_other(at).is_some())
            });
            if let (Some(length), Some(other)) = (length, other)
                && self.two_before(index)
            {
                let words = self.says_the_other(other).unwrap_or(2);
                self.say(other, other + words, &["the", "latter"]);
                self.say(index, index + length, &["the", "former"]);
                index = other;
            }
            index += 1;
        }
    }

    /// "one", "one of them": how many words, where they stand for a thing.
    fn says_one(&self, index: usize) -> Option<usize> {
        let of_them = ["of", "them"];
        let length = match self.at(index) {
            "one" if self.starts(index + 1, &of_them) => 3,
            "one" if !is_determiner(self.at(index - 1)) => 1,
            _ => return None,
        };
        self.ends_a_thing(index + length).then_some(length)
    }

    /// "the other", "the other one": how many words, where they stand for a thing.
    fn says_the_other(&self, index: usize) -> Option<usize> {
        let length = 2 + usize::from(self.at(index + 2) == "one");
        (self.starts(index, &["the", "other"]) && self.ends_a_thing(index + length)).then_some(length)
    }

    /// Whether what stands here goes on after a thing, so that the words before it are no part of a longer name.
    fn ends_a_thing(&self, at: usize) -> bool {
        let word = self.at(at);
        self.is_mark(at)
            || is_going(word)
            || SHALL.contains(&word)
            || RECEIVES.contains(&word)
            || preposition(&[word]).is_some_and(|_| word != "of")
            || ["and", "ends", "straight"].contains(&word)
    }

    /// Whether the last things named before a place are two joined by "and", each of its own name: of "two cups" the
    /// one and the other have a name already.
    fn two_before(&self, index: usize) -> bool {
        let from = index.saturating_sub(REACH);
        let joint = (from + 1..index).rev().find(|&at| {
            self.at(at) == "and"
                && self.noun_before(at).is_some()
                && (is_determiner(self.at(at + 1)) || self.lexicon.noun(&[self.at(at + 1)]).is_some())
        });
        let Some(joint) = joint else { return false };
        let length = self.noun_before(joint).map_or(0, |noun| noun.len());
        let first = self.with_determiner(joint - length);
        // "the cup, the plate and the fork": three.
        let listed = first > 0 && self.at(first - 1) == "," && self.noun_before(first - 1).is_some();
        let several = |at: usize| {
            inflect::number(self.at(at)).is_some_and(|number| number > 1)
                || self.lexicon.noun(&[self.at(at)]).is_some_and(|(_, plural)| plural)
        };
        !listed && !(joint + 1..index).any(several) && !(first..joint).any(several)
    }
}
