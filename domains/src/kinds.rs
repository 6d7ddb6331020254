//! The 125 object types of AI2-THOR 5.0: affordances, masses, materials, and which receptacle takes what.
//!
//! The facts are in `household/types.json` and `household/placement.json`, which say where they come from.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

/// One object type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// Its affordances by their AI2-THOR names, sorted.
    pub affordances: Vec<String>,
    /// The mass of most of its instances, in kilograms; 0 for what is fixed.
    pub mass_kg: f64,
    /// What it is made of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<String>,
    /// Where the facts come from: `measured` in ten floor plans, or the `documentation` of AI2-THOR.
    pub from: String,
}

impl Kind {
    /// Whether it has the affordance.
    pub fn is(&self, affordance: &str) -> bool {
        self.affordances.iter().any(|a| a == affordance)
    }
}

#[derive(Deserialize)]
struct TypeFile {
    types: BTreeMap<String, Kind>,
}

#[derive(Deserialize)]
struct PlacementFile {
    ai2thor: BTreeMap<String, String>,
    alfred: BTreeMap<String, String>,
    extra: BTreeMap<String, String>,
    cut: BTreeMap<String, String>,
}

/// All types and their compatibility.
#[derive(Debug)]
pub struct Kinds {
    types: BTreeMap<String, Kind>,
    accepts: BTreeMap<String, BTreeSet<String>>,
    accepts_cut: BTreeMap<String, BTreeSet<String>>,
    usual: BTreeMap<String, BTreeSet<String>>,
}

/// Types that stand for another type in a later state: `AppleSliced` is an `Apple`.
const SLICED: [(&str, &str); 6] = [
    ("AppleSliced", "Apple"),
    ("BreadSliced", "Bread"),
    ("LettuceSliced", "Lettuce"),
    ("PotatoSliced", "Potato"),
    ("TomatoSliced", "Tomato"),
    ("EggCracked", "Egg"),
];

/// Containers whose door shuts their contents in: AI2-THOR's "must be open to place objects in", and the safe.
const ENCLOSING: [&str; 7] = ["Box", "Cabinet", "Drawer", "Fridge", "LaundryHamper", "Microwave", "Safe"];

/// Types that AI2-THOR does not call dirtyable but that ALFRED lets agents wash. They are clean unless a task
/// says otherwise.
const WASHABLE: [&str; 17] = [
    "Apple",
    "ButterKnife",
    "DishSponge",
    "Egg",
    "Fork",
    "Kettle",
    "Knife",
    "Ladle",
    "Lettuce",
    "Potato",
    "SoapBar",
    "Spatula",
    "Spoon",
    "Tomato",
    "HandTowel",
    "Towel",
    "ScrubBrush",
];

impl Kinds {
    /// The table, read once.
    pub fn get() -> &'static Kinds {
        static TABLE: OnceLock<Kinds> = OnceLock::new();
        TABLE.get_or_init(|| {
            let types: TypeFile = serde_json::from_str(include_str!("../household/types.json"))
                .expect("the embedded type table is checked by a test");
            let placement: PlacementFile = serde_json::from_str(include_str!("../household/placement.json"))
                .expect("the embedded placement table is checked by a test");
            Kinds::new(types.types, placement)
        })
    }

    fn new(types: BTreeMap<String, Kind>, file: PlacementFile) -> Self {
        let items: BTreeSet<String> = types
            .iter()
            .filter(|(name, kind)| kind.is("pickupable") && SLICED.iter().all(|(cut, _)| cut != name))
            .map(|(name, _)| name.clone())
            .collect();
        let mut table =
            Kinds { types, accepts: BTreeMap::new(), accepts_cut: BTreeMap::new(), usual: BTreeMap::new() };
        let words = |list: &str| -> BTreeSet<String> {
            if list == "*" { items.clone() } else { list.split_whitespace().map(String::from).collect() }
        };
        for (receptacle, list) in file.ai2thor.iter().chain(&file.alfred).chain(&file.extra) {
            table.accepts.entry(receptacle.clone()).or_default().extend(words(list));
        }
        for (receptacle, list) in file.ai2thor.iter().chain(&file.alfred) {
            table.usual.entry(receptacle.clone()).or_default().extend(words(list));
        }
        for (receptacle, list) in &file.cut {
            table.accepts_cut.entry(receptacle.clone()).or_default().extend(words(list));
        }
        for list in table.accepts.values_mut() {
            // A footstool, say, is an item but never a vessel for itself.
            list.retain(|item| items.contains(item));
        }
        table
    }

    /// The type, or none.
    pub fn find(&self, name: &str) -> Option<&Kind> {
        self.types.get(name)
    }

    /// All types in alphabetical order.
    pub fn all(&self) -> impl Iterator<Item = (&str, &Kind)> {
        self.types.iter().map(|(name, kind)| (name.as_str(), kind))
    }

    /// The names of all types.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.types.keys().map(String::as_str)
    }

    /// Whether the receptacle type takes the item type as it is.
    pub fn accepts(&self, receptacle: &str, item: &str) -> bool {
        self.accepts.get(receptacle).is_some_and(|list| list.contains(item))
    }

    /// Whether the receptacle type takes the item type once it is sliced.
    pub fn accepts_cut(&self, receptacle: &str, item: &str) -> bool {
        self.accepts_cut.get(receptacle).is_some_and(|list| list.contains(item))
    }

    /// Whether things of the item type are usually found there (the tables of AI2-THOR and ALFRED alone).
    pub fn usual(&self, receptacle: &str, item: &str) -> bool {
        self.usual.get(receptacle).is_some_and(|list| list.contains(item))
    }

    /// What the receptacle type takes, sliced things included.
    pub fn accepted(&self, receptacle: &str) -> impl Iterator<Item = &str> {
        self.accepts
            .get(receptacle)
            .into_iter()
            .chain(self.accepts_cut.get(receptacle))
            .flatten()
            .map(String::as_str)
    }

    /// The type a name stands for: itself, or for `AppleSliced` its whole `Apple`.
    pub fn whole<'a>(&self, name: &'a str) -> &'a str {
        SLICED.iter().find(|(cut, _)| *cut == name).map_or(name, |(_, whole)| whole)
    }

    /// Whether the name is that of a type in a later state, which no scene starts with.
    pub fn is_cut(&self, name: &str) -> bool {
        SLICED.iter().any(|(cut, _)| *cut == name)
    }
}

/// Whether a door of this type shuts its contents in.
pub fn encloses(kind: &str) -> bool {
    ENCLOSING.contains(&kind)
}

/// Whether agents may wash it although AI2-THOR does not call it dirtyable.
pub fn washable(kind: &str) -> bool {
    WASHABLE.contains(&kind)
}

/// Whether it becomes cookable when it is sliced or cracked.
pub fn cooks_when_cut(kind: &str) -> bool {
    matches!(kind, "Bread" | "Egg")
}

/// Whether one slices with it.
pub fn cutter(kind: &str) -> bool {
    matches!(kind, "Knife" | "ButterKnife")
}

/// Whether one day there is none of it left (AI2-THOR's `canBeUsedUp`).
pub fn consumable(kind: &str) -> bool {
    matches!(kind, "PaperTowelRoll" | "SoapBottle" | "TissueBox" | "ToiletPaper")
}

/// Whether it is in pieces once broken, so that nobody can pick it up. Screens only crack, and an egg is food
/// in either state.
pub fn shatters(kind: &str) -> bool {
    matches!(kind, "Bottle" | "Bowl" | "Cup" | "Mug" | "Plate" | "Statue" | "Vase" | "WineBottle")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_are_complete() {
        let kinds = Kinds::get();
        assert_eq!(kinds.all().count(), 125);
        for (receptacle, items) in kinds.accepts.iter().chain(&kinds.accepts_cut) {
            assert!(kinds.find(receptacle).is_some(), "placement: unknown receptacle {receptacle}");
            for item in items {
                assert!(kinds.find(item).is_some(), "placement: {receptacle} takes unknown {item}");
            }
        }
        for (name, kind) in kinds.all().filter(|(n, k)| k.is("pickupable") && !kinds.is_cut(n)) {
            assert!(kind.mass_kg > 0.0, "{name} can be picked up but has no mass");
            assert!(kinds.accepts("Floor", name), "{name} cannot be put on the floor");
        }
        for name in WASHABLE.iter().chain(&ENCLOSING) {
            assert!(kinds.find(name).is_some(), "unknown type {name}");
        }
    }
}
