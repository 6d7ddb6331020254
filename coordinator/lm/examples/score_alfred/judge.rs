//! Whether an answer is the goal, and why not if it is not.

use std::collections::BTreeMap;

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_lm::offline::Gloss;
use lamma_lm::{Answer, Request};
use serde_json::Value;

use crate::strict;

/// A goal as a sorted list of "Type{states}@Parent".
pub fn wanted(task: &Value) -> Vec<String> {
    let goal = |key: &str| task["goal"][key].as_str().unwrap_or_default();
    let (object, parent, carrier) = (goal("object_target"), goal("parent_target"), goal("mrecep_target"));
    let mut states: Vec<&str> = Vec::new();
    match task["type"].as_str().unwrap_or_default() {
        "pick_clean_then_place_in_recep" => states.push("isDirty=false"),
        "pick_heat_then_place_in_recep" => states.push("temperature=Hot"),
        "pick_cool_then_place_in_recep" => states.push("temperature=Cold"),
        "look_at_obj_in_light" => states.push("isPickedUp=true"),
        _ => {}
    }
    if task["goal"]["object_sliced"] == Value::Bool(true) {
        states.push("isSliced=true");
    }
    states.sort_unstable();
    let states = states.join(",");
    let mut facts = match task["type"].as_str().unwrap_or_default() {
        "look_at_obj_in_light" => {
            vec![format!("{object}{{{states}}}@"), format!("{}{{isToggled=true}}@", goal("toggle_target"))]
        }
        "pick_and_place_with_movable_recep" => {
            vec![format!("{object}{{{states}}}@{carrier}"), format!("{carrier}{{}}@{parent}")]
        }
        "pick_two_obj_and_place" => vec![format!("{object}{{{states}}}@{parent}"); 2],
        _ => vec![format!("{object}{{{states}}}@{parent}")],
    };
    facts.sort();
    facts
}

#[derive(Default, Clone)]
struct Node {
    kind: String,
    states: BTreeMap<String, String>,
    parent: String,
}

/// Reads the goal entries as one list of facts about objects, following marks.
struct Flattener<'r> {
    request: &'r Request,
    nodes: BTreeMap<String, Node>,
    fresh: usize,
}

impl Flattener<'_> {
    fn kind(&self, object: &str) -> String {
        let named = self.request.objects.iter().find(|known| known.name == object);
        named.map_or_else(|| object.to_owned(), |known| known.kind.clone())
    }

    fn keys(&mut self, entry: &GoalEntry) -> Vec<String> {
        let kind = self.kind(&entry.object);
        let count = self.request.objects.iter().filter(|object| object.kind == kind).count();
        if let Some(mark) = &entry.same {
            return vec![format!("mark {mark}")];
        }
        if entry.all {
            return (0..count).map(|i| format!("all {kind} {i}")).collect();
        }
        if kind != entry.object || count == 1 {
            return vec![format!("object {}", if count == 1 { &kind } else { &entry.object })];
        }
        self.fresh += 1;
        vec![format!("some {kind} {}", self.fresh)]
    }

    fn entry(&mut self, entry: &GoalEntry, parent: &str, lasting: bool) {
        let kind = self.kind(&entry.object);
        for key in self.keys(entry) {
            let node = self.nodes.entry(key).or_default();
            node.kind.clone_from(&kind);
            if !parent.is_empty() && lasting {
                node.parent = parent.to_owned();
            }
            for (property, value) in &entry.is {
                let value = match value {
                    PropertyValue::Flag(flag) => flag.to_string(),
                    PropertyValue::Word(word) => word.clone(),
                };
                if lasting || property == "temperature" && !strict() {
                    node.states.insert(property.clone(), value);
                }
            }
        }
        for content in &entry.contains {
            match content {
                Content::Named(name) => {
                    self.entry(&GoalEntry { object: name.clone(), ..GoalEntry::default() }, &kind, lasting);
                }
                Content::With(inner) => self.entry(inner, &kind, lasting),
            }
        }
    }

    /// The facts read so far, sorted.
    fn facts(&self) -> Vec<String> {
        let told = |node: &&Node| !node.states.is_empty() || !node.parent.is_empty();
        let told = self.nodes.values().filter(told);
        let mut facts: Vec<String> = told
            .map(|node| {
                let states: Vec<String> = node.states.iter().map(|(k, v)| format!("{k}={v}")).collect();
                format!("{}{{{}}}@{}", node.kind, states.join(","), node.parent)
            })
            .collect();
        facts.sort();
        facts
    }
}

/// What came of a sentence.
pub struct Verdict {
    /// Why it is not the goal; empty if it is.
    pub cause: String,
    /// The types that were taken for the goal's, where the cause is a choice among what a noun may mean.
    pub confused: Option<String>,
    /// What was read.
    pub got: Vec<String>,
}

/// Compares an answer with the goal. What the sentence does not say at all is told from what was misread.
pub fn judge(answer: &Answer, wanted: &[String], request: &Request, gloss: &Gloss) -> Verdict {
    let unsaid = unsaid(wanted, gloss);
    let decomposition = match answer {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(clarification) => {
            let cause = unsaid.unwrap_or_else(|| "asked back".to_owned());
            return Verdict { cause, confused: None, got: clarification.not_understood.clone() };
        }
    };
    let mut flat = Flattener { request, nodes: BTreeMap::new(), fresh: 0 };
    for subtask in &decomposition.subtasks {
        for entry in &subtask.goal {
            flat.entry(entry, "", subtask.lasting);
        }
    }
    let got = flat.facts();
    let (cause, confused) = match unsaid {
        _ if got == wanted => (String::new(), None),
        Some(unsaid) => (unsaid, None),
        None => misread(&got, wanted),
    };
    Verdict { cause, confused, got }
}

/// What of the goal no word of the sentence may stand for.
fn unsaid(wanted: &[String], gloss: &Gloss) -> Option<String> {
    for fact in wanted {
        let (kind, states, parent) = parts(fact);
        // Before the place: who names neither is counted for the object.
        for (role, kind) in [("object", kind), ("place", parent)] {
            if !kind.is_empty() && !gloss.types.contains(kind) {
                return Some(format!("the sentence does not name the {role}"));
            }
        }
        let property = |state: &str| state.split('=').next().unwrap_or_default().to_owned();
        let silent = |state: &&str| !["isPickedUp", "isToggled"].contains(&property(state).as_str());
        if states.split(',').filter(silent).any(|s| !s.is_empty() && !gloss.properties.contains(&property(s)))
        {
            return Some("the sentence does not name the state".to_owned());
        }
    }
    None
}

/// What was read otherwise than it was meant.
fn misread(got: &[String], wanted: &[String]) -> (String, Option<String>) {
    let all = |facts: &[String], pick: fn(&str) -> &str| -> Vec<String> {
        let mut parts: Vec<String> = facts.iter().map(|fact| pick(fact).to_owned()).collect();
        parts.sort();
        parts
    };
    if got.len() != wanted.len() {
        return (format!("{} facts read where the goal has {}", got.len(), wanted.len()), None);
    }
    for (role, pick) in
        [("object", (|fact| parts(fact).0) as fn(&str) -> &str), ("place", |fact| parts(fact).2)]
    {
        let (ours, theirs) = (all(got, pick), all(wanted, pick));
        if ours != theirs {
            let pairs = ours.iter().zip(&theirs).filter(|(a, b)| a != b);
            let confused = pairs.map(|(a, b)| format!("{a} for {b}")).collect::<Vec<_>>().join(", ");
            return (format!("another {role} than is meant"), Some(confused));
        }
    }
    ("another state than is meant".to_owned(), None)
}

/// "Type{states}@Parent" in three.
fn parts(fact: &str) -> (&str, &str, &str) {
    let (kind, rest) = fact.split_once('{').unwrap_or((fact, ""));
    let (states, parent) = rest.split_once("}@").unwrap_or((rest, ""));
    (kind, states, parent)
}
