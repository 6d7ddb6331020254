//! How something is said, put plainly: contractions, "can" after a noun, "is to be", "there is …", states of lists.

use super::super::inflect::VerbForm;
use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{LIQUIDS, Relation, is_determiner, preposition};

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
const RESTING: [&str; 8] = ["lie", "stand", "sit", "rest", "remain", "wait", "live", "hang"];

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
            } else if word == "that"
                && self.tokens[index].typed.to_lowercase().ends_with("s")
                && self.noun_before(index).is_some()
                && preposition(&[self.at(index + 1)]).is_some()
            {
                // "the cup that's on the desk"
                self.say(index, index + 1, &["that", "is"]);
            } else if word == "having" && done && (index == 0 || self.is_mark(index - 1)) {
                self.say(index, index + 1, &["once", "you", "have"]);
            }
            index += 1;
        }
    }

    /// Whether something that was done stands at a place, and what it was done to.
    fn is_done(&self, index: usize) -> bool {
        let past = self.is_verb(index, VerbForm::Past);
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
                && (word == "can" && (["go", "stay", "be", "come", "move"].contains(&next) || resting(next))
                    || word == "may" && ["go", "come", "move"].contains(&next))
            {
                self.say(index, index + 1, &["should"]);
            } else if subject
                && ["cannot", "cant"].contains(&word)
                && (["stay", "be", "remain"].contains(&next) || resting(next))
            {
                self.say(index, index + 1, &["should", "not"]);
            } else if ["is", "are"].contains(&word) && self.starts(index + 1, &["not", "to"]) {
                self.say(index, index + 3, &["should", "not"]);
            } else if ["is", "are", "has", "have", "needs", "need", "ought"].contains(&word)
                && next == "to"
                && (resting(self.at(index + 2))
                    || ["hold", "contain"].contains(&self.at(index + 2))
                    || ["is", "are"].contains(&word) && self.at(index + 2) == "go"
                    || self.at(index + 2) == "be"
                        && (preposition(&[self.at(index + 3)]).is_some() || self.at(index + 3) == "there"))
            {
                self.say(index, index + 2, &["should"]);
            }
            let shall_before = (self.clause_start(index)..index).any(|at| SHALL[..3].contains(&self.at(at)));
            if self.at(index) == "and"
                && resting(self.at(index + 1))
                && preposition(&[self.at(index + 2)]).is_some()
                && (shall_before || self.lexicon.adjective(&[self.at(index - 1)]).is_some())
            {
                // "must be clean and stand on the shelf"
                self.say(index + 1, index + 2, &["they", "should", "be"]);
            } else if self.at(index) == "to"
                && resting(self.at(index + 1))
                && preposition(&[self.at(index + 2)]).is_some()
            {
                self.say(index + 1, index + 2, &["be"]);
            } else if self.starts(index, &["returned", "to"])
                && [",", "and", "be", "is", "are", "then"].contains(&self.at(index - 1))
            {
                self.say(index, index + 2, &["put", "in"]);
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
            let near = |at: usize| {
                preposition(&[self.at(at), self.at(at + 1), self.at(at + 2)])
                    .is_some_and(|(relation, _)| relation == Relation::Near)
            };
            // "should be beside it": nothing is said of how it is.
            if SHALL[..3].contains(&self.at(index)) && self.at(index + 1) == "be" && near(index + 2) {
                self.say(index + 1, index + 2, &["go"]);
            }
            index += 1;
        }
    }

    /// "that there is paper on the holder", "there should be a cup in the sink": the thing is to be there.
    pub(super) fn existence(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and", "then", "while"].contains(&self.at(index - 1));
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
            let place = (thing..end).find(|&at| self.is_place(at));
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
            } else if self.at(index) == "1" && self.lexicon.noun(&[self.at(index + 1)]).is_some() {
                self.say(index, index + 1, &["one"]);
            } else if self.at(index) == "plus" {
                self.say(index, index + 1, &["and"]);
            } else if ["everything", "anything"].contains(&self.at(index)) && self.at(index + 1) == "else" {
                self.say(index, index + 2, &["the", "rest"]);
            } else if ["that", "which"].contains(&self.at(index))
                && ["sits", "stands", "lies", "rests", "hangs", "sit", "stand", "lie"]
                    .contains(&self.at(index + 1))
                && preposition(&[self.at(index + 2)]).is_some()
            {
                // "the tomato that sits on the counter"
                self.say(index + 1, index + 2, &["is"]);
            } else if ["that", "which"].contains(&self.at(index))
                && ["is", "are"].contains(&self.at(index + 1))
                && LYING.contains(&self.at(index + 2))
                && preposition(&[self.at(index + 3)]).is_some()
            {
                self.say(index + 2, index + 3, &[]);
            } else if index > 0
                && ["lined", "stacked", "piled", "set", "laid"].contains(&self.at(index))
                && ["up", "out"].contains(&self.at(index + 1))
                && preposition(&[self.at(index + 2)]).is_some()
                && self.noun_before(index).is_some()
            {
                self.say(index, index + 2, &[]);
            } else if index > 0
                && LYING.contains(&self.at(index))
                && self.is_place(index + 1)
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
            let told = |this: &Self| {
                let start = this.clause_start(index);
                (start..index).any(|at| this.is_place(at)) || !this.is_order(start)
            };
            if let Some(was) = was.filter(|_| self.at(index) == "where" && who)
                && self.noun_before(index).is_some()
                && told(self)
            {
                let more = usize::from(["before", "now", "kept", "standing"].contains(&self.at(was + 1)));
                self.say(index, was + 1 + more, &[]);
            }
            // "put the salt where the pepper is"
            let is = was.filter(|&was| {
                self.is_mark(was + 1) && ["is", "are", "stands", "sits"].contains(&self.at(was))
            });
            if let Some(is) = is.filter(|_| self.at(index) == "where" && is_determiner(self.at(index + 1)))
                && self.is_order(self.clause_start(index))
                && !(self.clause_start(index)..index).any(|at| self.is_place(at))
                && self.noun_before(is).is_some()
            {
                self.say(is, is + 1, &[]);
                self.say(index, index + 1, &["next", "to"]);
            }
            let way = match self.at(index) {
                "down" => "closed",
                "up" => "open",
                _ => "",
            };
            let ends = self.is_mark(index + 1)
                || ["and", "by", "at", "when", "before", "after", "once"].contains(&self.at(index + 1));
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

    /// "the bread that you find on the counter", "the cup I left in the sink": that is there.
    pub(super) fn where_one_finds_it(&mut self) {
        const SEEN: [&str; 12] =
            ["find", "found", "see", "saw", "left", "put", "keep", "kept", "have", "had", "placed", "stored"];
        let mut index = 1;
        while index < self.tokens.len() {
            let that = usize::from(["that", "which"].contains(&self.at(index)));
            let person = ["you", "i", "we", "they"].contains(&self.at(index + that));
            let auxiliary = usize::from(["will", "can", "have", "had"].contains(&self.at(index + that + 1)));
            let verb = index + that + 1 + auxiliary;
            if person
                && SEEN.contains(&self.at(verb))
                && preposition(&[self.at(verb + 1)]).is_some()
                && self.noun_before(index).is_some()
            {
                self.say(index, verb + 1, &["that", "is"]);
            }
            index += 1;
        }
    }

    /// "the fridge should contain the egg and the milk", "the sofa needs the pillow": those should be in it.
    pub(super) fn containing(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let shall = usize::from(["should", "must", "shall"].contains(&self.at(index)));
            let gets = ["needs", "wants", "gets", "get", "receives", "receive"]
                .contains(&self.at(index + shall))
                && is_determiner(self.at(index + shall + 1))
                && (self.lexicon.noun(&[self.at(index + shall + 2)]).is_some()
                    || (2..5).any(|at| ["slice", "slices", "pieces"].contains(&self.at(index + shall + at))));
            let holds = gets
                || ["contain", "contains", "hold", "holds"].contains(&self.at(index + shall))
                    && (is_determiner(self.at(index + shall + 1))
                        || shall == 1
                        || LIQUIDS.contains(&self.at(index + shall + 1)));
            let told_apart = ["other", "former", "latter"].contains(&self.at(index - 1)) && gets;
            let vessel = self.noun_before(index).map_or(usize::from(told_apart), |noun| noun.len());
            let mut first = index - vessel;
            // "the washed bowl holds …"
            while vessel > 0 && first > 1 && self.lexicon.adjective(&[self.at(first - 1)]).is_some() {
                first -= 1;
            }
            let named = first > 0 && (is_determiner(self.at(first - 1)) || self.at(first - 1) == "one");
            let (true, true) = (holds && vessel > 0, named) else {
                index += 1;
                continue;
            };
            let things = index + shall + 1;
            if LIQUIDS.contains(&self.at(things)) {
                self.say(index, things, &["should", "be", "filled", "with"]);
                continue;
            }
            let end = (things..self.tokens.len())
                .find(|&at| {
                    [".", "that", "before", "after", "while", "once", "when", "until"].contains(&self.at(at))
                        || self.another_verb(at)
                })
                .unwrap_or(self.tokens.len());
            let end =
                (things..end).rev().find(|&at| ![",", "and"].contains(&self.at(at))).map_or(end, |at| at + 1);
            let mut behind = vec!["should".to_owned(), "be".to_owned(), "in".to_owned()];
            behind.extend(self.words(first - 1..index));
            self.say_all(end, end, &behind);
            self.say(first - 1, things, &[]);
            index = end;
        }
    }

    /// ", turn …", "and the light should …": what follows is said of something else.
    fn another_verb(&self, at: usize) -> bool {
        if ![",", "and"].contains(&self.at(at)) {
            return false;
        }
        let end = self.next_mark(at + 1, &[",", "."]);
        let joins = (at + 1..).take_while(|&at| ["and", "then"].contains(&self.at(at))).count();
        let next = self.at(at + 1 + joins);
        let ordered = next == "with"
            || !self.lexicon.verbs(next).is_empty()
                && (self.lexicon.noun(&[next]).is_none() || is_determiner(self.at(at + 2 + joins)));
        ordered
            || (at + 1..end).any(|at| {
                SHALL.contains(&self.at(at))
                    || is_going(self.at(at))
                    || ["contains", "holds", "wants", "gets", "receives"].contains(&self.at(at))
            })
    }

    /// "everything you cut", "whatever is washed": all of them.
    pub(super) fn what_was_done(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let all = ["everything", "all", "whatever", "anything"].contains(&self.at(index));
            let that = usize::from(self.at(index + 1) == "that");
            let person = ["you", "we", "youve", "weve"].contains(&self.at(index + 1 + that));
            let being =
                ["is", "was", "has"].contains(&self.at(index + 1 + that)) && self.at(index) == "whatever";
            let more = (index + 2 + that..)
                .take_while(|&at| ["have", "just", "already", "been", "had"].contains(&self.at(at)))
                .count();
            let done = index + 2 + that + more;
            let particle = usize::from(["up", "out"].contains(&self.at(done + 1)));
            let past = self.is_verb(done, VerbForm::Past) || ["cut", "put"].contains(&self.at(done));
            let closes = done + 1 + particle;
            let behind = self.at(closes);
            let ends = self.is_mark(closes)
                || preposition(&[behind]).is_some()
                || SHALL.contains(&behind)
                || is_going(behind);
            if all && (person || being) && past && ends {
                self.say(index, closes, &["all", "of", "them"]);
            } else if let Some(closes) = self.done_before(index).filter(|_| all) {
                self.say(index, closes, &["all", "of", "them"]);
            }
            index += 1;
        }
    }

    /// "(everything) sliced", "(all) that was washed", where that was asked for before: where the words end.
    fn done_before(&self, index: usize) -> Option<usize> {
        let that = usize::from(["that", "which"].contains(&self.at(index + 1)));
        let being = (index + 1 + that..)
            .take_while(|&at| ["is", "was", "has", "been", "got", "just", "being"].contains(&self.at(at)))
            .count();
        let done = index + 1 + that + being;
        let bases = crate::offline::inflect::bases(self.at(done));
        let said = bases.iter().any(|(base, _)| (0..index).any(|at| self.at(at) == base));
        let behind = self.at(done + 1);
        let ends = self.is_mark(done + 1)
            || preposition(&[behind]).is_some()
            || SHALL.contains(&behind)
            || is_going(behind);
        (self.is_verb(done, VerbForm::Past) && said && ends).then_some(done + 1)
    }

    /// "the bowl which you then put in the fridge": put the bowl in the fridge.
    pub(super) fn orders_in_relatives(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let which = ["which", "that"].contains(&self.at(index)) && self.at(index + 1) == "you";
            let then = ["then", "also", "afterwards", "should", "must"].contains(&self.at(index + 2));
            let verb = self.at(index + 3).to_owned();
            let placed = preposition(&[self.at(index + 4)]).is_some();
            let comma = usize::from(self.at(index - 1) == ",");
            let noun = self.noun_before(index - comma);
            if let (true, Some(noun)) =
                (which && then && placed && !self.lexicon.verbs(&verb).is_empty(), noun)
            {
                let mut order: Vec<&str> = vec![".", verb.as_str(), "the"];
                order.extend(noun.iter().map(String::as_str));
                self.say(index - comma, index + 4, &order);
            }
            index += 1;
        }
    }
}
