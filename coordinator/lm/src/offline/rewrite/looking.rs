//! What stands at a place of a text, and putting something in its stead.

use super::{LONGEST, Rewriting};
use crate::offline::inflect::VerbForm;
use crate::offline::syntax::{is_determiner, preposition};
use crate::offline::text::Token;

impl Rewriting<'_> {
    pub(super) fn at(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    pub(super) fn starts(&self, index: usize, words: &[&str]) -> bool {
        words.iter().enumerate().all(|(offset, word)| self.at(index + offset) == *word)
    }

    /// How many words there are of the one of these sayings that stands here.
    pub(super) fn one_of(&self, index: usize, sayings: &[&[&str]]) -> Option<usize> {
        sayings.iter().find(|said| self.starts(index, said)).map(|said| said.len())
    }

    /// Whether a preposition of a place stands here: "of" is none.
    pub(super) fn is_place(&self, at: usize) -> bool {
        preposition(&[self.at(at)]).is_some_and(|_| self.at(at) != "of")
    }

    pub(super) fn is_verb(&self, at: usize, wanted: VerbForm) -> bool {
        self.lexicon.verbs(self.at(at)).iter().any(|(form, _, _)| *form == wanted)
    }

    pub(super) fn is_base_verb(&self, at: usize) -> bool {
        self.is_verb(at, VerbForm::Base)
    }

    /// Whether what stands here gives an order and names nothing.
    pub(super) fn is_order(&self, at: usize) -> bool {
        self.is_base_verb(at) && self.lexicon.noun(&[self.at(at)]).is_none()
    }

    /// Whether what may have been done stands here: "washed", and those that look like an order.
    pub(super) fn is_participle(&self, at: usize) -> bool {
        self.is_verb(at, VerbForm::Past) || ["put", "cut", "set"].contains(&self.at(at))
    }

    /// Whether a part of a sentence may begin here: behind a mark, "and" or "then".
    pub(super) fn opens_part(&self, index: usize) -> bool {
        index == 0 || [",", ".", "and", "then"].contains(&self.at(index - 1))
    }

    /// Whether a word names parts of what was cut: "slice", "pieces", "halves".
    pub(super) fn is_part(&self, at: usize) -> bool {
        self.lexicon.is_small("slices", &[self.at(at).trim_end_matches('s')]) || self.at(at) == "halves"
    }

    /// The words of a range, as they are now.
    pub(super) fn words(&self, range: std::ops::Range<usize>) -> Vec<String> {
        range.map(|at| self.at(at).to_owned()).collect()
    }

    pub(super) fn is_mark(&self, index: usize) -> bool {
        index >= self.tokens.len() || [",", "."].contains(&self.at(index))
    }

    /// Where the next mark of some stands, from a place on.
    pub(super) fn next_mark(&self, from: usize, marks: &[&str]) -> usize {
        (from..self.tokens.len()).find(|&at| marks.contains(&self.at(at))).unwrap_or(self.tokens.len())
    }

    /// Says something in place of a range.
    pub(super) fn say(&mut self, from: usize, to: usize, words: &[&str]) {
        let to = to.min(self.tokens.len());
        self.tokens.splice(from..to, words.iter().map(|word| Token::said(word)));
    }

    /// The same with words that were put together.
    pub(super) fn say_all(&mut self, from: usize, to: usize, words: &[String]) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        self.say(from, to, &words);
    }

    /// Where what is between two marks begins.
    pub(super) fn clause_start(&self, index: usize) -> usize {
        (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1)
    }

    /// Where the sentence begins.
    pub(super) fn sentence_start(&self, index: usize) -> usize {
        (0..index).rev().find(|&at| self.at(at) == ".").map_or(0, |at| at + 1)
    }

    /// Where a thing begins whose words begin at `first`: at its determiner, if it has one.
    pub(super) fn with_determiner(&self, first: usize) -> usize {
        first - usize::from(first > 0 && is_determiner(self.at(first - 1)))
    }

    /// The noun that ends before a place, in words.
    pub(super) fn noun_before(&self, end: usize) -> Option<Vec<String>> {
        (1..=LONGEST.min(end)).rev().find_map(|length| {
            let words: Vec<&str> = (end - length..end).map(|at| self.at(at)).collect();
            self.lexicon.noun(&words)?;
            Some(words.into_iter().map(str::to_owned).collect())
        })
    }
}
