//! Tasks made up for any scene: as many as one likes, the same for the same seed.
//!
//! A task has one to three sub-tasks that do not hang together (bring something somewhere, slice, switch, open)
//! and a team that has the skills and the strength for them. Types of which the scene has exactly one are spoken
//! of, so that the sentence leaves nothing open.

use std::collections::BTreeMap;

use crate::HouseError;
use crate::goal::{Content, GoalEntry, PropertyValue};
use crate::kinds::{self, Kinds};
use crate::robots::{self, Member, Robot};
use crate::scene;
use crate::seed::Seed;
use crate::tasks::Task;
use crate::world::{Rules, Thing, setup};

/// The most sub-tasks of a task.
const MAX_SUBTASKS: usize = 3;
/// Tries for a sub-task before the task is left as it is.
const TRIES: usize = 50;

/// `count` tasks for the scene.
pub fn tasks(scene_name: &str, count: usize, seed: u64) -> Result<Vec<Task>, HouseError> {
    let scene = scene::load(scene_name)?;
    let world = setup(&scene.scene, &[], None, seed)?;
    let mut by_kind: BTreeMap<&str, Vec<&Thing>> = BTreeMap::new();
    for thing in &world.things {
        by_kind.entry(&thing.kind).or_default().push(thing);
    }
    let unique: Vec<&Thing> = by_kind.values().filter(|t| t.len() == 1).map(|t| t[0]).collect();
    let made = (0..count).map(|index| {
        let mut random = Seed::new(seed, &[&scene.scene, &index.to_string()]);
        task(&scene.scene, index, &unique, &mut random)
    });
    Ok(made.collect())
}

/// A part of a task: what is said, what shall hold, and what it takes.
struct Part {
    text: String,
    goal: GoalEntry,
    skills: &'static [&'static str],
    mass_kg: f64,
}

fn task(scene: &str, index: usize, things: &[&Thing], random: &mut Seed) -> Task {
    let wanted = 1 + random.below(MAX_SUBTASKS);
    let mut spoken_of: Vec<String> = Vec::new();
    let mut parts: Vec<Part> = Vec::new();
    for _ in 0..TRIES {
        if parts.len() == wanted {
            break;
        }
        let free: Vec<&Thing> = things.iter().filter(|t| !spoken_of.contains(&t.kind)).copied().collect();
        if let Some((part, kinds)) = part(&free, random) {
            spoken_of.extend(kinds);
            parts.push(part);
        }
    }
    let said: Vec<&str> = parts.iter().map(|p| p.text.as_str()).collect();
    Task {
        id: format!("{scene}-g{:03}", index + 1),
        suite: "generated".to_string(),
        category: "compound".to_string(),
        scene: scene.to_string(),
        instruction: sentence(&said),
        team: team(&parts, random),
        objects: None,
        goal: parts.into_iter().map(|p| p.goal).collect(),
        reference: None,
        rules: Rules::default(),
    }
}

/// One sub-task about things that are free, and the types it speaks of.
fn part(free: &[&Thing], random: &mut Seed) -> Option<(Part, Vec<String>)> {
    if free.is_empty() {
        return None;
    }
    let x = free[random.below(free.len())];
    let is = |property: &str, value: bool| GoalEntry {
        object: x.kind.clone(),
        is: BTreeMap::from([(property.to_string(), PropertyValue::Flag(value))]),
        ..GoalEntry::default()
    };
    let name = spoken(&x.kind);
    let on = x.flag("isToggled");
    let part = if x.can("pickupable") && (!x.can("sliceable") || random.below(2) == 0) {
        return bring(x, free, random);
    } else if x.can("sliceable") && free.iter().any(|t| t.kind == "Knife") {
        Part {
            text: format!("slice the {name}"),
            goal: is("isSliced", true),
            skills: &["SliceObject", "PickupObject", "OpenObject"],
            mass_kg: 0.2,
        }
    } else if x.can("toggleable") {
        let (word, skills) = if on { ("off", &["SwitchOff"][..]) } else { ("on", &["SwitchOn"][..]) };
        Part { text: format!("switch {word} the {name}"), goal: is("isToggled", !on), skills, mass_kg: 0.0 }
    } else if x.can("openable") && !x.flag("isOpen") {
        Part {
            text: format!("open the {name}"),
            goal: is("isOpen", true),
            skills: &["OpenObject"],
            mass_kg: 0.0,
        }
    } else {
        return None;
    };
    // A knife in hand for the slicing may not be wanted elsewhere.
    let knife = part.skills.contains(&"SliceObject").then(|| "Knife".to_string());
    Some((part, std::iter::once(x.kind.clone()).chain(knife).collect()))
}

fn bring(x: &Thing, free: &[&Thing], random: &mut Seed) -> Option<(Part, Vec<String>)> {
    let kinds = Kinds::get();
    let elsewhere = |c: &&&Thing| {
        let usual = kinds.accepts(&c.kind, &x.kind) && c.kind != "Floor";
        c.can("receptacle") && usual && x.parent.as_deref() != Some(c.name.as_str())
    };
    let places: Vec<&&Thing> = free.iter().filter(elsewhere).collect();
    if places.is_empty() {
        return None;
    }
    let place = places[random.below(places.len())];
    let goal = GoalEntry {
        object: place.kind.clone(),
        contains: vec![Content::Named(x.kind.clone())],
        ..GoalEntry::default()
    };
    let text =
        format!("put the {} {} the {}", spoken(&x.kind), preposition(&place.kind), spoken(&place.kind));
    let skills = &["PickupObject", "PutObject", "OpenObject"];
    Some((Part { text, goal, skills, mass_kg: x.mass_kg }, vec![x.kind.clone(), place.kind.clone()]))
}

/// Things lie on surfaces and in everything with sides.
fn preposition(receptacle: &str) -> &'static str {
    let hollow =
        ["Basin", "Bathtub", "Bowl", "CoffeeMachine", "Cup", "GarbageCan", "Mug", "Pan", "Pot", "Sink"];
    let sides = hollow.iter().any(|h| receptacle.ends_with(h)) || kinds::encloses(receptacle);
    if sides { "in" } else { "on" }
}

/// `coffee machine` of `CoffeeMachine`; a light switch is called the light.
fn spoken(kind: &str) -> String {
    if kind == "LightSwitch" {
        return "light".to_string();
    }
    let mut words = String::new();
    for (index, c) in kind.chars().enumerate() {
        if c.is_ascii_uppercase() && index > 0 && !words.ends_with(|p: char| p.is_ascii_uppercase()) {
            words.push(' ');
        }
        words.push(c);
    }
    words.to_ascii_lowercase()
}

fn sentence(parts: &[&str]) -> String {
    let joined = match parts.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => parts.concat(),
    };
    let mut letters = joined.chars();
    letters
        .next()
        .map_or(String::new(), |first| format!("{}{}.", first.to_ascii_uppercase(), letters.as_str()))
}

/// Two robots of the catalogue, and for each sub-task that they cannot do one that can.
fn team(parts: &[Part], random: &mut Seed) -> Vec<Member> {
    let all = robots::catalogue();
    let mut team: Vec<&Robot> = vec![&all[random.below(all.len())]];
    let second = &all[random.below(all.len())];
    if second.name != team[0].name {
        team.push(second);
    }
    for part in parts {
        let able = |r: &&Robot| part.skills.iter().all(|s| r.has(s)) && r.capacity_kg >= part.mass_kg;
        if !team.iter().any(&able) {
            let able: Vec<&Robot> = all.iter().filter(able).collect();
            // The catalogue has robots with all skills and 100 kg, so there always is one.
            team.extend(able.get(random.below(able.len())));
        }
    }
    team.into_iter().map(|r| Member::Named(r.name.clone())).collect()
}
