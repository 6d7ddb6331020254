//! The first test of the protocol: the real machines under seeded faults.

use lamma_coordinator::result::OutcomeKind;
use lamma_tests::faults::FaultPlan;
use lamma_tests::rng::Rng;
use lamma_tests::scenario::Scenario;
use lamma_tests::testbed::{PlanCache, run_seed, run_with};

#[test]
fn without_faults_the_team_reaches_its_goal_in_the_shortest_time() {
    let run = run_with(&Scenario::hand_over(), 0, Rng::new(0), FaultPlan::none(), &mut PlanCache::new());
    let result = run.result.unwrap();
    assert_eq!(result.outcome, OutcomeKind::Success, "{result:#?}");
    assert_eq!(result.metrics.exe, 1.0);
    assert!(result.faults.is_empty());
    assert!(result.plan.makespan >= result.plan.makespan_lower_bound);
    insta::assert_yaml_snapshot!(result.plan.actions);
}

#[test]
fn an_order_is_kept_across_a_sub_task_that_needs_nothing() {
    let run = run_with(&Scenario::chain(), 0, Rng::new(0), FaultPlan::none(), &mut PlanCache::new());
    let result = run.result.unwrap();
    assert_eq!(result.outcome, OutcomeKind::Success, "{result:#?}");
    let start = |action: &str| result.plan.actions.iter().find(|a| a.action == action).unwrap().start;
    assert!(start("Darken") > start("Put"), "{:#?}", result.plan.actions);
}

/// 1,000 schedules: no invariant is violated, every run ends.
#[test]
fn a_thousand_faulty_schedules_keep_every_invariant() {
    let scenario = Scenario::hand_over();
    let mut plans = PlanCache::new();
    let mut outcomes = std::collections::BTreeMap::new();
    let mut inputs = 0;
    for seed in 0..1000 {
        let run = run_seed(&scenario, seed, &mut plans);
        inputs += run.inputs;
        match run.result {
            Ok(result) => *outcomes.entry(format!("{:?}", result.outcome)).or_insert(0) += 1,
            Err(violation) => panic!(
                "seed {seed}: {violation}\n{:#?}\nagain: LAMMA_SEED={seed} cargo test -p lamma-tests --test protocol one_seed",
                run.faults
            ),
        }
    }
    println!("1000 seeds, {inputs} inputs: {outcomes:?}");
    assert!(outcomes.contains_key("Success") && outcomes.contains_key("Infeasible"), "{outcomes:?}");
}

#[test]
fn the_same_seed_gives_the_same_trace() {
    let scenario = Scenario::hand_over();
    for seed in (0..1000).step_by(37) {
        let first = run_seed(&scenario, seed, &mut PlanCache::new());
        let second = run_seed(&scenario, seed, &mut PlanCache::new());
        assert_eq!(first.trace_hash, second.trace_hash, "seed {seed}");
    }
}

/// Replays the seed in `LAMMA_SEED`.
#[test]
fn one_seed() {
    let Some(seed) = std::env::var("LAMMA_SEED").ok().and_then(|s| s.parse().ok()) else { return };
    let run = run_seed(&Scenario::hand_over(), seed, &mut PlanCache::new());
    println!("{run:#?}");
    run.result.unwrap();
}
