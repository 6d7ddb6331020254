//! Judges an answer by a line of `tests/data/household.txt`; the test and the scoring example share it.
//!
//! A line is `SCENE | SENTENCE | GOAL`. A goal is a list of facts with `;` between them: `Fork@Drawer`,
//! `Fork:clean`, `2 Book@Box`, `all Blinds:closed`. `~` before it: these at least (vague commands); `?`: it has
//! to ask; ` / ` between goals: either. `#` starts a comment.

use std::collections::BTreeMap;
use std::time::Duration;

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_lm::{Answer, ObjectView, Offline, Request};

/// What a line asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Exactly this goal.
    Plain,
    /// At least these facts.
    Vague,
    /// A question.
    Asks,
}

/// A line's outcome.
pub struct Outcome {
    /// The number of the line in the file.
    pub line: usize,
    /// What was said.
    pub sentence: String,
    /// What is wanted.
    pub goal: String,
    /// What the line asks for.
    pub kind: Kind,
    /// Whether that is what came.
    pub good: bool,
    /// What came.
    pub told: String,
}

/// Reads every line of a file, without assuming.
pub fn outcomes(text: &str, offline: &Offline) -> Result<Vec<Outcome>, String> {
    let mut scenes: BTreeMap<String, Vec<ObjectView>> = BTreeMap::new();
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let mut parts = line.split(" | ").map(str::trim);
        let (Some(scene), Some(sentence), Some(goal)) = (parts.next(), parts.next(), parts.next()) else {
            return Err(format!("line {}: write SCENE | SENTENCE | GOAL", number + 1));
        };
        if !scenes.contains_key(scene) {
            let world =
                lamma_domains::world::setup(scene, &[], None, 0).map_err(|error| error.to_string())?;
            scenes.insert(scene.to_owned(), lamma_domains::view::views(&world, world.facts()));
        }
        let objects = &scenes[scene];
        let answer = offline.read(&Request {
            instruction: sentence.to_owned(),
            objects: objects.clone(),
            robots: Vec::new(),
            assume: false,
            deadline: Duration::from_secs(5),
        });
        let kind = match goal.chars().next() {
            Some('~') => Kind::Vague,
            Some('?') => Kind::Asks,
            _ => Kind::Plain,
        };
        let (good, told) = judge(&answer, goal, objects);
        found.push(Outcome {
            line: number + 1,
            sentence: sentence.to_owned(),
            goal: goal.to_owned(),
            kind,
            good,
            told,
        });
    }
    Ok(found)
}

fn judge(answer: &Answer, goal: &str, objects: &[ObjectView]) -> (bool, String) {
    let decomposition = match answer {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(asks) => {
            return (goal == "?", {
                let perhaps = asks.readings.iter().map(|reading| format!("{:.2}", reading.confidence));
                let perhaps: Vec<String> = perhaps.collect();
                format!("asks: {:?} (readings at {})", asks.not_understood, perhaps.join(", "))
            });
        }
    };
    let mut got = Vec::new();
    for entry in decomposition.subtasks.iter().filter(|s| s.lasting).flat_map(|s| &s.goal) {
        facts(entry, objects, &mut got);
    }
    // What nothing undoes is as it was: said or not, it is the same goal.
    got.retain(|(fact, _)| !fact.ends_with(":uncut") && !fact.ends_with(":raw"));
    let mut got = numbered(got);
    got.sort();
    let told = format!("got  {} ({:.2})", got.join("; ").replace(" #1", ""), decomposition.confidence);
    let good = goal.trim_start_matches('~').split(" / ").any(|option| {
        let mut wanted: Vec<String> =
            option.split(';').flat_map(|fact| wanted(fact.trim().trim_start_matches('~'), objects)).collect();
        wanted.sort();
        wanted.dedup();
        if goal.starts_with('~') { wanted.iter().all(|fact| got.contains(fact)) } else { got == wanted }
    });
    (good, told)
}

fn kind_of(object: &str, objects: &[ObjectView]) -> String {
    objects.iter().find(|o| o.name == object).map_or(object, |o| &o.kind).to_owned()
}

fn count(kind: &str, objects: &[ObjectView]) -> usize {
    objects.iter().filter(|o| o.kind == kind).count()
}

/// The facts of an entry, each with what tells its object from others of its type.
pub fn facts(entry: &GoalEntry, objects: &[ObjectView], found: &mut Vec<(String, String)>) {
    let kind = kind_of(&entry.object, objects);
    let fresh = found.len();
    for number in 0..if entry.all { count(&kind, objects) } else { 1 } {
        let identity = match &entry.same {
            Some(mark) => mark.clone(),
            None if entry.all => format!("{kind}_{}", number + 1),
            None if kind != entry.object || count(&kind, objects) == 1 => entry.object.replace("_1", ""),
            None => format!("{fresh}"),
        };
        for (property, value) in &entry.is {
            found.push((format!("{kind}:{}", word(property, value)), identity.clone()));
        }
    }
    for content in &entry.contains {
        let inner = match content {
            Content::Named(name) => GoalEntry { object: name.clone(), ..GoalEntry::default() },
            Content::With(inner) => inner.as_ref().clone(),
        };
        let inside = kind_of(&inner.object, objects);
        let identity = match &inner.same {
            Some(mark) => mark.clone(),
            None if inside != inner.object || count(&inside, objects) == 1 => inner.object.replace("_1", ""),
            None => format!("{}", found.len()),
        };
        found.push((format!("{inside}@{kind}"), identity));
        facts(&inner, objects, found);
    }
}

/// `Book@Box` twice, of different books -> `Book@Box #1`, `Book@Box #2`.
pub fn numbered(mut facts: Vec<(String, String)>) -> Vec<String> {
    facts.sort();
    facts.dedup();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for (fact, _) in facts {
        let number = counts.entry(fact.clone()).or_default();
        *number += 1;
        found.push(format!("{fact} #{number}"));
    }
    found
}

fn word(property: &str, value: &PropertyValue) -> String {
    match (property, value) {
        ("isDirty", PropertyValue::Flag(dirty)) => if *dirty { "dirty" } else { "clean" }.to_owned(),
        ("isToggled", PropertyValue::Flag(on)) => if *on { "on" } else { "off" }.to_owned(),
        ("isOpen", PropertyValue::Flag(open)) => if *open { "open" } else { "closed" }.to_owned(),
        ("isFilledWithLiquid", PropertyValue::Flag(full)) => if *full { "full" } else { "empty" }.to_owned(),
        ("isSliced", PropertyValue::Flag(sliced)) => if *sliced { "sliced" } else { "uncut" }.to_owned(),
        ("isCooked", PropertyValue::Flag(cooked)) => if *cooked { "cooked" } else { "raw" }.to_owned(),
        ("isPickedUp", _) => "held".to_owned(),
        ("isBroken", PropertyValue::Flag(broken)) => if *broken { "broken" } else { "whole" }.to_owned(),
        (_, PropertyValue::Word(word)) => word.to_lowercase(),
        (property, value) => format!("{property}={value:?}"),
    }
}

/// `2 Book@Box` -> two facts.
fn wanted(fact: &str, objects: &[ObjectView]) -> Vec<String> {
    let (times, fact) = match fact.split_once(' ') {
        Some(("all", rest)) => (count(rest.split([':', '@']).next().unwrap_or_default(), objects), rest),
        Some((number, rest)) => (number.parse().unwrap_or(1), rest),
        None => (1, fact),
    };
    (1..=times).map(|number| format!("{fact} #{number}")).collect()
}
