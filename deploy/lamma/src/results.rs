//! What a benchmark writes into its `--out` folder.
//!
//! `results.json` and `results.csv` hold what follows from the tasks and the seed alone and are the same, to the
//! byte, whenever the benchmark is repeated; clocks, process numbers and paths are in `timings.json`.

use std::path::Path;

use serde_json::{Value, json};

use crate::commands::bench::Finished;
use crate::error::Failure;
use crate::suite::Suite;
use crate::table::Row;

/// Keys of a task's result that differ from run to run.
const OF_THE_RUN: [&str; 4] = ["run_dir", "processes", "time_ms", "elapsed_ms"];

/// Writes the three files.
pub fn write(out: &Path, value: &Value, suite: &Suite, finished: &[Finished]) -> Result<(), Failure> {
    let fail = |e: &std::io::Error| Failure::bad_input(format!("cannot write to {}: {e}", out.display()));
    std::fs::create_dir_all(out).map_err(|e| fail(&e))?;
    let put = |name: &str, text: String| std::fs::write(out.join(name), text).map_err(|e| fail(&e));
    let pretty = |value: &Value| serde_json::to_string_pretty(value).map_err(Failure::fault);
    let mut same = value.clone();
    without_the_run(&mut same);
    put("results.json", pretty(&same)?)?;
    put("results.csv", Row::csv(suite, finished))?;
    let timings = finished.iter().map(|f| {
        let of_the_run = OF_THE_RUN.iter().map(|key| ((*key).to_string(), f.json[*key].clone()));
        let id = ("id".to_string(), f.json["id"].clone());
        Value::Object(std::iter::once(id).chain(of_the_run).collect())
    });
    put("timings.json", pretty(&json!({ "tasks": timings.collect::<Vec<_>>() }))?)
}

/// Leaves out what a repetition would not find again.
fn without_the_run(value: &mut Value) {
    for task in value["tasks"].as_array_mut().into_iter().flatten() {
        let Value::Object(task) = task else { continue };
        OF_THE_RUN.iter().for_each(|key| drop(task.remove(*key)));
        for list in ["faults", "recoveries"] {
            for entry in task.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten() {
                if let Value::Object(entry) = entry {
                    entry.remove("at_ms");
                }
            }
        }
    }
}
