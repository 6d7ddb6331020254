//! How something is said, put plainly: contractions, "can" after a noun, "is to be", "there is …", states of lists.

use super::super::inflect::VerbForm;
use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::syntax::{is_determiner, preposition};

/// Contractions with "not", apart.
const DENIALS: [(&str, &str); 10] = [
    ("isnt", "is"),
    ("arent", "are"),
    ("wasnt", "was"),
    ("werent", "were"),
    ("shouldnt", "should"),
    ("mustnt", "must"),
    ("shant", "shall"),
    ("maynt", "may"),
    ("oughtnt", "should"),
    ("hasnt", "has"),
];

/// Verbs that say no more of a thing than where it is.
const RESTING: [&str; 7] = ["lie", "stand", "sit", "rest", "remain", "wait", "live"];

/// How things are where they are.
const LYING: [&str; 12] = [
    "sitting", "lying", "standing", "located", "placed", "found", "resting", "kept", "stored", "situated",
    "laying", "waiting",
];

impl Rewriting<'_> {
    /// "isn't" is "is not", "youve" before what was done is "you have", "having cut" is "once you have cut".
    pub(super) fn contractions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let word = self.at(index).to_owned();
            let done = self.is_done(index + 1);
            if let Some((_, first)) = DENIALS.iter().find(|(short, _)| *short == word) {
                self.say(index, index + 1, &[first, "not"]);
            } else if let (Some(who), true) = (word.strip_suffix("ve"), done)
                && ["you", "i", "we", "they"].contains(&who)
            {
                self.say(index, index + 1, &[who, "have"]);
            } else if word == "having" && done && (index == 0 || self.is_mark(index - 1)) {
                self.say(index, index + 1, &["once", "you", "have"]);
            }
            index += 1;
        }
    }

    /// Whether something that was done stands at a place, and what it was done to.
    fn is_done(&self, index: usize) -> bool {
        let past = self.lexicon.verbs(self.at(index)).iter().any(|(form, _, _)| *form == VerbForm::Past);
        let same = ["cut", "put", "set", "shut"].contains(&self.at(index));
        (past || same) && !self.is_mark(index + 1)
    }

    /// "the bowl can go …": no tin; "the remote has to lie …", "the book is to lie …": it shall be there.
    pub(super) fn modals(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let before = self.at(index - 1);
            let subject = before == "they" || before == "it" || self.noun_before(index).is_some();
            let person = ["i", "we", "he", "she", "nobody", "who"].contains(&before);
            let (word, next) = (self.at(index), self.at(index + 1));
            if person && word == "can" {
                self.say(index, index + 1, &["could"]);
                index += 1;
                continue;
            }
            let resting = |word: &str| RESTING.contains(&word);
            if subject
                && word == "can"
                && (["go", "stay", "be", "come", "move"].contains(&next) || resting(next))
            {
                self.say(index, index + 1, &["should"]);
            } else if ["is", "are"].contains(&word) && self.starts(index + 1, &["not", "to"]) {
                self.say(index, index + 3, &["should", "not"]);
            } else if ["is", "are", "has", "have", "needs", "need", "ought"].contains(&word)
                && next == "to"
                && (resting(self.at(index + 2)) || word == "is" && self.at(index + 2) == "go")
            {
                self.say(index, index + 2, &["should"]);
            }
            let resting_so = |at: usize| {
                preposition(&[self.at(at)]).is_some() || self.lexicon.adjective(&[self.at(at)]).is_some()
            };
            if SHALL.contains(&self.at(index)) && self.at(index) != "has" && self.at(index) != "have" {
                let at = index + 1 + usize::from(self.at(index + 1) == "not");
                if resting(self.at(at)) && resting_so(at + 1) {
                    self.say(at, at + 1, &["be"]);
                }
            }
            index += 1;
        }
    }

    /// "that there is paper on the holder", "there should be a cup in the sink": the thing is to be there.
    pub(super) fn existence(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and"].contains(&self.at(index - 1));
            let that = index > 0 && ["that", "sure", "ensure"].contains(&self.at(index - 1));
            let wished = ["should", "must", "shall", "needs", "has"].contains(&self.at(index + 1));
            if self.at(index) != "there" || !(that || opens && wished) {
                index += 1;
                continue;
            }
            let being = (index + 1..)
                .take_while(|&at| {
                    ["should", "must", "shall", "needs", "has", "to", "be", "is", "are", "always"]
                        .contains(&self.at(at))
                })
                .count();
            // "there's" has lost its "is" already.
            let thing = index + 1 + being;
            let end = self.next_mark(thing, &[",", "."]);
            let place =
                (thing..end).find(|&at| preposition(&[self.at(at)]).is_some_and(|_| self.at(at) != "of"));
            if let Some(place) = place.filter(|&place| place > thing && (being > 0 || that)) {
                let shall: &[&str] = if that { &["is"] } else { &["should", "be"] };
                self.say(place, place, shall);
                self.say(index, thing, &[]);
            }
            index += 1;
        }
    }

    /// "none of the cups", "each of the cups", "the cup itself", "that are sitting in the sink"
    pub(super) fn quantities(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            if self.starts(index, &["none", "of"]) && is_determiner(self.at(index + 2)) {
                self.say(index, index + 3, &["no"]);
            } else if index > 0
                && ["itself", "themselves"].contains(&self.at(index))
                && self.noun_before(index).is_some()
            {
                self.say(index, index + 1, &[]);
                continue;
            } else if self.at(index) == "plus" {
                self.say(index, index + 1, &["and"]);
            } else if ["everything", "anything"].contains(&self.at(index)) && self.at(index + 1) == "else" {
                self.say(index, index + 2, &["the", "rest"]);
            } else if ["that", "which"].contains(&self.at(index))
                && ["is", "are"].contains(&self.at(index + 1))
                && LYING.contains(&self.at(index + 2))
                && preposition(&[self.at(index + 3)]).is_some()
            {
                self.say(index + 2, index + 3, &[]);
            } else if index > 0
                && LYING.contains(&self.at(index))
                && preposition(&[self.at(index + 1)]).is_some_and(|_| self.at(index + 1) != "of")
                && self.noun_before(index).is_some()
            {
                // "a fork placed in the sink": a fork in it.
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
    }

    /// "the shelf where the vase was": which shelf is known without it; "the lid is down": closed.
    pub(super) fn whereabouts(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let was = (index + 2..end.min(index + LONGEST_ASIDE))
                .find(|&at| ["was", "is", "were", "are", "stood", "stands", "sits"].contains(&self.at(at)));
            let who = is_determiner(self.at(index + 1)) || ["it", "they"].contains(&self.at(index + 1));
            if let Some(was) = was.filter(|_| self.at(index) == "where" && who)
                && self.noun_before(index).is_some()
            {
                let more = usize::from(["before", "now", "kept", "standing"].contains(&self.at(was + 1)));
                self.say(index, was + 1 + more, &[]);
            }
            let way = match self.at(index) {
                "down" => "closed",
                "up" => "open",
                _ => "",
            };
            let ends = self.is_mark(index + 1) || self.at(index + 1) == "and";
            let told = ["is", "are", "be", "stay", "stays"].contains(&self.at(index - 1))
                && (index.saturating_sub(4)..index).any(|at| self.folds_down(at));
            if !way.is_empty() && ends && (told || self.folds_down(index)) {
                self.say(index, index + 1, &[way]);
            }
            index += 1;
        }
    }

    /// Whether the noun that ends before a place names what is closed by letting it down.
    fn folds_down(&self, end: usize) -> bool {
        const FOLDS: [&str; 2] = ["Toilet", "Blinds"];
        let noun = self.noun_before(end).and_then(|words| {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            self.lexicon.noun(&words).map(|(noun, _)| noun.kinds.clone())
        });
        noun.is_some_and(|kinds| kinds.iter().any(|kind| FOLDS.contains(&kind.as_str())))
    }

    /// "the mug, filled with water, to the table": no aside, what the mug shall hold.
    pub(super) fn contents(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let holds = ["filled", "full", "with", "containing", "holding"].contains(&self.at(index + 1));
            let closes = self.next_mark(index + 1, &[",", "."]);
            let behind = self.at(closes + 1);
            let goes_on =
                preposition(&[behind]).is_some() || behind == "and" && is_determiner(self.at(closes + 2));
            if self.at(index) == ","
                && holds
                && self.at(closes) == ","
                && closes - index <= LONGEST_ASIDE
                && goes_on
                && self.noun_before(index).is_some()
            {
                self.say(closes, closes + 1, &[]);
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
    }

    /// "unless the fridge is closed": if it is not.
    pub(super) fn exclusions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let is =
                (index + 1..end.min(index + LONGEST_ASIDE)).find(|&at| ["is", "are"].contains(&self.at(at)));
            if let Some(is) = is.filter(|&is| self.at(index) == "unless" && self.at(is + 1) != "not") {
                self.say(is + 1, is + 1, &["not"]);
                self.say(index, index + 1, &["if"]);
            }
            index += 1;
        }
    }

    /// "turn it on if it is not already", "unless it is clean already": as it shall be anyway.
    pub(super) fn needless_conditions(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]).min(self.tokens.len());
            let said: Vec<&str> = (index..end).map(|at| self.at(at)).collect();
            let comma = usize::from(self.at(index - 1) == ",");
            let (opening, rest) = match said.as_slice() {
                [opening @ ("if" | "unless"), "it" | "they", "is" | "are" | "has" | "have", rest @ ..]
                | [opening @ ("if" | "unless"), "it" | "theyre", rest @ ..] => (*opening, rest),
                ["if", rest @ ..] if rest.first() == Some(&"not") => ("if", rest),
                _ => ("", &[][..]),
            };
            let denied = rest.first() == Some(&"not");
            let already = rest.contains(&"already") || rest.contains(&"yet");
            let needless = rest.len() <= LONGEST_ASIDE
                && already
                && (opening == "if" && denied || opening == "unless" && !denied);
            if needless && !self.is_mark(index - 1 - comma) {
                self.say(index - comma, end, &[]);
            }
            index += 1;
        }
    }
}
