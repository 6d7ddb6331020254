//! What comes along with an order: "with the sponge left in the sink", "with the drawers all closed", "with the mug
//! underneath", "next to a plate of toast", "the desk lamp as the only light on".

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

/// How something is where it stays.
const STAYING: [&str; 12] = [
    "left", "kept", "staying", "standing", "sitting", "lying", "waiting", "resting", "placed", "put",
    "stored", "ready",
];

/// Inward, as where something goes is said.
const INWARD: [&str; 5] = ["in", "on", "inside", "onto", "into"];

/// What things are put in and carried with.
const VESSELS: [&str; 6] = ["bowl", "plate", "pot", "pan", "cup", "mug"];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn accompaniments(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            if self.at(index) == "with" {
                let _ = self.gathered_in_it(index)
                    || self.with_left(index)
                    || self.with_all_so(index)
                    || self.with_underneath(index);
            }
            self.beside_another(index);
            self.only_light(index);
            self.table_needs(index);
            self.used_for(index);
            self.whole_salad(index);
            self.the_mixture(index);
            index += 1;
        }
    }

    /// "…, with the sponge left in the sink": put it there.
    fn with_left(&mut self, index: usize) -> bool {
        let end = self.sentence_end(index);
        let left = (index + 2..end).find(|&at| STAYING.contains(&self.at(at)));
        let Some(left) = left.filter(|&left| self.names_only(index + 1, left)) else { return false };
        let there = INWARD.contains(&self.at(left + 1)) && is_determiner(self.at(left + 2));
        let comma = index > 1 && self.at(index - 1) == ",";
        if there && comma {
            self.say(left, left + 1, &[]);
            self.say(index - 1, index + 1, &[".", "put"]);
        }
        there && comma
    }

    /// "With the pen and the pencil gathered in it, the bowl goes …": put them in the bowl.
    fn gathered_in_it(&mut self, index: usize) -> bool {
        let opens = index == 0 || self.at(index - 1) == ".";
        let end = self.next_mark(index, &["."]);
        let it = (index + 3..end).find(|&at| {
            ["it", "them"].contains(&self.at(at))
                && INWARD.contains(&self.at(at - 1))
                && self.at(at + 1) == ","
        });
        let Some(it) = it.filter(|_| opens) else { return false };
        let placed = usize::from(
            !self.names_only(index + 1, it - 1)
                && (self.is_participle(it - 2) || STAYING.contains(&self.at(it - 2))),
        );
        let told = (it + 3..end.min(it + LONGEST_ASIDE)).find(|&at| {
            self.noun_before(at).is_some() && (SHALL.contains(&self.at(at)) || is_going(self.at(at)))
        });
        let things = it - 1 - placed;
        if let Some(told) = told.filter(|_| self.names_only(index + 1, things)) {
            let vessel = self.words(it + 2..told);
            self.say(it + 1, it + 2, &["."]);
            self.say_all(it, it + 1, &vessel);
            self.say(things, things + placed, &[]);
            self.say(index, index + 1, &["put"]);
        }
        told.is_some()
    }

    /// "…, with the fridge, drawers and cabinets all closed": they should be.
    fn with_all_so(&mut self, index: usize) -> bool {
        let end = self.sentence_end(index);
        let state = (index + 2..end).find(|&at| {
            let ends = self.is_mark(at + 1)
                || ["again", "afterwards", "afterward", "behind", "too", "at", "after"]
                    .contains(&self.at(at + 1));
            ends && self.lexicon.adjective(&[self.at(at)]).is_some()
        });
        let Some(state) = state else { return false };
        let all = usize::from(["all", "both", "each"].contains(&self.at(state - 1)));
        let things = index + 1..state - all;
        let several = things.clone().any(|at| self.at(at) == "and");
        if !several || index == 0 || !self.names_only(things.start, things.end) {
            return false;
        }
        let mut said = vec![".".to_owned()];
        for at in things.clone() {
            // "drawers and cabinets": all of them.
            let bare = at == things.start || ["and", ","].contains(&self.at(at - 1));
            if bare && !is_determiner(self.at(at)) && !["and", ","].contains(&self.at(at)) {
                said.push("the".to_owned());
            }
            said.push(self.at(at).to_owned());
        }
        said.extend(["should".to_owned(), "be".to_owned()]);
        let comma = usize::from(self.at(index - 1) == ",");
        self.say_all(index - comma, state, &said);
        true
    }

    /// "start the machine with the mug underneath": and put the mug under it.
    fn with_underneath(&mut self, index: usize) -> bool {
        let end = self.next_mark(index, &[",", "."]);
        let under = (index + 2..end).find(|&at| {
            let alone = ["underneath", "beneath", "below", "under"].contains(&self.at(at));
            let it = usize::from(self.at(at + 1) == "it");
            alone && (self.is_mark(at + 1 + it) || self.at(at + 1 + it) == "and")
        });
        let Some(under) = under.filter(|&under| index > 0 && self.names_only(index + 1, under)) else {
            return false;
        };
        let it = usize::from(self.at(under + 1) == "it");
        self.say(under, under + 1 + it, &["under", "it"]);
        let comma = usize::from(self.at(index - 1) == ",");
        self.say(index - comma, index + 1, &["and", "put"]);
        true
    }

    /// "serve it on the counter next to a plate of toast": the plate goes there too.
    fn beside_another(&mut self, index: usize) {
        const BESIDE: [&[&str]; 6] = [
            &["next", "to"],
            &["beside"],
            &["alongside"],
            &["together", "with"],
            &["along", "with"],
            &["with"],
        ];
        let Some(length) = self.one_of(index, &BESIDE) else { return };
        // "with the filled cup": one that is to be so goes there too.
        let asked = self.lexicon.adjective(&[self.at(index + length + 1)]).is_some();
        let first = self.at(index + length);
        let another = ["a", "an", "some"].contains(&first) || first == "the" && asked;
        let start = self.clause_start(index);
        let order = (start..index).find(|&at| self.is_order(at));
        let place =
            order.and_then(|order| (order + 2..index).find(|&at| ["on", "onto"].contains(&self.at(at))));
        let Some(place) = place.filter(|&place| another && self.names_only(place + 1, index)) else { return };
        let end = self.next_mark(index, &[",", "."]);
        let end = (index..end).find(|&at| self.at(at) == "and" && self.is_order(at + 1)).unwrap_or(end);
        if (index + length..end).any(|at| self.is_place(at) && self.at(at) != "with") {
            return;
        }
        let mut company = vec!["and".to_owned()];
        company.extend(self.words(index + length..end));
        self.say(index, end, &[]);
        self.say_all(place, place, &company);
    }

    /// "leave the desk lamp as the only light on": it should be on, and no other.
    fn only_light(&mut self, index: usize) {
        // "leave only the desk lamp on"
        let leaves = ["leave", "keep", "have"].contains(&self.at(index)) && self.at(index + 1) == "only";
        let on = (index + 3..index + 8).find(|&at| ["on", "lit", "burning"].contains(&self.at(at)));
        if let Some(on) = on.filter(|&on| leaves && self.names_only(index + 2, on))
            && ["lamp", "light", "lights", "lamps"].contains(&self.at(on - 1))
        {
            self.say(on, on + 1, &["and", "turn", "off", "all", "other", "lights"]);
            self.say(index, index + 2, &["turn", "on"]);
            return;
        }
        let only = self.at(index) == "as" && self.starts(index + 1, &["the", "only"]);
        let light = ["light", "lamp", "one", "source"].contains(&self.at(index + 3));
        let start = self.clause_start(index);
        let order = (start..index).find(|&at| ["leave", "keep", "have"].contains(&self.at(at)));
        let Some(order) = order.filter(|&order| only && light && self.names_only(order + 1, index)) else {
            return;
        };
        let end = self.next_mark(index, &[",", "."]);
        self.say(index, end, &["and", "turn", "off", "all", "other", "lights"]);
        self.say(order, order + 1, &["turn", "on"]);
    }

    /// "cut the lettuce, put the whole salad in the bowl": its slices.
    fn whole_salad(&mut self, index: usize) {
        let whole = ["the", "all"].contains(&self.at(index))
            && ["whole", "entire", "the"].contains(&self.at(index + 1));
        let of = usize::from(whole);
        let salad =
            ["salad", "mixture", "mix"].contains(&self.at(index + 1 + of)) && is_determiner(self.at(index));
        let ingredients = usize::from(self.at(index + 2 + of) == "ingredients");
        let place = index + 2 + of + ingredients;
        let vessel = (place + 2..place + 4).any(|at| VESSELS.contains(&self.at(at)));
        let placed = INWARD.contains(&self.at(place)) && vessel && index > 0 && self.is_order(index - 1);
        let cut =
            (0..index).any(|at| ["slice", "cut", "chop", "dice", "sliced", "chopped"].contains(&self.at(at)));
        if salad && placed && cut {
            self.say(index, index + 2 + of + ingredients, &["all", "slices"]);
        }
    }

    /// "mix all of it in a bowl and serve the salad": the bowl.
    fn the_mixture(&mut self, index: usize) {
        const MIXTURES: [&str; 5] = ["salad", "mixture", "mix", "dish", "meal"];
        let named =
            MIXTURES.contains(&self.at(index + 1)) && ["the", "this", "that"].contains(&self.at(index));
        let behind = self.is_mark(index + 2) || self.is_place(index + 2) || self.at(index + 2) == "and";
        let ordered = index > 1 && self.is_order(index - 1);
        if !(named && behind && ordered) {
            return;
        }
        let vessel = (2..index).rev().find(|&at| {
            ["in", "into", "on", "onto"].contains(&self.at(at - 2))
                && is_determiner(self.at(at - 1))
                && VESSELS.contains(&self.at(at))
        });
        if let Some(vessel) = vessel {
            let vessel = self.at(vessel).to_owned();
            self.say(index + 1, index + 2, &[&vessel]);
        }
    }

    /// "the table needs the plate and the cup": they go there.
    fn table_needs(&mut self, index: usize) {
        let needs = ["needs", "need", "gets", "wants"].contains(&self.at(index));
        let surface = ["table", "counter", "countertop", "desk", "shelf", "dresser"];
        let vessel = ["bowl", "plate", "pot", "pan", "box", "drawer", "fridge", "cabinet"];
        let start = self.clause_start(index);
        // "cut the lettuce and the bowl gets it": the bowl.
        let joined = (start..index).rev().find(|&at| ["and", "then"].contains(&self.at(at)));
        let first = joined.map_or(start, |at| at + 1);
        let thing = is_determiner(self.at(index + 1)) || self.noun_from(index + 1).is_some();
        let last = self.at(index.wrapping_sub(1)).to_owned();
        let place = surface.contains(&last.as_str()) || vessel.contains(&last.as_str());
        let thing = thing || ["them", "everything"].contains(&self.at(index + 1));
        let named = index > first && place && self.names_only(first, index);
        if !(needs && named && thing) || self.is_base_verb(index + 2) && self.at(index + 1) == "a" {
            return;
        }
        let end = self.next_mark(index, &["."]);
        let another = |at: usize| {
            let from = at + 1 + usize::from(self.at(at + 1) == "and");
            let close = self.next_mark(from, &[",", "."]);
            let told = |at: usize| SHALL.contains(&self.at(at)) || is_going(self.at(at));
            let next = self.at(from + 1);
            let ordered = self.is_base_verb(from)
                && (is_determiner(next) || ["on", "off", "out", "up"].contains(&next));
            ordered || self.is_order(from) || self.at(at) == "," && (from..close).any(told)
        };
        let stop =
            (index + 1..end).find(|&at| ["and", ","].contains(&self.at(at)) && another(at)).unwrap_or(end);
        // "the table needs a cup on it": told already.
        if (index..stop).any(|at| ["it", "them"].contains(&self.at(at)) && self.is_place(at - 1)) {
            return;
        }
        let mut order = vec!["put".to_owned()];
        order.extend(self.words(index + 1..stop));
        order.push(if surface.contains(&last.as_str()) { "on" } else { "in" }.to_owned());
        order.extend(self.words(first..index));
        self.say_all(first, stop, &order);
    }

    /// "use the bowl for all slices": they go in it.
    fn used_for(&mut self, index: usize) {
        let vessel = ["bowl", "plate", "pot", "pan", "box", "drawer", "cup", "mug", "cabinet", "shelf"];
        let used = self.at(index) == "use" && is_determiner(self.at(index + 1));
        let at = (index + 3..index + 6).find(|&at| self.at(at) == "for");
        let Some(at) = at.filter(|&at| used && vessel.contains(&self.at(at - 1))) else { return };
        let end = self.next_mark(at, &[",", "."]);
        let end = (at..end).find(|&at| self.at(at) == "and" && self.is_order(at + 1)).unwrap_or(end);
        let things = ["everything", "them", "it", "both", "these", "that"].contains(&self.at(at + 1))
            && end == at + 2
            || self.is_part(end - 1)
            || self.names_only(at + 1, end);
        if things && end > at + 1 {
            let inward = if ["plate", "shelf"].contains(&self.at(at - 1)) { "on" } else { "in" };
            let mut order = vec!["put".to_owned()];
            order.extend(self.words(at + 1..end));
            order.push(inward.to_owned());
            order.extend(self.words(index + 1..at));
            self.say_all(index, end, &order);
        }
    }

    /// Where the sentence ends.
    fn sentence_end(&self, index: usize) -> usize {
        self.next_mark(index, &["."])
    }
}
