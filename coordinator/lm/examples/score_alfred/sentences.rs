//! The crowd-written sentences in parts that are told by hashes: one to report, one to develop on, and halves to learn
//! from and to hold out.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::Failure;

/// Reads the tasks of `alfred/train_compact.json.gz`.
pub fn read_tasks(folder: &Path) -> Result<Value, Failure> {
    let unpacked =
        Command::new("gzip").arg("-dc").arg(folder.join("alfred/train_compact.json.gz")).output()?;
    Ok(serde_json::from_slice(&unpacked.stdout)?)
}

/// The sentences of a part, in an order that a hash gives.
pub fn sentences<'t>(tasks: &'t Value, part: &str, limit: usize) -> Vec<(&'t Value, &'t str)> {
    let seed = std::env::var("SEED").unwrap_or_default();
    let mut found: Vec<(u64, &Value, &str)> = Vec::new();
    for task in tasks["tasks"].as_array().into_iter().flatten() {
        let id = task["id"].as_str().unwrap_or_default();
        let clean = !fnv(id).is_multiple_of(2) && !crc32(id).is_multiple_of(2);
        let wanted = match part {
            "all" => true,
            "learn" => is_to_learn(task),
            "held" => !is_to_learn(task),
            _ => clean == (part == "clean"),
        };
        if wanted {
            for sentence in task["sentences"].as_array().into_iter().flatten().filter_map(Value::as_str) {
                found.push((fnv(&format!("{seed}{id}{sentence}")), task, sentence));
            }
        }
    }
    found.sort_by_key(|(hash, _, _)| *hash);
    found.truncate(limit);
    found.into_iter().map(|(_, task, sentence)| (task, sentence)).collect()
}

/// Whether a task is in the half that is learned from. A half has whole tasks (`HALVES=id`, unless told otherwise), or
/// whole kinds of task (`goal`: the same goal in the same rooms), or whole floor plans (`plan`).
fn is_to_learn(task: &Value) -> bool {
    let plan = task["floor_plan"].as_str().unwrap_or_default();
    match std::env::var("HALVES").as_deref() {
        // The lowest bit of this hash tells little of a name that ends in digits.
        Ok("plan") => (fnv(plan) >> 5).is_multiple_of(2),
        Ok("goal") => (fnv(&format!("{}{}{plan}", task["type"], task["goal"])) >> 7).is_multiple_of(2),
        _ => fnv(task["id"].as_str().unwrap_or_default()).is_multiple_of(2),
    }
}

/// Fowler, Noll and Vo's hash.
pub fn fnv(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn crc32(text: &str) -> u32 {
    !text.bytes().fold(u32::MAX, |sum, byte| {
        (0..8).fold(
            sum ^ u32::from(byte),
            |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 },
        )
    })
}
