//! Several noun phrases: what is joined by "and" and commas, and where such a list ends.

use super::super::clause::{Parser, is_going};
use super::super::inflect;
use super::super::syntax::{Head, Phrase, Quantity, Relation, is_determiner, preposition};
use super::DEEPEST;

impl Parser<'_> {
    /// Noun phrases joined by "and" and commas, up to the next clause.
    pub(in crate::offline) fn phrases(&mut self, depth: usize) -> Vec<Phrase> {
        let mut found = Vec::new();
        let Some(first) = self.phrase(depth) else { return found };
        found.push(first);
        loop {
            let start = self.position;
            let joined = self.skip_joins();
            let comma = self.words.get(start).is_some_and(|word| word == ",");
            if !joined
                || self.clause_starts_here(false)
                || self.another_subject(depth > 0)
                || (depth > 0 || self.acts) && self.something_should(comma || depth > 0)
            {
                self.position = start;
                return found;
            }
            // "shut it, the pen and the book on the desk": another thing is said of them.
            let after_pronoun = self.words[start] == ","
                && found.last().is_some_and(|phrase| matches!(phrase.head, Head::Pronoun { .. }));
            if after_pronoun && self.is_put_somewhere() {
                self.position = start;
                return found;
            }
            let or = !self.negated && self.words[start..self.position].iter().any(|word| word == "or");
            match self.phrase(depth) {
                Some(phrase) if or => {
                    if let Some(first) = found.pop() {
                        let chosen = self.chosen(first, phrase);
                        found.push(chosen);
                    }
                }
                Some(mut phrase) => {
                    if let (true, [class]) = (comma, found.as_slice())
                        && is_one_of(&phrase, class)
                    {
                        found.clear();
                    }
                    // "all the cabinets and drawers"
                    let all = found.last().is_some_and(|last| last.quantity == Quantity::All);
                    let each = found.last().is_some_and(is_each_of) && has_no_determiner(&phrase);
                    if all && (phrase.quantity == Quantity::Plural || each) {
                        phrase.quantity = Quantity::All;
                    }
                    // "both the plate and the bowl": one of each; "both plates and the bowl": two plates.
                    if let Some(first) = found.last_mut()
                        && first.text.starts_with("both ")
                        && self.words[start] == "and"
                        && !is_plural(first)
                    {
                        first.quantity = Quantity::One;
                    }
                    found.push(phrase);
                }
                None => {
                    self.position = start;
                    return found;
                }
            }
        }
    }

    /// ", each goes into the bowl", "a box with a bat, the ball goes …": something is said of what comes next.
    fn another_subject(&self, of_contents: bool) -> bool {
        // "chill the wine and the lights out"
        if (!self.switches || of_contents) && self.switched_thing_follows() {
            return true;
        }
        let pronoun =
            self.peek().is_some_and(|word| ["each", "both", "they", "it", "these", "those"].contains(&word));
        let mut ahead = self.ahead(0);
        let Some(first) = ahead.phrase(DEEPEST) else { return false };
        if !pronoun && !of_contents && first.head != Head::Slices {
            return false;
        }
        ahead.peek().is_some_and(|word| {
            is_going(word) || ["should", "must", "need", "needs", "is", "are"].contains(&word)
        })
    }

    /// "slice the potato, and the pot should be on the stove": what comes next is not done to the pot. Behind a comma
    /// several things may be told so.
    fn something_should(&self, several: bool) -> bool {
        let mut ahead = self.ahead(0);
        let Some(first) = ahead.phrase(DEEPEST) else { return false };
        // "close the fridge and the fork and the spoon should …": what cannot be closed is not closed.
        let unfit = self.wants.is_some_and(|wants| match &first.head {
            Head::Noun(noun) => !self.can_be(noun, wants),
            _ => false,
        });
        let several = several || unfit || first.text.starts_with("both ");
        while several && ahead.skip_joins() && ahead.phrase(DEEPEST).is_some() {}
        ahead.peek().is_some_and(|word| {
            ["should", "must", "shall", "needs"].contains(&word)
                || ["is", "are"].contains(&word) && ahead.word_at(1) == Some("to")
                || is_going(word) && (ahead.ahead(1).place_length().is_some() || ahead.ahead(1).state_told())
        })
    }

    /// Whether things are named here and then a place.
    fn is_put_somewhere(&self) -> bool {
        let mut ahead = self.ahead(0);
        while ahead.phrase(DEEPEST).is_some() && ahead.skip_joins() {}
        preposition(&ahead.rest())
            .is_some_and(|(relation, _)| matches!(relation, Relation::In | Relation::To))
    }

    /// Passes over "and", commas and the like between noun phrases.
    pub(in crate::offline) fn skip_joins(&mut self) -> bool {
        let start = self.position;
        while let Some(word) = self.peek() {
            match word {
                "," | "and" | "plus" | "or" | "nor" => self.position += 1,
                "as" if self.rest().starts_with(&["as", "well", "as"]) => self.position += 3,
                "along" | "together" if self.word_at(1) == Some("with") => self.position += 2,
                "then" | "also" if self.position > start && !self.clause_starts_here(false) => {
                    self.position += 1
                }
                _ => break,
            }
        }
        self.position > start
    }
}

/// "the food: the apple goes …", "both vegetables, the lettuce and …": whether one phrase names a member of
/// another's class.
pub(in crate::offline) fn is_one_of(phrase: &Phrase, class: &Phrase) -> bool {
    match (&phrase.head, &class.head) {
        (Head::Noun(one), Head::Noun(class)) => {
            class.class && !one.class && one.kinds.first().is_some_and(|kind| class.kinds.contains(kind))
        }
        _ => false,
    }
}

/// "every cabinet and drawer": each goes for both.
fn is_each_of(phrase: &Phrase) -> bool {
    ["every ", "each "].iter().any(|each| phrase.text.starts_with(each))
}

fn has_no_determiner(phrase: &Phrase) -> bool {
    let noun = matches!(phrase.head, Head::Noun(_));
    noun && phrase.text.split(' ').next().is_none_or(|first| !is_determiner(first))
}

fn is_plural(phrase: &Phrase) -> bool {
    phrase.text.rsplit(' ').next().is_some_and(|last| !inflect::singulars(last).is_empty())
}
