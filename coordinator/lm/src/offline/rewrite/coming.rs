//! Where things come from and end up: "the pan comes out of the sink and goes …", "ends up in the box", "plate it".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn comings(&mut self) {
        self.the_thing();
        let mut index = 0;
        while index < self.tokens.len() {
            self.comes_from(index);
            self.ends_up(index);
            self.put_in_between(index);
            self.that_same(index);
            self.before_that(index);
            self.left_of(index);
            self.out_there(index);
            self.looks_nicer(index);
            self.takes_its_place(index);
            self.plated(index);
            self.out_and_into(index);
            self.all_of_them(index);
            self.filled_at(index);
            index += 1;
        }
    }

    /// "fill it at the coffee maker, turn the thing off": what was named last.
    fn the_thing(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let switched = ["turn", "switch", "shut"].contains(&self.at(index - 1))
                && ["on", "off"].contains(&self.at(index + 2));
            if self.starts(index, &["the", "thing"]) && switched {
                let named = (2..index).rev().find_map(|end| self.noun_before(end));
                if let Some(named) = named {
                    self.say_all(index + 1, index + 2, &named);
                }
            }
            index += 1;
        }
    }

    /// "comes out of the sink and goes on the plate", "come off the table and onto the shelf": it goes there.
    fn comes_from(&mut self, index: usize) {
        if index == 0 || !["come", "comes"].contains(&self.at(index)) {
            return;
        }
        let subject = self.noun_before(index).is_some()
            || SHALL.contains(&self.at(index - 1))
            || ["to", "it", "they", "that"].contains(&self.at(index - 1));
        let from = match (self.at(index + 1), self.at(index + 2)) {
            ("out" | "off", "of" | "from") => 2,
            ("off" | "from", _) => 1,
            _ => return,
        };
        let first = index + 1 + from;
        let noun = (first + 1..first + 5).find(|&at| {
            (self.noun_before(at).is_some() || self.at(at - 1) == "there")
                && ["and", ","].contains(&self.at(at))
        });
        let Some(end) =
            noun.filter(|_| subject && (is_determiner(self.at(first)) || self.at(first) == "there"))
        else {
            return;
        };
        let behind = end + 1 + usize::from(self.at(end + 1) == "then");
        let going = if self.at(index) == "comes" { "goes" } else { "go" };
        if is_going(self.at(behind)) || ["get", "gets"].contains(&self.at(behind)) {
            self.say(index, behind, &[]);
        } else if ["onto", "into", "on", "in", "to", "back"].contains(&self.at(behind))
            && self.at(end) == "and"
        {
            self.say(index, behind, &[going]);
        }
    }

    /// "the knife you used ends up in the sink": it goes there.
    fn ends_up(&mut self, index: usize) {
        let used = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
            ("you" | "i" | "we", "used", _) | ("youve" | "weve", "used", _) => 2,
            ("you" | "i" | "we", "have", "used") => 3,
            _ => 0,
        };
        if index > 0 && used > 0 && self.noun_before(index).is_some() {
            let behind = self.at(index + used);
            let ends = is_going(behind) || SHALL.contains(&behind) || ["ends", "end"].contains(&behind);
            if ends || self.is_mark(index + used) || self.is_place(index + used) {
                self.say(index, index + used, &[]);
            }
        }
        let placed = self.at(index + 1) == "up" && self.is_place(index + 2);
        if index > 0
            && placed
            && ["ends", "end"].contains(&self.at(index))
            && self.noun_before(index).is_some()
        {
            let going = if self.at(index) == "ends" { "goes" } else { "go" };
            self.say(index, index + 2, &[going]);
        }
    }

    /// "the towels put away in the drawer": put them there.
    fn put_in_between(&mut self, index: usize) {
        let start = self.clause_start(index);
        let joins = (start..index).take_while(|&at| ["and", "but", "then"].contains(&self.at(at))).count();
        let first = start + joins;
        let away = ["away", "back", "down"].contains(&self.at(index + 1)) && self.is_place(index + 2);
        if self.at(index) == "put"
            && away
            && index > first
            && self.names_only(first, index)
            && is_determiner(self.at(first))
        {
            let mut order = vec!["put".to_owned()];
            order.extend(self.words(first..index));
            self.say_all(first, index + 2, &order);
        }
    }

    /// "wash them before they're stacked in the cabinet": then put them there.
    fn before_that(&mut self, index: usize) {
        let (who, being) = match (self.at(index + 1), self.at(index + 2)) {
            ("theyre", _) => ("them", 2),
            ("they", "are") => ("them", 3),
            ("it", "is") => ("it", 3),
            _ => return,
        };
        let put = ["put", "placed", "stacked", "stored", "returned", "stowed", "laid", "set"]
            .contains(&self.at(index + being));
        if self.at(index) == "before" && put && self.is_place(index + being + 1) && index > 2 {
            self.say(index, index + being + 1, &[",", "then", "put", who]);
        }
    }

    /// "the bottle can take its place in there": it should go in there.
    fn takes_its_place(&mut self, index: usize) {
        let can = usize::from(self.at(index) == "can");
        let takes = ["take", "takes"].contains(&self.at(index + can))
            && ["its", "their"].contains(&self.at(index + can + 1))
            && self.at(index + can + 2) == "place"
            && (self.at(index + can + 3) == "there" || self.at(index + can + 4) == "there");
        if takes && index > 0 && self.noun_before(index).is_some() {
            self.say(index, index + can + 3, &["should", "go"]);
        }
    }

    /// "whatever's left of the lettuce": the lettuce; "wants a good wash": a wash; "off again": off.
    fn left_of(&mut self, index: usize) {
        let is = usize::from(["is", crate::offline::text::POSSESSIVE].contains(&self.at(index + 1)));
        if ["whatever", "what"].contains(&self.at(index)) && self.starts(index + 1 + is, &["left", "of"]) {
            self.say(index, index + 3 + is, &[]);
        }
        let good = ["good", "quick", "proper", "thorough", "nice"].contains(&self.at(index + 2));
        if ["wants", "want", "needs", "need"].contains(&self.at(index))
            && self.at(index + 1) == "a"
            && good
            && self.is_base_verb(index + 3)
        {
            self.say(index + 2, index + 3, &[]);
        }
        let state = index > 0 && ["on", "off", "open", "closed", "shut"].contains(&self.at(index - 1));
        if self.at(index) == "again" && state {
            self.say(index, index + 1, &[]);
        }
    }

    /// "the ladle out on the counter": on it; "in the fridge, door shut": shut the door.
    fn out_there(&mut self, index: usize) {
        let start = self.clause_start(index);
        let out = self.at(index) == "out"
            && ["on", "in"].contains(&self.at(index + 1))
            && is_determiner(self.at(index + 2));
        if out
            && index > start
            && self.names_only(start, index)
            && self.lexicon.noun(&[self.at(start)]).is_some()
        {
            self.say(index, index + 1, &["should", "be"]);
        }
        let opens = index == start || self.at(index - 1) == "and";
        if opens && self.at(index) == "door" && ["shut", "closed"].contains(&self.at(index + 1)) && index > 0
        {
            self.say(index, index + 2, &["shut", "the", "door"]);
        }
    }

    /// "the vase would look nicer on the table": it should be there.
    fn looks_nicer(&mut self, index: usize) {
        let looks = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
            ("would", "look", _) => 2,
            ("would", "please", "me") => 3,
            ("looks" | "look", _, _) => 1,
            _ => return,
        };
        let more = (index + looks..)
            .take_while(|&at| {
                ["much", "more", "far", "so", "a", "lot", "better", "nicer", "best", "prettier"]
                    .contains(&self.at(at))
            })
            .count();
        if more > 0 && self.is_place(index + looks + more) && self.noun_before(index).is_some() {
            self.say(index, index + looks + more, &["should", "be"]);
        }
    }

    /// "on the side table; … on that same table": on the side table.
    fn that_same(&mut self, index: usize) {
        let same = is_determiner(self.at(index)) && self.at(index + 1) == "same";
        let Some(noun) = self.noun_before(index + 3).filter(|noun| same && noun.len() == 1) else { return };
        let named = (2..index).rev().find_map(|end| {
            let earlier = self.noun_before(end)?;
            (earlier.last() == noun.last()).then_some(earlier)
        });
        if let Some(named) = named {
            let mut said = vec!["the".to_owned()];
            said.extend(named);
            self.say_all(index, index + 3, &said);
        }
    }

    /// "fry an egg, plate it": put it on the plate.
    fn plated(&mut self, index: usize) {
        let it = ["it", "them"].contains(&self.at(index + 1));
        if self.at(index) == "plate" && it && self.opens_part(index) {
            let it = self.at(index + 1).to_owned();
            let up = usize::from(self.at(index + 2) == "up");
            self.say(index, index + 2 + up, &["put", &it, "on", "the", "plate"]);
        }
        // "…, starting with the bat on the floor": put it there first.
        if self.at(index) == "starting"
            && self.at(index + 1) == "with"
            && is_determiner(self.at(index + 2))
            && index > 0
            && self.is_mark(index - 1)
        {
            self.say(index - 1, index + 2, &["."]);
        }
    }

    /// "the bottle out of the cupboard and onto the table": it goes there.
    fn out_and_into(&mut self, index: usize) {
        let start = self.clause_start(index);
        let from = match (self.at(index), self.at(index + 1)) {
            ("out" | "off", "of") => 2,
            ("off", _) => 1,
            _ => return,
        };
        let joins = (index + from + 1..index + from + 6)
            .find(|&at| self.at(at) == "and" && self.noun_before(at).is_some());
        let onto = joins.is_some_and(|and| ["onto", "into", "to", "on", "in"].contains(&self.at(and + 1)));
        if let Some(and) =
            joins.filter(|_| onto && index > start && self.names_only(start, index) && !self.is_order(start))
        {
            let end = self.next_mark(and, &[",", "."]);
            let plain = !(and..end).any(|at| self.at(at) == "with");
            if plain {
                self.say(index, and + 1, &["goes"]);
            }
        }
    }

    /// "the two of them", "the pair", "the two clean things": both of them.
    fn all_of_them(&mut self, index: usize) {
        let two = self.at(index) == "the" && ["two", "pair", "both"].contains(&self.at(index + 1));
        if !two {
            return;
        }
        if self.starts(index + 2, &["of", "them"]) {
            self.say(index, index + 4, &["both", "of", "them"]);
            return;
        }
        let state = usize::from(self.lexicon.adjective(&[self.at(index + 2)]).is_some());
        let things = ["things", "items", "objects", "ones"].contains(&self.at(index + 2 + state));
        let pair = self.at(index + 1) == "pair"
            && (self.is_mark(index + 2) || is_going(self.at(index + 2)) || self.is_place(index + 2));
        let behind = index + 3 + state;
        let then = usize::from(self.at(behind) == "then");
        if things && (is_going(self.at(behind + then)) || self.at(behind + then) == "should") {
            self.say(index, behind + then, &["both", "of", "them"]);
        } else if pair {
            self.say(index, index + 2, &["both", "of", "them"]);
        }
    }

    /// "fill the mug at the coffee maker", "the cup filled at the tap": with coffee, with water.
    fn filled_at(&mut self, index: usize) {
        let there = ["at", "from", "under"].contains(&self.at(index)) && is_determiner(self.at(index + 1));
        let start = self.clause_start(index);
        let fills = (start..index).any(|at| ["fill", "filled", "fills"].contains(&self.at(at)));
        let with = (start..index).any(|at| self.at(at) == "with");
        if !there || !fills || with {
            return;
        }
        let end = (index + 3..index + 6).find(|&at| self.noun_before(at).is_some());
        let kinds = end.and_then(|end| {
            let words = self.words(index + 2..end);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            self.lexicon.noun(&words).map(|(noun, _)| noun.kinds.clone())
        });
        let liquid = kinds.and_then(|kinds| match kinds.first().map(String::as_str) {
            Some("Faucet") => Some("water"),
            Some("CoffeeMachine") => Some("coffee"),
            _ => None,
        });
        if let (Some(liquid), Some(end)) = (liquid, end) {
            self.say(index, end, &["with", liquid]);
            // "… and the cup filled with water"
            let joins = (start..index).take_while(|&at| ["and", "then"].contains(&self.at(at))).count();
            let filled = index - 1;
            if self.at(filled) == "filled" && self.names_only(start + joins, filled) {
                let mut order = vec!["fill".to_owned()];
                order.extend(self.words(start + joins..filled));
                self.say_all(start + joins, index, &order);
            }
        }
    }
}
