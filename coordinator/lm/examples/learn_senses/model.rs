//! A choice among types: weights of clues, fitted by stochastic gradients.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use lamma_lm::offline::squash;

use crate::sentences::fnv;

/// Rounds over all instances.
const ROUNDS: u64 = 10;
const STEP: f64 = 0.15;
/// How much weights are drawn to nothing.
const DECAY: f64 = 0.02;
/// Clues met in fewer floor plans are not learned.
const PLANS: usize = 3;
/// Weights below this are left out.
const LEAST: f64 = 0.25;
/// What a type gains where crowd writers call it by its own name.
const OWN_NAME: f64 = 2.0;
/// Tenths are written.
const UNIT: f64 = 10.0;

/// A noun where it was said, and what it meant.
pub struct Instance {
    pub noun: String,
    pub plan: String,
    /// In the lexicon's order.
    pub kinds: Vec<String>,
    pub meant: usize,
    pub near: Vec<String>,
    pub before: Vec<String>,
}

/// What a weight belongs to: a noun (or none, for words anywhere), a type and a clue.
type Key = (String, String, String);

/// The weights.
pub struct Model {
    weights: BTreeMap<Key, f64>,
    nouns: BTreeMap<String, BTreeSet<String>>,
}

impl Model {
    /// Fits the weights to instances.
    pub fn fit(instances: &[&Instance]) -> Self {
        let mut plans: BTreeMap<(String, String), BTreeSet<&str>> = BTreeMap::new();
        let mut nouns: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for instance in instances {
            for clue in instance.clues() {
                plans.entry(clue).or_default().insert(&instance.plan);
            }
            nouns.entry(instance.noun.clone()).or_default().extend(instance.kinds.iter().cloned());
        }
        // Numbers for the keys, and for each instance those of each of its types.
        let mut numbers: BTreeMap<Key, usize> = BTreeMap::new();
        let mut rows: Vec<(Vec<Vec<usize>>, Vec<f64>, usize)> = Vec::new();
        for instance in instances {
            let clues: Vec<_> =
                instance.clues().into_iter().filter(|clue| plans[clue].len() >= PLANS).collect();
            let of = |kind: &String| {
                let mut number = |(noun, clue): &(String, String)| {
                    let next = numbers.len();
                    *numbers.entry((noun.clone(), kind.clone(), clue.clone())).or_insert(next)
                };
                clues.iter().map(&mut number).collect()
            };
            let columns = instance.kinds.iter().map(of).collect();
            rows.push((columns, instance.own_names(), instance.meant));
        }
        let mut weights = vec![0.0_f64; numbers.len()];
        let mut squares = vec![1e-3_f64; numbers.len()];
        for round in 0..ROUNDS {
            let mut order: Vec<usize> = (0..rows.len()).collect();
            order.sort_by_key(|i| fnv(&format!("{round} {i}")));
            for (columns, own, meant) in order.into_iter().map(|i| &rows[i]) {
                let chances = chances(columns, own, &weights);
                for (kind, column) in columns.iter().enumerate() {
                    let error = f64::from(u8::from(kind == *meant)) - chances[kind];
                    for &at in column {
                        let slope = error - DECAY * weights[at];
                        squares[at] += slope * slope;
                        weights[at] = (weights[at] + STEP * slope / squares[at].sqrt()).max(0.0);
                    }
                }
            }
        }
        let weights =
            numbers.into_iter().map(|(key, at)| (key, weights[at])).filter(|(_, weight)| *weight >= LEAST);
        Self { weights: weights.collect(), nouns }
    }

    /// Which type it takes the noun for.
    pub fn choose(&self, instance: &Instance) -> usize {
        if !self.nouns.contains_key(&instance.noun) {
            return 0;
        }
        let score = |(i, kind): (usize, &String)| {
            let weight =
                |(noun, clue): (String, String)| self.weights.get(&(noun, kind.clone(), clue)).copied();
            instance.own_names()[i] + instance.clues().into_iter().filter_map(weight).sum::<f64>()
        };
        let scores: Vec<f64> = instance.kinds.iter().enumerate().map(score).collect();
        // The first of equals.
        (0..scores.len()).rev().max_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0)
    }

    /// The lexicon's file.
    pub fn to_toml(&self) -> String {
        let mut text = HEADER.to_owned();
        let table = |noun: &str, kind: &str| {
            let of = self.weights.iter().filter(|((n, k, _), _)| n == noun && k == kind);
            let mut entries: Vec<(i64, &str)> =
                of.map(|((_, _, clue), weight)| ((weight * UNIT).round() as i64, clue.as_str())).collect();
            entries.sort_by_key(|(weight, clue)| (std::cmp::Reverse(*weight), *clue));
            let entries: Vec<String> =
                entries.iter().map(|(weight, clue)| format!("{clue} = {weight}")).collect();
            if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
        };
        text.push_str("\n[senses.near]\n");
        let kinds: BTreeSet<&String> = self.nouns.values().flatten().collect();
        for kind in kinds {
            let _ = writeln!(text, "{kind} = {}", table("", kind));
        }
        for (noun, kinds) in &self.nouns {
            let _ = writeln!(text, "\n[senses.before.{noun}]");
            for kind in kinds {
                let _ = writeln!(text, "{kind} = {}", table(noun, kind));
            }
        }
        text
    }
}

impl Instance {
    /// Clues with the noun they count for; those anywhere count for all nouns.
    fn clues(&self) -> Vec<(String, String)> {
        let near = self.near.iter().map(|word| (String::new(), word.clone()));
        near.chain(self.before.iter().map(|clue| (self.noun.clone(), clue.clone()))).collect()
    }

    /// What a type gains by being called by its own name.
    fn own_names(&self) -> Vec<f64> {
        let own = |kind: &String| if squash(kind) == self.noun { OWN_NAME } else { 0.0 };
        self.kinds.iter().map(own).collect()
    }
}

/// How likely each type is.
fn chances(columns: &[Vec<usize>], own: &[f64], weights: &[f64]) -> Vec<f64> {
    let scores: Vec<f64> = columns
        .iter()
        .zip(own)
        .map(|(column, own)| own + column.iter().map(|&at| weights[at]).sum::<f64>())
        .collect();
    let most = scores.iter().copied().fold(f64::MIN, f64::max);
    let shares: Vec<f64> = scores.iter().map(|score| (score - most).exp()).collect();
    let all: f64 = shares.iter().sum();
    shares.into_iter().map(|share| share / all).collect()
}

const HEADER: &str = "\
# Which of its types a loose noun means, by the words around it. Learned, not written: `cargo run --release -p lamma-lm
# --example learn_senses -- ../shared/data` makes this file anew from one half of ALFRED's crowd-written sentences (MIT).
# Numbers are tenths of a natural logarithm. `near`: words within reach, whatever the noun, and types (`Bed`) that tell
# the room. `before`: by noun, the two words in front of it, the nearest preposition (`on_`), and how often it means
# the type at all (`_`).
";
