//! What follows the head of a noun phrase: contents, places, exceptions.

use lamma_domains::goal::PropertyValue;

use super::super::clause::Parser;
use super::super::inflect::VerbForm;
use super::super::lexicon::{Act, Noun, Settings, Verb};
use super::super::syntax::{Head, Phrase, Place, Quantity, preposition};

impl Parser<'_> {
    /// What follows the head: contents, places, exceptions.
    pub(super) fn after_head(&mut self, phrase: &mut Phrase, depth: usize) {
        loop {
            let start = self.position;
            match self.peek() {
                Some("of") => {
                    self.position += 1;
                    if let Some(of) = self.phrase(depth + 1) {
                        self.merge_of(phrase, of);
                    }
                }
                Some(",")
                    if matches!(self.word_at(1), Some("containing" | "holding"))
                        || self.word_at(1) == Some("with") && self.is_vessel(phrase) =>
                {
                    self.position += 2;
                    phrase.with.extend(self.phrases(depth + 1));
                    let _ = self.skip_back_reference();
                }
                Some("containing" | "holding") => {
                    self.position += 1;
                    phrase.with.extend(self.phrases(depth + 1));
                }
                Some("filled" | "full") if matches!(self.word_at(1), Some("with" | "of")) => {
                    self.position += 2;
                    phrase.with.extend(self.phrases(depth + 1));
                }
                Some("with") if self.is_vessel(phrase) && !self.state_follows() => {
                    self.position += 1;
                    let with = self.phrases(depth + 1);
                    if with.is_empty() {
                        self.position = start;
                        return;
                    }
                    phrase.with.extend(with);
                    let _ = self.skip_back_reference();
                }
                Some("that" | "which" | "thats")
                    if matches!(self.word_at(1), Some("is" | "are" | "was" | "were")) =>
                {
                    self.position += 2;
                    while matches!(self.peek(), Some("still" | "currently" | "now" | "left" | "already")) {
                        self.position += 1;
                    }
                    if !self.adjective(phrase) && preposition(&self.rest()).is_none() {
                        self.position = start;
                        return;
                    }
                    self.where_it_is(phrase, depth);
                }
                Some("that" | "which")
                    if matches!(self.word_at(1), Some("has" | "have" | "had"))
                        && self.word_at(2) == Some("been") =>
                {
                    self.position += 3;
                    if !self.adjective(phrase) {
                        self.position = start;
                        return;
                    }
                }
                Some("that" | "which")
                    if matches!(self.word_at(1), Some("has" | "contains" | "have" | "holds")) =>
                {
                    self.position += 2;
                    phrase.with.extend(self.phrases(depth + 1));
                    let _ = self.skip_back_reference();
                }
                Some(
                    "sitting" | "located" | "lying" | "laying" | "standing" | "resting" | "placed" | "found",
                ) if self.position + 1 < self.words.len() && preposition(&self.rest()[1..]).is_some() => {
                    self.position += 1;
                    self.where_it_is(phrase, depth);
                }
                Some("except" | "excluding" | "but")
                    if self.peek() != Some("but")
                        || phrase.quantity == Quantity::All && !self.ahead(1).clause_starts_here(false) =>
                {
                    self.position += 1;
                    if matches!(self.peek(), Some("for" | "from")) {
                        self.position += 1;
                    }
                    phrase.except.extend(self.excepted(depth));
                }
                Some("that" | "which" | "who" | "you" | "we" | "i") if self.relative().is_some() => {
                    self.states_of_relative(phrase);
                    if phrase.head == Head::Everything {
                        phrase.head = Head::Pronoun { plural: true };
                        phrase.quantity = Quantity::One;
                    }
                    self.position += self.relative().unwrap_or(0);
                }
                Some("other") if self.word_at(1) == Some("than") => {
                    self.position += 2;
                    phrase.except.extend(self.phrases(depth + 1));
                }
                _ => return,
            }
            if self.position == start {
                return;
            }
        }
    }

    /// "everything except the fork and the knife goes …": all that is joined, whatever is said behind it.
    fn excepted(&mut self, depth: usize) -> Vec<Phrase> {
        let mut found = self.phrases(depth + 1);
        loop {
            let start = self.position;
            let joined = self.peek() == Some("and") && self.skip_joins() && !self.clause_starts_here(false);
            match self.phrase(depth + 1).filter(|_| joined) {
                Some(phrase) if matches!(phrase.head, Head::Noun(_)) => found.push(phrase),
                _ => {
                    self.position = start;
                    return found;
                }
            }
        }
    }

    /// "the bread that you heated": it is hot.
    fn states_of_relative(&self, phrase: &mut Phrase) {
        let length = self.relative().unwrap_or(0);
        let verbs = (0..length).filter_map(|at| self.word_at(at)).flat_map(|word| self.lexicon.verbs(word));
        let treats = |verb: &Verb| matches!(verb.act, Act::Heat | Act::Chill | Act::Cook | Act::Set);
        let done = verbs.filter(|(form, particles, verb)| {
            *form == VerbForm::Past && particles.is_empty() && treats(verb) && verb.wants.is_none()
        });
        for (_, _, verb) in done.take(1) {
            let hot = Settings::from([("temperature".to_owned(), PropertyValue::Word("Hot".to_owned()))]);
            phrase.states.extend(if verb.act == Act::Cook { hot } else { verb.set.clone() });
        }
    }

    /// "(the knife) that you used", "(the machine) which makes it": how many words tell what is known of a thing.
    fn relative(&self) -> Option<usize> {
        const PERSONS: [&str; 9] = ["you", "we", "i", "they", "he", "she", "someone", "somebody", "ive"];
        const AUXILIARIES: [&str; 10] =
            ["have", "has", "had", "just", "will", "did", "already", "been", "be", "were"];
        let joined = usize::from(matches!(self.peek(), Some("that" | "which" | "who")));
        let person = usize::from(self.word_at(joined).is_some_and(|word| PERSONS.contains(&word)));
        let from = joined + person;
        let auxiliaries =
            (from..).take_while(|&at| self.word_at(at).is_some_and(|w| AUXILIARIES.contains(&w))).count();
        let verb = self.ahead(from + auxiliaries);
        let (form, _, length) = verb.verbs_here()?;
        let mut end = from + auxiliaries + length;
        if person == 1 {
            // "the knife you washed the apple with" says more than is read; "the knife you used" does not.
            let past = self.word_at(from).is_some_and(|word| ["cut", "put", "set"].contains(&word));
            let done = form == VerbForm::Past || auxiliaries > 0 || past;
            let stranded = self.word_at(end).is_some_and(|word| ["with", "from", "for"].contains(&word))
                && self.word_at(end + 1).is_none_or(|next| [".", ",", "and"].contains(&next));
            end += usize::from(stranded);
            let ends = self.word_at(end).is_none_or(|next| {
                [".", ",", "and", "then"].contains(&next) || preposition(&[next]).is_some()
            });
            return (done && ends).then_some(end);
        }
        let it = matches!(self.word_at(end), Some("it" | "them"));
        (joined == 1 && it).then_some(end + 1)
    }

    pub(super) fn is_vessel(&self, phrase: &Phrase) -> bool {
        matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| {
            self.scene.affords(kind, "receptacle") && self.scene.affords(kind, "pickupable")
        }))
    }

    /// `in it`, `on it`, `inside`: says again where the contents are.
    pub(in crate::offline) fn skip_back_reference(&mut self) -> bool {
        let start = self.position;
        if let Some((_, length)) = preposition(&self.rest()) {
            match self.word_at(length) {
                Some("it" | "them") => self.position += length + 1,
                next if next.is_none_or(|w| [".", ","].contains(&w) || preposition(&[w]).is_some())
                    && self.peek() == Some("inside") =>
                {
                    self.position += length;
                }
                _ => {}
            }
        }
        self.position > start
    }

    pub(super) fn where_it_is(&mut self, phrase: &mut Phrase, depth: usize) {
        if let Some((relation, length)) = preposition(&self.rest()) {
            let start = self.position;
            self.position += length;
            match self.phrase(depth + 1) {
                Some(at) => phrase.at.push(Place::new(relation, "", at)),
                None => self.position = start,
            }
        }
    }

    /// "N1 of N2": the same thing said twice ("the light of the lamp") is N2; otherwise N2 is what N1 holds, or
    /// only says which N1 is meant ("the drawer of the desk").
    fn merge_of(&self, phrase: &mut Phrase, of: Phrase) {
        let overlap = match (&phrase.head, &of.head) {
            (Head::Noun(a), Head::Noun(b)) => {
                a.kinds.iter().any(|kind| b.kinds.contains(kind)) && !self.is_compartment(a)
            }
            _ => false,
        };
        if overlap {
            phrase.head = of.head;
        } else if matches!(phrase.head, Head::Slices) {
            phrase.head = of.head;
            phrase.quantity = if phrase.quantity == Quantity::All { Quantity::One } else { phrase.quantity };
        } else {
            phrase.with.push(of);
        }
    }

    /// Whether a noun means first of all a compartment.
    pub(super) fn is_compartment(&self, noun: &Noun) -> bool {
        noun.kinds.iter().find(|kind| self.scene.has(kind)).is_some_and(|kind| self.is_compartment_kind(kind))
    }

    pub(super) fn is_compartment_kind(&self, kind: &str) -> bool {
        self.lexicon.is_small("compartments", &[&kind.to_lowercase()])
    }
}
