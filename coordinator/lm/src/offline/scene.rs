//! The scene as the parser needs it: objects by type, what they afford, what they accept.

use std::collections::{BTreeMap, BTreeSet};

use lamma_domains::goal::PropertyValue;

use super::lexicon::{Settings, split_camel_case};
use super::spelling::Spelling;
use crate::{ObjectView, RobotView};

/// An index over the objects of a request.
pub struct Scene<'a> {
    objects: BTreeMap<&'a str, &'a ObjectView>,
    kinds: BTreeMap<&'a str, Vec<&'a ObjectView>>,
    words: BTreeSet<String>,
    spelling: Spelling,
    /// By name in lower case, the first of equal ones.
    lower: BTreeMap<String, &'a ObjectView>,
    /// What objects of each type afford.
    affordances: BTreeMap<&'a str, BTreeSet<&'a str>>,
    team: &'a [RobotView],
}

impl<'a> Scene<'a> {
    /// Indexes the objects.
    pub fn new(objects: &'a [ObjectView], team: &'a [RobotView]) -> Self {
        let mut kinds: BTreeMap<&str, Vec<&ObjectView>> = BTreeMap::new();
        for object in objects {
            kinds.entry(&object.kind).or_default().push(object);
        }
        for list in kinds.values_mut() {
            list.sort_by(|a, b| natural(&a.name).cmp(&natural(&b.name)));
        }
        let mut words = BTreeSet::new();
        for kind in kinds.keys() {
            let phrase = split_camel_case(kind);
            words.insert(phrase.replace(' ', ""));
            words.extend(phrase.split(' ').map(str::to_owned));
        }
        let objects: BTreeMap<&str, &ObjectView> =
            objects.iter().map(|object| (object.name.as_str(), object)).collect();
        let mut lower = BTreeMap::new();
        let mut affordances: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for &object in objects.values() {
            lower.entry(object.name.to_ascii_lowercase()).or_insert(object);
            let known = affordances.entry(&object.kind).or_default();
            known.extend(object.affordances.iter().map(String::as_str));
        }
        let spelling = Spelling::of(words.iter().map(String::as_str));
        Self { objects, kinds, words, spelling, lower, affordances, team }
    }

    /// The objects of a type, in the order of their numbers.
    pub fn of_kind(&self, kind: &str) -> &[&'a ObjectView] {
        self.kinds.get(kind).map(Vec::as_slice).unwrap_or_default()
    }

    /// Whether there is an object of the type.
    pub fn has(&self, kind: &str) -> bool {
        self.kinds.contains_key(kind)
    }

    /// The types there are.
    pub fn kinds(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.kinds.keys().copied()
    }

    /// The object of a name, whatever its case.
    pub fn named(&self, name: &str) -> Option<&'a ObjectView> {
        self.objects.get(name).copied().or_else(|| self.lower.get(&name.to_ascii_lowercase()).copied())
    }

    /// Whether objects of a type afford something.
    pub fn affords(&self, kind: &str, affordance: &str) -> bool {
        self.affordances.get(kind).is_some_and(|known| known.contains(affordance))
    }

    /// Whether a receptacle type takes a type. Where a scene states nothing of a receptacle, it may.
    pub fn accepts(&self, receptacle: &str, kind: &str) -> bool {
        let sliced = format!("{kind}Sliced");
        self.of_kind(receptacle).iter().any(|object| {
            object.affordances.iter().any(|a| a == "receptacle")
                && (object.accepts.is_empty()
                    || object.accepts.iter().any(|accepted| accepted == kind || *accepted == sliced))
        })
    }

    /// Whether a receptacle type is known to take a type.
    pub fn surely_accepts(&self, receptacle: &str, kind: &str) -> bool {
        self.accepts(receptacle, kind)
            && self.of_kind(receptacle).iter().any(|object| !object.accepts.is_empty())
    }

    /// Whether the team is unknown, or each of the skills is somebody's.
    pub fn team_has(&self, skills: &[&str]) -> bool {
        let has = |skill: &&str| self.team.iter().any(|robot| robot.skills.iter().any(|s| s == skill));
        self.team.is_empty() || skills.iter().all(has)
    }

    /// Whether the team is unknown, or strong enough, together if need be, to carry something of a type.
    pub fn team_lifts(&self, kind: &str) -> bool {
        let carries = |robot: &&RobotView| robot.skills.iter().any(|skill| skill == "PickupObject");
        let strength: f64 = self.team.iter().filter(carries).map(|robot| robot.capacity_kg).sum();
        self.team.is_empty() || self.of_kind(kind).iter().any(|object| object.mass_kg <= strength)
    }

    /// The words of the types' names, for spelling.
    pub fn spelling(&self) -> &Spelling {
        &self.spelling
    }

    /// Whether a word is one of the types' names.
    pub fn has_word(&self, word: &str) -> bool {
        self.words.contains(word)
    }

    /// Whether things go in or on objects of a type, and it stays where it is.
    pub fn is_furniture(&self, kind: &str) -> bool {
        self.affords(kind, "receptacle") && !self.affords(kind, "pickupable")
    }

    /// What an object lies right in or on.
    pub fn parents(&self, object: &'a ObjectView) -> impl Iterator<Item = &'a ObjectView> + '_ {
        object.parents.iter().filter_map(|parent| self.named(parent))
    }

    /// Whether an object lies, directly or not, in or on an object that satisfies a condition.
    pub fn lies_in(&self, object: &ObjectView, condition: &dyn Fn(&ObjectView) -> bool) -> bool {
        let mut frontier: Vec<&str> = object.parents.iter().map(String::as_str).collect();
        let mut seen = BTreeSet::new();
        while let Some(name) = frontier.pop() {
            if !seen.insert(name) {
                continue;
            }
            if let Some(parent) = self.objects.get(name) {
                if condition(parent) {
                    return true;
                }
                frontier.extend(parent.parents.iter().map(String::as_str));
            }
        }
        false
    }
}

/// Whether an object is in the states now, as far as its flags say.
pub fn is_in_state(object: &ObjectView, states: &Settings) -> bool {
    states.iter().all(|(property, value)| {
        let holds = object.states.iter().any(|state| state == property);
        match value {
            PropertyValue::Flag(flag) => holds == *flag,
            PropertyValue::Word(word) => object.states.iter().any(|state| {
                state == word
                    || state.strip_prefix(property.as_str()).is_some_and(|rest| rest.ends_with(word.as_str()))
            }),
        }
    })
}

/// A name with its number as a number: `Book_10` comes after `Book_2`.
fn natural(name: &str) -> (&str, u64) {
    let digits = name.len() - name.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let (front, number) = name.split_at(name.len() - digits);
    (front, number.parse().unwrap_or(0))
}
