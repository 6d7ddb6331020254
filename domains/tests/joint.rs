//! Lifting together what is too heavy for one robot: pairs, larger crews, and what happens when one is lost.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{World, robot};
use lamma_domains::robots::Robot;

const KITCHEN: &str = r#"[
    {"type": "Apple", "in": "CounterTop_1"}, {"type": "Mug", "in": "CounterTop_1"},
    {"type": "Pot", "in": "CounterTop_1"}, {"type": "Plate", "in": "CounterTop_1"}
]"#;

/// `capacities[0]` kilograms for r1, and so on; one hand each.
fn team(capacities: &[f64]) -> Vec<Robot> {
    capacities.iter().enumerate().map(|(i, &kg)| robot(&format!("r{}", i + 1), kg, 1)).collect()
}

#[test]
fn too_heavy_is_too_heavy_and_two_lift_together() {
    let team = [robot("r1", 0.4, 1), robot("r2", 0.7, 1), robot("r3", 0.1, 1)];
    let mut w = World::new("FloorPlan6", &team, Some(KITCHEN)); // a mug weighs 1.0 kg
    w.run("GoToObject r1 Mug_1\nGoToObject r2 Mug_1\nGoToObject r3 Mug_1");
    w.refuses("PickupObject r1 Mug_1 CounterTop_1", "can-lift r1 mug_1");
    let lift = w.crew("PickupTogether r1", &["r1", "r2"], "Mug_1 CounterTop_1");
    w.refuses(&lift, "supporting r2 mug_1");
    w.refuses("SupportObject r3 Mug_1", "can-help-lift r3 mug_1");
    w.run("SupportObject r2 Mug_1");
    w.refuses("GoToObject r2 Apple_1", "mobile r2");
    w.run(&lift);
    w.run("GoToObject r1 CoffeeMachine_1");
    w.refuses("GoToObject r2 Apple_1", "mobile r2");
    w.run(&w.crew("PutTogether r1", &["r1", "r2"], "Mug_1 CoffeeMachine_1"));
    w.run("GoToObject r2 Apple_1");
    w.check(&["(in Mug_1 CoffeeMachine_1)", "(hand-free r1)", "(hand-free r2)", "!(supporting r2 Mug_1)"]);
}

#[test]
fn a_lost_helper_or_leader_sets_the_other_free() {
    let team = [robot("r1", 0.6, 1), robot("r2", 0.6, 1)];
    for (lost, left) in [("r1", "r2"), ("r2", "r1")] {
        let mut w = World::new("FloorPlan6", &team, Some(KITCHEN));
        w.run("GoToObject r1 Mug_1\nGoToObject r2 Mug_1\nSupportObject r2 Mug_1");
        w.run(&w.crew("PickupTogether r1", &["r1", "r2"], "Mug_1 CounterTop_1"));
        w.run(&format!("RobotLost {lost}"));
        w.check(&["(in Mug_1 Floor_1)", "(placed Mug_1)", "!(holding r1 Mug_1)", "!(supporting r2 Mug_1)"]);
        w.check(&[
            &format!("(hand-free {left})"),
            &format!("(mobile {left})"),
            &format!("!(hand-free {lost})"),
        ]);
        w.run(&format!("GoToObject {left} Apple_1\nPickupObject {left} Apple_1 CounterTop_1"));
    }
}

fn lifts<S: AsRef<str>>(world: &World, robots: &[S], thing: &str) -> bool {
    let robots: Vec<&str> = robots.iter().map(AsRef::as_ref).collect();
    world.find_crew(&robots).is_some_and(|crew| world.has(&format!("(can-lift-together {crew} {thing})")))
}

#[test]
fn three_lift_what_no_two_can() {
    // A mug weighs 1.0 kg.
    let mut w = World::new("FloorPlan6", &team(&[0.4, 0.35, 0.3, 0.2]), Some(KITCHEN));
    w.run("GoToObject r1 Mug_1\nGoToObject r2 Mug_1\nGoToObject r3 Mug_1\nGoToObject r4 Mug_1");
    assert!(!lifts(&w, &["r1", "r2"], "Mug_1"), "two are not enough");
    assert!(!lifts(&w, &["r1", "r2", "r3", "r4"], "Mug_1"), "three are enough: the fourth would be idle");
    let lift = w.crew("PickupTogether r1", &["r1", "r2", "r3"], "Mug_1 CounterTop_1");
    w.run("SupportObject r2 Mug_1");
    w.refuses(&lift, "supporting r3 mug_1");
    w.run("SupportObject r3 Mug_1");
    w.run(&lift);
    w.check(&["(holding r1 Mug_1)", "(helping r2 r1)", "(helping r3 r1)", "!(helping r4 r1)", "(mobile r4)"]);
    w.refuses("GoToObject r3 Apple_1", "mobile r3");
    w.refuses("WithdrawHand r3 Mug_1", "placed mug_1");
    w.run("GoToObject r1 CoffeeMachine_1");
    w.run(&w.crew("PutTogether r1", &["r1", "r2", "r3"], "Mug_1 CoffeeMachine_1"));
    for r in ["r1", "r2", "r3"] {
        w.check(&[
            &format!("(hand-free {r})"),
            &format!("(mobile {r})"),
            &format!("(at {r} CoffeeMachine_1)"),
        ]);
    }
    w.check(&["!(helping r2 r1)", "!(supporting r3 Mug_1)", "(in Mug_1 CoffeeMachine_1)"]);
}

#[test]
fn a_hand_that_is_offered_can_be_taken_back_and_stands_in_the_way_of_others_until_then() {
    let mut w = World::new("FloorPlan6", &team(&[0.6, 0.6, 0.5, 9.0]), Some(KITCHEN));
    w.run("GoToObject r1 Mug_1\nGoToObject r2 Mug_1\nGoToObject r3 Mug_1\nGoToObject r4 Mug_1");
    w.run("SupportObject r2 Mug_1\nSupportObject r3 Mug_1");
    w.refuses(&w.crew("PickupTogether r1", &["r1", "r2"], "Mug_1 CounterTop_1"), "supporting r3 mug_1");
    w.refuses("PickupObject r4 Mug_1 CounterTop_1", "supporting");
    w.run("WithdrawHand r3 Mug_1\nWithdrawHand r2 Mug_1\nGoToObject r3 Apple_1");
    w.run("PickupObject r4 Mug_1 CounterTop_1");
}

#[test]
fn crews_are_as_few_as_can_lift_the_thing() {
    let w = World::new("FloorPlan6", &team(&[0.3, 0.3, 0.3, 0.3, 0.3, 0.11]), Some(KITCHEN));
    for thing in ["Mug_1", "Plate_1", "Pot_1"] {
        let mass = w.setup.thing(thing).unwrap().mass_kg;
        let capacity = |robot: &String| if robot == "r6" { 0.11 } else { 0.3 };
        let crews: Vec<Vec<String>> = w.crews().into_values().filter(|c| lifts(&w, c, thing)).collect();
        assert!(!crews.is_empty(), "nobody lifts {thing}");
        for crew in crews {
            let together: f64 = crew.iter().map(capacity).sum();
            let weakest = crew.iter().map(capacity).fold(f64::MAX, f64::min);
            assert!(together >= mass && together - weakest < mass, "{crew:?} for {thing}, {mass} kg");
        }
    }
}

#[test]
fn when_a_helper_of_three_is_lost_the_others_are_free() {
    for lost in ["r1", "r2", "r3"] {
        let mut w = World::new("FloorPlan6", &team(&[0.4, 0.4, 0.4]), Some(KITCHEN));
        w.run("GoToObject r1 Mug_1\nGoToObject r2 Mug_1\nGoToObject r3 Mug_1");
        w.run("SupportObject r2 Mug_1\nSupportObject r3 Mug_1");
        w.run(&w.crew("PickupTogether r1", &["r1", "r2", "r3"], "Mug_1 CounterTop_1"));
        w.run(&format!("RobotLost {lost}"));
        w.check(&["(in Mug_1 Floor_1)", "(placed Mug_1)", "(exposed Mug_1)"]);
        for left in ["r1", "r2", "r3"].iter().filter(|r| **r != lost) {
            w.check(&[&format!("(hand-free {left})"), &format!("!(supporting {left} Mug_1)")]);
            w.run(&format!("GoToObject {left} Apple_1"));
        }
    }
}
