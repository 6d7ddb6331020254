//! Planning over numbers: what conditions ask for, what effects do, and what is said where nothing helps.

mod support;

use std::sync::atomic::AtomicBool;

use lamma_planner::{
    Engine, GroundLimits, Limits, Outcome, Plan, SearchOptions, Unsolvable, ground, solve, validate,
};
use support::parse;

fn outcome(domain: &str, problem: &str, engine: Engine) -> Outcome {
    let (domain, problem) = parse(
        &format!("(define (domain d) {domain})"),
        &format!("(define (problem p) (:domain d) {problem})"),
    );
    let task = ground(&domain, &problem, &GroundLimits::default()).expect("a sound task");
    let options = SearchOptions { engine, ..SearchOptions::default() };
    let limits = Limits { expansions: Some(200_000), ..Limits::default() };
    let outcome = solve(&task, &options, &limits, &AtomicBool::new(false));
    if let Outcome::Found(plan) = &outcome {
        let verdict = validate(&domain, &problem, &plan.acts).expect("a sound task");
        assert!(verdict.is_valid(), "{verdict} in {plan:?}");
    }
    outcome
}

/// The cheapest plan, which the default search finds some plan beside.
fn cheapest(domain: &str, problem: &str) -> Plan {
    match (outcome(domain, problem, Engine::Portfolio), outcome(domain, problem, Engine::AstarLmcut)) {
        (Outcome::Found(_), Outcome::Found(plan)) => plan,
        others => panic!("no plan: {others:?}"),
    }
}

fn unreachable(domain: &str, problem: &str) -> String {
    match outcome(domain, problem, Engine::Portfolio) {
        Outcome::Unsolvable(Unsolvable::Unreachable(parts)) => parts.join(", "),
        other => panic!("not proved at once: {other:?}"),
    }
}

const FRIDGE: &str = "(:requirements :strips :typing :numeric-fluents :disjunctive-preconditions)
    (:types robot thing)
    (:predicates (at ?r - robot ?x - thing) (in ?x ?y - thing) (holding ?r - robot ?x - thing)
                 (fridge ?x - thing))
    (:functions (doors-open ?x - thing))
    (:action go :parameters (?r - robot ?x - thing)
      :effect (and (at ?r ?x) (forall (?y - thing) (when (and (at ?r ?y) (not (= ?x ?y))) (not (at ?r ?y))))))
    (:action open :parameters (?r - robot ?x - thing) :precondition (and (at ?r ?x) (fridge ?x))
      :effect (increase (doors-open ?x) 1))
    (:action put :parameters (?r - robot ?x ?y - thing)
      :precondition (and (holding ?r ?x) (at ?r ?y) (or (not (fridge ?y)) (> (doors-open ?y) 0)))
      :effect (and (in ?x ?y) (not (holding ?r ?x))))";

#[test]
fn a_door_counted_by_a_number_is_opened_first() {
    let objects = "(:objects r - robot f apple - thing)";
    let plan = cheapest(
        FRIDGE,
        &format!("{objects} (:init (fridge f) (holding r apple) (= (doors-open f) 0)) (:goal (in apple f))"),
    );
    let acts: Vec<String> = plan.acts.iter().map(ToString::to_string).collect();
    assert_eq!(acts, ["(go r f)", "(open r f)", "(put r apple f)"]);
    let why =
        unreachable(FRIDGE, &format!("{objects} (:init (fridge f) (holding r apple)) (:goal (in apple f))"));
    assert_eq!(why, "(in apple f)", "a number without a value never grows");
    let (domain, problem) = parse(
        &format!("(define (domain d) {FRIDGE})"),
        &format!(
            "(define (problem p) (:domain d) {objects} (:init (fridge f) (holding r apple)) (:goal (in apple f)))"
        ),
    );
    let task = ground(&domain, &problem, &GroundLimits::default()).expect("a sound task");
    assert!(task.warnings.concat().starts_with("(doors-open f) is asked for"), "{:?}", task.warnings);
}

#[test]
fn counting_is_guided_and_exact() {
    let domain = "(:functions (x) (y))
        (:action more :parameters () :effect (increase (x) 1))
        (:action double :parameters () :precondition (> (x) 0) :effect (scale-up (x) 2))
        (:action less :parameters () :precondition (>= (x) 5) :effect (and (decrease (x) 5) (increase (y) 1)))";
    let plan = cheapest(domain, "(:init (= (x) 0) (= (y) 0)) (:goal (and (= (x) 1) (>= (y) 2)))");
    assert_eq!(plan.acts.len(), 7, "1 2 3 6 1 … or 1 2 4 8 11 …: {plan:?}");
    let far = "(:init (= (x) 0) (= (y) 0)) (:goal (> (x) 250.5))";
    let only_more = "(:functions (x) (y)) (:action more :parameters () :effect (increase (x) 1))
        (:action other :parameters () :effect (increase (y) 1))";
    match outcome(only_more, far, Engine::Portfolio) {
        Outcome::Found(plan) => assert_eq!(plan.acts.len(), 251),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_no_number_can_reach_is_proved_and_named() {
    let domain = "(:functions (x) (y)) (:action more :parameters () :effect (increase (x) 1))
        (:action swap :parameters () :effect (and (assign (y) (x)) (assign (x) (y))))";
    let why = unreachable(domain, "(:init (= (x) 1) (= (y) 2)) (:goal (and (> (x) 3) (< (+ (x) (y)) 2)))");
    assert_eq!(why, "(> 2 (+ (x) (y)))");
    assert_eq!(unreachable(domain, "(:init (= (x) 1) (= (y) 2)) (:goal (> 1 2))"), "(> 1 2)");
}

#[test]
fn actions_without_a_result_do_not_apply() {
    let domain = "(:predicates (p)) (:functions (x) (y) (z))
        (:action divide :parameters () :effect (and (p) (scale-down (x) (y))))
        (:action read :parameters () :effect (and (p) (assign (x) (z))))
        (:action more :parameters () :effect (increase (y) 1))
        (:action learn :parameters () :precondition (> (x) 1) :effect (assign (z) 3))";
    let plan = cheapest(domain, "(:init (= (x) 1) (= (y) 0)) (:goal (p))");
    assert_eq!(plan.acts.len(), 2, "{plan:?}");
    let plan = cheapest(domain, "(:init (= (x) 2) (= (y) 0)) (:goal (and (p) (= (x) 3)))");
    assert_eq!(plan.acts.len(), 2, "learn, then read: {plan:?}");
}

#[test]
fn metrics_that_are_sums_are_minimised_and_others_are_owned_up_to() {
    let domain = "(:predicates (there)) (:functions (fuel) (tolls))
        (:action road :parameters () :effect (and (there) (increase (fuel) 5)))
        (:action motorway :parameters () :effect (and (there) (increase (fuel) 2) (increase (tolls) 1)))";
    let problem =
        |metric: &str| format!("(:init (= (fuel) 0) (= (tolls) 0)) (:goal (there)) (:metric {metric})");
    let first = |metric: &str| cheapest(domain, &problem(metric)).acts[0].to_string();
    assert_eq!(first("minimize (+ (fuel) (tolls))"), "(motorway)");
    assert_eq!(first("minimize (+ (fuel) (* 10 (tolls)))"), "(road)");
    assert_eq!(first("maximize (- 0 (fuel))"), "(motorway)");
    let warnings = |metric: &str| {
        let (domain, problem) = parse(
            &format!("(define (domain d) {domain})"),
            &format!("(define (problem p) (:domain d) {})", problem(metric)),
        );
        ground(&domain, &problem, &GroundLimits::default()).expect("a sound task").warnings.join("; ")
    };
    assert_eq!(warnings("minimize (fuel)"), "");
    assert!(warnings("maximize (fuel)").contains("rewards long plans"), "{}", warnings("maximize (fuel)"));
    assert!(warnings("minimize (* (fuel) (tolls))").contains("no weighted sum"));
}

#[test]
fn a_cost_that_is_read_is_a_number_as_well() {
    let domain = "(:predicates (there)) (:functions (total-cost))
        (:action dear :parameters () :effect (and (there) (increase (total-cost) 5)))
        (:action cheap :parameters () :effect (and (there) (increase (total-cost) 2)))";
    let plan =
        cheapest(domain, "(:init) (:goal (and (there) (>= (total-cost) 6))) (:metric minimize (total-cost))");
    assert_eq!(plan.cost, 6.0, "three times cheap: {plan:?}");
}
