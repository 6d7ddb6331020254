//! The tasks of a folder, laid out as CoDMAP 2015 released them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::Failure;
use crate::world::{Privacy, WorldSource};

/// How deep below the folder tasks are looked for.
const DEPTH: usize = 4;

/// The file of reference values, and the folder of the tasks without privacy.
const REFERENCES: &str = "reference_values.json";
const CLASSICAL: &str = "classical";

/// A set of tasks.
pub struct Set {
    /// The folder.
    pub name: String,
    /// Its tasks, by id.
    pub tasks: Vec<TaskFolder>,
}

/// A folder with one task.
pub struct TaskFolder {
    /// The path below the set: `driverlog/pfile1`.
    pub id: String,
    /// The first part of it.
    pub domain: String,
    /// Where it is.
    pub path: PathBuf,
    /// What others have reached.
    pub reference: Option<Reference>,
    /// The set's own classical compilation.
    pub classical: Option<(PathBuf, PathBuf)>,
    factored: bool,
}

/// Values to compare with.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Reference {
    /// The shortest makespan known.
    pub best_makespan: Option<f64>,
}

#[derive(Deserialize)]
struct References {
    problems: BTreeMap<String, Reference>,
}

impl TaskFolder {
    /// The task for a run.
    pub fn source(&self, privacy: Privacy) -> Result<WorldSource, Failure> {
        match self.factored {
            true => WorldSource::factored(&self.path, privacy),
            false => WorldSource::pddl(&self.path.join("domain.pddl"), &self.path.join("problem.pddl")),
        }
    }
}

/// The tasks in the folder, or in its `factored` or `unfactored` part if it has one. Reference values come from
/// `reference_values.json` in that folder or the one above, the set's own compilation from `classical`.
pub fn read(folder: &Path, factored: bool, only: Option<&str>) -> Result<Set, Failure> {
    let form = if factored { "factored" } else { "unfactored" };
    let part = folder.join(form);
    let root = if part.is_dir() { part } else { folder.to_path_buf() };
    let mut found = Vec::new();
    look(&root, factored, DEPTH, &mut found).map_err(|e| Failure::unreadable(folder, &e))?;
    let above = folder.join("..");
    let home = |name: &str| [folder, &above].into_iter().find(|home| home.join(name).exists());
    let references = home(REFERENCES).map(references).transpose()?.unwrap_or_default();
    let compiled = home(CLASSICAL).unwrap_or(folder).join(CLASSICAL);
    let mut tasks: Vec<TaskFolder> = found
        .into_iter()
        .map(|path| {
            let id = path.strip_prefix(&root).unwrap_or(&path).display().to_string();
            let (domain, problem) = id.split_once('/').unwrap_or((&id, ""));
            let classical = compiled.join(domain);
            let pair = (classical.join("domain.pddl"), classical.join(format!("{problem}.pddl")));
            TaskFolder {
                domain: domain.to_string(),
                reference: references.get(&id).copied(),
                classical: (pair.0.is_file() && pair.1.is_file()).then_some(pair),
                factored,
                path,
                id,
            }
        })
        .collect();
    tasks.retain(|task| only.is_none_or(|only| task.id.contains(only)));
    tasks.sort_by(|a, b| a.id.cmp(&b.id));
    if tasks.is_empty() {
        let wanted = if factored {
            "domain-AGENT.pddl and problem-AGENT.pddl"
        } else {
            "domain.pddl and problem.pddl"
        };
        let which = only.map(|only| format!(" with {only:?} in its path")).unwrap_or_default();
        return Err(Failure::bad_input(format!(
            "{} has no {form} task{which}: a task is a folder with {wanted}",
            folder.display()
        )));
    }
    Ok(Set { name: folder.display().to_string(), tasks })
}

fn references(folder: &Path) -> Result<BTreeMap<String, Reference>, Failure> {
    let path = folder.join(REFERENCES);
    let text = std::fs::read_to_string(&path).map_err(|e| Failure::unreadable(&path, &e))?;
    let read: References =
        serde_json::from_str(&text).map_err(|e| Failure::bad_input(format!("{}: {e}", path.display())))?;
    Ok(read.problems)
}

fn look(folder: &Path, factored: bool, depth: usize, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut below = Vec::new();
    let mut is_task = false;
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if entry.path().is_dir() {
            below.push(entry.path());
        } else if factored {
            is_task |= name.starts_with("domain-") && name.ends_with(".pddl");
        } else {
            is_task |= name == "domain.pddl" && folder.join("problem.pddl").is_file();
        }
    }
    if is_task {
        found.push(folder.to_path_buf());
    } else if depth > 0 {
        for folder in below {
            look(&folder, factored, depth - 1, found)?;
        }
    }
    Ok(())
}
