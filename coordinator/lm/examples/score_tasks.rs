//! Compares the goals that the embedded default reads from a suite's sentences with the suite's own, without a
//! run: `score_tasks [FILE.jsonl]`. It prints counts by category and cause only, no sentence.

#[path = "../tests/judge/mod.rs"]
#[allow(dead_code, reason = "only its facts are used here")]
mod judge;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use lamma_domains::goal::GoalEntry;
use lamma_lm::{Answer, Offline, Request};
use serde_json::Value;

type Failure = Box<dyn std::error::Error>;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../domains/tasks/mat-thor.jsonl");

fn main() -> Result<(), Failure> {
    let file = std::env::args().nth(1).unwrap_or_else(|| FILE.to_owned());
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let mut counts: BTreeMap<String, BTreeMap<&str, usize>> = BTreeMap::new();
    for line in std::fs::read_to_string(&file)?.lines().filter(|line| !line.trim().is_empty()) {
        let task: Value = serde_json::from_str(line)?;
        let world = lamma_domains::world::setup(task["scene"].as_str().unwrap_or_default(), &[], None, 0)?;
        let objects = lamma_domains::view::views(&world, world.facts());
        let facts = |entries: &[GoalEntry]| {
            let mut found = Vec::new();
            entries.iter().for_each(|entry| judge::facts(entry, &objects, &mut found));
            judge::numbered(found)
        };
        let goal: Vec<GoalEntry> = serde_json::from_value(task["goal"].clone())?;
        let wanted = facts(&goal);
        let answer = offline.read(&Request {
            instruction: task["instruction"].as_str().unwrap_or_default().to_owned(),
            objects: objects.clone(),
            robots: Vec::new(),
            assume: false,
            deadline: Duration::from_secs(5),
        });
        let cause = match answer {
            Answer::Clarify(_) => "asks",
            Answer::Understood(decomposition) => {
                let lasting = decomposition.subtasks.iter().filter(|s| s.lasting);
                let read: Vec<GoalEntry> = lasting.flat_map(|s| s.goal.clone()).collect();
                let got = facts(&read);
                let all = wanted.iter().all(|fact| got.contains(fact));
                match wanted.iter().filter(|fact| got.contains(fact)).count() {
                    _ if all && got.len() == wanted.len() => "the same goal",
                    _ if all => "the goal and more",
                    0 => "another goal",
                    _ => "a part of the goal",
                }
            }
        };
        let category = task["category"].as_str().unwrap_or("?").to_owned();
        *counts.entry(category).or_default().entry(cause).or_default() += 1;
    }
    for (category, causes) in counts {
        println!("{category}: {causes:?}");
    }
    Ok(())
}
