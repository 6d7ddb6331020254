//! Verbs that are not said but understood.

use super::super::syntax::{Clause, Head, Phrase, Relation};
use super::Parser;
use super::shape::{goes_somewhere, is_denied, is_going};

impl<'a> Parser<'a> {
    /// Whether the clause read since a position says how something is.
    pub(super) fn is_told(&self, start: usize) -> bool {
        let said = self.words.get(start..self.position).unwrap_or_default();
        said.iter().any(|word| ["is", "are", "was", "were"].contains(&word.as_str()))
    }

    /// Whether the clause read since a position says how something should be.
    pub(super) fn is_wished(&self, start: usize) -> bool {
        let said = self.words.get(start..self.position).unwrap_or_default();
        let before = start.checked_sub(1).map_or("", |at| self.words[at].as_str());
        ["want", "like", "prefer"].contains(&before)
            || said
                .windows(2)
                .any(|two| ["should", "must", "shall"].contains(&two[0].as_str()) && two[1] == "be")
    }

    /// "apple in the fridge", "the fork goes in the drawer": to be put there.
    pub(super) fn understood_verb(&self, clause: &mut Clause<'a>, start: usize) {
        let goes = |word: &String| is_going(word);
        let said = self.words.get(start..self.position).unwrap_or_default();
        let told = self.is_told(start);
        // "bung the egg in the fridge": what is done with a thing and a place puts it there.
        let done = self.words.get(start).is_some_and(|word| self.is_unknown_verb(word, start + 1));
        let done = done && clause.unknown.len() == 1 && clause.unknown[0] == self.words[start];
        let going = !clause.unknown.is_empty();
        let before = start.checked_sub(1).map_or("", |at| self.words[at].as_str());
        let shall = said.iter().any(|word| ["should", "must", "shall"].contains(&word.as_str()))
            || ["want", "like", "need", "prefer"].contains(&before);
        let pronoun = |phrase: &Phrase| (going || shall) && matches!(phrase.head, Head::Pronoun { .. });
        let all = |phrase: &Phrase| going && phrase.head == Head::Everything;
        let moved = clause.objects.iter().all(|phrase| {
            self.is_movable(phrase) || pronoun(phrase) || all(phrase) || phrase.head == Head::Slices
        }) && !clause.objects.is_empty();
        let with = start.checked_sub(1).is_some_and(|at| self.words[at] == "with");
        let beside = (going || with) && clause.places.iter().any(|place| place.relation == Relation::Near);
        let stays = said.last().is_some_and(|word| ["stay", "stays"].contains(&word.as_str()));
        if clause.verbs.is_empty()
            && !stays
            && (done || clause.unknown.iter().all(goes))
            && !told
            && !is_denied(said)
            && moved
            && (goes_somewhere(clause) || beside)
        {
            clause.verbs = self.putting();
            clause.unknown.clear();
        }
    }

    /// Whether what is done before can be done to what a clause names: no towel is turned on, no sponge emptied.
    pub(super) fn may_be_done_to(&self, previous: &Clause<'a>, clause: &Clause<'a>) -> bool {
        const SPECIAL: [&str; 3] = ["toggleable", "openable", "canFillWithLiquid"];
        let fits = |phrase: &Phrase, wants: &str| match &phrase.head {
            Head::Noun(noun) => self.can_be(noun, wants),
            _ => true,
        };
        let wanted = previous.verbs.iter().filter_map(|verb| verb.wants.as_deref());
        let mut special = wanted.filter(|wants| SPECIAL.contains(wants)).peekable();
        special.peek().is_none()
            || special.any(|wants| clause.objects.iter().any(|phrase| fits(phrase, wants)))
    }
}
