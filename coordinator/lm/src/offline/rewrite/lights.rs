//! Lights and switches in everyday words, and what is said of an exception.

use super::Rewriting;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "… and finally a dark kitchen", "do without the lamp", "the lamp to shine": lights off, off, on.
    pub(super) fn dark_room(&mut self, index: usize) {
        let dark = self.at(index) == "a" && self.at(index + 1) == "dark";
        let room = self.lexicon.is_small("rooms", &[self.at(index + 2)]);
        let without = self.starts(index, &["do", "without"]);
        // "while the toaster runs", "put the toaster in operation"
        let runs = ["runs", "run"].contains(&self.at(index))
            && index > 1
            && self.at(self.clause_start(index)) == "while"
            && self.noun_before(index).is_some();
        if runs && self.is_mark(index + 1) {
            self.say(index, index + 1, &["is", "running"]);
        }
        let throws = ["throw", "drop", "bring"].contains(&self.at(index)) && self.opens_part(index);
        let lights = (index + 1..index + 5)
            .find(|&at| ["lights", "light"].contains(&self.at(at)) && !self.is_place(at + 1));
        let off = usize::from(self.at(index + 1) == "off");
        if let Some(light) = lights.filter(|&light| throws && self.names_only(index + 1 + off, light + 1)) {
            let down = usize::from(self.at(light + 1) == "down");
            if off + down > 0 || self.at(index) == "drop" {
                self.say(light + 1, light + 1 + down, &[]);
                self.say(index, index + 1 + off, &["turn", "off"]);
            }
        }
        if self.starts(index, &["in", "operation"]) || self.starts(index, &["into", "operation"]) {
            let start = self.clause_start(index);
            let order = (start..index).find(|&at| ["put", "place", "set", "bring"].contains(&self.at(at)));
            if let Some(order) = order.filter(|&order| self.names_only(order + 1, index)) {
                self.say(index, index + 2, &[]);
                self.say(order, order + 1, &["turn", "on"]);
                return;
            }
        }
        let shine = ["shine", "glow", "burn"].contains(&self.at(index + 1)) && self.at(index) == "to";
        if dark && room && index > 0 && self.is_mark(index + 3) {
            self.say(index, index + 3, &["the", "lights", "off"]);
        } else if without && (is_determiner(self.at(index + 2)) || self.at(index + 2) == "both") {
            self.say(index, index + 2, &["turn", "off"]);
        } else if shine && index > 0 && self.noun_before(index).is_some() && self.is_mark(index + 2) {
            self.say(index + 1, index + 2, &["be", "on"]);
        }
    }

    /// "except the mug, which should be full", "except the mug. Fill it": the mug.
    pub(super) fn about_the_exception(&mut self, index: usize) {
        if self.at(index) != "except" {
            return;
        }
        let first = index + 1 + usize::from(self.at(index + 1) == "for");
        let end = self.next_mark(first, &[",", "."]);
        if end == first || !is_determiner(self.at(first)) || !self.names_only(first, end) {
            return;
        }
        let said = self.words(first..end);
        let next = end + 1;
        let it = (next..next + 4).find(|&at| self.at(at) == "it");
        if self.at(end) == "," && self.at(next) == "which" {
            self.say_all(next, next + 1, &said);
            self.say(end, next, &["."]);
        } else if let Some(it) = it.filter(|_| self.at(end) == "." && self.is_order(next)) {
            self.say_all(it, it + 1, &said);
        }
    }

    /// "no drawer is left open", "not a single drawer stays open": every one of them is to be closed.
    pub(super) fn none_left_so(&mut self, index: usize) {
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

    /// "keep holding it": hold it; "let the coffee machine fill the mug": fill it with coffee; "the heat turned on": the
    /// burner; "before doing so": first.
    pub(super) fn everyday_orders(&mut self, index: usize) {
        let keeps = ["keep", "keeps"].contains(&self.at(index)) && self.at(index + 1) == "holding";
        let machine = self.starts(index, &["let", "the", "coffee"])
            && ["machine", "maker"].contains(&self.at(index + 3))
            && ["fill", "brew"].contains(&self.at(index + 4));
        let heat = self.starts(index, &["the", "heat"]) || self.starts(index, &["the", "flame"]);
        let turned = usize::from(["turned", "switched"].contains(&self.at(index + 2)));
        let doing = self.starts(index, &["before", "doing", "so"])
            || self.starts(index, &["before", "doing", "that"]);
        let start = self.clause_start(index);
        let (it, length) = match (self.at(index + 1), self.at(index + 2)) {
            ("it", "is") => ("it", 3),
            ("they", "are") => ("them", 3),
            ("theyre", _) => ("them", 2),
            _ => ("", 0),
        };
        let cold = length > 0
            && ["until", "till"].contains(&self.at(index))
            && ["cold", "chilled", "cool"].contains(&self.at(index + length))
            && (start..index).any(|at| ["keep", "leave", "put", "store", "place"].contains(&self.at(at)));
        if cold {
            self.say(index, index + length + 1, &["and", "chill", it]);
        } else if keeps {
            self.say(index, index + 2, &["hold"]);
        } else if machine {
            let end = self.next_mark(index, &[",", "."]);
            let end = (index..end).find(|&at| self.at(at) == "and").unwrap_or(end);
            self.say(end, end, &["with", "coffee"]);
            self.say(index, index + 5, &["fill"]);
        } else if heat && ["on", "off"].contains(&self.at(index + 2 + turned)) && index > 0 {
            self.say(index + 1, index + 2 + turned, &["burner"]);
        } else if doing {
            let but = usize::from(index > 0 && self.at(index - 1) == "but");
            self.say(index - but, index + 3, &[]);
        } else if self.at(index) == "beforehand" && self.is_mark_or_and(index + 1) {
            self.say(index, index + 1, &[]);
        } else if self.at(index) == "toast"
            && index > 1
            && self.at(index - 1) == "of"
            && self.is_part(index - 2)
        {
            self.say(index, index + 1, &["toasted", "bread"]);
        }
    }

    /// "both vegetables finally rest in that pot": they go there.
    pub(super) fn finally_rest(&mut self, index: usize) {
        let finally = ["finally", "then", "eventually", "should"].contains(&self.at(index.wrapping_sub(1)));
        let rest = ["rest", "rests"].contains(&self.at(index)) && ["in", "on"].contains(&self.at(index + 1));
        if index > 1 && finally && rest {
            let should = self.at(index - 1) == "should";
            let from = index - usize::from(!should);
            let wish: &[&str] = if should { &["be"] } else { &["should", "be"] };
            self.say(from, index + 1, wish);
        }
    }

    /// "clear the table, taking the cup to the sink", "get the table cleared: the cup …": what comes says how.
    pub(super) fn cleared(&mut self, index: usize) {
        if index > 0 && self.at(index - 1) != "." {
            return;
        }
        let end = self.next_mark(index, &[",", "."]);
        let gets = ["get", "have"].contains(&self.at(index)) && self.at(end.wrapping_sub(1)) == "cleared";
        let clears = self.at(index) == "clear" && is_determiner(self.at(index + 1));
        let colon = self.tokens.get(end).is_some_and(|token| token.typed == ":");
        let taking =
            ["taking", "moving", "bringing", "putting", "placing", "carrying"].contains(&self.at(end + 1));
        if !(gets || clears) || end > index + 6 || !(colon || self.at(end) == "," && taking) {
            return;
        }
        let order = match self.at(end + 1) {
            "taking" | "moving" | "bringing" | "carrying" => "move",
            _ => "put",
        };
        if taking {
            self.say(end + 1, end + 2, &[order]);
        }
        self.say(index, end + 1, &[]);
    }

    fn is_mark_or_and(&self, index: usize) -> bool {
        self.is_mark(index) || self.at(index) == "and"
    }
}
