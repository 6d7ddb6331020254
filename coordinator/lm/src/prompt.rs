//! What a chat model is told: the task, the format, the scene and the team; and the schema of the answer.

use std::collections::BTreeMap;
use std::fmt::Write;

use lamma_domains::robots::SKILLS;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::Request;
use crate::decode::PROPERTIES;

/// Goes into the cassette's key: another wording is another question.
pub const VERSION: u32 = 2;

const SYSTEM: &str = "\
You turn a household instruction into sub-tasks for a team of robots. Say what shall be TRUE, not what to do.
Answer with one JSON object and nothing else:
{\"subtasks\":[{\"id\":\"s1\",\"text\":\"…\",\"goal\":[ENTRY,…],\"after\":[\"s0\"],\"lasting\":true}],\
\"assumptions\":[\"…\"],\"confidence\":0.9}
ENTRY is about one object: {\"object\":\"Fridge\",\"contains\":[\"Apple\",{\"object\":\"Plate\",\"is\":{\"isDirty\":false}}],\
\"is\":{\"isOpen\":false},\"all\":false,\"same\":\"x\"}.
- \"object\" and the members of \"contains\" are object types or object names of the scene, spelt as they are there.
- \"is\" uses only the properties listed below. \"all\": true means every object of the type.
- A type named twice in \"contains\" means two different objects. Entries with the same \"same\" are about one object.
- \"after\" names the sub-tasks that must be done before; leave it empty for what may be done in parallel.
- \"bans\":[{\"skill\":\"OpenObject\",\"object\":\"Fridge\"}] says what nobody may do on the way, because the \
instruction forbids it; for PutObject \"item\" may name what must not be put there. Leave it out otherwise.
- \"lasting\": false for a sub-task that a later one undoes.
- Put into the last goal of an object also the states it must have then (a washed fork in a bowl: isDirty false).
- Never mention an object the instruction neither names nor implies.
- If you cannot tell what is meant, answer {\"question\":\"…\"} instead.";

/// Goes to the instructions where the model is to allocate, too.
const ALLOCATE: &str = "\n- \"robots\" names the robots that do the sub-task, as few as can, by their skills and \
what they lift. Every sub-task has at least one.";

/// What a model is told and asked for; different ones to compare with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wording {
    /// Only the names of things and robots: neither where things are and what they afford, nor what actions need.
    pub bare: bool,
    /// The model says which robots do a sub-task.
    pub allocate: bool,
}

/// The messages of the first try.
pub fn messages(request: &Request, wording: &Wording) -> Vec<Value> {
    let allocate = if wording.allocate { ALLOCATE } else { "" };
    vec![
        json!({"role": "system", "content": format!("{SYSTEM}{allocate}\nProperties: {}.", properties())}),
        json!({"role": "user", "content": scene(request, wording)}),
    ]
}

/// The messages that send an answer back with what is wrong with it.
pub fn repair(answer: &str, errors: &[String]) -> Vec<Value> {
    let mut text = String::from("This answer cannot be used:\n");
    for error in errors.iter().take(20) {
        let _ = writeln!(text, "- {error}");
    }
    text.push_str("Send the whole corrected JSON object and nothing else.");
    vec![
        json!({"role": "assistant", "content": shorten(answer, 8192)}),
        json!({"role": "user", "content": text}),
    ]
}

fn shorten(text: &str, limit: usize) -> &str {
    let end = text.char_indices().map(|(at, _)| at).find(|&at| at > limit).unwrap_or(text.len());
    &text[..end]
}

fn properties() -> String {
    let parts: Vec<String> = PROPERTIES
        .iter()
        .map(|(name, words)| {
            if words.is_empty() {
                format!("{name} (true/false)")
            } else {
                format!("{name} ({})", words.join("/"))
            }
        })
        .collect();
    parts.join(", ")
}

/// The instruction, the scene and the team.
pub(crate) fn scene(request: &Request, wording: &Wording) -> String {
    if wording.bare {
        return bare(request);
    }
    let mut text =
        format!("Instruction: {}\n\nObjects (name; where; what holds now):\n", request.instruction);
    for object in &request.objects {
        let _ = write!(text, "{}", object.name);
        if !object.parents.is_empty() {
            let _ = write!(text, "; in {}", object.parents.join(", "));
        }
        if !object.states.is_empty() {
            let _ = write!(text, "; {}", object.states.join(", "));
        }
        text.push('\n');
    }
    let mut affordances: BTreeMap<&str, &[String]> = BTreeMap::new();
    for object in &request.objects {
        affordances.entry(&object.kind).or_insert(&object.affordances);
    }
    text.push_str("\nTypes and what they afford:\n");
    for (kind, affordances) in affordances {
        let _ = writeln!(text, "{kind}: {}", affordances.join(", "));
    }
    text.push_str("\nTeam:\n");
    for robot in &request.robots {
        let _ = writeln!(text, "{}: {}; lifts {} kg", robot.name, robot.skills.join(", "), robot.capacity_kg);
    }
    text
}

/// The names alone.
fn bare(request: &Request) -> String {
    let list = |names: Vec<&str>| names.join(", ");
    let mut text = format!("Instruction: {}\n\nObjects: ", request.instruction);
    text.push_str(&list(request.objects.iter().map(|o| o.name.as_str()).collect()));
    text.push_str("\n\nTeam:\n");
    for robot in &request.robots {
        let _ = writeln!(text, "{}: {}", robot.name, robot.skills.join(", "));
    }
    text
}

/// The JSON schema of an answer. Definitions are written out in place and lists are closed, since servers'
/// grammar converters know only part of the language.
pub fn schema() -> Value {
    let inner = entry(&json!({"type": "string"}));
    let content = json!({"anyOf": [{"type": "string"}, inner]});
    let subtask = json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["id", "text", "goal", "after", "lasting"],
        "properties": {
            "id": {"type": "string"},
            "text": {"type": "string"},
            "goal": {"type": "array", "items": entry(&content)},
            "after": {"type": "array", "items": {"type": "string"}},
            "robots": {"type": "array", "items": {"type": "string"}},
            "lasting": {"type": "boolean"}
        }
    });
    json!({
        "type": "object",
        "additionalProperties": false,
        "properties": {
            "subtasks": {"type": "array", "items": subtask},
            "assumptions": {"type": "array", "items": {"type": "string"}},
            "bans": {"type": "array", "items": ban()},
            "confidence": {"type": "number"},
            "question": {"type": "string"}
        }
    })
}

fn ban() -> Value {
    let text = json!({"type": "string"});
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["skill", "object"],
        "properties": {"skill": {"type": "string", "enum": SKILLS}, "object": text, "item": text}
    })
}

fn entry(content: &Value) -> Value {
    let mut properties = serde_json::Map::new();
    for (name, words) in PROPERTIES {
        let kind = if words.is_empty() {
            json!({"type": "boolean"})
        } else {
            json!({"type": "string", "enum": words})
        };
        properties.insert((*name).to_owned(), kind);
    }
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["object"],
        "properties": {
            "object": {"type": "string"},
            "contains": {"type": "array", "items": content},
            "is": {"type": "object", "additionalProperties": false, "properties": properties},
            "all": {"type": "boolean"},
            "same": {"type": "string"}
        }
    })
}
