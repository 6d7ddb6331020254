//! What is not meant: "apart from the fork", "…, except the bread".

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

/// Other words for "except".
const EXCEPT: [&[&str]; 11] = [
    &["apart", "from"],
    &["aside", "from"],
    &["except", "for"],
    &["excepting"],
    &["excluding"],
    &["with", "the", "exception", "of"],
    &["not", "including"],
    &["not", "counting"],
    &["save", "for"],
    &["bar", "the"],
    &["minus", "the"],
];

/// Words that mean every one of what follows.
const ALL: [&str; 7] = ["everything", "all", "every", "anything", "each", "any", "both"];

impl Rewriting<'_> {
    /// "apart from the fork", "everything but the fork"
    pub(super) fn exceptions(&mut self) {
        for index in 0..self.tokens.len() {
            let said = self.one_of(index, &EXCEPT);
            if let Some(length) = said {
                let article = usize::from(["bar", "minus"].contains(&self.at(index)));
                self.say(index, index + length - article, &["except"]);
            } else if self.at(index) == "but" && is_determiner(self.at(index + 1)) {
                let before = (index.saturating_sub(LONGEST_ASIDE)..index).rev();
                let all =
                    before.take_while(|&at| !self.is_mark(at)).any(|at| ALL[..4].contains(&self.at(at)));
                if all {
                    self.say(index, index + 1, &["except"]);
                }
            } else if self.starts(index, &["but", "not"])
                && is_determiner(self.at(index + 2))
                && self.all_before(index).is_some()
                && self.noun_before(self.next_mark(index, &[",", "."])).is_some()
            {
                self.say(index, index + 2, &["except"]);
            }
        }
    }

    /// "all the food goes in the fridge, except the bread": all the food except the bread goes there.
    pub(super) fn exceptions_said_last(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let comma = usize::from(self.at(index - 1) == ",");
            let said = index - comma;
            let end = self.next_mark(index, &[",", "."]);
            let all = self.all_before(index).filter(|_| self.at(index) == "except");
            let plain = self.noun_before(end).is_some()
                && !(index + 1..end)
                    .any(|at| SHALL.contains(&self.at(at)) || is_going(self.at(at)) || self.is_place(at));
            if let (Some(all), true) = (all.and_then(|all| self.end_of_all(all, said)), plain)
                && all < said
            {
                let exception = self.words(index..end);
                self.say(said, end, &[]);
                self.say_all(all, all, &exception);
            }
            index += 1;
        }
    }

    /// Where the word of the same sentence stands that says that all are meant, or the article of a class of things:
    /// "the cutlery".
    fn all_before(&self, index: usize) -> Option<usize> {
        let start = self.sentence_start(index);
        let class = |at: &usize| {
            self.at(*at) == "the" && self.lexicon.noun(&[self.at(at + 1)]).is_some_and(|(noun, _)| noun.class)
        };
        (start..index)
            .rev()
            .find(|&at| ALL.contains(&self.at(at)))
            .or_else(|| (start..index).rev().filter(|at| at + 1 < index).find(class))
    }

    /// What is left out of all that is spoken of, in whatever words.
    pub(super) fn left_out(&mut self) {
        for index in 0..self.tokens.len() {
            self.left_where_it_is(index);
            self.about_the_exception(index);
        }
    }

    /// "all the fruit in the bowl but leave the apple where it is": except the apple.
    fn left_where_it_is(&mut self, index: usize) -> bool {
        const STAYS: [&[&str]; 6] = [
            &["where", "it", "is"],
            &["where", "they", "are"],
            &["alone"],
            &["out"],
            &["there"],
            &["as", "it", "is"],
        ];
        let leaves = self.at(index) == "but" && ["leave", "keep"].contains(&self.at(index + 1));
        let end = self.next_mark(index, &[",", "."]);
        let stays = (index + 3..end).find(|&at| {
            self.one_of(at, &STAYS).is_some_and(|length| at + length == end) && self.names_only(index + 2, at)
        });
        let Some(stays) = stays.filter(|_| leaves && self.all_before(index).is_some()) else { return false };
        self.say(stays, end, &[]);
        self.say(index, index + 2, &["except"]);
        true
    }

    /// Where what a word for all is said of ends: before what it should do, else behind its noun.
    fn end_of_all(&self, all: usize, end: usize) -> Option<usize> {
        let does = (all + 1..end).find(|&at| {
            (SHALL.contains(&self.at(at)) || is_going(self.at(at)))
                && !["that", "which"].contains(&self.at(at - 1))
        });
        let ordered = self.is_order(self.clause_start(all));
        if let Some(does) = does.filter(|_| !ordered) {
            return Some(does);
        }
        if ["everything", "anything"].contains(&self.at(all)) {
            return Some(all + 1);
        }
        (all + 2..end.min(all + LONGEST_ASIDE))
            .find(|&at| self.noun_before(at).is_some() && self.lexicon.noun(&[self.at(at)]).is_none())
    }

    /// "except the mug, which should be full", "except the mug. Fill it": the mug.
    fn about_the_exception(&mut self, index: usize) {
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
