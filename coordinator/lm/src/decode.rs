//! Reads a model's answer as strictly as bytes from a wire: size, form, names, order.

use std::collections::{BTreeMap, BTreeSet};

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_domains::robots::SKILLS;
use serde::Deserialize;

use crate::offline::damerau_levenshtein;
use crate::{Answer, Ban, Clarification, Decomposition, Request, Subtask};

/// Longer answers are not read, in bytes.
pub const LONGEST: usize = 64 * 1024;
/// More sub-tasks are refused.
pub const MOST_SUBTASKS: usize = 64;
/// More "after" entries, over all sub-tasks, are refused.
pub const MOST_EDGES: usize = 256;
/// More bans are refused.
pub const MOST_BANS: usize = 64;
/// Contents within contents go no deeper.
const DEEPEST: usize = 4;

/// The properties a goal may speak of, with the words a property takes; no words means true or false.
pub const PROPERTIES: &[(&str, &[&str])] = &[
    ("isOpen", &[]),
    ("isToggled", &[]),
    ("isSliced", &[]),
    ("isCooked", &[]),
    ("isBroken", &[]),
    ("isDirty", &[]),
    ("isPickedUp", &[]),
    ("isFilledWithLiquid", &[]),
    ("fillLiquid", &["water", "coffee", "wine"]),
    ("temperature", &["Hot", "Cold", "RoomTemp"]),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wire {
    #[serde(default)]
    subtasks: Vec<Subtask>,
    #[serde(default)]
    assumptions: Vec<String>,
    #[serde(default)]
    bans: Vec<Ban>,
    #[serde(default)]
    confidence: Option<f64>,
    #[serde(default)]
    question: Option<String>,
}

/// The answer, or everything that is wrong with it, in words a model can act on.
pub fn decode(text: &str, request: &Request) -> Result<Answer, Vec<String>> {
    if text.len() > LONGEST {
        return Err(vec![format!("the answer has {} bytes; at most {LONGEST} are read", text.len())]);
    }
    let body = json_part(text).ok_or_else(|| vec!["the answer holds no JSON object".to_owned()])?;
    let wire: Wire =
        serde_json::from_str(body).map_err(|error| vec![format!("not the format asked for: {error}")])?;
    if let (Some(question), true) = (&wire.question, wire.subtasks.is_empty()) {
        let question = question.clone();
        return Ok(Answer::Clarify(Clarification { question, ..Clarification::default() }));
    }
    let mut checker = Checker::new(request);
    checker.subtasks(&wire.subtasks);
    checker.bans(&wire.bans);
    let confidence = wire.confidence.unwrap_or(1.0);
    if !(0.0..=1.0).contains(&confidence) {
        checker.errors.push(format!("confidence: {confidence} is not between 0 and 1"));
    }
    if checker.errors.is_empty() {
        let Wire { subtasks, assumptions, bans, .. } = wire;
        Ok(Answer::Understood(Decomposition { subtasks, assumptions, confidence, bans }))
    } else {
        Err(checker.errors)
    }
}

/// The JSON object in a text: the whole of it, a fenced block, or from the first to the last brace.
pub(crate) fn json_part(text: &str) -> Option<&str> {
    let text = text.trim();
    let fenced = text.split("```").nth(1).map(|block| block.trim_start_matches("json").trim());
    let text = match fenced {
        Some(block) if !text.starts_with('{') => block,
        _ => text,
    };
    let (start, end) = (text.find('{')?, text.rfind('}')?);
    text.get(start..=end)
}

struct Checker<'r> {
    kinds: BTreeSet<&'r str>,
    names: BTreeSet<&'r str>,
    robots: BTreeSet<&'r str>,
    errors: Vec<String>,
}

impl<'r> Checker<'r> {
    fn new(request: &'r Request) -> Self {
        Self {
            kinds: request.objects.iter().map(|object| object.kind.as_str()).collect(),
            names: request.objects.iter().map(|object| object.name.as_str()).collect(),
            robots: request.robots.iter().map(|robot| robot.name.as_str()).collect(),
            errors: Vec::new(),
        }
    }

    fn subtasks(&mut self, subtasks: &[Subtask]) {
        if subtasks.is_empty() {
            self.errors.push("subtasks: there is none".to_owned());
        }
        if subtasks.len() > MOST_SUBTASKS {
            self.errors.push(format!("subtasks: {} of them; at most {MOST_SUBTASKS}", subtasks.len()));
            return;
        }
        let edges: usize = subtasks.iter().map(|subtask| subtask.after.len()).sum();
        if edges > MOST_EDGES {
            self.errors.push(format!("after: {edges} entries over all sub-tasks; at most {MOST_EDGES}"));
            return;
        }
        let mut seen = BTreeSet::new();
        for subtask in subtasks {
            if !seen.insert(subtask.id.as_str()) {
                self.errors.push(format!("id {:?} is used twice", subtask.id));
            }
        }
        for subtask in subtasks {
            for earlier in subtask.after.iter().filter(|earlier| !seen.contains(earlier.as_str())) {
                self.errors.push(format!("{}.after: no sub-task has the id {earlier:?}", subtask.id));
            }
            for robot in subtask.robots.iter().filter(|robot| !self.robots.contains(robot.as_str())) {
                let hint = nearest(robot, &self.robots);
                self.errors.push(format!("{}.robots: {robot:?} is not in the team{hint}", subtask.id));
            }
            if subtask.goal.is_empty() {
                self.errors.push(format!("{}.goal: is empty; leave such a sub-task out", subtask.id));
            }
            for (i, entry) in subtask.goal.iter().enumerate() {
                let place = format!("{}.goal[{i}]", subtask.id);
                if entry.contains.is_empty() && entry.is.is_empty() {
                    self.errors.push(format!(
                        "{place}: says nothing of {:?}; give \"contains\" or \"is\"",
                        entry.object
                    ));
                }
                self.entry(&place, entry, 0);
            }
        }
        if let Some(id) = on_a_cycle(subtasks) {
            self.errors.push(format!("after: {id:?} would have to come before itself"));
        }
    }

    fn bans(&mut self, bans: &[Ban]) {
        if bans.len() > MOST_BANS {
            self.errors.push(format!("bans: {} of them; at most {MOST_BANS}", bans.len()));
            return;
        }
        let skills: BTreeSet<&str> = SKILLS.into_iter().collect();
        for (i, ban) in bans.iter().enumerate() {
            let place = format!("bans[{i}]");
            if !skills.contains(ban.skill.as_str()) {
                let hint = nearest(&ban.skill, &skills);
                self.errors.push(format!("{place}: {:?} is no skill{hint}", ban.skill));
            }
            for object in std::iter::once(&ban.object).chain(&ban.item) {
                self.object(&place, object);
            }
        }
    }

    fn entry(&mut self, place: &str, entry: &GoalEntry, depth: usize) {
        if depth > DEEPEST {
            self.errors.push(format!("{place}: contents within contents go no deeper than {DEEPEST}"));
            return;
        }
        self.object(place, &entry.object);
        for (property, value) in &entry.is {
            self.property(place, property, value);
        }
        for (i, content) in entry.contains.iter().enumerate() {
            let place = format!("{place}.contains[{i}]");
            match content {
                Content::Named(name) => self.object(&place, name),
                Content::With(inner) => self.entry(&place, inner, depth + 1),
            }
        }
    }

    fn object(&mut self, place: &str, object: &str) {
        if !self.kinds.contains(object) && !self.names.contains(object) {
            let hint = nearest(object, &self.kinds);
            self.errors.push(format!("{place}: {object:?} is no object or type of this scene{hint}"));
        }
    }

    fn property(&mut self, place: &str, property: &str, value: &PropertyValue) {
        let Some((_, words)) = PROPERTIES.iter().find(|(name, _)| *name == property) else {
            let names: BTreeSet<&str> = PROPERTIES.iter().map(|(name, _)| *name).collect();
            let hint = nearest(property, &names);
            self.errors.push(format!("{place}.is: {property:?} is no property{hint}"));
            return;
        };
        match value {
            PropertyValue::Flag(_) if words.is_empty() => {}
            PropertyValue::Word(word) if words.contains(&word.as_str()) => {}
            _ if words.is_empty() => {
                self.errors.push(format!("{place}.is.{property}: must be true or false"))
            }
            _ => self.errors.push(format!("{place}.is.{property}: must be one of {}", words.join(", "))),
        }
    }
}

/// `; did you mean "…"?`, or nothing when nothing is near.
pub(crate) fn nearest(word: &str, known: &BTreeSet<&str>) -> String {
    let letters: Vec<char> = word.to_lowercase().chars().take(64).collect();
    let best = known
        .iter()
        .map(|known| {
            (damerau_levenshtein(&letters, &known.to_lowercase().chars().collect::<Vec<_>>()), known)
        })
        .min();
    match best {
        Some((distance, known)) if distance <= 2 + letters.len() / 4 => format!("; did you mean {known:?}?"),
        _ => String::new(),
    }
}

/// A sub-task on a cycle of "after", if there is one (Kahn, "Topological sorting of large networks", CACM 5(11), 1962).
fn on_a_cycle(subtasks: &[Subtask]) -> Option<&str> {
    let mut waiting: BTreeMap<&str, BTreeSet<&str>> = subtasks
        .iter()
        .map(|subtask| (subtask.id.as_str(), subtask.after.iter().map(String::as_str).collect()))
        .collect();
    loop {
        let free: Vec<&str> = waiting
            .iter()
            .filter(|(_, after)| after.iter().all(|id| !waiting.contains_key(id)))
            .map(|(id, _)| *id)
            .collect();
        if free.is_empty() {
            return waiting.keys().next().copied();
        }
        for id in free {
            waiting.remove(id);
        }
    }
}
