//! Relative clauses that only say which thing is meant, or what is to become of its parts.

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::inflect::VerbForm;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "the bread, whose slices all go on the plate, …": the slices go there, in a sentence of its own.
    pub(super) fn whose_slices(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let comma = usize::from(self.at(index - 1) == ",");
            let parts = self.is_part(index + 1);
            if self.at(index) != "whose" || !parts || self.noun_before(index - comma).is_none() {
                index += 1;
                continue;
            }
            let closes = self.next_mark(index, &[",", "."]);
            if self.at(closes) == "," {
                self.say(closes, closes + 1, &["."]);
            }
            let all = usize::from(["all", "both", "each"].contains(&self.at(index + 2)));
            self.say(index - comma, index + 2 + all, &[".", "the", "slices"]);
            index += 1;
        }
    }

    /// "the fridge, whose door must be shut": the fridge must be.
    pub(super) fn whose_door(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let comma = usize::from(self.at(index - 1) == ",");
            let door = ["door", "doors", "lid", "cover", "screen", "flap"].contains(&self.at(index + 1));
            let told =
                SHALL.contains(&self.at(index + 2)) || ["stays", "remains"].contains(&self.at(index + 2));
            let noun = if self.at(index) == "whose" { self.noun_before(index - comma) } else { None };
            if let Some(noun) = noun.filter(|_| door && told) {
                let mut words = vec![".".to_owned(), "the".to_owned()];
                words.extend(noun);
                let shall = ["is", "are"].contains(&self.at(index + 2));
                if shall {
                    words.extend(["should".to_owned(), "be".to_owned()]);
                }
                self.say_all(index - comma, index + 2 + usize::from(shall), &words);
            }
            index += 1;
        }
    }

    /// "the machine that made it", "whatever is running", "any lamp that is still on": which is meant is known
    /// without it.
    pub(super) fn known_by_what_they_do(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let that = ["that", "which"].contains(&self.at(index));
            let named = that && self.noun_before(index).is_some();
            if let Some(length) = self.runs(index + 1).filter(|_| named) {
                self.say(index, index + 1 + length, &[]);
                let any = (index.saturating_sub(3)..index).find(|&at| self.at(at) == "any");
                if let Some(any) = any {
                    self.say(any, any + 1, &["every"]);
                }
            } else if let Some(length) = self.did_it(index + 1).filter(|_| named) {
                self.say(index, index + 1 + length, &[]);
            } else if self.at(index - 1) == "whatever"
                && ["is", "looks", "seems"].contains(&self.at(index))
                && self
                    .lexicon
                    .adjective(&[self.at(index + 1)])
                    .is_some_and(|state| state.set.contains_key("isDirty"))
            {
                self.say(index - 1, index + 1, &["everything", "that", "is"]);
            } else if self.at(index - 1) == "whatever"
                && let Some(length) = self.runs(index)
            {
                self.say(index - 1, index + length, &["everything"]);
            }
            index += 1;
        }
    }

    /// "is still running", where nothing more is said of it: how many words.
    fn runs(&self, at: usize) -> Option<usize> {
        let is = ["is", "are"].contains(&self.at(at));
        let still = usize::from(["still", "currently", "now"].contains(&self.at(at + 1)));
        let how = at + 1 + still;
        let length = match (self.at(how), self.at(how + 1)) {
            ("turned" | "switched" | "powered" | "left", "on") => 2,
            ("on" | "running" | "going" | "brewing" | "heating" | "cooking", _) => 1,
            _ => return None,
        };
        let behind = how + length;
        let ends = self.is_mark(behind)
            || ["off", "and", "or", "must", "should", "gets", "has", "is"].contains(&self.at(behind))
            || is_going(self.at(behind))
            || self.is_verb(behind, VerbForm::Past);
        (is && ends).then_some(2 + still + length - 1)
    }

    /// "made it", "brewed the coffee": how many words.
    fn did_it(&self, at: usize) -> Option<usize> {
        let done = self.is_verb(at, VerbForm::Past) || ["made", "brewed", "cut"].contains(&self.at(at));
        let it = ["it", "them", "that"].contains(&self.at(at + 1)) || self.at(at + 1) == "coffee";
        if done && it {
            return Some(2);
        }
        let noun = (at + 3..at + 5).find(|&end| self.noun_before(end).is_some())?;
        (done && is_determiner(self.at(at + 1)) && noun > at + 2).then_some(noun - at)
    }

    /// "the book I am reading", "the food that has to stay cold": which one is meant is known without it.
    pub(super) fn relatives(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let known = self.noun_before(index).is_some();
            let person = ["i", "we", "you", "he", "she", "they"].contains(&self.at(index));
            let being = ["am", "are", "is", "was", "were"].contains(&self.at(index + 1));
            let doing =
                |at: usize| self.at(at).ends_with("ing") && !self.lexicon.verbs(self.at(at)).is_empty();
            let must =
                ["has", "have", "needs", "need"].contains(&self.at(index + 1)) && self.at(index + 2) == "to";
            let stay = ["stay", "be", "keep"].contains(&self.at(index + 3))
                && self.lexicon.adjective(&[self.at(index + 4)]).is_some();
            if known && person && being && doing(index + 2) {
                self.say(index, index + 3, &[]);
            } else if known && ["im", "were"].contains(&self.at(index)) && doing(index + 1) {
                self.say(index, index + 2, &[]);
            } else if known && ["that", "which"].contains(&self.at(index)) && must && stay {
                self.say(index, index + 5, &[]);
            }
            index += 1;
        }
    }
}
