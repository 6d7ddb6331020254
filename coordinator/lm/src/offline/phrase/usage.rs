//! Things told by what they are for or what they are like: "something to cut with", "the thing that tells the
//! time", "anything sharp", "somewhere cold".

use super::super::clause::Parser;
use super::super::lexicon::Noun;
use super::super::syntax::{Head, Phrase, Quantity, is_determiner, preposition};
use super::Front;

/// What a thing is for is said in no more words than this.
const LONGEST_USE: usize = 9;

/// A word that says of a thing only that it is one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Generic {
    One,
    All,
    Place,
}

impl Parser<'_> {
    /// A thing told by its use, at the position; nothing with the position unchanged.
    pub(super) fn by_use(&mut self, front: &mut Front) -> Option<Head> {
        if self.longest_noun().is_some_and(|(_, _, length)| length > 1) {
            return None;
        }
        let start = self.position;
        let (generic, kinds, length) = match self.generic_at(0) {
            Some((generic, length)) => {
                let (kinds, used) = self.use_behind(generic, length)?;
                (generic, kinds, length + used)
            }
            // "sharp things", "a cold place"
            None => {
                let (generic, length) = self.generic_at(1)?;
                let like = [self.peek()?.to_owned()];
                (generic, self.best_use(generic == Generic::Place, &like)?.0, 1 + length)
            }
        };
        self.position += length;
        if generic != Generic::Place {
            self.pass_over_object();
        }
        let word = self.text_between(start, self.position);
        match generic {
            Generic::All => front.quantity = front.quantity.or(Some(Quantity::All)),
            Generic::One if front.quantity.is_none() && !front.phrase.definite => {
                front.phrase.indefinite = true;
            }
            _ => {}
        }
        Some(Head::Noun(Noun { word, kinds, class: generic != Generic::Place }))
    }

    /// "somewhere safe", "where nobody gets hurt": a place with no preposition.
    pub(in crate::offline) fn somewhere(&mut self) -> Option<Phrase> {
        let (Generic::Place, _) = self.generic_at(0)? else { return None };
        let start = self.position;
        let mut front = Front::new();
        let head = self.by_use(&mut front)?;
        Some(Phrase::bare(head, &self.text_between(start, self.position)))
    }

    fn generic_at(&self, offset: usize) -> Option<(Generic, usize)> {
        let rest: Vec<&str> = self.rest().into_iter().skip(offset).collect();
        [("generic", Generic::One), ("generic_all", Generic::All), ("generic_place", Generic::Place)]
            .into_iter()
            .find_map(|(list, generic)| Some((generic, self.lexicon.longest_small(list, &rest)?)))
    }

    /// What is meant by the words behind a generic one, and how many words say it: those that explain most, in
    /// as few words as possible.
    fn use_behind(&self, generic: Generic, offset: usize) -> Option<(Vec<String>, usize)> {
        let behind: Vec<String> = self.words[self.position + offset..]
            .iter()
            .take(LONGEST_USE)
            .take_while(|word| ![".", ",", "and", "then", "but"].contains(&word.as_str()))
            .cloned()
            .collect();
        let free = ["whatever", "what", "where"].contains(&self.peek()?);
        let related = free || self.lexicon.longest_small("relative", &[behind.first()?.as_str()]).is_some();
        let mut best: Option<(Vec<String>, usize, usize)> = None;
        for length in 1..=behind.len() {
            let said = &behind[..length];
            let next = self.word_at(offset + length);
            if preposition(&[&said[length - 1]]).is_some()
                && next.is_some_and(|next| self.begins_a_thing(next))
            {
                continue;
            }
            let Some((kinds, explained)) = self.best_use(generic == Generic::Place, said) else { continue };
            let plain = said.iter().filter(|word| !["of", "the", "my"].contains(&word.as_str())).count();
            if (related || explained == plain) && best.as_ref().is_none_or(|(_, known, _)| explained > *known)
            {
                best = Some((kinds, explained, length));
            }
        }
        best.map(|(kinds, _, length)| (kinds, length))
    }

    fn best_use(&self, place: bool, said: &[String]) -> Option<(Vec<String>, usize)> {
        let mut best: Option<(&Vec<String>, usize)> = None;
        let said = self.lexicon.said(said);
        for usage in self.lexicon.uses().iter().filter(|usage| usage.place == place) {
            let explained = usage.triggers.iter().filter_map(|trigger| trigger.fits(&said)).max();
            if let Some(explained) = explained
                && best.is_none_or(|(_, known)| explained > known)
            {
                best = Some((&usage.kinds, explained));
            }
        }
        best.map(|(kinds, explained)| (kinds.clone(), explained))
    }

    fn begins_a_thing(&self, word: &str) -> bool {
        is_determiner(word) || self.lexicon.noun(&[word]).is_some()
    }

    /// "something to cut the bread with": what it is used on is no part of the goal.
    fn pass_over_object(&mut self) {
        let start = self.position;
        if self.peek().is_some_and(|word| self.begins_a_thing(word)) && self.phrase(super::DEEPEST).is_none()
        {
            self.position = start;
            return;
        }
        let stranded = self.peek().is_some_and(|word| ["with", "from", "on", "in"].contains(&word))
            && self.word_at(1).is_none_or(|next| {
                [".", ",", "and", "then"].contains(&next) || preposition(&[next]).is_some()
            });
        self.position += usize::from(stranded);
    }
}
