//! Scores the embedded default on crowd-written sentences with known goals.
//!
//! `score_alfred FOLDER [clean|dev|learn|held|all] [SENTENCES] [SHOW]` reads `alfred/train_compact.json.gz` and `ai2thor/*`
//! in the folder, takes that many sentences at random (by a hash), and prints the rate of exact goals and the
//! causes of the rest.
//!
//! `clean` is a quarter of the tasks, by two hashes of the task's id, that nobody has read while the grammar and
//! the lexicon were written: it reports. `dev` is the rest; failures are shown for it and for `learn` alone. `all` is
//! both. `learn` is the half that senses are learned from, `held` the other half, of which `clean` is a half;
//! `HALVES=id|goal|plan` says what they keep together (`examples/learn_senses`).
//! `LEXICON=DIR` reads the lexicon's files from a folder, so that it may be tuned without building.
//! `SEED=TEXT` takes other sentences. `STRICT=1` counts a question as a failure and a state that does not last as missing.

mod facts;
mod judge;
mod sentences;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use facts::Facts;
use judge::{judge, wanted};
use lamma_lm::{LanguageModel, Offline};
use sentences::{read_tasks, sentences};

/// Whatever goes wrong in an example.
pub type Failure = Box<dyn std::error::Error>;

/// Confusions shown.
const MOST_CONFUSIONS: usize = 25;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: score_alfred FOLDER [clean|dev|learn|held|all] [SENTENCES] [SHOW]";
    let folder = Path::new(arguments.first().ok_or(usage)?);
    let part = arguments.get(1).map_or("clean", String::as_str);
    let limit = arguments.get(2).and_then(|n| n.parse().ok()).unwrap_or(usize::MAX);
    let show: usize = arguments.get(3).and_then(|n| n.parse().ok()).unwrap_or(0);
    let facts = Facts::read(folder)?;
    let tasks = read_tasks(folder)?;
    let sentences = sentences(&tasks, part, limit);
    let mut parser = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let mut tally = Tally::default();
    for (task, sentence) in &sentences {
        let request = facts.request(task, sentence);
        let started = Instant::now();
        let answer = parser.decompose(&request, &AtomicBool::new(false))?;
        tally.times.push(started.elapsed());
        let wanted = wanted(task);
        let verdict = judge(&answer, &wanted, &request, &parser.gloss(sentence));
        let entry = tally.by_type.entry(task["type"].as_str().unwrap_or_default().to_owned()).or_default();
        entry.1 += 1;
        if verdict.cause.is_empty() {
            entry.0 += 1;
            continue;
        }
        *tally.causes.entry(verdict.cause.clone()).or_default() += 1;
        if part == "dev" || part == "learn" {
            if let Some(confused) = verdict.confused {
                *tally.confusions.entry(confused).or_default() += 1;
            }
            if tally.shown < show {
                tally.shown += 1;
                println!("{}\n  {sentence}\n  want {wanted:?}\n  got  {:?}", verdict.cause, verdict.got);
            }
        }
    }
    tally.print(part);
    Ok(())
}

/// What was counted.
#[derive(Default)]
struct Tally {
    by_type: BTreeMap<String, (usize, usize)>,
    causes: BTreeMap<String, usize>,
    confusions: BTreeMap<String, usize>,
    times: Vec<Duration>,
    shown: usize,
}

impl Tally {
    fn print(mut self, part: &str) {
        let exact: usize = self.by_type.values().map(|(good, _)| good).sum();
        let all: usize = self.by_type.values().map(|(_, all)| all).sum();
        println!("{part}: {exact}/{all} exact = {:.4}", exact as f64 / all.max(1) as f64);
        self.times.sort();
        let times = (self.times.get(all / 2), self.times.get(all * 99 / 100), self.times.last());
        if let (Some(median), Some(most), Some(worst)) = times {
            println!("a sentence takes: p50 {median:?}, p99 {most:?}, worst {worst:?}");
        }
        for (kind, (good, all)) in &self.by_type {
            println!("  {kind:42} {good:5}/{all:5} = {:.3}", *good as f64 / *all as f64);
        }
        println!("the rest by cause:");
        for (cause, count) in by_count(self.causes) {
            println!("  {count:5} ({:4.1} %) {cause}", 100.0 * count as f64 / all.max(1) as f64);
        }
        for (confused, count) in by_count(self.confusions).into_iter().take(MOST_CONFUSIONS) {
            println!("    {count:5} {confused}");
        }
    }
}

fn by_count(counts: BTreeMap<String, usize>) -> Vec<(String, usize)> {
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

fn strict() -> bool {
    std::env::var_os("STRICT").is_some()
}
