//! Random small tasks with everything the language offers, compared with an exhaustive search that uses the
//! plain executor only: the planner finds a plan exactly where there is one, and the plan is right.

#[path = "support/random.rs"]
mod random;
mod support;

use std::collections::{BTreeSet, VecDeque};
use std::sync::atomic::AtomicBool;

use lamma_pddl::Name;
use lamma_pddl::ast::*;
use lamma_planner::{
    Engine, GroundLimits, Limits, Outcome, SearchOptions, Unsolvable, Verdict, ground, hmax_unit, solve,
    validate,
};
use random::{narrow_task, numeric_task, task};
use support::{Executor, World};

/// The length of a shortest plan, by breadth-first search over everything.
fn shortest(executor: &Executor<'_>) -> Option<usize> {
    let acts: Vec<(Name, Vec<Name>)> = executor
        .domain
        .actions
        .iter()
        .flat_map(|action| {
            let mut rows = vec![Vec::new()];
            for param in &action.params {
                let members = executor.members(&param.types);
                rows = rows
                    .into_iter()
                    .flat_map(|row: Vec<Name>| {
                        members.iter().map(move |m| [row.clone(), vec![m.clone()]].concat())
                    })
                    .collect();
            }
            rows.into_iter().map(|row| (action.name.clone(), row))
        })
        .collect();
    let start = executor.initial();
    let key = |world: &World| {
        let numbers = world.values.values().map(|value| (value + 0.0).to_bits());
        (world.facts.clone(), numbers.collect::<Vec<_>>())
    };
    let mut seen = BTreeSet::from([key(&start)]);
    let mut queue: VecDeque<(World, usize)> = VecDeque::from([(start, 0)]);
    while let Some((world, depth)) = queue.pop_front() {
        if executor.holds(&world, &executor.problem.goal, &Vec::new()) {
            return Some(depth);
        }
        for (name, args) in &acts {
            if let Ok(next) = executor.apply(&world, name, args)
                && seen.insert(key(&next))
            {
                queue.push_back((next, depth + 1));
            }
        }
    }
    None
}

#[test]
fn plans_exist_exactly_where_exhaustive_search_finds_them() {
    compare(0..3000, task);
}

#[test]
fn with_numbers_too_plans_exist_exactly_where_exhaustive_search_finds_them() {
    compare(0..2500, numeric_task);
}

#[test]
fn where_every_effect_counts_none_is_forgotten() {
    compare(0..3000, narrow_task);
}

fn compare(seeds: std::ops::Range<u64>, make: fn(u64) -> (Domain, Problem)) {
    let (mut solvable, mut unsolvable, mut unreachable) = (0, 0, 0);
    for seed in seeds {
        let (domain, problem) = make(seed);
        let executor = Executor { domain: &domain, problem: &problem };
        let expected = shortest(&executor);
        let task = ground(&domain, &problem, &GroundLimits::default())
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let outcome = solve(&task, &SearchOptions::default(), &Limits::default(), &AtomicBool::new(false));
        match (&outcome, expected) {
            (Outcome::Found(plan), Some(length)) => {
                let checked = executor.check(plan);
                assert!(checked.is_ok(), "seed {seed}: {checked:?} in {plan:?}");
                assert!(plan.acts.len() >= length, "seed {seed}");
                let verdict = validate(&domain, &problem, &plan.acts);
                let valid = matches!(verdict, Ok(Verdict::Valid { .. }));
                assert!(valid, "seed {seed}: the interpreter says {verdict:?} of {plan:?}");
                assert!(
                    hmax_unit(&task).is_some_and(|h| h as usize <= length),
                    "seed {seed}: h_max overestimates"
                );
                let options = SearchOptions { engine: Engine::AstarLmcut, ..SearchOptions::default() };
                match solve(&task, &options, &Limits::default(), &AtomicBool::new(false)) {
                    Outcome::Found(plan) => {
                        assert!(executor.check(&plan).is_ok(), "seed {seed}: {plan:?}");
                        assert_eq!(plan.acts.len(), length, "seed {seed}: A* with LM-cut is not optimal");
                    }
                    other => panic!("seed {seed}: A* with LM-cut says {other:?}"),
                }
                solvable += usize::from(length > 0);
            }
            (Outcome::Unsolvable(why), None) => {
                unsolvable += 1;
                unreachable += usize::from(matches!(why, Unsolvable::Unreachable(_)));
            }
            _ => panic!("seed {seed}: exhaustive search {expected:?}, planner {outcome:?}"),
        }
    }
    assert!(
        solvable > 100 && unsolvable > 150,
        "{solvable} {unsolvable} {unreachable}: the tasks say too little"
    );
}
