//! Clauses: where they begin, their verb with its particle, its objects and places, and their order.

use std::rc::Rc;

use super::inflect::VerbForm;
use super::lexicon::{Act, LONGEST, Lexicon, Noun, Settings};
use super::phrase::NounAt;
use super::scene::Scene;
use super::syntax::{Clause, Head, Link, Phrase, Relation, is_determiner, is_function_word, preposition};
use opening::Opening;
pub use shape::{goes_somewhere, is_denied, is_going};
use shape::{only_pronouns, places};

/// More clauses than this are not read.
const MOST_CLAUSES: usize = 32;

/// Reads a sentence from left to right.
pub struct Parser<'a> {
    pub(super) words: &'a [String],
    pub(super) position: usize,
    pub(super) lexicon: &'a Lexicon,
    pub(super) scene: &'a Scene<'a>,
    /// The longest noun at each position.
    pub(super) nouns: Rc<[NounAt<'a>]>,
    /// Unknown modifiers that were let pass.
    pub passed_over: Vec<String>,
    /// What was chosen where the words left a choice.
    pub choices: Vec<String>,
    /// The place named last: "on one table … on another".
    pub(super) last_place: Option<Rc<Phrase>>,
    /// What was counted last: "two mugs … one … the other".
    pub(super) counted: Option<Rc<Noun>>,
    /// Whether the verb at hand still needs a place to put something.
    pub(super) wants_place: bool,
    /// Whether the verb at hand switches things on or off.
    pub(super) switches: bool,
    /// Whether the verb at hand does something to things, so that what should be otherwise is told apart.
    pub(super) acts: bool,
    /// What the verb at hand can be done to.
    pub(super) wants: Option<&'a str>,
    /// Whether the clause at hand is negated: then "or" forbids both.
    pub(super) negated: bool,
}

impl<'a> Parser<'a> {
    /// A parser at the start of the words.
    pub fn new(words: &'a [String], lexicon: &'a Lexicon, scene: &'a Scene<'a>) -> Self {
        Self {
            words,
            position: 0,
            lexicon,
            scene,
            nouns: super::sense::ordered(super::phrase::nouns(words, lexicon), words, lexicon, scene).into(),
            passed_over: Vec::new(),
            choices: Vec::new(),
            last_place: None,
            counted: None,
            wants_place: false,
            switches: true,
            acts: false,
            wants: None,
            negated: false,
        }
    }

    /// All clauses, in the order in which they are to be done.
    pub fn clauses(&mut self) -> Vec<Clause<'a>> {
        let mut clauses: Vec<Clause<'a>> = Vec::new();
        // A clause that waits for the one said after it, and whether it stands last because it has waited.
        let mut delayed: Option<Clause<'a>> = None;
        let mut late = false;
        while self.position < self.words.len() && clauses.len() < MOST_CLAUSES {
            let said_from = self.position;
            let opening = self.opening(clauses.is_empty() && delayed.is_none());
            let start = self.position;
            if start >= self.words.len() {
                break;
            }
            let previous = clauses.iter().rev().nth(usize::from(late));
            let clause = self.clause(&opening, previous);
            // "before you do that, take the book and put it on the desk": both.
            late &= matches!((&clause, previous), (Some(clause), Some(previous))
                if clause.inherits_from(previous) || clause.carries_it() && !opening.sentence);
            self.position = self.position.max(start + 1);
            let Some(mut clause) = clause else { continue };
            if let Some(said_before) = match &delayed {
                Some(late) => Some(late),
                None if opening.before_previous => clauses.last(),
                None => None,
            } {
                clause.name_pronouns(said_before);
            }
            clause.words = self.words[said_from..self.position].to_vec();
            if opening.after_next && delayed.is_none() {
                delayed = Some(clause);
            } else if let (true, Some(previous)) = (opening.before_previous, clauses.last_mut()) {
                previous.link = Link::Then;
                let at = clauses.len() - 1;
                clauses.insert(at, Clause { link: Link::And, ..clause });
            } else if late {
                clauses.insert(clauses.len() - 1, clause);
            } else {
                clauses.push(clause);
                if let Some(waited) = delayed.take() {
                    clauses.push(Clause { link: Link::Then, ..waited });
                    late = true;
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
        let doing = self.give_a_doing();
        let is_noun_first = self.longest_noun().is_some() && !self.clause_starts_here(previous.is_none());
        if let (Some((_, verbs, length)), false) = (self.verbs_here(), is_noun_first) {
            clause.verb_text = self.text_between(self.position, self.position + length);
            clause.verbs = verbs;
            self.position += length;
        } else if let Some((meant, verbs)) = self.miswritten_verb() {
            clause.verb_text = meant;
            clause.verbs = verbs;
            self.position += 1;
        } else if let Some(word) = self.peek()
            && self.longest_noun().is_none()
            && !is_function_word(word)
            && !["coffee", "wine"].contains(&word)
            && self.lexicon.adjective(&[word]).is_none()
            && self.word_at(1) != Some("of")
        {
            // An unknown verb, as far as its place tells.
            clause.verb_text = word.to_owned();
            clause.unknown.push(word.to_owned());
            self.position += 1;
        }
        if clause.verbs.is_empty() {
            self.particle_alone(&mut clause, previous);
        }
        if let Some((verbs, _)) = &doing {
            clause.verbs.clone_from(verbs);
        }
        self.wants_place = clause.verbs.iter().any(|verb| verb.act == Act::Place);
        self.negated = clause.negated;
        // "sliced bread and sliced potato should be in the pan" orders nothing by its first word.
        let told =
            start < self.position && self.words[start] == clause.verb_text && self.is_past(&clause.verb_text);
        self.acts =
            !told && !clause.verbs.is_empty() && clause.verbs.iter().all(|verb| verb.act != Act::Keep);
        let first = clause.verb_text.split(' ').next().unwrap_or_default();
        self.switches = clause.verbs.is_empty()
            || clause.verbs.iter().any(|verb| verb.act == Act::Keep)
            || self.lexicon.verbs(first).iter().any(|(_, particles, v)| {
                // "start the toaster and the lights off": by a verb that takes no "off".
                v.wants.as_deref() == Some("toggleable") && particles.iter().any(|p| p == "off")
            });
        // "turn on the microwave, light off": its particle is said.
        self.switches &= !clause.verb_text.ends_with(" on") && !clause.verb_text.ends_with(" off");
        self.wants = clause.verbs.first().and_then(|verb| verb.wants.as_deref());
        self.arguments(&mut clause, start);
        (self.wants_place, self.switches, self.acts) = (false, true, false);
        if let Some((_, word)) = doing {
            clause.objects.retain(|phrase| phrase.head != Head::Unknown(word.clone()));
        }
        let no_thing = |&at: &usize| {
            let plain = |word: &String| self.lexicon.adjective(&[word]).is_some();
            let adjective = usize::from(self.words.get(at + 1).is_some_and(plain));
            self.words[at] == "no" && self.longest_noun_at(at + 1 + adjective).is_some()
        };
        if (start..self.position.min(self.words.len())).any(|at| no_thing(&at)) {
            clause.deny();
        }
        // "the box on the sofa and the bowl in the box": the verb is understood.
        if clause.verbs.is_empty()
            && clause.unknown.is_empty()
            && clause.complement.is_empty()
            && let Some(previous) = previous
            && (!opening.sentence || goes_somewhere(&clause))
            && !(clause.places.is_empty() && self.is_told(start))
            && !self.is_wished(start)
            && (!clause.objects.is_empty() || goes_somewhere(&clause) && places(previous))
        {
            let other = only_pronouns(previous) || !self.may_be_done_to(previous, &clause);
            if other && goes_somewhere(&clause) && !places(previous) {
                // "put it on the desk and shut it, the pen in the drawer"
                clause.verbs = self.putting();
                clause.verb_text = "put".to_owned();
            } else {
                clause.verbs.clone_from(&previous.verbs);
                clause.verb_text.clone_from(&previous.verb_text);
            }
            // "put the card in the box, then the keys"
            if clause.places.is_empty() && clause.complement.is_empty() && places(previous) {
                clause.places.clone_from(&previous.places);
            }
        }
        if let Some(previous) = previous.filter(|_| clause.verbs.is_empty() && clause.unknown.is_empty()) {
            clause.go_on(previous);
        }
        let of_a_subject = previous.is_some_and(|previous| {
            (previous.verbs.is_empty() || previous.verbs.iter().any(|verb| verb.act == Act::Keep))
                && !previous.objects.is_empty()
                && previous.objects.iter().all(|phrase| self.is_movable(phrase))
        });
        let goes = clause.objects.is_empty() && is_going(&clause.verb_text) && goes_somewhere(&clause);
        if goes && of_a_subject && opening.link == Link::And && !opening.sentence {
            clause.verbs = self.putting();
        }
        self.understood_verb(&mut clause, start);
        self.place_of_many(&mut clause, start);
        clause.text = self.text_between(start, self.position);
        (!clause.text.is_empty()).then_some(clause)
    }

    /// Objects, places, particles and complements, up to the next clause.
    fn arguments(&mut self, clause: &mut Clause<'a>, start: usize) {
        while let Some(word) = self.peek() {
            if self.purpose(clause) || self.but_so(clause) {
                continue;
            }
            if self.is_boundary(clause, start) {
                return;
            }
            let before = self.position;
            if self.contrast() || self.neither(clause) || self.choice(clause) || self.there(clause) {
                continue;
            }
            if self.contents_told(clause)
                || self.belongs(clause)
                || self.passive(clause)
                || self.particle(clause)
                || self.complement(clause)
                || self.place(clause)
            {
                continue;
            }
            // "the fork and the spoon both in the drawer"
            let floating = ["both", "all", "each"].contains(&word) && !clause.objects.is_empty();
            if floating && self.word_at(1).is_some_and(|next| preposition(&[next]).is_some() && next != "of")
            {
                self.position += 1;
                continue;
            }
            // "slice the bread and the tomato, both into the bowl"
            let both = word == "," && matches!(self.word_at(1), Some("both" | "all"));
            if both && self.is_complete(clause) && self.ahead(2).goal_follows() {
                self.position += 2;
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
            // "spread all slices evenly in the pan": how it is done is no goal.
            let adverb = word.len() > 4 && word.ends_with("ly") && self.longest_noun().is_none();
            if adverb && self.lexicon.adjective(&[word]).is_none() && self.verbs_here().is_none() {
                self.position += 1;
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
            "," | "and"
                if self.is_complete(clause) && (self.new_subject_follows() || self.fixed_state_follows()) =>
            {
                true
            }
            "," if self.another_wish_follows(clause, start) => true,
            "," if only_pronouns(clause) && self.ahead_after_things().goal_follows() => true,
            "," | "and" if !self.switches && self.switched_thing_follows() => true,
            "," | "and" => {
                let mut ahead = self.ahead(1);
                if ahead.peek() == Some("and") || ahead.peek() == Some(",") {
                    ahead.position += 1;
                }
                ahead.clause_starts_here(false)
            }
            "then" | "but" | "until" | "so" | "dont" | "because" => self.position > start,
            "while" | "before" | "whilst" | "once" | "when" | "without" => self.position > start,
            "after" => self.position > start && next != "that",
            "as" => {
                self.position > start
                    && !self.rest().starts_with(&["as", "well"])
                    && self.ahead(1).clause_starts_here(false)
            }
            "with" if self.state_follows() => self.position > start,
            "to" if self.passive_follows() => self.position > start,
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

    /// Whether a clause says what is done to what, or where something goes.
    fn is_complete(&self, clause: &Clause<'a>) -> bool {
        let does = clause.verbs.iter().any(|verb| verb.act != Act::Keep);
        let put = places(clause) && !clause.places.is_empty();
        put || !clause.objects.is_empty()
            && (does
                || !clause.places.is_empty()
                || !clause.complement.is_empty()
                // "make it dark, and the fork needs washing"
                || !clause.unknown.is_empty())
    }

    /// "… to be put in the sink": what was spoken of is to be put there.
    fn passive_follows(&self) -> bool {
        self.word_at(1) == Some("be")
            && self.word_at(2).is_some_and(|word| {
                self.lexicon.verbs(word).iter().any(|(form, _, _)| *form == VerbForm::Past)
                    || ["put", "cut", "set"].contains(&word)
            })
    }

    /// "… the lettuce place it …": a verb right after a complete clause, followed by a determiner.
    fn verb_reads_as_clause(&self) -> bool {
        let Some((form, verbs, length)) = self.verbs_here() else { return false };
        form != VerbForm::Past
            && !self.peek().is_some_and(|word| ["should", "has", "needs", "gets"].contains(&word))
            && !verbs.iter().all(|verb| verb.act == Act::Go)
            && self.longest_noun().is_none()
            && preposition(&self.rest()).is_none()
            && (self
                .word_at(length)
                .is_some_and(|next| is_determiner(next) || next == "it" || next == "them")
                || form == VerbForm::Base && self.bare_order_follows(length))
    }

    /// "open fridge take egg": a verb and a noun with no article, as in notes.
    fn bare_order_follows(&self, length: usize) -> bool {
        let plain = self.peek().is_some_and(|word| {
            self.lexicon.adjective(&[word]).is_none()
                && !self.lexicon.is_small("modifiers", &[word])
                && !self.lexicon.is_small("rooms", &[word])
        });
        plain && self.longest_noun_at(self.position + length).is_some()
    }

    pub(super) fn ahead(&self, offset: usize) -> Parser<'a> {
        Parser {
            words: self.words,
            position: self.position + offset,
            lexicon: self.lexicon,
            scene: self.scene,
            nouns: Rc::clone(&self.nouns),
            passed_over: Vec::new(),
            choices: Vec::new(),
            last_place: self.last_place.clone(),
            counted: self.counted.clone(),
            wants_place: self.wants_place,
            switches: self.switches,
            acts: false,
            wants: None,
            negated: self.negated,
        }
    }

    /// After "and": whether what follows is "NP in NP", to be read with the same verb.
    fn same_verb_again(&self, clause: &Clause<'a>) -> bool {
        let switched = clause.verb_text.contains(' ') && self.ahead_after_things().complements_follow();
        let complete = !clause.places.is_empty() || !clause.complement.is_empty() || switched;
        let continues = clause.unknown.iter().all(|word| is_going(word));
        if clause.verbs.is_empty() && !continues || clause.objects.is_empty() || !complete {
            return false;
        }
        let mut ahead = self.ahead(0);
        ahead.skip_joins();
        if ahead.phrases(0).is_empty() {
            return false;
        }
        // "I want the bread sliced, the egg in the fridge": the wish goes on, whatever is wished for.
        let wished = clause.verbs.iter().all(|verb| verb.act == Act::Keep);
        ahead.position += usize::from(ahead.peek().is_some_and(is_going));
        if !clause.complement.is_empty() {
            return ahead.state_told()
                || ahead.complements_follow()
                || wished && (ahead.goal_follows() || ahead.near_follows());
        }
        if wished && (ahead.state_told() || ahead.complements_follow()) {
            return true;
        }
        // "the card with the keys in the box"
        if let Some((Relation::With, length)) = preposition(&ahead.rest()) {
            ahead.position += length;
            ahead.phrases(0);
        }
        // "… and the fork from the drawer to the table"
        if let Some((Relation::From, length)) = preposition(&ahead.rest()) {
            let start = ahead.position;
            ahead.position += length;
            if ahead.phrase(0).is_none() {
                ahead.position = start;
            }
        }
        preposition(&ahead.rest())
            .is_some_and(|(relation, _)| matches!(relation, Relation::In | Relation::To | Relation::Near))
            || ahead.peek().is_some_and(|word| ["should", "must", "needs", "need"].contains(&word))
            || ahead.aside_state_follows()
            || ahead.complements_follow()
    }
}

mod argument;
mod choice;
mod follows;
mod opening;
mod place;
mod shape;
mod understood;
mod verb;
