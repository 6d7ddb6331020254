//! What something becomes, said by "gets", "goes" and "has", as what it should be.

use super::Rewriting;
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

/// Liquids that a vessel may get.
const LIQUIDS: [&str; 3] = ["water", "coffee", "wine"];

impl Rewriting<'_> {
    /// "the bread gets sliced", "each cup gets water", "the light goes off", "all of it needs to go into the pot".
    pub(super) fn becoming(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.each_one(index);
            let subject = self.is_subject_before(index);
            let _ = subject
                && (self.gets_so(index)
                    || self.needs_a_wash(index)
                    || self.has_in_it(index)
                    || self.goes_so(index)
                    || self.rests(index))
                || self.having_it_somewhere(index)
                || self.given_a_liquid(index)
                || self.water_runs(index)
                || self.filled_with_things(index)
                || self.made_into_slices(index)
                || self.in_a_position(index)
                || self.until_full(index)
                || self.let_cool(index);
            index += 1;
        }
    }

    /// "each one gets filled": each of them.
    fn each_one(&mut self, index: usize) {
        let behind = self.at(index + 2);
        let told = ["gets", "should", "must", "needs"].contains(&behind) || is_going(behind);
        if self.starts(index, &["each", "one"]) && told {
            self.say(index, index + 2, &["each"]);
        }
    }

    /// "gets sliced", "gets some water": should be sliced, should be filled with water.
    fn gets_so(&mut self, index: usize) -> bool {
        let some = usize::from(["some", "its", "fresh"].contains(&self.at(index + 1)));
        if !["gets", "get"].contains(&self.at(index)) {
            return false;
        }
        if self.is_participle(index + 1) {
            self.say(index, index + 1, &["should", "be"]);
        } else if LIQUIDS.contains(&self.at(index + 1 + some)) {
            self.say(index, index + 1 + some, &["should", "be", "filled", "with"]);
        } else {
            return false;
        }
        true
    }

    /// "needs a wash", "could do with a good rinse": should be washed.
    fn needs_a_wash(&mut self, index: usize) -> bool {
        const DONE: [(&str, &str); 9] = [
            ("wash", "washed"),
            ("washing", "washed"),
            ("rinse", "rinsed"),
            ("rinsing", "rinsed"),
            ("clean", "cleaned"),
            ("cleaning", "cleaned"),
            ("scrub", "scrubbed"),
            ("wipe", "wiped"),
            ("polish", "cleaned"),
        ];
        let needs = match (self.at(index), self.at(index + 1)) {
            ("needs" | "need" | "wants" | "want" | "deserves" | "deserve" | "gets" | "get", _) => 1,
            ("could", "use") => 2,
            _ => return false,
        };
        let amount = usize::from(["a", "some", "another"].contains(&self.at(index + needs)));
        let how = index + needs + amount;
        let good =
            usize::from(["good", "quick", "proper", "thorough", "little", "nice"].contains(&self.at(how)));
        let done = DONE.iter().find(|(doing, _)| *doing == self.at(how + good));
        if let Some((_, done)) = done.filter(|_| amount > 0) {
            self.say(index, how + good + 1, &["should", "be", done]);
            return true;
        }
        false
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

    /// "goes off", "can go out", "must not run": should be off; "needs to go into the pot": should go there; "comes out
    /// onto the counter": comes onto it.
    fn goes_so(&mut self, index: usize) -> bool {
        let shall = ["should", "must", "shall", "can", "may", "could", "will"].contains(&self.at(index));
        let goes = |word: &str| ["goes", "go", "comes", "come"].contains(&word);
        let verb = index + usize::from(shall);
        let state = self.at(verb + 1).to_owned();
        let ends = self.is_mark(verb + 2)
            || ["and", "while", "then", "but", "before", "after", "once", "when", "until"]
                .contains(&self.at(verb + 2));
        let needs = ["needs", "need", "has", "have"].contains(&self.at(index)) && self.at(index + 1) == "to";
        let aside = ["out", "over", "back", "down", "up"].contains(&self.at(index + 1));
        if goes(self.at(verb)) && ["off", "on", "out", "dark"].contains(&state.as_str()) && ends {
            let state = if state == "dark" { "off" } else { &state };
            self.say(index, verb + 2, &["should", "be", state]);
        } else if shall
            && self.at(index + 1) == "not"
            && ["run", "burn", "shine"].contains(&self.at(index + 2))
        {
            self.say(index + 2, index + 3, &["be", "on"]);
        } else if ["burns", "burn", "shines", "shine", "glows", "glow"].contains(&self.at(index))
            && self.is_mark(index + 1)
        {
            self.say(index, index + 1, &["should", "be", "on"]);
        } else if needs
            && (is_going(self.at(index + 2)) && self.is_place(index + 3)
                || self.at(index + 2) == "be" && self.is_participle(index + 3))
        {
            self.say(index, index + 2, &["should"]);
        } else if is_going(self.at(index))
            && aside
            && ["onto", "into", "to", "in", "on"].contains(&self.at(index + 2))
            && is_determiner(self.at(index + 3))
        {
            self.say(index + 1, index + 2, &[]);
        } else {
            return false;
        }
        true
    }

    /// Whether what something is told of ends before a place.
    fn is_subject_before(&self, index: usize) -> bool {
        let before = self.at(index.wrapping_sub(1));
        index > 0
            && (["it", "they", "them", "both", "all", "each", "slices", "pieces", "everything", "halves"]
                .contains(&before)
                || self.noun_before(index).is_some())
    }

    /// "… and have both in the bowl": put them there.
    fn having_it_somewhere(&mut self, index: usize) -> bool {
        let opens = index == 0 || [",", ".", "and", "then"].contains(&self.at(index - 1));
        let all_of =
            usize::from(["all", "both"].contains(&self.at(index + 1)) && self.at(index + 2) == "of") * 2;
        let them = ["it", "them", "both", "that", "all", "those"].contains(&self.at(index + 1 + all_of));
        let place = index + 2 + all_of;
        let there = ["in", "on", "into", "onto", "inside"].contains(&self.at(place));
        if opens && ["have", "get"].contains(&self.at(index)) && them && there {
            self.say(index, index + 1, &["put"]);
            return true;
        }
        false
    }

    /// "make sure the egg sits in the fridge", "slice the apple, and the pot stands on the stove": it shall be there.
    fn rests(&mut self, index: usize) -> bool {
        const RESTS: [&str; 8] = ["sits", "stands", "lies", "rests", "sit", "stand", "lie", "rest"];
        let start = self.clause_start(index);
        let before = |at: usize| at > 0 && ["and", "that"].contains(&self.at(at - 1));
        let asked = (start..index).any(|at| self.is_order(at) || ["sure", "ensure"].contains(&self.at(at)))
            || self.at(start) == "and" && start > 1;
        let joined =
            (start..index).any(|at| is_determiner(self.at(at)) && before(at)) || self.at(start) == "and";
        let relative =
            (start..index).any(|at| ["which", "where", "that"].contains(&self.at(at)) && at + 1 == index);
        let sure = (start..index).any(|at| ["sure", "ensure"].contains(&self.at(at)));
        let told = RESTS.contains(&self.at(index)) && self.is_place(index + 1) && !relative;
        let shall = told && asked && (joined || sure);
        if shall {
            self.say(index, index + 1, &["should", "be"]);
        }
        shall
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

    /// "fill the bowl with all the slices", "loading the pan with the potato and the egg": put them in it.
    fn filled_with_things(&mut self, index: usize) -> bool {
        const FILL: [&str; 9] = ["fill", "load", "pile", "heap", "pack", "stack", "stuff", "top", "cover"];
        const FILLING: [&str; 6] = ["filling", "loading", "piling", "heaping", "packing", "stacking"];
        let gerund = FILLING.contains(&self.at(index));
        let with = (index + 2..index + 6).find(|&at| self.at(at) == "with");
        let Some(with) = with.filter(|&with| {
            (gerund || FILL.contains(&self.at(index)))
                && is_determiner(self.at(index + 1))
                && self.noun_before(with).is_some()
        }) else {
            return false;
        };
        let end = (with + 1..)
            .find(|&at| self.is_mark(at) || ["then", "and"].contains(&self.at(at)) && self.is_order(at + 1))
            .unwrap_or(with);
        let end = end - usize::from(self.at(end - 1) == "and");
        let parts = ["slices", "pieces", "slice", "piece", "them", "both", "everything"].contains(&self.at(end - 1));
        let things = self.names_only(with + 1, end)
            && !(with + 1..end).any(|at| LIQUIDS.contains(&self.at(at)));
        if !parts && !things {
            return false;
        }
        let mut order = vec![if gerund { "putting" } else { "put" }.to_owned()];
        order.extend(self.words(with + 1..end));
        order.push("in".to_owned());
        order.extend(self.words(index + 1..with));
        self.say_all(index, end, &order);
        true
    }

    /// "turn the apple and the bread into slices": slice them.
    fn made_into_slices(&mut self, index: usize) -> bool {
        let opens = index == 0 || [",", ".", "and", "then"].contains(&self.at(index - 1));
        let end = self.next_mark(index, &[",", "."]);
        let into = (index + 2..end).find(|&at| {
            self.at(at) == "into"
                && ["slices", "pieces", "chunks", "cubes", "wedges"].contains(&self.at(at + 1))
        });
        let Some(into) = into.filter(|&into| {
            opens
                && ["turn", "make"].contains(&self.at(index))
                && self.noun_before(into).is_some()
                && !(index + 1..into).any(|at| self.is_order(at))
        }) else {
            return false;
        };
        self.say(into, into + 2, &[]);
        self.say(index, index + 1, &["slice"]);
        true
    }

    /// "set the switch to the off position": to off.
    fn in_a_position(&mut self, index: usize) -> bool {
        let to = ["to", "in", "into"].contains(&self.at(index)) && self.at(index + 1) == "the";
        let state = ["off", "on"].contains(&self.at(index + 2));
        let position = to && state && ["position", "setting"].contains(&self.at(index + 3));
        if position {
            let state = self.at(index + 2).to_owned();
            self.say(index, index + 4, &["to", &state]);
        }
        position
    }

    /// "hold the cup under the tap until it is full", "run the tap into the mug": fill it.
    fn until_full(&mut self, index: usize) -> bool {
        const TAPS: [&str; 3] = ["tap", "faucet", "water"];
        let until = ["until", "till"].contains(&self.at(index));
        let is = match (self.at(index + 1), self.at(index + 2)) {
            ("it" | "they", "is" | "are") => 2,
            ("its" | "theyre" | "it", _) => 1,
            _ => 0,
        };
        let full = index + 1 + is;
        let start = self.clause_start(index);
        let held = ["hold", "put", "keep", "place", "leave"].contains(&self.at(start));
        let under = (start..index).find(|&at| self.at(at) == "under" || self.at(at) == "beneath");
        let tap = under.is_some_and(|at| (at..index).any(|at| TAPS.contains(&self.at(at))));
        if until && ["full", "filled"].contains(&self.at(full)) && held && tap {
            self.say(under.unwrap_or(index), full + 1, &[]);
            self.say(start, start + 1, &["fill"]);
        } else if self.at(index) == "run"
            && is_determiner(self.at(index + 1))
            && TAPS.contains(&self.at(index + 2))
            && ["into", "in"].contains(&self.at(index + 3))
        {
            self.say(index, index + 4, &["fill"]);
        } else {
            return false;
        }
        true
    }

    /// "let the burner cool down": cool it down.
    fn let_cool(&mut self, index: usize) -> bool {
        let cools = ["cool", "chill", "warm", "heat"].contains(&self.at(index));
        let start = self.clause_start(index);
        let lets = (start..index).rev().find(|&at| self.at(at) == "let");
        if let Some(lets) = lets.filter(|_| cools && self.noun_before(index).is_some()) {
            let way = usize::from(["down", "off", "up"].contains(&self.at(index + 1)));
            let order = self.words(index..index + 1 + way);
            self.say(index, index + 1 + way, &[]);
            self.say_all(lets, lets + 1, &order);
            return true;
        }
        false
    }
}
