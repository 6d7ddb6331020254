//! Nouns of several words: compounds, and what modifiers apart from the noun say of it.

use lamma_domains::goal::PropertyValue;

use super::super::clause::Parser;
use super::super::lexicon::{LONGEST, Noun};
use super::super::syntax::Head;
use super::super::text::POSSESSIVE;
use super::Front;

impl Parser<'_> {
    /// Takes the noun, and the nouns right behind it: of "dresser drawer" the last is the head.
    pub(super) fn noun_head(&mut self, noun: Noun, plural: bool, length: usize, front: &mut Front) -> Head {
        let mut noun = self.told_by_modifiers(length).unwrap_or(noun);
        let mut plural = plural;
        self.position += length;
        while let Some(word) = self.peek() {
            if word == POSSESSIVE {
                self.position += 1;
                front.chained += 1;
                if let Some((next, _, length)) = self.longest_noun()
                    && self.names_the_sort_of(&noun, &next)
                {
                    self.position += length;
                    continue;
                }
                if front.chained < LONGEST && self.noun_follows(0) {
                    return self.head(front).unwrap_or(Head::Noun(noun));
                }
                plural = true;
                continue;
            }
            if self.is_slices(word) && self.has_affordance(&noun, "sliceable") {
                front.sliced = true;
                plural |= word.ends_with('s');
                self.position += 1;
                continue;
            }
            let Some((next, next_plural, next_length)) = self.longest_noun() else { break };
            if self.verb_reads_better(next_length) || self.are_two_things(&noun, &next) {
                break;
            }
            // "a microwave mug" is one that was in it.
            if noun.kinds.first().is_some_and(|kind| kind == "Microwave")
                && self.has_affordance(&next, "pickupable")
            {
                let hot = PropertyValue::Word("Hot".to_owned());
                front.phrase.states.insert("temperature".to_owned(), hot);
            }
            if !self.names_the_sort_of(&noun, &next) {
                noun = next;
            }
            plural = next_plural;
            self.position += next_length;
        }
        front.plural |= plural;
        Head::Noun(noun)
    }

    /// "night stand table", "island counter": the second word may mean what the first says better.
    fn names_the_sort_of(&self, noun: &Noun, next: &Noun) -> bool {
        // "the chair's cushion" is the chair; a cushion by itself is not.
        let seat = self.has_affordance(noun, "receptacle") && !self.has_affordance(noun, "pickupable");
        if seat && ["cushion", "seat"].contains(&next.word.as_str()) {
            return true;
        }
        !noun.class
            && !self.is_compartment(noun)
            && !self.is_compartment(next)
            && noun.kinds.first().is_some_and(|kind| self.scene.has(kind) && next.kinds.contains(kind))
    }

    /// "small dark table", "large metal knife": the noun as an earlier modifier tells it, if the scene has that.
    fn told_by_modifiers(&self, length: usize) -> Option<Noun> {
        let words: Vec<&str> = self.rest().into_iter().take(length).collect();
        let before = self.words[..self.position].iter().rev().map(String::as_str).take(LONGEST);
        let modifiers = before.take_while(|word| self.lexicon.is_small("modifiers", &[word])).skip(1);
        modifiers
            .filter_map(|modifier| self.lexicon.noun(&[&[modifier], words.as_slice()].concat()))
            .map(|(noun, _)| noun)
            .find(|noun| noun.kinds.iter().any(|kind| self.scene.has(kind)))
            .cloned()
    }

    /// "the top shelf of the desk": a shelf where there are some; of a fridge it is but a part.
    pub(super) fn is_shelf_of_furniture(&self, words: &[&str]) -> bool {
        let shelf = words.last().is_some_and(|word| ["shelf", "shelves", "rack"].contains(word));
        let (Some((noun, _, _)), true) = (self.longest_noun_at(self.position + words.len() - 1), shelf)
        else {
            return false;
        };
        let here = noun.kinds.iter().any(|kind| self.scene.has(kind) && self.is_compartment_kind(kind));
        let of = (words.len() + 1..words.len() + 5).find_map(|at| self.longest_noun_at(self.position + at));
        here && of.is_some_and(|(of, _, _)| !self.has_affordance(&of, "openable"))
    }

    /// Whether an adjective follows behind some words.
    pub(super) fn adjective_follows(&self, offset: usize) -> bool {
        let rest = self.rest();
        let rest = rest.get(offset..).unwrap_or_default();
        (1..=3.min(rest.len())).any(|length| {
            self.lexicon.adjective(&rest[..length]).is_some()
                && self.longest_noun_at(self.position + offset + length).is_some()
        })
    }

    /// Whether modifiers and a noun stand here: what is before them is a modifier too.
    pub(super) fn modifiers_and_noun_follow(&self) -> bool {
        self.peek().is_some_and(|word| self.lexicon.is_small("modifiers", &[word])) && self.noun_follows(1)
    }
}
