//! What follows: looks ahead that tell whether a clause goes on.

use super::super::syntax::{Clause, Head, Phrase, Relation, preposition};
use super::Parser;

impl<'a> Parser<'a> {
    /// Whether a state is told here: "is clean", "sliced".
    pub(in crate::offline) fn state_told(&self) -> bool {
        self.peek().is_some_and(|word| {
            let rest = self.rest();
            ["is", "are", "stays", "stay", "gets", "get"].contains(&word)
                || preposition(&[word]).is_none()
                    && (self.lexicon.adjective(&[word]).is_some()
                        || rest.len() > 1 && self.lexicon.adjective(&rest[..2]).is_some())
        })
    }

    /// Whether it is said here where something goes.
    pub(super) fn goal_follows(&self) -> bool {
        preposition(&self.rest()).is_some_and(|(relation, _)| matches!(relation, Relation::In | Relation::To))
    }

    /// Whether a state is put in and a place follows: ", closed, on the table".
    pub(super) fn aside_state_follows(&self) -> bool {
        self.peek() == Some(",") && self.word_at(2) == Some(",") && {
            self.ahead(1).state_told() && self.ahead(3).goal_follows()
        }
    }

    /// Whether another thing is told here as it shall be, the verb understood: "the mug should be in the sink, the
    /// bread sliced, …".
    pub(super) fn another_wish_follows(&self, clause: &Clause<'a>, start: usize) -> bool {
        const SHALL: [&str; 5] = ["should", "must", "shall", "needs", "need"];
        let said = self.words.get(start..self.position).unwrap_or_default();
        let wished = said.iter().any(|word| SHALL.contains(&word.as_str()));
        let placed =
            clause.unknown.is_empty() && clause.places.iter().any(|place| place.relation == Relation::In);
        let told = clause.verbs.is_empty() && (!clause.complement.is_empty() || placed);
        let mut joined = self.ahead(0);
        joined.skip_joins();
        let ahead = self.ahead_after_things();
        let things = ahead.position > joined.position;
        let state = ahead.state_told() || told && ahead.switched_follows();
        things && (wished && self.is_complete(clause) && state || told && (state || ahead.goal_follows()))
    }

    /// "put the fork in the drawer, the stove cold": whether what cannot be carried is told here as it shall be.
    pub(super) fn fixed_state_follows(&self) -> bool {
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        let things = ahead.phrases(0);
        let fixed = |phrase: &Phrase| matches!(phrase.head, Head::Noun(_)) && !self.is_movable(phrase);
        let state = ahead.state_told() || ahead.switched_follows();
        let behind = if state { ahead.word_at(1) } else { None };
        let ends = behind.is_none_or(|word| [",", ".", "and", "then", "while", "before"].contains(&word));
        !things.is_empty() && things.iter().all(fixed) && state && ends
    }

    /// Whether it is said here what something is beside.
    pub(super) fn near_follows(&self) -> bool {
        preposition(&self.rest()).is_some_and(|(relation, _)| relation == Relation::Near)
    }

    /// Where the parser stands behind the things that come next.
    pub(super) fn ahead_after_things(&self) -> Parser<'a> {
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        ahead.phrases(0);
        ahead
    }

    /// "chill the wine and the lights out": whether things that can be switched come next, and how; not "take the egg and
    /// the bread out".
    pub(in crate::offline) fn switched_thing_follows(&self) -> bool {
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        let things = ahead.phrases(super::super::phrase::DEEPEST);
        let carried = |phrase: &Phrase| match &phrase.head {
            Head::Noun(noun) => self.is_movable(phrase) && !self.can_be(noun, "toggleable"),
            _ => false,
        };
        !things.is_empty() && !things.iter().any(carried) && ahead.switched_follows()
    }

    /// Whether what completes a verb stands here: "off", "out".
    pub(super) fn complements_follow(&self) -> bool {
        let ends =
            self.word_at(1).is_none_or(|next| [".", ",", "and", "then", "when", "once"].contains(&next));
        self.peek().is_some_and(|word| ["off", "on"].contains(&word) || word == "out" && ends)
    }
}
