//! Task files: JSON Lines, one task a line, read strictly. The format is the contract's.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::condition::{Goal, condition};
use crate::goal::GoalEntry;
use crate::robots::{self, Member};
use crate::world::{ObjectSpec, Rules, WorldSetup, setup_with};
use crate::{GoalError, HouseError, nearest};

/// A task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// One of its own.
    pub id: String,
    /// The collection it belongs to.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub suite: String,
    /// `compound`, `complex`, `vague`, or another.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub category: String,
    /// `FloorPlan15`
    pub scene: String,
    /// What a person says.
    pub instruction: String,
    /// The robots.
    pub team: Vec<Member>,
    /// Replaces the scene's movable objects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objects: Option<Vec<ObjectSpec>>,
    /// What shall be true at the end.
    pub goal: Vec<GoalEntry>,
    /// The best schedule known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Reference>,
    /// Rules that differ from the usual.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub rules: Rules,
}

fn is_usual(rules: &Rules) -> bool {
    *rules == Rules::default()
}

/// The best schedule known of a task, for its team.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Its length in time steps.
    pub makespan: u32,
    /// A proved lower bound of any schedule's length.
    pub lower_bound: u32,
    /// The actions it takes.
    pub steps: u32,
}

/// A line that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TaskProblem {
    /// From 1.
    pub line: usize,
    /// From 1; absent where the line is well-formed but says something impossible.
    pub column: Option<usize>,
    /// In words, with what to do.
    pub what: String,
}

impl fmt::Display for TaskProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.column {
            Some(column) => write!(f, "line {}, column {column}: {}", self.line, self.what),
            None => write!(f, "line {}: {}", self.line, self.what),
        }
    }
}

/// Every line that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", .problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct TaskError {
    /// At least one.
    pub problems: Vec<TaskProblem>,
}

/// Why a task's world cannot be set up.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WorldError {
    /// Its scene, team or objects.
    #[error(transparent)]
    House(#[from] HouseError),
    /// Its goal.
    #[error(transparent)]
    Goal(#[from] GoalError),
}

impl Task {
    /// The world the task starts in and its goal there.
    pub fn world(&self, seed: u64) -> Result<(WorldSetup, Goal), WorldError> {
        let team = robots::team(&self.team)?;
        let setup = setup_with(&self.scene, &team, self.objects.as_deref(), seed, &self.rules)?;
        let goal = condition(&self.goal, &setup)?;
        Ok((setup, goal))
    }
}

/// Reads the tasks of a file. Each line is checked to the end: scene, team, objects and goal are known.
pub fn read(text: &str) -> Result<Vec<Task>, TaskError> {
    let mut tasks = Vec::new();
    let mut problems = Vec::new();
    let mut ids: BTreeMap<String, usize> = BTreeMap::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let number = index + 1;
        let mut wrong = |column, what: String| problems.push(TaskProblem { line: number, column, what });
        let task: Task = match serde_json::from_str(line) {
            Ok(task) => task,
            Err(error) => {
                wrong(Some(error.column()), explain(&error));
                continue;
            }
        };
        if let Some(first) = ids.insert(task.id.clone(), number) {
            wrong(None, format!("id `{}` is taken by line {first}; give each task its own", task.id));
        }
        match task.world(0) {
            Err(WorldError::House(error)) => wrong(None, error.to_string()),
            Err(WorldError::Goal(error)) => {
                error.problems.iter().for_each(|problem| wrong(None, problem.to_string()));
            }
            Ok(_) => tasks.push(task),
        }
    }
    if problems.is_empty() { Ok(tasks) } else { Err(TaskError { problems }) }
}

/// Serde's message without its position and with the nearest key that exists.
fn explain(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(what, _)| what);
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match quoted.split_first() {
        Some((given, known)) if message.starts_with("unknown field") => {
            format!(
                "unknown key `{given}`{}; keys here are: {}",
                nearest::hint(given, known.iter().copied()),
                known.join(" ")
            )
        }
        _ => message.replace("missing field", "missing key").replace("duplicate field", "duplicate key"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"id": "x-01", "suite": "s", "category": "compound", "scene": "FloorPlan15", "instruction": "i", "team": ["robot1", {"name": "r2", "skills": ["GoToObject", "PickupObject", "PutObject"], "capacity_kg": 0.9, "hands": 1}], "objects": [{"type": "Apple", "count": 2, "in": "CounterTop", "is": {"isSliced": false}}, {"type": "Lettuce"}], "goal": [{"object": "Fridge", "contains": ["Apple", "Lettuce"]}, {"object": "LightSwitch", "is": {"isToggled": false}}], "reference": {"makespan": 6, "lower_bound": 6, "steps": 11}}"#;

    #[test]
    fn the_contracts_example_is_read_and_written_again() {
        let tasks = read(&format!("\n{GOOD}\n\n")).unwrap();
        assert_eq!(tasks.len(), 1);
        let again = serde_json::to_string(&tasks[0]).unwrap();
        assert_eq!(read(&again).unwrap(), tasks);
        let (setup, goal) = tasks[0].world(3).unwrap();
        assert_eq!(setup.things.iter().filter(|t| t.can("pickupable")).count(), 3);
        assert_eq!(goal.facts().count(), 3);
    }

    #[test]
    fn mistakes_are_placed_and_cured() {
        for (from, to, wanted) in [
            (r#""goal":"#, r#""goals":"#, "line 1, column"),
            (r#""goal":"#, r#""goals":"#, "unknown key `goals`; did you mean `goal`?"),
            (r#""contains""#, r#""contain""#, "unknown key `contain`; did you mean `contains`?"),
            (r#""hands": 1"#, r#""hand": 1"#, "unknown key `hand`; did you mean `hands`?"),
            (r#""hands": 1"#, r#""hands": 9"#, "hands is 9; give 1 to 4"),
            (r#""count": 2"#, r#""count": 2000"#, "at most 50"),
            (r#"{"type": "Lettuce"}"#, r#"{"type": "Fridge", "count": 2}"#, "has 1 × Fridge, not 2"),
            (r#""in": "CounterTop""#, r#""in": "CounterTip""#, "did you mean `CounterTop`"),
            (r#""in": "CounterTop""#, r#""in": "StoveBurner""#, "a StoveBurner does not take a Apple"),
            (r#""robot1""#, r#""robot99""#, "unknown robot `robot99`"),
            (r#""PutObject""#, r#""PutObjct""#, "did you mean `PutObject`"),
            ("FloorPlan15", "Floorplan16", "unknown scene"),
            (r#""isToggled": false"#, r#""isToggle": false"#, "did you mean `isToggled`"),
            (r#""Lettuce"]"#, r#""Lettuce", "Lettuce"]"#, "a second Lettuce"),
            (r#""instruction": "i", "#, "", "missing key `instruction`"),
            (r#""makespan": 6"#, r#""makespan": -6"#, "invalid value"),
        ] {
            let text = GOOD.replace(from, to);
            assert_ne!(text, GOOD, "{from}");
            let error = read(&text).unwrap_err().to_string();
            assert!(error.contains(wanted), "{from} -> {to}: {error}");
        }
        let twice = read(&format!("{GOOD}\n{GOOD}")).unwrap_err();
        assert_eq!(twice.to_string(), "line 2: id `x-01` is taken by line 1; give each task its own");
    }
}
