//! The MAT-THOR and SMART-LLM task files as they were released.
//!
//! They are JSON Lines read by position (sentence, robot ids, ground truth, two numbers of transitions), a third
//! of which is not valid JSON. What is certain is repaired, each repair is noted, and what cannot be read is
//! reported without losing the rest.
//!
//! Two questions about each line are answered by rule, so that results can be reported on the lines where a
//! result means something: whether its goal can be true in its scene at all ([`Imported::impossible`]), and
//! whether its goal is what its sentence asks for ([`Imported::agreement`]).

mod agreement;
mod repair;
mod text;

pub use agreement::Agreement;

use serde::Deserialize;

use crate::HouseError;
use crate::condition::condition;
use crate::goal::GoalEntry;
use crate::goal_error::GoalProblemKind;
use crate::robots::{self, Member, Robot};
use crate::tasks::Task;
use crate::world::{Rules, setup};

use text::Value;

/// One entry of the released ground truth, as it stands there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TruthEntry {
    /// The object's name; the released evaluator takes it as a part of a name.
    pub name: String,
    /// What it shall contain.
    pub contains: Vec<String>,
    /// `SLICED`, `OFF`, …
    pub state: Option<String>,
}

/// A line that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The line of the file, from 1.
    pub line: usize,
    /// The task in our own format. Its goal is empty if `impossible` says that there is none.
    pub task: Task,
    /// What was repaired.
    pub repairs: Vec<String>,
    /// The ground truth as it stands there, for the released evaluator's formulas.
    pub truth: Vec<TruthEntry>,
    /// Its number of transitions, where it has one.
    pub transitions: Option<f64>,
    /// The other number: the most transitions in the base files, an action count in the others.
    pub other_number: Option<f64>,
    /// Why the goal can never be true in the scene, if so.
    pub impossible: Option<String>,
    /// Whether the goal is what the sentence asks for.
    pub agreement: Agreement,
}

/// A line that could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unread {
    /// The line of the file, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub what: String,
}

/// What a file gave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Import {
    /// The lines that were read.
    pub tasks: Vec<Imported>,
    /// The others.
    pub unread: Vec<Unread>,
}

/// The robots that ids stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotIds(Vec<Robot>);

impl Default for RobotIds {
    /// The catalogue: id 1 is `robot1`.
    fn default() -> Self {
        RobotIds(robots::catalogue().to_vec())
    }
}

#[derive(Deserialize)]
struct RobotFile {
    robots: Vec<RobotEntry>,
}

/// Tolerant on purpose: the released lists say `mass` or `mass_capacity`, transcriptions say more.
#[derive(Deserialize)]
struct RobotEntry {
    name: Option<String>,
    skills: Vec<String>,
    #[serde(alias = "mass", alias = "capacity_kg")]
    mass_capacity: f64,
}

impl RobotIds {
    /// Robots from JSON text, a list or an object with `robots`; the first has id 1.
    pub fn from_json(text: &str) -> Result<Self, HouseError> {
        let bad = |what: String| HouseError::BadRobot { robot: "robots file".to_string(), what };
        let list = serde_json::from_str::<RobotFile>(text)
            .map(|file| file.robots)
            .or_else(|_| serde_json::from_str::<Vec<RobotEntry>>(text))
            .map_err(|e| bad(format!("{e}; expected a list of {{name, skills, mass_capacity}}")))?;
        let robot = |(index, entry): (usize, RobotEntry)| Robot {
            name: entry.name.unwrap_or_else(|| format!("robot{}", index + 1)),
            skills: entry.skills,
            capacity_kg: entry.mass_capacity,
            hands: 1,
        };
        let robots: Vec<Robot> = list.into_iter().enumerate().map(robot).collect();
        robots.iter().try_for_each(Robot::check)?;
        Ok(RobotIds(robots))
    }

    /// The robots of a team. A team that lists an id twice gets a second robot of that kind.
    fn team(&self, ids: &[f64], repairs: &mut Vec<String>) -> Result<Vec<Member>, String> {
        let mut team: Vec<Robot> = Vec::new();
        for id in ids {
            // Ids are small whole numbers; anything else misses the list.
            let index = if *id >= 1.0 && id.fract() == 0.0 { *id as usize - 1 } else { usize::MAX };
            let mut robot = self.0.get(index).cloned().ok_or_else(|| format!("there is no robot {id}"))?;
            if team.iter().any(|r| r.name == robot.name) {
                repairs.push(format!("named the second `{}` of the team apart", robot.name));
                robot.name = format!("{}-{}", robot.name, team.len() + 1);
            }
            team.push(robot);
        }
        if team.is_empty() {
            return Err("the team is empty".to_string());
        }
        let known = |r: Robot| match robots::find(&r.name) {
            Ok(catalogued) if *catalogued == r => Member::Named(r.name),
            _ => Member::Described(r),
        };
        Ok(team.into_iter().map(known).collect())
    }
}

/// Reads one of the released files. Scene and category come from its name, as `FloorPlan15pddl.json`: plain is
/// compound, `pddl` complex, `vague` vague.
pub fn import(file_name: &str, text: &str, suite: &str, robots: &RobotIds) -> Import {
    let stem = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    let stem = stem.strip_suffix(".json").unwrap_or(stem);
    let digits: String =
        stem.strip_prefix("FloorPlan").unwrap_or("").chars().take_while(char::is_ascii_digit).collect();
    let scene = format!("FloorPlan{digits}");
    let category = match stem {
        _ if stem.contains("vague") => "vague",
        _ if stem.contains("pddl") => "complex",
        _ => "compound",
    };
    let mut import = Import::default();
    for (line, record) in text::records(text) {
        let task = Task {
            id: format!("{stem}-{}", import.tasks.len() + import.unread.len() + 1),
            suite: suite.to_string(),
            category: category.to_string(),
            scene: scene.clone(),
            instruction: String::new(),
            team: Vec::new(),
            objects: None,
            goal: Vec::new(),
            reference: None,
            rules: Rules::default(),
        };
        match read_record(line, record, task, robots) {
            Ok(imported) => import.tasks.push(imported),
            Err(what) => import.unread.push(Unread { line, what }),
        }
    }
    import
}

fn read_record(line: usize, record: &str, mut task: Task, robots: &RobotIds) -> Result<Imported, String> {
    let (value, mut repairs) = text::read(record)?;
    repairs.dedup();
    let Value::Object(entries) = value else { return Err("is no object".to_string()) };
    let mut values = entries.into_iter().map(|(_, value)| value);
    let Some(Value::Text(instruction)) = values.next() else {
        return Err("its first value is no sentence".to_string());
    };
    task.instruction = instruction.trim().to_string();
    let ids = match values.next() {
        Some(Value::List(ids)) => ids,
        _ => return Err("its second value is no list of robots".to_string()),
    };
    let ids: Vec<f64> = ids
        .iter()
        .map(|id| match id {
            Value::Number(id) => Ok(*id),
            other => Err(format!("`{other:?}` is no robot id")),
        })
        .collect::<Result<_, _>>()?;
    task.team = robots.team(&ids, &mut repairs)?;
    let truth = match values.next() {
        Some(Value::List(entries)) => entries.iter().map(truth_entry).collect::<Result<Vec<_>, _>>()?,
        Some(Value::Object(_) | Value::Text(_) | Value::Number(_)) => {
            return Err("its third value is no list of object states".to_string());
        }
        Some(Value::Null) | None => Vec::new(),
    };
    let mut number = |what: &str| match values.next() {
        Some(Value::Number(n)) => Some(n),
        _ => {
            repairs.push(format!("it has no {what}"));
            None
        }
    };
    let transitions = number("number of transitions");
    let other_number = number("most or least number of transitions");
    let mut impossible = None;
    for entry in &truth {
        match repair::goal_entry(entry, &mut repairs) {
            Ok(entry) => task.goal.extend(entry),
            Err(what) => impossible = Some(format!("the goal cannot be read: {what}")),
        }
    }
    if task.goal.is_empty() && impossible.is_none() {
        impossible = Some("no goal is given".to_string());
    }
    let impossible = impossible.or_else(|| never_true(&task));
    let agreement = agreement::judge(&task.instruction, &task.goal);
    Ok(Imported { line, task, repairs, truth, transitions, other_number, impossible, agreement })
}

fn truth_entry(value: &Value) -> Result<TruthEntry, String> {
    let Value::Object(entries) = value else { return Err("an object state is no object".to_string()) };
    let get = |key: &str| entries.iter().find(|(k, _)| k.trim() == key).map(|(_, v)| v);
    let name = get("name").and_then(Value::word).ok_or("an object state names no object")?;
    let raw = match get("name") {
        Some(Value::Text(text)) => text.clone(),
        _ => name.to_string(),
    };
    let contains = match get("contains") {
        Some(Value::List(items)) => items.iter().filter_map(Value::word).map(String::from).collect(),
        _ => Vec::new(),
    };
    Ok(TruthEntry { name: raw, contains, state: get("state").and_then(Value::word).map(String::from) })
}

/// Why the goal cannot be true in the scene, whatever the team does.
fn never_true(task: &Task) -> Option<String> {
    let team = match robots::team(&task.team) {
        Ok(team) => team,
        Err(error) => return Some(error.to_string()),
    };
    let setup = match setup(&task.scene, &team, None, 0) {
        Ok(setup) => setup,
        Err(error) => return Some(error.to_string()),
    };
    let error = condition(&task.goal, &setup).err()?;
    let worst = |kind| error.problems.iter().find(|p| p.kind == kind);
    let problem =
        worst(GoalProblemKind::Absent).or(worst(GoalProblemKind::Impossible)).or(error.problems.first());
    problem.map(|p| p.what.clone())
}

/// The goal types of an entry, its contents' included.
fn types(goal: &[GoalEntry]) -> Vec<&GoalEntry> {
    use crate::goal::Content;
    let mut all = Vec::new();
    let mut open: Vec<&GoalEntry> = goal.iter().collect();
    while let Some(entry) = open.pop() {
        all.push(entry);
        open.extend(entry.contains.iter().filter_map(|c| match c {
            Content::With(inner) => Some(inner.as_ref()),
            Content::Named(_) => None,
        }));
    }
    all
}
