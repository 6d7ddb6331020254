//! Knowledge as data: nouns, verbs, adjectives and small words, read from TOML and extensible by a user's
//! file.
//!
//! Every phrase is filed under its letters alone ("cell phone", "cellphone" and "CellPhone" are one key),
//! which is how compounds are joined and split.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;
use std::path::Path;
use std::sync::OnceLock;

use lamma_domains::goal::PropertyValue;
use serde::Deserialize;

use super::inflect::{self, VerbForm};
use super::sense::Senses;
use super::situation::{self, Situation};
use super::spelling::Spelling;
use super::trigger::{Said, Trigger, TriggerWords};
use crate::LmError;

/// The list of words that are no slips of the pen, and mean nothing here.
pub const DICTIONARY: &str = "dictionary";

/// The longest phrase the lexicon looks for, in words.
pub const LONGEST: usize = 6;

/// Properties and the values they take.
pub type Settings = BTreeMap<String, PropertyValue>;

/// What a verb does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    /// The object ends where the sentence says.
    Place,
    /// The object ends where such things are kept.
    Store,
    /// The object ends in the rubbish.
    Discard,
    /// The object ends in a hand.
    Hold,
    /// The object is held in the light of a lamp.
    Examine,
    /// The object gets cold.
    Chill,
    /// The object gets hot.
    Heat,
    /// The object gets cooked.
    Cook,
    /// The object gets the verb's properties.
    Set,
    /// The object gets filled.
    Fill,
    /// The object loses its liquid.
    Empty,
    /// The liquid goes into the place.
    Pour,
    /// Nothing but a way to go.
    Go,
    /// A state is to hold.
    Keep,
    /// An instrument is named.
    Use,
}

/// A verb's effect schema.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Verb {
    /// Its forms, with their particles.
    pub words: Vec<String>,
    /// What it does.
    pub act: Act,
    /// The properties that hold afterwards.
    #[serde(default)]
    pub set: Settings,
    /// Types that a phrase may name as the instrument.
    #[serde(default)]
    pub tools: Vec<String>,
    /// An affordance the object must have.
    #[serde(default)]
    pub wants: Option<String>,
    /// Where the object goes when the sentence does not say.
    #[serde(default)]
    pub default: Vec<String>,
    /// The device the verb names.
    #[serde(default)]
    pub device: Option<String>,
}

/// An adjective that names a state.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adjective {
    /// Its forms.
    pub words: Vec<String>,
    /// The state it names.
    pub set: Settings,
    /// It picks a thing out and asks for nothing.
    #[serde(default)]
    pub selects: bool,
}

/// What a noun may stand for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Noun {
    /// The phrase it is filed under.
    pub word: String,
    /// Object types: alternatives, the likelier first, or the members of a class.
    pub kinds: Vec<String>,
    /// Whether the types are members of a class rather than alternatives.
    pub class: bool,
}

/// What things of some types are for or like.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Use {
    /// Sets of words that must all be there, as those of a situation.
    pub when: Vec<String>,
    /// What is meant, the likelier first.
    pub kinds: Vec<String>,
    /// It is said of a place.
    #[serde(default)]
    pub place: bool,
    /// `when`, as it is tried.
    #[serde(skip)]
    pub triggers: Vec<Trigger>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    types: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    words: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    classes: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    verb: Vec<Verb>,
    #[serde(default)]
    adjective: Vec<Adjective>,
    #[serde(default)]
    small: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    situation: Vec<Situation>,
    #[serde(default, rename = "use")]
    uses: Vec<Use>,
    #[serde(default)]
    controls: BTreeMap<String, String>,
    #[serde(default)]
    homes: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    under: BTreeMap<String, String>,
    #[serde(default)]
    stands: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    inside: BTreeMap<String, BTreeMap<String, Vec<String>>>,
    #[serde(default)]
    likes: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    senses: Senses,
}

/// The lexicon.
#[derive(Clone, Debug, Default)]
pub struct Lexicon {
    nouns: BTreeMap<String, Noun>,
    verbs: Vec<Verb>,
    /// First word of a verb -> (particles, verb), in the order of the files.
    verb_index: BTreeMap<String, Vec<(Vec<String>, usize)>>,
    adjectives: BTreeMap<String, Adjective>,
    small: BTreeMap<String, BTreeSet<String>>,
    situations: Vec<Situation>,
    uses: Vec<Use>,
    controls: BTreeMap<String, String>,
    homes: BTreeMap<String, Vec<String>>,
    under: BTreeMap<String, String>,
    stands: BTreeMap<String, Vec<String>>,
    inside: BTreeMap<String, BTreeMap<String, Vec<String>>>,
    likes: BTreeMap<String, Vec<String>>,
    senses: Senses,
    vocabulary: BTreeSet<String>,
    trigger_words: TriggerWords,
    /// The vocabulary that a strange word may be a slip for, and the verbs of one word, once somebody has asked.
    spelling: OnceLock<Spelling>,
    bare_verbs: OnceLock<Spelling>,
}

impl Lexicon {
    /// The lexicon that is built in.
    pub fn embedded() -> Result<Self, LmError> {
        let mut lexicon = Self::default();
        for (name, text) in FILES {
            lexicon.extend(&format!("the built-in lexicon ({name})"), text)?;
        }
        Ok(lexicon)
    }

    /// A lexicon that takes the place of the one built in: the files of a folder.
    pub fn from_folder(folder: &Path) -> Result<Self, LmError> {
        let mut lexicon = Self::default();
        for (name, _) in FILES {
            let path = folder.join(name);
            let text = std::fs::read_to_string(&path).map_err(|error| {
                LmError::Configuration(format!("cannot read the lexicon {}: {error}", path.display()))
            })?;
            lexicon.extend(&path.display().to_string(), &text)?;
        }
        Ok(lexicon)
    }

    /// Adds a file's entries; where they disagree with what is there, the file wins.
    pub fn extend(&mut self, name: &str, text: &str) -> Result<(), LmError> {
        let file: File = toml::from_str(text).map_err(|error| {
            LmError::Configuration(format!("{name}: {error}; see the tables of the built-in lexicon"))
        })?;
        for (kind, words) in file.types {
            self.add_type(&kind);
            for word in words {
                self.add_noun(&word, vec![kind.clone()], false);
            }
        }
        for (word, kinds) in file.words {
            self.add_noun(&word, kinds, false);
        }
        for (word, kinds) in file.classes {
            self.add_noun(&word, kinds, true);
        }
        for verb in file.verb {
            self.add_verb(verb);
        }
        for adjective in file.adjective {
            for word in &adjective.words {
                self.learn(word);
                self.adjectives.insert(squash(word), adjective.clone());
            }
        }
        for (list, words) in file.small {
            for word in words {
                if list != DICTIONARY {
                    self.learn(&word);
                }
                self.small.entry(list.clone()).or_default().insert(squash(&word));
            }
        }
        self.controls.extend(file.controls);
        self.homes.extend(file.homes);
        self.under.extend(file.under);
        self.stands.extend(file.stands);
        self.inside.extend(file.inside);
        self.likes.extend(file.likes);
        self.senses.extend(file.senses);
        for mut situation in file.situation {
            self.vocabulary.extend(situation::vocabulary(&situation.patterns()));
            situation.learn_triggers(&mut self.trigger_words);
            self.situations.push(situation);
        }
        for mut usage in file.uses {
            self.vocabulary.extend(situation::vocabulary(&usage.when));
            usage.triggers = usage.when.iter().map(|when| self.trigger_words.trigger(when)).collect();
            self.uses.push(usage);
        }
        (self.spelling, self.bare_verbs) = Default::default();
        Ok(())
    }

    /// Whether a type is known by its own name.
    pub fn knows_type(&self, kind: &str) -> bool {
        self.nouns.contains_key(&squash(kind))
    }

    /// Makes a type known by its own name, unless the name has a meaning already.
    pub fn add_type(&mut self, kind: &str) {
        let phrase = split_camel_case(kind);
        if !self.nouns.contains_key(&squash(&phrase)) {
            self.add_noun(&phrase, vec![kind.to_owned()], false);
        }
    }

    fn add_noun(&mut self, word: &str, kinds: Vec<String>, class: bool) {
        self.learn(word);
        self.nouns.insert(squash(word), Noun { word: word.to_owned(), kinds, class });
    }

    fn add_verb(&mut self, verb: Verb) {
        let index = self.verbs.len();
        for phrase in &verb.words {
            let mut words = phrase.split_whitespace().map(str::to_owned);
            if let Some(first) = words.next() {
                self.verb_index.entry(first).or_default().push((words.collect(), index));
            }
        }
        for phrase in verb.words.clone() {
            self.learn(&phrase);
        }
        self.verbs.push(verb);
    }

    fn learn(&mut self, phrase: &str) {
        self.vocabulary.extend(phrase.split_whitespace().map(str::to_lowercase));
    }

    /// The noun these words write, and whether they are a plural of it.
    pub fn noun(&self, words: &[&str]) -> Option<(&Noun, bool)> {
        let joined = words.concat();
        if let Some(noun) = self.nouns.get(&joined) {
            return Some((noun, self.looks_plural(&joined)));
        }
        let (last, front) = words.split_last()?;
        let front = front.concat();
        inflect::singulars(last)
            .iter()
            .find_map(|singular| self.nouns.get(&format!("{front}{singular}")))
            .or_else(|| {
                // "credits cards": plural all over.
                let all: Option<Vec<String>> =
                    words.iter().map(|word| inflect::singulars(word).into_iter().next()).collect();
                all.filter(|all| all.len() > 1).and_then(|all| self.nouns.get(&all.concat()))
            })
            .or_else(|| {
                // "bottles of soap"
                let [measure, "of", ..] = words else { return None };
                let of = words[1..].concat();
                let singulars = inflect::singulars(measure);
                let mut whole = singulars.iter().filter(|s| !self.is_small("slices", &[s.as_str()]));
                whole.find_map(|singular| self.nouns.get(&format!("{singular}{of}")))
            })
            .map(|noun| (noun, true))
    }

    /// Whether a word that has an entry of its own is the plural of another entry ("curtains", "lights").
    fn looks_plural(&self, joined: &str) -> bool {
        let entry = self.nouns.get(joined);
        entry.is_some_and(|noun| noun.class && joined.ends_with('s') && !joined.ends_with("ss"))
            || inflect::singulars(joined).iter().any(|s| {
                self.nouns.get(s).is_some_and(|single| entry.is_none_or(|e| e.kinds != single.kinds))
            })
    }

    /// The verbs a word may begin, with their particles, the particle-rich first.
    pub fn verbs(&self, word: &str) -> Vec<(VerbForm, &[String], &Verb)> {
        let mut found: Vec<(VerbForm, &[String], &Verb)> = Vec::new();
        for (base, form) in inflect::bases(word) {
            for (particles, index) in self.verb_index.get(&base).map(Vec::as_slice).unwrap_or_default() {
                found.push((form, particles, &self.verbs[*index]));
            }
        }
        found.sort_by_key(|(_, particles, _)| std::cmp::Reverse(particles.len()));
        found
    }

    /// The verb of one word that is one letter away from a word: the one of the same first letter before others.
    pub fn near_verb(&self, word: &str) -> Option<(&str, Vec<&Verb>)> {
        let first = word.chars().next();
        let bare_verbs = self.bare_verbs.get_or_init(|| {
            let verbs = self.verb_index.iter();
            let bare = verbs.filter(|(_, verbs)| verbs.iter().any(|(particles, _)| particles.is_empty()));
            Spelling::of(bare.map(|(base, _)| base.as_str()))
        });
        let found = bare_verbs.one_edit_away(word);
        let common = |base: &str| self.is_small("common", &[base]);
        let best = found.min_by_key(|base| (!common(base), base.chars().next() != first, base.len()))?;
        let known = self.verb_index.get(best).map(Vec::as_slice).unwrap_or_default();
        let bare = known.iter().filter(|(particles, _)| particles.is_empty());
        Some((best, bare.map(|(_, index)| &self.verbs[*index]).collect()))
    }

    /// The state an adjective names.
    pub fn adjective(&self, words: &[&str]) -> Option<&Adjective> {
        self.adjectives.get(&words.concat())
    }

    /// Whether the words are in one of the lists of small words.
    pub fn is_small(&self, list: &str, words: &[&str]) -> bool {
        self.small.get(list).is_some_and(|known| known.contains(&words.concat()))
    }

    /// The longest entry of a list of small words at the start of `words`, in words.
    pub fn longest_small(&self, list: &str, words: &[&str]) -> Option<usize> {
        let known = self.small.get(list)?;
        let joined = words[..LONGEST.min(words.len())].concat();
        // No entry starts like it: most words are in none of the lists.
        let start = joined.chars().next()?;
        let near =
            known.range::<str, _>((Bound::Included(&joined[..start.len_utf8()]), Bound::Unbounded)).next();
        near.filter(|entry| entry.starts_with(start))?;
        let mut end = joined.len();
        for length in (1..=LONGEST.min(words.len())).rev() {
            if known.contains(&joined[..end]) {
                return Some(length);
            }
            end -= words[length - 1].len();
        }
        None
    }

    /// What switches a thing that has no switch of its own.
    pub fn control(&self, kind: &str) -> Option<&str> {
        self.controls.get(kind).map(String::as_str)
    }

    /// Where things of a type are kept, the likelier first.
    pub fn homes(&self, kind: &str) -> impl Iterator<Item = &str> {
        let own = self.homes.get(kind).into_iter().flatten();
        own.chain(self.homes.get("anything").into_iter().flatten()).map(String::as_str)
    }

    /// What a word means for something in or on a vessel of a type.
    pub fn inside(&self, word: &str, vessel: &str) -> Option<&[String]> {
        self.inside.get(word)?.get(vessel).map(Vec::as_slice)
    }

    /// What is called by a type's name where there is none of the type, the likelier first.
    pub fn likes(&self, kind: &str) -> &[String] {
        self.likes.get(kind).map(Vec::as_slice).unwrap_or_default()
    }

    /// What speaks for which type of a loose noun.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// What is meant by "under" a thing.
    pub fn under(&self, kind: &str) -> Option<&str> {
        self.under.get(kind).map(String::as_str)
    }

    /// The surfaces something may stand on "beside" a thing of a type, the likelier first.
    pub fn beside(&self, kind: Option<&str>) -> impl Iterator<Item = &str> {
        let own = kind.and_then(|kind| self.stands.get(kind)).into_iter().flatten();
        own.chain(self.homes.get("beside").into_iter().flatten()).map(String::as_str)
    }

    /// The situations.
    pub fn situations(&self) -> &[Situation] {
        &self.situations
    }

    /// What things are for.
    pub fn uses(&self) -> &[Use] {
        &self.uses
    }

    /// Which words of triggers some words say.
    pub fn said(&self, words: &[String]) -> Said {
        self.trigger_words.said(words)
    }

    /// The words that a strange one may be a slip for.
    pub fn spelling(&self) -> &Spelling {
        self.spelling.get_or_init(|| {
            let misspellable =
                |known: &&str| !["real", "people"].iter().any(|list| self.is_small(list, &[known]));
            let words = self.vocabulary.iter().map(String::as_str).filter(misspellable);
            Spelling::with_common(words, |word| self.is_small("common", &[word]))
        })
    }

    /// The words it knows.
    pub fn vocabulary(&self) -> &BTreeSet<String> {
        &self.vocabulary
    }
}

mod filing;

use filing::FILES;
pub use filing::{split_camel_case, squash};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_lexicon_reads() {
        let lexicon = Lexicon::embedded().unwrap();
        assert_eq!(lexicon.noun(&["cell", "phones"]).unwrap().0.kinds, ["CellPhone"]);
        assert!(lexicon.noun(&["cellphones"]).unwrap().1);
        assert_eq!(lexicon.noun(&["baseballbat"]).unwrap().0.kinds, ["BaseballBat"]);
        assert!(lexicon.noun(&["knives"]).unwrap().1);
        assert!(!lexicon.noun(&["keys"]).unwrap().1);
        assert!(lexicon.verbs("washed").iter().any(|(form, _, _)| *form == VerbForm::Past));
    }

    #[test]
    fn a_users_file_wins_and_a_wrong_one_says_where() {
        let mut lexicon = Lexicon::embedded().unwrap();
        lexicon.extend("mine", "[types]\nGadget3000 = [\"thingamajig\"]").unwrap();
        assert_eq!(lexicon.noun(&["thingamajig"]).unwrap().0.kinds, ["Gadget3000"]);
        let error = lexicon.extend("mine", "[tpyes]\n").unwrap_err().to_string();
        assert!(error.contains("mine") && error.contains("tpyes"), "{error}");
    }
}
