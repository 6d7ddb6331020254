//! Noun phrases, as far as their names go.

use super::super::super::inflect;
use super::super::super::lexicon::Noun;
use super::super::super::syntax::{LIQUIDS, is_determiner, is_function_word, preposition};
use super::super::super::text::POSSESSIVE;
use super::closed::RESTING;
use super::{Chunker, Thing};

/// A noun phrase is no longer than this before its noun, in words.
const LONGEST_FRONT: usize = 7;

impl Chunker<'_> {
    /// A noun phrase and how many words it takes.
    pub(super) fn thing(&self, at: usize) -> Option<(Thing, usize)> {
        self.things.get(at)?.get_or_init(|| self.find_thing(at)).clone()
    }

    fn find_thing(&self, at: usize) -> Option<(Thing, usize)> {
        let mut words: Vec<String> = Vec::new();
        let mut position = at;
        let (mut plural, mut full_of) = (false, None);
        while position < at + LONGEST_FRONT {
            let bare = position == at;
            if bare && RESTING.contains(&self.at(at)) {
                return None;
            }
            let described = self.longest_adjective(position).filter(|&length| length > 1);
            if let Some((noun, several, length)) = self.parser.longest_noun_at(position)
                && described.is_none()
                && !(LIQUIDS.contains(&self.at(position)) && self.at(position + 1) == "filled")
            {
                if LIQUIDS.contains(&self.at(position)) && self.is_liquid(position, bare) {
                    return None;
                }
                let end = position + length;
                if let Some(last) = self.whose_it_is(&noun, end) {
                    position = last;
                    continue;
                }
                words.extend(self.words[position..end].iter().cloned());
                // "the glass bowl", "the armchair pillow"
                let can = self.at(end) == "can";
                if self.parser.longest_noun_at(end).is_some() && !self.is_order(end) && !can {
                    position = end;
                    continue;
                }
                return self
                    .named(words, &noun, plural || several, end)
                    .map(|(thing, end)| (Thing { full_of, ..thing }, end - at));
            }
            let word = self.at(position);
            if !["bit", "part", "portion", "section"].contains(&word)
                && self.parser.is_slices(word)
                && self.at(position + 1) != "of"
                && (!bare || word.ends_with('s'))
            {
                words.push(word.to_owned());
                let plural = word.ends_with('s');
                return Some((
                    Thing { words, kinds: Vec::new(), plural, absent: false, full_of: None },
                    position + 1 - at,
                ));
            }
            // "the water filled mug"
            if LIQUIDS.contains(&word) && self.at(position + 1) == "filled" {
                full_of = Some(word.to_owned());
                position += 2;
                continue;
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

    /// "the boy's mug": where the thing itself begins, behind whose it is.
    fn whose_it_is(&self, of: &Noun, end: usize) -> Option<usize> {
        let (noun, _, _) = self.parser.longest_noun_at(end + 1).filter(|_| self.at(end) == POSSESSIVE)?;
        let carried = |noun: &Noun| self.parser.has_affordance(noun, "pickupable");
        let here = |noun: &Noun| !self.parser.is_absent(noun);
        // "the coffee machine's spout" is at the machine.
        let itself = carried(&noun) || here(&noun) && carried(of) || !here(of);
        itself.then_some(end + 1)
    }

    /// A thing by its name, up to and with what is behind the noun: "apple slices", "the machine's spout".
    fn named(
        &self,
        mut words: Vec<String>,
        noun: &Noun,
        mut plural: bool,
        mut end: usize,
    ) -> Option<(Thing, usize)> {
        if self.at(end) == "time" {
            return None;
        }
        if self.parser.has_affordance(noun, "sliceable") && self.parser.is_slices(self.at(end)) {
            words.push(self.at(end).to_owned());
            plural |= self.at(end).ends_with('s');
            end += 1;
        }
        if let Some((_, _, length)) = self.parser.longest_noun_at(end + 1)
            && self.at(end) == POSSESSIVE
        {
            end += 1 + length;
        }
        let absent = self.parser.is_absent(noun);
        Some((Thing { words, kinds: noun.kinds.clone(), plural, absent, full_of: None }, end))
    }

    /// The longest adjective at a place, in words.
    fn longest_adjective(&self, at: usize) -> Option<usize> {
        let rest = self.rest(at);
        (1..=3.min(rest.len()))
            .rev()
            .find(|&n| self.lexicon.adjective(&rest[..n]).is_some() && preposition(&rest[..1]).is_none())
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
        let of =
            self.at(position + 1) == "of" || self.parser.is_slices(word) && self.at(position + 1) == "from";
        if ["slices", "measures", "parts"].into_iter().any(listed) && of {
            return Some(2);
        }
        if let Some(length) = self.longest_adjective(position) {
            return Some(length);
        }
        if let Some(length) = self.lexicon.longest_small("modifiers", &rest) {
            return Some(length);
        }
        // "the ugly vase"
        let strange = position > start
            && (is_determiner(self.at(position - 1)) || inflect::number(self.at(position - 1)).is_some())
            && !is_function_word(word)
            && !",.".contains(word)
            && word != POSSESSIVE
            && self.parser.longest_noun_at(position + 1).is_some();
        strange.then_some(0)
    }
}
