//! Benchmarks: what they write, and that they write the same again.

use std::io::{BufRead, BufReader};
use std::time::Duration;

use crate::tools::{Folder, finish, json, output, run_args, signal, start};

const TASKS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../domains/tasks/mat-thor.jsonl");

/// Must show: the same seed gives the same results, to the byte.
#[test]
fn a_repeated_benchmark_writes_the_same_bytes() {
    let folder = Folder::new("bench-twice");
    let mut seen: Vec<Vec<Vec<u8>>> = Vec::new();
    for out in ["first", "second"] {
        let args = ["bench", "--tasks", TASKS, "--only", "vague-0", "--jobs", "2", "--out", out, "--compat"];
        let done = output(&folder, &args);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let read = |name: &str| std::fs::read(folder.0.join(out).join(name)).unwrap();
        assert!(!read("timings.json").is_empty());
        seen.push(["results.json", "results.csv"].map(read).to_vec());
    }
    assert!(seen[0] == seen[1], "results differ between two runs of the same seed");
    let results: serde_json::Value = serde_json::from_slice(&seen[0][0]).unwrap();
    assert_eq!(results["tasks"].as_array().unwrap().len(), 9);
    assert!(results["tasks"][0].get("run_dir").is_none() && results["tasks"][0].get("time_ms").is_none());
    assert!(results["tasks"][0]["compat"]["gcr"].is_number());
}

#[test]
fn generated_tasks_are_a_suite() {
    let folder = Folder::new("bench-generated");
    let args = [
        "bench",
        "--generated",
        "2",
        "--only",
        "FloorPlan41",
        "--goals-given",
        "--bus",
        "inproc",
        "--format",
        "json",
    ];
    let (code, result) = json(&output(&folder, &args));
    assert_eq!(code, 0);
    assert_eq!(result["tasks"].as_array().unwrap().len(), 20, "two in each of FloorPlan410 to 419");
    assert_eq!(result["table"]["all"]["sr"], 1.0, "{result:#}");
}

#[test]
fn ctrl_c_ends_a_benchmark_with_what_was_done() {
    let folder = Folder::new("bench-ctrl-c");
    let args = ["bench", "--tasks", TASKS, "--goals-given", "--format", "json", "--jobs", "1"];
    let mut child = start(&folder, &args);
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let done = lines.by_ref().map(Result::unwrap).filter(|line| line.contains("success")).take(2);
    assert_eq!(done.count(), 2, "two tasks are done");
    signal(child.id(), "INT");
    let rest: Vec<String> = lines.map(Result::unwrap).collect();
    let (code, result) = json(&finish(child, Duration::from_secs(10)));
    let tasks = result["tasks"].as_array().unwrap().len();
    assert_eq!(code, 11, "{rest:#?}");
    assert!((2..70).contains(&tasks), "{tasks} of 70 are reported");
    assert_eq!(result["table"]["all"]["sr"], 1.0, "what was cut short does not count");
    assert!(rest.iter().any(|line| *line == format!("interrupted: {tasks} of 70 were done")), "{rest:#?}");
}

/// An action that fails is planned around, and the same script gives the same episode.
#[test]
fn events_are_planned_around() {
    let folder = Folder::new("events");
    let script = folder.file(
        "script.jsonl",
        "{\"robot\": \"robot1\", \"before_step\": 2, \"fail\": true}\n\
         {\"robot\": \"robot1\", \"before_step\": 4, \"move\": \"Apple_1\", \"to\": \"CounterTop_1\"}\n",
    );
    let mut seen = Vec::new();
    for _ in 0..2 {
        let args = run_args("Put the tomato in the fridge", "robot1,robot2", &["--events", &script]);
        let (code, result) = json(&output(&folder, &args));
        assert_eq!(code, 0, "{result:#}");
        assert!(result["metrics"]["exe"].as_f64().unwrap() < 1.0, "a step was refused: {result:#}");
        seen.push((result["plan"].clone(), result["metrics"].clone()));
    }
    assert_eq!(seen[0], seen[1]);
    let wrong = folder.file("wrong.jsonl", "{\"robot\": \"robto1\", \"before_step\": 2, \"fail\": true}\n");
    let done = output(&folder, &run_args("Put the tomato in the fridge", "robot1", &["--events", &wrong]));
    assert_eq!(done.status.code(), Some(20));
    assert!(String::from_utf8_lossy(&done.stderr).contains("did you mean `robot1`"));
}

/// Going takes its time everywhere: in the plan, on the simulator's clock and in the metrics.
#[test]
fn travel_counts_the_way() {
    let folder = Folder::new("travel");
    let args = |more: &[&'static str]| {
        let (code, result) =
            json(&output(&folder, &run_args("Put the tomato in the fridge", "robot1", more)));
        assert_eq!(code, 0, "{result:#}");
        result
    };
    let (unit, travel) = (args(&[]), args(&["--travel"]));
    let makespan = |result: &serde_json::Value| result["plan"]["makespan"].as_f64().unwrap();
    let actions = travel["plan"]["actions"].as_array().unwrap();
    let duration = |action: &serde_json::Value| action["duration"].as_f64().unwrap_or(1.0);
    let ends = actions.iter().map(|a| a["start"].as_f64().unwrap() + duration(a)).fold(0.0, f64::max);
    assert_eq!(makespan(&travel), ends, "the simulator's clock and the plan agree: {travel:#}");
    assert!(makespan(&travel) > makespan(&unit) && duration(&actions[0]) > 1.0, "{travel:#}");
    let bound = travel["plan"]["makespan_lower_bound"].as_f64().unwrap();
    assert!(makespan(&unit) < bound && bound <= makespan(&travel), "{travel:#}");
    assert_eq!(travel["metrics"]["eff"], 1.0);
    let solved: serde_json::Value = {
        let mut args = run_args("Put the tomato in the fridge", "robot1", &["--travel"]);
        args[0] = "solve";
        json(&output(&folder, &args)).1
    };
    assert_eq!(solved["plan"], travel["plan"]);
    let pddl = ["run", "--pddl", "a.pddl", "b.pddl", "--travel"];
    let done = output(&folder, &pddl);
    assert_eq!(done.status.code(), Some(20));
    assert!(String::from_utf8_lossy(&done.stderr).contains("--travel is for a scene"));
}
