//! Places told by what is there: "where the laptop was", "the statue joins it", "a ball on the desk that should be on the
//! floor"; and what is said to stay where it is.

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;
use crate::offline::text::POSSESSIVE;

/// How the grammar knows where something was before it goes elsewhere.
const WHERE_IT_WAS: [&str; 4] = ["in", "the", "place", "of"];

impl Rewriting<'_> {
    /// "put the phone where the laptop was": in its place; "the box that was there": the box.
    pub(super) fn where_things_were(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let told = self.put_where_it_was(index) || self.place_taken(index) || self.replaced(index);
            if !told
                && ["that", "which"].contains(&self.at(index))
                && ["was", "is", "were", "are", "stood"].contains(&self.at(index + 1))
                && self.at(index + 2) == "there"
                && self.noun_before(index).is_some()
            {
                let more = usize::from(self.at(index + 3) == "before");
                self.say(index, index + 3 + more, &[]);
            }
            index += 1;
        }
    }

    /// "put the phone where the laptop was", "and the mug where the egg was"
    fn put_where_it_was(&mut self, index: usize) -> bool {
        if self.at(index) != "where" || !is_determiner(self.at(index + 1)) {
            return false;
        }
        let to = usize::from(self.at(index - 1) == "to");
        let joined = (0..index).rev().find(|&at| self.at(at) == "and" || self.is_mark(at));
        let another = joined.is_some_and(|at| self.at(at) == "and" && self.names_only(at + 1, index));
        let put = (to == 1 || self.noun_before(index).is_some() || is_going(self.at(index - 1)))
            && (another || self.puts_before(index - to));
        let being = |at: usize| {
            ["was", "were", "stood"].contains(&self.at(at))
                || ["is", "are"].contains(&self.at(at)) && self.at(at + 1) == "now"
        };
        let was = (index + 3..index + 6).find(|&at| being(at)).filter(|&was| {
            self.noun_before(was).is_some()
                && (self.is_mark(was + 1) || ["and", "before", "now"].contains(&self.at(was + 1)))
        });
        let Some(was) = was.filter(|_| put) else { return false };
        let more = usize::from(["before", "now"].contains(&self.at(was + 1)));
        self.say(was, was + 1 + more, &[]);
        self.say(index - to, index + 1, &WHERE_IT_WAS);
        true
    }

    /// "the bread takes its place", "in the tomato's place": it goes where that was.
    fn place_taken(&mut self, index: usize) -> bool {
        let taken = ["take", "takes", "taking"].contains(&self.at(index));
        let inward = self.at(index) == "in" && self.noun_before(index).is_some();
        if !taken && !inward {
            return false;
        }
        let of = |at: usize| ["the", "its", "their"].contains(&self.at(at)) && self.at(at + 1) == "place";
        let (end, whose): (usize, Vec<String>) = if of(index + 1) && self.at(index + 1) == "the" {
            if self.at(index + 3) != "of" || !taken {
                return false;
            }
            (index + 4, Vec::new())
        } else if of(index + 1) {
            let it = if self.at(index + 1) == "its" { "it" } else { "them" };
            (index + 3, vec![it.to_owned()])
        } else {
            let place =
                (index + 2..index + 6).find(|&at| self.at(at) == "place" && self.at(at - 1) == POSSESSIVE);
            let Some(place) = place.filter(|_| is_determiner(self.at(index + 1))) else { return false };
            (place + 1, self.words(index + 1..place - 1))
        };
        let shall = taken && SHALL.contains(&self.at(index - 1));
        let told = taken && !shall && self.noun_before(index).is_some();
        if taken && !shall && !told {
            return false;
        }
        // "takes its place in the fridge" says where it is as well.
        let said = self.is_place(end);
        let mut words: Vec<&str> = Vec::new();
        if taken {
            words.push(if shall { "go" } else { "goes" });
        }
        if !said {
            words.extend(WHERE_IT_WAS);
            words.extend(whose.iter().map(String::as_str));
        }
        let words: Vec<String> = words.into_iter().map(str::to_owned).collect();
        self.say_all(index, end, &words);
        // "let the bread take its place"
        if let Some(lets) = (self.clause_start(index)..index).find(|&at| told && self.at(at) == "let") {
            self.say(lets, lets + 1, &[]);
        }
        true
    }

    /// "replace the egg with the tomato": the tomato goes where the egg was.
    fn replaced(&mut self, index: usize) -> bool {
        let order = ["replace", "exchange", "substitute"].contains(&self.at(index - 1))
            && (index == 1 || self.is_mark(index - 2));
        let end = self.next_mark(index, &[",", "."]);
        let joint = if self.at(index - 1) == "substitute" { "for" } else { "with" };
        let with = (index + 1..end).find(|&at| [joint, "by"].contains(&self.at(at)));
        let Some(with) = with.filter(|_| order) else { return false };
        // "replace the egg in the fridge with …"
        let lies = (index..with).find(|&at| self.is_place(at)).unwrap_or(with);
        if !self.names_only(index, lies) || lies < with && !self.names_only(lies + 1, with) {
            return false;
        }
        let until = (with + 2..end)
            .find(|&at| self.at(at) == "and" || self.is_place(at) || self.at(at) == "then")
            .unwrap_or(end);
        if self.is_place(until) || !self.names_only(with + 1, until) {
            return false;
        }
        let (first, second) = (self.words(index..lies), self.words(with + 1..until));
        let (comes, gone) = if joint == "for" { (first, second) } else { (second, first) };
        let was = WHERE_IT_WAS.map(str::to_owned);
        let words = [vec!["put".to_owned()], comes, was.to_vec(), gone].concat();
        self.say_all(index - 1, until, &words);
        true
    }

    /// Whether what stands before a place is put there: an order with no place of its own.
    fn puts_before(&self, end: usize) -> bool {
        let start = self.sentence_start(end);
        let order = (start..end).rev().find(|&at| self.is_order(at));
        (start..end).any(|at| is_going(self.at(at)) && at + 1 == end)
            || order.is_some_and(|order| {
                ["put", "place", "set", "move", "lay", "leave", "bring", "stand"].contains(&self.at(order))
                    && !(order..end).any(|at| self.is_place(at))
            })
    }

    /// "the statue joins it": it is beside it.
    pub(super) fn company(&mut self) {
        self.along_with();
        for index in 1..self.tokens.len() {
            let next = self.at(index + 1);
            if ["joins", "join"].contains(&self.at(index))
                && (is_determiner(next) || ["it", "them"].contains(&next))
                && self
                    .noun_before(index - usize::from(["can", "may", "should"].contains(&self.at(index - 1))))
                    .is_some()
            {
                // "joins the book in the box": both are there.
                let there = (index + 3..index + 6).find(|&at| {
                    ["in", "on", "inside"].contains(&self.at(at)) && self.noun_before(at).is_some()
                });
                if let Some(there) = there.filter(|&there| is_determiner(self.at(there + 1))) {
                    self.say(there, there, &["should", "be"]);
                    self.say(index, index + 1, &["and"]);
                } else {
                    let can = usize::from(["can", "may", "should"].contains(&self.at(index - 1)));
                    self.say(index - can, index + 1, &["should", "be", "beside"]);
                }
            }
        }
    }

    /// "there's a ball on the desk that should be on the floor, a pen on the bed that …": they should be there.
    pub(super) fn misplaced_things(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let that =
                ["that", "which"].contains(&self.at(index)) && SHALL[..5].contains(&self.at(index + 1));
            let start = self.clause_start(index);
            let joined = usize::from(["and", "then"].contains(&self.at(start)));
            let there = match (self.at(start + joined), self.at(start + joined + 1)) {
                ("there", "is" | "are") => 2,
                ("there" | "theres", _) => 1,
                _ => 0,
            };
            let thing = start + joined + there;
            let some = ["a", "an", "one", "two", "some"].contains(&self.at(thing));
            let end = self.next_mark(index, &[",", "."]);
            let once = !(thing..index)
                .chain(index + 2..end)
                .any(|at| is_going(self.at(at)) || self.is_mark(at) || SHALL.contains(&self.at(at)));
            if that
                && some
                && once
                && (thing..index).any(|at| self.is_place(at))
                && self.noun_before(index).is_some()
            {
                self.say(index, index + 1, &[]);
                self.say(start, thing, &[]);
                if start > 0 {
                    self.say(start - 1, start, &["."]);
                }
            }
            index += 1;
        }
    }

    /// "of the things on the shelf, the bowl …", "the statue left alone", "what's in the drawer can stay there, but …":
    /// nothing is done to it.
    pub(super) fn what_is_left(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || self.at(index - 1) == ".";
            let end = self.next_mark(index, &[",", "."]);
            let stays = (index + 1..end).find(|&at| {
                ["can", "may", "should", "must"].contains(&self.at(at))
                    && ["stay", "remain"].contains(&self.at(at + 1))
            });
            if opens
                && self.at(index) == "of"
                && is_determiner(self.at(index + 1))
                && self.at(end) == ","
                && end - index <= LONGEST_ASIDE
            {
                self.say(index, end + 1, &[]);
                continue;
            }
            if opens
                && ["what", "whatever"].contains(&self.at(index))
                && stays.is_some_and(|at| end - at <= 4)
            {
                let but = usize::from(["but", "and"].contains(&self.at(end + 1)));
                self.say(index, end + 1 + but, &[]);
                continue;
            }
            let left = self.at(index) == "left" && self.noun_before(index).is_some();
            let length = match (self.at(index + 1), self.at(index + 2), self.at(index + 3)) {
                ("alone" | "untouched", _, _) => 1,
                ("where" | "as", "it" | "they", "is" | "are") => 3,
                _ => 0,
            };
            if left && length > 0 && self.is_mark(index + 1 + length) {
                let start = (0..index).rev().find(|&at| self.is_mark(at));
                let told = start.is_some_and(|start| (start..index).any(|at| SHALL.contains(&self.at(at))));
                if let (Some(start), false) = (start, told) {
                    self.say(start, index + 1 + length, &[]);
                    index = start;
                }
            }
            index += 1;
        }
    }

    /// "put the spoon in the drawer along with the fork": put both there.
    fn along_with(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let along = ["along", "together"].contains(&self.at(index)) && self.at(index + 1) == "with";
            let start = self.clause_start(index);
            let first = (start..index).rev().find(|&at| self.is_order(at));
            let place = first.and_then(|first| (first + 2..index).find(|&at| self.is_place(at)));
            let end = (index + 3..index + 7).find(|&at| {
                self.noun_before(at).is_some() && (self.is_mark(at) || ["and", "then"].contains(&self.at(at)))
            });
            if let (true, Some(place), Some(end)) = (along && is_determiner(self.at(index + 2)), place, end)
                && self.noun_before(place).is_some()
                && self.noun_before(index).is_some()
            {
                let mut company = vec!["and".to_owned()];
                company.extend(self.words(index + 2..end));
                self.say(index, end, &[]);
                self.say_all(place, place, &company);
            }
            index += 1;
        }
    }
}
