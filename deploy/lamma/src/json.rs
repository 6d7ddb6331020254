//! What `--format json` prints: the coordinator's result with what only the launcher knows.

use lamma_coordinator::result::{OutcomeKind, RunResult};
use serde_json::{Value, json};

use crate::cli::{BusArg, CommonArgs};
use crate::error::Failure;
use crate::launch::Launched;

/// One run, as the contract lays it out.
pub fn run(launched: &Launched, common: &CommonArgs) -> Value {
    run_of(launched, common.bus, common.seed, &common.lm)
}

/// As [`run`], where there are no common options.
pub fn run_of(launched: &Launched, bus: BusArg, seed: u64, lm: &str) -> Value {
    let mut value = serde_json::to_value(&launched.result).unwrap_or_default();
    if let Value::Object(object) = &mut value {
        object.insert("run_dir".into(), json!(launched.folder));
        object.insert("seed".into(), json!(seed));
        object.insert("bus".into(), json!(bus.name()));
        object.insert("lm".into(), json!(lm));
        object.insert("processes".into(), json!(launched.processes));
        object.insert("elapsed_ms".into(), json!(launched.elapsed.as_secs_f64() * 1e3));
    }
    value
}

/// A failure, with what is known of its places.
pub fn failure(failure: &Failure) -> Value {
    let mut value = error(&failure.text);
    if let (Value::Object(object), false) = (&mut value, failure.diagnostics.is_empty()) {
        object.insert("diagnostics".into(), json!(failure.diagnostics));
    }
    value
}

/// A failure before or beside a run, with all keys of a result.
pub fn error(text: &str) -> Value {
    serde_json::to_value(RunResult::unfinished(OutcomeKind::Error, text)).unwrap_or_default()
}
