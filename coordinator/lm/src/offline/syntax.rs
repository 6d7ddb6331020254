//! What a sentence is made of: clauses, noun phrases, and the closed classes of English words.

use super::lexicon::{Act, Noun, Settings, Verb};

mod preposition;

pub use preposition::preposition;

/// Liquids that a vessel may get.
pub const LIQUIDS: [&str; 3] = ["water", "coffee", "wine"];

/// How much of what a noun names is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// One.
    One,
    /// So many.
    Count(usize),
    /// Every one.
    All,
    /// A plural with no number.
    Plural,
}

/// What a noun phrase is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Head {
    /// A noun of the lexicon, and whether it was a plural.
    Noun(Noun),
    /// One object of the scene by its name.
    Named(String),
    /// `it`, `them`
    Pronoun {
        /// `them`
        plural: bool,
    },
    /// `the slices`
    Slices,
    /// `everything`
    Everything,
    /// `water`
    Liquid(String),
    /// A room or a side of one: no object.
    Room,
    /// A word nobody knows.
    Unknown(String),
}

/// A noun phrase.
#[derive(Clone, Debug, PartialEq)]
pub struct Phrase {
    /// In words.
    pub text: String,
    /// What it is about.
    pub head: Head,
    /// How much of it.
    pub quantity: Quantity,
    /// `the`, `that`, `my`
    pub definite: bool,
    /// `a`
    pub indefinite: bool,
    /// `another`, `the other`
    pub other: bool,
    /// States asked for.
    pub states: Settings,
    /// States that pick it out.
    pub selects: Settings,
    /// What it contains: `with a spoon in it`.
    pub with: Vec<Phrase>,
    /// Where it is: `on the desk`.
    pub at: Vec<Place>,
    /// `except the lamp`
    pub except: Vec<Phrase>,
}

impl Phrase {
    /// A phrase of nothing but its head.
    pub fn bare(head: Head, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            head,
            quantity: Quantity::One,
            definite: false,
            indefinite: false,
            other: false,
            states: Settings::new(),
            selects: Settings::new(),
            with: Vec::new(),
            at: Vec::new(),
            except: Vec::new(),
        }
    }
}

impl Phrase {
    /// The liquid it speaks of, if it is one.
    pub fn liquid(&self) -> Option<&str> {
        match &self.head {
            Head::Liquid(liquid) => Some(liquid),
            Head::Noun(noun) => LIQUIDS.into_iter().find(|liquid| noun.word == *liquid),
            _ => None,
        }
    }
}

/// What a preposition says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `in`, `on`, `at`: where something is or goes.
    In,
    /// `to`, `into`, `onto`: where something goes.
    To,
    /// `from`, `out of`, `off`: where something was.
    From,
    /// `next to`, `under`: near something.
    Near,
    /// `with`, `using`: an instrument, or what is inside.
    With,
    /// `for`: of no consequence for the goal.
    For,
}

/// A prepositional phrase.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// What the preposition says.
    pub relation: Relation,
    /// What of.
    pub phrase: Phrase,
    /// Whether it is `under` or the like.
    pub under: bool,
    /// Whether it is where something was, before it goes elsewhere.
    pub was: bool,
    /// Whether it is `at`: there, if nothing else is said.
    pub there: bool,
    /// Whether it is `on top of`: not within.
    pub on_top: bool,
    /// Whether it is `over`: not in or on it, if something else can be.
    pub over: bool,
    /// Whether it is `on` and the like, or `in` and the like; neither where nothing says it.
    pub upon: bool,
    pub within: bool,
}

impl Place {
    /// A place by its preposition.
    pub fn new(relation: Relation, preposition: &str, phrase: Phrase) -> Self {
        let under = matches!(preposition, "under" | "underneath" | "below" | "beneath");
        Self {
            relation,
            phrase,
            under,
            was: preposition == "in the place of",
            there: preposition == "at",
            on_top: matches!(preposition, "on top of" | "atop" | "to the top of"),
            over: preposition == "over",
            upon: preposition.starts_with("on")
                || matches!(preposition, "atop" | "upon" | "down on" | "back on"),
            within: matches!(
                preposition,
                "in" | "into" | "inside" | "inside of" | "within" | "in to" | "back in"
            ),
        }
    }
}

/// How a clause follows the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// In no stated order.
    And,
    /// After it.
    Then,
    /// At the same time.
    While,
}

/// A clause.
#[derive(Clone, Debug)]
pub struct Clause<'a> {
    /// In words.
    pub text: String,
    /// What the verb may mean, with the most particles first; empty when there is no verb known.
    pub verbs: Vec<&'a Verb>,
    /// The verb as written.
    pub verb_text: String,
    /// `do not`, `without`
    pub negated: bool,
    /// `if`: what must hold now for the next clause to count.
    pub condition: bool,
    /// Who should do it: `robot2 should ...`.
    pub robots: Vec<String>,
    /// What it is done to.
    pub objects: Vec<Phrase>,
    /// Where, with what.
    pub places: Vec<Place>,
    /// `keep it closed`
    pub complement: Settings,
    /// `back`: to where it was.
    pub back: bool,
    /// How it follows the clause before it.
    pub link: Link,
    /// Words that no rule took.
    pub unknown: Vec<String>,
    /// The words, for situations.
    pub words: Vec<String>,
}

impl Clause<'_> {
    /// Whether one of some words is said in it.
    pub fn says_any(&self, words: &[&str]) -> bool {
        self.words.iter().any(|word| words.contains(&word.as_str()))
    }

    /// Whether it puts somewhere what was spoken of: "… and put it on the counter".
    pub fn carries_it(&self) -> bool {
        self.verbs.iter().any(|verb| verb.act == Act::Place)
            && self.objects.iter().any(|phrase| matches!(phrase.head, Head::Pronoun { .. }))
            && self
                .places
                .iter()
                .any(|place| matches!(place.relation, Relation::In | Relation::To | Relation::Near))
    }

    /// Whether it throws away what was spoken of: "… get rid of it".
    pub fn discards_it(&self) -> bool {
        self.verbs.iter().any(|verb| verb.act == Act::Discard)
            && self.objects.iter().any(|phrase| matches!(phrase.head, Head::Pronoun { .. }))
    }

    /// Whether it tells something rather than asks for it: it has no verb known, but somebody is or does something.
    pub fn is_remark(&self) -> bool {
        const TELLS: [&str; 16] = [
            "i",
            "im",
            "ive",
            "we",
            "were",
            "it",
            "is",
            "are",
            "was",
            "everyone",
            "everybody",
            "nobody",
            "cant",
            "there",
            "loves",
            "has",
        ];
        self.verbs.is_empty() && self.says_any(&TELLS)
    }

    /// Whether it asks for what it says rather than tells it: "the lamp should be off", "lamp off", but not
    /// "the lamp is off".
    pub fn wants(&self) -> bool {
        self.says_any(&[
            "should", "must", "needs", "need", "shall", "be", "once", "when", "after", "before", "until",
        ]) || !self.says_any(&["is", "are", "was", "were", "left", "s"]) && !self.says_any(&["while"])
            || self
                .words
                .iter()
                .find(|word| ![",", "and"].contains(&word.as_str()))
                .is_some_and(|first| first == "that" || first == "so")
    }

    /// Whether its verb is that of the clause before it, not said again.
    pub fn inherits_from(&self, previous: &Self) -> bool {
        self.verb_text == previous.verb_text && !self.text.starts_with(&self.verb_text)
    }

    /// "make sure the door is closed and the lights are off": the second is to be made sure of as well.
    pub fn go_on(&mut self, previous: &Self) {
        let keeps = previous.verbs.iter().any(|verb| verb.act == Act::Keep);
        if keeps && !previous.complement.is_empty() && !self.complement.is_empty() {
            self.verbs.clone_from(&previous.verbs);
            self.verb_text.clone_from(&previous.verb_text);
        }
    }

    /// What is said later but done earlier names what "it" is: "turn on the toaster after putting bread in it".
    pub fn name_pronouns(&mut self, said_before: &Self) {
        let [named] = said_before.objects.as_slice() else { return };
        if !matches!(named.head, Head::Noun(_) | Head::Named(_)) {
            return;
        }
        let places = self.places.iter_mut().map(|place| &mut place.phrase);
        for phrase in self.objects.iter_mut().chain(places) {
            if phrase.head == (Head::Pronoun { plural: false }) {
                phrase.clone_from(named);
            }
        }
    }

    /// "make sure no drawer is open": every one is not; "open no drawer": do not.
    pub fn deny(&mut self) {
        self.negated |= self.complement.is_empty();
        for value in self.complement.values_mut() {
            *value = super::opposite(value);
        }
        for phrase in &mut self.objects {
            phrase.quantity = Quantity::All;
        }
    }
}

const FUNCTION_WORDS: [&str; 99] = [
    "plus",
    "a",
    "an",
    "the",
    "this",
    "that",
    "these",
    "those",
    "my",
    "your",
    "our",
    "his",
    "her",
    "their",
    "its",
    "it",
    "them",
    "they",
    "him",
    "me",
    "you",
    "we",
    "us",
    "i",
    "and",
    "or",
    "but",
    "then",
    "if",
    "so",
    "when",
    "once",
    "until",
    "while",
    "before",
    "after",
    "as",
    "is",
    "are",
    "be",
    "was",
    "were",
    "been",
    "being",
    "am",
    "do",
    "does",
    "did",
    "dont",
    "not",
    "no",
    "never",
    "all",
    "both",
    "each",
    "every",
    "any",
    "some",
    "another",
    "other",
    "others",
    "rest",
    "of",
    "except",
    "than",
    "either",
    "one",
    "ones",
    "which",
    "who",
    "what",
    "where",
    "there",
    "here",
    "have",
    "has",
    "had",
    "can",
    "could",
    "will",
    "would",
    "shall",
    "should",
    "may",
    "might",
    "must",
    "let",
    "without",
    "everything",
    "anything",
    "nothing",
    "something",
    "thing",
    "things",
    "few",
    "several",
    "couple",
    "containing",
    "'s",
];

/// Whether a word belongs to a closed class.
pub fn is_function_word(word: &str) -> bool {
    FUNCTION_WORDS.contains(&word) || preposition(&[word]).is_some() || is_filler(word)
}

fn is_filler(word: &str) -> bool {
    ["back", "away", "out", "down", "up", "also", "together", "holding", "placed", "sitting", "located"]
        .contains(&word)
}

/// Words that open a noun phrase.
pub fn is_determiner(word: &str) -> bool {
    [
        "a", "an", "the", "this", "that", "these", "those", "my", "your", "our", "his", "her", "their",
        "its", "all", "both", "each", "every", "any", "some", "another", "other", "several", "few",
    ]
    .contains(&word)
}
