//! The best schedule known of each task of a file, and a proved bound: written into the file's `reference` keys.
//!
//! The team's joint task is scheduled by propositional planning (`lamma_planner::Scheduler`) from its goal as
//! given, without language and without a run. The result depends on nothing but the file and the budget, which
//! is counted in conflicts of the solver.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use lamma_coordinator::bound::JointTask;
use lamma_domains::tasks::{Reference, Task};
use lamma_planner::{MakespanLimits, Outcome, SearchOptions};

use crate::error::Failure;
use crate::out::say;

/// Conflicts of the solver for one task.
const CONFLICTS: u64 = 400_000;
/// Literals of the largest formula.
const SIZE: u64 = 40_000_000;
/// States of the search for a first schedule where the solver gives up.
const EXPANSIONS: u64 = 200_000;

/// Works out the reference of each task and writes the file anew, line by line.
pub fn write(file: &Path, tasks: &[Task]) -> Result<u8, Failure> {
    let text = std::fs::read_to_string(file).map_err(|e| Failure::unreadable(file, &e))?;
    let mut tasks = tasks.iter();
    let mut out = String::with_capacity(text.len() + 70 * 80);
    let (mut known, mut tight) = (0, 0);
    for line in text.lines() {
        let task = if line.trim().is_empty() { None } else { tasks.next() };
        match task.map(|t| (t, reference(t))) {
            Some((task, Ok(found))) => {
                say(format_args!(
                    "{:<20} makespan {} (at least {}), {} steps",
                    task.id, found.makespan, found.lower_bound, found.steps
                ));
                known += 1;
                tight += u32::from(found.makespan == found.lower_bound);
                out.push_str(&with_reference(line, found)?);
            }
            Some((task, Err(why))) => {
                say(format_args!("{:<20} no reference: {why}", task.id));
                out.push_str(line);
            }
            None => out.push_str(line),
        }
        out.push('\n');
    }
    std::fs::write(file, out).map_err(|e| Failure::io("write", file, &e))?;
    say(format_args!("{known} references, {tight} of them proved to be the shortest"));
    Ok(crate::exit::SUCCESS)
}

/// The shortest schedule found for the task's goal, and the bound that was proved.
fn reference(task: &Task) -> Result<Reference, String> {
    if task.rules.travel {
        return Err("going takes its time in it, and schedules are worked out in unit steps".into());
    }
    let (world, goal) = task.world(0).map_err(|e| e.to_string())?;
    let team = lamma_coordinator::house::team(&world);
    let available: Vec<usize> = (0..team.members.len()).collect();
    let facts = world.facts().cloned().collect();
    let joint = JointTask::new(&team, &available, &facts, &goal.condition())?;
    let floor = joint.floor().ok_or("the goal is out of the team's reach")?;
    let limits = MakespanLimits { conflicts: CONFLICTS, size: SIZE, ..MakespanLimits::default() };
    let never = AtomicBool::new(false);
    let found =
        joint.shortest(&[], floor, None, &limits, &never).ok_or("the goal is out of the team's reach")?;
    let bound = found.lower_bound.unwrap_or(floor);
    if let Some(schedule) = found.schedule {
        let steps = schedule.operators().count() as u32;
        return Ok(Reference { makespan: schedule.makespan(), lower_bound: bound, steps });
    }
    // The solver was stopped on its way up: a plan of the team, one action after the other, is where to come
    // down from.
    let limits_of_search = lamma_planner::Limits { expansions: Some(EXPANSIONS), ..Default::default() };
    let first = match lamma_planner::solve(&joint.task, &SearchOptions::default(), &limits_of_search, &never)
    {
        Outcome::Found(plan) => plan.acts.len() as u32,
        other => return Err(format!("no schedule was found: {other:?}")),
    };
    let down = joint.shortest(&[], bound, Some(first + 1), &limits, &never);
    let schedule = down.as_ref().and_then(|d| d.schedule.as_ref());
    match schedule {
        Some(s) => Ok(Reference {
            makespan: s.makespan(),
            lower_bound: down
                .as_ref()
                .and_then(|d| d.lower_bound)
                .unwrap_or(bound)
                .max(bound)
                .min(s.makespan()),
            steps: s.operators().count() as u32,
        }),
        None => Ok(Reference { makespan: first, lower_bound: bound, steps: first }),
    }
}

/// The line with this reference in place of the one it had. All else stays as it was written.
fn with_reference(line: &str, found: Reference) -> Result<String, Failure> {
    let bare = match line.find(", \"reference\":") {
        None => line.trim_end().to_string(),
        Some(start) => {
            // A reference holds numbers only, so its first brace closes it.
            let end = line[start..].find('}').map_or(line.len(), |at| start + at + 1);
            format!("{}{}", &line[..start], line[end..].trim_end())
        }
    };
    let body = bare
        .strip_suffix('}')
        .ok_or_else(|| Failure::bad_input("a task does not end with `}`; write each task on one line"))?;
    let reference = serde_json::to_value(found).map_err(Failure::fault)?;
    let (m, b, s) = (&reference["makespan"], &reference["lower_bound"], &reference["steps"]);
    Ok(format!("{body}, \"reference\": {{\"makespan\": {m}, \"lower_bound\": {b}, \"steps\": {s}}}}}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_is_added_or_replaced_and_nothing_else_changes() {
        let found = Reference { makespan: 6, lower_bound: 5, steps: 11 };
        let with = r#"{"id": "x", "goal": [{"object": "A", "is": {"isOpen": true}}], "reference": {"makespan": 6, "lower_bound": 5, "steps": 11}}"#;
        let without = r#"{"id": "x", "goal": [{"object": "A", "is": {"isOpen": true}}]}"#;
        let older = with.replace("11", "23");
        for line in [without, with, &older] {
            assert_eq!(with_reference(line, found).unwrap(), with);
        }
        let before =
            r#"{"id": "x", "reference": {"makespan": 9, "lower_bound": 5, "steps": 11}, "rules": {}}"#;
        let moved =
            r#"{"id": "x", "rules": {}, "reference": {"makespan": 6, "lower_bound": 5, "steps": 11}}"#;
        assert_eq!(with_reference(before, found).unwrap(), moved);
    }
}
