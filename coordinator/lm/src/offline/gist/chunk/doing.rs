//! What is done, and how things are.

use lamma_domains::goal::PropertyValue;

use super::closed::WISHES;
use super::{Chunk, Chunker, Doing};
use crate::offline::inflect::{self, VerbForm};
use crate::offline::lexicon::{Act, Settings, Verb};
use crate::offline::syntax::{Relation, is_determiner};

/// What may follow "on", "off", "up" and "down" where they say how something is.
pub(super) const BEHIND_A_STATE: [&str; 26] = [
    "",
    ",",
    ".",
    "and",
    "but",
    "then",
    "while",
    "too",
    "instead",
    "please",
    "again",
    "as",
    "when",
    "once",
    "now",
    "first",
    "afterwards",
    "afterward",
    "before",
    "after",
    "until",
    "for",
    "with",
    "also",
    "so",
    "by",
];

impl Chunker<'_> {
    pub(super) fn doing(&self, at: usize, opens: bool) -> Option<(Chunk, usize)> {
        let mut here = self.parser.ahead(0);
        here.position = at;
        if self.at(at + 1) == "filled" {
            return None;
        }
        let (form, verbs, mut length) = here.verbs_here()?;
        let verb: &Verb = verbs.first()?;
        let apart = self.with_particle_apart(at, length);
        let verb = apart.as_ref().map_or(verb, |(verb, _)| verb);
        if length > 1
            && ["to", "in", "into"].contains(&self.at(at + length - 1))
            && self.thing(at + length).is_some()
        {
            length -= 1;
        }
        let particles =
            apart.map_or_else(|| self.particles(at, verb, length), |(_, particle)| vec![particle]);
        let next = self.at(at + length);
        let object = is_determiner(next) && !["both", "all", "each"].contains(&next)
            || ["it", "them", "him", "me"].contains(&next);
        let named = self.thing(at).is_some();
        let is_noun =
            named && !(form == VerbForm::Base && opens && (object || self.thing(at + length).is_some()));
        let state = self.state(at);
        let switched = state.as_ref().filter(|(chunk, _)| form != VerbForm::Base && is_switch(chunk));
        let object = object || ["me", "us"].contains(&next);
        let told = form == VerbForm::Base
            && state.is_some()
            && length == 1
            && !(opens && (object || self.thing(at + length).is_some()));
        if is_noun || switched.is_some() || told {
            return None;
        }
        let word = self.at(at);
        if WISHES.contains(&word) && particles.is_empty() && !(opens && object) {
            return Some((Chunk::Wish, 1));
        }
        length = length.max(1);
        let same = ["cut", "put", "set", "shut"].contains(&word);
        let form = if same && !object && self.thing(at + length).is_none() { VerbForm::Past } else { form };
        // "switch the lamp on and the television off": by the states.
        let switched =
            particles.first().is_some_and(|particle| ["on", "off", "out"].contains(&particle.as_str()));
        if length == 1 && switched && verb.set.contains_key("isToggled") {
            return Some((Chunk::Moves(None), 1));
        }
        Some(match verb.act {
            Act::Place | Act::Hold | Act::Go | Act::Keep | Act::Use | Act::Pour => {
                // "box them": where is said by the verb
                if verb.act == Act::Place && !verb.default.is_empty() && !self.place_follows(at + length) {
                    let words = self.words[at..at + length].to_vec();
                    return Some((Chunk::Act(Doing { act: Act::Store, words, form, wants: None }), length));
                }
                let somewhere = verb.act == Act::Place && form == VerbForm::Base && opens && word != "leave";
                (Chunk::Moves(somewhere.then(|| word.to_owned())), length)
            }
            Act::Examine if opens && form == VerbForm::Base => (Chunk::Hard, length),
            Act::Examine => (Chunk::Other(word.to_owned()), 1),
            act => {
                let base = inflect::bases(word).into_iter().find(|(base, _)| {
                    self.lexicon.verbs(base).iter().any(|(f, p, v)| {
                        *f == VerbForm::Base && p.len() == particles.len() && std::ptr::eq(*v, verb)
                    })
                });
                let mut words = vec![base.map_or_else(|| word.to_owned(), |(base, _)| base)];
                words.extend(particles);
                (Chunk::Act(Doing { act, words, form, wants: verb.wants.clone() }), length)
            }
        })
    }

    /// "shut the laptop down": the verb with what stands behind its object.
    fn with_particle_apart(&self, at: usize, length: usize) -> Option<(&Verb, String)> {
        let (_, named) = self.thing(at + length).filter(|_| length == 1)?;
        let behind = at + length + named;
        let particle = self.at(behind);
        let ends = BEHIND_A_STATE.contains(&self.at(behind + 1));
        let known = self.lexicon.verbs(self.at(at));
        let (_, _, verb) = known.into_iter().find(|(_, particles, _)| *particles == [particle.to_owned()])?;
        (ends && particle == "down").then(|| (verb, particle.to_owned()))
    }

    /// Whether it is said where before the sentence ends.
    pub(super) fn place_follows(&self, at: usize) -> bool {
        (at..self.words.len()).take_while(|&at| ![".", ","].contains(&self.at(at))).any(|at| {
            matches!(self.place(at, None), Some((Chunk::Place(Relation::In | Relation::To, ..), _)))
        })
    }

    /// A verb's particles: behind it, or behind its object.
    pub(super) fn particles(&self, at: usize, verb: &Verb, length: usize) -> Vec<String> {
        let known = self.lexicon.verbs(self.at(at));
        let of_verb = || known.iter().filter(|(_, _, known)| std::ptr::eq(*known, verb));
        if length > 1 || of_verb().any(|(_, particles, _)| particles.is_empty()) {
            return self.words[at + 1..at + length].to_vec();
        }
        let behind = &self.words[at + 1..self.words.len().min(at + 9)];
        let apart = of_verb().find(|(_, particles, _)| matches!(particles, [one] if behind.contains(one)));
        apart.map_or_else(Vec::new, |(_, particles, _)| particles.to_vec())
    }

    pub(super) fn state(&self, at: usize) -> Option<(Chunk, usize)> {
        let rest = self.rest(at);
        let flag = |said: &str, property: &str, value: bool| {
            let set = Settings::from([(property.to_owned(), PropertyValue::Flag(value))]);
            Some((Chunk::State(vec![said.to_owned()], set), 1))
        };
        let ends = BEHIND_A_STATE.contains(&self.at(at + 1));
        match self.at(at) {
            word @ ("down" | "lowered" | "drawn") if ends => return flag(word, "isOpen", false),
            word @ ("up" | "raised") if ends => return flag(word, "isOpen", true),
            "going" | "brewing" | "working" => return Some((Self::on(), 1)),
            _ => {}
        }
        let length = (1..=3.min(rest.len())).rev().find(|&n| self.lexicon.adjective(&rest[..n]).is_some())?;
        let set = self.lexicon.adjective(&rest[..length])?.set.clone();
        Some((Chunk::State(self.words[at..at + length].to_vec(), set), length))
    }
}

/// Whether a state is one of a switch or a door.
fn is_switch(chunk: &Chunk) -> bool {
    matches!(chunk, Chunk::State(_, set) if set.contains_key("isToggled") || set.contains_key("isOpen"))
}
