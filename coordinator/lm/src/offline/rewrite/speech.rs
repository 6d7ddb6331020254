//! What is corrected, left open or added in speaking: "I mean …", "I don't care which", "and nothing else".

use super::super::inflect;
use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::syntax::{is_determiner, preposition};

/// Said of what comes before, and of no consequence.
const EMPTY: [&[&str]; 32] = [
    &["within", "reach"],
    &["within", "easy", "reach"],
    &["in", "that", "order"],
    &["in", "this", "order"],
    &["upside", "down"],
    &["while", "youre", "there"],
    &["while", "you", "are", "there"],
    &["while", "youre", "about", "it"],
    &["while", "you", "are", "about", "it"],
    &["i", "dont", "care", "which"],
    &["it", "doesnt", "matter", "which"],
    &["no", "matter", "which"],
    &["whichever", "you", "like"],
    &["but", "nothing", "else"],
    &["and", "thats", "it"],
    &["thats", "it"],
    &["thats", "all"],
    &["all", "together"],
    &["altogether"],
    &["half", "way"],
    &["halfway"],
    &["part", "way"],
    &["all", "the", "way"],
    &["a", "little", "bit"],
    &["while", "you", "do", "that"],
    &["while", "you", "do", "this"],
    &["while", "doing", "that"],
    &["while", "doing", "so"],
    &["let", "someone", "else"],
    &["let", "somebody", "else"],
    &["have", "someone", "else"],
    &["have", "somebody", "else"],
];

const CORRECTIONS: [&[&str]; 9] = [
    &["no", "wait", "i", "mean"],
    &["sorry", "i", "mean"],
    &["no", "i", "mean"],
    &["i", "mean"],
    &["i", "meant"],
    &["or", "rather"],
    &["make", "that"],
    &["no", "make", "that"],
    &["no", "sorry"],
];

impl Rewriting<'_> {
    /// Leaves out what is of no consequence, and the comma before it.
    pub(super) fn empty_words(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let length = self.one_of(index, &EMPTY);
            if let Some(length) = length {
                let comma = usize::from(
                    index > 0 && self.at(index - 1) == "," && [",", "."].contains(&self.at(index + length)),
                );
                self.say(index - comma, index + length, &[]);
                continue;
            }
            index += 1;
        }
    }

    /// "it would be nice if the cup was on the desk", "all cups have water in them", "…, but the mug shouldn't"
    pub(super) fn roundabout_wishes(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let nice = (self.starts(index, &["it", "would", "be"]) || self.starts(index, &["itd", "be"]))
                .then(|| (index + 2..index + 6).find(|&at| self.at(at) == "if"))
                .flatten()
                .filter(|&at| is_determiner(self.at(at + 1)));
            if let Some(condition) = nice {
                let end = self.next_mark(condition, &["."]);
                for at in (condition..end).rev() {
                    if ["was", "were", "is", "are"].contains(&self.at(at)) {
                        self.say(at, at + 1, &["should", "be"]);
                    }
                }
                self.say(index, condition + 1, &[]);
            }
            let liquid = ["water", "coffee", "wine"].contains(&self.at(index + 1));
            if ["have", "has"].contains(&self.at(index))
                && liquid
                && self.at(index + 2) == "in"
                && ["it", "them"].contains(&self.at(index + 3))
                && self.noun_before(index).is_some()
            {
                let liquid = self.at(index + 1).to_owned();
                self.say(index, index + 4, &["should", "be", "filled", "with", &liquid]);
            }
            self.denied_of_another(index);
            let each = self.at(index) == ","
                && self.at(index + 1) == "one"
                && ["on", "in"].contains(&self.at(index + 2))
                && self.at(index + 3) == "each";
            if each {
                let end = self.next_mark(index + 1, &[",", "."]);
                self.say(index, end, &[]);
            }
            index += 1;
        }
    }

    /// "…, but the mug should not; it goes …": the mug is spoken of.
    fn denied_of_another(&mut self, index: usize) {
        if !["but", "and"].contains(&self.at(index)) || !is_determiner(self.at(index + 1)) {
            return;
        }
        let not =
            (index + 3..index + 6).find(|&at| self.starts(at, &["should", "not"]) && self.is_mark(at + 2));
        if let Some(not) = not.filter(|&not| self.noun_before(not).is_some()) {
            self.say(not, not + 2, &[]);
            self.say(index, index + 1, &["."]);
        }
    }

    /// "put the bear … I mean the statue on the bed": the statue.
    pub(super) fn corrections(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let length = self.one_of(index, &CORRECTIONS);
            let (Some(length), true) = (length, is_determiner(self.at(index + length.unwrap_or(0)))) else {
                index += 1;
                continue;
            };
            let marks = (0..index).rev().take_while(|&at| self.is_mark(at)).count();
            let end = index - marks;
            let noun = self.noun_before(end).map_or(0, |noun| noun.len());
            if marks > 0 && noun > 0 && end > noun && is_determiner(self.at(end - noun - 1)) {
                let comma = usize::from({
                    let behind = self.next_mark(index + length, &[",", "."]);
                    self.at(behind) == "," && preposition(&[self.at(behind + 1)]).is_some()
                });
                if comma == 1 {
                    let behind = self.next_mark(index + length, &[",", "."]);
                    self.say(behind, behind + 1, &[]);
                }
                self.say(end - noun - 1, index + length, &[]);
            }
            index += 1;
        }
    }

    /// "the first two", "the last one": the former two, the latter.
    pub(super) fn first_and_last(&mut self) {
        let mut index = 0;
        while index + 1 < self.tokens.len() {
            let which = match self.at(index + 1) {
                "first" => "former",
                "last" => "latter",
                _ => "",
            };
            let number = inflect::number(self.at(index + 2));
            let one = self.at(index + 2) == "one";
            if self.at(index) == "the"
                && !which.is_empty()
                && (number.is_some() || one)
                && self.lexicon.noun(&[self.at(index + 3)]).is_none()
            {
                let length = if one || number == Some(1) { 3 } else { 2 };
                self.say(index + 1, index + length, &[which]);
            }
            index += 1;
        }
    }

    /// "should then be on", "either slice …", "be taken out and put …", "bring it to me on the plate", "fold the cloth"
    pub(super) fn small_verbs(&mut self) {
        const ADVERBS: [&str; 12] = [
            "then",
            "also",
            "finally",
            "afterwards",
            "always",
            "just",
            "instead",
            "now",
            "later",
            "first",
            "ideally",
            "preferably",
        ];
        const FETCHED: [&str; 6] = ["taken", "brought", "removed", "picked", "gotten", "collected"];
        let mut index = 1;
        while index < self.tokens.len() {
            let word = self.at(index);
            if ADVERBS.contains(&word) && SHALL.contains(&self.at(index - 1)) && self.at(index - 1) != "has" {
                self.say(index, index + 1, &[]);
                continue;
            }
            if FETCHED.contains(&word) && self.at(index - 1) == "be" {
                let particle =
                    usize::from(["out", "up", "down", "off", "away"].contains(&self.at(index + 1)));
                let from = if self.at(index + 1 + particle) == "from" || self.at(index + 1 + particle) == "of"
                {
                    (index + 2 + particle..index + 7 + particle)
                        .find(|&at| ["and", ","].contains(&self.at(at)))
                        .unwrap_or(index)
                } else {
                    index + 1 + particle
                };
                let joins = (from..).take_while(|&at| [",", "and", "then"].contains(&self.at(at))).count();
                if from > index && joins > 0 && self.is_participle(from + joins) {
                    self.say(index, from + joins, &[]);
                }
            }
            let me = ["me", "us", "him", "her"].contains(&self.at(index + 1));
            if self.at(index) == "to"
                && me
                && ["on", "in"].contains(&self.at(index + 2))
                && is_determiner(self.at(index + 3))
            {
                self.say(index, index + 2, &[]);
            }
            index += 1;
        }
        for index in 0..self.tokens.len() {
            let opens = self.opens_part(index);
            if opens && self.at(index) == "either" && self.is_order(index + 1) {
                self.say(index, index + 1, &[]);
            }
            if opens && ["fold", "iron"].contains(&self.at(index)) && is_determiner(self.at(index + 1)) {
                let cloth = self.lexicon.noun(&[self.at(index + 2)]).is_some_and(|(noun, _)| {
                    noun.kinds
                        .iter()
                        .any(|kind| ["Cloth", "Towel", "HandTowel", "Newspaper"].contains(&kind.as_str()))
                });
                if cloth {
                    self.say(index, index + 1, &["take"]);
                }
            }
        }
    }

    /// "…, next to the clock": no comma before it; "and on the plate lay an egg": a sentence of its own.
    pub(super) fn places_apart(&mut self) {
        const NEAR: [&[&str]; 6] = [
            &["next", "to"],
            &["beside"],
            &["near"],
            &["close", "to"],
            &["right", "beside"],
            &["right", "next", "to"],
        ];
        let mut index = 1;
        while index < self.tokens.len() {
            let near = self.one_of(index + 1, &NEAR).unwrap_or(0);
            let end = self.next_mark(index + 1, &[",", "."]);
            if self.at(index) == ","
                && near > 0
                && self.is_mark(end)
                && end - index <= near + 4
                && self.noun_before(index).is_some()
                && self.noun_before(end).is_some()
                && !(index + 1..end).any(|at| self.at(at) == "and")
            {
                self.say(index, index + 1, &[]);
            }
            let verb = (index + 3..self.tokens.len().min(index + 6)).find(|&at| {
                ["put", "place", "lay", "set"].contains(&self.at(at)) && is_determiner(self.at(at + 1))
            });
            if self.at(index) == "and"
                && ["on", "in", "inside"].contains(&self.at(index + 1))
                && is_determiner(self.at(index + 2))
                && verb.is_some_and(|verb| {
                    self.noun_before(verb).is_some_and(|noun| noun.len() + index + 3 == verb)
                })
            {
                self.say(index, index + 1, &["."]);
            }
            index += 1;
        }
    }

    /// "shelves are for books, so move the phone …": why is no order.
    pub(super) fn reasons_before_so(&mut self) {
        let mut start = 0;
        let mut index = 0;
        while index < self.tokens.len() {
            let so = usize::from(self.at(index) == ",");
            if self.at(index + so) == "so" && index > start {
                let end = self.next_mark(index + so + 1, &["."]);
                let orders = self.is_base_verb(index + so + 1) && is_determiner(self.at(index + so + 2));
                let tells = (start..index)
                    .any(|at| ["is", "are", "was", "were", "break", "breaks"].contains(&self.at(at)))
                    && !(start..index).any(|at| {
                        ["should", "must", "want", "need", "if", ",", "please"].contains(&self.at(at))
                    })
                    && index - start <= LONGEST_ASIDE + 2;
                let back =
                    (index..end).any(|at| ["it", "them", "they", "there", "both"].contains(&self.at(at)));
                let ordered = self.is_order(start);
                if orders && tells && !back && !ordered {
                    self.say(start, index + so + 1, &[]);
                    index = start;
                }
            }
            if self.at(index) == "." {
                start = index + 1;
            }
            index += 1;
        }
    }
}
