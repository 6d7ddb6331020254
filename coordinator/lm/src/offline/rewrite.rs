//! Plainer words for the same thing: subordinate clauses made main ones, asides left out, before the grammar reads.

use super::clause::is_going;
use super::lexicon::{LONGEST, Lexicon};
use super::syntax::{is_determiner, preposition};
use super::text::Token;

mod accompaniment;
mod afterthoughts;
mod arrangement;
mod asides;
mod becoming;
mod colloquial;
mod coming;
mod conditions;
mod devices;
mod exceptions;
mod fragment;
mod hurry;
mod identified;
mod liquids;
mod looking;
mod meals;
mod members;
mod pairs;
mod people;
mod relations;
mod saying;
mod shorthand;
mod slices;
mod slips;
mod speech;
mod states;
mod subjects;
mod switching;
mod terse;
mod timing;
mod topic;
mod whereabouts;
mod wishing;

/// An aside is no longer than this, in words.
const LONGEST_ASIDE: usize = 8;

/// Words that say that something shall be.
const SHALL: [&str; 14] = [
    "should", "must", "shall", "can", "could", "may", "will", "needs", "need", "has", "have", "is", "are",
    "gets",
];

/// A sentence in plainer words.
pub fn rewritten(tokens: Vec<Token>, lexicon: &Lexicon) -> Vec<Token> {
    let mut text = Rewriting { tokens, lexicon };
    text.contractions();
    text.members_of_the_team();
    text.terse();
    text.slips();
    text.left_out();
    text.meals();
    text.colloquialisms();
    text.devices();
    text.clearings();
    text.reported_orders();
    text.accompaniments();
    text.afterthoughts();
    text.comings();
    text.places_after_places();
    text.duties();
    text.whose_slices();
    text.whose_door();
    text.known_by_what_they_do();
    text.slices();
    text.liquids();
    text.becoming();
    text.switching();
    text.not_only();
    text.corrections();
    text.people();
    text.doers();
    text.sightings();
    text.taken_back();
    text.counted_wishes();
    text.states_in_asides();
    text.being_done();
    text.empty_words();
    text.words_between();
    text.loose_amounts();
    text.particles_first();
    text.clefts();
    text.colon_notes();
    text.asides_of_order();
    text.where_it_stood();
    text.places_in_relatives();
    text.one_and_the_other();
    text.shares();
    text.done_first();
    text.joined_conditions();
    text.hasty_parts();
    text.orders_in_disguise();
    text.what_is_left();
    text.where_things_were();
    text.company();
    text.misplaced_things();
    text.roundabout_wishes();
    text.small_verbs();
    text.done_and_put();
    text.first_and_last();
    text.places_apart();
    text.reasons_before_so();
    text.loose_words();
    text.additions();
    text.states_behind_marks();
    text.places_in_need();
    text.questions();
    text.needs();
    text.ready();
    text.bare_lists();
    text.no_lights();
    text.left_so();
    text.laden_with();
    text.states_as_notes();
    text.states_said_last();
    text.announced_lists();
    text.listed_in_brackets();
    text.topics();
    text.turns_of_phrase();
    text.first_and_second();
    text.with_something_somewhere();
    text.where_one_finds_it();
    text.quantities();
    text.whereabouts();
    text.needless_conditions();
    text.exclusions();
    text.conditions();
    text.alternatives();
    text.containing();
    text.what_was_done();
    text.orders_in_relatives();
    text.contents();
    text.existence();
    text.what_is_not_wanted();
    text.headings();
    text.modals();
    text.fronted_things();
    text.fronted_places();
    text.one_for_each();
    text.which_then();
    text.subjects();
    text.small_words();
    text.relatives();
    text.exceptions();
    text.exceptions_said_last();
    text.denials();
    text.which();
    text.reasons();
    text.same_of_others();
    text.named_members();
    text.sentences_apart();
    text.tokens
}

/// A sentence in which a room left in the dark is one with its lights off: nobody leaves.
pub fn with_lights_off(tokens: Vec<Token>, lexicon: &Lexicon) -> Vec<Token> {
    let mut text = Rewriting { tokens, lexicon };
    text.dark_rooms();
    text.tokens
}

/// A sentence with its contractions written out, and nothing else changed.
pub fn written_out(tokens: Vec<Token>, lexicon: &Lexicon) -> Vec<Token> {
    let mut text = Rewriting { tokens, lexicon };
    let mut index = 0;
    while index < text.tokens.len() {
        // "it's": it is
        let is = ["it", "that", "there", "what", "where", "here", "he", "she"].contains(&text.at(index))
            && text.tokens[index].typed.to_lowercase().ends_with('s');
        if is {
            let word = text.at(index).to_owned();
            text.say(index, index + 1, &[&word, "is"]);
        }
        index += 1;
    }
    text.contractions();
    text.slips();
    text.tokens
}

struct Rewriting<'l> {
    tokens: Vec<Token>,
    lexicon: &'l Lexicon,
}

impl Rewriting<'_> {
    /// "Prepare the desk: put the pen on it": "it" is what the heading names.
    fn name_it(&mut self, start: usize, colon: usize, end: usize) {
        let first = (start..colon).find(|&at| is_determiner(self.at(at)));
        let noun = first.and_then(|first| {
            let last = (first + 2..=colon).find(|&at| self.noun_before(at).is_some())?;
            Some((first..last).map(|at| self.at(at).to_owned()).collect::<Vec<_>>())
        });
        let it = (colon + 1..end).find(|&at| self.at(at) == "it");
        // "boil the egg: fill the pot, put the egg in it": in what came in between.
        let ordered = |at: usize| {
            [",", "and"].contains(&self.at(at)) && !self.lexicon.verbs(self.at(at + 1)).is_empty()
        };
        let placed = it.filter(|&it| {
            ["on", "in", "onto", "into"].contains(&self.at(it - 1)) && !(colon + 1..it).any(ordered)
        });
        if let (Some(noun), Some(it)) = (noun, placed) {
            let noun: Vec<&str> = noun.iter().map(String::as_str).collect();
            self.say(it, it + 1, &noun);
        }
    }

    /// "Clear the table: the mug goes …": what is said behind the colon says how.
    fn headings(&mut self) {
        const WEAK: [&str; 15] = [
            "all",
            "i",
            "we",
            "clear",
            "tidy",
            "sort",
            "organize",
            "organise",
            "here",
            "there",
            "clean",
            "swap",
            "rearrange",
            "redistribute",
            "change",
        ];
        let mut start = 0;
        let mut index = 0;
        while index < self.tokens.len() {
            let dash = ["-", "\u{2013}", "\u{2014}"].contains(&self.tokens[index].typed.as_str());
            let colon = self.tokens[index].typed == ":" || dash && WEAK.contains(&self.at(start));
            let end = self.next_mark(index + 1, &["."]);
            let first = self.at(start).to_owned();
            let weak = WEAK.contains(&first.as_str()) || self.lexicon.is_small("weak", &[&first]);
            let told =
                (index + 1..end).any(|at| is_going(self.at(at)) || ["should", "must"].contains(&self.at(at)));
            let next = self.at(index + 1);
            let ordered = !self.lexicon.verbs(next).is_empty() && self.lexicon.noun(&[next]).is_none();
            let laid = ["lay", "set", "laid"].contains(&first.as_str())
                && index > 0
                && self.at(index - 1).ends_with("table");
            if colon && laid && (is_determiner(next) || self.lexicon.noun(&[next]).is_some()) {
                self.say(index, index + 1, &["with"]);
                continue;
            }
            let places = (index + 1..end).filter(|&at| self.at(at) == "to" || self.is_place(at)).count();
            // "make the bed nice: the pillow on it, the book beside it"
            let listed = places > usize::from(!WEAK.contains(&first.as_str()));
            if colon && weak && index - start <= LONGEST_ASIDE && (told || ordered || listed) {
                self.name_it(start, index, end);
                self.say(start, index + 1, &[]);
                index = start;
                continue;
            }
            if self.at(index) == "." {
                start = index + 1;
            }
            index += 1;
        }
    }

    /// "they all go", "the same drawer", "stay out on the table"
    fn small_words(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let (before, word, next) = (self.at(index - 1), self.at(index), self.at(index + 1));
            let all = before == "they" && ["all", "both"].contains(&word)
                || ["all", "both", "each"].contains(&word)
                    && (["need", "needs", "should", "must", "have", "has"].contains(&next) || is_going(next))
                    && self.noun_before(index).is_some();
            let same = before == "the" && word == "same" && self.lexicon.noun(&[next]).is_some();
            let out = ["stay", "stays", "left", "kept", "stand", "all"].contains(&before)
                && word == "out"
                && self.is_place(index + 1);
            // "the apple and the bread should both be sliced"
            let floats = ["should", "must", "shall", "to"].contains(&before)
                && ["both", "all", "each"].contains(&word)
                && next == "be";
            if all || same || out || floats {
                self.say(index, index + 1, &[]);
            }
            // "once clean, they go …"
            if self.is_mark(index - 1)
                && ["once", "when", "after"].contains(&self.at(index))
                && self.lexicon.adjective(&[self.at(index + 1)]).is_some()
                && self.at(index + 2) == ","
            {
                self.say(index, index + 3, &["then"]);
            }
            index += 1;
        }
    }

    /// "…, which goes in the fridge": said of the noun before it, in a sentence of its own; "…, which is old, …" is
    /// an aside.
    fn which(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            if self.at(index) != "which" || self.at(index - 1) != "," {
                index += 1;
                continue;
            }
            let closes = self.next_mark(index, &[",", "."]);
            let next = self.at(index + 1).to_owned();
            let Some(noun) = self.noun_before(index - 1) else {
                index += 1;
                continue;
            };
            let listed = self.noun_listed_before(index - 1, noun.len());
            let mut subject: Vec<&str> = vec![".", "the"];
            if let Some(first) = &listed {
                subject.extend(first.iter().map(String::as_str));
                subject.extend(["and", "the"]);
            }
            subject.extend(noun.iter().map(String::as_str));
            let one = ["should", "must", "shall", "needs", "has", "gets", "ends"];
            let several = ["need", "have", "end"];
            let told = ["is", "are", "was", "were"].contains(&next.as_str());
            let plural = matches!(next.as_str(), "go" | "belong" | "move" | "stay" | "hang" | "come");
            let said_of_several = plural || several.contains(&next.as_str());
            if said_of_several && listed.is_some() {
                self.say(index - 1, index + 1, &subject);
            } else if said_of_several {
                self.say(index - 1, index + 1, &[".", "they"]);
            } else if listed.is_none() && is_going(&next)
                || one.contains(&next.as_str())
                || told && self.at(index + 2) == "to"
            {
                self.say(index - 1, index + 1, &subject);
            } else if told && self.at(closes) == "," && closes - index <= LONGEST_ASIDE {
                self.say(index - 1, closes + 1, &[]);
            } else if ["you", "we", "i"].contains(&next.as_str()) {
                self.order_of_which(index, &noun);
            }
            index += 1;
        }
    }

    /// The noun joined by "and" to the one that ends before a place.
    fn noun_listed_before(&self, end: usize, length: usize) -> Option<Vec<String>> {
        let mut at = end.checked_sub(length + 1)?;
        if is_determiner(self.at(at)) {
            at = at.checked_sub(1)?;
        }
        if self.at(at) == "and" { self.noun_before(at) } else { None }
    }

    /// "the bread, which you also slice": an order after all.
    fn order_of_which(&mut self, index: usize, noun: &[String]) {
        let mut at = index + 2;
        while ["also", "should", "must", "then", "need", "to", "will", "have"].contains(&self.at(at)) {
            at += 1;
        }
        let verb = self.at(at).to_owned();
        if self.is_mark(at + 1) && !self.lexicon.verbs(&verb).is_empty() {
            let mut order: Vec<&str> = vec!["and", verb.as_str(), "the"];
            order.extend(noun.iter().map(String::as_str));
            self.say(index, at + 1, &order);
        }
    }

    /// "…, since it is rotten, …": why is no order.
    fn reasons(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let why = self.at(index) == ","
                && ["since", "because", "as"].contains(&self.at(index + 1))
                && ["it", "its", "they", "theyre", "that", "thats", "he", "she", "i", "im", "we"]
                    .contains(&self.at(index + 2));
            let closes = self.next_mark(index + 1, &[",", "."]);
            if why && self.at(closes) == "," && closes - index <= LONGEST_ASIDE + 2 {
                let goes_on = preposition(&[self.at(closes + 1)]).is_some();
                self.say(index, closes + usize::from(goes_on), &[]);
            }
            index += 1;
        }
    }

    /// "…; so does the pillow", "…, as does the lettuce", "…; the keys and the card too": what was said before holds
    /// for them as well.
    fn same_of_others(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let does =
                ["does", "do", "should", "must", "will", "is", "are", "can"].contains(&self.at(index + 1));
            let after_mark =
                self.is_mark(index - 1) || self.at(index - 1) == "and" && self.is_mark(index.wrapping_sub(2));
            if after_mark
                && ["so", "as"].contains(&self.at(index))
                && does
                && is_determiner(self.at(index + 2))
            {
                self.say(index, index + 2, &[]);
                self.join_before(index);
                // "…, and so does the spoon, and the kettle …": what comes then is another thing.
                let ends = (index + 2..index + 6)
                    .find(|&at| self.noun_before(at).is_some() && [",", "and"].contains(&self.at(at)));
                if let Some(ends) = ends {
                    self.say(ends, ends + 1, &["."]);
                }
            } else if self.at(index - 1) == "." && is_determiner(self.at(index)) {
                let end = self.next_mark(index, &[",", "."]);
                let too = if self.at(end - 1) == "too" {
                    1
                } else {
                    2 * usize::from(self.starts(end.saturating_sub(2), &["as", "well"]))
                };
                let plain = (index..end.saturating_sub(too)).all(|at| {
                    let word = self.at(at);
                    !is_going(word) && !SHALL.contains(&word) && preposition(&[word]).is_none()
                });
                if too > 0 && plain && end - index <= LONGEST_ASIDE {
                    self.say(end - too, end, &[]);
                    self.join_before(index);
                }
            }
            index += 1;
        }
    }

    /// Makes the end of a sentence before a place a comma.
    fn join_before(&mut self, index: usize) {
        let at = if self.at(index - 1) == "and" { index.saturating_sub(2) } else { index - 1 };
        if self.at(at) == "." {
            self.say(at, at + 1, &[","]);
        }
    }
}

#[cfg(test)]
mod tests;
