//! Schedules of tasks without conditional effects, where the planning graph with its exclusions says what can hold
//! together: against a search through all that two vans can do in a step, on drawn tasks.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::{Source, parse_domain, parse_problem};
use lamma_planner::{
    GroundLimits, Limits, MakespanLimits, OperatorId, Outcome, Scheduler, Task, ground, solve,
};
use proptest::prelude::*;

const DOMAIN: &str = "(define (domain vans)
  (:requirements :typing)
  (:types van box place level)
  (:predicates (at ?v - van ?p - place) (in ?b - box ?p - place) (aboard ?b - box ?v - van) (empty ?v - van)
    (road ?p ?q - place) (fuel ?v - van ?l - level) (less ?l ?m - level))
  (:action drive :parameters (?v - van ?p ?q - place ?l ?m - level)
    :precondition (and (at ?v ?p) (road ?p ?q) (fuel ?v ?l) (less ?m ?l))
    :effect (and (not (at ?v ?p)) (at ?v ?q) (not (fuel ?v ?l)) (fuel ?v ?m)))
  (:action load :parameters (?v - van ?b - box ?p - place)
    :precondition (and (at ?v ?p) (in ?b ?p) (empty ?v))
    :effect (and (not (in ?b ?p)) (not (empty ?v)) (aboard ?b ?v)))
  (:action unload :parameters (?v - van ?b - box ?p - place)
    :precondition (and (at ?v ?p) (aboard ?b ?v))
    :effect (and (not (aboard ?b ?v)) (empty ?v) (in ?b ?p))))";

const PLACES: [&str; 3] = ["a", "b", "c"];

/// Two vans and two boxes on a road of three places.
fn task(vans: [usize; 2], fuel: [usize; 2], from: [usize; 2], to: [usize; 2]) -> Task {
    let at = |i: usize| PLACES[i];
    let problem = format!(
        "(define (problem p) (:domain vans)
          (:objects v w - van x y - box a b c - place l0 l1 l2 l3 l4 - level)
          (:init (at v {}) (at w {}) (fuel v l{}) (fuel w l{}) (in x {}) (in y {}) (empty v) (empty w)
            (road a b) (road b a) (road b c) (road c b) (less l0 l1) (less l1 l2) (less l2 l3) (less l3 l4))
          (:goal (and (in x {}) (in y {}))))",
        at(vans[0]),
        at(vans[1]),
        fuel[0],
        fuel[1],
        at(from[0]),
        at(from[1]),
        at(to[0]),
        at(to[1]),
    );
    grounded(problem)
}

fn grounded(problem: String) -> Task {
    let domain = parse_domain(&Source::new("vans.pddl", DOMAIN)).unwrap().value;
    let problem = parse_problem(&Source::new("p.pddl", problem)).unwrap().value;
    ground(&domain, &problem, &GroundLimits::default()).unwrap()
}

fn operators(task: &Task) -> impl Iterator<Item = OperatorId> + use<> {
    (0..task.operators.len() as u32).map(OperatorId)
}

fn agents(task: &Task) -> Vec<u32> {
    operators(task).map(|operator| u32::from(task.act(operator).args[0].as_str() == "w")).collect()
}

fn after(task: &Task, state: &[u64], plan: &[OperatorId]) -> Option<Vec<u64>> {
    let (mut state, mut next) = (state.to_vec(), state.to_vec());
    for &operator in plan {
        if !task.applicable(&state, operator) {
            return None;
        }
        task.apply(&state, operator, &mut next);
        std::mem::swap(&mut state, &mut next);
    }
    Some(state)
}

/// The fewest steps, by looking at all states; in a step each van does at most one thing, and the order of the two
/// makes no difference. `None` if the goal is out of reach.
fn fewest(task: &Task) -> Option<u32> {
    if !task.impossible.is_empty() {
        return None;
    }
    let agent = agents(task);
    let of = |van: u32| operators(task).filter(|o| agent[o.index()] == van).collect::<Vec<_>>();
    let (first, second) = (of(0), of(1));
    let mut seen = BTreeSet::from([task.init.clone()]);
    let mut layer = vec![task.init.clone()];
    let mut steps = 0;
    while !layer.is_empty() {
        if layer.iter().any(|state| task.is_goal(state)) {
            return Some(steps);
        }
        let mut next = Vec::new();
        for state in &layer {
            let mut reached: Vec<Vec<u64>> =
                operators(task).filter_map(|o| after(task, state, &[o])).collect();
            for (&a, &b) in first.iter().flat_map(|a| second.iter().map(move |b| (a, b))) {
                let both = after(task, state, &[a, b]);
                if both == after(task, state, &[b, a]) {
                    reached.extend(both);
                }
            }
            next.extend(reached.into_iter().filter(|state| seen.insert(state.clone())));
        }
        layer = next;
        steps += 1;
    }
    None
}

/// The plan found first.
fn first(task: &Task) -> Option<Vec<OperatorId>> {
    match solve(task, &Default::default(), &Limits::default(), &AtomicBool::new(false)) {
        Outcome::Found(plan) => task.trace(&plan),
        Outcome::Unsolvable(_) | Outcome::GaveUp(_) => None,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_planning_graph_excludes_no_schedule(
        vans in [0usize..3, 0usize..3], fuel in [0usize..5, 0usize..5], from in [0usize..3, 0usize..3],
        to in [0usize..3, 0usize..3]
    ) {
        let task = task(vans, fuel, from, to);
        let never = AtomicBool::new(false);
        let fewest = fewest(&task);
        let Some(scheduler) = Scheduler::new(&task, &agents(&task)) else {
            prop_assert_eq!(fewest, None);
            return Ok(());
        };
        let Some(fewest) = fewest else { return Ok(()) };
        prop_assert!(scheduler.depth() <= fewest && scheduler.work(64) <= fewest);
        let limits = MakespanLimits::default();
        let shortest = scheduler.shortest(0, Some(fewest + 3), &limits, &never);
        prop_assert_eq!(shortest.lower_bound, Some(fewest));
        prop_assert_eq!(shortest.schedule.map(|schedule| schedule.makespan()), Some(fewest));
    }

    #[test]
    fn a_plan_gets_no_longer_and_stays_a_plan(
        vans in [0usize..3, 0usize..3], fuel in [0usize..5, 0usize..5], from in [0usize..3, 0usize..3],
        to in [0usize..3, 0usize..3], work in 0u64..300_000
    ) {
        let task = task(vans, fuel, from, to);
        let (Some(plan), Some(fewest)) = (first(&task), fewest(&task)) else { return Ok(()) };
        let scheduler = Scheduler::new(&task, &agents(&task)).unwrap();
        let before = scheduler.makespan_of(&plan).unwrap();
        let limits = MakespanLimits { work, ..MakespanLimits::default() };
        let found = scheduler.improve(&plan, before, 0, &limits, &AtomicBool::new(false));
        prop_assert!(found.lower_bound.is_some_and(|bound| bound <= fewest));
        if let Some(schedule) = found.schedule {
            let operators: Vec<OperatorId> = schedule.operators().collect();
            prop_assert!(after(&task, &task.init, &operators).is_some_and(|end| task.is_goal(&end)));
            prop_assert!((fewest..before).contains(&schedule.makespan()));
            prop_assert_eq!(scheduler.makespan_of(&operators), Some(schedule.makespan()));
        }
    }
}

#[test]
fn what_one_van_must_do_one_after_the_other_is_seen_to_take_that_long() {
    // One van has fuel, and its one box at a time: two tours, of which nothing can be done at once.
    let task = task([0, 2], [4, 0], [0, 0], [1, 1]);
    let scheduler = Scheduler::new(&task, &agents(&task)).unwrap();
    assert_eq!(fewest(&task), Some(7));
    // Without exclusions: load, drive, unload.
    assert!(scheduler.depth() > 3, "{}", scheduler.depth());
}

#[test]
fn many_errands_are_shared_out() {
    // Twenty boxes, one at a time: a tour of six steps for each, and no drive home after the last.
    let boxes: Vec<String> = (0..20).map(|i| format!("b{i}")).collect();
    let all = |text: &dyn Fn(&String) -> String| boxes.iter().map(text).collect::<String>();
    let task = grounded(format!(
        "(define (problem p) (:domain vans) (:objects v w - van {}- box a b c - place l - level)
          (:init (at v a) (at w a) (fuel v l) (fuel w l) (less l l) (empty v) (empty w)
            (road a b) (road b a) (road b c) (road c b) {})
          (:goal (and {})))",
        all(&|b| format!("{b} ")),
        all(&|b| format!("(in {b} a)")),
        all(&|b| format!("(in {b} c)")),
    ));
    let act = |text: String| operators(&task).find(|&o| task.act(o).to_string() == text).unwrap();
    let tour = |b: &String| {
        let drive = |from: &str, to: &str| format!("(drive v {from} {to} l l)");
        let there =
            [format!("(load v {b} a)"), drive("a", "b"), drive("b", "c"), format!("(unload v {b} c)")];
        there.into_iter().chain([drive("c", "b"), drive("b", "a")]).map(act).collect::<Vec<_>>()
    };
    let alone: Vec<OperatorId> = boxes.iter().flat_map(tour).collect();
    let scheduler = Scheduler::new(&task, &agents(&task)).unwrap();
    let before = scheduler.makespan_of(&alone).unwrap();
    assert_eq!(before, 120);
    let limits = MakespanLimits { work: 100_000, ..MakespanLimits::default() };
    let found = scheduler.improve(&alone, before, 0, &limits, &AtomicBool::new(false));
    assert_eq!(found.schedule.map(|schedule| schedule.makespan()), Some(58));
}
