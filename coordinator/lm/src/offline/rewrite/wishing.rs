//! Wishes said as questions or as needs, and words that say nothing of the goal: said as what shall be.

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{is_determiner, preposition};

/// "I could do with …": I want it.
const LONGINGS: [&[&str]; 16] = [
    &["id", "prefer"],
    &["i", "would", "prefer"],
    &["id", "rather", "have"],
    &["i", "would", "rather", "have"],
    &["id", "kill", "for"],
    &["i", "would", "kill", "for"],
    &["i", "could", "kill", "for"],
    &["i", "could", "murder"],
    &["i", "could", "do", "with"],
    &["i", "could", "use"],
    &["i", "could", "really", "use"],
    &["id", "give", "anything", "for"],
    &["i", "am", "dying", "for"],
    &["im", "dying", "for"],
    &["i", "am", "in", "need", "of"],
    &["im", "in", "need", "of"],
];

impl Rewriting<'_> {
    /// "could the kettle be filled?": the kettle should be filled.
    pub(super) fn questions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [".", ","].contains(&self.at(index - 1));
            let asks = ["could", "can", "may", "might", "would"].contains(&self.at(index));
            let end = self.next_mark(index, &["."]);
            let be = (index + 2..end.min(index + LONGEST_ASIDE + 2)).find(|&at| self.at(at) == "be");
            if let Some(be) = be.filter(|_| opens && asks && is_determiner(self.at(index + 1))) {
                self.say(be, be, &["should"]);
                self.say(index, index + 1, &[]);
                // "… and the plant be watered"
                let mut at = be + 1;
                while at < end {
                    if self.at(at) == "be" && self.at(at - 1) != "should" && self.noun_before(at).is_some() {
                        self.say(at, at, &["should"]);
                        at += 1;
                    }
                    at += 1;
                }
            }
            index += 1;
        }
    }

    /// "the salt is needed on the table", "I could do with a cup", "whatever is on the desk", "do exactly the same"
    pub(super) fn needs(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let longing = self.one_of(index, &LONGINGS);
            if let Some(length) = longing {
                self.say(index, index + length, &["i", "want"]);
            } else if ["is", "are"].contains(&self.at(index))
                && ["needed", "wanted", "required"].contains(&self.at(index + 1))
                && self.is_place(index + 2)
                && self.at(index + 2) != "for"
            {
                self.say(index, index + 2, &["should", "be"]);
            } else if ["whatever", "what"].contains(&self.at(index))
                && ["is", "stands", "lies", "sits"].contains(&self.at(index + 1))
                && self.is_place(index + 2)
            {
                self.say(index, index + 2, &["everything"]);
            } else if self.at(index) == "exactly" && self.at(index + 1) == "the" {
                self.say(index, index + 1, &[]);
            } else if self.at(index) == "dried" && index > 0 && ["be", ","].contains(&self.at(index - 1)) {
                // What is dry is no state: "must be dried and put away".
                let joins = (index + 1..).take_while(|&at| [",", "and"].contains(&self.at(at))).count();
                if joins > 0 && self.is_participle(index + 1 + joins) {
                    self.say(index, index + 1 + joins, &[]);
                }
            }
            index += 1;
        }
    }

    /// "… when they're clean", "… once it is cold": in their order anyway.
    pub(super) fn ready(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let joins = ["when", "once"].contains(&self.at(index));
            let (who, length) = match (self.at(index + 1), self.at(index + 2)) {
                ("it" | "they" | "everything" | "all", "is" | "are") => (true, 3),
                ("theyre" | "it", _) => (true, 2),
                _ => (false, 0),
            };
            let state = self.lexicon.adjective(&[self.at(index + length)]).is_some();
            let ends = self.is_mark(index + length + 1);
            if joins && who && state && ends && !self.is_mark(index - 1) {
                let brought = self.brings(index, index + length);
                let wish: &[&str] = if self.at(index + 1) == "it" { &["it"] } else { &["they"] };
                let word = self.at(index + length).to_owned();
                self.say(index, index + length + 1, &[]);
                if !brought {
                    // "leave it in the sink when it is clean": nothing else says that it should be.
                    self.say(index, index, &[".", wish[0], "should", "be", &word]);
                }
            }
            index += 1;
        }
    }

    /// Whether something said before of the same thing brings about the state that is named at a place, or the state is
    /// no such thing.
    fn brings(&self, index: usize, state: usize) -> bool {
        let Some(state) = self.lexicon.adjective(&[self.at(state)]) else { return true };
        let clause = self.clause_start(index);
        let named = (clause..index).find_map(|at| self.noun_before(at).filter(|_| at > clause));
        let mentioned = |noun: &Vec<String>| {
            (0..clause.saturating_sub(noun.len() - 1)).any(|at| self.words(at..at + noun.len()) == *noun)
        };
        let alike = |property: &String| state.set.contains_key(property);
        let said = |at: usize| {
            self.lexicon.verbs(self.at(at)).iter().any(|(_, _, verb)| verb.set.keys().any(alike))
                || self.lexicon.adjective(&[self.at(at)]).is_some_and(|said| said.set.keys().any(alike))
        };
        let pronoun = (clause..index).any(|at| ["it", "them", "both", "everything"].contains(&self.at(at)));
        let earlier = if named.as_ref().is_some_and(mentioned) { 0 } else { clause };
        // "put it away once it is clean": what "it" is may well be said to be washed elsewhere.
        state.selects || pronoun || (earlier..index).any(said)
    }

    /// "the cup the plate and the fork": a list without commas; "the kitchen's clock": the clock.
    pub(super) fn bare_lists(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let length = self.noun_before(index).map_or(0, |noun| noun.len());
            let named = length > 0
                && index > length
                && ["the", "a", "an", "my"].contains(&self.at(index - length - 1));
            let another = ["the", "a", "an", "my"].contains(&self.at(index))
                && self.lexicon.noun(&[self.at(index + 1)]).is_some();
            if named && another {
                self.say(index, index, &[","]);
            }
            let room = self.lexicon.is_small("rooms", &[self.at(index - 1)]);
            if self.at(index) == crate::offline::text::POSSESSIVE && room && is_determiner(self.at(index - 2))
            {
                self.say(index - 1, index + 1, &[]);
            }
            index += 1;
        }
    }

    /// "…, drawers shut": those should be shut.
    pub(super) fn states_said_last(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let told = self.lexicon.adjective(&[self.at(index)]).is_some_and(|state| {
                state.set.contains_key("isOpen") && preposition(&[self.at(index)]).is_none()
            });
            let length = self.noun_before(index).map_or(0, |noun| noun.len());
            if !told || length == 0 || !self.is_mark(index + 1) || index < length + 1 {
                index += 1;
                continue;
            }
            let first = self.with_determiner(index - length);
            let comma = first > 0 && self.at(first - 1) == ","
                || first > 1 && self.at(first - 1) == "and" && self.at(first - 2) == ",";
            if comma {
                self.say(index, index, &["should", "be"]);
                index += 2;
            }
            index += 1;
        }
    }

    /// "neither the stove nor the tap should be on": both should not be; "make it so that …": make sure of it.
    pub(super) fn denials(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and", "that"].contains(&self.at(index - 1));
            if self.starts(index, &["make", "it", "so"]) {
                let that = usize::from(self.at(index + 3) == "that");
                self.say(index, index + 3 + that, &["make", "sure"]);
            }
            if opens && self.at(index) == "neither" {
                let end = self.next_mark(index, &["."]);
                let nor = (index..end).find(|&at| self.at(at) == "nor");
                let shall = nor.and_then(|nor| (nor..end).find(|&at| SHALL[..13].contains(&self.at(at))));
                let goes = nor.and_then(|nor| (nor..end).find(|&at| is_going(self.at(at))));
                if let (None, Some(goes)) = (shall, goes) {
                    self.say(goes, goes + 1, &["should", "be"]);
                }
                let shall = shall.or(goes);
                if let (Some(nor), Some(shall)) = (nor, shall) {
                    self.say(shall + 1, shall + 1, &["not"]);
                    self.say(nor, nor + 1, &["and"]);
                    self.say(index, index + 1, &[]);
                }
            }
            index += 1;
        }
    }

    /// "Dad is happiest when he finds his paper waiting on the sofa", "life would be easier if the remote was lying on the
    /// couch": it should be there.
    pub(super) fn would_be_happy(&mut self, index: usize) -> bool {
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
        if !["when", "if"].contains(&self.at(index)) {
            return false;
        }
        let start = self.sentence_start(index);
        if !(start..index).any(|at| GOOD.contains(&self.at(at))) {
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
