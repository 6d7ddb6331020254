//! Learns which of its types a loose noun means from crowd-written sentences with known goals, and prints
//! `domains/household/lexicon/senses.toml`:
//!
//! `learn_senses FOLDER > domains/household/lexicon/senses.toml`
//!
//! It reads the `learn` half of `score_alfred` (see there for `HALVES` and `LEXICON`). An instance is a noun that may mean several types
//! of its scene of which the goal names exactly one. Weights are those of a choice among the types: no less than
//! nothing, of clues that were met in several floor plans, so that what holds in one kitchen alone is not learned.
//! A noun is learned only if that helps in floor plans that it was not learned in.

#[path = "../score_alfred/facts.rs"]
mod facts;
mod model;
#[path = "../score_alfred/sentences.rs"]
mod sentences;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use lamma_lm::Offline;
use lamma_lm::offline::LooseNoun;

use facts::Facts;
use model::{Instance, Model};
use sentences::{fnv, read_tasks, sentences};

/// Whatever goes wrong in an example.
pub type Failure = Box<dyn std::error::Error>;

/// A noun that is met less often is not learned.
const FEWEST: usize = 20;

/// How many parts of the floor plans a noun is tried in.
const FOLDS: u64 = 4;

/// A noun is learned if at least one in so many instances more is right by it.
const GAIN: usize = 100;

/// Nouns that stay as the lexicon has them. Crowd writers call any knife so; who knows that there are two sorts says
/// "butter knife".
const LEFT: [&str; 1] = ["knife"];

/// Words that tell nothing of what is spoken of, however far away.
const EMPTY: &str = "the a an it them and of to then up down that is its with in on from into onto inside for at by two one some this";

fn main() -> Result<(), Failure> {
    let folder = std::env::args().nth(1).ok_or("usage: learn_senses FOLDER > senses.toml")?;
    let instances = usable(instances(Path::new(&folder))?);
    let mut nouns: BTreeMap<&str, (usize, usize, usize)> = BTreeMap::new();
    for fold in 0..FOLDS {
        let tried = |instance: &&Instance| fnv(&instance.plan) / 7 % FOLDS == fold;
        let model = Model::fit(&instances.iter().filter(|i| !tried(i)).collect::<Vec<_>>());
        for instance in instances.iter().filter(tried) {
            let (all, plain, learned) = nouns.entry(&instance.noun).or_default();
            *all += 1;
            *plain += usize::from(instance.meant == 0);
            *learned += usize::from(model.choose(instance) == instance.meant);
        }
    }
    nouns.retain(|noun, (all, plain, learned)| {
        let helps = *learned > *plain + *all / GAIN;
        eprintln!(
            "{noun}: {plain} of {all} by the lexicon, {learned} by its words{}",
            if helps { "" } else { ": left" }
        );
        helps
    });
    let learned: Vec<&Instance> = instances.iter().filter(|i| nouns.contains_key(i.noun.as_str())).collect();
    print!("{}", Model::fit(&learned).to_toml());
    Ok(())
}

/// The instances of the half to learn from.
fn instances(folder: &Path) -> Result<Vec<Instance>, Failure> {
    let facts = Facts::read(folder)?;
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let empty: BTreeSet<&str> = EMPTY.split(' ').collect();
    let tasks = read_tasks(folder)?;
    let mut found = Vec::new();
    for (task, sentence) in sentences(&tasks, "learn", usize::MAX) {
        let goal: BTreeSet<&str> = ["object_target", "parent_target", "mrecep_target", "toggle_target"]
            .iter()
            .filter_map(|key| task["goal"][key].as_str())
            .collect();
        for LooseNoun { word, kinds, clues } in offline.loose_nouns(&facts.request(task, sentence)) {
            let meant: Vec<usize> = (0..kinds.len()).filter(|&i| goal.contains(kinds[i].as_str())).collect();
            let [meant] = meant.as_slice() else { continue };
            let is_word = |word: &String| word.chars().all(|c| c.is_alphanumeric() || c == '_');
            let near = clues.near.into_iter().filter(|w| is_word(w) && !empty.contains(w.as_str())).collect();
            found.push(Instance {
                noun: lamma_lm::offline::squash(&word),
                plan: task["floor_plan"].as_str().unwrap_or_default().to_owned(),
                meant: *meant,
                kinds,
                near,
                before: clues.before.into_iter().filter(is_word).collect(),
            });
        }
    }
    Ok(found)
}

/// Without types that a noun never means, and nouns that are too seldom or leave no choice then.
fn usable(mut instances: Vec<Instance>) -> Vec<Instance> {
    let mut meant: BTreeSet<(String, String)> = BTreeSet::new();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for instance in &instances {
        meant.insert((instance.noun.clone(), instance.kinds[instance.meant].clone()));
        *counts.entry(instance.noun.clone()).or_default() += 1;
    }
    for instance in &mut instances {
        let right = instance.kinds[instance.meant].clone();
        instance.kinds.retain(|kind| meant.contains(&(instance.noun.clone(), kind.clone())));
        instance.meant = instance.kinds.iter().position(|kind| *kind == right).unwrap_or(0);
    }
    instances.retain(|instance| {
        let noun = instance.noun.as_str();
        instance.kinds.len() > 1 && counts[noun] >= FEWEST && !LEFT.contains(&noun)
    });
    instances
}

fn strict() -> bool {
    false
}
