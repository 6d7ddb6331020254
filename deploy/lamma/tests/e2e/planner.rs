//! The planner and the validator alone.

use std::time::Duration;

use crate::tools::{Folder, finish, output, signal, start};

const DOMAIN: &str = "(define (domain ferry) (:requirements :strips :typing)
  (:types place car)
  (:predicates (at-ferry ?p - place) (at ?c - car ?p - place) (empty) (on ?c - car))
  (:action sail :parameters (?from ?to - place)
    :precondition (at-ferry ?from) :effect (and (at-ferry ?to) (not (at-ferry ?from))))
  (:action board :parameters (?c - car ?p - place)
    :precondition (and (at ?c ?p) (at-ferry ?p) (empty))
    :effect (and (on ?c) (not (at ?c ?p)) (not (empty))))
  (:action debark :parameters (?c - car ?p - place)
    :precondition (and (on ?c) (at-ferry ?p)) :effect (and (at ?c ?p) (not (on ?c)) (empty))))";

const PROBLEM: &str = "(define (problem two) (:domain ferry)
  (:objects a b - place red blue - car)
  (:init (at-ferry a) (at red a) (at blue a) (empty))
  (:goal (and (at red b) (at blue b))))";

#[test]
fn a_plan_that_plan_prints_is_one_that_validate_accepts() {
    let folder = Folder::new("ferry");
    let (domain, problem) = (folder.file("domain.pddl", DOMAIN), folder.file("problem.pddl", PROBLEM));
    let plan = folder.0.join("plan.txt").display().to_string();
    let out = output(&folder, &["plan", &domain, &problem, "--plan-file", &plan]);
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    let printed = String::from_utf8_lossy(&out.stdout).into_owned();
    assert_eq!(printed, std::fs::read_to_string(&plan).unwrap());
    assert!(printed.trim_end().ends_with("; cost = 7 (unit cost)"), "{printed}");
    assert_eq!(output(&folder, &["validate", &domain, &problem, &plan]).status.code(), Some(0));
    // Without its first step the plan fails at a step that is named, with the fact that is missing.
    let cut: String = printed.lines().skip(1).map(|l| format!("{l}\n")).collect();
    let cut = folder.file("cut.txt", &cut);
    let out = output(&folder, &["validate", &domain, &problem, &cut]);
    assert_eq!(out.status.code(), Some(1));
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    assert!(text.contains("does not hold"), "{text}");
}

#[test]
fn what_can_never_be_is_said_with_its_cause() {
    let folder = Folder::new("no-way");
    let domain = folder
        .file("domain.pddl", &DOMAIN.replace("(at-ferry ?p) (empty))", "(at-ferry ?p) (afloat) (empty))"));
    let domain = folder.file(
        "domain.pddl",
        &std::fs::read_to_string(domain).unwrap().replace("(empty) (on", "(empty) (afloat) (on"),
    );
    let problem = folder.file("problem.pddl", PROBLEM);
    let out = output(&folder, &["plan", &domain, &problem, "--format", "json"]);
    assert_eq!(out.status.code(), Some(10), "{}", String::from_utf8_lossy(&out.stderr));
    let answer: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    assert_eq!(answer["outcome"], "infeasible");
    let reason = answer["reason"].as_str().unwrap();
    assert!(reason.contains("(at red b)"), "{reason}");
    assert!(reason.contains("(afloat) (no action adds it and `:init` does not state it)"), "{reason}");
}

#[test]
fn findings_are_data_where_data_is_asked_for() {
    let folder = Folder::new("findings");
    let domain = folder.file("domain.pddl", DOMAIN);
    let problem = folder.file("problem.pddl", &PROBLEM.replace("(at red a)", "(att red a)"));
    let out = output(&folder, &["plan", &domain, &problem, "--format", "json"]);
    assert_eq!(out.status.code(), Some(20));
    let answer: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    assert_eq!(answer["outcome"], "error");
    let found = &answer["diagnostics"][0];
    assert_eq!(found["code"], "pddl::unknown-predicate");
    assert_eq!((found["line"].as_u64(), found["severity"].as_str()), (Some(3), Some("error")));
    assert!(found["help"].as_str().unwrap().contains("`at`"), "{found}");
}

#[test]
fn anytime_ends_with_a_proof_where_there_is_one() {
    let folder = Folder::new("anytime");
    let (domain, problem) = (folder.file("domain.pddl", DOMAIN), folder.file("problem.pddl", PROBLEM));
    let plan = folder.0.join("plan.txt").display().to_string();
    let args = ["plan", &domain, &problem, "--search", "anytime", "--format", "json", "--plan-file", &plan];
    let out = output(&folder, &args);
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    let answer: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    assert_eq!(answer["optimal"], true);
    assert_eq!((answer["plan"]["length"].as_u64(), answer["plan"]["cost"].as_f64()), (Some(7), Some(7.0)));
    assert_eq!(output(&folder, &["validate", &domain, &problem, &plan]).status.code(), Some(0));
}

/// Counters that all have to be high at once, each step of one lowering another: too many states to see.
fn hard() -> (String, String) {
    let domain = "(define (domain counters) (:requirements :strips :typing :numeric-fluents)
      (:types counter) (:predicates (next ?a ?b - counter)) (:functions (value ?c - counter))
      (:action up :parameters (?a ?b - counter) :precondition (next ?a ?b)
        :effect (and (increase (value ?a) 2) (decrease (value ?b) 2))))";
    let names: Vec<String> = (0..9).map(|i| format!("c{i}")).collect();
    let facts: String = (0..9).map(|i| format!("(next c{i} c{}) (= (value c{i}) 0)", (i + 1) % 9)).collect();
    let goal: String = names.iter().map(|c| format!("(>= (value {c}) 1)")).collect();
    let problem = format!(
        "(define (problem all) (:domain counters) (:objects {} - counter) (:init {facts}) (:goal (and {goal})))",
        names.join(" ")
    );
    (domain.to_owned(), problem)
}

#[test]
fn limits_end_a_search_without_a_claim() {
    let folder = Folder::new("limits");
    let (domain, problem) = hard();
    let (domain, problem) = (folder.file("domain.pddl", &domain), folder.file("problem.pddl", &problem));
    let time = output(&folder, &["plan", &domain, &problem, "--time-limit", "0.5"]);
    assert_eq!(time.status.code(), Some(11));
    let said = String::from_utf8_lossy(&time.stderr).into_owned();
    assert!(said.contains("the time limit is used up"), "{said}");
    let memory = output(&folder, &["plan", &domain, &problem, "--memory-limit", "60", "--time-limit", "60"]);
    assert_eq!(memory.status.code(), Some(11));
    let said = String::from_utf8_lossy(&memory.stderr).into_owned();
    assert!(said.contains("the memory limit is used up"), "{said}");
}

/// Without limits nobody but the search itself looks for the signal.
#[test]
fn an_interrupted_search_says_so() {
    let folder = Folder::new("interrupted");
    let (domain, problem) = hard();
    let (domain, problem) = (folder.file("domain.pddl", &domain), folder.file("problem.pddl", &problem));
    for more in [&[][..], &["--search", "anytime"], &["--time-limit", "60"]] {
        let child = start(&folder, &[&["plan", &domain, &problem][..], more].concat());
        std::thread::sleep(Duration::from_millis(500));
        signal(child.id(), "INT");
        let out = finish(child, Duration::from_secs(5));
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(
            (out.status.code(), said.as_str()),
            (Some(11), "gave up: it was interrupted\n"),
            "{more:?}"
        );
    }
}
