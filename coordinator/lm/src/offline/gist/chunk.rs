//! The parts a sentence is made of, as far as they can be told one by one: things, places, states, doings.

use std::cell::OnceCell;
use std::ops::Range;

use super::super::clause::Parser;
use super::super::inflect::VerbForm;
use super::super::lexicon::{Act, LONGEST, Lexicon, Settings};
use super::super::scene::Scene;
use super::super::syntax::Relation;

use closed::WISHES;

mod aside;
mod closed;
mod doing;
mod place;
mod thing;

/// A thing as it is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thing {
    /// Its name, without words nobody knows.
    pub words: Vec<String>,
    /// The types that it may be of; none for slices.
    pub kinds: Vec<String>,
    /// Whether several are meant.
    pub plural: bool,
    /// Whether nothing like it is in the scene.
    pub absent: bool,
    /// What it is to be full of: "the water filled mug".
    pub full_of: Option<String>,
}

/// What was named before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Again {
    /// `it`
    One,
    /// `them`; `both` and `all three`: so many
    All(usize),
    /// `the former`
    First,
    /// `the latter`
    Last,
}

/// Where something is or goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Where {
    /// At a thing that is named.
    At(Thing),
    /// In or on what was named before: `in it`.
    AtIt,
    /// Where the last thing went: `there`.
    There,
}

/// What something is to get by being done to.
#[derive(Clone, Debug, PartialEq)]
pub struct Doing {
    /// What the verb does.
    pub act: Act,
    /// Its base form, with its particles.
    pub words: Vec<String>,
    /// As it was written.
    pub form: VerbForm,
    /// An affordance that the thing must have.
    pub wants: Option<String>,
}

/// A part of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum Chunk {
    /// A noun phrase.
    Thing(Thing),
    /// A pronoun.
    Again(Again),
    /// A prepositional phrase, by its relation and the words of its preposition.
    Place(Relation, Vec<String>, Where),
    /// An adjective.
    State(Vec<String>, Settings),
    /// A verb that changes a thing.
    Act(Doing),
    /// A verb that only carries things or wants them somehow; itself where it says nothing without a place.
    Moves(Option<String>),
    /// `water`
    Liquid(String),
    /// `not`, `no`, `without`
    Deny,
    /// `with`; `together with` (true)
    With(bool),
    /// A comma, or `and` (true).
    Join(bool),
    /// `but`
    But,
    /// The end of a sentence.
    Stop,
    /// `stays`
    Stays,
    /// `likewise`, `too`
    Likewise,
    /// `in place of`: what comes next is only named.
    Beside,
    /// `that is`: what comes next says which one is meant.
    Tells,
    /// `holding`: what comes next is in it.
    Holds,
    /// `which`: what comes next is said of what was named last.
    Which,
    /// `should be`, `goes`: what comes next is wished.
    Wish,
    /// What makes more of a sentence than its parts say: `if`, `except`.
    Hard,
    /// A word that says nothing here.
    Other(String),
}

impl Chunk {
    /// Whether a part of the sentence ends with it, and another begins behind it.
    pub fn ends_part(&self) -> bool {
        matches!(self, Self::Join(_) | Self::But | Self::Stop)
    }
}

/// Words that say nothing, behind which an order may begin.
const OPENERS: [&str; 11] = [
    "please",
    "you",
    "kindly",
    "finally",
    "lastly",
    "also",
    "afterwards",
    "afterward",
    "later",
    "next",
    "meanwhile",
];

/// Tells the parts.
pub struct Chunker<'a> {
    words: &'a [String],
    lexicon: &'a Lexicon,
    scene: &'a Scene<'a>,
    parser: Parser<'a>,
    /// The noun phrases that begin at each place, once they were looked for.
    things: Vec<OnceCell<Option<(Thing, usize)>>>,
}

impl<'a> Chunker<'a> {
    /// Of the words of a sentence.
    pub fn new(words: &'a [String], lexicon: &'a Lexicon, scene: &'a Scene<'a>) -> Self {
        let things = vec![OnceCell::new(); words.len()];
        Self { words, lexicon, scene, parser: Parser::new(words, lexicon, scene), things }
    }

    /// All parts, in their order.
    pub fn chunks(&self) -> (Vec<Chunk>, Vec<Range<usize>>) {
        let mut found: Vec<Chunk> = Vec::new();
        let mut spans = Vec::new();
        let mut at = 0;
        let mut aside = false;
        while at < self.words.len() {
            // "when that is done light the candle"
            let opens = aside
                || found.last().is_none_or(|last| {
                    last.ends_part()
                        || matches!(last, Chunk::Wish)
                        || matches!(last, Chunk::Other(word) if OPENERS.contains(&word.as_str()))
                });
            let said_beside = self.aside(at, opens);
            aside = said_beside.is_some_and(|_| ["when", "once", "after"].contains(&self.at(at)));
            let (chunk, length) = match said_beside {
                Some(length) => (Chunk::Other(self.at(at).to_owned()), length),
                None => self.chunk(at, opens, found.last()),
            };
            found.push(chunk);
            let end = (at + length.max(1)).min(self.words.len());
            spans.push(at..end);
            at = end;
        }
        (found, spans)
    }

    fn at(&self, at: usize) -> &'a str {
        self.words.get(at).map_or("", String::as_str)
    }

    fn starts(&self, at: usize, words: &[&str]) -> bool {
        words.iter().enumerate().all(|(offset, word)| self.at(at + offset) == *word)
    }

    fn one_of(&self, at: usize, phrases: &[&[&str]]) -> Option<usize> {
        phrases.iter().find(|phrase| self.starts(at, phrase)).map(|phrase| phrase.len())
    }

    fn rest(&self, at: usize) -> Vec<&'a str> {
        self.words.iter().skip(at).take(LONGEST).map(String::as_str).collect()
    }

    fn chunk(&self, at: usize, opens: bool, before: Option<&Chunk>) -> (Chunk, usize) {
        self.closed_class(at, opens)
            .or_else(|| self.again(at))
            .or_else(|| self.place_of_it(at, opens))
            .or_else(|| self.place(at, before))
            .or_else(|| self.doing(at, opens))
            .or_else(|| self.thing(at).map(|(thing, length)| (Chunk::Thing(thing), length)))
            .or_else(|| self.state(at))
            .unwrap_or_else(|| match self.at(at) {
                word if WISHES.contains(&word) => (Chunk::Wish, 1),
                word => (Chunk::Other(word.to_owned()), 1),
            })
    }
}
