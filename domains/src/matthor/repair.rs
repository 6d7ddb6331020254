//! Names and states of the released files in AI2-THOR's own words.

use std::collections::BTreeMap;

use crate::goal::{Content, GoalEntry, PropertyValue};
use crate::kinds::Kinds;
use crate::nearest::distance;
use crate::property::Property;

use super::TruthEntry;

/// What people call things.
const CALLED: [(&str, &str); 6] = [
    ("trash", "GarbageCan"),
    ("trashcan", "GarbageCan"),
    ("bin", "GarbageCan"),
    ("tv", "Television"),
    ("light", "LightSwitch"),
    ("phone", "CellPhone"),
];

/// The type a name must mean, with a note if it was not spelt so. A misspelling is certain if exactly one type
/// is as near, within two letters and a third of the word.
pub(super) fn type_name(given: &str) -> Result<(String, Option<String>), String> {
    let kinds = Kinds::get();
    if kinds.find(given).is_some() {
        return Ok((given.to_string(), None));
    }
    let plain: String = given.chars().filter(|c| c.is_ascii_alphanumeric()).collect();
    let plain = plain.to_ascii_lowercase();
    let note = |name: &str| Ok((name.to_string(), Some(format!("read the name `{given}` as {name}"))));
    if let Some(name) = kinds.names().find(|n| n.to_ascii_lowercase() == plain) {
        return note(name);
    }
    if let Some((_, name)) = CALLED.iter().find(|(called, _)| *called == plain) {
        return note(name);
    }
    let allowed = (plain.len() / 3).min(2);
    let mut near: Vec<(usize, &str)> = kinds
        .names()
        .map(|n| (distance(&n.to_ascii_lowercase(), &plain), n))
        .filter(|(d, _)| *d <= allowed)
        .collect();
    near.sort_unstable();
    match near.as_slice() {
        [(_, name)] => note(name),
        [(best, name), (second, _), ..] if best < second => note(name),
        _ => Err(format!("`{given}` is no object type")),
    }
}

/// The property a state word means.
fn state(word: &str) -> Option<(Property, PropertyValue)> {
    let flag = |property, value| Some((property, PropertyValue::Flag(value)));
    match word.to_ascii_uppercase().as_str() {
        "SLICED" => flag(Property::Sliced, true),
        "ON" => flag(Property::Toggled, true),
        "OFF" => flag(Property::Toggled, false),
        "HOT" => Some((Property::Temperature, PropertyValue::Word("Hot".to_string()))),
        "COOKED" => flag(Property::Cooked, true),
        "OPENED" => flag(Property::Open, true),
        "CLOSED" => flag(Property::Open, false),
        "PICKED" => flag(Property::PickedUp, true),
        "BROKEN" => flag(Property::Broken, true),
        "EMPTY" => flag(Property::Filled, false),
        _ => None,
    }
}

/// A ground-truth entry as a goal entry, or nothing if it says nothing.
pub(super) fn goal_entry(truth: &TruthEntry, notes: &mut Vec<String>) -> Result<Option<GoalEntry>, String> {
    let mut named = |name: &str| -> Result<String, String> {
        let (kind, note) = type_name(name)?;
        notes.extend(note);
        Ok(kind)
    };
    let object = named(&truth.name)?;
    let contains: Vec<String> = truth.contains.iter().map(|c| named(c)).collect::<Result<_, _>>()?;
    let mut entry = GoalEntry { object, ..GoalEntry::default() };
    let has = |kind: &str, property: Property| {
        Kinds::get().find(kind).is_some_and(|k| property.applies(kind, |a| k.is(a)))
    };
    let mut of_contents: BTreeMap<String, PropertyValue> = BTreeMap::new();
    if let Some(word) = &truth.state {
        let (property, value) = state(word).ok_or_else(|| format!("unknown state `{word}`"))?;
        if is_not_upper_case(word) {
            notes.push(format!("read the state `{word}` as {}", word.to_ascii_uppercase()));
        }
        if has(&entry.object, property) {
            entry.is.insert(property.name().to_string(), value);
        } else if !contains.is_empty() && contains.iter().all(|c| has(c, property)) {
            notes.push(format!("`{word}`, said of the {}, is meant of what it contains", entry.object));
            of_contents.insert(property.name().to_string(), value);
        } else {
            return Err(format!("a {} cannot be {word}", entry.object));
        }
    }
    entry.contains = contains
        .into_iter()
        .map(|object| match of_contents.is_empty() {
            true => Content::Named(object),
            false => {
                Content::With(Box::new(GoalEntry { object, is: of_contents.clone(), ..GoalEntry::default() }))
            }
        })
        .collect();
    if entry.is.is_empty() && entry.contains.is_empty() {
        notes.push(format!("left out an entry that says nothing of the {}", entry.object));
        return Ok(None);
    }
    Ok(Some(entry))
}

/// All states but a few are written in upper case.
fn is_not_upper_case(word: &str) -> bool {
    word.chars().any(|c| c.is_ascii_lowercase())
}
