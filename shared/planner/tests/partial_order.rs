//! What deordering promises: every order that the partial order allows reaches the goal from the same start.
//!
//! Random walks of a team through a small world with doors, hands, joint lifts and conditional effects are deordered
//! for a random part of what they achieve, and then carried out in random other orders, each step on the plain
//! semantics; short ones in every order that the gates allow.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::BTreeSet;
use std::sync::Arc;

use lamma_pddl::ast::{Condition, GroundAtom, Init, TypedName};
use lamma_pddl::{Source, parse_condition, parse_domain, parse_ground_atom};
use lamma_planner::partial_order::{PartialOrder, TeamStep, deorder};
use lamma_planner::{GroundAct, GroundCondition, Interpreter, WorldState};
use proptest::prelude::*;

const DOMAIN: &str = "(define (domain flat)
  (:requirements :typing :negative-preconditions :conditional-effects :universal-preconditions)
  (:types robot thing place lamp)
  (:predicates (at ?r - robot ?p - place) (in ?x - thing ?p - place) (holding ?r - robot ?x - thing)
    (free ?r - robot) (open ?p - place) (lit ?p - place) (seen ?x - thing) (powered)
    (helping ?r - robot ?x - thing))
  (:action go :parameters (?r - robot ?p - place) :precondition (forall (?x - thing) (not (helping ?r ?x)))
    :effect (and (forall (?q - place) (not (at ?r ?q))) (at ?r ?p)))
  (:action visit :parameters (?r - robot ?x - thing)
    :precondition (forall (?y - thing) (not (helping ?r ?y)))
    :effect (and (forall (?q - place) (not (at ?r ?q))) (forall (?q - place) (when (in ?x ?q) (at ?r ?q)))))
  (:action open :parameters (?r - robot ?p - place)
    :precondition (and (at ?r ?p) (not (open ?p))) :effect (open ?p))
  (:action close :parameters (?r - robot ?p - place)
    :precondition (and (at ?r ?p) (open ?p)) :effect (not (open ?p)))
  (:action pick :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (in ?x ?p) (free ?r) (open ?p))
    :effect (and (holding ?r ?x) (not (free ?r)) (not (in ?x ?p)) (not (seen ?x))))
  (:action put :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (holding ?r ?x) (open ?p))
    :effect (and (in ?x ?p) (free ?r) (not (holding ?r ?x)) (when (lit ?p) (seen ?x))))
  (:action help :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (in ?x ?p) (free ?r)) :effect (and (helping ?r ?x) (not (free ?r))))
  (:action withdraw :parameters (?r - robot ?x - thing)
    :precondition (helping ?r ?x) :effect (and (not (helping ?r ?x)) (free ?r)))
  (:action haul :parameters (?r ?h - robot ?x - thing ?p ?q - place)
    :precondition (and (not (= ?r ?h)) (at ?r ?p) (in ?x ?p) (free ?r) (helping ?h ?x))
    :effect (and (not (in ?x ?p)) (in ?x ?q) (not (helping ?h ?x)) (free ?h)
      (forall (?o - place) (and (not (at ?r ?o)) (not (at ?h ?o)))) (at ?r ?q) (at ?h ?q)
      (not (seen ?x)) (when (lit ?q) (seen ?x))))
  (:action power :parameters (?r - robot) :precondition ()
    :effect (and (when (powered) (not (powered))) (when (not (powered)) (powered))))
  (:action light :parameters (?r - robot ?p - place)
    :precondition (and (at ?r ?p) (or (powered) (open ?p)))
    :effect (and (lit ?p) (forall (?x - thing) (when (in ?x ?p) (seen ?x))))))";

struct World {
    interpreter: Interpreter,
    initial: WorldState,
    acts: Vec<(usize, GroundAct)>,
}

fn world() -> World {
    let domain = parse_domain(&Source::new("flat.pddl", DOMAIN)).unwrap().value;
    let (robots, things, places) = (["r1", "r2", "r3"], ["x", "y"], ["a", "b", "c"]);
    let typed = |names: &[&str], of: &str| names.iter().map(|n| TypedName::new(*n, of)).collect::<Vec<_>>();
    let objects = [typed(&robots, "robot"), typed(&things, "thing"), typed(&places, "place")].concat();
    let interpreter = Interpreter::new(&domain, &objects).unwrap();
    let facts = [
        "(at r1 a)",
        "(at r2 b)",
        "(at r3 c)",
        "(free r1)",
        "(free r2)",
        "(free r3)",
        "(in x a)",
        "(in y b)",
        "(open a)",
    ];
    let init: Vec<Init> = facts.iter().map(|f| Init::Fact(parse_ground_atom(f).unwrap())).collect();
    let initial = interpreter.initial(&init).unwrap();
    let mut acts = Vec::new();
    for (agent, r) in robots.iter().enumerate() {
        acts.push((agent, GroundAct::new("power", [*r])));
        acts.extend(things.map(|x| (agent, GroundAct::new("visit", [*r, x]))));
        for p in places {
            for action in ["go", "open", "close", "light"] {
                acts.push((agent, GroundAct::new(action, [*r, p])));
            }
            for x in things {
                acts.push((agent, GroundAct::new("pick", [*r, x, p])));
                acts.push((agent, GroundAct::new("put", [*r, x, p])));
                acts.push((agent, GroundAct::new("help", [*r, x, p])));
                for (h, q) in robots.iter().flat_map(|h| places.map(|q| (h, q))).filter(|(h, _)| *h != r) {
                    acts.push((agent, GroundAct::new("haul", [*r, h, x, p, q])));
                }
            }
        }
        acts.extend(things.map(|x| (agent, GroundAct::new("withdraw", [*r, x]))));
    }
    World { interpreter, initial, acts }
}

/// A valid walk: of the acts drawn, those that are possible.
fn walk(world: &World, draws: &[usize]) -> Vec<TeamStep> {
    let mut state = world.initial.clone();
    let mut steps = Vec::new();
    for draw in draws {
        let (agent, act) = &world.acts[draw % world.acts.len()];
        let action = world.interpreter.instantiate(act).unwrap();
        if world.interpreter.apply(&mut state, &action).is_ok() {
            steps.push(TeamStep { agent: *agent, action: Arc::new(action) });
        }
    }
    steps
}

/// Some of what holds at the end, and some of what does not.
fn goal(world: &World, end: &WorldState, draws: &[usize]) -> GroundCondition {
    let facts: Vec<String> = end.facts.iter().map(ToString::to_string).collect();
    let mut parts: Vec<Condition> =
        draws.iter().map(|d| parse_condition(&facts[d % facts.len()]).unwrap()).collect();
    for absent in ["(powered)", "(open b)", "(seen x)", "(in y b)"] {
        if !facts.iter().any(|f| f == absent) {
            parts.push(parse_condition(&format!("(not {absent})")).unwrap());
        }
    }
    world.interpreter.ground_condition(&Condition::And(parts)).unwrap()
}

/// A random walk of at most `length` steps, deordered for some of what it achieves, with orderings to `keep`.
struct Case {
    world: World,
    goal: GroundCondition,
    order: PartialOrder,
    keep: Vec<(usize, usize)>,
}

fn case(draws: &[usize], wanted: &[usize], length: usize) -> Result<Case, TestCaseError> {
    let world = world();
    let steps: Vec<TeamStep> = walk(&world, draws).into_iter().take(length).collect();
    let mut reached = world.initial.clone();
    for step in &steps {
        world.interpreter.apply(&mut reached, &step.action).unwrap();
    }
    let goal = goal(&world, &reached, wanted);
    let pair = |draw: &usize| (draw % steps.len().max(1), draw / 1_000 % steps.len().max(1));
    let keep: Vec<(usize, usize)> = wanted.iter().map(pair).filter(|(a, b)| a < b).collect();
    let order = deorder(&world.interpreter, &world.initial, steps, &goal, &keep)
        .map_err(|(i, v)| TestCaseError::fail(format!("step {i}: {v}")))?;
    prop_assert!(order.makespan() <= order.steps.len() as f64);
    Ok(Case { world, goal, order, keep })
}

/// Carries the steps out in the order in which `draws` picks from those that may go next.
fn carry_out(
    world: &World,
    order: &PartialOrder,
    draws: &[usize],
) -> Result<(WorldState, Vec<usize>), String> {
    let mut sequence = Vec::with_capacity(order.steps.len());
    let mut state = world.initial.clone();
    let mut done = vec![false; order.steps.len()];
    for turn in 0..order.steps.len() {
        let ready: Vec<usize> =
            (0..done.len()).filter(|&i| !done[i] && order.before[i].iter().all(|&p| done[p])).collect();
        let next = ready[draws[turn % draws.len()] % ready.len()];
        let step = &order.steps[next];
        world
            .interpreter
            .apply(&mut state, &step.action)
            .map_err(|v| format!("step {next}, {}: {v}", step.action.act))?;
        done[next] = true;
        sequence.push(next);
    }
    Ok((state, sequence))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn every_allowed_order_reaches_the_goal(
        draws in proptest::collection::vec(any::<usize>(), 20..400),
        wanted in proptest::collection::vec(any::<usize>(), 1..4),
        orders in proptest::collection::vec(proptest::collection::vec(any::<usize>(), 7..30), 6),
    ) {
        let Case { world, goal, order, keep } = case(&draws, &wanted, 14)?;
        for draws in &orders {
            let (state, sequence) = carry_out(&world, &order, draws).map_err(TestCaseError::fail)?;
            let place = |step: usize| sequence.iter().position(|&s| s == step);
            prop_assert!(keep.iter().all(|&(a, b)| place(a) < place(b)), "{keep:?} in {sequence:?}");
            prop_assert!(world.interpreter.holds(&state, &goal), "{goal} does not hold after another order");
        }
    }
}

/// Everything that can happen when each agent does its steps in order, each as soon or as late as its gates
/// allow: by how far everybody is, all states that the world can be in.
fn all_interleavings(world: &World, order: &PartialOrder, goal: &GroundCondition) -> Result<usize, String> {
    let gates = order.gates();
    let mut own: Vec<Vec<usize>> = vec![Vec::new(); 3];
    for (i, step) in order.steps.iter().enumerate() {
        own[step.agent].push(i);
    }
    let mut seen: BTreeSet<(Vec<u32>, BTreeSet<GroundAtom>)> = BTreeSet::new();
    let mut open = vec![(vec![0u32; 3], world.initial.clone())];
    while let Some((done, state)) = open.pop() {
        if !seen.insert((done.clone(), state.facts.clone())) {
            continue;
        }
        let mut stuck = true;
        for agent in 0..3 {
            let Some(&next) = own[agent].get(done[agent] as usize) else { continue };
            if gates[next].iter().all(|&(other, count)| done[other] >= count) {
                stuck = false;
                let (mut done, mut after) = (done.clone(), state.clone());
                let action = &order.steps[next].action;
                world
                    .interpreter
                    .apply(&mut after, action)
                    .map_err(|v| format!("{} after {done:?}: {v}", action.act))?;
                done[agent] += 1;
                open.push((done, after));
            }
        }
        let finished = (0..3).all(|a| done[a] as usize == own[a].len());
        if stuck && !finished {
            return Err(format!("everybody waits after {done:?}"));
        }
        if finished && !world.interpreter.holds(&state, goal) {
            return Err(format!("{goal} does not hold at the end of some interleaving"));
        }
    }
    Ok(seen.len())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn every_interleaving_that_the_gates_allow_reaches_the_goal(
        draws in proptest::collection::vec(any::<usize>(), 20..400),
        wanted in proptest::collection::vec(any::<usize>(), 1..4),
    ) {
        let Case { world, goal, order, .. } = case(&draws, &wanted, 10)?;
        all_interleavings(&world, &order, &goal).map_err(TestCaseError::fail)?;
    }
}

/// A team's gates let through what the partial order lets through.
#[test]
fn independent_robots_wait_for_nobody_and_a_hand_over_has_one_gate() {
    let world = world();
    let acts = [
        (0, "go r1 a"),
        (1, "go r2 b"),
        (1, "open r2 b"),
        (0, "pick r1 x a"),
        (0, "go r1 b"),
        (0, "put r1 x b"),
    ];
    let steps = acts.iter().map(|(agent, text)| {
        let mut words = text.split(' ');
        let act = GroundAct::new(words.next().unwrap(), words);
        TeamStep { agent: *agent, action: Arc::new(world.interpreter.instantiate(&act).unwrap()) }
    });
    let goal = world.interpreter.ground_condition(&parse_condition("(in x b)").unwrap()).unwrap();
    let order = deorder(&world.interpreter, &world.initial, steps.collect(), &goal, &[]).unwrap();
    assert_eq!(order.makespan(), 4.0);
    let gates: Vec<_> = order.gates().into_iter().enumerate().filter(|(_, g)| !g.is_empty()).collect();
    assert_eq!(gates, [(5, vec![(1, 2)])], "only the putting waits, for the door");
}
