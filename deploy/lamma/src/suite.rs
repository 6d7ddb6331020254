//! The tasks of a benchmark, from our own files or as MAT-THOR was released.

use std::path::{Path, PathBuf};

use lamma_domains::matthor::{RobotIds, TruthEntry, import};
use lamma_domains::{generate, scene, tasks};

use crate::cli::BenchArgs;
use crate::compat::truth_of;
use crate::error::Failure;

/// A suite.
pub struct Suite {
    /// From the file or folder.
    pub name: String,
    /// Its tasks.
    pub entries: Vec<Entry>,
    /// What could not be read, for the person.
    pub notes: Vec<String>,
    /// Whether some tasks are set aside, so that the table tells the others apart.
    pub imported: bool,
    /// Whether the tasks' own goals are planned for.
    pub goals_given: bool,
}

/// A task of a suite.
pub struct Entry {
    /// The task.
    pub task: tasks::Task,
    /// What was repaired when it was read.
    pub repairs: Vec<String>,
    /// Why its goal can never hold in its scene, if so.
    pub impossible: Option<String>,
    /// Why it does not count among those whose goal can hold and agrees with the sentence.
    pub set_aside: Option<String>,
    /// Its ground truth in the terms of the released evaluator.
    pub truth: Vec<TruthEntry>,
}

impl Suite {
    /// Whether it is divided as the paper's table is.
    pub fn has_the_papers_categories(&self) -> bool {
        ["compound", "complex", "vague"].iter().all(|c| self.entries.iter().any(|e| e.task.category == *c))
    }
}

/// Reads what the arguments name.
pub fn read(args: &BenchArgs) -> Result<Suite, Failure> {
    let suite = named(args)?;
    Ok(Suite { goals_given: args.goals_given, ..suite })
}

fn named(args: &BenchArgs) -> Result<Suite, Failure> {
    match (&args.tasks, &args.mat_thor, args.generated) {
        (Some(file), ..) => own(file),
        (None, Some(folder), _) => mat_thor(folder, args.robots.as_deref()),
        (None, None, Some(count)) => generated(usize::from(count), args.common.seed),
        (None, None, None) => {
            Err(Failure::bad_input("name a suite: --tasks FILE.jsonl, --mat-thor DIR or --generated N"))
        }
    }
}

/// Tasks made up for every floor plan.
fn generated(count: usize, seed: u64) -> Result<Suite, Failure> {
    let mut entries = Vec::new();
    for scene in scene::names() {
        let tasks = generate::tasks(&scene, count, seed).map_err(Failure::bad_input)?;
        entries.extend(tasks.into_iter().map(Entry::of));
    }
    let name = format!("{count} generated tasks in each floor plan");
    Ok(Suite { name, entries, notes: Vec::new(), imported: false, goals_given: false })
}

impl Entry {
    fn of(task: tasks::Task) -> Entry {
        let truth = truth_of(&task.goal);
        Entry { task, repairs: Vec::new(), impossible: None, set_aside: None, truth }
    }
}

fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|e| Failure::unreadable(path, &e))?;
    String::from_utf8(bytes).map_err(|e| Failure::bad_input(format!("{} is not UTF-8: {e}", path.display())))
}

fn own(file: &Path) -> Result<Suite, Failure> {
    let text = read_text(file)?;
    let tasks = tasks::read(&text).map_err(|error| {
        let lines: Vec<String> = error.problems.iter().map(|p| format!("{}: {p}", file.display())).collect();
        Failure::bad_input(lines.join("\n"))
    })?;
    if tasks.is_empty() {
        return Err(Failure::bad_input(format!(
            "{} has no task: one JSON object a line is expected",
            file.display()
        )));
    }
    Ok(Suite {
        name: file.display().to_string(),
        entries: tasks.into_iter().map(Entry::of).collect(),
        notes: Vec::new(),
        imported: false,
        goals_given: false,
    })
}

fn mat_thor(folder: &Path, robots: Option<&Path>) -> Result<Suite, Failure> {
    let robots = match robots {
        Some(path) => RobotIds::from_json(&read_text(path)?)
            .map_err(|e| Failure::bad_input(format!("{}: {e}", path.display())))?,
        None => RobotIds::default(),
    };
    let listing = std::fs::read_dir(folder).map_err(|e| Failure::unreadable(folder, &e))?;
    let mut files: Vec<PathBuf> = listing.filter_map(|e| e.ok().map(|e| e.path())).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "json" || e == "jsonl"));
    files.sort();
    if files.is_empty() {
        return Err(Failure::bad_input(format!("{} has no .json file", folder.display())));
    }
    let mut suite = Suite {
        name: folder.display().to_string(),
        entries: Vec::new(),
        notes: Vec::new(),
        imported: true,
        goals_given: false,
    };
    for file in files {
        let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let found = import(&name, &read_text(&file)?, "mat-thor", &robots);
        for line in found.unread {
            suite.notes.push(format!("{name}:{}: not read: {}", line.line, line.what));
        }
        for line in found.tasks {
            let disagrees = (!line.agreement.agrees).then(|| line.agreement.reasons.join("; "));
            suite.entries.push(Entry {
                task: line.task,
                repairs: line.repairs,
                set_aside: line.impossible.clone().or(disagrees),
                impossible: line.impossible,
                truth: line.truth,
            });
        }
    }
    let (all, aside) = (suite.entries.len(), suite.entries.iter().filter(|e| e.set_aside.is_some()).count());
    suite.notes.push(format!(
        "{all} lines read, {} not read; {aside} set aside (goal impossible in the scene, or not what the sentence says)",
        suite.notes.len()
    ));
    Ok(suite)
}
