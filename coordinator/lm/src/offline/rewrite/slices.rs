//! What is done with all that was cut, or with all at once: "every piece of either goes …", "load the pan with the
//! slices", "the bowl is where the slices go", "turn the apple into slices".

use std::ops::Range;

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{LIQUIDS, is_determiner};

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn slices(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = self.opens_part(index);
            if opens {
                let _ = self.where_they_go(index) || self.are_put(index) || self.all_of_the_slices(index);
                let _ = self.thrown_in(index) || self.vessel_first(index);
                let _ = self.tipped_in(index) || self.used_to_hold(index) || self.by_cutting(index);
            }
            self.waiting(index);
            self.sliced_things(index);
            self.of_several(index);
            let _ = self.filled_with_things(index) || self.made_into_slices(index);
            index += 1;
        }
    }

    /// Says of a range that things are put into a vessel, both named within it.
    fn say_put_in(&mut self, all: Range<usize>, put: &str, things: Range<usize>, vessel: Range<usize>) {
        let mut order = vec![put.to_owned()];
        order.extend(self.words(things));
        order.push("in".to_owned());
        order.extend(self.words(vessel));
        self.say_all(all.start, all.end, &order);
    }

    /// Where what is said here ends: at a mark, or before another order.
    fn next_order(&self, from: usize) -> usize {
        (from..self.tokens.len())
            .find(|&at| self.is_mark(at) || ["and", "then"].contains(&self.at(at)) && self.is_order(at + 1))
            .unwrap_or(self.tokens.len())
    }

    /// Where the words for all the slices end that begin here: "all of the slices", "each slice".
    fn all_parts(&self, index: usize) -> Option<usize> {
        let counted = ["all", "every", "each", "both", "any", "the"].contains(&self.at(index));
        let end = (index + 1..index + 5).find(|&at| self.is_part(at))? + 1;
        let plain = (index + 1..end - 1)
            .all(|at| ["of", "the", "these", "those", "single", "and", "every"].contains(&self.at(at)));
        (counted && plain).then_some(end)
    }

    /// "the bowl is where all the slices go", "the bowl is for the slices": put them in it.
    fn where_they_go(&mut self, index: usize) -> bool {
        let is = (index + 2..index + 5).find(|&at| self.at(at) == "is" && self.noun_before(at).is_some());
        let Some(is) = is.filter(|_| is_determiner(self.at(index))) else { return false };
        let (there, for_them) = (self.at(is + 1) == "where", self.at(is + 1) == "for");
        let end = (is + 3..is + 9).find(|&at| {
            self.is_mark(at)
                || ["and", "then"].contains(&self.at(at))
                || is_going(self.at(at))
                || self.at(at) == "should"
        });
        let Some(end) = end
            .filter(|&end| (there || for_them) && (self.noun_before(end).is_some() || self.is_part(end - 1)))
        else {
            return false;
        };
        let goes = usize::from(is_going(self.at(end))) + 2 * usize::from(self.at(end) == "should");
        if there && goes == 0 || for_them && !self.is_part(end - 1) {
            return false;
        }
        self.say_put_in(index..end + goes, "put", is + 2..end, index..is);
        true
    }

    /// "leave every slice waiting in the pot": in the pot.
    fn waiting(&mut self, index: usize) {
        const HOW: [&str; 6] = ["sitting", "waiting", "lying", "resting", "ready", "aside"];
        let before =
            index > 0 && (self.is_part(index - 1) || ["both", "them", "it"].contains(&self.at(index - 1)));
        if before && HOW.contains(&self.at(index)) && self.is_place(index + 1) {
            self.say(index, index + 1, &[]);
        }
    }

    /// Whether the noun of one word at a place is food that is cut.
    fn is_cut_food(&self, at: usize) -> bool {
        const FOOD: [&str; 6] = ["Apple", "Bread", "Egg", "Lettuce", "Potato", "Tomato"];
        let noun = self.lexicon.noun(&[self.at(at)]);
        noun.is_some_and(|(noun, _)| noun.kinds.first().is_some_and(|kind| FOOD.contains(&kind.as_str())))
    }

    /// "tomato and potato slices", "pieces of the tomato and the potato", "the sliced tomato and potato": of both; "slices
    /// from the tomato": of it.
    fn of_several(&mut self, index: usize) {
        if index > 1
            && self.is_part(index)
            && self.is_cut_food(index - 1)
            && self.at(index - 2) == "and"
            && index > 2
            && self.is_cut_food(index - 3)
        {
            self.say(index - 2, index - 2, &["slices"]);
            return;
        }
        if self.is_part(index) && self.at(index + 1) == "from" {
            let the = usize::from(is_determiner(self.at(index + 2)));
            if self.is_cut_food(index + 2 + the) {
                self.say(index + 1, index + 2, &["of"]);
            }
        }
        let of = self.is_part(index) && self.at(index + 1) == "of";
        let sliced =
            self.lexicon.adjective(&[self.at(index)]).is_some_and(|state| state.set.contains_key("isSliced"))
                && self.is_cut_food(index + 1);
        let the = usize::from(of && is_determiner(self.at(index + 2)));
        let first = if of { index + 2 + the } else { index + 1 };
        if !(of && self.is_cut_food(first) || sliced) || self.at(first + 1) != "and" {
            return;
        }
        let another = usize::from(is_determiner(self.at(first + 2)));
        let second = first + 2 + another;
        let ends = self.is_place(second + 1) || self.is_mark(second + 1) || is_going(self.at(second + 1));
        if self.is_cut_food(second) && ends && (of || another == 0) {
            let word = if of { vec!["slices", "of"] } else { vec!["sliced"] };
            self.say(first + 2, first + 2, &word);
        }
    }

    /// "all the sliced food", where something was to be sliced: its slices.
    fn sliced_things(&mut self, index: usize) -> bool {
        const THINGS: [&str; 8] =
            ["food", "foods", "ingredients", "vegetables", "fruit", "stuff", "things", "items"];
        let the = usize::from(["the", "of"].contains(&self.at(index + 1)));
        let cut = index + 1 + the;
        let all = ["all", "the", "every", "both"].contains(&self.at(index));
        let sliced =
            self.lexicon.adjective(&[self.at(cut)]).is_some_and(|state| state.set.contains_key("isSliced"));
        let before = (0..index).any(|at| {
            self.lexicon.verbs(self.at(at)).iter().any(|(_, _, verb)| verb.set.contains_key("isSliced"))
        });
        let things = all && sliced && before && THINGS.contains(&self.at(cut + 1));
        if things {
            self.say(index, cut + 2, &["all", "the", "slices"]);
        }
        things
    }

    /// ", each slice placed in the bowl": put each there.
    fn are_put(&mut self, index: usize) -> bool {
        const PUT: [&str; 9] =
            ["placed", "put", "dropped", "tossed", "thrown", "moved", "set", "laid", "gathered"];
        let Some(end) = self.all_parts(index) else { return false };
        let put = PUT.contains(&self.at(end)) && self.is_place(end + 1);
        // "every slice into the pot"
        let behind = self.next_mark(end, &[",", "."]);
        let alone = ["into", "onto", "in", "on"].contains(&self.at(end))
            && !(end..behind).any(|at| is_going(self.at(at)) || SHALL.contains(&self.at(at)));
        if put || alone {
            self.say(end, end + usize::from(put), &[]);
            self.say(index, index, &["put"]);
        }
        put || alone
    }

    /// "all of the pieces go …", "every piece of either goes …": the slices go there.
    fn all_of_the_slices(&mut self, index: usize) -> bool {
        let all = ["all", "every", "each", "both", "any"].contains(&self.at(index));
        let of_the = match (self.at(index + 1), self.at(index + 2)) {
            ("of", "the" | "these" | "those") => 2,
            ("the" | "these" | "those" | "single", _) => 1,
            _ => 0,
        };
        let part = index + 1 + of_the;
        let parts = self.lexicon.is_small("slices", &[self.at(part).trim_end_matches('s')])
            || self.at(part) == "halves";
        let of_it = if self.at(part + 1) == "of"
            && ["it", "them", "either", "each", "both", "these", "those", "that"].contains(&self.at(part + 2))
        {
            2
        } else {
            0
        };
        let end = part + 1 + of_it;
        let goes = is_going(self.at(end))
            || ["should", "must", "needs", "need"].contains(&self.at(end))
            || ["is", "are"].contains(&self.at(end)) && self.at(end + 1) == "to";
        let told = all && parts && of_the + of_it > 0 && goes;
        if told {
            self.say(index, end, &["the", "slices"]);
            if is_going(self.at(index + 2)) && self.at(index + 2).ends_with('s') {
                self.say(index + 2, index + 3, &["go"]);
            }
        }
        told
    }

    /// "take the pot and throw in all the slices": put them in it.
    fn thrown_in(&mut self, index: usize) -> bool {
        let throws = ["put", "throw", "toss", "add", "drop", "tip", "chuck", "place"]
            .contains(&self.at(index))
            && self.at(index + 1) == "in";
        let end = self.all_parts(index + 2).or_else(|| {
            ["both", "them", "everything", "all"].contains(&self.at(index + 2)).then_some(index + 3)
        });
        let Some(end) =
            end.filter(|&end| throws && (self.is_mark(end) || ["and", "then"].contains(&self.at(end))))
        else {
            return false;
        };
        self.say(end, end, &["in", "it"]);
        self.say(index, index + 2, &["put"]);
        true
    }

    /// "into the pot, put all the slices": in the pot.
    fn vessel_first(&mut self, index: usize) -> bool {
        let comma = (index + 3..index + 6).find(|&at| self.at(at) == "," && self.noun_before(at).is_some());
        let into = ["into", "onto"].contains(&self.at(index))
            && is_determiner(self.at(index + 1))
            && comma.is_some_and(|comma| self.is_order(comma + 1));
        if into {
            let word = if self.at(index) == "into" { "in" } else { "on" };
            self.say(index, index + 1, &[word]);
        }
        into
    }

    /// "tip all the slices into the pot": put them in.
    fn tipped_in(&mut self, index: usize) -> bool {
        const TIP: [&str; 10] =
            ["pour", "empty", "tip", "sweep", "scrape", "shake", "brush", "tumble", "slide", "keep"];
        let end = self.all_parts(index + 1).or_else(|| {
            let all_of_it = self.starts(index + 1, &["all", "of", "it"]) as usize * 3;
            let them = usize::from(["them", "everything"].contains(&self.at(index + 1)));
            (all_of_it + them > 0).then_some(index + 1 + all_of_it + them)
        });
        let into = end.is_some_and(|end| ["into", "onto", "in", "on", "inside"].contains(&self.at(end)));
        let tips = into && TIP.contains(&self.at(index));
        if tips {
            self.say(index, index + 1, &["put"]);
        }
        tips
    }

    /// "use the bowl to hold every slice": put every slice in it.
    fn used_to_hold(&mut self, index: usize) -> bool {
        let to = (index + 2..index + 6).find(|&at| self.at(at) == "to" && self.noun_before(at).is_some());
        let Some(to) = to.filter(|_| self.at(index) == "use" && is_determiner(self.at(index + 1))) else {
            return false;
        };
        let holds = ["hold", "store", "collect", "contain", "keep", "gather"].contains(&self.at(to + 1));
        let end = self.next_order(to + 2);
        if !holds || end <= to + 2 {
            return false;
        }
        self.say_put_in(index..end, "put", to + 2..end, index + 1..to);
        true
    }

    /// "prepare the apple and the bread by slicing both": slicing them.
    fn by_cutting(&mut self, index: usize) -> bool {
        let prepares = ["prepare", "process", "prep", "fix", "ready"].contains(&self.at(index));
        let end = self.next_mark(index, &[",", "."]);
        let by = (index + 2..end).find(|&at| self.at(at) == "by" && self.at(at + 1).ends_with("ing"));
        let Some(by) = by.filter(|&by| {
            prepares
                && ["both", "it", "them", "each"].contains(&self.at(by + 2))
                && self.noun_before(by).is_some()
        }) else {
            return false;
        };
        let doing = self.at(by + 1).to_owned();
        self.say(by, by + 3, &[]);
        self.say(index, index + 1, &[&doing]);
        true
    }

    /// "fill the bowl with all the slices", "loading the pan with the potato and the egg": put them in it.
    fn filled_with_things(&mut self, index: usize) -> bool {
        const FILL: [&str; 9] = ["fill", "load", "pile", "heap", "pack", "stack", "stuff", "top", "cover"];
        const FILLING: [&str; 6] = ["filling", "loading", "piling", "heaping", "packing", "stacking"];
        let gerund = FILLING.contains(&self.at(index));
        let with = (index + 2..index + 6).find(|&at| self.at(at) == "with");
        let Some(with) = with.filter(|&with| {
            (gerund || FILL.contains(&self.at(index)))
                && is_determiner(self.at(index + 1))
                && self.noun_before(with).is_some()
        }) else {
            return false;
        };
        let end = self.next_order(with + 1);
        let end = end - usize::from(self.at(end - 1) == "and");
        let parts =
            ["slices", "pieces", "slice", "piece", "them", "both", "everything"].contains(&self.at(end - 1));
        let things =
            self.names_only(with + 1, end) && !(with + 1..end).any(|at| LIQUIDS.contains(&self.at(at)));
        if !parts && !things {
            return false;
        }
        let put = if gerund { "putting" } else { "put" };
        self.say_put_in(index..end, put, with + 1..end, index + 1..with);
        true
    }

    /// "turn the apple and the bread into slices": slice them.
    fn made_into_slices(&mut self, index: usize) -> bool {
        let opens = self.opens_part(index);
        let end = self.next_mark(index, &[",", "."]);
        let into = (index + 2..end).find(|&at| {
            self.at(at) == "into"
                && ["slices", "pieces", "chunks", "cubes", "wedges"].contains(&self.at(at + 1))
        });
        let Some(into) = into.filter(|&into| {
            opens
                && ["turn", "make"].contains(&self.at(index))
                && self.noun_before(into).is_some()
                && !(index + 1..into).any(|at| self.is_order(at))
        }) else {
            return false;
        };
        self.say(into, into + 2, &[]);
        self.say(index, index + 1, &["slice"]);
        true
    }
}
