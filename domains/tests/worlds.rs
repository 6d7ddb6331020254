//! Worlds of a task's own, and how they are told of.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{World, able, robot, specs};
use lamma_domains::setup;
use lamma_domains::view::views;

#[test]
fn a_tasks_objects_replace_the_movable_ones_and_restate_the_others() {
    let objects = r#"[{"type": "Apple", "count": 3, "in": "Fridge"}, {"type": "Mug", "is": {"isDirty": true}},
        {"type": "LightSwitch", "is": {"isToggled": false}},
        {"type": "StoveKnob", "is": {"isToggled": true}}, {"type": "Pan", "in": "StoveBurner"}]"#;
    let w = World::new("FloorPlan6", &able(1), Some(objects));
    let movable = w.setup.things.iter().filter(|t| t.can("pickupable")).count();
    assert_eq!(movable, 5);
    w.check(&["(in Apple_3 Fridge_1)", "(cold Apple_3)", "!(exposed Apple_3)", "(dirty Mug_1)"]);
    w.check(&["!(toggled LightSwitch_1)", "(toggled StoveKnob_1)", "!(toggled StoveKnob_2)"]);
    let burner = &w.setup.thing("StoveKnob_1").unwrap().controls[0];
    w.check(&[&format!("(toggled {burner})"), &format!("(heating {burner})")]);
    let on = w.has(&format!("(in Pan_1 {burner})"));
    assert_eq!(w.has("(heating Pan_1)"), on, "a pan heats where its burner is on, and only there");
}

#[test]
fn a_seed_gives_the_same_world_each_time_and_another_seed_another() {
    let objects = specs(r#"[{"type": "Apple", "count": 5}, {"type": "Plate", "count": 5}, {"type": "Mug"}]"#);
    let world = |seed| setup("FloorPlan6", &able(2), Some(&objects), seed).unwrap();
    assert_eq!(world(7), world(7));
    assert_ne!(world(7), world(8));
}

#[test]
fn views_speak_ai2_thors_language() {
    let mut w = World::new("FloorPlan6", &[robot("r1", 5.0, 1)], None);
    w.run("GoToObject r1 Plate_1\nPickupObject r1 Plate_1 CounterTop_2\nGoToObject r1 Fridge_1");
    w.run("OpenObject r1 Fridge_1");
    let views = views(&w.setup, &w.state.facts);
    let view = |name: &str| views.iter().find(|v| v.name == name).unwrap();
    assert_eq!(view("Egg_1").parents, ["Fridge_1"]);
    assert_eq!(view("Egg_1").states, ["temperature:Cold"]);
    assert_eq!(
        (&view("Plate_1").parents[..], &view("Plate_1").states[..]),
        (&[][..], &["isPickedUp".into()][..])
    );
    assert_eq!(view("Fridge_1").states, ["isOpen"]);
    assert_eq!(view("LightSwitch_1").states, ["isToggled"]);
    assert!(view("Toaster_1").accepts.contains(&"Bread".to_string()));
    assert!(view("Apple_1").accepts.is_empty() && view("Apple_1").mass_kg == 0.2);
    assert_eq!(views.len(), w.setup.things.len());
}

#[test]
fn a_robot_cannot_be_called_like_a_thing() {
    for name in ["Apple_1", "water", "GoToObject", "two words", ""] {
        let error = setup("FloorPlan6", &[robot(name, 1.0, 1)], None, 0).unwrap_err().to_string();
        assert!(error.contains("name"), "{name}: {error}");
    }
}
