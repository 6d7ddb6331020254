//! Which of its types a loose noun means ("cup": a cup or a mug), by the words around it. What speaks for which was
//! learned from crowd-written sentences; `domains/household/lexicon/senses.toml` says how. It only orders what the
//! lexicon allows and the scene has.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::lexicon::{Lexicon, Noun, squash};
use super::phrase::NounAt;
use super::scene::Scene;
use super::{Offline, plain};
use crate::Request;

/// How much it counts that a noun is a type's own name, in tenths of a natural logarithm. Those who know what the
/// scene calls things mean what they say, so it is more than what crowd writers, who only see them, would make of it.
const OWN_NAME: i32 = 50;

/// Words farther away say nothing.
const REACH: usize = 20;

/// Words that say where, if they stand this near before the noun.
const PREPOSITIONS: [&str; 12] =
    ["on", "in", "from", "into", "to", "under", "with", "onto", "inside", "off", "by", "of"];
const PREPOSITION_REACH: usize = 4;

/// Types that tell what room it is: what a table is in a kitchen, it is not by a bed.
const TELL_THE_ROOM: [&str; 4] = ["Fridge", "Toilet", "Bed", "Sofa"];

/// What speaks for a type, in tenths of a natural logarithm.
type Weights = BTreeMap<String, i32>;

/// What was learned.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Senses {
    /// Type -> words around the noun, and types of [`TELL_THE_ROOM`].
    near: BTreeMap<String, Weights>,
    /// Noun -> type -> clues right before the noun, or [`Clues::ALWAYS`]. A noun that is not here was not learned.
    before: BTreeMap<String, BTreeMap<String, Weights>>,
}

/// What is said around a noun.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Clues {
    /// The words in reach, in lower case, and what tells the room.
    pub near: BTreeSet<String>,
    /// The two words before it, and the nearest preposition before it as `on_`.
    pub before: BTreeSet<String>,
}

impl Clues {
    /// What holds wherever the noun is said.
    pub const ALWAYS: &'static str = "_";

    fn around(words: &[String], at: usize, length: usize) -> Self {
        let end = (at + length).min(words.len());
        let front = &words[at.saturating_sub(REACH)..at];
        let behind = &words[end..(end + REACH).min(words.len())];
        let near = front.iter().chain(behind).cloned().collect();
        let is_preposition = |word: &&String| PREPOSITIONS.contains(&word.as_str());
        let two = front.iter().rev().take(2).filter(|word| !is_preposition(word));
        let mut before: BTreeSet<String> = two.cloned().collect();
        let nearest = front.iter().rev().take(PREPOSITION_REACH).find(is_preposition);
        before.extend(nearest.map(|word| format!("{word}_")));
        before.insert(Self::ALWAYS.to_owned());
        Self { near, before }
    }
}

/// A noun of an instruction that may mean several types of the scene.
#[derive(Clone, Debug)]
pub struct LooseNoun {
    /// The noun, as the lexicon files it.
    pub word: String,
    /// The types, in the lexicon's order.
    pub kinds: Vec<String>,
    /// What is said around it.
    pub clues: Clues,
}

impl Senses {
    /// Adds what else was learned; where both speak of a type or noun, the other wins.
    pub fn extend(&mut self, other: Self) {
        self.near.extend(other.near);
        self.before.extend(other.before);
    }

    /// Puts the likelier of a noun's types first.
    fn order(&self, noun: &LooseNoun) -> Option<Vec<String>> {
        let learned = self.before.get(&squash(&noun.word))?;
        let known: Vec<&String> = noun.kinds.iter().filter(|kind| learned.contains_key(*kind)).collect();
        let sum = |weights: Option<&Weights>, clues: &BTreeSet<String>| -> i32 {
            weights.map_or(0, |weights| clues.iter().filter_map(|clue| weights.get(clue)).sum())
        };
        let score = |kind: &String| {
            let own = if squash(kind) == squash(&noun.word) { OWN_NAME } else { 0 };
            own + sum(self.near.get(kind), &noun.clues.near) + sum(learned.get(kind), &noun.clues.before)
        };
        let mut ordered = known.clone();
        ordered.sort_by_key(|kind| std::cmp::Reverse(score(kind)));
        // What nothing was learned of stays where it is.
        let mut ordered = ordered.into_iter();
        let place = |kind: &String| if known.contains(&kind) { ordered.next() } else { None };
        let places: Vec<Option<&String>> = noun.kinds.iter().map(place).collect();
        Some(noun.kinds.iter().zip(places).map(|(kind, other)| other.unwrap_or(kind).clone()).collect())
    }
}

/// The nouns of a text, each with its likelier types first.
pub(super) fn ordered<'a>(
    mut nouns: Vec<NounAt<'a>>,
    words: &[String],
    lexicon: &Lexicon,
    scene: &Scene<'_>,
) -> Vec<NounAt<'a>> {
    for (at, loose) in loose_nouns(&nouns, words, scene) {
        if let (Some(kinds), Some((noun, _, _))) = (lexicon.senses().order(&loose), &mut nouns[at]) {
            let absent = noun.kinds.iter().filter(|kind| !kinds.contains(kind)).cloned();
            let kinds: Vec<String> = kinds.iter().cloned().chain(absent).collect();
            noun.to_mut().kinds = kinds;
        }
    }
    nouns
}

/// The nouns that may mean several types of the scene, and their positions. A type that is named elsewhere in the text
/// by a word of its own is not meant by another: "the cup and the mug".
fn loose_nouns(nouns: &[NounAt<'_>], words: &[String], scene: &Scene<'_>) -> Vec<(usize, LooseNoun)> {
    let mut outer = Vec::new();
    let mut end = 0;
    for (at, noun) in nouns.iter().enumerate().filter_map(|(at, noun)| Some((at, noun.as_ref()?))) {
        // Of "coffee mug" the "mug" is a part.
        if at >= end {
            end = at + noun.2;
            outer.push((at, noun));
        }
    }
    let own = |noun: &Noun| {
        let kind = noun.kinds.first().filter(|kind| squash(kind) == squash(&noun.word));
        kind.filter(|_| !noun.class).cloned()
    };
    let named: BTreeSet<String> = outer.iter().filter_map(|(_, (noun, _, _))| own(noun)).collect();
    let mut found = Vec::new();
    for (at, (noun, _, length)) in outer.into_iter().filter(|(_, (noun, _, _))| !noun.class) {
        let mine = own(noun);
        let kinds: Vec<String> = noun
            .kinds
            .iter()
            .filter(|kind| scene.has(kind) && (!named.contains(*kind) || mine.as_ref() == Some(*kind)))
            .cloned()
            .collect();
        if kinds.len() > 1 {
            let mut clues = Clues::around(words, at, *length);
            let room = TELL_THE_ROOM.iter().filter(|kind| scene.has(kind));
            clues.near.extend(room.map(|kind| (*kind).to_owned()));
            found.push((at, LooseNoun { word: noun.word.clone(), kinds, clues }));
        }
    }
    found
}

impl Offline {
    /// The nouns of an instruction that may mean several types of the scene: what senses are learned from.
    pub fn loose_nouns(&self, request: &Request) -> Vec<LooseNoun> {
        let scene = Scene::new(&request.objects, &request.robots);
        let words = plain(&request.instruction, &self.lexicon, &scene).words;
        let nouns = super::phrase::nouns(&words, &self.lexicon);
        loose_nouns(&nouns, &words, &scene).into_iter().map(|(_, loose)| loose).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meant(senses: &str, noun: &str, kinds: &[&str], words: &str, at: usize) -> Option<Vec<String>> {
        let mut lexicon = Lexicon::default();
        lexicon.extend("learned", senses).unwrap();
        let words: Vec<String> = words.split(' ').map(str::to_owned).collect();
        let kinds = kinds.iter().map(|kind| (*kind).to_owned()).collect();
        let clues = Clues::around(&words, at, 1);
        lexicon.senses().order(&LooseNoun { word: noun.to_owned(), kinds, clues })
    }

    const TABLE: &str = "
[senses.near]
Desk = { pencil = 12 }
[senses.before.table]
DiningTable = { _ = 5 }
Desk = { from_ = 3 }
[senses.before.cup]
Cup = {}
Mug = { coffee = 30 }
";

    #[test]
    fn words_around_a_noun_order_its_types() {
        let kinds = ["DiningTable", "SideTable", "Desk"];
        let near = meant(TABLE, "table", &kinds, "put the pencil on the table", 5).unwrap();
        // Nothing was learned of the side table: it stays where it was.
        assert_eq!(near, ["Desk", "SideTable", "DiningTable"]);
        let far = meant(TABLE, "table", &kinds, "put the plate on the table", 5).unwrap();
        assert_eq!(far, kinds);
        assert_eq!(meant(TABLE, "stool", &kinds, "put the pencil on the stool", 5), None);
    }

    #[test]
    fn a_types_own_name_is_taken_at_its_word() {
        let cup = meant(TABLE, "cup", &["Cup", "Mug"], "fill the coffee cup", 3).unwrap();
        assert_eq!(cup, ["Cup", "Mug"]);
    }
}
