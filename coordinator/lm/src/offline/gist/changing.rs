//! What things shall be, and what is done to them.

use super::Gist;
use super::chunk::{Chunk, Doing, Thing, Where};
use super::saying::Last;
use crate::offline::inflect::VerbForm;
use crate::offline::lexicon::{Act, Settings};
use crate::offline::scene::is_in_state;
use crate::offline::syntax::Relation;

impl Gist<'_> {
    /// The topic shall be so.
    pub(super) fn state(&mut self, at: usize, words: &[String], set: &Settings) -> Option<()> {
        // "shut the laptop down": said with what was done.
        let particle = words.len() == 1
            && matches!(&self.saying.last, Some(Last::Done(verb)) if verb.len() > 1 && verb.ends_with(words));
        if particle {
            return Some(());
        }
        self.pending = None;
        let untouched = |property: &str| set.get(property) == Some(&crate::offline::no());
        let full = set.contains_key("isFilledWithLiquid") && self.liquid_is_said(at);
        // What is told and is not so is wished.
        let told = std::mem::take(&mut self.tells) && !self.is_untrue(set);
        if told || self.frozen || untouched("isSliced") || untouched("isCooked") || full {
            return Some(());
        }
        let said = words[0].as_str();
        let wanted = self.can_be_so(set, ["up", "down"].contains(&said));
        if wanted.is_empty() {
            return self.says_only_how(at, said);
        }
        let breaks = words == ["sliced"] && !wanted.iter().any(|thing| self.affords(thing, "sliceable"));
        let opens = wanted.iter().any(|thing| self.affords(thing, "openable"));
        let plain = match said {
            "up" if !opens => "on",
            "down" if !opens => "off",
            "up" | "raised" => "open",
            "down" | "lowered" | "drawn" => "closed",
            "out" => "off",
            "sliced" if breaks => "broken",
            _ => "",
        };
        if wanted != self.topic {
            self.change_topic(wanted);
        }
        let denied = std::mem::take(&mut self.denied);
        if !denied && ["on", "running"].contains(&said) && self.only_runs_to_fill(at) {
            self.said();
            return Some(());
        }
        let plain = [plain.to_owned()];
        self.saying.so(&self.topic, if plain[0].is_empty() { words } else { &plain }, denied);
        self.said();
        Some(())
    }

    /// Whether nothing spoken of is so now.
    fn is_untrue(&self, set: &Settings) -> bool {
        let switch = set.contains_key("isToggled") || set.contains_key("isOpen");
        let mut objects =
            self.topic.iter().flat_map(|thing| &thing.kinds).flat_map(|kind| self.scene.of_kind(kind));
        let known = objects.clone().next().is_some();
        switch && known && !objects.any(|object| is_in_state(object, set))
    }

    /// What of the topic can be so; else what it was put into: "put it in the microwave and turn it on".
    fn can_be_so(&self, set: &Settings, upright: bool) -> Vec<Thing> {
        let wants = match set.keys().next().map(String::as_str) {
            Some("isOpen") => "openable",
            Some("isToggled") => "toggleable",
            _ => return self.topic.clone(),
        };
        let can =
            |thing: &&Thing| self.affords(thing, wants) && !(upright && self.affords(thing, "pickupable"));
        let wanted: Vec<Thing> = self.topic.iter().filter(can).cloned().collect();
        // "the lights down"
        let switched =
            |thing: &Thing| self.affords(thing, "toggleable") && !self.affords(thing, "pickupable");
        if upright && wanted.is_empty() && self.topic.iter().all(switched) {
            return self.topic.clone();
        }
        if !wanted.is_empty() || wants != "toggleable" || self.fresh {
            return wanted;
        }
        self.place.iter().filter_map(|(_, thing)| thing.as_ref()).filter(can).cloned().collect()
    }

    /// "up on the shelf", "the bottle out of the cupboard"; "hang the towels up" is what is done.
    fn says_only_how(&mut self, at: usize, said: &str) -> Option<()> {
        let upright = ["up", "down"].contains(&said);
        if let Some(verb) = self.homeless.clone().filter(|verb| upright && self.has_particle(verb, said)) {
            self.saying.done(&self.topic, &[verb, said.to_owned()]);
            self.said();
            return Some(());
        }
        let of_a_thing = matches!(self.chunk_before(at), Some(Chunk::Thing(_) | Chunk::Again(_)));
        let denied = std::mem::take(&mut self.denied);
        let how = denied || upright || said == "out" || !of_a_thing && ["on", "off"].contains(&said);
        how.then_some(())
    }

    /// Whether a verb of the lexicon takes a particle.
    pub(super) fn has_particle(&self, verb: &str, particle: &str) -> bool {
        self.lexicon.verbs(verb).iter().any(|(_, particles, _)| *particles == [particle.to_owned()])
    }

    /// "full of water"
    pub(super) fn liquid_is_said(&self, at: usize) -> bool {
        matches!(self.chunk(at + 1), Some(Chunk::With(_) | Chunk::Other(_)))
            && matches!(self.chunk(at + 2), Some(Chunk::Liquid(_)))
    }

    /// Something is done: to what is named next, or to the topic.
    pub(super) fn doing(&mut self, at: usize, doing: &Doing) -> Option<()> {
        (self.pending, self.same) = (None, false);
        let past = doing.form == VerbForm::Past;
        if self.homeless.is_some() && !past {
            return None;
        }
        if past && self.comes_before_its_thing(at) {
            self.leading = Some(doing.clone());
            return Some(());
        }
        // "after you have filled the pot"
        let done_to = matches!(self.chunk(at + 1), Some(Chunk::Thing(_) | Chunk::Again(_)))
            && matches!(self.chunk_before(at), Some(Chunk::Wish | Chunk::Other(_)));
        if past && !done_to && self.is_no_wish() {
            return Some(());
        }
        if self.denied {
            return None;
        }
        if doing.act == Act::Store && self.is_said_where(at) {
            return self.moves(doing.words.first().cloned());
        }
        match self.chunks[at + 1..].iter().find(|chunk| !matches!(chunk, Chunk::Other(_))) {
            Some(Chunk::Thing(_) | Chunk::Again(_)) if !past || done_to => {
                (self.pending, self.listing, self.unapplied) = (Some(doing.clone()), false, true);
                Some(())
            }
            // "boil some water in the kettle"
            Some(Chunk::Liquid(_)) if doing.act != Act::Fill => Some(()),
            _ if self.frozen => Some(()),
            _ if past || !std::mem::take(&mut self.tells) && self.is_wished(at) => self.do_it(at, doing),
            _ => self.is_no_order(at, doing).then_some(()),
        }
    }

    /// "once rinsed, the lettuce …"
    fn comes_before_its_thing(&self, at: usize) -> bool {
        matches!(self.chunk_before(at), Some(Chunk::Other(word)) if word == "once")
            && matches!(self.chunk(at + 1), Some(Chunk::Join(false)))
            && matches!(self.chunk(at + 2), Some(Chunk::Thing(_)))
    }

    /// Whether what was done is only told, is not wanted, or was done to nothing here.
    fn is_no_wish(&mut self) -> bool {
        std::mem::take(&mut self.tells) || std::mem::take(&mut self.denied) || self.topic.is_empty()
    }

    /// "store the slices and the bread in the fridge"
    fn is_said_where(&self, at: usize) -> bool {
        let part = self.chunks[at + 1..]
            .iter()
            .take_while(|chunk| !matches!(chunk, Chunk::Stop | Chunk::Act(_) | Chunk::Moves(_)));
        part.clone().any(|chunk| matches!(chunk, Chunk::Place(Relation::In | Relation::To, ..)))
    }

    /// "needs a wash", "wants scrubbing", "let it run"; not "the tap runs", nor "the pot is boiling".
    fn is_wished(&self, at: usize) -> bool {
        let said = self.chunks[..at].iter().rev();
        let before = said.clone().find(|chunk| !matches!(chunk, Chunk::Other(_)));
        let mut sentence = said.take_while(|chunk| !matches!(chunk, Chunk::Stop));
        let listed = matches!(self.chunk_before(at), Some(Chunk::Join(_) | Chunk::But))
            && sentence.any(|chunk| matches!(chunk, Chunk::Wish));
        matches!(before, Some(Chunk::Wish)) || listed || self.moved || self.opens(at) && self.fresh
    }

    /// "a nice soak", "closing up now: …"
    fn is_no_order(&self, at: usize, doing: &Doing) -> bool {
        match doing.form {
            VerbForm::Base => matches!(self.chunk_before(at), Some(Chunk::Other(_))),
            VerbForm::Gerund => matches!(self.chunk_before(at), None | Some(Chunk::Stop)),
            VerbForm::Past => false,
        }
    }

    /// Says that it is done to the topic.
    pub(super) fn do_it(&mut self, at: usize, doing: &Doing) -> Option<()> {
        if self.topic.is_empty() {
            return None;
        }
        if !doing.words.iter().any(|word| word == "off") && self.only_runs_to_fill(at) {
            self.said();
            return Some(());
        }
        if doing.act == Act::Fill {
            self.liquid = self.filling(at);
            if self.liquid.is_some() {
                self.fill_what_can_be();
                return Some(());
            }
        }
        self.saying.done(&self.topic, &doing.words);
        self.said();
        self.acted = true;
        Some(())
    }

    /// "the plate and the cup filled with water": the cup; where they go is still to come.
    fn fill_what_can_be(&mut self) {
        let can = |thing: &Thing| self.affords(thing, "canFillWithLiquid");
        let last = self.topic.last().filter(|_| !self.topic.iter().all(can)).cloned();
        let Some(last) = last else { return self.fill() };
        let (fresh, listing) = (self.fresh, self.listing);
        let all = std::mem::replace(&mut self.topic, vec![last]);
        self.fill();
        (self.fresh, self.listing, self.topic) = (fresh, listing, all);
    }

    /// "turn on the tap and fill the kettle": what runs is not to go on running.
    fn only_runs_to_fill(&self, at: usize) -> bool {
        let tap = self.topic.iter().all(|thing| thing.kinds.iter().any(|kind| kind == "Faucet"));
        let fills = |chunk: &Chunk| {
            matches!(chunk, Chunk::Liquid(_)) || matches!(chunk, Chunk::Act(doing) if doing.act == Act::Fill)
        };
        let mut sentence = self.chunks[at..].iter().take_while(|chunk| !matches!(chunk, Chunk::Stop));
        tap && sentence.any(fills)
    }

    /// What something is filled with: said behind it, before anything else is spoken of.
    pub(super) fn filling(&mut self, at: usize) -> Option<String> {
        let mut things = 0;
        for next in at + 1..self.chunks.len() {
            match &self.chunks[next] {
                Chunk::Liquid(liquid) if !self.taken.contains(&next) => {
                    self.taken.push(next);
                    return Some(liquid.clone());
                }
                Chunk::Place(_, _, Where::At(from)) => {
                    let is = |kinds: &[&str]| from.kinds.iter().any(|kind| kinds.contains(&kind.as_str()));
                    let liquid = match () {
                        () if is(&["CoffeeMachine"]) => "coffee",
                        () if is(&["Faucet", "Sink", "SinkBasin"]) => "water",
                        () => return None,
                    };
                    self.taken.push(next);
                    return Some(liquid.to_owned());
                }
                Chunk::Thing(_) => things += 1,
                Chunk::Again(_) | Chunk::With(_) | Chunk::Other(_) | Chunk::State(..) => {}
                _ => return None,
            }
            if things > 1 {
                return None;
            }
        }
        None
    }

    /// Says that the topic holds the liquid.
    pub(super) fn fill(&mut self) {
        if let Some(liquid) = self.liquid.take() {
            self.saying.filled(&self.topic, &liquid);
            self.said();
        }
    }

    pub(super) fn liquid(&mut self, at: usize, liquid: &str) -> Option<()> {
        if self.taken.contains(&at) {
            return Some(());
        }
        let behind = self.chunks[..at].iter().rposition(|chunk| {
            !matches!(chunk, Chunk::Other(word) if !["of", "holding", "containing"].contains(&word.as_str()))
        });
        let of = match behind.map(|behind| &self.chunks[behind]) {
            Some(Chunk::Other(word)) => ["of", "holding", "containing"].contains(&word.as_str()),
            Some(Chunk::State(words, _)) => ["full", "filled"].contains(&words[0].as_str()),
            Some(Chunk::With(_) | Chunk::Holds) => true,
            _ => false,
        };
        // "with water in the cup": where it goes is still to come.
        let of = of
            && !matches!(self.chunk(at + 1), Some(Chunk::Place(_, _, Where::At(vessel)))
            if self.affords(vessel, "canFillWithLiquid"));
        let vessel =
            self.topic.last().filter(|thing| of && self.affords(thing, "canFillWithLiquid")).cloned();
        self.liquid = Some(liquid.to_owned());
        let Some(vessel) = vessel else { return Some(()) };
        let fresh = self.fresh;
        let all = std::mem::replace(&mut self.topic, vec![vessel]);
        self.fill();
        // "a plate and a mug of coffee on the table": where they go is still to come.
        (self.fresh, self.topic) = (fresh && all.len() > 1, all);
        self.listing = self.fresh;
        Some(())
    }
}
