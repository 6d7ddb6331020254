//! What holds a liquid, in whatever words: "give the pot some water", "the mug should have coffee in it", "hold the cup
//! under the tap until it is full".

use super::Rewriting;
use crate::offline::syntax::{LIQUIDS, is_determiner};

const TAPS: [&str; 2] = ["tap", "faucet"];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn liquids(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let subject = index > 0 && self.noun_before(index).is_some();
            self.tap_water(index);
            self.inside_it(index);
            let _ = subject && (self.has_in_it(index) || self.filled_from_the_tap(index))
                || self.given_a_liquid(index)
                || self.kept_full(index)
                || self.water_runs(index)
                || self.taps_to_fill(index)
                || self.until_full(index);
            index += 1;
        }
    }

    /// "fresh tap water": water; "use the cup for water": fill it.
    fn tap_water(&mut self, index: usize) {
        if TAPS.contains(&self.at(index)) && self.at(index + 1) == "water" {
            let fresh = index > 0 && ["fresh", "cold", "cool", "clean"].contains(&self.at(index - 1));
            self.say(index - usize::from(fresh), index + 1, &[]);
        }
        let vessel =
            index > 1 && ["glass", "cup", "mug"].contains(&self.at(index - 1)) && self.at(index - 2) == "a";
        if vessel
            && self.at(index) == "for"
            && LIQUIDS.contains(&self.at(index + 1))
            && self.is_mark(index + 2)
        {
            self.say(index, index + 2, &[]);
        }
        let used = self.at(index) == "use" && self.opens_part(index) && is_determiner(self.at(index + 1));
        let liquid = (index + 3..index + 6).find(|&at| {
            self.at(at) == "for" && LIQUIDS.contains(&self.at(at + 1)) && self.noun_before(at).is_some()
        });
        if let Some(at) = liquid.filter(|_| used) {
            self.say(at, at + 1, &["with"]);
            self.say(index, index + 1, &["fill"]);
        }
    }

    /// "put the pot on the stove with water inside": with water in it; "water for the pot": fill it.
    fn inside_it(&mut self, index: usize) {
        let some = usize::from(["some", "fresh", "a"].contains(&self.at(index + 1)));
        let liquid = index + 1 + some;
        let inside = match (self.at(liquid + 1), self.at(liquid + 2)) {
            ("in" | "inside", "there") => 2,
            ("inside" | "within", "it") => 2,
            ("inside" | "within", _) => 1,
            _ => 0,
        };
        let ends =
            self.is_mark(liquid + 1 + inside) || ["and", "then"].contains(&self.at(liquid + 1 + inside));
        if self.at(index) == "with" && LIQUIDS.contains(&self.at(liquid)) && inside > 0 && ends {
            self.say(liquid + 1, liquid + 1 + inside, &["in", "it"]);
        }
        let opens = self.opens_part(index);
        let vessel = (index + 4..index + 7).find(|&at| self.noun_before(at).is_some() && self.is_mark(at));
        if let Some(end) = vessel.filter(|_| {
            opens
                && LIQUIDS.contains(&self.at(index))
                && self.at(index + 1) == "for"
                && is_determiner(self.at(index + 2))
        }) {
            let mut order = vec!["fill".to_owned()];
            order.extend(self.words(index + 2..end));
            order.extend(["with".to_owned(), self.at(index).to_owned()]);
            self.say_all(index, end, &order);
        }
    }

    /// "keep the kettle filled with water", "let the pot hold water": fill it.
    fn kept_full(&mut self, index: usize) -> bool {
        const KEEP: [&str; 13] = [
            "keep", "leave", "make", "get", "have", "let", "supply", "provide", "ensure", "leaving",
            "keeping", "making", "getting",
        ];
        let noun = (index + 3..index + 6).find(|&end| self.noun_before(end).is_some());
        // ", with the pot left full of water"
        let company = self.at(index) == "with" && index > 0 && self.at(index - 1) == ",";
        let keeps = KEEP.contains(&self.at(index)) || company;
        let Some(end) = noun.filter(|_| keeps && is_determiner(self.at(index + 1))) else {
            return false;
        };
        let left = usize::from(["left", "kept", "still"].contains(&self.at(end)));
        let how = match (self.at(end + left), self.at(end + left + 1)) {
            ("filled" | "full" | "filling", "with" | "of") => 2 + left,
            ("hold" | "holds" | "holding" | "contain" | "contains" | "containing", _) => 1,
            ("with", _) => 1,
            _ => return false,
        };
        let some = usize::from(["some", "fresh"].contains(&self.at(end + how)));
        // Where more is said of it, it is put there: "have the cup holding water on the counter".
        let placed = self.is_place(end + how + some + 1);
        if !LIQUIDS.contains(&self.at(end + how + some)) || placed {
            return false;
        }
        self.say(end, end + how + some, &["with"]);
        self.say(index, index + 1, &["fill"]);
        true
    }

    /// "should be filled from the tap": with water.
    fn filled_from_the_tap(&mut self, index: usize) -> bool {
        let be = ["should", "must", "shall"].contains(&self.at(index)) && self.at(index + 1) == "be";
        let from = ["from", "at", "under"].contains(&self.at(index + 3))
            && is_determiner(self.at(index + 4))
            && [TAPS[0], TAPS[1], "sink"].contains(&self.at(index + 5));
        let filled = be && ["filled", "full"].contains(&self.at(index + 2)) && from;
        if filled {
            self.say(index + 2, index + 6, &["filled", "with", "water"]);
        }
        filled
    }

    /// "run the tap to fill the pot", "turn on the tap and fill it": fill it.
    fn taps_to_fill(&mut self, index: usize) -> bool {
        let on = usize::from(self.at(index) == "turn" && self.at(index + 1) == "on");
        let runs = ["run", "use", "open", "turn", "start"].contains(&self.at(index));
        let tap = index + 1 + on;
        let fills = is_determiner(self.at(tap))
            && TAPS.contains(&self.at(tap + 1))
            && ["to", "and"].contains(&self.at(tap + 2))
            && self.at(tap + 3) == "fill";
        if runs && fills {
            self.say(index, tap + 3, &[]);
        }
        runs && fills
    }

    /// "should have coffee in it", "needs water": should be filled with it.
    fn has_in_it(&mut self, index: usize) -> bool {
        let has = match (self.at(index), self.at(index + 1)) {
            ("should" | "must" | "shall", "have" | "contain") => 2,
            ("needs" | "need", "to") if self.at(index + 2) == "have" => 3,
            ("needs" | "need" | "wants", _) => 1,
            _ => return false,
        };
        let some = usize::from(["some", "fresh", "hot"].contains(&self.at(index + has)));
        let liquid = index + has + some;
        let inside = 2 * usize::from(
            ["in", "inside"].contains(&self.at(liquid + 1)) && ["it", "them"].contains(&self.at(liquid + 2)),
        );
        let ends = self.is_mark(liquid + 1 + inside)
            || ["and", "before", "while", "then", "after"].contains(&self.at(liquid + 1 + inside));
        if !LIQUIDS.contains(&self.at(liquid)) || !ends {
            return false;
        }
        let liquid_word = self.at(liquid).to_owned();
        self.say(index, liquid + 1 + inside, &["should", "be", "filled", "with", &liquid_word]);
        true
    }

    /// "let water run into the cup": run it in; "use the coffee machine to fill the cup": fill it with coffee.
    fn water_runs(&mut self, index: usize) -> bool {
        let the = usize::from(self.at(index + 1) == "the");
        if self.at(index) == "let"
            && self.at(index + 1 + the) == "water"
            && self.at(index + 2 + the) == "run"
            && ["into", "in"].contains(&self.at(index + 3 + the))
        {
            self.say(index, index + 3 + the, &["pour", "water"]);
            return true;
        }
        let brewed = ["use", "using"].contains(&self.at(index))
            && self.at(index + 2) == "coffee"
            && self.starts(index + 4, &["to", "fill"]);
        if brewed {
            let end = (index + 6..)
                .find(|&at| self.is_mark(at) || ["and", "then", "before", "while"].contains(&self.at(at)));
            let end = end.unwrap_or(index + 6);
            self.say(end, end, &["with", "coffee"]);
            self.say(index, index + 5, &[]);
        }
        brewed
    }

    /// "give the pot some water", "have the cup holding water": fill it.
    fn given_a_liquid(&mut self, index: usize) -> bool {
        if ["give", "giving"].contains(&self.at(index)) && is_determiner(self.at(index + 1)) {
            let noun = (index + 3..index + 6).find(|&end| self.noun_before(end).is_some());
            let amount = |at: usize| match (self.at(at), self.at(at + 1), self.at(at + 2)) {
                ("a", "bit" | "drop" | "splash" | "little", "of") => 3,
                ("a", "little", _) => 2,
                ("some" | "fresh" | "its" | "their", _, _) => 1,
                _ => 0,
            };
            if let Some(end) = noun.filter(|&end| LIQUIDS.contains(&self.at(end + amount(end)))) {
                self.say(end, end + amount(end), &["with"]);
                self.say(index, index + 1, &["fill"]);
                return true;
            }
        } else if ["holding", "hold"].contains(&self.at(index))
            && LIQUIDS.contains(&self.at(index + 1))
            && self.noun_before(index).is_some()
            && (self.clause_start(index)..index).any(|at| ["have", "let"].contains(&self.at(at)))
        {
            self.say(index, index + 1, &["filled", "with"]);
            return true;
        }
        false
    }

    /// "hold the cup under the tap until it is full", "run the tap into the mug": fill it.
    fn until_full(&mut self, index: usize) -> bool {
        let until = ["until", "till"].contains(&self.at(index));
        let is = match (self.at(index + 1), self.at(index + 2)) {
            ("it" | "they", "is" | "are") => 2,
            ("its" | "theyre" | "it", _) => 1,
            _ => 0,
        };
        let full = index + 1 + is;
        let first = self.clause_start(index);
        let held =
            (first..index).find(|&at| ["hold", "put", "keep", "place", "leave"].contains(&self.at(at)));
        let start = held.unwrap_or(first);
        let held = held.is_some();
        let under = (start..index).find(|&at| self.at(at) == "under" || self.at(at) == "beneath");
        let tap = under
            .is_some_and(|at| (at..index).any(|at| TAPS.contains(&self.at(at)) || self.at(at) == "water"));
        if until && ["full", "filled"].contains(&self.at(full)) && held && tap {
            self.say(under.unwrap_or(index), full + 1, &[]);
            self.say(start, start + 1, &["fill"]);
        } else if self.at(index) == "run"
            && is_determiner(self.at(index + 1))
            && (TAPS.contains(&self.at(index + 2)) || self.at(index + 2) == "water")
            && ["into", "in"].contains(&self.at(index + 3))
        {
            self.say(index, index + 4, &["fill"]);
        } else {
            return false;
        }
        true
    }

    /// "make it full with water", "make full of water": fill it; "make clean the spoon": clean it.
    pub(super) fn make_full(&mut self, index: usize) -> bool {
        if self.at(index) != "make" {
            return false;
        }
        let full = (index + 1..index + 6).find(|&at| self.at(at) == "full");
        let full = full
            .filter(|&at| at == index + 1 || self.names_only(index + 1, at) || self.at(index + 1) == "it");
        if let Some(full) = full.filter(|&at| ["with", "of"].contains(&self.at(at + 1))) {
            self.say(full, full + 2, &["with"]);
            let it: &[&str] = if full == index + 1 { &["fill", "it"] } else { &["fill"] };
            self.say(index, index + 1, it);
            return true;
        }
        if ["clean", "hot", "cold"].contains(&self.at(index + 1)) && is_determiner(self.at(index + 2)) {
            let order = match self.at(index + 1) {
                "clean" => "clean",
                "hot" => "heat",
                _ => "chill",
            };
            self.say(index, index + 2, &[order]);
            return true;
        }
        false
    }

    /// "hold it under the tap and fill it": fill it.
    pub(super) fn held_to_be_filled(&mut self, index: usize) -> bool {
        let held = ["hold", "put", "place"].contains(&self.at(index))
            && ["it", "them"].contains(&self.at(index + 1))
            && ["under", "below", "beneath"].contains(&self.at(index + 2));
        let tap =
            is_determiner(self.at(index + 3)) && ["tap", "faucet", "spout"].contains(&self.at(index + 4));
        let and = index + 5 + usize::from(self.at(index + 5) == ",");
        if !held || !tap || !["and", "then"].contains(&self.at(and)) || self.at(and + 1) != "fill" {
            return false;
        }
        self.say(index, and + 1, &[]);
        true
    }

    /// "wait till the pot is filled up": fill the pot with water.
    pub(super) fn waits_till_full(&mut self, index: usize) -> bool {
        let waits = self.at(index) == "wait" && ["till", "until"].contains(&self.at(index + 1));
        let is = (index + 3..index + 7).find(|&at| ["is", "gets"].contains(&self.at(at)));
        let Some(is) = is.filter(|&is| waits && ["full", "filled"].contains(&self.at(is + 1))) else {
            return false;
        };
        let up = usize::from(self.at(is + 2) == "up");
        self.say(is, is + 2 + up, &["with", "water"]);
        self.say(index, index + 2, &["fill"]);
        true
    }
}
