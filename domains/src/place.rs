//! Where movable things start when nobody has measured it: by rule and seed.
//!
//! A thing goes to a place where AI2-THOR and ALFRED say its type is found. Open surfaces are three times as
//! likely as drawers and cupboards; eggs lie in the fridge; appliances, the bin and the toilet start empty; a
//! towel or paper holder takes one thing; the floor is for what fits nowhere else.

use std::collections::BTreeMap;

use crate::kinds::{Kinds, encloses};
use crate::seed::Seed;

/// A receptacle that does not move: its name and its type.
pub type Fixture<'a> = (&'a str, &'a str);

/// Gives each of the things `(name, type)` a place. `wanted` limits the choice to these receptacle types or
/// names; a thing that fits none of them goes unplaced and is missing from the answer.
pub fn place(
    things: &[(String, String, Option<String>)],
    fixtures: &[Fixture<'_>],
    scene: &str,
    seed: u64,
) -> BTreeMap<String, String> {
    let mut places: BTreeMap<String, String> = BTreeMap::new();
    for (name, kind, wanted) in things {
        let chances: Vec<(&str, usize)> = fixtures
            .iter()
            .filter(|(place, of)| match wanted {
                // Most sinks hold things in their basin only.
                Some(wanted) => place == wanted || of == wanted || (wanted == "Sink" && *of == "SinkBasin"),
                None => true,
            })
            .map(|(place, of)| (*place, chance(of, kind, wanted.is_some())))
            .filter(|(place, chance)| *chance > 0 && !taken(place, &places))
            .collect();
        let total: usize = chances.iter().map(|(_, chance)| chance).sum();
        let mut at = Seed::new(seed, &[scene, name]).below(total);
        for (place, chance) in chances {
            if at < chance {
                places.insert(name.clone(), place.to_string());
                break;
            }
            at -= chance;
        }
    }
    places
}

/// How likely a thing of the type is found there, relative to other places.
fn chance(receptacle: &str, kind: &str, asked_for: bool) -> usize {
    let kinds = Kinds::get();
    if !kinds.find(receptacle).is_some_and(|k| k.is("receptacle")) {
        return 0;
    }
    if asked_for {
        return usize::from(kinds.accepts(receptacle, kind));
    }
    match (receptacle, kind) {
        // So that it is chosen only where nothing else is possible.
        ("Floor", _) => usize::from(kinds.accepts("Floor", kind)),
        ("Fridge", "Egg") => 1_000_000,
        ("GarbageCan" | "Toilet" | "Microwave" | "CoffeeMachine" | "Toaster" | "StoveBurner", _) => 0,
        ("Chair" | "Stool", _) => 0,
        _ if !kinds.usual(receptacle, kind) => 0,
        _ if encloses(receptacle) => 1_000,
        _ => 3_000,
    }
}

/// Whether a holder for one thing has it already.
fn taken(place: &str, places: &BTreeMap<String, String>) -> bool {
    let single = ["TowelHolder_", "HandTowelHolder_", "ToiletPaperHanger_"];
    single.iter().any(|s| place.starts_with(s)) && places.values().any(|p| p == place)
}
