//! Builds `household/scenes/FloorPlan*.json` from a folder of AI2-THOR facts.
//!
//! `cargo run -p lamma-domains --example build_scenes -- FOLDER` with `scenes_v5/`, `floorplan_objects.json`,
//! `fp15_partial_positions_v5.json` and `alfred_layouts_v2.1.json` in it. The files it writes are committed, so
//! that nothing needs the folder.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use lamma_domains::goal::PropertyValue;
use lamma_domains::kinds::{Kinds, encloses};
use lamma_domains::place;
use lamma_domains::scene::{CELL_M, Grid, Placed, Scene, SceneObject};
use lamma_domains::seed::Seed;
use serde_json::Value;

/// The seed behind everything placed by rule.
const SEED: u64 = 2025;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: build_scenes FOLDER")?;
    let folder = Path::new(&folder);
    let read = |name: &str| -> Result<Value, Box<dyn Error>> {
        Ok(serde_json::from_str(&std::fs::read_to_string(folder.join(name))?)?)
    };
    let counts = read("floorplan_objects.json")?;
    let layouts = read("alfred_layouts_v2.1.json")?;
    let fifteen = read("fp15_partial_positions_v5.json")?;
    for base in [0, 200, 300, 400] {
        for number in base + 1..=base + 30 {
            let measured = folder.join(format!("scenes_v5/FloorPlan{number}.json"));
            let layout = &layouts["floor_plans"][number.to_string()];
            let counted = &counts["floor_plans"][number.to_string()]["objects"];
            let mut scene = if measured.exists() {
                measured_scene(number, &serde_json::from_str(&std::fs::read_to_string(measured)?)?)
            } else {
                let known = if number == 15 { &fifteen } else { &Value::Null };
                ruled_scene(number, counted, layout, known)
            };
            walk(&mut scene, layout);
            let path = format!("{}/household/scenes/FloorPlan{number}.json", env!("CARGO_MANIFEST_DIR"));
            std::fs::write(path, text(&scene)?)?;
        }
    }
    Ok(())
}

fn room(number: u32) -> String {
    match number / 100 {
        2 => "living room",
        3 => "bedroom",
        4 => "bathroom",
        _ => "kitchen",
    }
    .to_string()
}

fn text(scene: &Scene) -> Result<String, Box<dyn Error>> {
    let mut out = String::new();
    writeln!(out, "{{\"scene\":{},", serde_json::to_string(&scene.scene)?)?;
    writeln!(out, "\"room\":{},", serde_json::to_string(&scene.room)?)?;
    writeln!(out, "\"placed\":{},", serde_json::to_string(&scene.placed)?)?;
    writeln!(out, "\"about\":{},", serde_json::to_string(&scene.about)?)?;
    let rows: Result<Vec<String>, _> = scene.floor.rows.iter().map(serde_json::to_string).collect();
    let corner = serde_json::to_string(&scene.floor.corner)?;
    writeln!(out, "\"floor\":{{\"corner\":{corner},\"rows\":[\n{}\n]}},\n\"objects\":[", rows?.join(",\n"))?;
    let objects: Result<Vec<String>, _> = scene.objects.iter().map(serde_json::to_string).collect();
    writeln!(out, "{}\n]}}", objects?.join(",\n"))?;
    Ok(out)
}

fn object(name: String, kind: &str) -> SceneObject {
    let is = match kind {
        "LightSwitch" => BTreeMap::from([("isToggled".to_string(), PropertyValue::Flag(true))]),
        _ => BTreeMap::new(),
    };
    SceneObject {
        name,
        kind: kind.to_string(),
        mass_kg: Kinds::get().find(kind).map_or(0.0, |k| k.mass_kg),
        affordances: None,
        at: None,
        parent: None,
        is,
        controls: Vec::new(),
        fills: Vec::new(),
        placed: None,
        stand: None,
    }
}

// ---------------------------------------------------------------- measured

fn measured_scene(number: u32, file: &Value) -> Scene {
    let list = file["objects"].as_array().cloned().unwrap_or_default();
    let names = numbered(&list);
    let mut objects: Vec<SceneObject> = list.iter().map(|o| measured_object(o, &list, &names)).collect();
    connect(&mut objects);
    objects.sort_by_key(|o| order(&o.name));
    Scene {
        scene: format!("FloorPlan{number}"),
        room: room(number),
        placed: Placed::Measured,
        about:
            "Objects, positions, masses, affordances, states, containers and knobs as AI2-THOR 5.0 reports \
                them. By rule: which tap runs into which basin (the nearest), where the metadata names no \
                container (the nearest that accepts), and one container where it names several."
                .to_string(),
        floor: Grid { corner: [0.0, 0.0], rows: Vec::new() },
        objects,
    }
}

fn kind_of(object: &Value) -> &str {
    let id = object["id"].as_str().unwrap_or_default();
    match id.rsplit('|').next() {
        Some("SinkBasin") => "SinkBasin",
        Some("BathtubBasin") => "BathtubBasin",
        _ => object["type"].as_str().unwrap_or_default(),
    }
}

/// AI2-THOR's object ids and our names for them.
fn numbered(list: &[Value]) -> BTreeMap<String, String> {
    let mut count: BTreeMap<&str, u32> = BTreeMap::new();
    list.iter()
        .map(|object| {
            let number = count.entry(kind_of(object)).or_default();
            *number += 1;
            (object["id"].as_str().unwrap_or_default().to_string(), format!("{}_{number}", kind_of(object)))
        })
        .collect()
}

fn order(name: &str) -> (String, u32) {
    let (kind, number) = name.rsplit_once('_').unwrap_or((name, "0"));
    (kind.to_string(), number.parse().unwrap_or(0))
}

fn position(object: &Value) -> Option<[f64; 3]> {
    let at: Vec<f64> = object["pos"].as_array()?.iter().filter_map(Value::as_f64).collect();
    at.try_into().ok()
}

fn measured_object(from: &Value, all: &[Value], names: &BTreeMap<String, String>) -> SceneObject {
    let kind = kind_of(from);
    let mut to = object(names[from["id"].as_str().unwrap_or_default()].clone(), kind);
    to.is.clear();
    to.at = position(from);
    to.mass_kg = from["mass"].as_f64().unwrap_or(0.0);
    let mut affordances: Vec<String> = strings(&from["aff"]);
    affordances.sort();
    if Kinds::get().find(kind).is_some_and(|k| k.affordances != affordances) {
        to.affordances = Some(affordances);
    }
    for (key, value) in from["state"].as_object().into_iter().flatten() {
        match value {
            Value::Bool(flag) => drop(to.is.insert(key.clone(), PropertyValue::Flag(*flag))),
            Value::String(word) if kind != "Floor" => {
                drop(to.is.insert(key.clone(), PropertyValue::Word(word.clone())));
            }
            _ => {}
        }
    }
    to.controls = strings(&from["controls"]).iter().filter_map(|id| names.get(id).cloned()).collect();
    let item = from["aff"].as_array().is_some_and(|a| a.iter().any(|a| a == "pickupable"));
    let parents: Vec<String> =
        strings(&from["parents"]).iter().filter_map(|id| names.get(id).cloned()).collect();
    let plain = |p: &&String| !p.starts_with("Floor_") && !p.starts_with("CounterTop_");
    to.parent = parents.iter().find(plain).or(parents.first()).cloned();
    if !item {
        let vessel = |p: &String| ["Plate", "Cup", "Bowl", "Chair"].contains(&order(p).0.as_str());
        to.parent = to.parent.filter(|p| !vessel(p) && order(p).0 != "Floor");
    } else if to.parent.is_none() {
        to.parent = nearest_receptacle(from, all, names, |of| Kinds::get().accepts(of, kind));
        to.placed = Some(Placed::Rule);
    }
    to
}

fn strings(list: &Value) -> Vec<String> {
    list.as_array().into_iter().flatten().filter_map(|s| s.as_str().map(String::from)).collect()
}

fn nearest_receptacle(
    from: &Value,
    all: &[Value],
    names: &BTreeMap<String, String>,
    fits: impl Fn(&str) -> bool,
) -> Option<String> {
    let here = position(from)?;
    all.iter()
        .filter(|o| {
            let kind = kind_of(o);
            kind != "Floor" && !encloses(kind) && fits(kind) && o["mass"].as_f64() == Some(0.0)
        })
        .filter_map(|o| Some((distance(here, position(o)?), names.get(o["id"].as_str()?)?.clone())))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| name)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

// ---------------------------------------------------------------- by rule

fn ruled_scene(number: u32, counted: &Value, layout: &Value, known: &Value) -> Scene {
    let scene = format!("FloorPlan{number}");
    let mut stands = standing(layout);
    let mut objects = Vec::new();
    for (kind, (count, mass)) in census(counted, layout, &stands) {
        let mut places = stands.remove(&kind).unwrap_or_default().into_iter();
        for index in 1..=count {
            let mut new = object(format!("{kind}_{index}"), &kind);
            new.mass_kg = mass.unwrap_or(new.mass_kg);
            new.at = places.next();
            objects.push(new);
        }
    }
    for (kind, at) in known["objects"].as_object().into_iter().flatten() {
        let at: Vec<f64> = at.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
        if let Some(object) = objects.iter_mut().find(|o| o.name == format!("{kind}_1")) {
            object.at = at.try_into().ok();
            object.placed = Some(Placed::Measured);
        }
    }
    connect(&mut objects);
    put_in_place(&mut objects, &scene, known);
    objects.sort_by_key(|o| order(&o.name));
    let what = if counted.is_null() {
        "By AI2-THOR 2.1 as ALFRED used it: object types and the number and positions of receptacles. By rule: \
         one instance of every other type (four burners and knobs)"
    } else {
        "As AI2-THOR 5.0 reports them: object types, counts and masses. By AI2-THOR 2.1: positions of receptacles"
    };
    let some = if known.is_null() { "" } else { " (objects marked measured excepted)" };
    Scene {
        scene,
        room: room(number),
        placed: Placed::Rule,
        about: format!(
            "{what}. By rule and seed {SEED}: what movable things lie in{some}, knobs and taps. Nothing is known \
             of the state at the start, so it is the usual one: lights on, doors closed, things clean and whole."
        ),
        floor: Grid { corner: [0.0, 0.0], rows: Vec::new() },
        objects,
    }
}

/// Positions of receptacles by type, in the order of their ids.
fn standing(layout: &Value) -> BTreeMap<String, Vec<[f64; 3]>> {
    let mut places: BTreeMap<String, Vec<[f64; 3]>> = BTreeMap::new();
    for id in layout["receptacle_standing_pose"].as_object().into_iter().flat_map(|poses| poses.keys()) {
        let parts: Vec<&str> = id.split('|').collect();
        let at: Vec<f64> = parts.iter().skip(1).take(3).filter_map(|n| n.parse().ok()).collect();
        let kind = parts.get(4).copied().unwrap_or(parts[0]);
        if let Ok(at) = at.try_into() {
            places.entry(kind.to_string()).or_default().push(at);
        }
    }
    places
}

/// How many of each type, and their mass where it is known for the scene.
fn census(
    counted: &Value,
    layout: &Value,
    stands: &BTreeMap<String, Vec<[f64; 3]>>,
) -> BTreeMap<String, (u64, Option<f64>)> {
    if let Some(counted) = counted.as_object() {
        let entry = |o: &Value| (o["count"].as_u64().unwrap_or(1), o["mass_kg"].as_f64());
        return counted.iter().map(|(kind, o)| (kind.clone(), entry(o))).collect();
    }
    let mut types: Vec<String> = strings(&layout["object_types"]);
    types.push("Floor".to_string());
    let mut census = BTreeMap::new();
    for kind in types {
        let kind = match kind.as_str() {
            "Glassbottle" => "Bottle",
            "Lamp" => "DeskLamp",
            other => other,
        };
        if Kinds::get().find(kind).is_none() {
            continue;
        }
        let count = match kind {
            "StoveBurner" | "StoveKnob" => 4,
            _ => stands.get(kind).map_or(1, |places| places.len().max(1) as u64),
        };
        census.insert(kind.to_string(), (count, None));
    }
    census
}

fn put_in_place(objects: &mut [SceneObject], scene: &str, known: &Value) {
    let kinds = Kinds::get();
    let movable = |kind: &str| kinds.find(kind).is_some_and(|k| k.is("pickupable"));
    let things: Vec<(String, String, Option<String>)> = objects
        .iter()
        .filter(|o| movable(&o.kind))
        .map(|o| {
            let sure = known["inferred_parent"][&o.kind].as_str().filter(|_| o.name.ends_with("_1"));
            let sure = sure.map(|p| if p.starts_with("CounterTop") { "CounterTop_2" } else { p });
            (o.name.clone(), o.kind.clone(), sure.map(String::from))
        })
        .collect();
    let fixtures: Vec<(String, String)> =
        objects.iter().filter(|o| !movable(&o.kind)).map(|o| (o.name.clone(), o.kind.clone())).collect();
    let fixtures: Vec<(&str, &str)> = fixtures.iter().map(|(n, k)| (n.as_str(), k.as_str())).collect();
    let places = place::place(&things, &fixtures, scene, SEED);
    for object in objects.iter_mut().filter(|o| movable(&o.kind)) {
        object.parent = places.get(&object.name).cloned();
        if object.parent.as_ref().is_some_and(|p| p.starts_with("Fridge_")) {
            object.is.insert("temperature".to_string(), PropertyValue::Word("Cold".to_string()));
        }
    }
}

// ---------------------------------------------------------------- both

/// Which tap runs into which basin and, where it is not known, which knob controls which burner.
fn connect(objects: &mut [SceneObject]) {
    let of = |kinds: &[&str], list: &[SceneObject]| -> Vec<(String, Option<[f64; 3]>)> {
        let mut found: Vec<_> = list
            .iter()
            .filter(|o| kinds.contains(&o.kind.as_str()))
            .map(|o| (o.name.clone(), o.at))
            .collect();
        found.sort_by_key(|(name, _)| (kinds.iter().position(|k| name.starts_with(k)), order(name)));
        found
    };
    let basins = of(&["SinkBasin", "BathtubBasin"], objects);
    let taps = of(&["Faucet"], objects);
    let heads = of(&["ShowerHead"], objects);
    let tubs = of(&["BathtubBasin"], objects);
    let burners = of(&["StoveBurner"], objects);
    let knobs = of(&["StoveKnob"], objects);
    let known = objects.iter().any(|o| !o.controls.is_empty());
    let mut link = |from: &str, to: &str, knob: bool| {
        if let Some(object) = objects.iter_mut().find(|o| o.name == from) {
            let list = if knob { &mut object.controls } else { &mut object.fills };
            if !list.iter().any(|l| l == to) {
                list.push(to.to_string());
            }
        }
    };
    for (index, (tap, at)) in taps.iter().enumerate() {
        if let Some(basin) = near(*at, &basins, index) {
            link(tap, &basin, false);
        }
    }
    for (index, (basin, at)) in basins.iter().enumerate() {
        if let Some(tap) = near(*at, &taps, index) {
            link(&tap, basin, false);
        }
    }
    for (head, at) in &heads {
        let close = |(_, tub): &&(String, Option<[f64; 3]>)| match (at, tub) {
            (Some(a), Some(b)) => distance(*a, *b) < 2.0,
            _ => true,
        };
        if let Some((tub, _)) = tubs.iter().find(close) {
            link(head, tub, false);
        }
    }
    if !known {
        for ((knob, _), (burner, _)) in knobs.iter().zip(&burners) {
            link(knob, burner, true);
        }
    }
}

/// The nearest of the list; where a position is missing, the one with the same number.
fn near(at: Option<[f64; 3]>, list: &[(String, Option<[f64; 3]>)], index: usize) -> Option<String> {
    let placed: Option<Vec<(f64, &String)>> =
        list.iter().map(|(name, there)| Some((distance(at?, (*there)?), name))).collect();
    match placed {
        Some(placed) => placed.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, n)| n.clone()),
        None => list.get(index).or(list.last()).map(|(name, _)| name.clone()),
    }
}

// ---------------------------------------------------------------- walking

/// A cell of the floor, in cells from the origin.
type Cell = (i64, i64);

/// The floor and where one stands at what does not move.
fn walk(scene: &mut Scene, layout: &Value) {
    let cells = cells(layout);
    scene.floor = grid(&cells);
    let poses = poses(layout);
    let fixed = |o: &SceneObject| !Kinds::get().find(&o.kind).is_some_and(|k| k.is("pickupable"));
    let serves = |o: &SceneObject| !o.fills.is_empty() || !o.controls.is_empty();
    let walls: Vec<Cell> = cells.iter().copied().filter(|c| is_edge(*c, &cells)).collect();
    let name = &scene.scene;
    let alone = |o: &SceneObject| match o.at {
        _ if o.kind == "Floor" => closest(middle(&cells), &cells),
        Some(at) => closest(posed(&o.kind, at, &poses).unwrap_or([at[0], at[2]]), &cells),
        None => metres(walls[Seed::new(SEED, &[name, &o.name, "stand"]).below(walls.len())]),
    };
    for object in scene.objects.iter_mut().filter(|o| fixed(o) && !serves(o)) {
        object.stand = Some(alone(object));
    }
    // A tap is where its basin is, a knob where its burner is.
    let known: BTreeMap<String, [f64; 2]> =
        scene.objects.iter().filter_map(|o| Some((o.name.clone(), o.stand?))).collect();
    for object in scene.objects.iter_mut().filter(|o| fixed(o) && serves(o)) {
        let served = object.fills.iter().chain(&object.controls).find_map(|name| known.get(name).copied());
        object.stand = served.or_else(|| Some(alone(object)));
    }
    scene.about.push_str(
        " For walking: the floor's cells and where one stands at a receptacle by AI2-THOR 2.1, at a tap or \
         knob as at what it serves, at other things the cell nearest to them, or where they are is not known a cell at \
         the edge by the seed.",
    );
}

fn metres(cell: Cell) -> [f64; 2] {
    [cell.0 as f64 * CELL_M, cell.1 as f64 * CELL_M]
}

fn cells(layout: &Value) -> Vec<Cell> {
    let point = |p: &Value| Some((p[0].as_f64()? / CELL_M, p[1].as_f64()? / CELL_M));
    let points = layout["reachable_xz"].as_array().into_iter().flatten().filter_map(point);
    let mut cells: Vec<Cell> = points.map(|(x, z)| (x.round() as i64, z.round() as i64)).collect();
    cells.sort_unstable();
    cells
}

fn grid(cells: &[Cell]) -> Grid {
    let span = |of: fn(&Cell) -> i64| {
        let all = || cells.iter().map(of);
        (all().min().unwrap_or(0), all().max().unwrap_or(0))
    };
    let ((x0, x1), (z0, z1)) = (span(|c| c.0), span(|c| c.1));
    let letter = |x, z| if cells.binary_search(&(x, z)).is_ok() { '.' } else { '#' };
    Grid {
        corner: metres((x0, z0)),
        rows: (z0..=z1).map(|z| (x0..=x1).map(|x| letter(x, z)).collect()).collect(),
    }
}

/// The standing poses of receptacles: type, position, where one stands.
fn poses(layout: &Value) -> Vec<(String, [f64; 3], [f64; 2])> {
    let pose = |(id, pose): (&String, &Value)| {
        let parts: Vec<&str> = id.split('|').collect();
        let at: Vec<f64> = parts.iter().skip(1).take(3).filter_map(|n| n.parse().ok()).collect();
        let kind = parts.get(4).copied().unwrap_or(parts[0]).to_string();
        Some((kind, at.try_into().ok()?, [pose[0].as_f64()?, pose[1].as_f64()?]))
    };
    layout["receptacle_standing_pose"].as_object().into_iter().flatten().filter_map(pose).collect()
}

/// The pose of the receptacle of that type nearest to the position, if it can be the same one.
fn posed(kind: &str, at: [f64; 3], poses: &[(String, [f64; 3], [f64; 2])]) -> Option<[f64; 2]> {
    let same =
        poses.iter().filter(|(of, ..)| of == kind).map(|(_, there, stand)| (distance(at, *there), *stand));
    same.filter(|(apart, _)| *apart < 0.5).min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, stand)| stand)
}

fn middle(cells: &[Cell]) -> [f64; 2] {
    let n = cells.len().max(1) as f64;
    let mean = |of: fn(&Cell) -> i64| cells.iter().map(of).sum::<i64>() as f64 * CELL_M / n;
    [mean(|c| c.0), mean(|c| c.1)]
}

fn closest(at: [f64; 2], cells: &[Cell]) -> [f64; 2] {
    let apart = |cell: Cell| {
        let there = metres(cell);
        (there[0] - at[0]).powi(2) + (there[1] - at[1]).powi(2)
    };
    cells
        .iter()
        .map(|c| (apart(*c), metres(*c)))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map_or(at, |(_, m)| m)
}

fn is_edge(cell: Cell, cells: &[Cell]) -> bool {
    [(1, 0), (-1, 0), (0, 1), (0, -1)]
        .iter()
        .any(|(dx, dz)| cells.binary_search(&(cell.0 + dx, cell.1 + dz)).is_err())
}
