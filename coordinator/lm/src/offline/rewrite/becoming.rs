//! What something becomes, said by "gets", "goes" and "has", as what it should be.

use super::Rewriting;
use super::liquids::LIQUIDS;
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "the bread gets sliced", "each cup gets water", "the light goes off", "all of it needs to go into the pot".
    pub(super) fn becoming(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.each_one(index);
            // "the mug then gets filled"
            if ["then", "also", "now"].contains(&self.at(index))
                && index > 0
                && self.noun_before(index).is_some()
                && ["gets", "get"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
            }
            let subject = self.is_subject_before(index);
            let _ = subject
                && (self.gets_so(index)
                    || self.needs_a_wash(index)
                    || self.goes_so(index)
                    || self.rests(index))
                || self.having_it_somewhere(index)
                || self.in_a_position(index)
                || self.darkened(index)
                || self.started(index)
                || self.in_the_dark(index)
                || self.heat_off(index)
                || self.given_a_wash(index)
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
        } else if shall && self.at(index + 1) == "stop" && self.is_mark(index + 2) {
            self.say(index, index + 2, &["should", "be", "off"]);
        } else if shall && self.starts(index + 1, &["be", "going"]) {
            self.say(index + 2, index + 3, &["on"]);
        } else if shall
            && self.at(index + 1) == "run"
            && (self.is_mark(index + 2) || self.at(index + 2) == "and")
        {
            self.say(index + 1, index + 2, &["be", "on"]);
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
        let all_of = if ["slice", "slices", "pieces"].contains(&self.at(index + 2)) { 1 } else { all_of };
        let them = ["it", "them", "both", "that", "all", "those", "slice", "slices", "pieces"]
            .contains(&self.at(index + 1 + all_of));
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

    /// "set the switch to the off position": to off.
    fn in_a_position(&mut self, index: usize) -> bool {
        let to = ["to", "in", "into"].contains(&self.at(index)) && self.at(index + 1) == "the";
        let state = ["off", "on"].contains(&self.at(index + 2));
        let position = to && state && ["position", "setting"].contains(&self.at(index + 3));
        let start = self.clause_start(index);
        let turned =
            (start..index).any(|at| ["turn", "switch", "flip", "turned", "switched"].contains(&self.at(at)));
        if position {
            let state = self.at(index + 2).to_owned();
            self.say(index, index + 4, &["to", &state]);
        }
        // "set the burner on high", "put the toaster to use"
        let set =
            (start..index).any(|at| ["turn", "put", "set", "switch", "get", "bring"].contains(&self.at(at)));
        let level = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
            (
                "on" | "to" | "at",
                "high" | "low" | "medium" | "full" | "max",
                "heat" | "power" | "flame" | "blast",
            ) => 3,
            ("on" | "to" | "at", "high" | "low" | "medium" | "full" | "max", _) => 2,
            ("to" | "into", "use" | "work" | "operation" | "action", _) => 2,
            ("in", "motion" | "operation" | "action", _) => 2,
            _ => 0,
        };
        let ends =
            self.is_mark(index + level) || ["and", "then", "while", "with"].contains(&self.at(index + level));
        if set && level > 0 && ends && index > 0 && self.noun_before(index).is_some() {
            self.say(index, index + level, &["on"]);
            return true;
        }
        // "turn the toaster to on"
        let to = self.at(index) == "to" && ["on", "off"].contains(&self.at(index + 1)) && turned;
        if to {
            self.say(index, index + 1, &[]);
        }
        position || to
    }

    /// "chill the wine, with the kitchen dark", "… in the dark": turn off the lights as well; "to keep cold": to chill.
    fn in_the_dark(&mut self, index: usize) -> bool {
        let room =
            |at: usize| is_determiner(self.at(at)) && self.lexicon.is_small("rooms", &[self.at(at + 1)]);
        let left = usize::from(["left", "kept"].contains(&self.at(index + 3)));
        let dark = |at: usize| match (self.at(at), self.at(at + 1), self.at(at + 2)) {
            ("in", "the", "dark") => 3,
            ("in", "darkness", _) => 2,
            ("dark" | "unlit", _, _) => 1,
            _ => 0,
        };
        let (from, length) = if self.at(index) == "with" && room(index + 1) {
            (index, 3 + left + dark(index + 3 + left))
        } else if index > 0 && self.noun_before(index).is_some() && self.at(index) == "in" {
            (index, dark(index))
        } else {
            (index, 0)
        };
        let told = if self.at(from) == "with" { length > 3 + left } else { length > 0 };
        if told && self.is_mark(from + length) {
            let comma: &[&str] = if index > 0 && self.at(index - 1) == "," { &[] } else { &[","] };
            let mut order = comma.to_vec();
            order.extend(["turn", "off", "the", "lights"]);
            self.say(from, from + length, &order);
            return true;
        }
        let keeps = self.at(index) == "to"
            && ["keep", "stay", "remain"].contains(&self.at(index + 1))
            && ["cold", "cool", "chilled"].contains(&self.at(index + 2))
            && (self.is_mark(index + 3) || ["and", "with", "while"].contains(&self.at(index + 3)));
        if keeps {
            self.say(index + 1, index + 3, &["chill"]);
        }
        keeps
    }

    /// "turn off the heat", "the gas off": the stove; "ending with the burner off": with it off.
    fn heat_off(&mut self, index: usize) -> bool {
        let heat = self.at(index) == "the" && ["heat", "gas", "flame"].contains(&self.at(index + 1));
        let start = self.clause_start(index);
        let turns = (start..index).any(|at| ["turn", "cut", "kill", "shut", "switch"].contains(&self.at(at)));
        let off = ["off", "out", "down"].contains(&self.at(index + 2));
        if heat && (turns && (off || self.is_mark(index + 2)) || off && self.is_mark(index + 3)) {
            self.say(index + 1, index + 2, &["stove"]);
            return true;
        }
        // "the light switch down"
        let flipped = index > 0 && self.at(index - 1) == "switch" && self.is_mark(index + 1);
        if flipped && ["down", "up"].contains(&self.at(index)) {
            let state = if self.at(index) == "down" { "off" } else { "on" };
            self.say(index, index + 1, &[state]);
            return true;
        }
        let ending = ["ending", "finishing"].contains(&self.at(index)) && self.at(index + 1) == "with";
        if ending {
            self.say(index, index + 1, &[]);
        }
        ending
    }

    /// "set the oven to heat up", "get the coffee maker going": turn it on; "bring the lights down": turn them off.
    fn started(&mut self, index: usize) -> bool {
        const DEVICES: [&str; 5] = ["Microwave", "CoffeeMachine", "Toaster", "StoveBurner", "StoveKnob"];
        const LET: [&str; 8] = ["set", "get", "have", "let", "leave", "keep", "make", "bring"];
        const RUN: [&str; 18] = [
            "run", "heat", "warm", "cook", "brew", "start", "work", "go", "going", "heating", "brewing",
            "working", "cooking", "humming", "running", "online", "whirring", "warming",
        ];
        let noun =
            (index + 3..index + 7).find(|&end| self.noun_before(end).is_some() && self.at(end) != "machine");
        let Some(end) = noun.filter(|_| is_determiner(self.at(index + 1))) else { return false };
        let words = self.words(index + 2..end);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let kinds = self.lexicon.noun(&words).map(|(noun, _)| noun.kinds.clone()).unwrap_or_default();
        let lights = words.last().is_some_and(|last| ["light", "lights", "lamps"].contains(last));
        let dimmed = match (self.at(index), self.at(end)) {
            ("bring" | "take" | "turn", "down") => 1,
            ("put", "to") if ["rest", "sleep", "bed"].contains(&self.at(end + 1)) => 2,
            ("set", "to") if self.at(end + 1) == "dark" => 2,
            _ => 0,
        };
        if lights && dimmed > 0 {
            self.say(end, end + dimmed, &[]);
            self.say(index, index + 1, &["turn", "off"]);
            return true;
        }
        let to = usize::from(self.at(end) == "to");
        let run = end + to;
        let up = usize::from(["up", "again"].contains(&self.at(run + 1)));
        let ends = self.is_mark(run + 1 + up)
            || ["and", "then", "while", "with", "before"].contains(&self.at(run + 1 + up));
        let device = kinds.first().is_some_and(|kind| DEVICES.contains(&kind.as_str()));
        let starts = device && LET.contains(&self.at(index)) && RUN.contains(&self.at(run)) && ends;
        if starts {
            self.say(end, run + 1 + up, &[]);
            self.say(index, index + 1, &["turn", "on"]);
        }
        starts
    }

    /// "give the plate, the mug and the bowl a wash": wash them; "do the washing up: the plate, …": wash those.
    fn given_a_wash(&mut self, index: usize) -> bool {
        const WASHES: [&str; 6] = ["wash", "rinse", "clean", "scrub", "wipe", "cleaning"];
        let end = self.next_mark(index + 1, &["."]);
        let a = (index + 3..end.min(index + 16)).find(|&at| {
            self.at(at) == "a"
                && (WASHES.contains(&self.at(at + 1))
                    || ["good", "quick", "proper", "thorough"].contains(&self.at(at + 1))
                        && WASHES.contains(&self.at(at + 2)))
        });
        let doing = match (self.at(index), self.at(index + 1), self.at(index + 2), self.at(index + 3)) {
            ("do", "the", "washing", "up") => 4,
            ("do", "the", "dishes", _) => 3,
            _ => 0,
        };
        let listed = doing > 0
            && self.tokens.get(index + doing).is_some_and(|token| token.typed == ":")
            && is_determiner(self.at(index + doing + 1));
        if listed {
            self.say(index, index + doing + 1, &["wash"]);
            return true;
        }
        let Some(a) = a.filter(|&a| self.at(index) == "give" && self.names_only(index + 1, a)) else {
            return false;
        };
        let good = usize::from(!WASHES.contains(&self.at(a + 1)));
        let doing = self.at(a + 1 + good).to_owned();
        let doing = if doing == "cleaning" { "clean" } else { &doing };
        self.say(a, a + 2 + good, &[]);
        self.say(index, index + 1, &[doing]);
        true
    }

    /// "darken the kitchen", "the room should be dark": the lights off; "bring the stove to life": turn it on.
    fn darkened(&mut self, index: usize) -> bool {
        let room = is_determiner(self.at(index + 1)) && self.lexicon.is_small("rooms", &[self.at(index + 2)]);
        let darkens = ["darken", "darkening"].contains(&self.at(index));
        let left = ["leave", "keep", "make", "have", "get"].contains(&self.at(index))
            && ["dark", "unlit"].contains(&self.at(index + 3));
        let here = is_determiner(self.at(index)) && self.lexicon.is_small("rooms", &[self.at(index + 1)]);
        let (shall, be) = (self.at(index + 2), self.at(index + 3));
        let told = match (shall, be) {
            ("should" | "must" | "shall", "be" | "stay" | "go") => 4,
            ("goes" | "stays" | "gets", _) => 3,
            _ => 0,
        };
        let told = told * usize::from(here && told > 0 && ["dark", "unlit"].contains(&self.at(index + told)));
        let life = (index + 3..index + 7).find(|&at| self.starts(at, &["to", "life"]));
        if room && (darkens || left) {
            self.say(index, index + 3 + usize::from(left), &["turn", "off", "the", "lights"]);
        } else if told > 0 {
            self.say(index, index + told + 1, &["the", "lights", "should", "be", "off"]);
        } else if let Some(life) = life.filter(|_| self.at(index) == "bring") {
            self.say(life, life + 2, &[]);
            self.say(index, index + 1, &["turn", "on"]);
        } else {
            return false;
        }
        true
    }

    /// "let the burner cool down": cool it down.
    fn let_cool(&mut self, index: usize) -> bool {
        let cools = ["cool", "chill", "warm", "heat"].contains(&self.at(index));
        let start = self.clause_start(index);
        // "make the shower stop"
        let makes = (start..index).rev().find(|&at| ["make", "let", "get"].contains(&self.at(at)));
        let to = usize::from(index > 0 && self.at(index - 1) == "to");
        if let Some(makes) = makes.filter(|_| {
            self.at(index) == "stop" && self.is_mark(index + 1) && self.noun_before(index - to).is_some()
        }) {
            self.say(index - to, index + 1, &[]);
            self.say(makes, makes + 1, &["turn", "off"]);
            return true;
        }
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
