//! What opens a clause: joins, politeness, order words, negation, who is spoken to.

use super::super::inflect::VerbForm;
use super::super::lexicon::Act;
use super::super::syntax::{Link, Relation, preposition};
use super::Parser;

/// What opens a clause.
pub(super) struct Opening {
    pub(super) link: Link,
    pub(super) negated: bool,
    pub(super) condition: bool,
    pub(super) robots: Vec<String>,
    /// A new sentence.
    pub(super) sentence: bool,
    /// `before you …, …`: this clause comes after the next.
    pub(super) after_next: bool,
    /// `… after you …`: this clause comes before the one said before it.
    pub(super) before_previous: bool,
}

impl Parser<'_> {
    /// Passes over joins and politeness, and notes the order they state.
    pub(super) fn opening(&mut self, first: bool) -> Opening {
        let mut opening = Opening {
            link: Link::And,
            negated: false,
            condition: false,
            robots: Vec::new(),
            sentence: self.position.checked_sub(1).is_some_and(|at| self.words[at] == "."),
            after_next: false,
            before_previous: false,
        };
        while let Some(word) = self.peek() {
            if let Some((link, length)) = self.done_or_under_way() {
                opening.link = link;
                self.position += length;
                continue;
            }
            let rest = self.rest();
            if let Some(length) = self.lexicon.longest_small("sequence", &rest)
                && !(length == 1 && self.longest_noun().is_some())
                && !(word == "next" && preposition(&rest).is_some())
            {
                opening.link = Link::Then;
                self.position += length;
                continue;
            }
            let polite = self.lexicon.longest_small("polite", &rest);
            if let Some(length) = polite.filter(|&length| length > 1) {
                self.position += length;
                continue;
            }
            if let Some(length) = self.lexicon.longest_small("parallel", &rest) {
                if word != "as" {
                    opening.link = Link::While;
                }
                self.position += length;
                continue;
            }
            if let Some(robot) = self.robot() {
                opening.robots.push(robot);
                continue;
            }
            if let Some(length) = self.somebody() {
                self.position += length;
                continue;
            }
            if self.reason() {
                continue;
            }
            opening.sentence |= word == ".";
            match word {
                "let" if self.ahead(1).verbs_here().is_some() => {}
                "have" | "has" | "had" if self.perfect_follows() => {}
                "go" | "come" if self.another_verb_follows() => {}
                "should" | "shall" | "must" | "can" | "has" | "will" if !opening.robots.is_empty() => {}
                "have" | "let" if self.ahead(1).robot().is_some() => {}
                "that" if self.word_at(1).is_some_and(super::super::syntax::is_determiner) => {}
                "that" if matches!(self.word_at(1), Some("it" | "they")) => {}
                "if" => {
                    opening.condition = true;
                    opening.before_previous = !first && !self.is_fronted();
                }
                "to" if self.word_at(1) == Some("be") && self.word_at(2).is_some() => self.position += 1,
                "," | "." | "and" | "so" | "but" | "plus" | "first" | "firstly" | "to" | "you" | "i"
                | "we" => {}
                "with" if self.state_follows() => {}
                "before" => {
                    if first {
                        opening.after_next = true;
                    } else {
                        opening.link = Link::Then;
                    }
                }
                "after" | "once" | "when" => {
                    if first || self.is_fronted() {
                        // The next clause follows by its position.
                    } else {
                        opening.before_previous = true;
                    }
                }
                "do" | "does" if matches!(self.word_at(1), Some("not")) => {
                    opening.negated = true;
                    self.position += 1;
                }
                "dont" | "never" | "without" | "not" | "avoid" => opening.negated = true,
                _ => match polite {
                    // "next to the plate lay the fork"
                    Some(length) if word != "next" || preposition(&rest).is_none() => {
                        self.position += length;
                        continue;
                    }
                    _ => break,
                },
            }
            self.position += 1;
        }
        opening
    }

    /// "with the lights off": a state that is to hold.
    pub(in crate::offline) fn state_follows(&self) -> bool {
        let mut ahead = self.ahead(1);
        let things = if self.peek() == Some("with") { ahead.phrases(0) } else { Vec::new() };
        if things.is_empty() {
            return false;
        }
        // "with water in the cup": to be so.
        let beside = preposition(&ahead.rest()).is_some_and(|(relation, length)| {
            relation == Relation::Near && matches!(ahead.word_at(length), Some("it" | "them" | "that"))
        });
        if beside {
            return true;
        }
        let poured = things.iter().all(|phrase| phrase.liquid().is_some())
            && preposition(&ahead.rest()).is_some_and(|(relation, _)| relation == Relation::In)
            && ahead.word_at(1) != Some("it")
            && self.goes_into_a_vessel(&ahead);
        let sliced = things.iter().all(|phrase| phrase.head == super::super::syntax::Head::Slices)
            && preposition(&ahead.rest()).is_some_and(|(relation, _)| relation == Relation::In);
        if poured || sliced {
            return true;
        }
        // "with the stove left cold"
        ahead.position += usize::from(matches!(ahead.peek(), Some("left" | "kept" | "still")));
        let rest = ahead.rest();
        let told = (1..=3.min(rest.len())).rev().find_map(|n| Some((self.lexicon.adjective(&rest[..n])?, n)));
        let (state, length) = told.map_or((None, 1), |(state, length)| (Some(state), length));
        let ends =
            ahead.word_at(length).is_none_or(|word| [",", ".", "and", "at", "afterwards"].contains(&word));
        let told = ["isOpen", "isToggled", "isFilledWithLiquid"];
        let definite = things.iter().all(|phrase| phrase.definite);
        (ends || ahead.peek() == Some("full"))
            && state.is_some_and(|state| definite || state.set.keys().any(|p| told.contains(&p.as_str())))
    }

    /// "(with water) in the cup", but not "(the kettle with water) on the counter".
    fn goes_into_a_vessel(&self, ahead: &Self) -> bool {
        let mut place = ahead.ahead(preposition(&ahead.rest()).map_or(0, |(_, length)| length));
        let phrase = place.phrase(0);
        phrase.is_some_and(|phrase| match &phrase.head {
            super::super::syntax::Head::Noun(noun) => self.has_affordance(noun, "canFillWithLiquid"),
            _ => true,
        })
    }

    /// "… so (that) you can put it on the table": an order after all; how many words stand before its verb.
    fn so_you_can_put(&self) -> Option<usize> {
        let person = if self.word_at(1) == Some("that") { 2 } else { 1 };
        let can = matches!(self.word_at(person), Some("you" | "i" | "we"))
            && matches!(self.word_at(person + 1), Some("can" | "could" | "may"));
        let placing =
            |verbs: &[&super::super::lexicon::Verb]| verbs.iter().any(|verb| verb.act == Act::Place);
        let puts = self.ahead(person + 2).verbs_here().is_some_and(|(_, verbs, _)| placing(&verbs));
        (can && puts).then_some(person + 2)
    }

    /// "once you have washed the fork": what is done, not a wish.
    fn perfect_follows(&self) -> bool {
        let person = self.position.checked_sub(1).and_then(|at| self.words.get(at));
        person.is_some_and(|word| {
            ["you", "we", "i", "they", "robot", "somebody", "one"].contains(&word.as_str())
        }) && self.ahead(1).verbs_here().is_some_and(|(form, _, _)| form == VerbForm::Past)
            && self.word_at(2).is_some()
    }

    /// "when all of that is done", "while this is going on": only the order, whatever the words.
    fn done_or_under_way(&self) -> Option<(Link, usize)> {
        const JOINS: [&str; 8] = ["when", "once", "after", "while", "whilst", "as", "until", "soon"];
        const WHAT: [&str; 17] = [
            "you",
            "we",
            "youre",
            "im",
            "that",
            "this",
            "it",
            "everything",
            "all",
            "of",
            "they",
            "these",
            "those",
            "things",
            "thats",
            "its",
            "else",
        ];
        const AUXILIARIES: [&str; 11] =
            ["is", "are", "has", "have", "been", "gets", "being", "s", "will", "be", "finally"];
        const DONE: [&str; 8] =
            ["done", "finished", "complete", "completed", "over", "ready", "settled", "through"];
        const UNDER_WAY: [&str; 7] =
            ["going", "happening", "running", "underway", "progress", "cooking", "heating"];
        let run = |from: usize, words: &[&str]| {
            (from..).take_while(|&at| self.word_at(at).is_some_and(|word| words.contains(&word))).count()
        };
        let joins = run(0, &JOINS);
        let what = run(joins, &WHAT);
        let auxiliaries = run(joins + what, &AUXILIARIES);
        let contracted = matches!(self.word_at(joins), Some("thats" | "its" | "youre" | "im"));
        if joins == 0 || what == 0 || auxiliaries == 0 && !contracted {
            return None;
        }
        let at = joins + what + auxiliaries;
        let word = self.word_at(at)?;
        let length = at + 1;
        if DONE.contains(&word) {
            return Some((Link::Then, length));
        }
        let particle = matches!(self.word_at(length), Some("on"));
        let under_way = word == "under" && self.word_at(length) == Some("way")
            || word == "in" && self.word_at(length) == Some("progress");
        // "while you are heating the bread" is a clause.
        let person =
            (joins..joins + what).any(|at| matches!(self.word_at(at), Some("you" | "we" | "youre" | "im")));
        (!person && (UNDER_WAY.contains(&word) || under_way))
            .then_some((Link::While, length + usize::from(particle || under_way)))
    }

    /// "(while) another slices the bread", "the other one washes …": somebody does it, and no matter who.
    fn somebody(&self) -> Option<usize> {
        const WHO: [&[&str]; 12] = [
            &["the", "first"],
            &["the", "second"],
            &["the", "third"],
            &["the", "rest"],
            &["somebody"],
            &["the", "other", "one"],
            &["the", "other"],
            &["the", "others"],
            &["another", "one"],
            &["another"],
            &["others"],
            &["one"],
        ];
        let rest = self.rest();
        WHO.iter().find(|who| rest.starts_with(who)).map(|who| who.len()).filter(|&length| {
            let behind = self.ahead(length);
            let word = behind.peek().unwrap_or_default();
            let does = word.ends_with('s') || ["should", "can", "will", "must"].contains(&word);
            does && behind.verbs_here().is_some()
                && !["goes", "belongs", "is"].contains(&word)
                && behind.word_at(1).is_some_and(|next| {
                    super::super::syntax::is_determiner(next)
                        || ["it", "them", "on", "off"].contains(&next)
                        || behind.ahead(1).verbs_here().is_some()
                })
        })
    }

    /// "so that it gets cold": a state that is wished for.
    fn so_that_it_is(&self) -> bool {
        let at = 1 + usize::from(self.word_at(1) == Some("that"));
        let it = matches!(self.word_at(at), Some("it" | "they"));
        let gets = matches!(
            self.word_at(at + 1),
            Some("is" | "are" | "gets" | "get" | "stays" | "stay" | "becomes" | "become")
        );
        let state = self.word_at(at + 2).and_then(|word| self.lexicon.adjective(&[word]));
        it && gets && state.is_some()
    }

    /// "go turn on the lamp": the going says nothing.
    fn another_verb_follows(&self) -> bool {
        let ahead = self.ahead(1);
        ahead.longest_noun().is_none()
            && ahead.peek().is_some_and(|word| preposition(&[word]).is_none())
            && ahead.verbs_here().is_some_and(|(form, verbs, _)| {
                form == VerbForm::Base && verbs.iter().any(|verb| verb.act != Act::Go)
            })
    }

    /// "… . Once it is clean, put it away": what is said first is done first.
    fn is_fronted(&self) -> bool {
        // "Also, after you wash the cup, it goes in the sink."
        const ADVERBS: [&str; 9] =
            [",", "also", "finally", "next", "meanwhile", "first", "okay", "hey", "please"];
        let said = &self.words[..self.position];
        let comma = said.len() - said.iter().rev().take_while(|word| *word == ",").count();
        let said = said[..comma].strip_suffix(&["after".to_owned(), "that".to_owned()]).unwrap_or(said);
        let before = said.iter().rev().find(|word| !ADVERBS.contains(&word.as_str()));
        before.is_some_and(|word| [".", "and", "then", "but"].contains(&word.as_str()))
    }

    /// "so I can see", "because it is late": passes over why.
    fn reason(&mut self) -> bool {
        const PERSONS: [&str; 10] =
            ["i", "we", "you", "he", "she", "they", "it", "that", "nobody", "everyone"];
        let why = match self.peek() {
            Some("because" | "until") => true,
            Some("so") if self.so_you_can_put().is_some() => {
                self.position += self.so_you_can_put().unwrap_or(0);
                return true;
            }
            Some("so") if self.so_that_it_is() => return false,
            Some("so" | "since") => self.word_at(1).is_some_and(|word| PERSONS.contains(&word)),
            _ => false,
        };
        while why && self.peek().is_some_and(|word| word != "." && word != ",") {
            // "so it heats up and turn off the light": an order again.
            if self.peek() == Some("and") && self.another_verb_follows() {
                break;
            }
            self.position += 1;
        }
        why
    }
}
