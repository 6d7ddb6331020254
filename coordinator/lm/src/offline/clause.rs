//! Clauses: where they begin, their verb with its particle, its objects and places, and their order.

use super::inflect::VerbForm;
use super::lexicon::{Act, LONGEST, Lexicon, Settings, Verb};
use super::scene::Scene;
use super::syntax::{Clause, Link, Relation, is_determiner, is_function_word, preposition};

/// More clauses than this are not read.
const MOST_CLAUSES: usize = 32;

/// Reads a sentence from left to right.
pub struct Parser<'a> {
    pub(super) words: &'a [String],
    pub(super) position: usize,
    pub(super) lexicon: &'a Lexicon,
    pub(super) scene: &'a Scene<'a>,
    /// Unknown modifiers that were let pass.
    pub passed_over: Vec<String>,
    /// What was chosen where the words left a choice.
    pub choices: Vec<String>,
    /// Whether the verb at hand still needs a place to put something.
    wants_place: bool,
    /// Whether the clause at hand is negated: then "or" forbids both.
    pub(super) negated: bool,
}

/// What opens a clause.
struct Opening {
    link: Link,
    negated: bool,
    condition: bool,
    robots: Vec<String>,
    /// `before you …, …`: this clause comes after the next.
    after_next: bool,
    /// `… after you …`: this clause comes before the one said before it.
    before_previous: bool,
}

impl<'a> Parser<'a> {
    /// A parser at the start of the words.
    pub fn new(words: &'a [String], lexicon: &'a Lexicon, scene: &'a Scene<'a>) -> Self {
        Self {
            words,
            position: 0,
            lexicon,
            scene,
            passed_over: Vec::new(),
            choices: Vec::new(),
            wants_place: false,
            negated: false,
        }
    }

    /// All clauses, in the order in which they are to be done.
    pub fn clauses(&mut self) -> Vec<Clause<'a>> {
        let mut clauses: Vec<Clause<'a>> = Vec::new();
        // A clause that waits for the one said after it.
        let mut delayed: Option<Clause<'a>> = None;
        while self.position < self.words.len() && clauses.len() < MOST_CLAUSES {
            let said_from = self.position;
            let opening = self.opening(clauses.is_empty() && delayed.is_none());
            let start = self.position;
            if start >= self.words.len() {
                break;
            }
            let clause = self.clause(&opening, clauses.last());
            self.position = self.position.max(start + 1);
            let Some(mut clause) = clause else { continue };
            clause.words = self.words[said_from..self.position].to_vec();
            if opening.after_next && delayed.is_none() {
                delayed = Some(clause);
            } else if let (true, Some(previous)) = (opening.before_previous, clauses.last_mut()) {
                previous.link = Link::Then;
                let at = clauses.len() - 1;
                clauses.insert(at, Clause { link: Link::And, ..clause });
            } else {
                clauses.push(clause);
                if let Some(late) = delayed.take() {
                    clauses.push(Clause { link: Link::Then, ..late });
                }
            }
        }
        clauses.extend(delayed);
        clauses
    }

    pub(super) fn peek(&self) -> Option<&'a str> {
        self.word_at(0)
    }

    pub(super) fn word_at(&self, offset: usize) -> Option<&'a str> {
        self.words.get(self.position + offset).map(String::as_str)
    }

    /// The next words, as many as a phrase of the lexicon may have.
    pub(super) fn rest(&self) -> Vec<&'a str> {
        let end = (self.position + LONGEST + 1).min(self.words.len());
        self.words.get(self.position..end).unwrap_or_default().iter().map(String::as_str).collect()
    }

    pub(super) fn text_between(&self, start: usize, end: usize) -> String {
        let mut text = String::new();
        for word in self.words.get(start..end).unwrap_or_default() {
            if !text.is_empty() && word != "," && word != "." {
                text.push(' ');
            }
            text.push_str(word);
        }
        text.trim_end_matches([',', '.', ' ']).to_owned()
    }

    /// Passes over joins and politeness, and notes the order they state.
    fn opening(&mut self, first: bool) -> Opening {
        let mut opening = Opening {
            link: Link::And,
            negated: false,
            condition: false,
            robots: Vec::new(),
            after_next: false,
            before_previous: false,
        };
        while let Some(word) = self.peek() {
            let rest = self.rest();
            if let Some(length) = self.lexicon.longest_small("sequence", &rest)
                && !(length == 1 && self.longest_noun().is_some())
            {
                opening.link = Link::Then;
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
            let polite = self.lexicon.longest_small("polite", &rest);
            if let Some(length) = polite.filter(|&length| length > 1) {
                self.position += length;
                continue;
            }
            if let Some(robot) = self.robot() {
                opening.robots.push(robot);
                continue;
            }
            match word {
                "should" | "shall" | "must" | "can" | "has" | "will" if !opening.robots.is_empty() => {}
                "have" | "let" if self.ahead(1).robot().is_some() => {}
                "if" => {
                    opening.condition = true;
                    opening.before_previous = !first;
                }
                "," | "." | "and" | "so" | "but" | "plus" | "first" | "firstly" | "to" | "you" | "i"
                | "we" => {}
                "before" => {
                    if first {
                        opening.after_next = true;
                    } else {
                        opening.link = Link::Then;
                    }
                }
                "after" | "once" | "when" => {
                    if first {
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
                    Some(length) => {
                        self.position += length;
                        continue;
                    }
                    None => break,
                },
            }
            self.position += 1;
        }
        opening
    }

    /// The verbs at the position and how many words they take, the particle-rich first.
    fn verbs_here(&self) -> Option<(VerbForm, Vec<&'a Verb>, usize)> {
        let word = self.peek()?;
        let candidates = self.lexicon.verbs(word);
        let behind: Vec<&str> = self.rest().into_iter().skip(1).collect();
        let contiguous = candidates.iter().find(|(_, particles, verb)| {
            particles.len() <= behind.len()
                && particles.iter().zip(&behind).all(|(a, b)| a == b)
                && self.object_may_fit(particles, verb)
        });
        let Some((form, particles, _)) = contiguous else { return self.verb_apart(&candidates) };
        let (form, length) = (*form, particles.len());
        let verbs = candidates
            .iter()
            .filter(|(_, other, _)| other.len() == length && other.iter().zip(&behind).all(|(a, b)| a == b))
            .map(|(_, _, verb)| *verb)
            .collect();
        Some((form, verbs, length + 1))
    }

    /// "switch the light on": a verb that needs its particle, which stands behind the object.
    fn verb_apart(
        &self,
        candidates: &[(VerbForm, &'a [String], &'a Verb)],
    ) -> Option<(VerbForm, Vec<&'a Verb>, usize)> {
        let behind: Vec<&str> = self.words[self.position + 1..]
            .iter()
            .map(String::as_str)
            .take(8)
            .take_while(|word| ![".", ",", "then", "if"].contains(word))
            .collect();
        let (form, particles, _) = candidates
            .iter()
            .find(|(_, particles, _)| particles.len() == 1 && behind.contains(&particles[0].as_str()))?;
        let verbs =
            candidates.iter().filter(|(_, other, _)| other == particles).map(|(_, _, verb)| *verb).collect();
        Some((*form, verbs, 1))
    }

    /// "put on the light" switches; "put on the table" puts: what follows decides.
    fn object_may_fit(&self, particles: &[String], verb: &Verb) -> bool {
        let (Some(wants), [particle]) = (&verb.wants, particles) else { return true };
        if preposition(&[particle]).is_none() {
            return true;
        }
        let nouns: Vec<_> = (self.position + 2..self.position + 8)
            .take_while(|&at| {
                self.words.get(at).is_some_and(|word| {
                    preposition(&[word]).is_none() && !["and", ",", ".", "while"].contains(&word.as_str())
                })
            })
            .filter_map(|at| self.longest_noun_at(at))
            .collect();
        // What is not here can be anything, unless the bare verb would put things there.
        let puts =
            |word| self.lexicon.verbs(word).iter().any(|(_, p, v)| p.is_empty() && v.act == Act::Place);
        let open = !self.peek().is_some_and(puts);
        nouns.is_empty()
            || nouns.iter().any(|(noun, _, _)| self.can_be(noun, wants) || open && self.is_absent(noun))
    }

    fn can_be(&self, noun: &super::lexicon::Noun, wants: &str) -> bool {
        self.has_affordance(noun, wants)
            || wants == "toggleable" && noun.kinds.iter().any(|kind| self.lexicon.control(kind).is_some())
    }

    /// Whether a clause rather than another noun phrase starts at the position.
    pub(super) fn clause_starts_here(&self, first: bool) -> bool {
        let Some(word) = self.peek() else { return true };
        if [".", "then", "before", "after", "while", "when", "once", "until", "but", "dont", "without"]
            .contains(&word)
        {
            return true;
        }
        let rest = self.rest();
        let negation = word == "never" || rest.starts_with(&["do", "not"]);
        if negation
            || self.robot_opens()
            || self.lexicon.longest_small("sequence", &rest).is_some()
            || self.lexicon.longest_small("parallel", &rest).is_some()
        {
            return true;
        }
        let Some((form, verbs, length)) = self.verbs_here() else {
            return self.lexicon.longest_small("polite", &rest).is_some();
        };
        let next = self.word_at(length);
        let determined =
            next.is_some_and(|next| is_determiner(next) || ["it", "them", "everything"].contains(&next));
        let noun = self.longest_noun();
        if noun.as_ref().is_some_and(|(_, _, noun_length)| *noun_length > length)
            && !(first && self.noun_begins(length))
        {
            return false;
        }
        if form == VerbForm::Past {
            return first || determined;
        }
        if noun.is_some() {
            // A word that is noun and verb is a verb when something to do it to follows at once.
            return first || determined || self.noun_begins(length);
        }
        if self.lexicon.adjective(&[word]).is_some() {
            return first || determined || (!self.wants_place && self.noun_begins(length));
        }
        !verbs.is_empty()
    }

    /// Whether a noun phrase without a determiner starts behind some words.
    fn noun_begins(&self, offset: usize) -> bool {
        let at = self.position + offset;
        let Some(word) = self.words.get(at).map(String::as_str) else { return false };
        if preposition(&[word]).is_some() || word == "and" || word == "," {
            return false;
        }
        self.longest_noun_at(at).is_some()
            || super::inflect::number(word).is_some()
            || self.lexicon.adjective(&[word]).is_some()
            || self.lexicon.is_small("slices", &[word])
    }

    fn clause(&mut self, opening: &Opening, previous: Option<&Clause<'a>>) -> Option<Clause<'a>> {
        let start = self.position;
        let mut clause = Clause {
            text: String::new(),
            verbs: Vec::new(),
            verb_text: String::new(),
            negated: opening.negated,
            condition: opening.condition,
            robots: opening.robots.clone(),
            objects: Vec::new(),
            places: Vec::new(),
            complement: Settings::new(),
            back: false,
            link: opening.link,
            unknown: Vec::new(),
            words: Vec::new(),
        };
        self.leading_places(&mut clause);
        let is_noun_first = self.longest_noun().is_some() && !self.clause_starts_here(previous.is_none());
        if let (Some((_, verbs, length)), false) = (self.verbs_here(), is_noun_first) {
            clause.verb_text = self.text_between(self.position, self.position + length);
            clause.verbs = verbs;
            self.position += length;
        } else if let Some(word) = self.peek()
            && self.longest_noun().is_none()
            && !is_function_word(word)
            && self.lexicon.adjective(&[word]).is_none()
        {
            // An unknown verb, as far as its place tells.
            clause.verb_text = word.to_owned();
            clause.unknown.push(word.to_owned());
            self.position += 1;
        }
        if clause.verbs.is_empty() {
            self.particle_alone(&mut clause, previous);
        }
        self.wants_place = clause.verbs.iter().any(|verb| verb.act == Act::Place);
        self.negated = clause.negated;
        self.arguments(&mut clause, start);
        self.wants_place = false;
        let no_thing = |&at: &usize| self.words[at] == "no" && self.longest_noun_at(at + 1).is_some();
        if (start..self.position.min(self.words.len())).any(|at| no_thing(&at)) {
            clause.deny();
        }
        // "the box on the sofa and the bowl in the box": the verb is understood.
        if clause.verbs.is_empty()
            && clause.unknown.is_empty()
            && let Some(previous) = previous
            && (!clause.objects.is_empty())
        {
            clause.verbs.clone_from(&previous.verbs);
            clause.verb_text.clone_from(&previous.verb_text);
        }
        clause.text = self.text_between(start, self.position);
        (!clause.text.is_empty()).then_some(clause)
    }

    /// Objects, places, particles and complements, up to the next clause.
    fn arguments(&mut self, clause: &mut Clause<'a>, start: usize) {
        while let Some(word) = self.peek() {
            if self.is_boundary(clause, start) {
                return;
            }
            let before = self.position;
            if self.contrast() || self.neither(clause) || self.choice(clause) || self.there(clause) {
                continue;
            }
            if self.particle(clause) || self.complement(clause) || self.place(clause) {
                continue;
            }
            if matches!(word, "," | "and" | "or") {
                // Not a clause: more objects, or the same verb with another object and place.
                self.position += 1;
                if self.same_verb_again(clause) {
                    self.position = before;
                    return;
                }
                continue;
            }
            let polite = self.lexicon.longest_small("polite", &self.rest());
            if let (Some(length), None) = (polite, self.longest_noun()) {
                self.position += length;
                continue;
            }
            if let Some(length) = self.lexicon.longest_small("parallel", &self.rest()) {
                self.position += length;
                clause.link = if clause.link == Link::And { Link::While } else { clause.link };
                continue;
            }
            let phrases = self.phrases(0);
            if phrases.is_empty() {
                if !is_function_word(word) && !self.lexicon.is_small("modifiers", &[word]) {
                    clause.unknown.push(word.to_owned());
                }
                self.position = before + 1;
            } else {
                self.wants_place &= clause.objects.is_empty();
                clause.objects.extend(phrases);
            }
        }
    }

    /// Whether the clause ends at the position.
    fn is_boundary(&self, clause: &Clause<'a>, start: usize) -> bool {
        let Some(word) = self.peek() else { return true };
        let Some(next) = self.word_at(1) else { return word == "." };
        if self.ahead(0).contrast() {
            return false;
        }
        match word {
            "do" if next == "not" => self.position > start,
            "never" | "if" => self.position > start,
            "." => true,
            "," | "and" => {
                let mut ahead = self.ahead(1);
                if ahead.peek() == Some("and") || ahead.peek() == Some(",") {
                    ahead.position += 1;
                }
                ahead.clause_starts_here(false)
            }
            "then" | "but" | "until" | "so" | "dont" => self.position > start,
            "while" | "before" | "whilst" | "once" | "when" | "without" => self.position > start,
            "after" => self.position > start && next != "that",
            "as" => {
                self.position > start
                    && !self.rest().starts_with(&["as", "well"])
                    && self.ahead(1).clause_starts_here(false)
            }
            // "to turn it on" begins a clause; "to the sink" does not.
            "to" | "by" => {
                self.position > start
                    && self.ahead(1).longest_noun().is_none()
                    && self.ahead(1).verbs_here().is_some()
                    && !clause.verbs.is_empty()
            }
            _ => self.position > start && !clause.objects.is_empty() && self.verb_reads_as_clause(),
        }
    }

    /// "… the lettuce place it …": a verb right after a complete clause, followed by a determiner.
    fn verb_reads_as_clause(&self) -> bool {
        let Some((form, _, length)) = self.verbs_here() else { return false };
        form == VerbForm::Base
            && self.longest_noun().is_none()
            && preposition(&self.rest()).is_none()
            && self.word_at(length).is_some_and(|next| is_determiner(next) || next == "it" || next == "them")
    }

    fn ahead(&self, offset: usize) -> Parser<'a> {
        Parser {
            words: self.words,
            position: self.position + offset,
            lexicon: self.lexicon,
            scene: self.scene,
            passed_over: Vec::new(),
            choices: Vec::new(),
            wants_place: self.wants_place,
            negated: self.negated,
        }
    }

    /// After "and": whether what follows is "NP in NP", to be read with the same verb.
    fn same_verb_again(&self, clause: &Clause<'a>) -> bool {
        let complete = !clause.places.is_empty() || !clause.complement.is_empty();
        if clause.verbs.is_empty() || clause.objects.is_empty() || !complete {
            return false;
        }
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        if ahead.phrases(0).is_empty() {
            return false;
        }
        if !clause.complement.is_empty() {
            let rest = ahead.rest();
            let states = |word: &&str| {
                ["is", "are", "stays", "stay"].contains(word) || self.lexicon.adjective(&[word]).is_some()
            };
            return rest.first().is_some_and(states);
        }
        preposition(&ahead.rest())
            .is_some_and(|(relation, _)| matches!(relation, Relation::In | Relation::To))
            || ahead.complements_follow()
    }

    fn complements_follow(&self) -> bool {
        self.peek().is_some_and(|word| ["off", "on"].contains(&word))
    }
}

mod argument;
mod choice;
