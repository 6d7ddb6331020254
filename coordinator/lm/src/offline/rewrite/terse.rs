//! Telegrams and slips of people in a hurry, or of those who speak another language: "tv on lights off", "make full with
//! water", "laptop close", and what would make somebody happy.

use super::Rewriting;
use crate::offline::syntax::is_determiner;

/// What is often typed for another word, and no slip of a letter that spelling mends.
const TYPED_FOR: [(&str, &str); 12] = [
    ("teh", "the"),
    ("hte", "the"),
    ("adn", "and"),
    ("nad", "and"),
    ("wiht", "with"),
    ("tehn", "then"),
    ("thne", "then"),
    ("bothe", "both"),
    ("bith", "both"),
    ("thier", "their"),
    ("besides", "beside"),
    ("unto", "onto"),
];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn terse(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.typed_for(index);
            self.apart_by_states(index);
            let _ = self.close_behind(index)
                || self.make_full(index)
                || self.held_to_be_filled(index)
                || self.waits_till_full(index)
                || self.stands_there(index)
                || self.no_more(index)
                || self.put_on_stove(index)
                || self.would_be_happy(index);
            index += 1;
        }
    }

    /// "teh mug", "go to the counter an lay it down, than get the towel"
    fn typed_for(&mut self, index: usize) {
        let word = self.at(index);
        if let Some((_, meant)) = TYPED_FOR.iter().find(|(typed, _)| *typed == word) {
            let thing =
                is_determiner(self.at(index + 1)) || self.lexicon.noun(&[self.at(index + 1)]).is_some();
            if *meant != "beside" || thing {
                self.say(index, index + 1, &[meant]);
            }
        } else if word == "an"
            && self.is_order(index + 1)
            && !self.at(index + 1).starts_with(['a', 'e', 'i', 'o', 'u'])
        {
            self.say(index, index + 1, &["and"]);
        } else if word == "than"
            && index > 0
            && [",", ".", "and"].contains(&self.at(index - 1))
            && self.is_order(index + 1)
        {
            self.say(index, index + 1, &["then"]);
        }
    }

    /// "tv on lights off": two parts.
    fn apart_by_states(&mut self, index: usize) {
        const STATES: [&str; 7] = ["on", "off", "out", "open", "closed", "shut", "clean"];
        let state = STATES.contains(&self.at(index)) && index > 0;
        let start = self.clause_start(index);
        let joined = self.is_mark(index + 1) || self.at(index + 1) == "and";
        if !state || joined || !self.names_only(start, index) {
            return;
        }
        let next = (index + 2..index + 5).find(|&at| STATES.contains(&self.at(at)));
        let ends = |at: usize| {
            self.is_mark(at + 1)
                || ["and", "please"].contains(&self.at(at + 1))
                || self.lexicon.noun(&[self.at(at + 1)]).is_some()
        };
        if next.is_some_and(|next| self.names_only(index + 1, next) && ends(next)) {
            self.say(index + 1, index + 1, &[","]);
        }
    }

    /// "laptop close, phone to desk": close it.
    fn close_behind(&mut self, index: usize) -> bool {
        let start = self.clause_start(index);
        let verb = self.at(index) == "close" && self.is_mark(index + 1);
        if !verb || start == index || !self.names_only(start, index) {
            return false;
        }
        self.say(index, index + 1, &["closed"]);
        true
    }

    /// "make it full with water", "make full of water": fill it; "make clean the spoon": clean it.
    fn make_full(&mut self, index: usize) -> bool {
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
    fn held_to_be_filled(&mut self, index: usize) -> bool {
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
    fn waits_till_full(&mut self, index: usize) -> bool {
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

    /// "make sure that the statue stands on the table": is there; no stand.
    fn stands_there(&mut self, index: usize) -> bool {
        let stands =
            ["stands", "sits", "lies", "rests"].contains(&self.at(index)) && self.is_place(index + 1);
        let start = self.sentence_start(index);
        let wished = (start..index).any(|at| ["that", "sure", "ensure"].contains(&self.at(at)));
        if stands && (wished || self.at(index) == "stands") && self.noun_before(index).is_some() {
            self.say(index, index + 1, &["is"]);
            return true;
        }
        // "… and that the watch is kept on the dresser"
        let sure = (start..index).any(|at| ["sure", "ensure", "check", "see"].contains(&self.at(at)));
        if sure && self.starts(index, &["and", "that"]) && is_determiner(self.at(index + 2)) {
            self.say(index, index + 2, &[".", "make", "sure", "that"]);
            return true;
        }
        false
    }

    /// "fill the kettle and put on stove": put it there.
    fn put_on_stove(&mut self, index: usize) -> bool {
        let goes_on = index > 0 && [",", "and", "then"].contains(&self.at(index - 1));
        let stove = ["stove", "hob", "burner", "cooker"].contains(&self.at(index + 2));
        if !goes_on || !stove || !self.starts(index, &["put", "on"]) {
            return false;
        }
        self.say(index + 1, index + 1, &["it"]);
        true
    }

    /// "no more cartoons", "no more light burning": it is off.
    fn no_more(&mut self, index: usize) -> bool {
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

    /// "Dad is happiest when he finds his paper waiting on the sofa", "life would be easier if the remote was lying on the
    /// couch": it should be there.
    fn would_be_happy(&mut self, index: usize) -> bool {
        const GOOD: [&str; 16] = [
            "happy",
            "happier",
            "happiest",
            "easier",
            "nicer",
            "better",
            "lovely",
            "great",
            "nice",
            "good",
            "glad",
            "wonderful",
            "perfect",
            "best",
            "delighted",
            "pleased",
        ];
        const RESTS: [&str; 8] =
            ["waiting", "lying", "sitting", "standing", "ready", "laid", "resting", "simply"];
        let start = self.sentence_start(index);
        let good = (start..index).any(|at| GOOD.contains(&self.at(at)));
        if !["when", "if"].contains(&self.at(index)) || !good {
            return false;
        }
        let end = self.next_mark(index, &[",", "."]);
        let finds =
            (index + 1..index + 4).find(|&at| ["finds", "find", "found", "sees"].contains(&self.at(at)));
        let was = (index + 2..index + 7).find(|&at| ["was", "were", "is", "are"].contains(&self.at(at)));
        let (thing, behind) = match (finds, was) {
            (Some(finds), _) => (finds + 1, (finds + 2..end).find(|&at| self.noun_before(at).is_some())),
            (None, Some(was)) if self.noun_before(was).is_some() => (index + 1, Some(was)),
            _ => return false,
        };
        let Some(behind) = behind else { return false };
        // "… and the pan was on the stove": more than one wish.
        if (behind + 1..end).any(|at| self.at(at) == "and") {
            return false;
        }
        let passed = (behind..end)
            .take_while(|&at| {
                RESTS.contains(&self.at(at))
                    || ["was", "were", "is", "are", "just", "already"].contains(&self.at(at))
            })
            .count();
        let place = behind + passed;
        if !self.is_place(place) || !self.names_only(thing, behind) {
            return false;
        }
        self.say(behind, place, &["should", "be"]);
        self.say(start, thing, &[]);
        true
    }
}
