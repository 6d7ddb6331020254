//! What is spoken of: things as they are named, listed and named again.

use super::Gist;
use super::chunk::{Again, Chunk, Doing, Thing};
use super::saying::{self, Last};
use crate::offline::syntax::Relation;

impl Gist<'_> {
    /// A thing is named: something waits for it, it joins what is spoken of, or it is spoken of from here on.
    pub(super) fn thing(&mut self, at: usize, thing: &Thing) -> Option<()> {
        let thing = &self.part_of_what_opens(thing);
        if thing.absent {
            // What is not here is spoken of, or something is wanted of it that cannot be.
            let wanted = self.pending.is_some() || self.listing || self.is_wanted(at);
            return (!wanted).then_some(());
        }
        self.tells &= matches!(self.chunk_before(at), Some(Chunk::Tells));
        self.named = Some(thing.clone());
        // "the cutlery in the drawer, but not the knife": not all of it.
        let of_them = |known: &Thing| {
            known.kinds.len() > 1
                && known != thing
                && thing.kinds.iter().any(|kind| known.kinds.contains(kind))
        };
        if (self.denied || self.leaves) && self.topic.iter().chain(&self.before).any(of_them) {
            return None;
        }
        if self.is_a_tool(at) || self.is_left_out(at, thing) || self.is_filled_in(thing) {
            return Some(());
        }
        if self.goes_along(at) && self.affords(thing, "pickupable") {
            self.of_it_alone(thing, Self::as_before)?;
            self.topic.push(thing.clone());
            (self.same, self.listing) = (true, true);
            return Some(());
        }
        if let Some(doing) = self.pending.take()
            && (self.unapplied || self.listing && !self.opens_another(at, &doing))
        {
            return self.done_to(at, thing, doing);
        }
        if let Some(leading) = self.leading.take() {
            self.change_topic(vec![thing.clone()]);
            self.do_it(at, &leading)?;
            self.listing = false;
            return Some(());
        }
        self.speak_of(at, thing)?;
        if let Some(liquid) = &thing.full_of {
            // Where it goes is still to come.
            let (fresh, listing) = (self.fresh, self.listing);
            self.saying.filled(std::slice::from_ref(thing), liquid);
            (self.fresh, self.listing) = (fresh, listing);
        }
        Some(())
    }

    /// Does to a thing what waits for it, and for those listed behind it.
    fn done_to(&mut self, at: usize, thing: &Thing, doing: Doing) -> Option<()> {
        if std::mem::take(&mut self.unapplied) {
            self.leave_topic()?;
            self.change_topic(Vec::new());
        }
        self.add(thing);
        self.of_it_alone(thing, |gist| gist.do_it(at, &doing))?;
        (self.pending, self.listing) = (Some(doing), true);
        Some(())
    }

    /// Says something of a thing, and leaves spoken of what was.
    fn of_it_alone(&mut self, thing: &Thing, say: impl FnOnce(&mut Self) -> Option<()>) -> Option<()> {
        let all = std::mem::replace(&mut self.topic, vec![thing.clone()]);
        say(self)?;
        self.topic = all;
        Some(())
    }

    /// "but not the apple", "to the armchair, not the sofa"
    fn is_left_out(&mut self, at: usize, thing: &Thing) -> bool {
        let place = matches!(self.saying.last, Some(Last::Place(_)))
            && self.is_fixed_holder(thing)
            && self.ends_behind(at);
        let left_out = self.denied && (self.pending.is_some() || place);
        self.denied &= !left_out;
        left_out
    }

    /// "the plate with the egg", where it is put somewhere: the plate and what is on it.
    fn is_filled_in(&mut self, thing: &Thing) -> bool {
        let Some(vessel) = self.topic.last_mut().filter(|_| self.contents && self.homeless.is_some()) else {
            return false;
        };
        let joint = if vessel.words.iter().any(|word| word == "with") { "and" } else { "with" };
        vessel.words.push(joint.to_owned());
        vessel.words.extend(saying::name(thing));
        true
    }

    /// What something is told of from here on: more of a list, or something else.
    fn speak_of(&mut self, at: usize, thing: &Thing) -> Option<()> {
        if self.listing && self.homeless.is_some() && !self.topic.is_empty() && !self.fresh {
            // "put it with a glass on the table"
            self.add(thing);
            return Some(());
        }
        if self.front.is_some() && self.topic.iter().any(|known| known.words == thing.words) {
            // "on the table the plate and the spoon, the spoon washed"
            self.change_topic(vec![thing.clone()]);
            (self.fresh, self.listing) = (false, false);
            return Some(());
        }
        if self.same && self.chunk_before(at) == Some(&Chunk::Join(false)) {
            (self.same, self.listing) = (false, false);
        }
        let together = self.fresh && matches!(self.chunk_before(at), Some(Chunk::With(_)));
        if together || self.listing && (self.fresh || self.front.is_some() || self.same) {
            self.add(thing);
        } else if self.fresh {
            return None;
        } else {
            self.change_topic(Vec::new());
            self.add(thing);
        }
        let only_named = self.is_only_named(at);
        (self.fresh, self.listing) = (!only_named, !only_named);
        if self.same {
            self.of_it_alone(thing, Self::as_before)?;
            self.listing = true;
        } else if let Some(front) = self.front.clone().filter(|_| self.affords(thing, "pickupable")) {
            self.saying.put(std::slice::from_ref(thing), &front);
            (self.fresh, self.listing) = (false, true);
        }
        Some(())
    }

    /// "on the shelf with the vase", "in place of the newspaper": nothing is said of it.
    fn is_only_named(&self, at: usize) -> bool {
        let with = matches!(self.chunk_before(at), Some(Chunk::With(_)))
            && matches!(self.chunks.get(at.wrapping_sub(2)), Some(Chunk::Place(..)))
            && self.ends_behind(at);
        with || matches!(self.chunk_before(at), Some(Chunk::Beside))
    }

    /// "put the card in the box, then the keys": what nothing was said of goes where the last went.
    pub(super) fn leave_topic(&mut self) -> Option<()> {
        if !self.fresh {
            return Some(());
        }
        matches!(self.saying.last, Some(Last::Place(_))).then_some(())?;
        self.as_before()
    }

    pub(super) fn change_topic(&mut self, topic: Vec<Thing>) {
        self.before = std::mem::replace(&mut self.topic, topic);
        self.frozen = false;
    }

    pub(super) fn add(&mut self, thing: &Thing) {
        self.topic.push(thing.clone());
        self.recent.retain(|known| known != thing);
        if self.affords(thing, "pickupable") {
            self.recent.push(thing.clone());
        }
        if self.topic.len() > 1 {
            self.listed.clone_from(&self.topic);
        }
    }

    /// "wipe the mirror with the cloth": by what it is done.
    pub(super) fn is_a_tool(&self, at: usize) -> bool {
        matches!(self.chunk_before(at), Some(Chunk::With(_)))
            && matches!(self.saying.last, Some(Last::Done(_)))
            && !self.fresh
            && self.ends_behind(at)
            && matches!(
                self.chunks.get(at.wrapping_sub(2)),
                Some(Chunk::Thing(_) | Chunk::Again(_) | Chunk::Place(..) | Chunk::Act(_))
            )
    }

    /// "on the plate with the lettuce": it goes there too.
    pub(super) fn goes_along(&self, at: usize) -> bool {
        matches!(self.chunk_before(at), Some(Chunk::With(_)))
            && matches!(self.chunks.get(at.wrapping_sub(2)), Some(Chunk::Place(..)))
            && matches!(self.saying.last, Some(Last::Place(_)))
            && match self.chunk(at + 1) {
                // "with the plate and the bowl"
                Some(Chunk::Join(true)) if matches!(self.chunk(at + 2), Some(Chunk::Thing(_))) => {
                    self.ends_behind(at + 2)
                }
                behind if behind.is_none_or(Chunk::ends_part) => {
                    matches!(self.chunk_before(at), Some(Chunk::With(true)))
                        || matches!(&self.chunks[at], Chunk::Thing(thing) if self.is_described(thing))
                }
                Some(Chunk::State(words, _)) => ["full", "filled"].contains(&words[0].as_str()),
                _ => false,
            }
    }

    /// "a slice", "the sliced lettuce": one that is to be so, rather than one that is there.
    fn is_described(&self, thing: &Thing) -> bool {
        let asked = |word: &String| self.lexicon.adjective(&[word]).is_some_and(|state| !state.selects);
        ["a", "an", "some"].contains(&thing.words[0].as_str()) || thing.words.iter().any(asked)
    }

    /// "its door": that of what was spoken of.
    pub(super) fn part_of_what_opens(&self, thing: &Thing) -> Thing {
        let door = ["door", "doors", "lid"].contains(&thing.words[thing.words.len() - 1].as_str());
        if !door || !thing.absent {
            return thing.clone();
        }
        let place = self.place.iter().filter_map(|(_, thing)| thing.as_ref());
        let mut known = self.topic.iter().rev().chain(place);
        if let Some(opens) = known.clone().find(|thing| self.affords(thing, "openable")) {
            return opens.clone();
        }
        // The door of the shower is the shower door.
        let of = |known: &Thing| {
            let name = [known.words.last()?.as_str(), "door"];
            let (noun, _) = self.lexicon.noun(&name)?;
            let here = noun.kinds.iter().any(|kind| self.scene.has(kind));
            let words = ["the", name[0], name[1]].map(str::to_owned).to_vec();
            here.then(|| Thing {
                words,
                kinds: noun.kinds.clone(),
                plural: false,
                absent: false,
                full_of: None,
            })
        };
        known.find_map(of).unwrap_or_else(|| thing.clone())
    }

    /// Whether a thing in a list of what something is done to begins something else: "boil the egg, wine in the fridge".
    pub(super) fn opens_another(&self, at: usize, doing: &Doing) -> bool {
        let comma = self.chunk_before(at) == Some(&Chunk::Join(false));
        let then = self.chunk_before(at) == Some(&Chunk::But);
        let listed = |chunk: &&Chunk| match chunk {
            Chunk::Thing(_) | Chunk::Join(true) => true,
            Chunk::Join(false) => then,
            _ => false,
        };
        let behind = self.chunks[at + 1..].iter().find(|chunk| !listed(chunk));
        match behind {
            Some(Chunk::Wish | Chunk::Stays | Chunk::Tells) => true,
            // "turn on the toaster and lights out"
            Some(Chunk::State(_, set)) => {
                let off = set.get("isToggled") == Some(&crate::offline::no());
                let on = doing.wants.as_deref() == Some("toggleable")
                    && !doing
                        .words
                        .iter()
                        .any(|word| ["off", "out", "stop", "kill"].contains(&word.as_str()));
                comma || then || off && on
            }
            Some(Chunk::Place(Relation::In | Relation::To, ..)) => comma,
            _ => false,
        }
    }

    /// Whether something is said of what stands at a place.
    pub(super) fn is_wanted(&self, at: usize) -> bool {
        matches!(
            self.chunk(at + 1),
            Some(Chunk::State(..) | Chunk::Wish | Chunk::Place(Relation::In | Relation::To, ..))
        ) || matches!(self.chunk_before(at), Some(Chunk::Moves(_)))
    }

    pub(super) fn again(&mut self, at: usize, again: Again) -> Option<()> {
        // "the knife with them"
        if matches!(self.chunk_before(at), Some(Chunk::With(_))) {
            if self.fresh
                && let Some((place, _)) = self.place.clone()
            {
                self.put(&place);
            }
            return Some(());
        }
        match again {
            Again::First | Again::Last => {
                let thing = if again == Again::First { self.listed.first() } else { self.listed.last() };
                let thing = thing.filter(|_| self.listed.len() > 1)?.clone();
                self.put_with_the_rest();
                if self.fresh && self.topic.len() > 1 {
                    return None;
                }
                self.change_topic(vec![thing]);
                self.fresh = true;
            }
            Again::One => self.one_of_them(),
            Again::All(number) => self.several(number),
        }
        if let Some(doing) = self.pending.take().filter(|_| self.unapplied) {
            self.unapplied = false;
            self.do_it(at, &doing)?;
        }
        self.listing = false;
        Some(())
    }

    /// "it": what it can be done to, the last named first.
    pub(super) fn one_of_them(&mut self) {
        let wants = self.pending.as_ref().and_then(|doing| doing.wants.clone());
        let place = self.place.iter().filter_map(|(_, thing)| thing.as_ref());
        let can_be = |thing: &&Thing| wants.as_ref().is_none_or(|wants| self.affords(thing, wants));
        let device = |thing: &&Thing| can_be(thing) && self.affords(thing, "toggleable");
        let recent = self.recent.iter().rev();
        let devices = wants.is_some().then(|| self.topic.iter().rev().find(device)).flatten();
        let one =
            devices.or_else(|| self.topic.iter().rev().chain(place).chain(recent).find(can_be)).cloned();
        let whole = self.topic.len() == 1 || self.fresh && self.topic.iter().any(|thing| can_be(&thing));
        if let Some(one) = one.filter(|one| !whole || !self.topic.contains(one)) {
            self.change_topic(vec![one]);
        }
    }

    /// "both", "all three", "them" where one was spoken of last: those that were spoken of.
    pub(super) fn several(&mut self, number: usize) {
        let listed = self.topic.len() > 1 || self.topic.iter().any(|thing| thing.plural);
        if listed && (number == 0 || number == self.topic.len()) || self.recent.len() < 2.max(number) {
            return;
        }
        let from = if number == 0 { 0 } else { self.recent.len() - number };
        let several = self.recent.split_off(from);
        self.recent.clear();
        self.change_topic(several);
    }
}
