//! What is to be so or done before or beside something else: "once washed", "once both are inside", "while the bread is
//! being sliced", "when the lamp is on". Orders come in their order anyway; what has to be done for it is said plainly.

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::inflect::VerbForm;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// "carry the box, once both are inside, to the table": in their order anyway.
    pub(super) fn asides_of_order(&mut self) {
        let mut index = 1;
        while index + 2 < self.tokens.len() {
            let joins = self.at(index) == "," && ["once", "when", "after"].contains(&self.at(index + 1));
            let who = ["both", "it", "they", "all", "everything", "that"].contains(&self.at(index + 2));
            let being = ["is", "are", "has", "have"].contains(&self.at(index + 3));
            let end = self.next_mark(index + 1, &[",", "."]);
            let goes_on = self.is_place(end + 1);
            if joins && who && being && self.at(end) == "," && goes_on && end - index <= LONGEST_ASIDE {
                self.say(index, end + 1, &[]);
            }
            index += 1;
        }
    }

    /// "put the knife, once cleaned, in the drawer", "the bowl, once it has been washed, holds …": the clean knife, the
    /// washed bowl.
    pub(super) fn states_in_asides(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let noun = self.noun_before(index).map_or(0, |noun| noun.len());
            let joins = ["once", "when", "after"].contains(&self.at(index + 1));
            let end = self.next_mark(index + 1, &[",", "."]);
            let who = usize::from(["it", "they", "its"].contains(&self.at(index + 2)));
            let being = (index + 2 + who..end)
                .take_while(|&at| ["is", "are", "has", "have", "been"].contains(&self.at(at)))
                .count();
            let state = index + 2 + who + being;
            let plain = |at: usize| {
                at == end || self.lexicon.adjective(&[self.at(at)]).is_some_and(|state| !state.selects)
            };
            let first = index + 1 + usize::from(joins);
            let several = first < end
                && plain(first)
                && (first + 1 == end || self.at(first + 1) == "and" && first + 3 == end && plain(first + 2));
            let behind = self.at(end + 1);
            let goes_on = self.is_place(end + 1) || SHALL.contains(&behind) || is_going(behind);
            let told = noun > 0 && index > noun && is_determiner(self.at(index - noun - 1));
            let filled = joins && self.at(state) == "filled" && state + 1 == end && self.at(end) == ",";
            if self.at(index) == "," && told && filled {
                // "the kettle, once filled, goes on the burner"
                let thing = self.words(index - noun - 1..index);
                self.say(index, end + 1, &[]);
                let mut order = vec!["fill".to_owned()];
                order.extend(thing);
                order.push(".".to_owned());
                let start = self.clause_start(index - noun - 1);
                if start == index - noun - 1 {
                    self.say_all(start, start, &order);
                }
            } else if self.at(index) == "," && told && several && self.at(end) == "," && goes_on {
                let states = self.words(first..end);
                self.say(index, end + 1, &[]);
                self.say_all(index - noun, index - noun, &states);
            } else if self.at(index) == ","
                && told
                && joins
                && state + 1 == end
                && self.at(end) == ","
                && self.lexicon.adjective(&[self.at(state)]).is_some_and(|state| !state.selects)
            {
                let state = self.at(state).to_owned();
                self.say(index, end + 1, &[]);
                self.say(index - noun, index - noun, &[&state]);
            }
            index += 1;
        }
    }

    /// "while the bread is being sliced, …": it should be sliced.
    pub(super) fn being_done(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let being = (index + 2..end)
                .find(|&at| ["is", "are"].contains(&self.at(at)) && self.at(at + 1) == "being");
            if ["while", "whilst"].contains(&self.at(index))
                && is_determiner(self.at(index + 1))
                && let Some(being) = being
                && self.noun_before(being).is_some()
                && self.is_verb(being + 2, VerbForm::Past)
                && being + 3 == end
                && self.at(end) == ","
            {
                self.say(end, end + 1, &["."]);
                self.say(being, being + 2, &["should", "be"]);
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
    }

    /// "should be washed and put on a burner": put it there, and nothing is switched on.
    pub(super) fn done_and_put(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let start = self.sentence_start(index);
            let be = (start..index).rev().find(|&at| self.at(at) == "be");
            let shall = be.filter(|&be| be > start && SHALL.contains(&self.at(be - 1)));
            let done = shall.is_some_and(|be| {
                self.is_participle(be + 1) && !(be..index).any(|at| self.is_order(at) && at > be + 1)
            });
            let joined = ["and", ","].contains(&self.at(index - 1));
            if done && joined && self.at(index) == "put" && self.is_place(index + 1) {
                let both = shall.is_some_and(|be| {
                    let start = self.clause_start(be);
                    let first = start + usize::from(self.at(start) == "and");
                    (start..be).any(|at| ["they", "both"].contains(&self.at(at)))
                        || self.names_only(first, be - 1) && (first..be).any(|at| self.at(at) == "and")
                });
                self.say(index + 1, index + 1, if both { &["them"] } else { &["it"] });
            }
            index += 1;
        }
    }

    /// "should be on a burner once washed": washed, and then there; "when it's brewed, …": then; "leaving the knife where
    /// it is": nothing is done to it.
    pub(super) fn done_first(&mut self) {
        const READY: [&str; 6] = ["brewed", "through", "made", "over", "boiled", "finished"];
        let mut index = 1;
        while index < self.tokens.len() {
            let end = self.next_mark(index, &[",", "."]);
            let start = self.clause_start(index);
            let be = (start..index).find(|&at| self.at(at) == "be" && self.is_place(at + 1));
            if ["once", "when", "after"].contains(&self.at(index))
                && index + 2 == end
                && self.is_participle(index + 1)
                && let Some(be) = be
            {
                let done = self.at(index + 1).to_owned();
                self.say(index, index + 2, &[]);
                self.say(be + 1, be + 1, &[&done, "and", "put", "it"]);
            } else if ["leaving", "keeping"].contains(&self.at(index))
                && self.is_mark(index - 1)
                && (self.starts(end.saturating_sub(3), &["where", "it", "is"])
                    || self.starts(end.saturating_sub(3), &["where", "they", "are"])
                    || ["alone", "untouched", "there"].contains(&self.at(end - 1)))
            {
                self.say(index - 1, end, &[]);
            }
            let opens = index < 2 || self.is_mark(index - 2);
            let is = usize::from(["is", "has", "been"].contains(&self.at(index + 1)));
            if opens
                && ["once", "when", "after"].contains(&self.at(index - 1))
                && ["it", "its", "that", "thats"].contains(&self.at(index))
                && READY.contains(&self.at(index + 1 + is))
                && self.at(index + 2 + is) == ","
            {
                self.say(index - 1, index + 3 + is, &["then"]);
            }
            index += 1;
        }
    }

    /// "when the blinds are shut and the lamp is on, …": both shall be so.
    pub(super) fn joined_conditions(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || self.at(index - 1) == ".";
            let joins = ["when", "once", "after"].contains(&self.at(index));
            let end = self.next_mark(index, &[",", "."]);
            let and = (index..end).find(|&at| self.at(at) == "and" && is_determiner(self.at(at + 1)));
            let is = |at: &usize| {
                ["is", "are"].contains(&self.at(*at))
                    && self.noun_before(*at).is_some()
                    && self.lexicon.adjective(&[self.at(*at + 1)]).is_some()
            };
            if let Some(and) = and.filter(|&and| opens && joins && (index..and).any(|at| is(&at)))
                && let Some(second) = (and..end).find(is)
            {
                self.say(second, second + 1, &["should", "be"]);
            }
            index += 1;
        }
    }
}
