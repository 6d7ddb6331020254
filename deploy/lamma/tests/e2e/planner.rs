//! The planner and the validator alone.

use crate::tools::{Folder, output};

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
