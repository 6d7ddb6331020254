//! Every heuristic keeps what it promises, on all states of small tasks solved exhaustively.

#[path = "support/random.rs"]
mod random;

use std::collections::{BTreeMap, VecDeque};

use lamma_pddl::ast::{Domain, Problem};
use lamma_planner::heuristic::{Blind, Costs, Estimate, Heuristic, LandmarkCut, Relaxation};
use lamma_planner::{GroundLimits, OperatorId, State, Task, ground};

/// All reachable states, their true distances (`None`: no way to the goal) and transitions.
struct Space {
    states: Vec<Vec<u64>>,
    distance: Vec<Option<u32>>,
    transitions: Vec<(usize, OperatorId, usize)>,
}

fn explore(task: &Task) -> Space {
    let mut ids = BTreeMap::from([(task.initial_state(), 0usize)]);
    let mut states = vec![task.init.clone()];
    let mut transitions = Vec::new();
    let mut at = 0;
    while at < states.len() {
        let state = states[at].clone();
        let mut next = state.clone();
        for operator in (0..task.operators.len() as u32).map(OperatorId) {
            if task.applicable(&state, operator) {
                task.apply(&state, operator, &mut next);
                let id = *ids.entry(State(next.clone().into_boxed_slice())).or_insert_with(|| {
                    states.push(next.clone());
                    states.len() - 1
                });
                transitions.push((at, operator, id));
            }
        }
        at += 1;
    }
    let mut distance: Vec<Option<u32>> = states.iter().map(|s| task.is_goal(s).then_some(0)).collect();
    let mut queue: VecDeque<usize> = (0..states.len()).filter(|&s| distance[s].is_some()).collect();
    while let Some(state) = queue.pop_front() {
        for &(from, ..) in transitions.iter().filter(|&&(.., to)| to == state) {
            if distance[from].is_none() {
                distance[from] = distance[state].map(|d| d + 1);
                queue.push_back(from);
            }
        }
    }
    Space { states, distance, transitions }
}

fn hold_to_promises(name: &str, seed: u64, heuristic: &mut dyn Heuristic, space: &Space) {
    let promised = heuristic.properties();
    let estimates: Vec<Estimate> =
        space.states.iter().map(|s| heuristic.estimate(s, &mut Vec::new())).collect();
    for (state, (&estimate, &distance)) in estimates.iter().zip(&space.distance).enumerate() {
        match (estimate, distance) {
            (Estimate::DeadEnd, Some(d)) if promised.safe => {
                panic!("{name}, seed {seed}, state {state}: called a dead end, but the goal is {d} away")
            }
            (Estimate::Cost(h), Some(d)) if promised.admissible => {
                assert!(h <= d, "{name}, seed {seed}, state {state}: {h} estimated, {d} away");
            }
            _ => {}
        }
    }
    for &(from, _, to) in space.transitions.iter().filter(|_| promised.consistent) {
        if let (Estimate::Cost(before), Estimate::Cost(after)) = (estimates[from], estimates[to]) {
            assert!(before <= after + 1, "{name}, seed {seed}: falls from {before} to {after} in one step");
        }
    }
}

#[test]
fn heuristics_keep_their_promises() {
    hold_all(0..2500, random::task);
}

#[test]
fn landmark_cuts_that_a_state_inherits_keep_the_estimate_admissible() {
    let mut inherited = 0;
    for seed in 0..2500 {
        let (domain, problem) = random::task(seed);
        let task = ground(&domain, &problem, &GroundLimits::default()).expect("random tasks are well formed");
        let space = if task.impossible.is_empty() { explore(&task) } else { continue };
        if space.states.len() > 300 {
            continue;
        }
        let mut heuristic = LandmarkCut::new(&task, Costs::Unit);
        for &(from, operator, to) in &space.transitions {
            heuristic.estimate(&space.states[from], &mut Vec::new());
            let findings = heuristic.findings().to_vec();
            let state = &space.states[to];
            match (heuristic.estimate_after(state, &findings, operator, &mut Vec::new()), space.distance[to])
            {
                (Estimate::Cost(h), Some(d)) => assert!(h <= d, "seed {seed}: {h} estimated, {d} away"),
                (Estimate::DeadEnd, Some(d)) => panic!("seed {seed}: called a dead end, but {d} away"),
                _ => {}
            }
            inherited += usize::from(!findings.is_empty());
        }
    }
    assert!(inherited > 1000, "{inherited} states that inherit cuts are too few to mean anything");
}

#[test]
fn heuristics_keep_their_promises_over_numbers() {
    hold_all(0..1000, random::numeric_task);
}

fn hold_all(seeds: std::ops::Range<u64>, make: fn(u64) -> (Domain, Problem)) {
    let mut states = 0;
    for seed in seeds {
        let (domain, problem) = make(seed);
        let task = ground(&domain, &problem, &GroundLimits::default()).expect("random tasks are well formed");
        if !task.impossible.is_empty() {
            continue;
        }
        let space = explore(&task);
        if space.states.len() > 500 {
            continue;
        }
        states += space.states.len();
        hold_to_promises("blind", seed, &mut Blind, &space);
        hold_to_promises("h_FF", seed, &mut Relaxation::new(&task, Costs::Unit), &space);
        hold_to_promises("LM-cut", seed, &mut LandmarkCut::new(&task, Costs::Unit), &space);
        let mut relaxation = Relaxation::new(&task, Costs::Unit);
        for (state, &distance) in space.states.iter().zip(&space.distance) {
            let hmax = relaxation.hmax(state);
            assert!(distance.is_none_or(|d| hmax.is_some_and(|h| h <= d)), "h_max, seed {seed}");
        }
    }
    assert!(states > 1000, "{states} states are too few to mean anything");
}
