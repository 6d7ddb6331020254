//! Who is to do it, where that changes nothing of what is to be done: "would somebody please …", "have another robot …".

use super::Rewriting;
use crate::offline::clause::is_going;
use crate::offline::inflect::VerbForm;
use crate::offline::syntax::is_determiner;

/// Somebody, and no matter who.
const SOMEBODY: [&[&str]; 26] = [
    &["somebody", "else"],
    &["someone", "else"],
    &["somebody"],
    &["someone"],
    &["anybody"],
    &["anyone"],
    &["one", "of", "you"],
    &["one", "of", "the", "robots"],
    &["the", "others"],
    &["a", "second", "one"],
    &["a", "third", "one"],
    &["another", "of", "you"],
    &["another", "robot"],
    &["one", "robot"],
    &["a", "robot"],
    &["the", "other", "robot"],
    &["a", "second", "robot"],
    &["a", "third", "robot"],
    &["another", "person"],
    &["one", "person"],
    &["a", "first", "person"],
    &["a", "second", "person"],
    &["a", "third", "person"],
    &["a", "fourth", "person"],
    &["the", "second", "person"],
    &["the", "third", "person"],
];

/// One of several who do something.
const ONE_OF_SEVERAL: [&[&str]; 15] = [
    &["the", "rest"],
    &["the", "first"],
    &["the", "second"],
    &["the", "third"],
    &["the", "fourth"],
    &["the", "last"],
    &["the", "next"],
    &["the", "other"],
    &["the", "others"],
    &["another"],
    &["someone", "else"],
    &["somebody", "else"],
    &["a", "second"],
    &["a", "third"],
    &["one"],
];

impl Rewriting<'_> {
    /// Leaves out who does it where an order follows.
    pub(super) fn people(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens =
                index == 0 || [",", ".", "and", "while", "then", "that"].contains(&self.at(index - 1));
            if opens && let Some(length) = self.names_somebody(index) {
                self.say(index, index + length, &[]);
            }
            index += 1;
        }
    }

    /// "the first of you slices the bread", "whichever of you is free should cool it": slice it, cool it.
    pub(super) fn doers(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens =
                index == 0 || [",", ".", "and", "while", "whilst", "then"].contains(&self.at(index - 1));
            let Some(who) = self.doer(index).filter(|_| opens) else {
                index += 1;
                continue;
            };
            let verb = index + who;
            let ordered = ["should", "must", "can", "could", "will", "shall", "to"].contains(&self.at(verb))
                && self.is_base_verb(verb + 1)
                && !is_going(self.at(verb + 1));
            if ordered {
                self.say(index, verb + 1, &[]);
            } else if ["others", "rest"].contains(&self.at(verb - 1))
                && self.is_order(verb)
                && is_determiner(self.at(verb + 1))
            {
                self.say(index, verb, &[]);
            } else if let Some(base) = self.done_by_somebody(verb) {
                self.say(index, verb + 1, &[&base]);
            }
            index += 1;
        }
    }

    /// How many words name one of several who do something.
    fn doer(&self, index: usize) -> Option<usize> {
        if ["whoever", "whichever"].contains(&self.at(index)) {
            let shall = (index + 1..index + 9)
                .find(|&at| ["should", "must", "can", "shall", "could"].contains(&self.at(at)));
            return shall.map(|at| at - index);
        }
        let who = self.one_of(index, &ONE_OF_SEVERAL)?;
        let of = match (self.at(index + who), self.at(index + who + 1), self.at(index + who + 2)) {
            ("of", "you" | "us" | "them", _) => 2,
            ("of", "the", "robots" | "team" | "others") => 3,
            _ => 0,
        };
        Some(who + of)
    }

    /// "slices (the bread)": the verb as an order, where somebody is said to do it to something.
    fn done_by_somebody(&self, verb: usize) -> Option<String> {
        let word = self.at(verb);
        let next = self.at(verb + 1);
        let done_to = is_determiner(next)
            || ["it", "them", "on", "off", "both"].contains(&next)
            || word == "sees" && next == "to";
        // "the other gets the pillow" is said of a thing.
        let takes = ["gets", "needs", "wants", "takes", "holds", "contains", "is", "has", "was", "does"];
        let carried = word == "takes"
            && (verb..self.next_mark(verb, &[",", "."])).any(|at| ["to", "into"].contains(&self.at(at)));
        let takes = takes.contains(&word) && !carried;
        if !word.ends_with('s') || is_going(word) || takes || !done_to {
            return None;
        }
        let stems = [word.strip_suffix("es"), word.strip_suffix('s')];
        let is_verb =
            |stem: &&str| self.lexicon.verbs(stem).iter().any(|(form, _, _)| *form == VerbForm::Base);
        stems.into_iter().flatten().rfind(is_verb).map(str::to_owned)
    }

    /// How many words say before an order that somebody does it.
    fn names_somebody(&self, index: usize) -> Option<usize> {
        let asks =
            ["would", "could", "can", "will", "have", "let", "get", "ask", "tell"].contains(&self.at(index));
        let start = index + usize::from(asks);
        let who = self.one_of(start, &SOMEBODY)?;
        let person = ["person", "robots", "others"].contains(&self.at(start + who - 1));
        let mut end = start + who;
        let shall = ["should", "must", "can", "could", "will", "to", "shall"].contains(&self.at(end));
        end += usize::from(shall);
        end += usize::from(["please", "kindly"].contains(&self.at(end)));
        ((asks || person && shall) && self.is_base_verb(end)).then_some(end - index)
    }
}
