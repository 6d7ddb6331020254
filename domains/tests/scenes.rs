//! Every scene loads and its start is consistent; so is every state that actions lead to from there.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::{World, able, robot};
use lamma_domains::kinds::Kinds;
use lamma_domains::robots::{Robot, union_domain};
use lamma_domains::scene::{self, Placed};
use lamma_domains::seed::Seed;
use lamma_domains::world::setup;

#[test]
fn the_domain_has_the_types_of_the_table() {
    let table: BTreeSet<String> = Kinds::get().names().map(str::to_lowercase).collect();
    let ours = [
        "robot", "crew", "thing", "liquid", "count", "skill", "fixture", "item", "vessel", "heater", "basin",
    ];
    let domain: BTreeSet<String> = union_domain()
        .types
        .iter()
        .map(|t| t.name.as_str().to_lowercase())
        .filter(|n| !ours.contains(&n.as_str()))
        .collect();
    assert_eq!(domain, table);
    for (name, kind) in Kinds::get().all() {
        let parent = |of: &str| {
            let of = union_domain().types.iter().find(|t| t.name == *of).unwrap();
            of.types[0].as_str().to_string()
        };
        let mut at = parent(name);
        let mut chain = vec![at.clone()];
        while at != "object" {
            at = if at == "thing" { "object".to_string() } else { parent(&at) };
            chain.push(at.clone());
        }
        let item = chain.contains(&"item".to_string());
        assert_eq!(item, kind.is("pickupable"), "{name}: {chain:?}");
        let vessel = chain.contains(&"vessel".to_string());
        assert_eq!(vessel, item && kind.is("receptacle"), "{name}: {chain:?}");
        assert_eq!(chain.contains(&"heater".to_string()), kind.is("isHeatSource"), "{name}: {chain:?}");
    }
}

#[test]
fn every_scene_loads_and_its_start_is_consistent() {
    let names = scene::names();
    assert_eq!(names.len(), 120);
    let mut measured = 0;
    for name in &names {
        let scene = scene::load(name).unwrap();
        assert_eq!(&scene.scene, name);
        measured += usize::from(scene.placed == Placed::Measured);
        let world = World::of(setup(name, &able(2), None, 0).unwrap_or_else(|e| panic!("{name}: {e}")));
        consistent(&world, &able(2), &BTreeSet::new()).unwrap_or_else(|what| panic!("{name}: {what}"));
        for thing in &world.setup.things {
            assert!(Kinds::get().find(&thing.kind).is_some(), "{name}: {} is of no known type", thing.name);
            for other in thing.parent.iter().chain(&thing.controls).chain(&thing.fills) {
                let found = world.setup.thing(other);
                assert!(found.is_some(), "{name}: {} speaks of {other}", thing.name);
            }
        }
        for what in ["Floor", "LightSwitch"] {
            let there = world.setup.things.iter().any(|t| t.kind == what);
            // Four living rooms and bedrooms of AI2-THOR 2.1 have no switch.
            assert!(there || what == "LightSwitch", "{name} has no {what}");
        }
    }
    assert_eq!(measured, 10);
}

#[test]
fn every_burner_has_a_knob_and_every_basin_a_tap() {
    for name in scene::names() {
        let objects = scene::load(&name).unwrap().objects;
        let of = |kinds: &[&str]| -> Vec<String> {
            let wanted = objects.iter().filter(|o| kinds.contains(&o.kind.as_str()));
            wanted.map(|o| o.name.clone()).collect()
        };
        for burner in of(&["StoveBurner"]) {
            let knobs = objects.iter().filter(|o| o.controls.contains(&burner)).count();
            assert!(knobs > 0, "{name}: no knob for {burner}");
        }
        // Two bathrooms of AI2-THOR 2.1 have no tap at all.
        for basin in of(&["SinkBasin", "BathtubBasin"]).into_iter().filter(|_| !of(&["Faucet"]).is_empty()) {
            let taps = objects.iter().filter(|o| o.fills.contains(&basin)).count();
            assert!(taps > 0, "{name}: no tap for {basin}");
        }
        for switch in objects.iter().filter(|o| ["StoveKnob", "Faucet"].contains(&o.kind.as_str())) {
            assert!(
                !switch.controls.is_empty() || !switch.fills.is_empty(),
                "{name}: {} does nothing",
                switch.name
            );
        }
    }
}

#[test]
fn an_unknown_scene_is_an_error_with_the_nearest() {
    let error = scene::load("FloorPlam15").unwrap_err().to_string();
    assert!(error.contains("did you mean `FloorPlan15`?"), "{error}");
    assert!(scene::load("FloorPlan99").is_err());
    assert!(scene::load("FloorPlan+6").is_err());
}

/// What holds in every state that can be reached, said once more and independently of the domain.
fn consistent(world: &World, team: &[Robot], lost: &BTreeSet<String>) -> Result<(), String> {
    let facts = &world.state.facts;
    let mut inside: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut holders: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    for fact in facts {
        let args: Vec<String> = fact.args.iter().map(ToString::to_string).collect();
        match fact.predicate.as_str() {
            "in" => inside.entry(args[0].clone()).or_default().push(args[1].clone()),
            "holding" => {
                *used.entry(args[0].clone()).or_default() += 1;
                holders.entry(args[1].clone()).or_default().push(args[0].clone());
            }
            "supporting" => *used.entry(args[0].clone()).or_default() += 1,
            _ => {}
        }
    }
    let has = |text: String| world.has(&text);
    let ensure = |holds: bool, what: String| if holds { Ok(()) } else { Err(what) };
    for thing in &world.setup.things {
        let x = &thing.name;
        let places = inside.get(x).map_or(0, Vec::len) + holders.get(x).map_or(0, Vec::len);
        let wanted = usize::from(thing.can("pickupable"));
        ensure(
            places == wanted,
            format!("{x} is at {places} places: {:?} {:?}", inside.get(x), holders.get(x)),
        )?;
        let held = holders.contains_key(x);
        let placed = !held && thing.kind != "Floor";
        ensure(has(format!("(placed {x})")) == placed, format!("placed {x} should be {placed}"))?;
        let shut = |c: &String| has(format!("(encloses {c})")) && !has(format!("(open {c})"));
        let open = inside.get(x).is_none_or(|c| has(format!("(fixed {})", c[0])) && !shut(&c[0]));
        ensure(has(format!("(exposed {x})")) == (open && !held), format!("exposed {x} should be {open}"))?;
        let door = !has(format!("(encloses {x})")) || has(format!("(open {x})"));
        let takes = thing.can("receptacle") && door && !has(format!("(broken {x})"));
        ensure(has(format!("(accessible {x})")) == takes, format!("accessible {x} should be {takes}"))?;
        ensure(!(has(format!("(hot {x})")) && has(format!("(cold {x})"))), format!("{x} is hot and cold"))?;
        let filled = ["water", "coffee", "wine"].iter().any(|l| has(format!("(filled-with {x} {l})")));
        ensure(has(format!("(filled {x})")) == filled, format!("filled {x} should be {filled}"))?;
        for device in &thing.controls {
            let on = has(format!("(toggled {x})"));
            ensure(has(format!("(toggled {device})")) == on, format!("{x} and {device} differ"))?;
            ensure(has(format!("(heating {device})")) == on, format!("heating {device} should be {on}"))?;
        }
        for robot in team.iter().filter(|_| held) {
            ensure(
                !has(format!("(at {} {x})", robot.name)),
                format!("{} stands at {x}, which is held", robot.name),
            )?;
        }
    }
    for robot in team.iter().filter(|r| !lost.contains(&r.name)) {
        let r = &robot.name;
        let free = used.get(r).copied().unwrap_or(0) < usize::from(robot.hands);
        ensure(has(format!("(hand-free {r})")) == free, format!("hand-free {r} should be {free}"))?;
        let knife = ["Knife", "ButterKnife"];
        let armed = holders
            .iter()
            .any(|(x, by)| by.contains(r) && knife.iter().any(|k| x.starts_with(&format!("{k}_"))));
        ensure(has(format!("(armed {r})")) == armed, format!("armed {r} should be {armed}"))?;
    }
    Ok(())
}

/// Random acts keep the world consistent. A wrong effect anywhere shows as a fact that contradicts another.
#[test]
fn random_acts_keep_the_world_consistent() {
    let team = [robot("r1", 0.3, 1), robot("r2", 2.0, 2), robot("r3", 0.9, 1)];
    for (scene, seed) in [("FloorPlan6", 1), ("FloorPlan21", 2), ("FloorPlan209", 3), ("FloorPlan425", 4)] {
        let mut world = World::new(scene, &team, None);
        let mut random = Seed::new(seed, &["walk"]);
        let mut lost = BTreeSet::new();
        let mut log = Vec::new();
        let mut done: BTreeMap<String, usize> = BTreeMap::new();
        for step in 0..1500 {
            let act = random_act(&world, &mut random, step > 1300);
            if world.act(&act).is_ok() {
                let name = act.split_whitespace().next().unwrap_or_default().to_string();
                if name == "RobotLost" {
                    lost.extend(act.split_whitespace().nth(1).map(String::from));
                }
                *done.entry(name).or_default() += 1;
                log.push(act);
                if let Err(what) = consistent(&world, &team, &lost) {
                    panic!("{scene}, seed {seed}: {what} after\n{}", log.join("\n"));
                }
            }
        }
        assert!(done.len() >= 12, "{scene}: the walk is too tame: {done:?}");
    }
}

/// An act with a fair chance: the robot mostly acts on what it stands at or holds.
fn random_act(world: &World, random: &mut Seed, late: bool) -> String {
    let actions = &world.setup.domain.actions;
    let action = &actions[random.below(actions.len())];
    let robots: Vec<&str> = world.setup.members.iter().map(|m| m.name.as_str()).collect();
    let robot = robots[random.below(robots.len())];
    if action.name == "RobotLost" && !(late && random.below(20) == 0) {
        return format!("GoToObject {robot} {}", any_thing(world, random));
    }
    let near: Vec<String> = world
        .state
        .facts
        .iter()
        .filter(|f| (f.predicate == "at" || f.predicate == "holding") && f.args[0] == *robot)
        .map(|f| f.args[1].to_string())
        .collect();
    let mut words = vec![action.name.to_string()];
    for (index, param) in action.params.iter().enumerate() {
        words.push(match param.types[0].as_str() {
            "robot" if index == 0 => robot.to_string(),
            "robot" => robots[random.below(robots.len())].to_string(),
            "crew" => match world.crews().len() {
                0 => "none".to_string(),
                crews => format!("crew_{}", 1 + random.below(crews)),
            },
            "liquid" => ["water", "coffee", "wine"][random.below(3)].to_string(),
            _ if action.name == "GoToObject" || near.is_empty() => any_thing(world, random),
            _ => {
                let x = near[random.below(near.len())].clone();
                let held_in = world
                    .state
                    .facts
                    .iter()
                    .find(|f| f.predicate == "in" && f.args[0] == *words[words.len() - 1]);
                match held_in {
                    Some(place) if index + 1 == action.params.len() && index > 1 => place.args[1].to_string(),
                    _ => x,
                }
            }
        });
    }
    words.join(" ")
}

fn any_thing(world: &World, random: &mut Seed) -> String {
    world.setup.things[random.below(world.setup.things.len())].name.clone()
}
