//! Noun phrases: determiners, quantities, adjectives, heads, and what follows a head.

use std::borrow::Cow;
use std::rc::Rc;

use super::clause::Parser;
use super::inflect;
use super::lexicon::{LONGEST, Lexicon, Noun};
use super::syntax::{Head, Phrase, Quantity, is_determiner, is_function_word, preposition};

/// Noun phrases within noun phrases go no deeper than this.
pub(super) const DEEPEST: usize = 4;

/// What has been read before the head.
struct Front {
    phrase: Phrase,
    quantity: Option<Quantity>,
    sliced: bool,
    plural: bool,
    /// How many heads were read before this one ("the table's drawer's …").
    chained: usize,
}

impl Front {
    fn new() -> Self {
        Self {
            phrase: Phrase::bare(Head::Room, ""),
            quantity: None,
            sliced: false,
            plural: false,
            chained: 0,
        }
    }
}

impl Parser<'_> {
    /// One noun phrase at the position, or nothing with the position unchanged.
    pub(super) fn phrase(&mut self, depth: usize) -> Option<Phrase> {
        let start = self.position;
        let mut front = Front::new();
        let head = if depth > DEEPEST { None } else { self.head(&mut front) };
        let Some(head) = head else {
            self.position = start;
            return None;
        };
        // "the food items"
        if matches!(head, Head::Noun(_))
            && matches!(self.peek(), Some("items" | "stuff" | "things" | "objects" | "goods"))
        {
            self.position += 1;
            front.plural = true;
        }
        let Front { mut phrase, quantity, sliced, plural, .. } = front;
        phrase.head = head;
        let any = plural && quantity == Some(Quantity::One) && self.words[start] == "any";
        phrase.quantity = match (quantity, &phrase.head) {
            (Some(Quantity::One), Head::Noun(_)) if any => Quantity::All,
            (Some(Quantity::Plural), _) | (None, _) if plural => Quantity::Plural,
            // "some bread" is not several.
            (Some(Quantity::Plural), Head::Noun(noun)) if !noun.class => Quantity::One,
            (Some(quantity), _) => quantity,
            (None, Head::Everything) => Quantity::All,
            (None, _) => Quantity::One,
        };
        if phrase.quantity == Quantity::Plural && phrase.definite {
            phrase.quantity = Quantity::All;
        }
        if sliced {
            phrase.states.insert("isSliced".to_owned(), super::yes());
            if phrase.quantity == Quantity::All && quantity.is_none() && phrase.head != Head::Slices {
                phrase.quantity = Quantity::One;
            }
        }
        self.after_head(&mut phrase, depth);
        if let (Head::Noun(noun), Quantity::Count(_) | Quantity::Plural | Quantity::All) =
            (&phrase.head, phrase.quantity)
        {
            self.counted = Some(Rc::new(noun.clone()));
        } else if let (Head::Noun(noun), Some("one")) =
            (&phrase.head, self.words.get(start).map(String::as_str))
        {
            self.counted = Some(Rc::new(noun.clone()));
        }
        phrase.text = self.text_between(start, self.position);
        Some(phrase)
    }

    /// Reads up to and with the head.
    fn head(&mut self, front: &mut Front) -> Option<Head> {
        let start = self.position;
        while let Some(word) = self.peek() {
            if word == "," && self.position > start && self.list_of_modifiers() {
                self.position += 1;
                continue;
            }
            if let Some(head) = self.by_use(front) {
                return Some(head);
            }
            if let Some(head) = self.one_of_the_counted(word, front) {
                return Some(head);
            }
            if let Some(head) = self.pronoun(word, front) {
                return Some(head);
            }
            if self.determiner(word, front) {
                continue;
            }
            if let Some(object) = self.scene.named(word) {
                self.position += 1;
                return Some(Head::Named(object.name.clone()));
            }
            if let Some(number) = inflect::number(word) {
                self.position += 1;
                if front.quantity == Some(Quantity::All) && self.peek() == Some("of") {
                    front.quantity = None;
                    self.position += 1;
                    continue;
                }
                front.quantity = Some(if number == 1 { Quantity::One } else { Quantity::Count(number) });
                continue;
            }
            if self.measure(front) {
                continue;
            }
            // "a light brown cabinet" is no light.
            let shade = self.lexicon.longest_small("modifiers", &self.rest()).filter(|&length| length > 1);
            if let Some(length) = shade.filter(|&length| self.noun_follows(length)) {
                self.position += length;
                continue;
            }
            if let Some((noun, plural, length)) = self.longest_noun()
                && (length > 1 || !self.is_adjective_before_noun())
            {
                return Some(self.noun_head(noun, plural, length, front));
            }
            if self.two_kinds(front) || self.adjective(&mut front.phrase) {
                continue;
            }
            if self.lexicon.longest_small("slices", &self.rest()).is_some() || self.is_slices(word) {
                self.position += 1;
                front.plural |= word.ends_with('s');
                front.sliced = true;
                if self.longest_noun().is_some_and(|(noun, _, _)| self.has_affordance(&noun, "sliceable")) {
                    continue;
                }
                return Some(Head::Slices);
            }
            if let Some(length) = self.lexicon.longest_small("modifiers", &self.rest())
                && (self.noun_follows(length) || self.adjective_follows(length))
            {
                self.position += length;
                continue;
            }
            if let Some(length) = self.lexicon.longest_small("rooms", &self.rest()) {
                self.position += length;
                return Some(Head::Room);
            }
            return self.unknown_head(word, start, front);
        }
        None
    }

    /// A word nobody knows: a modifier when a noun follows at once, else the head.
    fn unknown_head(&mut self, word: &str, start: usize, front: &mut Front) -> Option<Head> {
        let liquid = ["coffee", "water", "wine"].contains(&word);
        if liquid {
            self.position += 1;
            return Some(Head::Liquid(word.to_owned()));
        }
        if is_function_word(word) || ",.".contains(word) || self.lexicon.is_small("polite", &[word]) {
            return None;
        }
        let going = super::clause::is_going(word);
        if (going || !self.lexicon.verbs(word).is_empty()) && self.position == start {
            return None;
        }
        let known_modifier = self.lexicon.is_small("modifiers", &[word]);
        if !known_modifier
            && !self.lexicon.verbs(word).is_empty()
            && self.longest_noun_at(self.position + 1).is_none()
            && let Some(meant) = self.miswritten_noun(word)
        {
            self.position += 1;
            self.choices.push(format!("read \"{word}\" as \"{}\"", meant.word));
            return Some(Head::Noun(meant));
        }
        self.position += 1;
        if known_modifier
            && let Some(next) = self.peek()
            && !is_function_word(next)
            && !",.".contains(next)
            && self.longest_noun().is_none()
            && !self.is_slices(next)
        {
            self.position += 1;
            return Some(Head::Unknown(next.to_owned()));
        }
        if front.chained < LONGEST
            && (self.longest_noun().is_some() || self.modifiers_and_noun_follow())
            && (known_modifier || self.position > start)
        {
            if !known_modifier {
                self.passed_over.push(word.to_owned());
            }
            front.chained += 1;
            return self.head(front);
        }
        Some(Head::Unknown(word.to_owned()))
    }

    fn pronoun(&mut self, word: &str, front: &mut Front) -> Option<Head> {
        let next = self.word_at(1);
        let alone = next.is_none_or(|next| {
            (is_function_word(next) && !is_determiner(next) && next != "of")
                || super::clause::is_going(next)
                || ["need", "needs"].contains(&next)
                || ",.".contains(next)
                || word == "both"
                    && self.lexicon.adjective(&[next]).is_some()
                    && self.longest_noun_at(self.position + 2).is_none()
        });
        let head = match word {
            "it" if self.is_miswritten_its(word) => return None,
            "it" | "this" | "that" if self.all_of_it_follows() => {
                self.position += 1;
                Head::Pronoun { plural: true }
            }
            "it" | "him" => Head::Pronoun { plural: false },
            "former" | "latter" if front.phrase.definite => {
                let number = next.and_then(inflect::number).filter(|&number| number > 1);
                if let Some(number) = number {
                    front.quantity = Some(Quantity::Count(number));
                    self.position += 1;
                }
                Head::Pronoun { plural: number.is_some() }
            }
            "them" | "they" => Head::Pronoun { plural: true },
            "this" | "that" | "one" if alone && self.can_be_pronoun() => Head::Pronoun { plural: false },
            "these" | "those" | "both" | "ones" | "all" | "each" if alone => Head::Pronoun { plural: true },
            "everything" | "anything" | "stuff" => Head::Everything,
            "things" | "items" | "objects"
                if front.phrase.definite || front.quantity == Some(Quantity::All) =>
            {
                front.plural = true;
                Head::Everything
            }
            "others" | "rest" if next != Some("of") => {
                front.phrase.other = true;
                Head::Everything
            }
            _ => return None,
        };
        self.position += 1;
        Some(head)
    }

    /// `one` stands for a noun only when something was mentioned.
    fn can_be_pronoun(&self) -> bool {
        self.position > 0
    }

    fn determiner(&mut self, word: &str, front: &mut Front) -> bool {
        match word {
            "it" if self.is_miswritten_its(word) => front.phrase.definite = true,
            "a" | "an" => {
                front.phrase.indefinite = true;
                front.quantity.get_or_insert(Quantity::One);
                if let (Some("couple" | "pair"), Some("of")) = (self.word_at(1), self.word_at(2))
                    && self.longest_noun_at(self.position + 1).is_none()
                {
                    front.quantity = Some(Quantity::Count(2));
                    self.position += 2;
                } else if self.word_at(1) == Some("few") {
                    front.quantity = Some(Quantity::Plural);
                    self.position += 1;
                }
            }
            "the" | "this" | "that" | "these" | "those" | "my" | "your" | "our" | "his" | "her" | "their"
            | "its" => {
                front.phrase.definite = true;
            }
            "all" | "every" | "each" | "whole" => front.quantity = Some(Quantity::All),
            "both" => front.quantity = Some(Quantity::Count(2)),
            // "some of the candles": not all of them.
            "some" | "several" if self.word_at(1) == Some("of") => front.quantity = Some(Quantity::Count(2)),
            "some" | "several" | "few" => front.quantity = Some(Quantity::Plural),
            "any" | "either" => front.quantity = Some(Quantity::One),
            "another" | "other" | "remaining" => front.phrase.other = true,
            "rest" if self.word_at(1) == Some("of") => {
                front.phrase.other = true;
                front.quantity = Some(Quantity::All);
            }
            "of" if self.position > 0 => {}
            _ => return false,
        }
        self.position += 1;
        true
    }

    /// `a slice of`, `the top of`, `a head of`: passes over the measure and its "of".
    fn measure(&mut self, front: &mut Front) -> bool {
        let rest = self.rest();
        // A longer noun wins: "box of tissues", "bar of soap".
        if self.longest_noun().is_some_and(|(_, _, length)| length > 2) {
            return false;
        }
        for length in [3, 2, 1] {
            if rest.get(length) != Some(&"of") {
                continue;
            }
            let words = &rest[..length];
            if self.is_shelf_of_furniture(words) {
                continue;
            }
            // "a box of keys" is a box.
            if words == ["box"] && self.scene.has("Box") {
                continue;
            }
            let singular: Vec<String> = inflect::singulars(words[length - 1]);
            let is_in = |list: &str| {
                self.lexicon.is_small(list, words)
                    || singular.iter().any(|s| length == 1 && self.lexicon.is_small(list, &[s.as_str()]))
            };
            let (slices, other) = (is_in("slices"), is_in("measures") || is_in("parts"));
            if !(slices || other)
                || (slices && self.lexicon.is_small("parts", words) && !self.food_follows(length + 1))
            {
                if !other {
                    continue;
                }
            } else if slices {
                front.sliced |= self.food_follows(length + 1);
            }
            let plural =
                self.lexicon.noun(words).is_none() && words[length - 1].ends_with('s') && words[0] != "glass";
            if plural && !self.lexicon.is_small("parts", words) && front.quantity.is_none() {
                front.quantity = Some(Quantity::Plural);
                front.plural = true;
            }
            if words == ["couple"] || words == ["pair"] {
                front.quantity = Some(Quantity::Count(2));
            }
            self.position += length + 1;
            return true;
        }
        false
    }

    /// Whether one of the next few words from an offset is something that can be sliced.
    fn food_follows(&self, offset: usize) -> bool {
        (offset..offset + 4).any(|at| {
            self.longest_noun_at(self.position + at)
                .is_some_and(|(noun, _, _)| !noun.class && self.has_affordance(&noun, "sliceable"))
        })
    }

    pub(super) fn has_affordance(&self, noun: &Noun, affordance: &str) -> bool {
        noun.kinds.iter().any(|kind| self.scene.affords(kind, affordance))
    }

    pub(super) fn is_absent(&self, noun: &Noun) -> bool {
        !self.scene.kinds().any(|kind| noun.kinds.iter().any(|k| k == kind))
    }

    pub(super) fn is_slices(&self, word: &str) -> bool {
        inflect::singulars(word).iter().any(|s| self.lexicon.is_small("slices", &[s.as_str()]))
            || self.lexicon.is_small("slices", &[word])
    }

    /// Whether the next word is rather the verb of a new clause ("... the cup toast the bread").
    fn verb_reads_better(&self, length: usize) -> bool {
        let Some(word) = self.peek() else { return false };
        length == 1
            && !self.lexicon.verbs(word).is_empty()
            && self.word_at(1).is_some_and(|next| is_determiner(next) || next == "it")
    }

    /// An adjective that is also a noun or verb counts as an adjective when a noun follows.
    fn is_adjective_before_noun(&self) -> bool {
        let rest = self.rest();
        let state = (1..=3.min(rest.len())).rev().find(|&n| self.lexicon.adjective(&rest[..n]).is_some());
        state.is_some_and(|n| self.longest_noun_at(self.position + n).is_some())
    }

    fn adjective(&mut self, phrase: &mut Phrase) -> bool {
        let rest = self.rest();
        for length in (1..=3.min(rest.len())).rev() {
            let Some(adjective) = self.lexicon.adjective(&rest[..length]) else { continue };
            // "on" and "out" are adjectives only behind "is".
            if preposition(&rest[..length]).is_some() || rest[0] == "out" {
                continue;
            }
            // "put a burning candle on the counter": one that is to burn.
            let before = self.position.checked_sub(2).map_or("", |at| self.words[at].as_str());
            let lit = (self.wants_place || !self.acts)
                && phrase.indefinite
                && preposition(&[before]).is_none()
                && (adjective.set.contains_key("isToggled")
                    || adjective.set.get("isOpen") == Some(&super::yes()));
            let target = if adjective.selects && !lit { &mut phrase.selects } else { &mut phrase.states };
            target.extend(adjective.set.clone());
            self.position += length;
            if self.peek() == Some("and")
                && self.rest().get(1).is_some_and(|w| self.lexicon.adjective(&[w]).is_some())
            {
                self.position += 1;
            }
            return true;
        }
        false
    }

    /// Whether a noun, or adjectives and a noun, follow behind `offset` words.
    pub(super) fn noun_follows(&self, offset: usize) -> bool {
        (offset..offset + 5)
            .take_while(|&at| {
                // "the front edge of the bed": behind "of" a determiner may stand.
                let of = at > 0 && self.word_at(at - 1) == Some("of");
                self.word_at(at).is_some_and(|word| {
                    preposition(&[word]).is_none()
                        && (of || !is_determiner(word))
                        && !["and", ",", "."].contains(&word)
                })
            })
            .any(|at| {
                self.longest_noun_at(self.position + at).is_some()
                    || self.word_at(at).is_some_and(|word| self.is_slices(word))
            })
    }

    pub(super) fn longest_noun(&self) -> Option<(Noun, bool, usize)> {
        self.longest_noun_at(self.position)
    }

    /// The longest noun at a position.
    pub(super) fn longest_noun_at(&self, position: usize) -> Option<(Noun, bool, usize)> {
        let (noun, plural, length) = self.nouns.get(position)?.as_ref()?;
        Some((noun.clone().into_owned(), *plural, *length))
    }
}

/// The longest noun at a position, whether it is a plural, and its length in words.
pub(super) type NounAt<'a> = Option<(Cow<'a, Noun>, bool, usize)>;

/// The longest noun at each position.
pub(super) fn nouns<'a>(words: &'a [String], lexicon: &'a Lexicon) -> Vec<NounAt<'a>> {
    let at = |position: usize| {
        let rest: Vec<&str> = words[position..].iter().take(LONGEST).map(String::as_str).collect();
        let usable = rest.iter().position(|w| [",", ".", "and"].contains(w)).unwrap_or(rest.len());
        (1..=usable).rev().find_map(|length| {
            lexicon.noun(&rest[..length]).map(|(noun, plural)| (Cow::Borrowed(noun), plural, length))
        })
    };
    (0..words.len()).map(at).collect()
}

mod compound;
mod list;
mod mend;
mod tail;
mod usage;

pub(super) use list::is_one_of;
