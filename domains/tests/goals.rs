//! Goals of task files: what they mean, what they count, and what is wrong with wrong ones.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{World, able};
use lamma_domains::goal::GoalEntry;
use lamma_domains::{GoalProblemKind, condition};

const KITCHEN: &str = r#"[
    {"type": "Apple", "count": 2, "in": "CounterTop_1"}, {"type": "Lettuce", "in": "CounterTop_1"},
    {"type": "Knife", "in": "CounterTop_2"}, {"type": "Mug", "in": "CounterTop_1"},
    {"type": "Plate", "count": 2, "in": "CounterTop_1"}, {"type": "Egg", "in": "Fridge"}
]"#;

fn entries(json: &str) -> Vec<GoalEntry> {
    serde_json::from_str(json).unwrap_or_else(|e| panic!("{json}: {e}"))
}

fn kitchen() -> World {
    World::new("FloorPlan6", &able(1), Some(KITCHEN))
}

/// goal; what is translated; the texts of its facts
#[test]
fn goals_are_translated() {
    let world = kitchen();
    for (goal, wanted, texts) in [
        (
            r#"[{"object": "Fridge", "contains": ["Egg", "Lettuce"]}]"#,
            "(and (in Egg_1 Fridge_1) (in Lettuce_1 Fridge_1))",
            vec!["Fridge contains Egg", "Fridge contains Lettuce"],
        ),
        (
            r#"[{"object": "LightSwitch", "is": {"isToggled": false}}]"#,
            "(not (toggled LightSwitch_1))",
            vec!["LightSwitch is off"],
        ),
        (
            r#"[{"object": "Fridge", "contains": ["Apple", "Apple"]}]"#,
            "(exists (?apple1 ?apple2 - Apple) (and (in ?apple1 Fridge_1) (in ?apple2 Fridge_1) \
             (not (= ?apple1 ?apple2))))",
            vec!["Fridge contains Apple", "Fridge contains another Apple"],
        ),
        (
            r#"[{"object": "Apple", "all": true, "is": {"isSliced": true}}]"#,
            "(and (sliced Apple_1) (sliced Apple_2))",
            vec!["every Apple is sliced"],
        ),
        (
            r#"[{"object": "Fridge", "contains": [{"object": "Apple", "is": {"isSliced": true}}]}]"#,
            "(exists (?apple1 - Apple) (and (in ?apple1 Fridge_1) (sliced ?apple1)))",
            vec!["Fridge contains Apple", "Apple is sliced"],
        ),
        (
            r#"[{"object": "Fridge", "contains": [{"object": "Apple", "same": "a"}]},
                {"object": "Apple", "same": "a", "is": {"temperature": "RoomTemp"}}]"#,
            "(exists (?apple1 - Apple) (and (in ?apple1 Fridge_1) (not (hot ?apple1)) (not (cold ?apple1))))",
            vec!["Fridge contains Apple", "Apple is at room temperature"],
        ),
        (
            r#"[{"object": "Mug", "is": {"fillLiquid": "coffee", "isPickedUp": false, "isDirty": false}}]"#,
            "(and (filled-with Mug_1 coffee) (not (dirty Mug_1)) (not (exists (?holder - robot) (holding ?holder Mug_1))))",
            vec!["Mug is filled with coffee", "Mug is clean", "Mug is not held"],
        ),
        (
            r#"[{"object": "Apple_2", "is": {"isSliced": true}}]"#,
            "(sliced Apple_2)",
            vec!["Apple_2 is sliced"],
        ),
        (
            r#"[{"object": "AppleSliced", "is": {"isSliced": true}}]"#,
            "(exists (?apple1 - Apple) (sliced ?apple1))",
            vec!["Apple is sliced"],
        ),
        (
            r#"[{"object": "Fridge", "contains": [{"object": "Apple", "all": true}, "Egg"]}]"#,
            "(and (in Apple_1 Fridge_1) (in Apple_2 Fridge_1) (in Egg_1 Fridge_1))",
            vec!["Fridge contains every Apple", "Fridge contains Egg"],
        ),
        (
            r#"[{"object": "Egg", "is": {"isBroken": true}}, {"object": "Mug", "is": {"isPickedUp": true}}]"#,
            "(and (broken Egg_1) (exists (?holder - robot) (holding ?holder Mug_1)))",
            vec!["Egg is broken", "Mug is held"],
        ),
    ] {
        let found = condition(&entries(goal), &world.setup).unwrap_or_else(|e| panic!("{goal}: {e}"));
        let wanted = lamma_pddl::parse_condition(wanted).unwrap_or_else(|r| panic!("{r}"));
        let sorted = |c: &lamma_pddl::ast::Condition| c.to_string();
        let same = |a: &str, b: &str| {
            let words = |t: &str| {
                let mut w: Vec<String> =
                    t.split_whitespace().map(|s| s.trim_matches(['(', ')']).to_lowercase()).collect();
                w.sort();
                w
            };
            words(a) == words(b)
        };
        assert!(
            same(&sorted(&found.condition()), &sorted(&wanted)),
            "{goal}\n{}\n{wanted}",
            found.condition()
        );
        let mut got: Vec<&str> = found.facts().map(|f| f.text.as_str()).collect();
        let mut texts = texts;
        got.sort_unstable();
        texts.sort_unstable();
        assert_eq!(got, texts, "{goal}");
    }
}

#[test]
fn facts_are_counted_and_the_count_is_full_only_when_the_goal_is_reached() {
    let mut world = kitchen();
    let goal = condition(
        &entries(r#"[{"object": "Plate", "contains": ["Apple", "Egg"]}, {"object": "LightSwitch", "is": {"isToggled": false}}]"#),
        &world.setup,
    )
    .unwrap();
    let count = |w: &World| goal.reached(|c| w.holds(c));
    assert_eq!((count(&world).reached, count(&world).total), (0, 3));
    world.run(
        "GoToObject r1 Apple_1\nPickupObject r1 Apple_1 CounterTop_1\nPutObject r1 Apple_1 CounterTop_1",
    );
    world.run("PickupObject r1 Apple_1 CounterTop_1\nGoToObject r1 Plate_1\nPutObject r1 Apple_1 Plate_1");
    assert_eq!(count(&world).reached, 1);
    world.run("GoToObject r1 Fridge_1\nOpenObject r1 Fridge_1\nPickupObject r1 Egg_1 Fridge_1");
    world.run("GoToObject r1 Plate_2\nPutObject r1 Egg_1 Plate_2\nGoToObject r1 LightSwitch_1\nSwitchOff r1 LightSwitch_1");
    // The apple and the egg lie on plates, but not on one plate.
    let split = count(&world);
    assert_eq!((split.reached, split.missing.len()), (2, 1), "{split:?}");
    assert!(!world.holds(&goal.condition()));
    world.run("GoToObject r1 Egg_1\nPickupObject r1 Egg_1 Plate_2\nGoToObject r1 Plate_1\nPutObject r1 Egg_1 Plate_1");
    assert_eq!(count(&world).reached, 3);
    assert!(world.holds(&goal.condition()));
}

#[test]
fn two_of_a_type_are_two_different_objects() {
    let mut world = kitchen();
    let goal = condition(&entries(r#"[{"object": "Plate", "contains": ["Apple", "Apple"]}]"#), &world.setup)
        .unwrap();
    for (apple, reached) in [("Apple_1", 1), ("Apple_2", 2)] {
        world.run(&format!("GoToObject r1 {apple}\nPickupObject r1 {apple} CounterTop_1\nGoToObject r1 Plate_1\nPutObject r1 {apple} Plate_1"));
        assert_eq!(goal.reached(|c| world.holds(c)).reached, reached, "{apple}");
    }
}

#[test]
fn a_sink_that_holds_nothing_itself_means_its_basin() {
    let world = World::new("FloorPlan414", &able(1), None);
    let goal = condition(&entries(r#"[{"object": "Sink", "contains": ["SoapBar"]}]"#), &world.setup).unwrap();
    assert_eq!(goal.condition().to_string().to_lowercase(), "(in soapbar_1 sinkbasin_1)");
}

#[test]
fn what_is_wrong_is_said_with_a_cure() {
    use GoalProblemKind::{Absent, Impossible, Malformed, Unknown};
    let world = kitchen();
    for (goal, kind, wanted) in [
        ("[]", Malformed, "goal: is empty"),
        (r#"[{"object": "Fridge"}]"#, Malformed, "says nothing"),
        (r#"[{"object": "Fridgee", "contains": ["Egg"]}]"#, Unknown, "did you mean `Fridge`"),
        (
            r#"[{"object": "Fridge", "contains": ["Egg", "Tomatto"]}]"#,
            Unknown,
            "goal[0].contains[1]: unknown object type `Tomatto`; did you mean `Tomato`",
        ),
        (r#"[{"object": "Television", "is": {"isToggled": true}}]"#, Absent, "FloorPlan6 has no Television"),
        (r#"[{"object": "Apple_7", "is": {"isSliced": true}}]"#, Absent, "it has Apple_1, Apple_2"),
        (r#"[{"object": "Fridge", "contains": ["Egg", "Egg"]}]"#, Absent, "a second Egg"),
        (r#"[{"object": "Apple", "is": {"isslice": true}}]"#, Unknown, "did you mean `isSliced`"),
        (r#"[{"object": "Apple", "is": {"isSliced": "yes"}}]"#, Unknown, "true or false"),
        (r#"[{"object": "Mug", "is": {"temperature": "Warm"}}]"#, Unknown, "Hot Cold RoomTemp"),
        (r#"[{"object": "Apple", "is": {"isOpen": true}}]"#, Impossible, "a Apple has no `isOpen`"),
        (r#"[{"object": "Knife", "contains": ["Apple"]}]"#, Impossible, "a Knife holds nothing"),
        (r#"[{"object": "Microwave", "contains": ["Knife"]}]"#, Impossible, "does not take a Knife"),
        (
            r#"[{"object": "Apple", "all": true, "same": "a", "is": {"isSliced": true}}]"#,
            Malformed,
            "use one of them",
        ),
        (
            r#"[{"object": "Apple", "same": "a", "is": {"isSliced": true}}, {"object": "Egg", "same": "a", "is": {"isSliced": true}}]"#,
            Malformed,
            "one object has one type",
        ),
    ] {
        let error = condition(&entries(goal), &world.setup).unwrap_err();
        assert_eq!(error.problems[0].kind, kind, "{goal}: {error}");
        assert!(error.to_string().contains(wanted), "{goal}: {error}");
    }
}
