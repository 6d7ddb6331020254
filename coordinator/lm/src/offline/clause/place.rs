//! Places: which prepositional phrases a clause has, and where the next thing said begins.

use std::rc::Rc;

use super::super::syntax::{Clause, Head, Phrase, Place, Quantity, Relation, preposition};
use super::{Parser, is_going};

impl<'a> Parser<'a> {
    /// A prepositional phrase.
    pub(super) fn place(&mut self, clause: &mut Clause<'a>) -> bool {
        if let Some(phrase) = self.somewhere() {
            clause.places.push(Place::new(Relation::In, "in", phrase));
            return true;
        }
        let Some((relation, length)) = preposition(&self.rest()) else { return false };
        let start = self.position;
        self.position += length;
        if self.another_such(clause, relation) {
            return true;
        }
        let Some(phrase) = self.phrase(0) else {
            // A preposition with nothing behind it is an adverb: "with a spoon inside"; or what it is in was
            // spoken of before: "put the tomato in".
            self.position = start + length;
            let ends = self.peek().is_none_or(|word| [".", ",", "and"].contains(&word));
            if ends
                && self.wants_place
                && clause.places.is_empty()
                && matches!(self.words[start].as_str(), "in" | "inside")
            {
                let it = Phrase::bare(Head::Pronoun { plural: false }, "it");
                clause.places.push(Place::new(Relation::In, "in", it));
            }
            return true;
        };
        if self.put_in_what(clause, relation, &phrase, start) {
            return true;
        }
        // "the bowl on the counter with the fork next to it": the fork goes there as well.
        if relation == Relation::With && !clause.places.is_empty() && self.beside_it() {
            clause.objects.push(phrase);
            return true;
        }
        // "a mug in the sink with a spoon in it": the spoon is in the mug.
        if relation == Relation::With
            && self.skip_back_reference()
            && let Some(object) = clause.objects.last_mut()
        {
            object.with.push(phrase);
            return true;
        }
        let mut phrase = phrase;
        if let (false, Some(object)) = (phrase.except.is_empty(), clause.objects.last_mut()) {
            object.except.append(&mut phrase.except);
        }
        let said = self.text_between(start, start + length);
        if said.ends_with("between") {
            self.other_end();
        }
        // "put it away over the microwave": not in it.
        let above = said == "over" && self.is_openable(&phrase);
        let near = above || self.wants_place && is_on_the_rim(&said, &phrase);
        let relation = if near { Relation::Near } else { relation };
        self.last_place = Some(Rc::new(phrase.clone()));
        clause.places.push(Place::new(relation, &said, phrase));
        self.more_places(clause, relation);
        true
    }

    /// Passes over "next to it".
    fn beside_it(&mut self) -> bool {
        let near = preposition(&self.rest()).filter(|(relation, _)| *relation == Relation::Near);
        let length = near.map_or(0, |(_, length)| length);
        let it = length > 0 && matches!(self.word_at(length), Some("it" | "them" | "that"));
        self.position += if it { length + 1 } else { 0 };
        it
    }

    /// "open the fridge and put in the apple": the apple goes into what was spoken of.
    fn put_in_what(&self, clause: &mut Clause<'a>, relation: Relation, what: &Phrase, start: usize) -> bool {
        let vessel = matches!(&what.head, Head::Noun(noun) if self.has_affordance(noun, "receptacle"));
        let ends = self.peek().is_none_or(|word| [".", ",", "and", "then"].contains(&word));
        let inward = relation == Relation::In && matches!(self.words[start].as_str(), "in" | "inside");
        if !(self.wants_place && inward && ends && clause.objects.is_empty() && clause.places.is_empty())
            || vessel
            || !self.is_movable(what)
        {
            return false;
        }
        clause.objects.push(what.clone());
        let it = Phrase::bare(Head::Pronoun { plural: false }, "it");
        clause.places.push(Place::new(Relation::In, "in", it));
        true
    }

    /// "from one table to another (one)": the noun was said with "from".
    fn another_such(&mut self, clause: &mut Clause<'a>, relation: Relation) -> bool {
        let length = match (self.peek(), self.word_at(1)) {
            (Some("another"), Some("one")) => 2,
            (Some("another"), next)
                if self.longest_noun_at(self.position + 1).is_none()
                    && next != Some("of")
                    && !self.part_follows(1) =>
            {
                1
            }
            (Some("the"), Some("other"))
                if self.longest_noun_at(self.position + 2).is_none() && !self.part_follows(2) =>
            {
                2 + usize::from(self.word_at(2) == Some("one"))
            }
            _ => return false,
        };
        let from = clause.places.iter().find(|place| place.relation == Relation::From);
        let from = from.or(clause.places.first()).map(|place| &place.phrase);
        let Some(mut phrase) = from.or(self.last_place.as_deref()).cloned() else { return false };
        phrase.other = true;
        (phrase.definite, phrase.indefinite) = (false, true);
        clause.places.push(Place::new(relation, "to", phrase));
        self.position += length;
        true
    }

    /// "(the other) side of the desk": a part of what is named behind it.
    fn part_follows(&self, offset: usize) -> bool {
        let part = self.word_at(offset).is_some_and(|word| self.lexicon.is_small("parts", &[word]));
        part && self.word_at(offset + 1) == Some("of")
    }

    /// "between the vase and the shaker": both only say where.
    fn other_end(&mut self) {
        let start = self.position;
        if self.peek() == Some("and") {
            self.position += 1;
            if self.clause_starts_here(false) || self.phrase(0).is_none() {
                self.position = start;
            }
        }
    }

    /// "out", "off" or "switched off" at the end of what is said: of a light, not of a place.
    pub(in crate::offline) fn switched_follows(&self) -> bool {
        let rest = self.rest();
        (1..=3.min(rest.len())).any(|length| {
            let ends = rest.get(length).is_none_or(|next| {
                [".", ",", "and", "then", "when", "once", "at", "for", "in"].contains(next)
            });
            let switches = |state: &super::super::lexicon::Adjective| state.set.contains_key("isToggled");
            ends && self.lexicon.adjective(&rest[..length]).is_some_and(switches)
        })
    }

    /// Whether somebody or something else is spoken of from here on: "and the plate should be clean".
    pub(super) fn new_subject_follows(&self) -> bool {
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        ahead.position += usize::from(ahead.peek() == Some("then"));
        // "…, no drawer may be open"
        ahead.position += usize::from(ahead.peek() == Some("no"));
        let things = ahead.phrases(0);
        let Some(first) = things.first() else { return false };
        // "…, all of them clean"
        if matches!(first.head, Head::Pronoun { plural: true }) && ahead.state_told() {
            return true;
        }
        ahead.peek().is_some_and(|word| {
            ["should", "must", "needs", "need", "is", "are", "has", "have", "ought", "can", "may", "shall"]
                .contains(&word)
                || is_going(word) && ahead.ahead(1).place_length().is_some()
                || ["stays", "stay", "remains"].contains(&word) && ahead.ahead(1).state_told()
        })
    }

    /// "in the fridge and the microwave": more of the same, unless a clause or another object follows.
    pub(super) fn more_places(&mut self, clause: &mut Clause<'a>, relation: Relation) {
        loop {
            let start = self.position;
            if !self.skip_joins()
                || self.clause_starts_here(false)
                || preposition(&self.rest()).is_some()
                || self.new_subject_follows()
            {
                self.position = start;
                return;
            }
            let Some(phrase) = self.phrase(0) else {
                self.position = start;
                return;
            };
            let mut behind = self.ahead(0);
            let joined = behind.skip_joins();
            let told = joined && behind.state_told();
            if joined && !told {
                behind.phrases(0);
                let closed = behind.peek() == Some(",") && behind.ahead(1).place_length().is_some();
                behind.position += usize::from(closed);
            }
            behind.position += usize::from(behind.peek().is_some_and(is_going));
            // "next to it, the card with the keys in the box"
            if let Some((Relation::With, length)) = preposition(&behind.rest()) {
                behind.position += length;
                behind.phrases(0);
            }
            let goes_elsewhere = preposition(&behind.rest())
                .is_some_and(|(other, _)| other != Relation::From && other != Relation::With);
            // "sliced, on the counter, the mug filled with coffee"
            let filled =
                !clause.complement.is_empty() && phrase.with.iter().any(|with| with.liquid().is_some());
            let another_pair = self.switched_follows()
                || filled
                || told
                || self.state_told() && (self.is_openable(&phrase) || !self.is_movable(&phrase))
                || (!clause.complement.is_empty() || clause.verbs.is_empty()) && self.state_told()
                || relation != Relation::From
                    && !(relation == Relation::With && self.wants_place && clause.places.len() == 1)
                    && (goes_elsewhere || preposition(&self.rest()).is_some())
                || matches!(self.peek(), Some("on" | "off" | "should" | "must" | "is" | "are" | "needs"))
                || matches!(self.peek(), Some("stays" | "stay")) && self.ahead(1).state_told();
            if another_pair {
                self.position = start;
                return;
            }
            let movable = self.is_movable(&phrase);
            // "in the fridge, light switch down": nothing is put into a switch.
            let holds_nothing = matches!(&phrase.head, Head::Noun(noun)
                if !noun.class && self.has_affordance(noun, "toggleable") && !self.has_affordance(noun, "receptacle"));
            if !movable && holds_nothing && matches!(relation, Relation::In | Relation::To) {
                self.position = start;
                return;
            }
            if movable && relation != Relation::With {
                clause.objects.push(phrase);
            } else {
                clause.places.push(Place::new(relation, "", phrase));
            }
        }
    }

    /// Whether a phrase names what stands where it is and can be opened.
    fn is_openable(&self, phrase: &Phrase) -> bool {
        matches!(&phrase.head, Head::Noun(noun) if self.has_affordance(noun, "openable"))
            && !self.is_movable(phrase)
    }

    /// "with a card in hand, turn on the lamp": places said before the verb.
    pub(super) fn leading_places(&mut self, clause: &mut Clause<'a>) {
        let start = self.position;
        while let Some((relation, length)) = preposition(&self.rest()) {
            if matches!(relation, Relation::To | Relation::For) || self.verbs_here().is_some() {
                break;
            }
            self.position += length;
            let Some(phrase) = self.phrase(0) else { break };
            clause.places.push(Place::new(relation, "", phrase));
        }
        if self.peek() == Some(",") {
            self.position += 1;
        }
        if self.verbs_here().is_none() {
            clause.places.clear();
            self.position = start;
        }
    }

    /// "all dishes on the counter should be clean": those that are there; nothing is put anywhere.
    pub(super) fn place_of_many(&self, clause: &mut Clause<'a>, start: usize) {
        const SHALL: [&str; 6] = ["should", "must", "shall", "need", "needs", "gets"];
        let said = self.words.get(start..self.position).unwrap_or_default();
        let Some(shall) = said.iter().position(|word| SHALL.contains(&word.as_str())) else { return };
        let is_place = |word: &String| {
            preposition(&[word]).is_some_and(|(r, _)| matches!(r, Relation::In | Relation::To))
        };
        let only_before = said[..shall].iter().any(is_place) && !said[shall..].iter().skip(2).any(is_place);
        let several = |phrase: &Phrase| matches!(phrase.quantity, Quantity::All | Quantity::Plural);
        let many = only_before && clause.objects.last().is_some_and(several);
        if let ([place], true) = (clause.places.as_slice(), many)
            && place.relation == Relation::In
        {
            let place = clause.places.remove(0);
            clause.objects.iter_mut().filter(|phrase| several(phrase)).for_each(|p| p.at.push(place.clone()));
        }
    }
}

/// "on the sink", "on the edge of the sink": beside the basin, on what that is let into.
fn is_on_the_rim(preposition: &str, phrase: &Phrase) -> bool {
    let basin = matches!(&phrase.head, Head::Noun(noun)
        if noun.kinds.first().is_some_and(|kind| ["SinkBasin", "Sink"].contains(&kind.as_str())));
    let on =
        ["on", "onto", "on to", "on top of", "upon", "atop", "over on", "down on"].contains(&preposition);
    let rim = phrase.text.split(' ').any(|word| ["edge", "rim", "ledge", "lip"].contains(&word));
    basin && phrase.quantity == Quantity::One && (on || rim)
}
