//! The ways of every floor plan: how long it takes from thing to thing where going takes its time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::able;
use lamma_domains::scene;
use lamma_domains::world::{Rules, setup, setup_with};

fn travel() -> Rules {
    Rules { travel: true, ..Rules::default() }
}

#[test]
fn every_thing_that_stays_has_a_place_and_no_way_around_is_shorter() {
    for name in scene::names() {
        let setup = setup_with(&name, &able(1), None, 0, &travel()).unwrap();
        let ways = setup.ways.unwrap();
        for thing in setup.things.iter().filter(|t| !t.can("pickupable")) {
            assert!(ways.place_of.contains_key(&thing.name), "{name}: nobody can stand at {}", thing.name);
        }
        let places = ways.steps.len();
        assert!(ways.middle < places && ways.place_of["Floor_1"] == ways.middle, "{name}");
        for a in 0..places {
            for b in 0..places {
                let way = ways.steps[a][b];
                assert_eq!(way == 0, a == b, "{name}: {a} to {b}");
                assert_eq!(way, ways.steps[b][a], "{name}: {a} to {b} and back");
                for c in 0..places {
                    assert!(ways.steps[a][c] <= way + ways.steps[b][c], "{name}: {a} to {c} over {b}");
                }
            }
        }
    }
}

/// Positions as AI2-THOR has them: the fridge and the first counter of FloorPlan6.
#[test]
fn a_way_is_as_long_as_the_room_makes_it() {
    let setup = setup_with("FloorPlan6", &able(1), None, 0, &travel()).unwrap();
    let ways = setup.ways.as_ref().unwrap();
    let stand = |name: &str| setup.thing(name).unwrap().stand.unwrap();
    let (fridge, sink) = (stand("Fridge_1"), stand("SinkBasin_1"));
    let straight = ((fridge[0] - sink[0]).abs() + (fridge[1] - sink[1]).abs()) / 0.25;
    let way = ways.steps[ways.place_of["Fridge_1"]][ways.place_of["SinkBasin_1"]];
    assert!(straight >= 4.0 && f64::from(way) >= straight, "{way} steps, {straight} in a straight line");
    assert_eq!(ways.place_of["Faucet_1"], ways.place_of["SinkBasin_1"], "a tap is at its basin");
}

#[test]
fn without_the_rule_there_are_no_ways() {
    assert_eq!(setup("FloorPlan6", &able(1), None, 0).unwrap().ways, None);
}
