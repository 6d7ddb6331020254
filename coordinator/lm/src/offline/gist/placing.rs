//! Where things go.

use super::Gist;
use super::chunk::{Chunk, Thing, Where};
use super::saying::{self, Last};
use crate::offline::lexicon::Act;
use crate::offline::syntax::Relation;

impl Gist<'_> {
    /// Something is said to be or go somewhere.
    pub(super) fn placed(
        &mut self,
        at: usize,
        relation: Relation,
        preposition: &[String],
        place: &Where,
    ) -> Option<()> {
        // "the cup with water in it"
        let of_water = matches!(place, Where::AtIt)
            && self.liquid.is_none()
            && matches!(self.chunk_before(at), Some(Chunk::Liquid(_)));
        if self.taken.contains(&at) || of_water {
            return Some(());
        }
        self.pending = None;
        if let Where::At(thing) = place {
            self.named = Some(thing.clone());
        }
        // "put it away from the shelf": not where it is.
        let stored = |chunk: &Chunk| matches!(chunk, Chunk::Act(doing) if doing.act == Act::Store);
        if relation == Relation::From && self.chunks[at.saturating_sub(3)..at].iter().any(stored) {
            return None;
        }
        if relation == Relation::From || self.is_no_goal(at, relation, place) {
            // "the dishes in the sink": not all of them.
            return (!self.tells_which_of_many(at, relation, place)).then_some(());
        }
        let (named, thing) = self.place_meant(relation, preposition, place)?;
        if self.fills_it(thing.as_ref()) || self.is_by_what_it_is_done(thing.as_ref()) {
            return Some(());
        }
        if relation == Relation::In && self.is_done_there(at) {
            self.saying.there(&named);
        } else if let Some(held) = self.is_about_a_place(at).cloned() {
            if self.affords(&held, "pickupable") && thing.is_some() {
                self.saying.put(std::slice::from_ref(&held), &named);
            }
            return Some(());
        } else if self.is_said_first(at) {
            (self.front, self.homeless) = (Some(named.clone()), None);
            if matches!(self.chunk(at + 1), Some(Chunk::Join(false))) {
                self.change_topic(thing.iter().cloned().collect());
            }
        } else if self.topic.iter().any(|thing| self.affords(thing, "pickupable")) {
            self.put(&named);
        } else {
            return None;
        }
        self.place = Some((named, thing));
        Some(())
    }

    /// Whether a place only says which thing is meant, where it is not to be, or what it is near where it is.
    fn is_no_goal(&mut self, at: usize, relation: Relation, place: &Where) -> bool {
        let near = relation == Relation::Near && self.homeless.is_none() && !self.fresh;
        // "on the table next to the cup"
        let put = matches!(self.saying.last, Some(Last::Place(_)));
        if near && (put || !matches!(place, Where::At(_))) {
            return true;
        }
        // "put the pot with the potato in it on the stove"
        if std::mem::take(&mut self.contents) && matches!(place, Where::AtIt) {
            return true;
        }
        let ignored = std::mem::take(&mut self.tells) || self.frozen || std::mem::take(&mut self.denied);
        let ignored = ignored || self.only_tells_which(at);
        if ignored {
            self.homeless = None;
        }
        ignored
    }

    /// Whether a place behind things tells some of them from others.
    fn tells_which_of_many(&self, at: usize, relation: Relation, place: &Where) -> bool {
        const CLASS: usize = 3;
        let many = |thing: &Thing| {
            thing.kinds.len() > CLASS
                || relation != Relation::From
                    && (thing.plural || ["every", "each", "any"].contains(&thing.words[0].as_str()))
        };
        let before = match self.chunk_before(at) {
            Some(Chunk::Tells) => self.chunks.get(at.wrapping_sub(2)),
            before => before,
        };
        matches!(place, Where::At(_)) && matches!(before, Some(Chunk::Thing(thing)) if many(thing))
    }

    /// The place in words, and the thing that it is, if it is one.
    fn place_meant(
        &self,
        relation: Relation,
        preposition: &[String],
        place: &Where,
    ) -> Option<(Vec<String>, Option<Thing>)> {
        let thing = match place {
            Where::There => return self.place.clone(),
            Where::At(thing) if thing.absent => return None,
            Where::At(thing) => return Some((at_thing(preposition, thing), Some(thing.clone()))),
            Where::AtIt if relation == Relation::Near => self.before.last()?.clone(),
            Where::AtIt => {
                // "the cup should have water in it"
                let filled = self.topic.last().filter(|_| self.liquid.is_some());
                let filled = filled.filter(|thing| self.affords(thing, "canFillWithLiquid")).cloned();
                filled.or_else(|| self.holder())?
            }
        };
        Some((at_thing(preposition, &saying::again(&thing)), Some(thing)))
    }

    /// "water into the mug"
    fn fills_it(&mut self, vessel: Option<&Thing>) -> bool {
        let vessel = vessel.filter(|vessel| self.affords(vessel, "canFillWithLiquid"));
        let Some(vessel) = vessel.filter(|_| self.liquid.is_some()).cloned() else { return false };
        self.change_topic(vec![vessel]);
        self.fill();
        true
    }

    /// "wash the dishes under the tap": how.
    fn is_by_what_it_is_done(&self, place: Option<&Thing>) -> bool {
        let tap = place.is_some_and(|thing| thing.kinds.iter().any(|kind| kind == "Faucet"));
        tap && matches!(self.saying.last, Some(Last::Done(_))) && self.homeless.is_none() && !self.fresh
    }

    /// "cook the potato in the pan"
    fn is_done_there(&self, at: usize) -> bool {
        self.acted
            && matches!(self.saying.last, Some(Last::Done(_)))
            && matches!(self.chunk_before(at), Some(Chunk::Thing(_) | Chunk::Again(_) | Chunk::Act(_)))
            && self.homeless.is_none()
            && !self.fresh
    }

    /// "on the plate on the table": the plate is to be there.
    fn is_about_a_place(&self, at: usize) -> Option<&'_ Thing> {
        let Some(Chunk::Place(Relation::In | Relation::To, _, Where::At(held))) = self.chunk_before(at)
        else {
            return None;
        };
        let filled = self.topic == [held.clone()];
        let put = filled || matches!(self.saying.last, Some(Last::Place(_)));
        (put && !self.fresh && self.homeless.is_none()).then_some(held)
    }

    pub(super) fn put(&mut self, place: &[String]) {
        self.saying.put(&self.topic, place);
        self.said();
    }

    /// What something may be in or on that was spoken of: what was spoken of before, or where that went.
    pub(super) fn holder(&self) -> Option<Thing> {
        let place = self.place.iter().filter_map(|(_, thing)| thing.as_ref());
        let known = self.before.iter().rev().chain(place).chain(self.topic.iter().rev());
        known
            .filter(|thing| self.affords(thing, "receptacle"))
            .find(|thing| self.topic != [(*thing).clone()])
            .cloned()
    }

    /// "on the bed there should be the book", not "the book on the bed, the ball …"
    pub(super) fn is_said_first(&self, at: usize) -> bool {
        let next = self.chunks.get(at + 1..).unwrap_or_default();
        let said = |chunk: &&Chunk| {
            matches!(
                chunk,
                Chunk::Wish
                    | Chunk::Moves(_)
                    | Chunk::Other(_)
                    | Chunk::Place(_, _, Where::There)
                    | Chunk::Tells
            )
        };
        let things = matches!(next.iter().find(|chunk| !said(chunk)), Some(Chunk::Thing(_)));
        let opens = self.opens(at) || matches!(self.chunk_before(at), Some(Chunk::Moves(_)));
        // "into the box, left open, go …"
        let first = matches!(self.chunk_before(at), None | Some(Chunk::Stop));
        let until_thing = next.iter().take_while(|chunk| !matches!(chunk, Chunk::Thing(_) | Chunk::Stop));
        let inserted = first
            && matches!(next.first(), Some(Chunk::Join(false)))
            && until_thing.clone().any(|chunk| matches!(chunk, Chunk::Wish))
            && matches!(next.get(until_thing.count()), Some(Chunk::Thing(_)));
        (things && opens || inserted) && !self.fresh && self.pending.is_none()
    }

    /// "the fork in the sink gets …", "the cup on the desk to the sink", "on the shelf you find …": where it is now.
    pub(super) fn only_tells_which(&self, at: usize) -> bool {
        let behind_thing = matches!(self.chunk_before(at), Some(Chunk::Thing(_)));
        let told = matches!(self.chunk(at + 1), Some(Chunk::Tells)) && self.is_said_first(at);
        told || behind_thing
            && matches!(
                self.chunk(at + 1),
                Some(Chunk::Wish | Chunk::Place(Relation::In | Relation::To, _, Where::At(_)))
            )
    }
}

pub(super) fn at_thing(preposition: &[String], thing: &Thing) -> Vec<String> {
    let mut words = preposition.to_vec();
    words.extend(saying::name(thing));
    words
}
