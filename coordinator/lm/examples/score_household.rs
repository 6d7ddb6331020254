//! Scores the embedded default on our own household sentences: `score_household [FILE] [SHOW]`.
//!
//! The lines are told in `tests/judge/mod.rs`. Questions count as failures, as in a run without `--assume`.
//! `LEXICON=DIR` reads the lexicon's files from a folder.

#[path = "../tests/judge/mod.rs"]
mod judge;

use std::collections::BTreeMap;
use std::path::Path;

use lamma_lm::Offline;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/household.txt");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let file = arguments.first().map_or(FILE, String::as_str);
    let show: usize = arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(usize::MAX);
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let outcomes = judge::outcomes(&std::fs::read_to_string(file)?, &offline)?;
    for bad in outcomes.iter().filter(|outcome| !outcome.good).take(show) {
        println!("{}: {}\n    want {}\n    {}", bad.line, bad.sentence, bad.goal, bad.told);
    }
    let mut counts: BTreeMap<judge::Kind, (usize, usize)> = BTreeMap::new();
    for outcome in &outcomes {
        let entry = counts.entry(outcome.kind).or_default();
        entry.0 += usize::from(outcome.good);
        entry.1 += 1;
    }
    for (kind, (good, all)) in counts {
        println!("{kind:?}: {good}/{all} = {:.3}", good as f64 / all as f64);
    }
    Ok(())
}
