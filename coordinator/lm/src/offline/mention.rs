//! From noun phrases to things of the scene: new ones, ones spoken of before, and classes of them.

use std::collections::BTreeSet;

use super::lexicon::{Lexicon, Noun, Settings};
use super::scene::{Scene, is_in_state};
use super::syntax::{Head, Phrase, Place, Quantity};
use crate::{Ban, ObjectView};

pub use confidence::Confidence;

/// Which objects of its type an entity is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Which {
    /// Any one.
    Any,
    /// Every one.
    All,
    /// This one.
    Named(String),
}

/// Something spoken of.
#[derive(Clone, Debug)]
pub struct Entity {
    /// The types it may be, the likelier first.
    pub kinds: Vec<String>,
    /// Which of them.
    pub which: Which,
    /// In words.
    pub text: String,
    /// The noun it was named by.
    pub noun: String,
    /// States the words ask for.
    pub asked: Settings,
    /// What the words say it holds.
    pub holds: Vec<usize>,
}

impl Entity {
    /// The type it is taken to be.
    pub fn kind(&self) -> &str {
        self.kinds.first().map(String::as_str).unwrap_or_default()
    }
}

/// What a clause spoke of.
#[derive(Clone, Debug, Default)]
pub struct Spoken {
    /// What it was done to.
    pub objects: Vec<usize>,
    /// Where it went.
    pub places: Vec<usize>,
    /// The clause put the objects in the places.
    pub placed: bool,
    /// Where one went.
    pub reached: Vec<usize>,
}

/// Everything spoken of so far, and what was taken for granted or not understood.
pub struct Discourse<'a> {
    pub(super) lexicon: &'a Lexicon,
    pub(super) scene: &'a Scene<'a>,
    /// The things.
    pub entities: Vec<Entity>,
    /// By clause.
    pub spoken: Vec<Spoken>,
    /// Taken for granted.
    pub assumptions: Vec<String>,
    /// Not understood, or not possible here.
    pub problems: Vec<String>,
    /// How sure the reading is.
    pub confidence: Confidence,
    /// What must not be done on the way.
    pub bans: Vec<Ban>,
    /// What is switched, and by what.
    pub(super) controls: Vec<(usize, usize)>,
}

impl<'a> Discourse<'a> {
    /// Nothing spoken of yet.
    pub fn new(lexicon: &'a Lexicon, scene: &'a Scene<'a>) -> Self {
        Self {
            lexicon,
            scene,
            entities: Vec::new(),
            spoken: Vec::new(),
            assumptions: Vec::new(),
            problems: Vec::new(),
            confidence: Confidence::default(),
            bans: Vec::new(),
            controls: Vec::new(),
        }
    }

    /// Notes a problem and what it costs.
    pub fn problem(&mut self, text: String, factor: f64) {
        if !self.problems.contains(&text) {
            self.problems.push(text);
            self.confidence.doubt(factor);
        }
    }

    /// Notes something taken for granted and what it costs.
    pub fn assume(&mut self, text: String, factor: f64) {
        if !self.assumptions.contains(&text) {
            self.assumptions.push(text);
            self.confidence.assume(factor);
        }
    }

    /// The things a phrase names; `at` says where they are, `wants` what they must afford.
    pub fn mention(&mut self, phrase: &Phrase, at: &[Place], wants: Option<&str>) -> Vec<usize> {
        let found = match &phrase.head {
            Head::Noun(noun) => self.noun(noun, phrase, at, wants),
            Head::Named(name) => self.named(name),
            Head::Pronoun { .. } if phrase.text.starts_with("the former") => self.some_of_these(phrase, true),
            Head::Pronoun { .. } if phrase.text.starts_with("the latter") => {
                self.some_of_these(phrase, false)
            }
            Head::Pronoun { .. } if phrase.other || matches!(phrase.quantity, Quantity::Count(_)) => {
                self.some_of_them(phrase, wants)
            }
            Head::Pronoun { plural: true } if phrase.text.starts_with("one of") => {
                self.one_of_them(wants).into_iter().collect()
            }
            Head::Pronoun { plural: true } if ["each", "all"].contains(&first_word(&phrase.text)) => {
                self.all_of_them(wants)
            }
            Head::Pronoun { .. } if phrase.text == "there" && self.last_place().is_some() => {
                self.last_place().into_iter().collect()
            }
            Head::Pronoun { .. } if is_all_of_it(&phrase.text) => self.all_of_it(wants),
            Head::Pronoun { plural } => {
                let found = self.pronoun(*plural, wants);
                // "take the cup, the pan and the pot; put one in the sink": no matter which is not said.
                if phrase.text == "one" && found.len() > 1 {
                    self.problem("it is not said which of them is meant".to_owned(), 0.3);
                }
                found
            }
            Head::Slices => self.slices(matches!(phrase.quantity, Quantity::Plural | Quantity::All)),
            Head::Everything => self.everything(phrase, at, wants),
            // "the door", "the lid": of what was spoken of.
            Head::Room if wants == Some("openable") => self.pronoun(false, wants),
            Head::Liquid(_) | Head::Room => Vec::new(),
            Head::Unknown(word) => {
                self.problem(format!("I do not know what \"{word}\" is"), 0.25);
                Vec::new()
            }
        };
        let contents: Vec<usize> =
            if found.len() == 1 { self.contents(found[0], &phrase.with) } else { Vec::new() };
        for &entity in &found {
            if let (Head::Noun(noun), true) = (&phrase.head, self.entities[entity].noun.is_empty()) {
                self.entities[entity].noun.clone_from(&noun.word);
            }
            self.entities[entity].asked.extend(phrase.states.clone());
            if wants == Some("pickupable") && self.is_to_be_full(entity, phrase) {
                self.assume(format!("\"{}\" is filled with water", phrase.text), 0.9);
                self.entities[entity].asked.extend(filled("water"));
            }
            if let Some(liquid) = phrase.with.iter().find_map(Phrase::liquid)
                && self.scene.affords(self.entities[entity].kind(), "canFillWithLiquid")
            {
                self.entities[entity].asked.extend(filled(liquid));
            }
            for &content in &contents {
                if !self.entities[entity].holds.contains(&content) {
                    self.entities[entity].holds.push(content);
                }
            }
        }
        found
    }

    /// What "with …" or "of …" says a thing holds; phrases it cannot hold say nothing.
    fn contents(&mut self, holder: usize, with: &[Phrase]) -> Vec<usize> {
        let mut found = Vec::new();
        for phrase in with {
            if let Head::Liquid(_) = phrase.head {
                continue;
            }
            let Head::Noun(noun) = &phrase.head else { continue };
            if phrase.liquid().is_some() {
                continue;
            }
            let holders = self.entities[holder].kinds.clone();
            let scene = self.scene;
            let fitting: Vec<String> = holders
                .iter()
                .filter(|kind| {
                    scene.affords(kind, "pickupable")
                        && noun.kinds.iter().any(|content| scene.accepts(kind, content))
                })
                .cloned()
                .collect();
            if fitting.is_empty() {
                continue;
            }
            let mut narrowed = phrase.clone();
            narrowed.indefinite |= phrase.quantity == Quantity::One && !phrase.definite;
            let kinds = self.lexicon.inside(&noun.word, &fitting[0]).unwrap_or(&noun.kinds);
            narrowed.head = Head::Noun(Noun {
                kinds: kinds
                    .iter()
                    .filter(|content| {
                        scene.has(content) && fitting.iter().any(|kind| scene.accepts(kind, content))
                    })
                    .cloned()
                    .collect(),
                ..noun.clone()
            });
            if phrase.quantity == Quantity::Plural || phrase.quantity == Quantity::All {
                narrowed.quantity = Quantity::Plural;
            }
            self.entities[holder].kinds = fitting;
            found.extend(self.mention(&narrowed, &[], None));
        }
        found
    }

    pub(super) fn add(&mut self, kinds: Vec<String>, which: Which, text: &str) -> usize {
        self.entities.push(Entity {
            kinds,
            which,
            text: text.to_owned(),
            noun: String::new(),
            asked: Settings::new(),
            holds: Vec::new(),
        });
        self.entities.len() - 1
    }

    fn named(&mut self, name: &str) -> Vec<usize> {
        if let Some(known) =
            self.entities.iter().position(|entity| entity.which == Which::Named(name.to_owned()))
        {
            return vec![known];
        }
        match self.scene.named(name) {
            Some(object) => vec![self.add(vec![object.kind.clone()], Which::Named(name.to_owned()), name)],
            None => Vec::new(),
        }
    }

    fn noun(&mut self, noun: &Noun, phrase: &Phrase, at: &[Place], wants: Option<&str>) -> Vec<usize> {
        if noun.word == "water" && wants != Some("toggleable") {
            self.problem("it is not said what the water is to be in".to_owned(), 0.3);
            return Vec::new();
        }
        // "every light" means all that "lights" means.
        let lexicon = self.lexicon;
        let plural = |ending: &str| super::lexicon::squash(&format!("{}{ending}", noun.word));
        let all = ["s", "es"]
            .iter()
            .filter_map(|ending| lexicon.noun(&[&plural(ending)]))
            .find(|(noun, _)| noun.class);
        let noun = match all {
            Some((all, _)) if phrase.quantity == Quantity::All && all.class => all,
            _ => noun,
        };
        if let Some(known) = self.spoken_of_before(noun, phrase) {
            return known;
        }
        let mut kinds: Vec<String> = noun.kinds.iter().filter(|kind| self.scene.has(kind)).cloned().collect();
        if kinds.is_empty() {
            kinds = self.nearest_kinds(noun);
            if let Some(kind) = kinds.first() {
                self.assume(format!("there is no {} here; a {kind} is taken for it", noun.word), 0.8);
            }
        }
        if kinds.is_empty() && wants == Some("openable") && self.lexicon.is_small("parts", &[&noun.word]) {
            // "open its lid": of what was spoken of.
            return self.pronoun(false, wants);
        }
        if kinds.is_empty() {
            self.problem(format!("there is no {} here", noun.word), 0.2);
            return Vec::new();
        }
        if let (false, Some(own)) = (noun.class, noun.kinds.first())
            && *own != kinds[0]
            && super::lexicon::squash(own) == super::lexicon::squash(&noun.word)
        {
            self.assume(format!("there is no {} here; a {} is taken for it", noun.word, kinds[0]), 0.9);
        }
        if let Some(wants) = wants {
            let able: Vec<String> = kinds.iter().filter(|kind| self.affords(kind, wants)).cloned().collect();
            if !able.is_empty() {
                kinds = able;
            }
        }
        let except = self.exceptions(&phrase.except);
        kinds.retain(|kind| !except.contains(kind.as_str()));
        if noun.class
            && !phrase.other
            && let Some(known) = self.members_spoken_of(noun, phrase)
        {
            return known;
        }
        if noun.class && phrase.other {
            // "the rest of the dishes": without those spoken of.
            kinds = self.without_those_spoken_of(kinds);
        }
        if noun.class {
            return self.class(noun, &kinds, phrase, at);
        }
        match phrase.quantity {
            Quantity::All if phrase.other => {
                let kind = kinds.first().cloned().unwrap_or_default();
                let named = self.entities.iter().filter(|entity| entity.kind() == kind).count();
                let left = self.scene.of_kind(&kind).len().saturating_sub(named);
                self.several(&[kind], left, phrase, at)
            }
            Quantity::One => vec![self.one(kinds, phrase, at)],
            Quantity::Count(count) => self.several(&kinds, count, phrase, at),
            Quantity::Plural => {
                let most = kinds.iter().map(|kind| self.scene.of_kind(kind).len()).max().unwrap_or(1);
                self.several(&kinds, most.min(2), phrase, at)
            }
            Quantity::All => {
                // "the towels": of what the word may mean, that of which there are several.
                if wants != Some("receptacle") {
                    kinds.sort_by_key(|kind| self.scene.of_kind(kind).len() < 2);
                }
                self.every(&kinds[..1.min(kinds.len())], phrase, at)
            }
        }
    }

    /// What is here of what is meant by the last word alone ("white table": a table), or of what people call
    /// so where there is none ("dresser": a sideboard).
    fn nearest_kinds(&self, noun: &Noun) -> Vec<String> {
        let here = |kinds: &[String]| -> Vec<String> {
            kinds.iter().filter(|kind| self.scene.has(kind)).cloned().collect()
        };
        let last = noun.word.rsplit_once(' ').and_then(|(_, last)| self.lexicon.noun(&[last]));
        let same = last.filter(|(last, _)| last.kinds.first().is_some_and(|kind| noun.kinds.contains(kind)));
        let by_last_word = same.map(|(noun, _)| here(&noun.kinds)).unwrap_or_default();
        if !by_last_word.is_empty() || noun.class {
            return by_last_word;
        }
        noun.kinds
            .iter()
            .map(|kind| here(self.lexicon.likes(kind)))
            .find(|k| !k.is_empty())
            .unwrap_or_default()
    }

    pub(super) fn affords(&self, kind: &str, affordance: &str) -> bool {
        self.scene.affords(kind, affordance)
            || (affordance == "toggleable" && self.lexicon.control(kind).is_some_and(|c| self.scene.has(c)))
    }

    /// The same words again mean the same thing, unless they say "another" or "a".
    fn spoken_of_before(&self, noun: &Noun, phrase: &Phrase) -> Option<Vec<usize>> {
        let sliced_again = phrase.states.contains_key("isSliced")
            && self.entities.iter().any(|e| e.asked.contains_key("isSliced") && names(noun, e, self.scene));
        if phrase.other
            || noun.class && phrase.quantity != Quantity::One && !phrase.definite
            || (phrase.indefinite && !sliced_again)
            || !sliced_again && matches!(phrase.quantity, Quantity::Count(_) | Quantity::Plural)
        {
            return None;
        }
        for spoken in self.spoken.iter().rev() {
            for group in [&spoken.objects, &spoken.places] {
                let known: Vec<usize> =
                    group.iter().copied().filter(|&e| names(noun, &self.entities[e], self.scene)).collect();
                let wanted_one = phrase.quantity == Quantity::One && known.len() == 1;
                let wanted_all = phrase.quantity == Quantity::All && phrase.definite && known.len() > 1;
                if wanted_one || wanted_all {
                    return Some(known);
                }
            }
        }
        None
    }

    /// Types and names that "except …" takes out.
    fn exceptions(&self, except: &[Phrase]) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for phrase in except {
            match &phrase.head {
                Head::Noun(noun) if noun.kinds.iter().any(|kind| several::spared(phrase, kind).is_some()) => {
                }
                Head::Noun(noun) if !noun.class => {
                    let here = noun.kinds.iter().find(|kind| self.scene.has(kind));
                    found.extend(here.or(noun.kinds.first()).cloned());
                }
                Head::Noun(noun) => found.extend(noun.kinds.iter().cloned()),
                Head::Named(name) => {
                    found.insert(name.clone());
                }
                _ => {}
            }
        }
        found
    }

    fn one(&mut self, kinds: Vec<String>, phrase: &Phrase, at: &[Place]) -> usize {
        let selected = self.selected(&kinds, phrase, at);
        let taken: BTreeSet<String> = self
            .entities
            .iter()
            .filter_map(|e| if let Which::Named(name) = &e.which { Some(name.clone()) } else { None })
            .collect();
        if let Some(object) = selected.iter().find(|object| !taken.contains(&object.name)) {
            let (kind, name) = (object.kind.clone(), object.name.clone());
            self.assume(format!("\"{}\" is {name}", phrase.text), 1.0);
            return self.add(vec![kind], Which::Named(name), &phrase.text);
        }
        self.add(kinds, Which::Any, &phrase.text)
    }

    /// The objects of the first of the types that words or places pick out; empty when they pick out none
    /// or do not tell objects apart.
    fn selected(&self, kinds: &[String], phrase: &Phrase, at: &[Place]) -> Vec<&'a ObjectView> {
        for kind in kinds {
            let all = self.scene.of_kind(kind);
            if all.len() < 2 {
                continue;
            }
            let fits = |object: &&&ObjectView| {
                is_in_state(object, &phrase.selects)
                    && (!phrase.definite
                        || is_in_state(object, &phrase.states)
                        || phrase.states.contains_key("isDirty"))
                    && phrase.at.iter().chain(at).all(|place| self.is_at(object, place))
            };
            let some: Vec<&ObjectView> = all.iter().filter(fits).copied().collect();
            if !some.is_empty() && some.len() < all.len() {
                return some;
            }
        }
        Vec::new()
    }

    /// Whether an object is where a phrase says, as far as it can be told.
    pub fn is_at(&self, object: &ObjectView, place: &Place) -> bool {
        match &place.phrase.head {
            Head::Noun(noun) => {
                // A table is no counter where there is one.
                let mut here = noun.kinds.iter().filter(|kind| self.scene.has(kind)).peekable();
                let most = if noun.word == "counter" { 1 } else { noun.kinds.len() };
                here.peek().is_none()
                    || here.take(most).any(|kind| self.scene.lies_in(object, &|parent| parent.kind == *kind))
            }
            Head::Named(name) => self.scene.lies_in(object, &|parent| parent.name == *name),
            _ => true,
        }
    }
}

fn first_word(text: &str) -> &str {
    text.split(' ').next().unwrap_or_default()
}

/// "it all", "all of that": whatever was spoken of.
fn is_all_of_it(text: &str) -> bool {
    ["it all", "that all", "this all", "all of it", "all of that", "all of this", "all that", "all this"]
        .contains(&text)
}

/// The states of what is full of a liquid.
pub fn filled(liquid: &str) -> Settings {
    let word = lamma_domains::goal::PropertyValue::Word(liquid.to_owned());
    Settings::from([("isFilledWithLiquid".to_owned(), super::yes()), ("fillLiquid".to_owned(), word)])
}

/// Whether a noun would be taken for the type that an entity is taken for.
fn names(noun: &Noun, entity: &Entity, scene: &Scene<'_>) -> bool {
    if noun.class {
        return noun.kinds.iter().any(|kind| kind == entity.kind());
    }
    let first = noun.kinds.iter().find(|kind| scene.has(kind));
    first.is_some_and(|first| first == entity.kind())
        || entity.noun == noun.word && noun.kinds.iter().any(|kind| kind == entity.kind())
}

mod confidence;
mod fitting;
mod naming;
mod reference;
mod several;
