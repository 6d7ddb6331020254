//! The proved makespan of every task of a suite, from the goals as given, without a run: for each task the
//! cheap bound, the proved bound and the shortest schedule.
//!
//! `cargo run --release -p lamma-coordinator --example household_makespan -- TASKS.jsonl [CONFLICTS [SIZE [ID]]]`;
//! in place of a file, `--generated N` for N made-up tasks in every sixth floor plan.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use lamma_coordinator::bound::JointTask;
use lamma_domains::tasks::Task;
use lamma_domains::{generate, scene, tasks};
use lamma_planner::MakespanLimits;

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (tasks, rest) = match args.first().map(String::as_str) {
        Some("--generated") => (generated(args.get(1).and_then(|n| n.parse().ok()).unwrap_or(1))?, 2),
        Some(file) => {
            let text = std::fs::read_to_string(file).map_err(|e| format!("{file}: {e}"))?;
            (tasks::read(&text).map_err(|e| format!("{:?}", e.problems))?, 1)
        }
        None => return Err("name a file of tasks, or --generated N".into()),
    };
    let number = |at: usize, default| args.get(rest + at).and_then(|c| c.parse().ok()).unwrap_or(default);
    let limits =
        MakespanLimits { conflicts: number(0, 20_000), size: number(1, 20_000_000), ..Default::default() };
    let only = args.get(rest + 2).map_or("", String::as_str);
    let (mut proved, mut times) = (0, Vec::new());
    for task in tasks.iter().filter(|t| t.id.contains(only)) {
        match one(task, &limits) {
            Ok((line, tight, ms)) => {
                println!("{:<24} {line}", task.id);
                proved += usize::from(tight);
                times.push(ms);
            }
            Err(why) => println!("{:<24} {why}", task.id),
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times.get(((times.len() as f64 * share) as usize).min(times.len().max(1) - 1));
    println!(
        "{proved} of {} proved; ms to prove: median {:.0}, 90 % {:.0}, most {:.0}",
        times.len(),
        at(0.5).unwrap_or(&0.0),
        at(0.9).unwrap_or(&0.0),
        at(1.0).unwrap_or(&0.0)
    );
    Ok(())
}

fn generated(count: usize) -> Result<Vec<Task>, String> {
    let mut tasks = Vec::new();
    for name in scene::names().into_iter().step_by(6) {
        tasks.extend(generate::tasks(&name, count, 1).map_err(|e| e.to_string())?);
    }
    Ok(tasks)
}

/// A line about the task, whether its shortest schedule was found, and the time that took.
fn one(task: &Task, limits: &MakespanLimits) -> Result<(String, bool, f64), String> {
    let (world, goal) = task.world(0).map_err(|e| e.to_string())?;
    let team = lamma_coordinator::house::team(&world);
    let available: Vec<usize> = (0..team.members.len()).collect();
    let facts = world.facts().cloned().collect();
    let start = Instant::now();
    let joint = JointTask::new(&team, &available, &facts, &goal.condition())?;
    let grounded = start.elapsed();
    let floor = joint.floor().ok_or("the goal is out of reach")?;
    let floored = start.elapsed();
    let found = joint
        .shortest(&[], floor, None, limits, &AtomicBool::new(false))
        .ok_or("the goal is out of reach")?;
    let makespan = found.schedule.as_ref().map_or("-".into(), |s| s.makespan().to_string());
    let ms = (start.elapsed() - floored).as_secs_f64() * 1e3;
    let line = format!(
        "floor {floor} bound {} makespan {makespan}; ground {:.0} ms, floor {:.0} ms, prove {ms:.0} ms; {}",
        found.lower_bound.unwrap_or(0),
        grounded.as_secs_f64() * 1e3,
        (floored - grounded).as_secs_f64() * 1e3,
        joint.task
    );
    Ok((line, found.schedule.is_some(), ms))
}
