//! What something becomes, said by "gets", "goes" and "has", as what it should be.

use super::Rewriting;
use crate::offline::clause::is_going;
use crate::offline::syntax::{LIQUIDS, is_determiner};

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
                || self.given_a_wash(index);
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
        let opens = self.opens_part(index);
        let all_of =
            usize::from(["all", "both"].contains(&self.at(index + 1)) && self.at(index + 2) == "of") * 2;
        let all_of = if ["slice", "slices", "pieces"].contains(&self.at(index + 2)) { 1 } else { all_of };
        let them = ["it", "them", "both", "that", "all", "those", "slice", "slices", "pieces", "everything"]
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
}
