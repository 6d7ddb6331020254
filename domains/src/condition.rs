//! Goals of task files as PDDL conditions, checked against the world they are for.
//!
//! What one goal fact is: each item of a `contains` and each property of an `is` counts one, nested ones too.
//! What it means: the facts of one entry, and of entries tied by `same`, speak of the same objects, so besides a
//! condition per fact there is one per such group. `contains` is direct, as AI2-THOR's `receptacleObjectIds`
//! are: what lies on a plate in the fridge is contained by the plate.

use std::collections::BTreeMap;

use lamma_pddl::ast::Condition;

use crate::goal::{Content, GoalEntry};
use crate::goal_error::{GoalError, GoalProblem};
use crate::scribe::Scribe;
use crate::world::WorldSetup;

/// How many facts a goal may have.
const MAX_FACTS: usize = 1000;

/// One thing that shall be true.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalFact {
    /// For people: `Fridge contains Apple`.
    pub text: String,
    /// That it is true, of whatever objects.
    pub condition: Condition,
}

/// Facts that speak of the same objects.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalGroup {
    /// Each by itself.
    pub facts: Vec<GoalFact>,
    /// All of them together, of the same objects.
    pub joint: Condition,
}

/// A goal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Goal {
    /// Its independent parts.
    pub groups: Vec<GoalGroup>,
}

/// How much of a goal is reached.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// Facts of the goal.
    pub total: usize,
    /// Facts that count as reached; equals `total` only if the whole goal is reached.
    pub reached: usize,
    /// The others, in words.
    pub missing: Vec<String>,
}

impl Goal {
    /// The whole goal.
    pub fn condition(&self) -> Condition {
        match self.groups.as_slice() {
            [one] => one.joint.clone(),
            many => Condition::And(many.iter().map(|g| g.joint.clone()).collect()),
        }
    }

    /// All facts, in order.
    pub fn facts(&self) -> impl Iterator<Item = &GoalFact> {
        self.groups.iter().flat_map(|g| &g.facts)
    }

    /// Counts what holds. Where each fact of a group holds, but of different objects, one is missing: the
    /// count is full exactly when the goal is reached.
    pub fn reached(&self, mut holds: impl FnMut(&Condition) -> bool) -> Reached {
        let mut count = Reached { total: self.facts().count(), ..Reached::default() };
        for group in &self.groups {
            let missing: Vec<&GoalFact> = group.facts.iter().filter(|f| !holds(&f.condition)).collect();
            count.reached += group.facts.len() - missing.len();
            count.missing.extend(missing.iter().map(|f| f.text.clone()));
            if missing.is_empty() && !holds(&group.joint) {
                count.reached -= 1;
                let texts: Vec<&str> = group.facts.iter().map(|f| f.text.as_str()).collect();
                count.missing.push(format!("of the same objects: {}", texts.join(", ")));
            }
        }
        count
    }
}

/// Translates a goal, or says everything that is wrong with it.
pub fn condition(entries: &[GoalEntry], setup: &WorldSetup) -> Result<Goal, GoalError> {
    let mut problems = Vec::new();
    if entries.is_empty() {
        problems.push(GoalProblem::malformed("goal", "is empty; give at least one entry"));
    }
    let mut groups = Vec::new();
    for entries in tied(entries) {
        let mut scribe = Scribe::new(setup);
        for (index, entry) in entries {
            scribe.entry(entry, &format!("goal[{index}]"));
        }
        let (group, found) = scribe.finish();
        groups.push(group);
        problems.extend(found);
    }
    let goal = Goal { groups };
    let count = goal.facts().count();
    if count > MAX_FACTS {
        problems.push(GoalProblem::malformed("goal", &format!("has {count} facts; at most {MAX_FACTS}")));
    }
    if problems.is_empty() { Ok(goal) } else { Err(GoalError { problems }) }
}

/// Entries that share a mark, directly or through others, in one list; with their place in the goal.
fn tied(entries: &[GoalEntry]) -> Vec<Vec<(usize, &GoalEntry)>> {
    let mut groups: Vec<Vec<(usize, &GoalEntry)>> = Vec::new();
    let mut of_mark: BTreeMap<&str, usize> = BTreeMap::new();
    for (index, entry) in entries.iter().enumerate() {
        let mut marks = Vec::new();
        collect_marks(entry, &mut marks);
        let mut known: Vec<usize> = marks.iter().filter_map(|m| of_mark.get(m).copied()).collect();
        known.sort_unstable();
        known.dedup();
        let group = match known.first() {
            Some(&first) => {
                for &other in known.iter().skip(1) {
                    let moved = std::mem::take(&mut groups[other]);
                    groups[first].extend(moved);
                    of_mark.values_mut().filter(|g| **g == other).for_each(|g| *g = first);
                }
                first
            }
            None => {
                groups.push(Vec::new());
                groups.len() - 1
            }
        };
        groups[group].push((index, entry));
        of_mark.extend(marks.into_iter().map(|m| (m, group)));
    }
    groups.retain(|g| !g.is_empty());
    groups.iter_mut().for_each(|g| g.sort_by_key(|(index, _)| *index));
    groups
}

fn collect_marks<'a>(entry: &'a GoalEntry, into: &mut Vec<&'a str>) {
    into.extend(entry.same.as_deref());
    for content in &entry.contains {
        if let Content::With(inner) = content {
            collect_marks(inner, into);
        }
    }
}
