//! The proved makespan of every task of a suite, from the goals as given, without a run: for each task the
//! cheap bound, the proved bound and the shortest schedule.
//!
//! `cargo run --release -p lamma-coordinator --example household_makespan -- TASKS.jsonl [CONFLICTS]`

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use lamma_coordinator::bound::JointTask;
use lamma_planner::MakespanLimits;

fn main() -> Result<(), String> {
    let mut args = std::env::args().skip(1);
    let file = args.next().ok_or("name a file of tasks")?;
    let conflicts = args.next().and_then(|c| c.parse().ok()).unwrap_or(20_000);
    let only = args.next().unwrap_or_default();
    let text = std::fs::read_to_string(&file).map_err(|e| format!("{file}: {e}"))?;
    let tasks = lamma_domains::tasks::read(&text).map_err(|e| format!("{:?}", e.problems))?;
    for task in tasks.iter().filter(|t| t.id.contains(&only)) {
        match one(task, conflicts) {
            Ok(line) => println!("{:<24} {line}", task.id),
            Err(why) => println!("{:<24} {why}", task.id),
        }
    }
    Ok(())
}

fn one(task: &lamma_domains::tasks::Task, conflicts: u64) -> Result<String, String> {
    let (world, goal) = task.world(0).map_err(|e| e.to_string())?;
    let team = lamma_coordinator::house::team(&world);
    let available: Vec<usize> = (0..team.members.len()).collect();
    let facts = world.facts().cloned().collect();
    let start = Instant::now();
    let joint = JointTask::new(&team, &available, &facts, &goal.condition())?;
    let grounded = start.elapsed();
    let floor = joint.floor().ok_or("the goal is out of reach")?;
    let floored = start.elapsed();
    let limits = MakespanLimits { conflicts, size: 20_000_000, ..MakespanLimits::default() };
    let found =
        joint.shortest(floor, None, &limits, &AtomicBool::new(false)).ok_or("the goal is out of reach")?;
    let makespan = found.schedule.map_or("-".into(), |s| s.makespan().to_string());
    Ok(format!(
        "floor {floor} bound {} makespan {makespan}; ground {:.0} ms, floor {:.0} ms, prove {:.0} ms; {}",
        found.lower_bound.unwrap_or(0),
        grounded.as_secs_f64() * 1e3,
        (floored - grounded).as_secs_f64() * 1e3,
        (start.elapsed() - floored).as_secs_f64() * 1e3,
        joint.task
    ))
}
