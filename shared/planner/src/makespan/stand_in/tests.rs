//! Schedules with and without what is left out, compared.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, GroundAtom, Init, Problem, TypedName};
use lamma_pddl::{Name, Source, parse_condition, parse_domain};

use crate::makespan::together::Together;
use crate::{GroundLimits, MakespanLimits, OperatorId, Scheduler, Task, ground};

/// Tables, cupboards with doors, a sink.
const DOMAIN: &str = "(define (domain kitchen)
  (:requirements :typing :negative-preconditions :conditional-effects)
  (:types robot item place)
  (:predicates (at ?r - robot ?p - place) (near ?r - robot ?x - item) (in ?x - item ?p - place)
    (holding ?r - robot ?x - item) (free ?r - robot) (door ?p - place) (open ?p - place) (exposed ?x - item)
    (clean ?x - item) (washes ?p - place) (opens ?r - robot) (carries ?r - robot) (seen ?x - item))
  (:action go :parameters (?r - robot ?p - place) :precondition ()
    :effect (and (forall (?q - place) (not (at ?r ?q))) (forall (?y - item) (not (near ?r ?y))) (at ?r ?p)
      (forall (?y - item) (when (in ?y ?p) (near ?r ?y)))))
  (:action open :parameters (?r - robot ?p - place)
    :precondition (and (opens ?r) (door ?p) (at ?r ?p) (not (open ?p)))
    :effect (and (open ?p) (forall (?x - item) (when (in ?x ?p) (exposed ?x)))))
  (:action close :parameters (?r - robot ?p - place)
    :precondition (and (opens ?r) (door ?p) (at ?r ?p) (open ?p))
    :effect (and (not (open ?p)) (forall (?x - item) (when (in ?x ?p) (not (exposed ?x))))))
  (:action pick :parameters (?r - robot ?x - item ?p - place)
    :precondition (and (carries ?r) (free ?r) (near ?r ?x) (at ?r ?p) (in ?x ?p) (open ?p))
    :effect (and (holding ?r ?x) (not (free ?r)) (not (in ?x ?p)) (not (exposed ?x))
      (forall (?a - robot) (not (near ?a ?x)))))
  (:action put :parameters (?r - robot ?x - item ?p - place)
    :precondition (and (at ?r ?p) (holding ?r ?x) (open ?p))
    :effect (and (in ?x ?p) (free ?r) (not (holding ?r ?x)) (near ?r ?x) (exposed ?x)
      (when (washes ?p) (clean ?x))))
  (:action look :parameters (?r - robot ?x - item)
    :precondition (and (opens ?r) (near ?r ?x) (exposed ?x)) :effect (seen ?x)))";

const PLACES: [&str; 6] = ["table1", "table2", "shelf", "cupboard1", "cupboard2", "sink"];
const GOALS: [&str; 9] = [
    "(in x cupboard1)",
    "(in y cupboard1)",
    "(not (open cupboard1))",
    "(not (open cupboard2))",
    "(clean x)",
    "(clean y)",
    "(seen x)",
    "(in y table2)",
    "(holding r1 y)",
];

/// A start and a goal of three parts, drawn by `bits`.
fn task(mut bits: u64) -> Task {
    let mut draw = |of: u64| {
        let drawn = bits % of;
        bits /= of;
        drawn as usize
    };
    let typed = |names: &[&str], of: &str| names.iter().map(|n| TypedName::new(*n, of)).collect::<Vec<_>>();
    let mut facts = Vec::new();
    for item in ["x", "y"] {
        let place = draw(5);
        facts.push(GroundAtom::new("in", [item, PLACES[place]]));
        if place < 3 {
            facts.push(GroundAtom::new("exposed", [item]));
        }
    }
    for robot in ["r1", "r2"] {
        facts.push(GroundAtom::new("at", [robot, "shelf"]));
        facts.push(GroundAtom::new("free", [robot]));
        let skills = [&["opens"][..], &["carries"], &["opens", "carries"]][draw(3)];
        facts.extend(skills.iter().map(|skill| GroundAtom::new(*skill, [robot])));
    }
    let open = ["table1", "table2", "shelf", "sink"].map(|place| GroundAtom::new("open", [place]));
    let doors = ["cupboard1", "cupboard2"].map(|place| GroundAtom::new("door", [place]));
    facts.extend(open.into_iter().chain(doors));
    facts.push(GroundAtom::new("washes", ["sink"]));
    let goals = (0..3).map(|_| parse_condition(GOALS[draw(9)]).unwrap()).collect();
    let domain = parse_domain(&Source::new("kitchen.pddl", DOMAIN)).unwrap().value;
    let problem = Problem {
        name: Name::new("p"),
        domain: Name::new("kitchen"),
        objects: [typed(&["r1", "r2"], "robot"), typed(&["x", "y"], "item"), typed(&PLACES, "place")]
            .concat(),
        init: facts.into_iter().map(Init::Fact).collect(),
        goal: Condition::And(goals),
        metric: None,
    };
    ground(&domain, &problem, &GroundLimits::default()).unwrap()
}

#[test]
fn what_is_left_out_makes_no_schedule_longer() {
    let (mut compared, mut left_out) = (0, 0);
    for case in 0..120_u64 {
        let task = task(case.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 16);
        let of: Vec<u32> = (0..task.operators.len() as u32)
            .map(|o| u32::from(task.act(OperatorId(o)).args[0] == "r2"))
            .collect();
        let Some(scheduler) = Scheduler::new(&task, &of) else { continue };
        let left = scheduler.relevant.iter().filter(|&&relevant| relevant).count();
        let limits = MakespanLimits::default();
        let shortest = |scheduler: &Scheduler<'_>| {
            let found = scheduler.shortest(0, Some(9), &limits, &AtomicBool::new(false));
            (found.lower_bound, found.schedule.map(|schedule| schedule.makespan()))
        };
        let found = shortest(&scheduler);
        let Some(mut plain) = Scheduler::new(&task, &of) else { continue };
        plain.relevant = vec![true; task.operators.len()];
        plain.together = Together::default();
        let expected = shortest(&plain);
        assert_eq!(found, expected, "case {case}");
        compared += 1;
        left_out += usize::from(2 * left < task.operators.len());
    }
    assert!(compared > 60 && 4 * left_out > compared, "{left_out} of {compared} got less than half as large");
}
