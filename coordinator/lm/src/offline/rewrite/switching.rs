//! Switching in other words: "set the burner on high", "get the oven going", "bring the stove to life", "darken the room",
//! "let the toaster cool down".

use super::Rewriting;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn switching(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let _ = self.in_a_position(index)
                || self.in_the_dark(index)
                || self.started(index)
                || self.heat_off(index)
                || self.flipped(index)
                || self.made_to_stop(index)
                || self.let_cool(index);
            index += 1;
        }
    }

    /// "leave the whole room in the dark", in whatever words: the lights off.
    pub(super) fn dark_rooms(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let _ = self.darkened(index);
            if self.at(index) == "everywhere" && index > 0 && ["off", "out"].contains(&self.at(index - 1)) {
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
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

    /// "darken the kitchen", "the room should be dark": the lights off; "bring the stove to life": turn it on.
    fn darkened(&mut self, index: usize) -> bool {
        let room = is_determiner(self.at(index + 1)) && self.lexicon.is_small("rooms", &[self.at(index + 2)]);
        let whole = is_determiner(self.at(index)) && ["whole", "entire"].contains(&self.at(index + 1));
        if whole && self.lexicon.is_small("rooms", &[self.at(index + 2)]) {
            self.say(index + 1, index + 2, &[]);
            return self.darkened(index.saturating_sub(2)) || self.darkened(index.saturating_sub(1));
        }
        let blacked = usize::from(self.starts(index, &["black", "out"]));
        if blacked > 0 && is_determiner(self.at(index + 2)) && self.is_mark(index + 4) {
            self.say(index, index + 4, &["turn", "off", "the", "lights"]);
            return true;
        }
        let darkens = ["darken", "darkening"].contains(&self.at(index));
        let dark = self.darkness(index + 3);
        let left = ["leave", "keep", "make", "have", "get", "put", "set", "place", "plunge", "bring"]
            .contains(&self.at(index))
            && dark > 0
            && (self.is_mark(index + 3 + dark)
                || ["and", "as", "too", "please", "then"].contains(&self.at(index + 3 + dark)));
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
            self.say(index, index + 3 + dark * usize::from(left), &["turn", "off", "the", "lights"]);
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

    /// How many words at a place say that it is dark: "dark", "in the dark", "in complete darkness".
    fn darkness(&self, at: usize) -> usize {
        let how = usize::from(
            ["the", "complete", "total", "full", "completely", "totally", "nice"].contains(&self.at(at + 1)),
        );
        match self.at(at) {
            "dark" | "unlit" | "darkened" => 1,
            "in" | "into" if ["dark", "darkness"].contains(&self.at(at + 1 + how)) => 2 + how,
            "completely" | "totally" | "fully" if self.at(at + 1) == "dark" => 2,
            _ => 0,
        }
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

    /// "turn off the heat", "the gas off": the stove.
    fn heat_off(&mut self, index: usize) -> bool {
        let heat = self.at(index) == "the" && ["heat", "gas", "flame"].contains(&self.at(index + 1));
        let start = self.clause_start(index);
        let turns = (start..index).any(|at| ["turn", "cut", "kill", "shut", "switch"].contains(&self.at(at)));
        let off = ["off", "out", "down"].contains(&self.at(index + 2));
        if heat && (turns && (off || self.is_mark(index + 2)) || off && self.is_mark(index + 3)) {
            self.say(index + 1, index + 2, &["stove"]);
            return true;
        }
        false
    }

    /// "the light switch down": off; "ending with the burner off": with it off.
    fn flipped(&mut self, index: usize) -> bool {
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

    /// "make the shower stop": turn it off.
    fn made_to_stop(&mut self, index: usize) -> bool {
        let start = self.clause_start(index);
        let makes = (start..index).rev().find(|&at| ["make", "let", "get"].contains(&self.at(at)));
        let to = usize::from(index > 0 && self.at(index - 1) == "to");
        if let Some(makes) = makes.filter(|_| {
            self.at(index) == "stop" && self.is_mark(index + 1) && self.noun_before(index - to).is_some()
        }) {
            self.say(index - to, index + 1, &[]);
            self.say(makes, makes + 1, &["turn", "off"]);
            return true;
        }
        false
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

    /// "no more cartoons", "no more light burning": it is off.
    pub(super) fn no_more(&mut self, index: usize) -> bool {
        const SHOWN: [&str; 6] = ["cartoons", "tv", "telly", "television", "films", "shows"];
        const LIT: [&str; 3] = ["light", "lights", "lamps"];
        if !self.starts(index, &["no", "more"]) || !self.opens_part(index) {
            return false;
        }
        let what = if SHOWN.contains(&self.at(index + 2)) {
            "tv"
        } else if LIT.contains(&self.at(index + 2)) {
            "lights"
        } else {
            return false;
        };
        let burning = usize::from(["burning", "on", "shining"].contains(&self.at(index + 3)));
        self.say(index, index + 3 + burning, &["turn", "off", "the", what]);
        true
    }
}
