//! Devices, lights and doors in everyday words: "while the toaster runs", "drop the lights", "a dark kitchen", "no drawer
//! is left open".

use super::Rewriting;
use crate::offline::syntax::is_determiner;
use crate::offline::text::POSSESSIVE;

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn devices(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.lid_of(index);
            self.runs_meanwhile(index);
            self.lights_thrown_off(index);
            let _ = self.in_operation(index)
                || self.a_dark_room(index)
                || self.done_without(index)
                || self.is_to_shine(index)
                || self.heat_turned_on(index)
                || self.put_on_the_stove(index);
            self.none_left_open(index);
            index += 1;
        }
    }

    /// "the laptop lid down", "the laptop's lid": the laptop, closed.
    fn lid_of(&mut self, index: usize) {
        let own = usize::from(index > 0 && self.at(index - 1) == POSSESSIVE);
        let lid = ["lid", "cover", "flap"].contains(&self.at(index)) || own > 0 && self.at(index) == "door";
        let compound = self.noun_before(index + 1).is_some_and(|noun| noun.len() > 1);
        if !lid || index <= own || compound || self.noun_before(index - own).is_none() {
            return;
        }
        self.say(index - own, index + 1, &[]);
        let from = index - own;
        if let Some(lifts) =
            (from.saturating_sub(5)..from).find(|&at| ["lift", "raise"].contains(&self.at(at)))
            && self.names_only(lifts + 1, from)
        {
            self.say(lifts, lifts + 1, &["open"]);
            return;
        }
        let being = (from..).take_while(|&at| ["is", "should", "be", "must"].contains(&self.at(at))).count();
        let way = from + being;
        if self.is_mark(way + 1) || ["and", "then", "but"].contains(&self.at(way + 1)) {
            match self.at(way) {
                "down" => self.say(way, way + 1, &["closed"]),
                "up" => self.say(way, way + 1, &["open"]),
                _ => {}
            }
        }
    }

    /// "while the toaster runs": while it is running.
    fn runs_meanwhile(&mut self, index: usize) {
        let runs = ["runs", "run"].contains(&self.at(index)) && self.is_mark(index + 1);
        let during = self.at(self.clause_start(index)) == "while";
        if runs && during && index > 1 && self.noun_before(index).is_some() {
            self.say(index, index + 1, &["is", "running"]);
        }
    }

    /// "throw off the lights", "bring the lights down", "drop the lights": turn them off.
    fn lights_thrown_off(&mut self, index: usize) {
        let throws = ["throw", "drop", "bring"].contains(&self.at(index)) && self.opens_part(index);
        let lights = (index + 1..index + 5)
            .find(|&at| ["lights", "light"].contains(&self.at(at)) && !self.is_place(at + 1));
        let off = usize::from(self.at(index + 1) == "off");
        let Some(light) = lights.filter(|&light| throws && self.names_only(index + 1 + off, light + 1))
        else {
            return;
        };
        let down = usize::from(self.at(light + 1) == "down");
        if off + down > 0 || self.at(index) == "drop" {
            self.say(light + 1, light + 1 + down, &[]);
            self.say(index, index + 1 + off, &["turn", "off"]);
        }
    }

    /// "put the toaster in operation": turn it on.
    fn in_operation(&mut self, index: usize) -> bool {
        let inward = ["in", "into"].contains(&self.at(index)) && self.at(index + 1) == "operation";
        let start = self.clause_start(index);
        let order = (start..index).find(|&at| ["put", "place", "set", "bring"].contains(&self.at(at)));
        let Some(order) = order.filter(|&order| inward && self.names_only(order + 1, index)) else {
            return false;
        };
        self.say(index, index + 2, &[]);
        self.say(order, order + 1, &["turn", "on"]);
        true
    }

    /// "… and finally a dark kitchen": the lights off.
    fn a_dark_room(&mut self, index: usize) -> bool {
        let room = self.lexicon.is_small("rooms", &[self.at(index + 2)]) && self.is_mark(index + 3);
        let dark = index > 0 && self.starts(index, &["a", "dark"]) && room;
        if dark {
            self.say(index, index + 3, &["the", "lights", "off"]);
        }
        dark
    }

    /// "do without the lamp": turn it off.
    fn done_without(&mut self, index: usize) -> bool {
        let thing = is_determiner(self.at(index + 2)) || self.at(index + 2) == "both";
        let without = thing && self.starts(index, &["do", "without"]);
        if without {
            self.say(index, index + 2, &["turn", "off"]);
        }
        without
    }

    /// "the lamp to shine": to be on.
    fn is_to_shine(&mut self, index: usize) -> bool {
        let shine = self.at(index) == "to" && ["shine", "glow", "burn"].contains(&self.at(index + 1));
        let ends = self.is_mark(index + 2) && index > 0 && self.noun_before(index).is_some();
        if shine && ends {
            self.say(index + 1, index + 2, &["be", "on"]);
        }
        shine && ends
    }

    /// "with the heat turned on": the burner.
    fn heat_turned_on(&mut self, index: usize) -> bool {
        let heat = self.at(index) == "the" && ["heat", "flame"].contains(&self.at(index + 1));
        let turned = usize::from(["turned", "switched"].contains(&self.at(index + 2)));
        let on = index > 0 && heat && ["on", "off"].contains(&self.at(index + 2 + turned));
        if on {
            self.say(index + 1, index + 2 + turned, &["burner"]);
        }
        on
    }

    /// "no drawer is left open", "not a single drawer stays open": every one of them is to be closed.
    fn none_left_open(&mut self, index: usize) {
        let no = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
            ("not", "a" | "one", "single") => 3,
            ("no", "single", _) => 2,
            ("none", "of", "the") => 3,
            ("no", _, _) => 1,
            _ => return,
        };
        let is = (index + no + 1..index + no + 4).find(|&at| self.noun_before(at).is_some());
        let Some(is) = is.filter(|&is| !self.is_mark(is)) else { return };
        let stays = match (self.at(is), self.at(is + 1)) {
            ("is" | "are" | "be", "left") => 2,
            ("should" | "must" | "may", "stay" | "remain") => 2,
            ("should" | "must" | "may", "be") if self.at(is + 2) == "left" => 3,
            ("stays" | "remains" | "stay" | "remain", _) => 1,
            ("left", _) => 1,
            _ => return,
        };
        if self.at(is + stays) == "open" && self.is_mark(is + stays + 1) {
            self.say(is, is + stays + 1, &["should", "be", "closed"]);
            let every: &[&str] =
                if no == 3 && self.at(index) == "none" { &["all", "the"] } else { &["every"] };
            self.say(index, index + no, every);
        }
    }

    /// "put the kettle on": to boil; "put the pan on": on the stove.
    fn put_on_the_stove(&mut self, index: usize) -> bool {
        let puts = ["put", "pop", "stick", "get", "set"].contains(&self.at(index)) && self.opens_part(index);
        let on = index + 3;
        let ends = self.is_mark(on + 1) || ["and", "for", "to", "then", "before"].contains(&self.at(on + 1));
        if !puts || self.at(on) != "on" || !ends || !is_determiner(self.at(index + 1)) {
            return false;
        }
        match self.at(index + 2) {
            "kettle" => self.say(index, on + 1, &["boil", "the", "kettle"]),
            "pan" | "pot" | "skillet" | "saucepan" => {
                self.say(on + 1, on + 1, &["the", "stove"]);
            }
            _ => return false,
        }
        true
    }
}
