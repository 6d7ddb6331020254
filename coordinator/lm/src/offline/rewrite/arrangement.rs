//! Words in their usual order: places said first, what is not wanted, one for each.

use super::super::inflect::VerbForm;
use super::{LONGEST_ASIDE, Rewriting};
use crate::offline::clause::is_going;
use crate::offline::syntax::{is_determiner, preposition};

impl Rewriting<'_> {
    /// Where a sentence, or a part of one behind "and" or "then", begins.
    fn is_start(&self, index: usize) -> bool {
        index == 0
            || self.at(index - 1) == "."
            || ["and", "then"].contains(&self.at(index - 1)) && (index == 1 || self.is_mark(index - 2))
    }

    /// "in the drawer go the forks", "on the plate I want the egg": the things, and then where.
    pub(super) fn fronted_places(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            // "…, into the fridge goes the egg"
            let comma = index > 0
                && self.at(index - 1) == ","
                && (index + 2..index + 5).any(|at| {
                    is_going(self.at(at)) && is_determiner(self.at(at + 1)) && self.noun_before(at).is_some()
                });
            if !(self.is_start(index) || comma) || preposition(&[self.at(index)]).is_none() {
                index += 1;
                continue;
            }
            let end = self.next_mark(index, &["."]);
            let verb = (index + 2..end.min(index + LONGEST_ASIDE)).find(|&at| self.carries_place(at));
            let plain = |verb: usize| (index..verb).all(|at| !self.is_mark(at) && !is_going(self.at(at)));
            if let Some(verb) = verb.filter(|&verb| plain(verb)) {
                let place = self.words(index..verb);
                let place: Vec<&str> = place.iter().map(String::as_str).collect();
                let goes = is_going(self.at(verb)) || self.at(verb) == "should";
                let wish = if goes { verb + usize::from(self.at(verb) == "should") + 1 } else { verb };
                // ", and the plate …": another thing is said.
                let later = |at: usize| ["before", "after", "while", "once", "when"].contains(&self.at(at));
                let stop = (wish..end).find(|&at| later(at) || self.another_follows(at)).unwrap_or(end);
                let mut behind: Vec<&str> = if goes { vec!["go"] } else { Vec::new() };
                behind.extend(place);
                self.say(stop, stop, &behind);
                self.say(index, wish, &[]);
            }
            index += 1;
        }
    }

    /// "go the forks", "should go the forks", "I want the egg": what a place said first belongs to.
    fn carries_place(&self, at: usize) -> bool {
        let going = is_going(self.at(at)) && (is_determiner(self.at(at + 1)) || self.at(at + 1) == "both");
        let shall = self.at(at) == "should" && is_going(self.at(at + 1));
        let person = ["i", "we", "you"].contains(&self.at(at))
            && ["want", "need", "like", "put", "place"].contains(&self.at(at + 1))
            && is_determiner(self.at(at + 2));
        going || shall && is_determiner(self.at(at + 2)) || person
    }

    /// ", and the plate I want …", ", and in the drawer go …"
    fn another_follows(&self, at: usize) -> bool {
        let joined = self.at(at) == "," || self.at(at) == "and";
        let from = at + 1 + usize::from(self.at(at) == "," && self.at(at + 1) == "and");
        let person = (from..from + LONGEST_ASIDE)
            .take_while(|&at| !self.is_mark(at) && self.at(at) != "and")
            .any(|at| ["i", "we"].contains(&self.at(at)) && ["want", "need"].contains(&self.at(at + 1)));
        let told = (from + 1..from + 5).any(|at| {
            self.noun_before(at).is_some()
                && (["should", "must", "needs", "has"].contains(&self.at(at)) || is_going(self.at(at)))
        });
        let ordered = self.is_order(from) || self.at(from) == "then" || told;
        joined && (preposition(&[self.at(from)]).is_some() && self.at(from) != "of" || person || ordered)
    }

    /// "the plate I want on the table": "I want the plate on the table".
    pub(super) fn fronted_things(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let person = ["i", "we"].contains(&self.at(index))
                && ["want", "need"].contains(&self.at(index + 1))
                && (preposition(&[self.at(index + 2)]).is_some()
                    || self.lexicon.adjective(&[self.at(index + 2)]).is_some());
            let noun = self.noun_before(index).map(|noun| noun.len());
            if let (true, Some(length)) = (person, noun) {
                let mut first = self.with_determiner(index - length);
                // "the cup and the plate I want …"
                if first > 1
                    && self.at(first - 1) == "and"
                    && let Some(other) = self.noun_before(first - 1)
                {
                    first = self.with_determiner(first - 1 - other.len());
                }
                if first == 0 || self.is_mark(first - 1) || self.at(first - 1) == "and" {
                    let wish = self.words(index..index + 2);
                    self.say(index, index + 2, &[]);
                    self.say(first, first, &[&wish[0], &wish[1]]);
                }
            }
            index += 1;
        }
    }

    /// "instead of leaving the cup in the sink, …": only says what is spoken of; "… instead of on the table" says
    /// nothing of what shall be.
    pub(super) fn what_is_not_wanted(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let of = self.at(index + 1) == "of" && self.at(index) == "instead";
            let than = self.at(index + 1) == "than" && self.at(index) == "rather";
            if !of && !than {
                index += 1;
                continue;
            }
            let end = self.next_mark(index, &[",", "."]);
            let first = index == 0 || self.at(index - 1) == ".";
            let doing =
                self.at(index + 2).ends_with("ing") && !self.lexicon.verbs(self.at(index + 2)).is_empty();
            if first && doing && self.at(end) == "," {
                let things = index + 3;
                let place = (things..end).find(|&at| self.is_place(at)).unwrap_or(end);
                self.say(place, end + 1, &["."]);
                self.say(index, things, &[]);
            } else if first {
                self.say(index, end + 1, &[]);
            } else {
                let comma = usize::from(self.at(index - 1) == ",");
                self.say(index - comma, end, &[]);
            }
            index += 1;
        }
    }

    /// "the cup, the mug and the bowl each get their own shelf": one goes on a shelf, the next on another.
    pub(super) fn one_for_each(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let own = self.at(index) == "own" && ["its", "their", "his"].contains(&self.at(index - 1));
            let start = self.sentence_start(index);
            let each = (start..index).find(|&at| self.at(at) == "each");
            let (true, Some(each)) = (own, each) else {
                index += 1;
                continue;
            };
            let (first, verb) = (self.at(each + 1).to_owned(), each + 1);
            let gets = ["get", "gets", "have", "has", "need", "needs"].contains(&first.as_str());
            let goes = is_going(&first);
            let place = self.words(verb + 1..index - 1);
            let end = self.next_mark(index, &[",", ".", "and"]);
            let home = self.words(index + 1..end);
            if !(gets && place.is_empty() || goes && place.len() == 1) || home.is_empty() || each == start {
                index += 1;
                continue;
            }
            let joint = place.first().cloned().unwrap_or_else(|| "in".to_owned());
            let things = self.words(start..each);
            let mut plain: Vec<String> = vec!["put".to_owned()];
            let listed = things.split(|word| word == "," || word == "and").filter(|thing| !thing.is_empty());
            for (number, thing) in listed.enumerate() {
                if number > 0 {
                    plain.extend([",".to_owned(), "put".to_owned()]);
                }
                plain.extend(thing.iter().cloned());
                plain.extend([joint.clone(), if number == 0 { "one" } else { "another" }.to_owned()]);
                plain.extend(home.iter().cloned());
            }
            self.say_all(start, end, &plain);
            index = start + plain.len();
        }
    }

    /// "…, which then is carried to the table": said of the thing, in a sentence of its own.
    pub(super) fn which_then(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            if self.at(index - 1) == "which"
                && ["then", "afterwards", "in", "also", "finally"].contains(&self.at(index))
                && !(self.at(index) == "in" && self.at(index + 1) != "turn")
            {
                let length = 1 + usize::from(self.at(index) == "in");
                self.say(index, index + length, &[]);
            }
            // "which is carried to …" is what shall be.
            let done = self.lexicon.verbs(self.at(index + 1));
            if self.at(index - 1) == "which"
                && ["is", "are", "gets", "get"].contains(&self.at(index))
                && done.iter().any(|(form, _, _)| *form == VerbForm::Past)
                && self.lexicon.adjective(&[self.at(index + 1)]).is_none()
                && preposition(&[self.at(index + 2)]).is_some()
            {
                self.say(index, index + 1, &["should", "be"]);
            }
            index += 1;
        }
    }

    /// Orders in the words of a report: "they are both moved into the sink", "are best hidden in a drawer", "see that it
    /// is closed", "taking care that it does not leave the shelf", "into the box with the keys", "lower it onto the desk".
    pub(super) fn reported_orders(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let _ = self.are_moved(index)
                || self.best_kept(index)
                || self.see_that(index)
                || self.taking_care(index)
                || self.put_into_it_with(index)
                || self.lowered_onto(index)
                || self.everything_sliced(index);
            index += 1;
        }
    }

    /// "the cups are both moved into the sink": they should be.
    fn are_moved(&mut self, index: usize) -> bool {
        let both = usize::from(["both", "all", "each", "then"].contains(&self.at(index + 1)));
        let moved = ["moved", "carried", "brought", "taken", "transferred", "returned"]
            .contains(&self.at(index + 1 + both));
        let there = ["to", "into", "onto"].contains(&self.at(index + 2 + both));
        let are = ["is", "are"].contains(&self.at(index)) && moved && there;
        let told = are && index > 0 && self.noun_before(index).is_some();
        if told {
            self.say(index, index + 1 + both, &["should", "be"]);
        }
        told
    }

    /// "the keys are best hidden in a drawer": they should be.
    fn best_kept(&mut self, index: usize) -> bool {
        let best = ["is", "are"].contains(&self.at(index)) && self.at(index + 1) == "best";
        let kept = best && (self.is_participle(index + 2) || self.is_place(index + 2));
        if kept {
            self.say(index, index + 2, &["should", "be"]);
        }
        kept
    }

    /// "check that every cabinet is closed": make sure of it.
    fn see_that(&mut self, index: usize) -> bool {
        let sees = ["see", "check", "verify"].contains(&self.at(index)) && self.at(index + 1) == "that";
        let what = self.at(index + 2);
        let told = sees && (is_determiner(what) || ["every", "each", "all", "both", "no"].contains(&what));
        if told {
            self.say(index, index + 1, &["make", "sure"]);
        }
        told
    }

    /// "taking care that the statue does not leave its table": it stays.
    fn taking_care(&mut self, index: usize) -> bool {
        if !self.starts(index, &["taking", "care", "that"])
            && !self.starts(index, &["making", "sure", "that"])
        {
            return false;
        }
        let end = self.next_mark(index, &[",", "."]);
        let leaves = (index + 4..end).find(|&at| {
            ["does", "do"].contains(&self.at(at))
                && self.at(at + 1) == "not"
                && ["leave", "move"].contains(&self.at(at + 2))
                || ["doesnt", "dont"].contains(&self.at(at)) && ["leave", "move"].contains(&self.at(at + 1))
        });
        if let Some(leaves) = leaves.filter(|&leaves| self.names_only(index + 3, leaves)) {
            let mut said = vec![".".to_owned()];
            said.extend(self.words(index + 3..leaves));
            said.push("stays".to_owned());
            let comma = usize::from(index > 0 && self.at(index - 1) == ",");
            self.say_all(index - comma, end, &said);
        }
        leaves.is_some()
    }

    /// "into the box with the keys and the card": put them there.
    fn put_into_it_with(&mut self, index: usize) -> bool {
        let then = ["and", "then"].contains(&self.at(index.wrapping_sub(1)));
        let opens = index == 0 || self.is_mark(index - 1) || then;
        let inward = ["into", "onto"].contains(&self.at(index)) && is_determiner(self.at(index + 1));
        let with = (index + 3..index + 6).find(|&at| self.at(at) == "with" && self.noun_before(at).is_some());
        let Some(with) = with.filter(|_| opens && inward && is_determiner(self.at(index + 1))) else {
            return false;
        };
        let mut end = with + 1;
        while end < self.tokens.len() && !self.is_mark(end) || self.lists_on(end) {
            end += 1;
        }
        if !self.names_only(with + 1, end) {
            return false;
        }
        let mut order = vec!["put".to_owned()];
        order.extend(self.words(with + 1..end));
        order.extend(self.words(index..with));
        self.say_all(index, end, &order);
        true
    }

    /// Whether more things are listed behind a comma.
    fn lists_on(&self, at: usize) -> bool {
        let from = at + 1 + usize::from(self.at(at + 1) == "and");
        let end = self.next_mark(from, &[",", "."]);
        self.at(at) == "," && end > from && is_determiner(self.at(from)) && self.names_only(from, end)
    }

    /// "lower it onto the desk": put it there.
    fn lowered_onto(&mut self, index: usize) -> bool {
        let it = ["it", "them"].contains(&self.at(index + 1));
        let lowered = self.at(index) == "lower" && it && ["onto", "into", "to"].contains(&self.at(index + 2));
        if lowered {
            self.say(index, index + 1, &["put"]);
        }
        lowered
    }

    /// "everything sliced goes on the plate": all slices.
    fn everything_sliced(&mut self, index: usize) -> bool {
        let cut = ["sliced", "cut", "chopped", "diced"].contains(&self.at(index + 1));
        let sliced = self.at(index) == "everything" && cut;
        if sliced {
            self.say(index, index + 2, &["all", "slices"]);
        }
        sliced
    }
}
