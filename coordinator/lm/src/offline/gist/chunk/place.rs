//! Where something is or goes.

use lamma_domains::goal::PropertyValue;

use super::doing::BEHIND_A_STATE;
use super::{Again, Chunk, Chunker, Where};
use crate::offline::inflect::VerbForm;
use crate::offline::lexicon::Settings;
use crate::offline::syntax::{Relation, is_determiner, preposition};

impl Chunker<'_> {
    /// "fridge for that", "the bed will do for them", "box them": it goes there.
    pub(super) fn place_of_it(&self, at: usize, opens: bool) -> Option<(Chunk, usize)> {
        let (mut thing, length) = self.thing(at).filter(|_| opens)?;
        if !thing.kinds.iter().any(|kind| self.scene.affords(kind, "receptacle")) {
            return None;
        }
        let next = at + length;
        let fine = self
            .one_of(next, &[&["will", "do"], &["is", "the", "place"], &["is", "fine"], &["is", "best"]])
            .unwrap_or(0);
        let pronoun = |at: usize| ["it", "them", "that", "those", "these", "both"].contains(&self.at(at));
        let taken = if self.at(next + fine) == "for" && pronoun(next + fine + 1) {
            length + fine + 2
        } else if length == 1 && ["it", "them"].contains(&self.at(next)) && !self.is_order(at) {
            length + 1
        } else {
            return None;
        };
        if !is_determiner(&thing.words[0]) {
            thing.words.insert(0, "the".to_owned());
        }
        Some((Chunk::Place(Relation::In, vec!["in".to_owned()], Where::At(thing)), taken))
    }

    pub(super) fn is_order(&self, at: usize) -> bool {
        self.lexicon.verbs(self.at(at)).iter().any(|(form, _, _)| *form == VerbForm::Base)
    }

    pub(super) fn place(&self, at: usize, before: Option<&Chunk>) -> Option<(Chunk, usize)> {
        let at_word = self.at(at);
        if at_word == "there" && !["should", "is", "are", "must"].contains(&self.at(at + 1)) {
            return Some((Chunk::Place(Relation::In, vec!["in".to_owned()], Where::There), 1));
        }
        let (relation, mut length) = preposition(&self.rest(at))?;
        if relation == Relation::With {
            return Some((Chunk::With(length > 1), length));
        }
        let preposition = self.words[at..at + length].to_vec();
        if relation == Relation::For {
            let bin = matches!(before, Some(Chunk::Wish));
            if (bin || matches!(before, Some(Chunk::Liquid(_) | Chunk::Act(_))))
                && self.thing(at + length).is_some()
            {
                let (thing, named) = self.thing(at + length)?;
                return Some(match before {
                    Some(Chunk::Liquid(_) | Chunk::Wish) => {
                        let into = vec!["in".to_owned()];
                        (Chunk::Place(Relation::In, into, Where::At(thing)), length + named)
                    }
                    _ => (Chunk::Other(at_word.to_owned()), length),
                });
            }
            let time = ["seconds", "minutes", "minute", "hour", "hours", "while"];
            if ((at + length)..(at + length) + 4).any(|at| time.contains(&self.at(at))) {
                return Some((Chunk::Hard, length));
            }
            let one = usize::from(self.at(at + length).ends_with("ing"))
                | usize::from(["one", "now", "me", "us", "it", "that"].contains(&self.at(at + length)));
            let skipped = self.thing(at + length).map_or(one, |(_, length)| length);
            return Some((Chunk::Other(at_word.to_owned()), length + skipped));
        }
        let target = at + length;
        let place = if self.at(target) == "there" {
            length += 1;
            Where::There
        } else if let Some((Chunk::Again(Again::First | Again::Last), pronoun)) = self.again(target) {
            return Some((Chunk::Hard, length + pronoun));
        } else if let Some((Chunk::Again(_), pronoun)) = self.again(target) {
            length += pronoun;
            Where::AtIt
        } else if let Some((thing, named)) = self.thing(target) {
            length += named;
            if thing.kinds.is_empty() {
                // "in pieces", "into slices"
                let set = Settings::from([("isSliced".to_owned(), PropertyValue::Flag(true))]);
                let inward = ["in", "into", "to"].contains(&at_word);
                return inward.then(|| (Chunk::State(vec!["sliced".to_owned()], set), length));
            }
            Where::At(thing)
        } else {
            // "on show", "out of earshot"; but "the lamp on, please"
            let switched = ["on", "off"].contains(&at_word)
                && matches!(before, Some(Chunk::Thing(thing))
                    if thing.kinds.iter().any(|kind| self.scene.affords(kind, "toggleable")));
            let state = length == 1 && (switched || BEHIND_A_STATE.contains(&self.at(target)));
            let purpose = at_word == "to";
            if state && at_word == "inside" {
                return Some((Chunk::Place(Relation::In, vec!["in".to_owned()], Where::AtIt), 1));
            }
            let words = || self.words[at..at + length].join(" ");
            return (!state && !purpose).then(|| (Chunk::Other(words()), length));
        };
        Some((Chunk::Place(relation, preposition, place), length))
    }
}
