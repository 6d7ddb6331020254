//! Noun phrases, as far as their names go.

use super::super::super::inflect;
use super::super::super::syntax::{is_determiner, is_function_word, preposition};
use super::super::super::text::POSSESSIVE;
use super::closed::RESTING;
use super::{Chunker, Thing};

/// A noun phrase is no longer than this before its noun, in words.
const LONGEST_FRONT: usize = 7;

impl Chunker<'_> {
    /// A noun phrase and how many words it takes.
    pub(super) fn thing(&self, at: usize) -> Option<(Thing, usize)> {
        let mut words: Vec<String> = Vec::new();
        let mut position = at;
        let mut plural = false;
        while position < at + LONGEST_FRONT {
            let bare = position == at;
            if bare && RESTING.contains(&self.at(at)) {
                return None;
            }
            if let Some((noun, is_plural, length)) = self.parser.longest_noun_at(position) {
                if ["water", "coffee", "wine"].contains(&self.at(position)) && self.is_liquid(position, bare)
                {
                    return None;
                }
                let mut end = position + length;
                let fixed = noun.kinds.iter().any(|kind| self.scene.affords(kind, "receptacle"))
                    && !noun.kinds.iter().any(|kind| self.scene.affords(kind, "pickupable"));
                // "the armchair pillow"
                if fixed
                    && self.parser.longest_noun_at(end).is_some_and(|(next, _, _)| {
                        next.kinds.iter().any(|kind| self.scene.affords(kind, "pickupable"))
                    })
                {
                    position = end;
                    continue;
                }
                // "the coffee machine's spout", "the boy's mug"
                if self.at(end) == POSSESSIVE
                    && let Some((of, _, length)) = self.parser.longest_noun_at(end + 1)
                {
                    let carried =
                        |kinds: &[String]| kinds.iter().any(|kind| self.scene.affords(kind, "pickupable"));
                    let here = |kinds: &[String]| kinds.iter().any(|kind| self.scene.has(kind));
                    let another = carried(&of.kinds) || here(&of.kinds) && carried(&noun.kinds);
                    if another || !here(&noun.kinds) {
                        position = end + 1;
                        continue;
                    }
                    words.extend(self.words[position..end].iter().cloned());
                    let absent = !noun.kinds.iter().any(|kind| self.scene.has(kind));
                    let thing = Thing { words, kinds: noun.kinds, plural, absent };
                    return Some((thing, end + 1 + length - at));
                }
                if self.at(end) == "time" {
                    return None;
                }
                words.extend(self.words[position..end].iter().cloned());
                let sliceable = noun.kinds.iter().any(|kind| self.scene.affords(kind, "sliceable"));
                if sliceable && self.is_slices(self.at(end)) {
                    words.push(self.at(end).to_owned());
                    plural |= self.at(end).ends_with('s');
                    end += 1;
                }
                let absent = !noun.kinds.iter().any(|kind| self.scene.has(kind));
                let plural = plural || is_plural;
                return Some((Thing { words, kinds: noun.kinds, plural, absent }, end - at));
            }
            let word = self.at(position);
            if !["bit", "part", "portion", "section"].contains(&word)
                && self.is_slices(word)
                && self.at(position + 1) != "of"
                && (!bare || word.ends_with('s'))
            {
                words.push(word.to_owned());
                let plural = word.ends_with('s');
                return Some((Thing { words, kinds: Vec::new(), plural, absent: false }, position + 1 - at));
            }
            let length = self.front(position, at)?;
            plural |= ["both", "all"].contains(&word) || inflect::number(word).is_some_and(|n| n > 1);
            if length > 0 {
                words.extend(self.words[position..position + length].iter().cloned());
            }
            position += length.max(1);
        }
        None
    }

    fn is_slices(&self, word: &str) -> bool {
        self.lexicon.is_small("slices", &[word])
            || inflect::singulars(word).iter().any(|one| self.lexicon.is_small("slices", &[one]))
    }

    /// How many words at a place belong to what stands before a noun; 0 for one that nobody knows.
    fn front(&self, position: usize, start: usize) -> Option<usize> {
        let word = self.at(position);
        let rest = self.rest(position);
        let first = position == start
            || is_determiner(self.at(position - 1))
            || ["of", "and"].contains(&self.at(position - 1))
            || inflect::number(self.at(position - 1)).is_some();
        if word == "rest" {
            return None;
        }
        if is_determiner(word) || inflect::number(word).is_some() {
            return first.then_some(1);
        }
        if word == "of" && position > start {
            return Some(1);
        }
        // "the water filled mug"
        if ["water", "coffee", "wine"].contains(&word) && self.at(position + 1) == "filled" {
            return Some(2);
        }
        // "the washed and sliced tomato"
        let state = |at: usize| self.lexicon.adjective(&[self.at(at)]).is_some();
        if word == "and" && position > start && state(position - 1) && state(position + 1) {
            let noun = self.parser.longest_noun_at(position + 2).is_some();
            return noun.then_some(1);
        }
        let listed = |list: &str| {
            self.lexicon.is_small(list, &[word])
                || inflect::singulars(word).iter().any(|one| self.lexicon.is_small(list, &[one]))
        };
        if ["slices", "measures", "parts"].into_iter().any(listed) && self.at(position + 1) == "of" {
            return Some(2);
        }
        let adjective = (1..=3.min(rest.len()))
            .rev()
            .find(|&n| self.lexicon.adjective(&rest[..n]).is_some() && preposition(&rest[..1]).is_none());
        if adjective.is_some() {
            return adjective;
        }
        if let Some(length) = self.lexicon.longest_small("modifiers", &rest) {
            return Some(length);
        }
        // "the ugly vase"
        let strange = position > start
            && is_determiner(self.at(position - 1))
            && !is_function_word(word)
            && !",.".contains(word)
            && word != POSSESSIVE
            && self.parser.longest_noun_at(position + 1).is_some();
        strange.then_some(0)
    }
}
