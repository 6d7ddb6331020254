//! What is added to what was said: "the card too", "same for the lettuce", "then onto the table with it", ". On the desk."

use super::{LONGEST_ASIDE, Rewriting};
use crate::offline::syntax::{Relation, is_determiner, preposition};

/// Said behind what is added.
const TOO: [&[&str]; 5] = [&["too"], &["as", "well"], &["also"], &["likewise"], &["instead"]];

/// Said before what is added.
const SAME: [&[&str]; 11] = [
    &["same", "for"],
    &["same", "with"],
    &["same", "goes", "for"],
    &["the", "same", "for"],
    &["the", "same", "with"],
    &["the", "same", "goes", "for"],
    &["likewise"],
    &["ditto", "for"],
    &["ditto"],
    &["and", "likewise"],
    &["and", "same", "for"],
];

impl Rewriting<'_> {
    /// All of them, part by part.
    pub(super) fn afterthoughts(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || self.is_mark(index - 1);
            if opens && !self.is_mark(index) {
                let _ = self.likewise(index) || self.too(index);
                self.with_it(index);
                self.on_it_goes(index);
                self.not_there(index);
                self.lights_out(index);
                self.state_and_place(index);
                self.same_thing(index);
                self.goes_there(index);
                self.then_it(index);
                self.states_behind(index);
                self.fine_for_it(index);
                self.place_alone(index);
            }
            index += 1;
        }
    }

    /// "bin the egg. same for the lettuce": the lettuce too; what comes behind it is another thing.
    fn likewise(&mut self, index: usize) -> bool {
        let Some(length) = self.one_of(index, &SAME) else { return false };
        let end = self.next_mark(index, &[",", "."]);
        if index == 0 || end <= index + length || !self.names_only(index + length, end) {
            return false;
        }
        self.say(index, index + length, &[]);
        self.add_to_what_was_said(index, end - length);
        true
    }

    /// "… the coffee machine: same thing": the coffee machine too.
    fn same_thing(&mut self, index: usize) {
        let same =
            self.at(index) == "same" && ["thing", "here", "again", "deal"].contains(&self.at(index + 1));
        let before = self.clause_start(index.saturating_sub(1));
        let joins = usize::from(self.at(before) == "and");
        if same && self.is_mark(index + 2) && before > 0 && self.names_only(before + joins, index - 1) {
            self.say(index - 1, index + 2, &[]);
            self.say(before, before + joins, &[]);
            self.add_to_what_was_said(before, index - 1 - joins);
        }
    }

    /// "the book too", "blinds down as well": added, or said again.
    fn too(&mut self, index: usize) -> bool {
        let end = self.next_mark(index, &[",", "."]);
        let Some(too) =
            (index + 1..end).find(|&at| self.one_of(at, &TOO).is_some_and(|length| at + length == end))
        else {
            return false;
        };
        let joins = usize::from(["and", "plus"].contains(&self.at(index)));
        if index > 0 && self.names_only(index + joins, too) {
            self.say(too, end, &[]);
            self.say(index, index + joins, &[]);
            self.add_to_what_was_said(index, too - joins);
            return true;
        }
        let told = (index..too).any(|at| {
            self.lexicon.adjective(&[self.at(at)]).is_some()
                || self.is_place(at)
                || ["down", "up", "on", "off"].contains(&self.at(at))
        });
        let particle = ["away", "off", "on", "out", "up", "down"].contains(&self.at(too - 1));
        if self.is_order(index) && particle {
            // "throw the egg away as well"
            self.say(too, end, &[]);
            return true;
        }
        if told && too - index <= LONGEST_ASIDE && !self.is_order(index) {
            self.say(too, end, &[]);
        }
        told
    }

    /// Joins things to the part before them, and parts them from what comes then.
    fn add_to_what_was_said(&mut self, index: usize, end: usize) {
        if index > 0 {
            self.say(index - 1, index, &[","]);
        }
        let more = end + 1 < self.tokens.len() && self.at(end) == ",";
        if more && !self.lexicon.is_small("parallel", &[self.at(end + 1)]) {
            self.say(end, end + 1, &["."]);
        }
    }

    /// "then onto the table with it", "desk with it": put it there.
    fn with_it(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let joins =
            (index..end).take_while(|&at| ["and", "then", "afterwards"].contains(&self.at(at))).count();
        let start = index + joins;
        if end < start + 3
            || self.at(end - 2) != "with"
            || !["it", "them", "that", "both"].contains(&self.at(end - 1))
        {
            return;
        }
        let there = preposition(&[self.at(start)])
            .is_some_and(|(relation, _)| matches!(relation, Relation::In | Relation::To));
        let bare = self.names_only(start, end - 2) && !self.is_order(start);
        let named = there && self.noun_before(end - 2).is_some();
        if named || bare {
            let mut order = vec!["put".to_owned(), self.at(end - 1).to_owned()];
            if bare {
                order.push("to".to_owned());
            }
            if bare && !is_determiner(self.at(start)) {
                order.push("the".to_owned());
            }
            order.extend(self.words(start..end - 2));
            self.say_all(start, end, &order);
        }
    }

    /// "wash it, then into the drawer": put it there.
    fn on_it_goes(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let joins = (index..end).take_while(|&at| ["and", "then"].contains(&self.at(at))).count();
        let start = index + joins;
        let thing = start + 1 + usize::from(is_determiner(self.at(start + 1)));
        let noun = self.noun_before(end).map_or(0, |noun| noun.len());
        let before = self.clause_start(index.saturating_sub(1));
        let placed = (before..index).any(|at| self.is_place(at));
        let ordered = index > 1 && self.is_order(before) && !(placed && self.says_to_put_or_take(before));
        let said = |it: &str| (before..index).any(|at| self.at(at) == it);
        let it = if said("them") || said("and") && !said("it") { "them" } else { "it" };
        if ordered
            && self.at(start.wrapping_sub(1)) == "then"
            && ["into", "onto", "in", "on"].contains(&self.at(start))
            && noun > 0
            && thing + noun == end
        {
            self.say(start, start, &["put", it]);
        }
    }

    /// "the tissues should be on the toilet, not shut away in a cabinet": not in a cabinet; "to the chair not sofa".
    fn not_there(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let shut = self.is_participle(index + 1) || ["shut", "hidden", "stuck"].contains(&self.at(index + 1));
        if self.at(index) == "not" && shut {
            let away = usize::from(["away", "up", "back"].contains(&self.at(index + 2)));
            if self.is_place(index + 2 + away) {
                self.say(index + 1, index + 2 + away, &[]);
            }
        }
        let not = (index + 2..end).find(|&at| self.at(at) == "not" && self.noun_before(at).is_some());
        if let Some(not) = not.filter(|&not| self.names_only(not + 1, end) && !self.is_order(not + 1))
            && (index..not).any(|at| self.is_place(at))
        {
            self.say(not, end, &[]);
        }
    }

    /// "the bed is fine for it": it goes there.
    fn fine_for_it(&mut self, index: usize) {
        const FINE: [&str; 9] =
            ["fine", "good", "ok", "okay", "perfect", "best", "great", "better", "enough"];
        let end = self.next_mark(index, &[",", "."]);
        let Some(is) = (index + 1..end).find(|&at| self.at(at) == "is") else { return };
        let it = ["it", "them", "that"].contains(&self.at(is + 3));
        // "the fork is fine where it is"
        if FINE.contains(&self.at(is + 1))
            && ["where", "as"].contains(&self.at(is + 2))
            && self.at(is + 3) == "it"
        {
            self.say(is, end, &["stays"]);
            return;
        }
        if self.names_only(index, is)
            && FINE.contains(&self.at(is + 1))
            && self.at(is + 2) == "for"
            && it
            && is + 4 == end
        {
            let mut order = vec!["put".to_owned(), self.at(is + 3).to_owned(), "to".to_owned()];
            if !is_determiner(self.at(index)) {
                order.push("the".to_owned());
            }
            order.extend(self.words(index..is));
            self.say_all(index, end, &order);
        }
    }

    /// "give me the apple, washed. On the table.": put it there.
    fn place_alone(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let there = ["on", "in", "onto", "into", "to"].contains(&self.at(index));
        let thing = index + 1 + usize::from(is_determiner(self.at(index + 1)));
        let noun = self.noun_before(end).map_or(0, |noun| noun.len());
        let alone =
            index > 0 && self.at(index - 1) == "." && (end >= self.tokens.len() || self.at(end) == ".");
        if alone && there && noun > 0 && thing + noun == end {
            self.say(index, index, &["put", "it"]);
        }
    }

    /// "pen and pencil in there": they go there.
    fn goes_there(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let joins = (index..end).take_while(|&at| ["and", "then"].contains(&self.at(at))).count();
        let there = end.saturating_sub(1);
        let inward = usize::from(["in", "on"].contains(&self.at(there.wrapping_sub(1))));
        let things = there.saturating_sub(inward);
        let before = self.clause_start(index.saturating_sub(1));
        let placed = (before..index).any(|at| self.is_place(at));
        if placed
            && self.at(there) == "there"
            && things > index + joins
            && self.names_only(index + joins, things)
            && !self.is_order(index + joins)
        {
            self.say(things, things, &["should", "go"]);
        }
    }

    /// "and the phone, put it in the drawer", "as for the pot, it goes …": the phone, the pot.
    fn then_it(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let about = self.starts(index, &["as", "for"]);
        let joins = if about {
            2
        } else {
            (index..end).take_while(|&at| ["and", "but"].contains(&self.at(at))).count()
        };
        let start = index + joins;
        let from = (start..end).find(|&at| ["from", "in", "on"].contains(&self.at(at)));
        let things = from.filter(|&from| self.names_only(start, from)).unwrap_or(end);
        let close = self.next_mark(end + 1, &[",", "."]);
        let it = (end + 1..close.min(end + 4)).find(|&at| {
            ["it", "that", "them"].contains(&self.at(at)) && self.lexicon.noun(&[self.at(at + 1)]).is_none()
        });
        let ordered =
            self.is_order(end + 1) && it.is_some_and(|it| it > end + 1) || about && it == Some(end + 1);
        let named = joins > 0
            && self.at(end) == ","
            && is_determiner(self.at(start))
            && self.names_only(start, things);
        if let (true, true, Some(it)) = (ordered, named, it) {
            let said = self.words(start..things);
            self.say_all(it, it + 1, &said);
            self.say(index, end + 1, &[]);
            if index > 0 && self.at(index - 1) == "," {
                self.say(index - 1, index, &["."]);
            }
        }
    }

    /// "give me the apple, cold and clean": the cold and clean apple.
    fn states_behind(&mut self, index: usize) {
        const ASKED: [&str; 8] = ["give", "bring", "get", "hand", "fetch", "want", "need", "like"];
        let end = self.next_mark(index, &[",", "."]);
        let state = |at: usize| {
            self.at(at) == "and" && at > index
                || self.lexicon.adjective(&[self.at(at)]).is_some_and(|state| !state.selects)
        };
        let noun = self.noun_before(index.saturating_sub(1)).map_or(0, |noun| noun.len());
        if index < 3 || noun == 0 || end == index || !(index..end).all(state) || self.at(index - 1) != "," {
            return;
        }
        let first = index - 1 - noun;
        let before = self.clause_start(index - 1);
        let asked = (before..before + 3).any(|at| ASKED.contains(&self.at(at)));
        if asked && first > before && is_determiner(self.at(first - 1)) {
            let states = self.words(index..end);
            self.say(index - 1, end, &[]);
            self.say_all(first, first, &states);
        }
    }

    /// "close the fridge, toaster off, lights out": off, and no more, beside so much else.
    fn lights_out(&mut self, index: usize) {
        const BESIDE: usize = 3;
        let marks = (0..self.tokens.len()).filter(|&at| [",", "."].contains(&self.at(at))).count();
        let end = self.next_mark(index, &[",", "."]);
        let light = end > index + 1 && ["light", "lights", "lamp", "lamps"].contains(&self.at(end - 2));
        if index > 0 && marks >= BESIDE && light && self.at(end - 1) == "out" && end - index <= 4 {
            self.say(end - 1, end, &["off"]);
        }
    }

    /// "the candle lit on the counter", "with the laptop closed on the bed": so and there.
    fn state_and_place(&mut self, index: usize) {
        let end = self.next_mark(index, &[",", "."]);
        let with = usize::from(self.at(index) == "with");
        let first = index + with;
        let state = (first + 1..end).find(|&at| ["lit", "open", "closed", "shut"].contains(&self.at(at)));
        let Some(state) = state.filter(|&state| self.names_only(first, state) && !self.is_order(first))
        else {
            return;
        };
        let there = ["on", "in"].contains(&self.at(state + 1)) && is_determiner(self.at(state + 2));
        if there && self.noun_before(end).is_some() {
            self.say(state + 1, state + 1, &["and"]);
            self.say(state, state, &["should", "be"]);
            self.say(index, index + with, &[]);
        }
    }
}
