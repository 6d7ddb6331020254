//! Remarks: what is told beside orders and orders nothing: "Grandma is coming.", "…, nobody is watching".
//!
//! An instruction is split into parts, at marks and before what joins another part to one. A part that only tells
//! something is left out where another part orders something, and said to be taken as a remark.

use super::clause::is_going;
use super::lexicon::{LONGEST, Lexicon};
use super::scene::Scene;
use super::syntax::{LIQUIDS, is_determiner, preposition};
use super::text::Token;
use super::{inflect, situation};
use telling::Said;

mod antecedent;
mod telling;
mod wishes;

/// Who says in so many parts what to do has said all of it: what is told beside them asks for nothing more.
const SAID_ALL: usize = 3;

/// What joins a reason or a time to what is ordered.
const SUBORDINATORS: [&str; 13] = [
    "where",
    "because",
    "since",
    "as",
    "when",
    "once",
    "before",
    "after",
    "while",
    "until",
    "till",
    "whenever",
    "otherwise",
];

/// Names that are no persons'.
const DAYS: [&str; 7] = ["monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday"];

/// Tokens from one place up to another.
#[derive(Clone, Copy, Debug)]
struct Part {
    from: usize,
    to: usize,
}

/// The tokens of an instruction, and what they may be about.
struct Remarks<'a> {
    tokens: Vec<Token>,
    lexicon: &'a Lexicon,
    scene: &'a Scene<'a>,
}

/// An instruction without its remarks, and the remarks.
pub fn set_apart(tokens: &[Token], lexicon: &Lexicon, scene: &Scene<'_>) -> (Vec<Token>, Vec<String>) {
    let mut text = Remarks { tokens: tokens.to_vec(), lexicon, scene };
    text.say_what_others_say();
    text.wish_for_others();
    let parts = text.parts();
    let telling: Vec<bool> =
        (0..parts.len()).map(|at| text.is_remark(parts[at]) || text.tells_of_the_past(at, &parts)).collect();
    let orders: Vec<bool> =
        parts.iter().zip(&telling).map(|(part, tells)| !tells && text.orders(*part)).collect();
    let said = orders.iter().filter(|orders| **orders).count();
    // "Let's clear the table. The cup goes …, the plate …, the bread …": so it is done.
    let announced = |at: usize| said > SAID_ALL && text.announces(parts[at]);
    if said == 0 {
        return (text.tokens, Vec::new());
    }
    let left_out: Vec<bool> = (0..parts.len())
        .map(|at| {
            announced(at) || telling[at] && (said >= SAID_ALL || text.asks_for_nothing(at, &parts, &orders))
        })
        .collect();
    text.without(&parts, &left_out)
}

/// An instruction in which what is told of things before they are asked for is left out, and pronouns for them are
/// replaced by their names.
pub fn told_apart(tokens: &[Token], lexicon: &Lexicon, scene: &Scene<'_>) -> Vec<Token> {
    Remarks { tokens: tokens.to_vec(), lexicon, scene }.name_what_is_told_of()
}

impl Remarks<'_> {
    fn at(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    fn typed(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.typed.as_str())
    }

    fn is_mark(&self, index: usize) -> bool {
        index >= self.tokens.len() || [",", "."].contains(&self.at(index))
    }

    /// Splits at marks and before what joins.
    fn parts(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        let mut from = 0;
        for index in 0..=self.tokens.len() {
            let mark = self.is_mark(index);
            let ends = mark || index > from && self.joins(index);
            if !ends {
                continue;
            }
            if index > from {
                parts.push(Part { from, to: index });
            }
            from = index + usize::from(mark);
        }
        parts
    }

    /// Whether another part begins here without a mark before it: "… so wash it", "… because I am late".
    fn joins(&self, index: usize) -> bool {
        let next = self.at(index + 1);
        match self.at(index) {
            "because" => true,
            "so" => {
                ["that", "no", "please", "can", "could", "will", "would"].contains(&next)
                    || self.somebody(index + 1)
                    || self.is_order(index + 1)
                    || is_determiner(next)
                    || self.lexicon.noun(&[next]).is_some() && self.lexicon.adjective(&[next]).is_none()
            }
            "if" => ["there", "need", "needed", "necessary"].contains(&next),
            "but" if next == "whatever" => true,
            "and" | "but" | "then" => {
                let then = usize::from(["then", "please", "just", "also"].contains(&next));
                self.is_order(index + 1 + then) || ["i", "im", "ill", "we", "nobody"].contains(&next)
            }
            word => {
                SUBORDINATORS.contains(&word)
                    && self.at(index - 1) != "soon"
                    && (self.somebody(index + 1) || ["you", "youve", "youre"].contains(&next))
            }
        }
    }

    /// Whether somebody is spoken of here who is no robot.
    fn somebody(&self, index: usize) -> bool {
        let words: Vec<String> = telling::spelled_out(&self.tokens[index.min(self.tokens.len())..]);
        telling::person(&words, &self.named_persons(index), self.lexicon).is_some()
    }

    /// Whether an order begins here.
    fn is_order(&self, index: usize) -> bool {
        let word = self.at(index);
        let base = !word.ends_with('s') || word.ends_with("ss");
        base && !is_going(word)
            && self.lexicon.noun(&[word]).is_none()
            && self.lexicon.verbs(word).iter().any(|(form, _, _)| *form == inflect::VerbForm::Base)
    }

    /// Whether a thing of the scene is named here that is no class of things.
    fn own_name(&self, index: usize) -> bool {
        self.thing(index).is_some_and(|length| {
            let words: Vec<&str> = (index..index + length).map(|at| self.at(at)).collect();
            let liquid = LIQUIDS.contains(&words[0]) && length == 1;
            !liquid && self.lexicon.noun(&words).is_none_or(|(noun, _)| !noun.class)
        })
    }

    /// In how many words a thing of the scene is named here. "can" is no tin, and "Camp" no lamp.
    fn thing(&self, index: usize) -> Option<usize> {
        let typed = self.typed(index);
        let large = typed.chars().next().is_some_and(char::is_uppercase);
        let plain = typed.to_lowercase().replace(['\'', '\u{2019}'], "");
        let repaired = large && plain != self.at(index) && plain.strip_suffix('s') != Some(self.at(index));
        if self.at(index) == "can" || repaired {
            return None;
        }
        let longest = LONGEST.min(self.tokens.len().saturating_sub(index));
        (1..=longest).rev().find(|&length| {
            let words: Vec<&str> = (index..index + length).map(|at| self.at(at)).collect();
            let noun = self.lexicon.noun(&words);
            noun.is_some_and(|(noun, _)| noun.kinds.iter().any(|kind| self.scene.has(kind)))
                || length == 1 && self.scene.named(words[0]).is_some()
        })
    }

    fn names_a_thing(&self, part: Part) -> bool {
        (part.from..part.to).any(|at| self.thing(at).is_some())
    }

    /// Whether a part says what to do, as far as its words tell: it names a thing of the scene.
    fn orders(&self, part: Part) -> bool {
        let joins = (part.from..part.to)
            .take_while(|&at| ["and", "then", "but", "so", "please", "just", "also"].contains(&self.at(at)))
            .count();
        let spoken_of = (part.from..part.to).any(|at| ["it", "them", "both"].contains(&self.at(at)));
        self.names_a_thing(part) || spoken_of && self.is_order(part.from + joins)
    }

    /// Which of the words from a place on are names of persons: written large, and no word that is known.
    fn named_persons(&self, from: usize) -> Vec<bool> {
        let named = |at: usize| {
            let typed = self.typed(at);
            let capital = typed.chars().next().is_some_and(char::is_uppercase);
            let lower = typed.chars().skip(1).all(|c| c.is_lowercase() || c == '\'');
            let plain = typed.to_lowercase();
            let plain = plain.trim_end_matches("'s");
            capital
                && lower
                && typed.len() > 2
                && !DAYS.contains(&plain)
                && !super::text::is_known(plain, self.lexicon, self.scene)
        };
        (from..self.tokens.len()).map(named).collect()
    }

    /// "someone had a shower": of what was, if nothing behind it is said of it.
    fn tells_of_the_past(&self, at: usize, parts: &[Part]) -> bool {
        let part = parts[at];
        let words = telling::spelled_out(&self.tokens[part.from..part.to]);
        let Some(length) = telling::person(&words, &self.named_persons(part.from), self.lexicon) else {
            return false;
        };
        let was = words
            .get(length)
            .is_some_and(|word| ["had", "took", "used", "forgot", "broke"].contains(&word.as_str()));
        let pronoun =
            |part: &Part| (part.from..part.to).any(|at| ["it", "them", "that", "one"].contains(&self.at(at)));
        was && !words.iter().any(|word| word == "to") && !parts[at + 1..].iter().take(2).any(pronoun)
    }

    /// How many tokens at the start of a part name a person: the cleaner is no bottle.
    fn persons(&self, part: Part) -> usize {
        let words: Vec<String> = (part.from..part.to).map(|at| self.at(at).to_owned()).collect();
        let determined = words.first().is_some_and(|word| is_determiner(word));
        let length = telling::person(&words, &[], self.lexicon).filter(|_| determined);
        length.unwrap_or(0)
    }

    /// Whether a part only tells something, or only calls or greets somebody.
    fn is_remark(&self, part: Part) -> bool {
        let words = telling::spelled_out(&self.tokens[part.from..part.to]);
        let said = Said {
            words: &words,
            named: self.named_persons(part.from),
            thing: self.names_a_thing(part),
            own_name: (part.from + self.persons(part)..part.to).any(|at| self.own_name(at)),
            colon: self.typed(part.to) == ":",
            sentence: part.from == 0 || self.at(part.from - 1) == ".",
            ends: self.at(part.to) != ",",
        };
        // "before you turn off the lamp": that is to be done as well.
        let when =
            ["before", "after", "once"].contains(&self.at(part.from)) && self.at(part.from + 1) == "you";
        let verb = part.from + 2 + usize::from(self.at(part.from + 2) == "have");
        let done = !self.lexicon.verbs(self.at(verb)).is_empty() && said.own_name;
        if when && done && !["leave", "go", "come", "left"].contains(&self.at(verb)) {
            return false;
        }
        said.is_remark(self.lexicon) || said.is_vague(self.lexicon) || said.colon && self.heads(part)
    }

    /// "Let's clear the table.": what is done by what is said behind it.
    fn announces(&self, part: Part) -> bool {
        let opens = part.from == 0 && part.to - part.from <= 6;
        let clears = ["clear", "tidy", "clean", "sort"].contains(&self.at(part.from + 1))
            && self.at(part.from) == "let";
        opens && clears
    }

    /// "Closing up the kitchen now:", "get the soup going:": a heading of what is said behind it.
    fn heads(&self, part: Part) -> bool {
        let first = self.at(part.from);
        let end =
            (part.to + 1..self.tokens.len()).find(|&at| self.at(at) == ".").unwrap_or(self.tokens.len());
        let told = (part.to + 1..end)
            .any(|at| is_placed(self.at(at)) || self.lexicon.adjective(&[self.at(at)]).is_some());
        let weak = !self.is_order(part.from) || self.lexicon.is_small("weak", &[first]);
        let listed = (part.from..part.to)
            .any(|at| ["following", "these", "this", "bring", "take"].contains(&self.at(at)));
        !self.names_a_thing(part)
            && weak
            && !listed
            && (part.from == 0 || self.at(part.from - 1) == ".")
            && (told || self.is_order(part.to + 1))
            && (part.to + 1..end).any(|at| self.thing(at).is_some())
    }

    /// Whether what a part tells asks for nothing: no situation answers it, it says why or when, or the order that
    /// it leads to is said behind it.
    fn asks_for_nothing(&self, at: usize, parts: &[Part], orders: &[bool]) -> bool {
        let part = parts[at];
        let words: Vec<String> = (part.from..part.to).map(|at| self.at(at).to_owned()).collect();
        let reason = SUBORDINATORS.contains(&words[0].as_str()) || words[0] == "so";
        let leads = parts
            .get(at + 1)
            .is_some_and(|next| orders[at + 1] && (self.at(next.from) == "so" || self.typed(part.to) == ":"));
        let back = telling::refers_back(&words);
        let said = orders.iter().filter(|orders| **orders).count();
        let own = if said > 1 { &["later", "myself", "ourselves"][..] } else { &["later"] };
        let later = words.iter().any(|word| own.contains(&word.as_str()));
        // "open the blinds, it is like a cave in here": why.
        let explains = at > 0
            && said > 0
            && (orders[at - 1] || self.is_order(parts[at - 1].from + 1))
            && self.typed(parts[at - 1].to) == ",";
        // "it feels so gloomy in here, brighten things up": what is asked for is said.
        let asked = parts.get(at + 1).is_some_and(|next| {
            let words: Vec<String> = (next.from..next.to).map(|at| self.at(at).to_owned()).collect();
            let strong = situation::ranked(self.lexicon, &situation::words_of(&words), true);
            !orders[at + 1] && !self.is_remark(*next) && !strong.is_empty()
        });
        reason
            || leads
            || back
            || later
            || explains
            || asked
            || situation::ranked(self.lexicon, &situation::words_of(&words), false).is_empty()
    }

    /// What is left, with the stronger of the marks around what was left out, and what was left out, in words.
    fn without(self, parts: &[Part], left_out: &[bool]) -> (Vec<Token>, Vec<String>) {
        let mut kept: Vec<Token> = Vec::with_capacity(self.tokens.len());
        let mut remarks = Vec::new();
        let (mut bare, mut asks, mut why) = (false, false, false);
        for (part, left_out) in parts.iter().zip(left_out) {
            let mark = self.tokens.get(part.to).filter(|_| self.is_mark(part.to));
            if *left_out {
                let words: Vec<&str> = (part.from..part.to).map(|at| self.at(at)).collect();
                remarks.push(words.join(" "));
                match (kept.last_mut(), mark) {
                    // "the tomato, since it is rotten, in the bin", "could you, when you can, wash the cup"
                    (Some(last), Some(mark))
                        if last.text == ","
                            && mark.text == ","
                            && (preposition(&[self.at(part.to + 1)]).is_some() || asks) =>
                    {
                        kept.pop();
                    }
                    (Some(last), Some(mark)) if last.text == "," => last.clone_from(mark),
                    (Some(last), Some(mark)) if ![",", "."].contains(&last.text.as_str()) => {
                        kept.push(mark.clone())
                    }
                    _ => {}
                }
                asks = false;
                why = true;
                bare = kept.last().is_none_or(|last| last.text == ".");
                continue;
            }
            // "Grandma is coming, so wash the cup": wash it.
            let joins = bare && ["and", "but"].contains(&self.at(part.from));
            let from = part.from + usize::from(joins || (why || bare) && self.at(part.from) == "so");
            why = false;
            kept.extend_from_slice(&self.tokens[from..part.to]);
            kept.extend(mark.cloned());
            asks = part.to < from + 4 && !self.names_a_thing(*part) && !self.is_order(from);
            bare = false;
        }
        if kept.last().is_some_and(|last| last.text == ",") {
            kept.pop();
        }
        (kept, remarks)
    }
}

/// Whether something is said to go or to be somewhere.
fn is_placed(word: &str) -> bool {
    is_going(word) || preposition(&[word]).is_some()
}
