//! The reason that is given for what no team can do, on a table of cases (`reasons.jsonl`): each names its kind
//! and what the reason must say.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_coordinator::allocate::allocate;
use lamma_coordinator::allocation::{AllocateInput, Cut, NoAllocation};
use lamma_coordinator::decompose::given;
use lamma_coordinator::house::team;
use lamma_domains::tasks;

/// Why the task is infeasible, by the way a run goes: what one cut does not settle, a coarser one does.
fn reason(task: &tasks::Task) -> Result<String, String> {
    let (world, _) = match task.world(0) {
        Ok(world) => world,
        Err(error) => return Ok(error.to_string()),
    };
    let understanding = given(&world, &task.goal).map_err(|e| format!("not understood: {e}"))?;
    let mut input = AllocateInput {
        cut: Cut::default(),
        rule: lamma_coordinator::AllocationRule::Shortest,
        team: Arc::new(team(&world)),
        available: (0..world.members.len()).collect(),
        facts: world.facts().cloned().collect(),
        final_goal: understanding.final_goal(),
        subgoals: understanding.subgoals,
        excluded: Default::default(),
        expansions: 2_000,
    };
    loop {
        let why = match allocate(&input, &AtomicBool::new(false)) {
            Err(NoAllocation::Infeasible(why)) => return Ok(why),
            Err(NoAllocation::NotThisWay(why) | NoAllocation::GaveUp(why)) => why,
            Ok(_) => "allocated".to_string(),
        };
        input.cut = input.cut.coarser().ok_or(format!("not proved infeasible: {why}"))?;
    }
}

#[test]
fn the_reason_names_what_stands_in_the_way() {
    let mut wrong = Vec::new();
    let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
    for line in include_str!("reasons.jsonl").lines() {
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        *kinds.entry(row["kind"].as_str().unwrap().to_string()).or_default() += 1;
        let expected: Vec<&str> =
            row["expect"].as_array().unwrap().iter().map(|e| e.as_str().unwrap()).collect();
        let task: Result<tasks::Task, _> = serde_json::from_value(row["task"].clone());
        let found = task.map_err(|e| e.to_string()).and_then(|task| reason(&task));
        let right = found.as_ref().is_ok_and(|why| expected.iter().all(|e| why.contains(e)));
        eprintln!("{} / {}: {found:?}", row["kind"], row["task"]["id"]);
        if !right {
            wrong.push(format!("{} / {}: {found:?} lacks {expected:?}", row["kind"], row["task"]["id"]));
        }
    }
    assert!(kinds.values().sum::<usize>() >= 40, "{kinds:?}");
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
}
