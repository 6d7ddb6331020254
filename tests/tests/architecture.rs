//! Holds the code to the walls that ARCHITECTURE.md draws: who may depend on whom, and what may be named
//! where. An invariant that says what is absent needs a test, or it is a wish.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What each crate may depend on, within the workspace.
const ALLOWED: &[(&str, &[&str])] = &[
    ("lamma-pddl", &[]),
    ("lamma-planner", &["lamma-pddl"]),
    ("lamma-protocol", &[]),
    ("lamma-bus", &["lamma-protocol"]),
    ("lamma-domains", &["lamma-pddl"]),
    ("lamma-lm", &["lamma-pddl", "lamma-domains"]),
    ("lamma-robot", &["lamma-pddl", "lamma-planner", "lamma-protocol"]),
    ("lamma-simulator", &["lamma-pddl", "lamma-planner", "lamma-protocol"]),
    ("lamma-coordinator", &["lamma-pddl", "lamma-planner", "lamma-protocol", "lamma-lm", "lamma-domains"]),
];

/// Crates whose code must behave the same in every process: no clock, thread, hash order or I/O.
const MACHINES: &[&str] =
    &["agents/robot/src", "agents/simulator/src", "coordinator/src", "shared/protocol/src"];

/// The only names at the top.
const TOP: &[&str] = &["agents", "coordinator", "shared", "domains", "tests", "deploy"];

const LINES: usize = 500;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in the workspace").to_path_buf()
}

fn sources(below: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![root().join(below)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                if !path.ends_with("target") {
                    open.push(path);
                }
            } else if path.extension().is_some_and(|e| e == "rs") {
                let name = path.strip_prefix(root()).unwrap().display().to_string();
                found.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

/// The code without its comments and its test module.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = product.lines().map(|l| l.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

fn metadata() -> serde_json::Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    serde_json::from_slice(&output.stdout).expect("cargo prints JSON")
}

#[test]
fn crates_depend_only_in_the_direction_of_the_house() {
    let metadata = metadata();
    let allowed: BTreeMap<&str, &[&str]> = ALLOWED.iter().copied().collect();
    let mut seen = BTreeSet::new();
    for package in metadata["packages"].as_array().unwrap() {
        let name = package["name"].as_str().unwrap();
        let Some(allowed) = allowed.get(name) else { continue };
        seen.insert(name);
        for dependency in package["dependencies"].as_array().unwrap() {
            let on = dependency["name"].as_str().unwrap();
            let for_tests = dependency["kind"].as_str() == Some("dev");
            if on.starts_with("lamma-") && !for_tests {
                assert!(
                    allowed.contains(&on),
                    "{name} must not depend on {on}: see ARCHITECTURE.md, \"Direction\""
                );
            }
        }
    }
    assert_eq!(seen.len(), ALLOWED.len(), "a crate of the house is missing");
}

#[test]
fn only_the_codec_names_the_encoding_library() {
    for (file, text) in TOP.iter().flat_map(|top| sources(top)) {
        let own = file == "shared/protocol/src/codec.rs" || file == "tests/tests/architecture.rs";
        assert!(own || !code(&text).contains("bincode"), "{file} names bincode: only codec.rs may");
    }
}

#[test]
fn machines_name_no_clock_thread_hash_order_or_transport() {
    let banned = [
        "std::time::Instant",
        "SystemTime",
        "std::thread",
        "HashMap",
        "HashSet",
        "std::net",
        "std::fs",
        "tokio",
        "iceoryx2",
        "zenoh",
        "fastrand",
        "println!",
    ];
    for (file, text) in MACHINES.iter().flat_map(|below| sources(below)) {
        let code = code(&text);
        for name in banned {
            assert!(!code.contains(name), "{file} names {name}: a machine has no side effects");
        }
    }
}

#[test]
fn transports_and_threads_are_named_only_where_they_belong() {
    for (file, text) in TOP.iter().flat_map(|top| sources(top)) {
        let code = code(&text);
        let may = file.starts_with("shared/bus") || file.starts_with("deploy") || file.starts_with("tests/");
        assert!(may || !code.contains("iceoryx2::"), "{file} names iceoryx2: only the bus does");
        let may =
            may || file.contains("/tests/") || file.contains("/examples/") || file.contains("/benches/");
        assert!(
            may || !code.contains("std::thread::spawn"),
            "{file} starts a thread: only the bus and the mains do"
        );
        let may = may || file.starts_with("coordinator/lm/src/http");
        assert!(may || !code.contains("std::net::"), "{file} opens sockets: only the bus and lm/http do");
    }
}

#[test]
fn unsafe_code_is_only_in_the_bus() {
    for (file, text) in TOP.iter().flat_map(|top| sources(top)) {
        let own = file.starts_with("shared/bus/src") || file == "tests/tests/architecture.rs";
        let has = code(&text)
            .lines()
            .any(|l| l.contains("unsafe {") || l.contains("unsafe fn") || l.contains("allow(unsafe_code)"));
        assert!(own || !has, "{file} has unsafe code: it belongs into the bus, behind a safe function");
    }
}

#[test]
fn files_are_short_enough_to_have_one_subject() {
    for (file, text) in TOP.iter().flat_map(|top| sources(top)) {
        let lines = text.lines().count();
        assert!(lines <= LINES, "{file} has {lines} lines, more than {LINES}: split it by subject");
    }
}

#[test]
fn the_top_level_is_the_house_and_nothing_else() {
    let metadata = metadata();
    for package in metadata["packages"].as_array().unwrap() {
        let manifest = package["manifest_path"].as_str().unwrap();
        let place = Path::new(manifest).strip_prefix(root()).unwrap();
        let first = place.components().next().unwrap().as_os_str().to_str().unwrap();
        assert!(TOP.contains(&first), "{manifest} lies outside of the seven rooms");
    }
}

#[test]
fn every_file_that_architecture_md_names_is_there() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    for path in text.split('`').filter(|w| w.contains('/') && (w.ends_with(".rs") || w.ends_with(".md"))) {
        assert!(root().join(path).exists(), "ARCHITECTURE.md names {path}, which is not there");
    }
}
