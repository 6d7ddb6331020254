//! Whether a goal is what a sentence asks for. A heuristic without a list of lines, sentences or tasks.
//!
//! The goal agrees if everything in it is in the sentence:
//!
//! 1. Each object type of the goal is *named* (a word of the sentence is the type's name, a word of the name, or
//!    nearly so: `keychain`, `light`, `tomoate`) or *implied* by a word for a class of things whose members
//!    AI2-THOR's affordances and materials tell (`vegetables` are food, `chill` needs a cold source).
//! 2. Each property of the goal is asked for by a word (`slice`, `turn off`) or by a named appliance that brings
//!    it about (a coffee machine makes hot).
//!
//! What the sentence asks for beyond the goal does not count against it: doing more than is checked is no
//! failure. A sentence that only hints at its goal ("get the place ready for guests") agrees with none.

use crate::goal::{Content, GoalEntry, PropertyValue};
use crate::kinds::{Kind, Kinds};
use crate::nearest::distance;
use crate::property::Property;

use super::types;

/// The judgement and its reasons.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Whether the goal is what the sentence asks for.
    pub agrees: bool,
    /// What in the goal the sentence does not ask for; empty if it agrees.
    pub reasons: Vec<String>,
}

/// Whether a type of that name is in a class.
type Member = fn(&str, &Kind) -> bool;

/// Words for a class of things, and what its members are.
const CLASSES: [(&[&str], Member); 9] = [
    (&["vegetable", "veggie", "veges", "food", "ingredient", "grocery", "groceries"], |_, k| {
        made_of(k, "Food")
    }),
    (&["electronic", "electronics", "device", "gadget"], |_, k| k.is("toggleable") && k.is("breakable")),
    (&["chill", "cool", "refrigerate", "refrigerator", "cold"], |_, k| k.is("isColdSource")),
    (&["heating", "heat", "warm", "microwave"], |n, k| {
        k.is("isHeatSource") && k.is("openable") || n == "Microwave"
    }),
    (&["toast"], |n, _| n == "Toaster" || n == "Bread"),
    (&["trash", "garbage", "rubbish", "bin", "trashcan"], |n, _| n == "GarbageCan"),
    (&["water", "tap", "shower"], |n, _| n == "Faucet" || n == "ShowerHead"),
    (&["tv"], |n, _| n == "Television"),
    (&["dark", "lamp", "lit"], |n, k| k.is("toggleable") && (n.contains("Light") || n.contains("Lamp"))),
];

/// Words that ask for a property and value.
const ASKED: [(Property, bool, &[&str]); 10] = [
    (Property::Sliced, true, &["slice", "sliced", "cut", "chop"]),
    (Property::Cooked, true, &["cook", "cooked", "toast", "fry", "boil", "bake", "microwave"]),
    (Property::Broken, true, &["break", "smash", "destroy", "shatter"]),
    (Property::Open, true, &["open"]),
    (Property::Open, false, &["close", "shut"]),
    (Property::Toggled, true, &["on", "lit", "light", "water"]),
    (Property::Toggled, false, &["off", "dark"]),
    (Property::PickedUp, true, &["pick", "hold", "grab", "take"]),
    (Property::Dirty, false, &["wash", "clean", "rinse"]),
    (Property::Filled, false, &["empty", "clear", "pour"]),
];

fn made_of(kind: &Kind, material: &str) -> bool {
    kind.materials.iter().any(|m| m == material)
}

/// Judges a goal by its sentence.
pub(super) fn judge(sentence: &str, goal: &[GoalEntry]) -> Agreement {
    let words: Vec<String> = sentence
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    let mut reasons = Vec::new();
    for entry in types(goal) {
        let contents = entry.contains.iter().filter_map(|c| match c {
            Content::Named(name) => Some(name.as_str()),
            Content::With(_) => None,
        });
        for name in std::iter::once(entry.object.as_str()).chain(contents) {
            if !named(name, &words) && !implied(name, &words) {
                reasons.push(format!("the sentence does not speak of a {name}"));
            }
        }
        for (property, value) in &entry.is {
            if !asked(property, value, &words) {
                reasons.push(format!("the sentence does not ask for `{property}` of the {}", entry.object));
            }
        }
    }
    Agreement { agrees: reasons.is_empty() && !goal.is_empty(), reasons }
}

/// The words of `CellPhone`: `cell`, `phone`, and `cellphone`.
fn parts(name: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for c in name.chars() {
        match parts.last_mut() {
            Some(last) if !c.is_ascii_uppercase() => last.push(c.to_ascii_lowercase()),
            _ => parts.push(c.to_ascii_lowercase().to_string()),
        }
    }
    if parts.len() > 1 {
        parts.push(name.to_ascii_lowercase());
    }
    parts
}

fn named(name: &str, words: &[String]) -> bool {
    let kind = Kinds::get().whole(name);
    parts(kind).iter().any(|part| words.iter().any(|word| alike(word, part)))
}

/// Equal, a plural, a longer compound (`breadloaf`), one slip in a word of five letters or more, or two in one
/// of six or more that begins alike (a `potato` is no `tomato`).
fn alike(word: &str, part: &str) -> bool {
    let plural = word.strip_suffix('s').unwrap_or(word);
    let compound = part.len() >= 4 && word.starts_with(part);
    let slips = distance(word, part).min(distance(plural, part));
    let begins_alike = word.chars().next() == part.chars().next();
    let slip = part.len() >= 5 && slips <= 1 || part.len() >= 6 && slips <= 2 && begins_alike;
    word == part || plural == part || compound || slip
}

fn implied(name: &str, words: &[String]) -> bool {
    let Some(kind) = Kinds::get().find(name) else { return false };
    let says = |list: &[&str]| list.iter().any(|w| words.iter().any(|word| alike(word, w)));
    CLASSES.iter().any(|(list, member)| says(list) && member(name, kind))
}

fn asked(property: &str, value: &PropertyValue, words: &[String]) -> bool {
    let Ok(property) = Property::parse(property) else { return false };
    let says = |list: &[&str]| list.iter().any(|w| words.iter().any(|word| word == w || alike(word, w)));
    match value {
        PropertyValue::Flag(flag) => {
            ASKED.iter().any(|(p, v, list)| *p == property && v == flag && says(list))
        }
        PropertyValue::Word(word) => {
            let appliance = |kind: &Kind| match word.as_str() {
                "Hot" => kind.is("isHeatSource"),
                "Cold" => kind.is("isColdSource"),
                _ => false,
            };
            says(&[&word.to_ascii_lowercase()])
                || Kinds::get().all().any(|(name, kind)| appliance(kind) && named(name, words))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_agree_with_sentences_that_ask_for_them() {
        for (sentence, goal, agrees) in [
            (
                "Lay the keychain and the pens on the desk",
                r#"[{"object": "Desk", "contains": ["KeyChain", "Pen"]}]"#,
                true,
            ),
            ("Lay the pens on the desk", r#"[{"object": "Desk", "contains": ["Pencil"]}]"#, false),
            ("Cool the vegetables", r#"[{"object": "Fridge", "contains": ["Potato", "Tomato"]}]"#, true),
            ("Cool the potatoes", r#"[{"object": "Fridge", "contains": ["Tomato"]}]"#, false),
            ("Fry the potatoes", r#"[{"object": "Tomato", "is": {"isCooked": true}}]"#, false),
            (
                "Chop the tomatos, then the light goes off",
                r#"[{"object": "Tomato", "is": {"isSliced": true}}, {"object": "LightSwitch", "is": {"isToggled": false}}]"#,
                true,
            ),
            ("Look at the tomato", r#"[{"object": "Tomato", "is": {"isSliced": true}}]"#, false),
            (
                "Use the coffee machine with the mug",
                r#"[{"object": "Mug", "is": {"temperature": "Hot"}}]"#,
                true,
            ),
            ("Smash the gadgets", r#"[{"object": "CellPhone", "is": {"isBroken": true}}]"#, true),
            ("Get the place ready for guests", r#"[{"object": "Sofa", "contains": ["Pillow"]}]"#, false),
            ("Anything", "[]", false),
        ] {
            let goal: Vec<GoalEntry> = serde_json::from_str(goal).unwrap();
            let judged = judge(sentence, &goal);
            assert_eq!(judged.agrees, agrees, "{sentence}: {:?}", judged.reasons);
        }
    }
}
