//! What is left out or miswritten in a noun phrase.

use super::super::clause::{Parser, is_going};
use super::super::inflect;
use super::super::lexicon::Noun;
use super::super::scene::Scene;
use super::super::syntax::{Head, Quantity, preposition};
use super::Front;

impl Parser<'_> {
    /// "the leftmost, lower drawer": a comma between modifiers.
    pub(super) fn list_of_modifiers(&self) -> bool {
        let before = self.position.checked_sub(1).and_then(|at| self.words.get(at));
        let is_modifier = |word: &str| {
            self.lexicon.is_small("modifiers", &[word]) || self.lexicon.adjective(&[word]).is_some()
        };
        // "a cleaned, mug full of water": a comma too many.
        let state = before.is_some_and(|word| {
            self.lexicon.adjective(&[word]).is_some() && self.lexicon.noun(&[word]).is_none()
        });
        if state && self.longest_noun_at(self.position + 1).is_some() && self.word_at(1) != Some("and") {
            return true;
        }
        before.is_some_and(|word| is_modifier(word))
            && self.word_at(1).is_some_and(is_modifier)
            && (2..5).any(|at| self.longest_noun_at(self.position + at).is_some())
    }

    /// "a full and an empty roll", "a white and a gold bottle": two of them.
    pub(super) fn two_kinds(&mut self, front: &mut Front) -> bool {
        let (Some(one), Some("and")) = (self.peek(), self.word_at(1)) else { return false };
        let apart = self.word_at(2).is_some_and(|word| ["a", "an", "one"].contains(&word));
        let length = if apart { 4 } else { 3 };
        let Some(other) = self.word_at(length - 1) else { return false };
        let opposite = match (self.lexicon.adjective(&[one]), self.lexicon.adjective(&[other])) {
            (Some(a), Some(b)) => a.set.iter().any(|(p, v)| b.set.get(p).is_some_and(|w| w != v)),
            _ => false,
        };
        let is_modifier = |word: &str| self.lexicon.is_small("modifiers", &[word]);
        let different = apart && one != other && is_modifier(one) && is_modifier(other);
        if !(opposite || different) || !self.noun_follows(length) {
            return false;
        }
        front.quantity = Some(Quantity::Count(2));
        self.position += length;
        true
    }

    /// "two mugs … one … the other (one)", "three books … two … the third": of those that were counted. "the other
    /// two", "all three" where nothing was counted: of those that were spoken of.
    pub(super) fn one_of_the_counted(&mut self, word: &str, front: &mut Front) -> Option<Head> {
        const ORDINALS: [&str; 6] = ["other", "remaining", "second", "third", "last", "first"];
        let ends = |at: usize| {
            self.word_at(at).is_none_or(|next| {
                ",.".contains(next)
                    || preposition(&[next]).is_some()
                    || is_going(next)
                    || ["and", "should", "then", "need", "needs"].contains(&next)
            })
        };
        let number = inflect::number(word);
        let ones = usize::from(self.word_at(1).is_some_and(|next| ["one", "ones"].contains(&next)));
        let all = front.quantity == Some(Quantity::All);
        let length = match word {
            "another" if ends(1 + ones) => 1 + ones,
            _ if ORDINALS.contains(&word) && front.phrase.definite && ends(1 + ones) => 1 + ones,
            _ if number.is_some() && ends(1) => 1,
            _ => return None,
        };
        let other = front.phrase.other || word != "first" && number.is_none();
        let several = number.filter(|&count| count > 1);
        let head = match self.counted.as_deref().cloned() {
            Some(noun) if !all => Head::Noun(noun),
            _ if several.is_some() && (all || other || front.phrase.definite) => {
                Head::Pronoun { plural: true }
            }
            _ => return None,
        };
        self.position += length;
        front.phrase.other = other;
        (front.phrase.definite, front.phrase.indefinite) = (false, true);
        front.quantity = Some(match several {
            Some(count) => Quantity::Count(count),
            None if ["remaining", "other"].contains(&word) && self.words[self.position - 1] == "ones" => {
                Quantity::All
            }
            None => Quantity::One,
        });
        Some(head)
    }

    /// A verb where a noun is due, a letter away from what the scene has: "put the clean put on the stove".
    pub(super) fn miswritten_noun(&self, word: &str) -> Option<Noun> {
        let meant = self.scene.spelling().one_edit_away(word).next()?;
        self.lexicon.noun(&[meant]).map(|(noun, _)| noun.clone())
    }

    /// "put it all on the table"
    pub(super) fn all_of_it_follows(&self) -> bool {
        self.word_at(1) == Some("all")
            && self
                .word_at(2)
                .is_none_or(|next| ",.".contains(next) || preposition(&[next]).is_some() || next == "and")
    }

    /// "from it's hanger": a possessive, miswritten.
    pub(super) fn is_miswritten_its(&self, word: &str) -> bool {
        let before = self.position.checked_sub(1).and_then(|at| self.words.get(at));
        word == "it"
            && before.is_some_and(|before| preposition(&[before]).is_some())
            && self.longest_noun_at(self.position + 1).is_some()
    }

    /// "bread butterknife and fork": a list without its commas, not a bread's knife.
    pub(super) fn are_two_things(&self, one: &Noun, other: &Noun) -> bool {
        let here = |noun: &Noun| {
            !noun.class && noun.kinds.first().is_some_and(|kind| self.scene.affords(kind, "pickupable"))
        };
        let vessel = noun_affords(self.scene, other, "receptacle");
        here(one) && here(other) && !vessel && !one.kinds.iter().any(|kind| other.kinds.contains(kind))
    }
}

fn noun_affords(scene: &Scene<'_>, noun: &Noun, affordance: &str) -> bool {
    noun.kinds.iter().any(|kind| scene.affords(kind, affordance))
}
