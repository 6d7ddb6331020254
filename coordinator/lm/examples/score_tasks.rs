//! Compares the goals that the embedded default reads from a suite's sentences with the suite's own, without a
//! run: `score_tasks [FILE.jsonl]`. It prints counts by category and cause only, no sentence and no object.
//!
//! "Enough" is what a run needs: the suite's facts are among those read, or hold at the start. Where something is
//! missing, it says of what kind, what was read in its place, and which constructions the sentence makes use of.

#[path = "../tests/judge/mod.rs"]
#[allow(dead_code, reason = "only its facts are used here")]
mod judge;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Duration;

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_domains::robots;
use lamma_domains::world::ObjectSpec;
use lamma_lm::{Answer, ObjectView, Offline, Request, RobotView};
use serde_json::Value;

type Failure = Box<dyn std::error::Error>;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../domains/tasks/mat-thor.jsonl");

#[derive(Default)]
struct Tally {
    tasks: usize,
    enough: usize,
    exact: usize,
    causes: BTreeMap<String, usize>,
}

fn main() -> Result<(), Failure> {
    let file = std::env::args().nth(1).unwrap_or_else(|| FILE.to_owned());
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for line in std::fs::read_to_string(&file)?.lines().filter(|line| !line.trim().is_empty()) {
        let task: Value = serde_json::from_str(line)?;
        let specs: Option<Vec<ObjectSpec>> = serde_json::from_value(task["objects"].clone())?;
        let scene = task["scene"].as_str().unwrap_or_default();
        let world = lamma_domains::world::setup(scene, &[], specs.as_deref(), 0)?;
        let objects = lamma_domains::view::views(&world, world.facts());
        let goal: Vec<GoalEntry> = serde_json::from_value(task["goal"].clone())?;
        let answer = offline.read(&Request {
            instruction: task["instruction"].as_str().unwrap_or_default().to_owned(),
            objects: objects.clone(),
            robots: team(&task)?,
            assume: false,
            deadline: Duration::from_secs(5),
        });
        let category = task["category"].as_str().unwrap_or("?").to_owned();
        let made_of = constructions(task["instruction"].as_str().unwrap_or_default());
        tally(tallies.entry(category).or_default(), &answer, &goal, &objects, &made_of);
    }
    for (category, Tally { tasks, enough, exact, causes }) in tallies {
        println!("{category}: enough for {enough} of {tasks}, the same goal for {exact}");
        for (cause, times) in causes {
            println!("  {times} × {cause}");
        }
    }
    Ok(())
}

fn team(task: &Value) -> Result<Vec<RobotView>, Failure> {
    let robots = robots::team(&serde_json::from_value::<Vec<robots::Member>>(task["team"].clone())?)?;
    let view = |r: robots::Robot| RobotView { name: r.name, skills: r.skills, capacity_kg: r.capacity_kg };
    Ok(robots.into_iter().map(view).collect())
}

fn tally(tally: &mut Tally, answer: &Answer, goal: &[GoalEntry], objects: &[ObjectView], made_of: &str) {
    tally.tasks += 1;
    let mut note = |cause: String| *tally.causes.entry(format!("{cause}\n      {made_of}")).or_default() += 1;
    let decomposition = match answer {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(asks) => {
            let about: BTreeSet<String> =
                asks.not_understood.iter().map(|text| told(text, objects)).collect();
            let wanted = by_class(&facts(goal, objects), objects);
            let about = about.into_iter().collect::<Vec<_>>().join(", ");
            let read = asks.readings.iter().map(|reading| reading.subtasks.len()).max().unwrap_or(0);
            return note(format!(
                "asks: {about}\n      {} problems beside {read} sub-tasks; wants {wanted}",
                asks.not_understood.len()
            ));
        }
    };
    let read: Vec<GoalEntry> =
        decomposition.subtasks.iter().filter(|s| s.lasting).flat_map(|s| s.goal.clone()).collect();
    let got = facts(&read, objects);
    let open: Vec<GoalEntry> = goal.iter().filter(|entry| !holds_now(entry, objects)).cloned().collect();
    let missing: Vec<String> = facts(&open, objects).into_iter().filter(|f| !got.contains(f)).collect();
    let wanted = facts(goal, objects);
    let more: Vec<String> = got.iter().filter(|fact| !wanted.contains(fact)).cloned().collect();
    if missing.is_empty() {
        tally.enough += 1;
        tally.exact += usize::from(more.is_empty());
        return;
    }
    let causes: BTreeSet<String> = missing.iter().map(|fact| cause(fact, &got)).collect();
    let causes: Vec<String> = causes.into_iter().collect();
    note(format!(
        "lacks {} of {}: {}\n      in {} sub-tasks; wants {}; lacks {}; too much {}",
        missing.len(),
        wanted.len(),
        causes.join(", "),
        decomposition.subtasks.len(),
        by_class(&wanted, objects),
        by_class(&missing, objects),
        by_class(&more, objects)
    ));
}

/// Facts by predicate and by what sort of things they are of, counted.
fn by_class(facts: &[String], objects: &[ObjectView]) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for fact in facts {
        let fact = fact.split(" #").next().unwrap_or_default();
        let told = match (fact.split_once('@'), fact.split_once(':')) {
            (Some((thing, place)), _) => format!("{} in {}", sort(thing, objects), sort(place, objects)),
            (_, Some((thing, state))) => format!("{} {state}", sort(thing, objects)),
            _ => "?".to_owned(),
        };
        *counts.entry(told).or_default() += 1;
    }
    let told: Vec<String> = counts.into_iter().map(|(told, times)| format!("{times} {told}")).collect();
    if told.is_empty() { "nothing".to_owned() } else { told.join(", ") }
}

/// What sort of thing a type is, by what it affords.
fn sort(kind: &str, objects: &[ObjectView]) -> &'static str {
    let plain = |kind: &str| kind.replace("SinkBasin", "Sink").replace("BathtubBasin", "Bathtub");
    let affords = |affordance: &str| {
        let of_kind = |object: &&ObjectView| plain(&object.kind) == kind;
        objects.iter().filter(of_kind).any(|object| object.affordances.iter().any(|a| a == affordance))
    };
    let fixed = !affords("pickupable");
    match () {
        () if affords("sliceable") => "food",
        () if !fixed && affords("receptacle") => "vessel",
        () if !fixed => "item",
        () if affords("isColdSource") || affords("isHeatSource") => "appliance",
        () if affords("toggleable") => "switch",
        () if affords("openable") => "cupboard",
        () if affords("receptacle") => "surface",
        () => "fixture",
    }
}

/// Which constructions a sentence makes use of, and how long it is; none of its own words.
fn constructions(sentence: &str) -> String {
    const KINDS: [(&str, &[&str]); 12] = [
        ("condition", &["if", "unless", "case"]),
        ("meanwhile", &["while", "meanwhile", "meantime", "as"]),
        ("order", &["then", "before", "after", "once", "when", "next", "finally", "until"]),
        ("quantifier", &["all", "every", "each", "both", "any", "everything", "whole"]),
        ("number", &["two", "three", "four", "2", "3", "4"]),
        ("exception", &["except", "but", "apart", "other", "rest"]),
        ("negation", &["not", "dont", "without", "never", "no"]),
        ("pronoun", &["it", "them", "they", "one", "ones", "these", "those", "there"]),
        ("relative", &["which", "that", "who", "whatever"]),
        ("wish", &["should", "must", "need", "needs", "want", "would", "like", "be"]),
        ("person", &["i", "we", "my", "our", "somebody", "someone"]),
        ("robot", &["robot", "robots", "together"]),
    ];
    let plain = sentence.to_lowercase().replace('\'', "");
    let words: Vec<&str> = plain.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let used = KINDS.iter().filter(|(_, of)| words.iter().any(|word| of.contains(word)));
    let kinds: Vec<&str> = used.map(|(kind, _)| *kind).collect();
    let commas = sentence.matches([',', ';']).count();
    let stops = sentence.matches(['.', '!', '?', ':']).count();
    format!("{} words, {commas} commas, {stops} stops: {}", words.len(), kinds.join(" "))
}

/// What kind of thing a question is about; of what cannot change, also what sort it is and what it lacks.
fn told(text: &str, objects: &[ObjectView]) -> String {
    let about = about(text);
    // What sort of thing has no place: of what is quoted, the type that is named in it.
    let quoted: String = text.split('"').nth(1).unwrap_or_default().replace(' ', "").to_lowercase();
    let named = objects.iter().find(|object| quoted.contains(&object.kind.to_lowercase()));
    if about == "a place left out" {
        return format!("{about} ({})", named.map_or("?", |object| sort(&object.kind, objects)));
    }
    let kind = text.split(['(', ')']).nth(1).filter(|_| text.contains(") is not "));
    match (kind, text.rsplit(' ').next()) {
        (Some(kind), Some(lacking)) => format!("{about} ({}, {lacking})", sort(kind, objects)),
        _ => about.to_owned(),
    }
}

/// What kind of thing a question is about.
fn about(text: &str) -> &'static str {
    const ABOUT: [(&str, &str); 16] = [
        ("is not said what the slices", "slices of nothing"),
        ("is not said what the water", "water in nothing"),
        ("is not said what to do about", "a state told, not asked for"),
        ("what \"it\" is", "a singular pronoun of nothing"),
        ("what \"them\" is", "a plural pronoun of nothing"),
        ("is not openable", "what does not open is to"),
        ("is not toggleable", "what has no switch is switched"),
        ("I do not know what \"", "a noun or verb unknown"),
        ("I do not know what to do", "no order found"),
        ("there is no ", "something absent"),
        ("it is not said where", "a place left out"),
        ("it is not said what", "a thing left out"),
        ("is forbidden, but", "a ban broken"),
        ("is not said which", "which of them is left open"),
        ("is not ", "what cannot change so"),
        ("cannot", "an impossible change"),
    ];
    ABOUT.iter().find(|(words, _)| text.contains(words)).map_or("something else", |(_, about)| about)
}

/// The kind of a missing fact, and what was read in its place.
fn cause(fact: &str, got: &[String]) -> String {
    let bare = |fact: &str| fact.split(" #").next().unwrap_or_default().to_owned();
    let fact = bare(fact);
    let others: Vec<String> = got.iter().map(|fact| bare(fact)).collect();
    if others.contains(&fact) {
        return "a second one of the same".to_owned();
    }
    if let Some((thing, place)) = fact.split_once('@') {
        let elsewhere = others.iter().any(|o| o.split('@').next() == Some(thing) && o.contains('@'));
        let filled = others.iter().any(|o| o.split('@').nth(1) == Some(place));
        let known = others.iter().any(|o| o.starts_with(&format!("{thing}:")));
        return match (elsewhere, filled, known) {
            (true, ..) => "contains (it is put elsewhere)",
            (_, true, _) => "contains (other things are put there)",
            (_, _, true) => "contains (the thing only gets a state)",
            _ => "contains (nothing like it)",
        }
        .to_owned();
    }
    let (thing, state) = fact.split_once(':').unwrap_or((&fact, ""));
    let same_thing =
        others.iter().any(|o| o.starts_with(&format!("{thing}:")) || o.starts_with(&format!("{thing}@")));
    let same_state = others.iter().any(|o| o.ends_with(&format!(":{state}")));
    let of = match (same_thing, same_state) {
        (true, _) => "of a thing that something else is done to",
        (_, true) => "of a thing left out",
        _ => "nothing like it",
    };
    format!("{state} ({of})")
}

fn facts(entries: &[GoalEntry], objects: &[ObjectView]) -> Vec<String> {
    let mut found = Vec::new();
    entries.iter().for_each(|entry| judge::facts(entry, objects, &mut found));
    // A basin is a sink.
    let plain = |fact: String| fact.replace("SinkBasin", "Sink").replace("BathtubBasin", "Bathtub");
    judge::numbered(found.into_iter().map(|(fact, of)| (plain(fact), of)).collect())
}

/// Whether an entry holds before anything is done, by one object or, if it says so, by all.
fn holds_now(entry: &GoalEntry, objects: &[ObjectView]) -> bool {
    let mut meant = objects.iter().filter(|o| o.kind == entry.object || o.name == entry.object);
    if entry.all { meant.all(|o| is_so(entry, o, objects)) } else { meant.any(|o| is_so(entry, o, objects)) }
}

fn is_so(entry: &GoalEntry, object: &ObjectView, objects: &[ObjectView]) -> bool {
    let stated = entry.is.iter().all(|(property, value)| match value {
        PropertyValue::Flag(flag) => object.states.contains(property) == *flag,
        PropertyValue::Word(word) => object.states.contains(&format!("{property}:{word}")),
    });
    let within: Vec<&ObjectView> =
        objects.iter().filter(|o| o.parents.first() == Some(&object.name)).collect();
    stated
        && entry.contains.iter().all(|content| {
            within.iter().any(|inner| match content {
                Content::Named(kind) => inner.kind == *kind || inner.name == *kind,
                Content::With(entry) => inner.kind == entry.object && is_so(entry, inner, objects),
            })
        })
}
