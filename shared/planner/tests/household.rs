//! A small household with everything its domains use: universal and conditional effects, existential goals
//! over different objects of a type, negative and disjunctive preconditions.

mod support;

use std::sync::atomic::AtomicBool;

use lamma_planner::{
    GroundLimits, Limits, Outcome, SearchOptions, Unsolvable, ground, never_together, solve,
};
use support::{Executor, parse};

const DOMAIN: &str = "
(define (domain household)
  (:requirements :adl :typing)
  (:types robot item - object  receptacle food - item  Fridge Counter Microwave - receptacle
          Apple Lettuce Knife - food)
  (:predicates (at ?r - robot ?x - item) (in ?x ?c - item) (holding ?r - robot ?x - item) (hot ?x - item)
    (opened ?c - item) (openable ?c - item) (accepts ?c ?x - item) (sliced ?x - item) (on ?d - item)
    (heats ?d - item) (busy ?r - robot))
  (:action GoToObject :parameters (?r - robot ?x - item)
    :precondition (not (exists (?y - robot) (holding ?y ?x)))
    :effect (and (forall (?y - item) (not (at ?r ?y)))
                 (at ?r ?x)
                 (forall (?c - receptacle) (when (in ?x ?c) (at ?r ?c)))
                 (forall (?y - item) (when (holding ?r ?y) (at ?r ?y)))))
  (:action PickupObject :parameters (?r - robot ?x - food)
    :precondition (and (at ?r ?x) (not (busy ?r))
      (forall (?c - receptacle) (imply (and (in ?x ?c) (openable ?c)) (opened ?c))))
    :effect (and (holding ?r ?x) (busy ?r) (forall (?c - receptacle) (not (in ?x ?c)))))
  (:action PutObject :parameters (?r - robot ?x - food ?c - receptacle)
    :precondition (and (holding ?r ?x) (at ?r ?c) (accepts ?c ?x) (or (not (openable ?c)) (opened ?c)))
    :effect (and (in ?x ?c) (not (holding ?r ?x)) (not (busy ?r))))
  (:action OpenObject :parameters (?r - robot ?c - receptacle)
    :precondition (and (at ?r ?c) (openable ?c) (not (opened ?c)) (not (on ?c)))
    :effect (opened ?c))
  (:action CloseObject :parameters (?r - robot ?c - receptacle)
    :precondition (and (at ?r ?c) (opened ?c)) :effect (not (opened ?c)))
  (:action SliceObject :parameters (?r - robot ?x - food)
    :precondition (and (at ?r ?x) (exists (?k - Knife) (holding ?r ?k)) (not (sliced ?x)))
    :effect (sliced ?x))
  (:action SwitchOn :parameters (?r - robot ?d - receptacle)
    :precondition (and (at ?r ?d) (heats ?d) (not (opened ?d)) (not (on ?d)))
    :effect (and (on ?d) (forall (?x - food) (when (in ?x ?d) (hot ?x))))))";

fn problem(goal: &str) -> String {
    format!(
        "(define (problem p) (:domain household)
          (:objects robot1 - robot Fridge_1 - Fridge Counter_1 Counter_2 - Counter Microwave_1 - Microwave
             Apple_1 Apple_2 Apple_3 - Apple Lettuce_1 - Lettuce Knife_1 Knife_2 - Knife)
          (:init (at robot1 Counter_1) (in Apple_1 Counter_1) (in Apple_2 Counter_2) (in Apple_3 Fridge_1)
             (in Lettuce_1 Counter_2) (in Knife_1 Counter_2) (in Knife_2 Fridge_1)
             (openable Fridge_1) (openable Microwave_1) (heats Microwave_1)
             {})
          (:goal {goal}))",
        ["Apple_1", "Apple_2", "Apple_3", "Lettuce_1", "Knife_1"]
            .iter()
            .flat_map(|x| ["Fridge_1", "Counter_1", "Counter_2", "Microwave_1"]
                .map(|c| format!("(accepts {c} {x})")))
            .collect::<String>()
    )
}

fn solve_goal(goal: &str) -> Outcome {
    let (domain, problem) = parse(DOMAIN, &problem(goal));
    let task = ground(&domain, &problem, &GroundLimits::default()).expect("the task is well formed");
    let limits = Limits { expansions: Some(200_000), ..Limits::default() };
    let outcome = solve(&task, &SearchOptions::default(), &limits, &AtomicBool::new(false));
    if let Outcome::Found(plan) = &outcome {
        let cost = Executor { domain: &domain, problem: &problem }.check(plan);
        assert_eq!(cost, Ok(plan.cost), "{goal}: {plan:?}");
    }
    outcome
}

#[track_caller]
fn length(goal: &str) -> usize {
    match solve_goal(goal) {
        Outcome::Found(plan) => plan.acts.len(),
        other => panic!("{goal}: {other:?}"),
    }
}

#[test]
fn one_apple_in_the_fridge() {
    assert_eq!(length("(in Apple_1 Fridge_1)"), 5, "go, pick up, go, open, put");
    assert_eq!(length("(exists (?a - Apple ?f - Fridge) (in ?a ?f))"), 0, "one is there already");
}

#[test]
fn two_different_apples_and_a_lettuce() {
    let goal = "(exists (?f - Fridge) (and (exists (?a - Apple ?b - Apple)
        (and (not (= ?a ?b)) (in ?a ?f) (in ?b ?f))) (exists (?l - Lettuce) (in ?l ?f))))";
    assert_eq!(length(goal), 9, "one apple and the lettuce are brought");
}

#[test]
fn conjunctions_of_quantified_goals() {
    let goal = "(and (exists (?f - Fridge ?a - Apple) (and (in ?a ?f) (sliced ?a)))
        (exists (?a - Apple) (hot ?a)) (forall (?c - receptacle) (not (opened ?c))))";
    assert!(length(goal) >= 10);
}

#[test]
fn universal_goals() {
    assert_eq!(
        length("(forall (?x - Apple) (in ?x Counter_2))"),
        9,
        "two are elsewhere, one of them behind a door"
    );
    assert_eq!(length("(forall (?c - Counter) (not (opened ?c)))"), 0);
}

#[test]
fn names_keep_their_spelling() {
    let Outcome::Found(plan) = solve_goal("(holding robot1 apple_1)") else { panic!("a plan exists") };
    assert_eq!(plan.acts.last().map(ToString::to_string).as_deref(), Some("(PickupObject robot1 Apple_1)"));
}

#[test]
fn the_unreachable_part_of_the_goal_is_named() {
    let unreachable = |goal| match solve_goal(goal) {
        Outcome::Unsolvable(Unsolvable::Unreachable(facts)) => facts,
        other => panic!("{goal}: {other:?}"),
    };
    assert_eq!(unreachable("(and (in Apple_1 Fridge_1) (in Knife_2 Counter_1))"), ["(in Knife_2 Counter_1)"]);
    assert_eq!(unreachable("(exists (?k - Knife) (hot Fridge_1))"), ["(hot Fridge_1)"]);
    assert_eq!(unreachable("(exists (?a - Apple ?l - Lettuce) (in ?a ?l))"), ["(exists (?a ?l) (in ?a ?l))"]);
    assert_eq!(unreachable("(forall (?x - food) (in ?x Counter_2))"), ["(forall (?x) (in ?x Counter_2))"]);
    assert_eq!(unreachable("(polished Apple_1)"), ["(polished Apple_1)"], "a predicate nobody declared");
}

#[test]
fn an_exhausted_search_is_a_proof() {
    let goal = "(and (holding robot1 Apple_1) (on Microwave_1) (holding robot1 Apple_2))";
    assert_eq!(solve_goal(goal), Outcome::Unsolvable(Unsolvable::Exhausted));
    let (domain, problem) = parse(DOMAIN, &problem(goal));
    let task = ground(&domain, &problem, &GroundLimits::default()).expect("the task is well formed");
    let apart = never_together(&task, 1_000_000).expect("not so many states");
    assert_eq!(
        apart,
        ["(holding robot1 Apple_1)", "(holding robot1 Apple_2)"],
        "the microwave is in nobody's way"
    );
    assert_eq!(never_together(&task, 10), None, "more states than it may look at");
}

#[test]
fn what_only_keeps_an_effect_from_happening_is_needed() {
    let domain = "(define (domain d) (:predicates (c) (l) (g))
        (:action quiet :effect (not (c)))
        (:action go :effect (and (g) (when (c) (not (l))))))";
    let (domain, problem) =
        parse(domain, "(define (problem p) (:domain d) (:init (c) (l)) (:goal (and (g) (l))))");
    let task = ground(&domain, &problem, &GroundLimits::default()).expect("the task is well formed");
    let outcome = solve(&task, &SearchOptions::default(), &Limits::default(), &AtomicBool::new(false));
    assert!(matches!(&outcome, Outcome::Found(plan) if plan.acts.len() == 2), "{outcome:?}");
}

#[test]
fn things_that_cannot_matter_are_not_grounded() {
    let operators = |others: usize| {
        let names: String = (0..others).map(|n| format!("other{n} ")).collect();
        let places: String = (0..others).map(|n| format!("(in other{n} counter) ")).collect();
        let problem = format!(
            "(define (problem p) (:domain kitchen)
               (:objects r - robot counter fridge stove - place apple knife {names} - item)
               (:init (at r counter) (in apple counter) (in knife fridge) (closable fridge) (knife knife)
                 (switchable stove) {places})
               (:goal (and (in apple fridge) (sliced apple) (on stove))))"
        );
        let (domain, problem) = parse(include_str!("../../../tests/planner/kitchen.pddl"), &problem);
        let task = ground(&domain, &problem, &GroundLimits::default()).expect("the task is well formed");
        let outcome = solve(&task, &SearchOptions::default(), &Limits::default(), &AtomicBool::new(false));
        assert!(matches!(outcome, Outcome::Found(_)), "{outcome:?}");
        task.operators.len()
    };
    assert_eq!(operators(40), operators(0));
}
