//! Words that choose: "not the fork", "the plate or the bowl", "robot2 should", "put it there".

use super::super::lexicon::Act;
use super::super::syntax::{Clause, Head, Phrase, Place, Relation, preposition};
use super::{Parser, is_going};

impl<'a> Parser<'a> {
    /// `robot2`, `robot 2`: who is spoken to.
    pub(super) fn robot(&mut self) -> Option<String> {
        let word = self.peek()?;
        let number = word.strip_prefix("robot")?.trim_start_matches('_');
        let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        if is_number(number) {
            self.position += 1;
            return Some(format!("robot{number}"));
        }
        let next = self.word_at(1).filter(|next| number.is_empty() && is_number(next))?;
        self.position += 2;
        Some(format!("robot{next}"))
    }

    /// Whether a robot is spoken to here.
    pub(super) fn robot_opens(&self) -> bool {
        self.ahead(0).robot().is_some()
            || self.word_at(1).is_some()
                && self.ahead(1).robot().is_some()
                && matches!(self.peek(), Some("have" | "let"))
    }

    /// ", not the fork", "instead of the plate", "but not in the sink": passes over what is not meant.
    pub(super) fn contrast(&mut self) -> bool {
        let start = self.position;
        while matches!(self.peek(), Some("," | "and" | "but")) {
            self.position += 1;
        }
        let length = match (self.peek(), self.word_at(1)) {
            (Some("not"), _) => 1,
            (Some("instead"), Some("of")) | (Some("rather"), Some("than")) => 2,
            _ => 0,
        };
        self.position += length;
        if length > 0 {
            self.position += preposition(&self.rest()).map_or(0, |(_, length)| length);
            let is_thing = |phrase: &Phrase| !matches!(phrase.head, Head::Unknown(_));
            if self.verbs_here().is_none() && self.phrase(0).as_ref().is_some_and(is_thing) {
                self.position += usize::from(
                    self.peek() == Some(",")
                        && self.words[start] == ","
                        && !self.ahead(1).clause_starts_here(false),
                );
                return true;
            }
        }
        self.position = start;
        false
    }

    /// "put neither A nor B in C" forbids both.
    pub(super) fn neither(&mut self, clause: &mut Clause<'a>) -> bool {
        match self.peek() {
            Some("neither") => {
                clause.negated = true;
                self.negated = true;
            }
            Some("nor") if clause.negated => {}
            _ => return false,
        }
        self.position += 1;
        true
    }

    /// "on the plate or in the bowl": one of the places.
    pub(super) fn choice(&mut self, clause: &mut Clause<'a>) -> bool {
        if self.peek() != Some("or") || clause.places.is_empty() || self.negated {
            return false;
        }
        let start = self.position;
        self.position += 1;
        self.position += preposition(&self.rest()).map_or(0, |(_, length)| length);
        let Some(other) = self.phrase(0) else {
            self.position = start;
            return false;
        };
        if let Some(place) = clause.places.last_mut() {
            let first = place.phrase.clone();
            place.phrase = self.chosen(first, other);
        }
        true
    }

    /// Of two phrases joined by "or", the first that the scene has.
    pub(in crate::offline) fn chosen(&mut self, first: Phrase, other: Phrase) -> Phrase {
        let is_here = |phrase: &Phrase| match &phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(|kind| self.scene.has(kind)),
            Head::Unknown(_) => false,
            _ => true,
        };
        let (taken, left) = if is_here(&first) || !is_here(&other) { (first, other) } else { (other, first) };
        self.choices.push(format!("of \"{}\" or \"{}\", the former is taken", taken.text, left.text));
        taken
    }

    /// "put the tomato there", "in there": the receptacle spoken of last.
    pub(super) fn there(&mut self, clause: &mut Clause<'a>) -> bool {
        // "that there is water in the pot"
        let that = usize::from(self.peek() == Some("that"));
        let is = |word: &str| ["is", "are", "be", "should", "must", "has", "have", "to"].contains(&word);
        if self.word_at(that) == Some("there") && self.word_at(that + 1).is_some_and(is) {
            self.position += that + 1;
            while self.peek().is_some_and(is) {
                self.position += 1;
            }
            return true;
        }
        let shall = self.position > 1
            && ["be", "go"].contains(&self.words[self.position - 1].as_str())
            && ["should", "must", "shall"].contains(&self.words[self.position - 2].as_str());
        let places = clause.verbs.iter().any(|verb| verb.act == Act::Place)
            || clause.verbs.is_empty() && shall
            || clause.verbs.is_empty() && clause.unknown.iter().any(|word| is_going(word));
        let length = preposition(&self.rest())
            .filter(|(relation, _)| matches!(relation, Relation::In | Relation::To))
            .map_or(0, |(_, length)| length);
        if !places || !clause.places.is_empty() || self.word_at(length) != Some("there") {
            return false;
        }
        self.position += length + 1;
        // "in there" is in what was spoken of, "there" where it went.
        let text = if length > 0 { "in there" } else { "there" };
        let it = Phrase::bare(Head::Pronoun { plural: false }, text);
        clause.places.push(Place::new(Relation::In, "in", it));
        true
    }
}
