//! The world as people and language models are told of it: AI2-THOR's words instead of facts.

use std::collections::BTreeMap;

use lamma_pddl::Name;
use lamma_pddl::ast::GroundAtom;
use serde::{Deserialize, Serialize};

use crate::kinds::Kinds;
use crate::world::{Thing, WorldSetup};

/// An object as it is now.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectView {
    /// `Apple_1`
    pub name: String,
    /// `Apple`
    pub kind: String,
    /// What it lies in or on, and what that lies in, nearest first. Empty while it is held.
    pub parents: Vec<String>,
    /// Affordances by their AI2-THOR names.
    pub affordances: Vec<String>,
    /// Properties that hold now: `isOpen`, …, `temperature:Hot`, `fillLiquid:water`.
    pub states: Vec<String>,
    /// Object types it can hold, if a receptacle.
    pub accepts: Vec<String>,
    /// What it is made of.
    pub materials: Vec<String>,
    /// In kilograms; 0 for what is fixed.
    pub mass_kg: f64,
}

/// Every thing of the world under the given facts.
pub fn views<'a>(setup: &WorldSetup, facts: impl IntoIterator<Item = &'a GroundAtom>) -> Vec<ObjectView> {
    let mut parent: BTreeMap<Name, Name> = BTreeMap::new();
    let mut states: BTreeMap<Name, Vec<String>> = BTreeMap::new();
    for fact in facts {
        match (fact.predicate.as_str(), fact.args.as_slice()) {
            ("in", [x, c]) => drop(parent.insert(x.clone(), c.clone())),
            ("holding", [_, x]) => states.entry(x.clone()).or_default().push("isPickedUp".to_string()),
            ("filled-with", [x, liquid]) => {
                states.entry(x.clone()).or_default().push(format!("fillLiquid:{liquid}"));
            }
            (predicate, [x]) => {
                if let Some(state) = state(predicate) {
                    states.entry(x.clone()).or_default().push(state.to_string());
                }
            }
            _ => {}
        }
    }
    setup.things.iter().map(|thing| view(thing, &parent, &mut states)).collect()
}

fn state(predicate: &str) -> Option<&'static str> {
    Some(match predicate {
        "open" => "isOpen",
        "toggled" => "isToggled",
        "sliced" => "isSliced",
        "broken" => "isBroken",
        "cooked" => "isCooked",
        "dirty" => "isDirty",
        "used-up" => "isUsedUp",
        "filled" => "isFilledWithLiquid",
        "hot" => "temperature:Hot",
        "cold" => "temperature:Cold",
        _ => return None,
    })
}

fn view(
    thing: &Thing,
    parent: &BTreeMap<Name, Name>,
    states: &mut BTreeMap<Name, Vec<String>>,
) -> ObjectView {
    let mut parents = Vec::new();
    let mut at = Name::new(&thing.name);
    while let Some(next) = parent.get(&at).filter(|_| parents.len() < parent.len()) {
        parents.push(next.to_string());
        at = next.clone();
    }
    let mut states = states.remove(&Name::new(&thing.name)).unwrap_or_default();
    states.sort();
    let accepts = if thing.can("receptacle") {
        Kinds::get().accepted(&thing.kind).map(String::from).collect()
    } else {
        Vec::new()
    };
    ObjectView {
        name: thing.name.clone(),
        kind: thing.kind.clone(),
        parents,
        affordances: thing.affordances.clone(),
        states,
        accepts,
        materials: thing.materials.clone(),
        mass_kg: thing.mass_kg,
    }
}
