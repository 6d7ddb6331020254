//! Notes rather than sentences: "egg and fork: drawer", "out goes the soap", "one each in a drawer".

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::inflect::VerbForm;
use crate::offline::syntax::{is_determiner, preposition};

/// What a particle said first asks for: "out goes the soap".
const THROWN: [(&str, &[&str]); 5] = [
    ("out", &["throw", "away"]),
    ("off", &["turn", "off"]),
    ("on", &["turn", "on"]),
    ("away", &["put", "away"]),
    ("down", &["close"]),
];

impl Rewriting<'_> {
    /// "egg and lettuce: fridge": they go there; "plate: wash": wash it.
    pub(super) fn colon_notes(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let start = self.clause_start_of_list(index);
            let colon = self.tokens[index].typed == ":";
            let first = self.clause_start(index);
            let order = (first..index).find(|&at| self.is_order(at));
            if colon
                && order.is_some_and(|order| index - order <= 2)
                && self.noun_before(index).is_none()
                && is_determiner(self.at(index + 1))
            {
                // "wash up: the mug, the fork"
                self.say(index, index + 1, &[]);
                continue;
            }
            if !colon || start == index || !self.names_only(start, index) {
                index += 1;
                continue;
            }
            let behind = index + 1 + usize::from(is_determiner(self.at(index + 1)));
            let end = self.next_mark(index + 1, &[",", "."]);
            let noun = self.noun_before(end).map_or(0, |noun| noun.len());
            if noun > 0 && behind + noun == end {
                let article: &[&str] = if behind > index + 1 { &["in"] } else { &["in", "the"] };
                self.say(index, index + 1, article);
            } else if end == index + 2 && self.is_order(index + 1) {
                let verb = self.at(index + 1).to_owned();
                self.say(index, index + 2, &[]);
                self.say(start, start, &[&verb]);
            }
            index += 1;
        }
    }

    /// Where the names before a colon begin: at the end of the sentence before, or of the note before.
    fn clause_start_of_list(&self, colon: usize) -> usize {
        let start = self.sentence_start(colon);
        let earlier = (start..colon).rev().find(|&at| self.is_place(at));
        // "egg: fridge, fork and knife: drawer"
        let note = earlier.map(|at| self.next_mark(at, &[","])).filter(|&mark| mark < colon);
        note.map_or(start, |mark| mark + 1)
    }

    /// Whether a range is nothing but the names of things.
    pub(super) fn names_only(&self, from: usize, to: usize) -> bool {
        let mut at = from;
        while at < to {
            let word = self.at(at);
            if is_determiner(word) || [",", "and", "&"].contains(&word) {
                at += 1;
                continue;
            }
            let length = (1..=3.min(to - at)).rev().find(|&length| {
                let words = self.words(at..at + length);
                let words: Vec<&str> = words.iter().map(String::as_str).collect();
                self.lexicon.noun(&words).is_some() || self.lexicon.adjective(&words).is_some()
            });
            match length {
                Some(length) => at += length,
                None => return false,
            }
        }
        self.noun_before(to).is_some()
    }

    /// "out goes the soap", "off go the lights": throw it out, turn them off.
    pub(super) fn particles_first(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = self.opens_part(index);
            let order = THROWN.iter().find(|(particle, _)| *particle == self.at(index));
            if let (true, Some((_, order))) = (opens, order)
                && ["goes", "go", "comes", "come"].contains(&self.at(index + 1))
                && is_determiner(self.at(index + 2))
            {
                self.say(index, index + 2, order);
            }
            index += 1;
        }
    }

    /// "whatever egg there is", "any eggs you find": the egg; "the lot": all of it; "both want to be …": they should.
    pub(super) fn loose_amounts(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let there = (index + 2..index + 5)
                .find(|&at| self.at(at) == "there" && ["is", "are"].contains(&self.at(at + 1)));
            let is = (index + 2..index + 5).find(|&at| {
                ["is", "are"].contains(&self.at(at))
                    && self.is_place(at + 1)
                    && self.noun_before(at).is_some()
            });
            if ["whatever", "what"].contains(&self.at(index))
                && let Some(is) = is
            {
                self.say(is, is, &["that"]);
                self.say(index, index + 1, &["all", "the"]);
            } else if ["whatever", "what", "any"].contains(&self.at(index))
                && let Some(there) = there.filter(|&there| self.noun_before(there).is_some())
            {
                self.say(there, there + 2, &[]);
                let all = self.the_or_all(there);
                self.say(index, index + 1, all);
            } else if ["whatever", "any", "what"].contains(&self.at(index))
                && let Some(lie) = (index + 2..index + 5).find(|&at| self.lies_about(at) > 0)
                && self.noun_before(lie).is_some()
            {
                self.say(lie, lie + self.lies_about(lie), &[]);
                let all = self.the_or_all(lie);
                self.say(index, index + 1, all);
            } else if self.at(index) == "the"
                && ["whole", "entire", "full"].contains(&self.at(index + 1))
                && ["lot", "batch", "pile", "heap", "bunch", "load"].contains(&self.at(index + 2))
                && self.at(index + 3) != "of"
            {
                self.say(index, index + 3, &["all", "of", "them"]);
            } else if self.starts(index, &["the", "lot"]) && self.at(index + 2) != "of" {
                self.say(index, index + 2, &["all", "of", "them"]);
            } else if self.starts(index, &["the", "last", "of", "them"]) {
                self.say(index, index + 4, &["the", "latter"]);
            } else if self.starts(index, &["the", "first", "of", "them"]) {
                self.say(index, index + 4, &["the", "former"]);
            } else if index > 0
                && ["both", "they", "it", "all"].contains(&self.at(index - 1))
                && ["want", "wants"].contains(&self.at(index))
                && self.starts(index + 1, &["to", "be"])
            {
                self.say(index, index + 2, &["should"]);
            }
            index += 1;
        }
    }

    /// "(that) are lying around", "is left": how many words say no more than that it is there.
    fn lies_about(&self, at: usize) -> usize {
        let that = usize::from(["that", "which"].contains(&self.at(at)));
        let is = usize::from(["is", "are"].contains(&self.at(at + that)));
        let how = at + that + is;
        let lying = usize::from(["lying", "standing", "sitting", "left", "still"].contains(&self.at(how)));
        let about = usize::from(["around", "about", "there", "over"].contains(&self.at(how + lying)));
        let length = that + is + lying + about;
        let ends = self.is_mark(at + length) || self.at(at + length) == "and";
        if is + about > 0 && lying + about > 0 && is > 0 && ends { length } else { 0 }
    }

    /// "put the egg …, no, scratch that, put …": only what is said then; counts for the sentence before.
    pub(super) fn taken_back(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let back = ["scratch", "strike"].contains(&self.at(index)) && self.at(index + 1) == "that";
            if back && self.is_mark(index + 2) {
                let before = (0..index).rev().find(|&at| !self.is_mark(at) && self.at(at) != "no");
                let start = before.map_or(0, |at| self.sentence_start(at));
                self.say(start, index + 3, &[]);
                index = start;
            }
            index += 1;
        }
    }

    /// "the first thing I want is the cup on the desk; the second, …": I want it there.
    pub(super) fn counted_wishes(&mut self) {
        const COUNTED: [&str; 6] = ["first", "second", "third", "fourth", "last", "next"];
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and"].contains(&self.at(index - 1));
            let counted = self.at(index) == "the" && COUNTED.contains(&self.at(index + 1)) && opens;
            if counted && self.starts(index + 2, &["thing", "i", "want", "is"]) {
                self.say(index, index + 6, &["i", "want"]);
            } else if counted && self.at(index + 2) == "," && is_determiner(self.at(index + 3)) {
                self.say(index, index + 3, &[]);
            }
            index += 1;
        }
    }

    /// "not only the knife but also the pan": both.
    pub(super) fn not_only(&mut self) {
        for index in 0..self.tokens.len() {
            let end = self.next_mark(index, &["."]);
            let but = (index + 2..end).find(|&at| self.at(at) == "but");
            // "make sure that both …"
            if index > 0
                && self.at(index) == "that"
                && ["sure", "ensure", "certain", "see", "check"].contains(&self.at(index - 1))
                && ["both", "all", "every", "each"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
            }
            let only =
                self.at(index) == "not" && ["only", "just", "merely", "simply"].contains(&self.at(index + 1));
            if let Some(but) = but.filter(|_| only) {
                let also = usize::from(self.at(but + 1) == "also");
                self.say(but, but + 1 + also, &["and"]);
                self.say(index, index + 2, &[]);
            }
        }
    }

    /// What to put before the noun that ends before a place where any of it is meant: "any cups" are all the cups.
    fn the_or_all(&self, end: usize) -> &'static [&'static str] {
        if self.noun_is_plural(end) { &["all", "the"] } else { &["the"] }
    }

    /// Whether the noun that ends before a place is a plural.
    fn noun_is_plural(&self, end: usize) -> bool {
        let words = self.noun_before(end).unwrap_or_default();
        let ends = words.last().is_some_and(|last| last.ends_with('s') && !last.ends_with("ss"));
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        ends || self.lexicon.noun(&words).is_some_and(|(_, plural)| plural)
    }

    /// "ought to", "is supposed to", "had better": should.
    pub(super) fn duties(&mut self) {
        const DUTIES: [&[&str]; 14] = [
            &["ought", "to"],
            &["had", "better"],
            &["is", "supposed", "to"],
            &["are", "supposed", "to"],
            &["is", "meant", "to"],
            &["are", "meant", "to"],
            &["is", "due", "to"],
            &["are", "due", "to"],
            &["is", "expected", "to"],
            &["are", "expected", "to"],
            &["will", "have", "to"],
            &["would", "have", "to"],
            &["will", "need", "to"],
            &["are", "both", "to"],
        ];
        let mut index = 1;
        while index < self.tokens.len() {
            let person = ["i", "you", "we", "who"].contains(&self.at(index - 1));
            if let (Some(length), false) = (self.one_of(index, &DUTIES), person) {
                let also = usize::from(["also", "both", "all"].contains(&self.at(index + length)));
                self.say(index, index + length + also, &["should"]);
            }
            // "should finish on the table": be there in the end.
            let ends = ["finish", "end", "finishes", "ends", "wind", "winds"].contains(&self.at(index));
            let up = usize::from(self.at(index + 1) == "up");
            let so = |at: usize| {
                preposition(&[self.at(at)]).is_some() || self.lexicon.adjective(&[self.at(at)]).is_some()
            };
            let subject = self.noun_before(index).is_some()
                || SHALL.contains(&self.at(index - 1))
                || ["both", "they", "it", "all", "to", "that"].contains(&self.at(index - 1));
            if ends && subject && so(index + 1 + up) && !["with", "by"].contains(&self.at(index + 1 + up)) {
                let shall: &[&str] = match self.at(index - 1) {
                    "to" => &["be"],
                    before if SHALL.contains(&before) => &["be"],
                    _ => &["should", "be"],
                };
                self.say(index, index + 1 + up, shall);
            }
            index += 1;
        }
    }

    /// "into a drawer each", "into one drawer each": each into its own; "share a drawer": go into one.
    pub(super) fn shares(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let noun = self.noun_before(index).map_or(0, |noun| noun.len());
            let one = index.wrapping_sub(noun + 1);
            let each = self.at(index) == "each" && noun > 0 && ["a", "one", "an"].contains(&self.at(one));
            if each && (self.is_mark(index + 1) || ["and", "then"].contains(&self.at(index + 1))) {
                let start = self.clause_start(one);
                let goes = (start..one).find(|&at| is_going(self.at(at)));
                self.say(index, index + 1, &[]);
                if let Some(goes) = goes {
                    self.say(one, one + 1, &["their", "own"]);
                    self.say(goes, goes, &["each"]);
                } else {
                    self.say(one, one + 1, &["a"]);
                }
            } else if ["share", "shares"].contains(&self.at(index))
                && ["a", "one", "the"].contains(&self.at(index + 1))
                && (self.noun_before(index).is_some() || SHALL.contains(&self.at(index - 1)))
            {
                let shall: &[&str] =
                    if SHALL.contains(&self.at(index - 1)) { &["go", "in"] } else { &["should", "go", "in"] };
                self.say(index, index + 1, shall);
            }
            index += 1;
        }
    }

    /// "what goes in the fridge is the apple": the apple goes there.
    pub(super) fn clefts(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let shall = usize::from(self.at(index + 1) == "should");
            let going = is_going(self.at(index + 1 + shall)) && self.is_place(index + 2 + shall);
            let end = self.next_mark(index, &[",", "."]);
            let is = (index + 3..end).find(|&at| ["is", "are"].contains(&self.at(at)));
            if let (true, true, Some(is)) = (self.at(index) == "what", going, is)
                && is_determiner(self.at(is + 1))
                && self.noun_before(is).is_some()
            {
                let mut plain = self.words(is + 1..end);
                plain.extend(self.words(index + 1..is));
                self.say_all(index, end, &plain);
            }
            index += 1;
        }
    }

    /// "if you see any cups lying about, bin them": bin the cups; "see to the plate, washing it": wash it.
    pub(super) fn sightings(&mut self) {
        const SEEN: [&[&str]; 5] = [
            &["if", "you", "see"],
            &["if", "you", "find"],
            &["if", "you", "spot"],
            &["if", "there", "are"],
            &["should", "you", "see"],
        ];
        let mut index = 0;
        while index < self.tokens.len() {
            let seen = self.one_of(index, &SEEN).unwrap_or(0);
            let any = index + seen;
            let end = self.next_mark(index, &[",", "."]);
            let about = (any..end)
                .find(|&at| {
                    ["lying", "about", "around", "left", "standing", "sitting"].contains(&self.at(at))
                })
                .unwrap_or(end);
            let them = self.next_mark(end + 1, &[",", "."]).min(end + LONGEST_ASIDE);
            let pronoun = (end + 1..them).find(|&at| ["it", "them"].contains(&self.at(at)));
            let plain = self.noun_before(about).is_some() && !(about..end).any(|at| self.is_place(at));
            let order = self.is_order(end + 1);
            if let Some(pronoun) =
                pronoun.filter(|_| seen > 0 && plain && order && end - any <= LONGEST_ASIDE)
            {
                let several = usize::from(["any", "a", "an", "some"].contains(&self.at(any)));
                let all = if several > 0 { self.the_or_all(about) } else { &["the"] };
                let mut things: Vec<String> = all.iter().map(|&word| word.to_owned()).collect();
                things.extend(self.words(any + several..about));
                self.say_all(pronoun, pronoun + 1, &things);
                self.say(index, end + 1, &[]);
            } else if ["see", "sees"].contains(&self.at(index))
                && self.at(index + 1) == "to"
                && is_determiner(self.at(index + 2))
                && self.at(end) == ","
                && self.is_verb(end + 1, VerbForm::Gerund)
                && let Some(it) = (end + 2..end + 4).find(|&at| ["it", "them"].contains(&self.at(at)))
            {
                let things = self.words(index + 2..end);
                self.say_all(it, it + 1, &things);
                self.say(index, end + 1, &[]);
            }
            index += 1;
        }
    }
}
