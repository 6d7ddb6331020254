//! Scores the embedded default on crowd-written sentences with known goals.
//!
//! `score_alfred FOLDER [dev|test] [SENTENCES] [SHOW]` reads `alfred/train_compact.json.gz` and `ai2thor/*` in
//! the folder, takes that many sentences of one half of the tasks (split by the task's id), and prints the
//! rate of exact goals and the causes of the rest. Failures are shown for the development half only.
//!
//! `test` is the other half. The lexicon's first word counts were taken over a split by another hash (CRC-32),
//! which covers half of it, so `clean` is the quarter of the tasks that neither touched.
//! `LEXICON=DIR` reads the lexicon's files from a folder, so that it may be tuned without building.
//! `STRICT=1` counts a question as a failure and a state that does not last as missing.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_lm::{Answer, LanguageModel, ObjectView, Offline, Request};
use serde_json::Value;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = arguments.first().ok_or("usage: score_alfred FOLDER [dev|test] [SENTENCES] [SHOW]")?;
    let half = arguments.get(1).map_or("dev", String::as_str);
    let limit = arguments.get(2).and_then(|n| n.parse().ok()).unwrap_or(usize::MAX);
    let show: usize = arguments.get(3).and_then(|n| n.parse().ok()).unwrap_or(0);
    let folder = Path::new(folder);
    let facts = Facts::read(folder)?;
    let gz = folder.join("alfred/train_compact.json.gz");
    let unpacked = Command::new("gzip").arg("-dc").arg(&gz).output()?;
    let tasks: Value = serde_json::from_slice(&unpacked.stdout)?;
    let mut sentences: Vec<(u64, &Value, &str)> = Vec::new();
    for task in tasks["tasks"].as_array().into_iter().flatten() {
        let id = task["id"].as_str().unwrap_or_default();
        if fnv(id).is_multiple_of(2) != (half == "dev") || half == "clean" && crc32(id).is_multiple_of(2) {
            continue;
        }
        for sentence in task["sentences"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            sentences.push((fnv(&format!("{id}{sentence}")), task, sentence));
        }
    }
    sentences.sort_by_key(|(hash, _, _)| *hash);
    sentences.truncate(limit);

    let mut parser = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let mut causes: BTreeMap<String, usize> = BTreeMap::new();
    let mut by_type: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let (mut exact, mut shown) = (0, 0);
    let mut times: Vec<Duration> = Vec::new();
    for (_, task, sentence) in &sentences {
        let request = facts.request(task, sentence);
        let started = Instant::now();
        let answer = parser.decompose(&request, &AtomicBool::new(false))?;
        times.push(started.elapsed());
        let wanted = wanted(task);
        let (cause, got) = judge(&answer, &wanted, &request);
        let entry = by_type.entry(task["type"].as_str().unwrap_or_default().to_owned()).or_default();
        entry.1 += 1;
        if cause.is_empty() {
            exact += 1;
            entry.0 += 1;
            continue;
        }
        if half == "dev" && shown < show {
            shown += 1;
            println!("{cause}\n  {sentence}\n  want {wanted:?}\n  got  {got:?}");
        }
        *causes.entry(cause).or_default() += 1;
    }
    times.sort();
    let n = sentences.len().max(1);
    println!("{half}: {exact}/{} exact = {:.4}", sentences.len(), exact as f64 / n as f64);
    println!("median {:?}, worst {:?}", times[times.len() / 2], times[times.len() - 1]);
    for (kind, (good, all)) in by_type {
        println!("  {kind:42} {good:5}/{all:5}");
    }
    let mut causes: Vec<(String, usize)> = causes.into_iter().collect();
    causes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    for (cause, count) in causes {
        println!("  {count:5} {cause}");
    }
    Ok(())
}

fn fnv(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn crc32(text: &str) -> u32 {
    !text.bytes().fold(u32::MAX, |sum, byte| {
        (0..8).fold(
            sum ^ u32::from(byte),
            |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 },
        )
    })
}

fn strict() -> bool {
    std::env::var_os("STRICT").is_some()
}

/// What is known of types and floor plans.
struct Facts {
    affordances: Value,
    constants: Value,
    layouts: Value,
}

impl Facts {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let read = |name: &str| -> Result<Value, Failure> {
            Ok(serde_json::from_slice(&std::fs::read(folder.join("ai2thor").join(name))?)?)
        };
        Ok(Self {
            affordances: read("object_affordances.json")?["types"].clone(),
            constants: read("alfred_constants.json")?["data"].clone(),
            layouts: read("alfred_layouts_v2.1.json")?["floor_plans"].clone(),
        })
    }

    fn request(&self, task: &Value, sentence: &str) -> Request {
        let plan = task["floor_plan"].as_str().unwrap_or_default().trim_start_matches("FloorPlan");
        let layout = &self.layouts[plan];
        let mut counts: BTreeMap<String, u64> = BTreeMap::new();
        for (kind, count) in task["object_counts"].as_object().into_iter().flatten() {
            counts.insert(kind.clone(), count.as_u64().unwrap_or(1));
        }
        for kind in layout["object_types"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if self.affordances[kind]["pickupable"] != Value::Bool(true) && kind != "Glassbottle" {
                let poses = layout["receptacle_standing_pose"].as_object();
                let receptacles = poses
                    .map_or(0, |poses| poses.keys().filter(|id| id.split('|').next() == Some(kind)).count());
                counts.insert(kind.to_owned(), receptacles.max(1) as u64);
            }
        }
        for kind in
            ["toggle_target", "parent_target"].map(|key| task["goal"][key].as_str().unwrap_or_default())
        {
            if !kind.is_empty() {
                counts.entry(kind.to_owned()).or_insert(1);
            }
        }
        let mut objects = Vec::new();
        for (kind, count) in counts {
            for number in 1..=count {
                objects.push(self.object(&kind, number));
            }
        }
        Request {
            instruction: sentence.to_owned(),
            objects,
            robots: Vec::new(),
            assume: !strict(),
            deadline: Duration::from_secs(5),
        }
    }

    fn object(&self, kind: &str, number: u64) -> ObjectView {
        const AFFORDANCES: [&str; 12] = [
            "pickupable",
            "receptacle",
            "openable",
            "toggleable",
            "sliceable",
            "cookable",
            "breakable",
            "dirtyable",
            "canFillWithLiquid",
            "canBeUsedUp",
            "isHeatSource",
            "isColdSource",
        ];
        let known = &self.affordances[kind];
        let mut affordances: Vec<String> =
            AFFORDANCES.iter().filter(|a| known[**a] == Value::Bool(true)).map(|a| (*a).to_owned()).collect();
        let lists = &self.constants["VAL_RECEPTACLE_OBJECTS"];
        let list = if kind.ends_with("Table") { "TableTop" } else { kind };
        let accepts: Vec<String> = lists[list]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .map(str::to_owned)
            .collect();
        if !accepts.is_empty() && !affordances.iter().any(|a| a == "receptacle") {
            affordances.push("receptacle".to_owned());
        }
        if kind == "Glassbottle" {
            affordances.push("pickupable".to_owned());
        }
        ObjectView {
            name: format!("{kind}_{number}"),
            kind: kind.to_owned(),
            affordances,
            accepts,
            ..ObjectView::default()
        }
    }
}

/// A goal as a sorted list of "Type{states}@Parent".
fn wanted(task: &Value) -> Vec<String> {
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
}

fn judge(answer: &Answer, wanted: &[String], request: &Request) -> (String, Vec<String>) {
    let decomposition = match answer {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(clarification) => {
            let reason = clarification.not_understood.first().cloned().unwrap_or_default();
            return (
                format!("asks: {}", reason.split('"').next().unwrap_or_default()),
                clarification.not_understood.clone(),
            );
        }
    };
    let mut flat = Flattener { request, nodes: BTreeMap::new(), fresh: 0 };
    for subtask in &decomposition.subtasks {
        for entry in &subtask.goal {
            flat.entry(entry, "", subtask.lasting);
        }
    }
    let mut got: Vec<String> = flat
        .nodes
        .values()
        .filter(|node| !node.states.is_empty() || !node.parent.is_empty())
        .map(|node| {
            let states: Vec<String> = node.states.iter().map(|(k, v)| format!("{k}={v}")).collect();
            format!("{}{{{}}}@{}", node.kind, states.join(","), node.parent)
        })
        .collect();
    got.sort();
    if got == wanted {
        return (String::new(), got);
    }
    let part = |facts: &[String], pick: fn(&str) -> String| -> Vec<String> {
        let mut parts: Vec<String> = facts.iter().map(|fact| pick(fact)).collect();
        parts.sort();
        parts
    };
    let kind = |fact: &str| fact.split('{').next().unwrap_or_default().to_owned();
    let parent = |fact: &str| fact.split('@').nth(1).unwrap_or_default().to_owned();
    let cause = if got.len() != wanted.len() {
        format!("{} facts instead of {}", got.len(), wanted.len())
    } else if part(&got, kind) != part(wanted, kind) {
        "another object".to_owned()
    } else if part(&got, parent) != part(wanted, parent) {
        "another place".to_owned()
    } else {
        "another state".to_owned()
    };
    (cause, got)
}
