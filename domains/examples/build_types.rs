//! Builds `household/types.json` from a folder of AI2-THOR facts.
//!
//! `cargo run -p lamma-domains --example build_types -- FOLDER` with `object_affordances.json` and
//! `floorplan_objects.json` in it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

/// Where instances of a type differ: what most of them are.
const USUALLY: [(&str, &str, bool); 5] = [
    ("Bowl", "breakable", true),
    ("Cup", "breakable", true),
    ("CoffeeMachine", "breakable", false),
    ("SideTable", "moveable", true),
    ("Sink", "receptacle", false),
];

/// Types that no measured scene has and whose mass is therefore assumed, in kilograms.
const ASSUMED_KG: [(&str, f64); 8] = [
    ("Bottle", 0.8),
    ("TableTopDecor", 0.5),
    ("Safe", 20.0),
    ("Ottoman", 8.0),
    ("Desktop", 7.0),
    ("DogBed", 2.0),
    ("VacuumCleaner", 6.0),
    ("Poster", 0.0),
];

const AFFORDANCES: [&str; 13] = [
    "breakable",
    "canBeUsedUp",
    "canFillWithLiquid",
    "cookable",
    "dirtyable",
    "isColdSource",
    "isHeatSource",
    "moveable",
    "openable",
    "pickupable",
    "receptacle",
    "sliceable",
    "toggleable",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: build_types FOLDER")?;
    let read = |name: &str| -> Result<Value, Box<dyn std::error::Error>> {
        Ok(serde_json::from_str(&std::fs::read_to_string(Path::new(&folder).join(name))?)?)
    };
    let facts = read("object_affordances.json")?;
    let logged = logged_masses(&read("floorplan_objects.json")?);
    let mut lines = Vec::new();
    for (name, fact) in facts["types"].as_object().ok_or("object_affordances.json: no types")? {
        let has = |a: &str| match USUALLY.iter().find(|(t, b, _)| t == name && *b == a) {
            Some((_, _, usually)) => *usually,
            None => fact[a] == Value::Bool(true),
        };
        let affordances: Vec<&str> = AFFORDANCES.into_iter().filter(|a| has(a)).collect();
        let measured = fact["masses_kg"].as_array().and_then(|m| m.last()).and_then(Value::as_f64);
        let assumed = ASSUMED_KG.iter().find(|(t, _)| t == name).map(|(_, kg)| *kg);
        let mass = measured.or(logged.get(name).copied()).or(assumed).unwrap_or(0.0);
        let from = if fact["from"] == "docs" { "documentation" } else { "measured" };
        let mut line = format!(
            "{}:{{\"affordances\":{},\"mass_kg\":{mass:?}",
            Value::from(name.as_str()),
            Value::from(affordances)
        );
        if let Some(materials) = fact["materials"].as_array().filter(|m| !m.is_empty()) {
            write!(line, ",\"materials\":{}", Value::from(materials.clone()))?;
        }
        write!(line, ",\"from\":\"{from}\"}}")?;
        lines.push(line);
    }
    let text = format!(
        "{{\"about\":\"Object types of AI2-THOR 5.0 (facts; Apache-2.0 source). Where instances differ, what most \
         are. Types from the documentation have their mass from run logs or, where no scene has them, assumed.\",\n\
         \"types\":{{\n{}\n}}}}\n",
        lines.join(",\n")
    );
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/household/types.json"), text)?;
    Ok(())
}

fn logged_masses(file: &Value) -> BTreeMap<String, f64> {
    let mut masses = BTreeMap::new();
    for plan in file["floor_plans"].as_object().into_iter().flat_map(|plans| plans.values()) {
        for (name, object) in plan["objects"].as_object().into_iter().flatten() {
            masses.insert(name.clone(), object["mass_kg"].as_f64().unwrap_or(0.0));
        }
    }
    masses
}
