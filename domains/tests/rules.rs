//! The rules of the household world, one test a rule, through the plain interpreter.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{World, able, robot};
use lamma_domains::world::{Rules, setup_with};

/// A kitchen with just these things: everything else would only be in the way.
const KITCHEN: &str = r#"[
    {"type": "Apple", "in": "CounterTop_1"}, {"type": "Potato", "in": "CounterTop_1"},
    {"type": "Egg", "in": "Fridge"}, {"type": "Bread", "in": "CounterTop_1"},
    {"type": "Knife", "in": "CounterTop_2"}, {"type": "ButterKnife", "in": "CounterTop_2"},
    {"type": "Pan", "in": "CounterTop_1"}, {"type": "Plate", "in": "CounterTop_1"},
    {"type": "Mug", "in": "CounterTop_1"}, {"type": "Bowl", "in": "Cabinet_1"},
    {"type": "Spoon", "in": "Bowl_1"}
]"#;

fn kitchen() -> World {
    World::new("FloorPlan6", &able(2), Some(KITCHEN))
}

#[test]
fn going_brings_a_robot_to_the_thing_its_container_and_its_contents() {
    let mut w = kitchen();
    w.run("GoToObject r1 Apple_1");
    w.check(&["(at r1 Apple_1)", "(at r1 CounterTop_1)", "!(at r1 Potato_1)", "(at r1 Floor_1)"]);
    w.run("GoToObject r1 CounterTop_2");
    w.check(&["!(at r1 Apple_1)", "!(at r1 CounterTop_1)", "(at r1 Knife_1)", "(at r1 ButterKnife_1)"]);
    w.refuses("GoToObject r1 Floor_1", "placed");
}

#[test]
fn a_robot_acts_only_on_what_it_stands_at() {
    let mut w = kitchen();
    w.refuses("PickupObject r1 Apple_1 CounterTop_1", "at r1 apple_1");
    w.refuses("OpenObject r1 Fridge_1", "at r1 fridge_1");
    w.refuses("SwitchOff r1 LightSwitch_1", "at r1 lightswitch_1");
}

#[test]
fn a_robot_acts_within_its_skills() {
    let team = lamma_domains::robots::find("robot24").unwrap().clone(); // goes and switches
    let mut w = World::new("FloorPlan6", &[team], Some(KITCHEN));
    w.run("GoToObject robot24 LightSwitch_1\nSwitchOff robot24 LightSwitch_1\nGoToObject robot24 Fridge_1");
    w.refuses("OpenObject robot24 Fridge_1", "has robot24 openobject");
}

#[test]
fn a_hand_holds_one_thing() {
    let mut w = kitchen();
    w.run("GoToObject r1 Apple_1\nPickupObject r1 Apple_1 CounterTop_1\nGoToObject r1 Potato_1");
    w.refuses("PickupObject r1 Potato_1 CounterTop_1", "hand-free r1");
}

#[test]
fn as_many_things_as_hands() {
    let mut w = World::new("FloorPlan6", &[robot("r1", 9.0, 2)], Some(KITCHEN));
    w.run(
        "GoToObject r1 CounterTop_1
         PickupObject r1 Apple_1 CounterTop_1
         PickupObject r1 Potato_1 CounterTop_1",
    );
    w.refuses("PickupObject r1 Bread_1 CounterTop_1", "hand-free r1");
    w.run("PutObject r1 Apple_1 CounterTop_1\nPickupObject r1 Bread_1 CounterTop_1");
    w.refuses("PickupObject r1 Apple_1 CounterTop_1", "hand-free r1");
    w.run("PutObject r1 Bread_1 CounterTop_1\nPutObject r1 Potato_1 CounterTop_1");
    w.check(&["(free-hands r1 two)", "!(free-hands r1 one)", "!(free-hands r1 none)"]);
}

#[test]
fn what_is_held_is_nowhere_and_nobody_stands_at_it() {
    let mut w = kitchen();
    w.run("GoToObject r1 Plate_1\nGoToObject r2 Apple_1\nPickupObject r2 Apple_1 CounterTop_1");
    w.run("GoToObject r2 Plate_1\nPutObject r2 Apple_1 Plate_1\nGoToObject r2 Apple_1");
    w.run("PickupObject r1 Plate_1 CounterTop_1");
    w.check(&["!(in Plate_1 CounterTop_1)", "!(at r1 Plate_1)", "!(at r2 Plate_1)"]);
    w.check(&["(in Apple_1 Plate_1)", "(holding r1 Plate_1)"]);
    w.refuses("GoToObject r2 Plate_1", "placed plate_1");
    w.run("GoToObject r2 Apple_1");
    w.refuses("PickupObject r2 Apple_1 Plate_1", "at r2 plate_1");
    w.run("PutObject r1 Plate_1 CounterTop_1");
    w.refuses("PickupObject r2 Apple_1 Plate_1", "at r2 plate_1");
    w.run("GoToObject r2 Apple_1\nPickupObject r2 Apple_1 Plate_1");
}

#[test]
fn a_closed_container_neither_gives_nor_takes() {
    let mut w = kitchen();
    w.run("GoToObject r1 Egg_1");
    w.check(&["(at r1 Egg_1)", "(at r1 Fridge_1)"]);
    w.refuses("PickupObject r1 Egg_1 Fridge_1", "accessible fridge_1");
    w.run("OpenObject r1 Fridge_1\nPickupObject r1 Egg_1 Fridge_1\nCloseObject r1 Fridge_1");
    w.refuses("PutObject r1 Egg_1 Fridge_1", "accessible fridge_1");
    w.run("OpenObject r1 Fridge_1\nPutObject r1 Egg_1 Fridge_1");
    w.check(&["(in Egg_1 Fridge_1)", "(hand-free r1)", "(at r1 Egg_1)", "(cold Egg_1)"]);
}

#[test]
fn what_lies_in_a_bowl_in_a_closed_cabinet_is_out_of_reach() {
    let mut w = kitchen();
    w.run("GoToObject r1 Spoon_1");
    w.refuses("PickupObject r1 Spoon_1 Bowl_1", "exposed bowl_1");
    w.run("GoToObject r1 Cabinet_1\nOpenObject r1 Cabinet_1\nGoToObject r1 Spoon_1");
    w.run("PickupObject r1 Spoon_1 Bowl_1\nPutObject r1 Spoon_1 Bowl_1");
    w.run("GoToObject r1 Cabinet_1\nCloseObject r1 Cabinet_1");
    w.check(&["!(exposed Spoon_1)", "!(exposed Bowl_1)"]);
    w.run("OpenObject r1 Cabinet_1");
    w.check(&["!(exposed Spoon_1)", "(exposed Bowl_1)"]);
}

#[test]
fn a_box_opens_and_closes_wherever_it_stands() {
    let objects = r#"[{"type": "Box", "in": "CoffeeTable"}, {"type": "Watch", "in": "CoffeeTable"},
                      {"type": "Book", "in": "Box_1"}]"#;
    let mut w = World::new("FloorPlan209", &able(1), Some(objects));
    w.run("GoToObject r1 Watch_1\nPickupObject r1 Watch_1 CoffeeTable_1\nGoToObject r1 Box_1");
    w.refuses("PutObject r1 Watch_1 Box_1", "accessible box_1");
    w.run("OpenObject r1 Box_1\nPutObject r1 Watch_1 Box_1\nPickupObject r1 Book_1 Box_1");
    w.run("CloseObject r1 Box_1");
    w.refuses("PutObject r1 Book_1 Box_1", "accessible box_1");
}

#[test]
fn containers_take_what_ai2_thor_lets_them_take() {
    let mut w = kitchen();
    w.run("GoToObject r1 Knife_1\nPickupObject r1 Knife_1 CounterTop_2\nGoToObject r1 StoveBurner_1");
    w.refuses("PutObject r1 Knife_1 StoveBurner_1", "accepts stoveburner_1 knife_1");
    w.run("GoToObject r1 GarbageCan_1\nPutObject r1 Knife_1 GarbageCan_1");
}

#[test]
fn slicing_needs_a_knife_in_hand_and_cannot_be_undone() {
    let mut w = kitchen();
    w.run("GoToObject r1 Apple_1");
    w.refuses("SliceObject r1 Apple_1", "armed r1");
    for (knife, thing) in [("Knife_1", "Apple_1"), ("ButterKnife_1", "Potato_1")] {
        w.run(&format!("GoToObject r1 {knife}\nPickupObject r1 {knife} CounterTop_2"));
        w.run(&format!("GoToObject r1 {thing}\nSliceObject r1 {thing}"));
        w.refuses(&format!("SliceObject r1 {thing}"), "sliced");
        w.run(&format!("GoToObject r1 CounterTop_2\nPutObject r1 {knife} CounterTop_2"));
        w.check(&["!(armed r1)"]);
    }
    w.run("GoToObject r1 Bread_1");
    w.refuses("SliceObject r1 Bread_1", "armed r1");
}

#[test]
fn a_task_can_do_without_the_knife() {
    let rules = Rules { knife_free: true, ..Rules::default() };
    let mut w = World::with("FloorPlan6", &able(1), Some(KITCHEN), &rules);
    w.run("GoToObject r1 Apple_1\nSliceObject r1 Apple_1");
    w.run("GoToObject r1 Knife_1\nPickupObject r1 Knife_1 CounterTop_2\nPutObject r1 Knife_1 CounterTop_2");
    w.run("GoToObject r1 Bread_1\nSliceObject r1 Bread_1");
}

#[test]
fn a_second_knife_keeps_a_two_handed_robot_armed() {
    let mut w = World::new("FloorPlan6", &[robot("r1", 9.0, 2)], Some(KITCHEN));
    w.run(
        "GoToObject r1 CounterTop_2
         PickupObject r1 Knife_1 CounterTop_2
         PickupObject r1 ButterKnife_1 CounterTop_2
         PutObject r1 Knife_1 CounterTop_2",
    );
    w.check(&["(armed r1)"]);
    w.run("PutObject r1 ButterKnife_1 CounterTop_2");
    w.check(&["!(armed r1)"]);
}

#[test]
fn what_lies_behind_a_door_cannot_be_sliced() {
    let mut w = World::new(
        "FloorPlan6",
        &able(1),
        Some(
            r#"[{"type": "Apple", "in": "Fridge"}, {"type": "Plate", "in": "Fridge"},
                 {"type": "Tomato", "in": "Plate_1"}, {"type": "Knife", "in": "CounterTop_1"}]"#,
        ),
    );
    w.run("GoToObject r1 Knife_1\nPickupObject r1 Knife_1 CounterTop_1\nGoToObject r1 Apple_1");
    w.refuses("SliceObject r1 Apple_1", "exposed apple_1");
    w.run("GoToObject r1 Fridge_1\nOpenObject r1 Fridge_1\nSliceObject r1 Apple_1");
    // Nor what lies in a vessel: it is taken out first.
    w.refuses("SliceObject r1 Tomato_1", "exposed tomato_1");
}

#[test]
fn a_knob_runs_its_burner_and_the_burner_cooks() {
    let mut w = kitchen();
    let burner = w.setup.thing("StoveKnob_1").unwrap().controls[0].clone();
    w.run("GoToObject r1 StoveBurner_1");
    w.refuses("SwitchOn r1 StoveBurner_1", "toggleable stoveburner_1");
    w.run("GoToObject r1 Potato_1\nPickupObject r1 Potato_1 CounterTop_1\nGoToObject r1 Pan_1");
    w.run("PutObject r1 Potato_1 Pan_1\nPickupObject r1 Pan_1 CounterTop_1");
    w.run(&format!("GoToObject r1 {burner}\nPutObject r1 Pan_1 {burner}"));
    w.check(&["!(cooked Potato_1)", "!(hot Pan_1)"]);
    w.run("GoToObject r1 StoveKnob_1\nSwitchOn r1 StoveKnob_1");
    w.check(&[&format!("(toggled {burner})"), "(hot Pan_1)", "(hot Potato_1)", "(cooked Potato_1)"]);
    w.run("SwitchOff r1 StoveKnob_1");
    w.check(&[&format!("!(toggled {burner})"), &format!("!(heating {burner})"), "!(heating Pan_1)"]);
    w.check(&["(hot Potato_1)"]);
}

#[test]
fn what_is_put_on_a_burner_that_is_on_becomes_hot_and_so_does_what_is_put_into_the_pan() {
    let mut w = kitchen();
    let burner = w.setup.thing("StoveKnob_1").unwrap().controls[0].clone();
    w.run("GoToObject r1 StoveKnob_1\nSwitchOn r1 StoveKnob_1\nGoToObject r1 Pan_1");
    w.run("PickupObject r1 Pan_1 CounterTop_1");
    w.run(&format!("GoToObject r1 {burner}\nPutObject r1 Pan_1 {burner}"));
    w.check(&["(hot Pan_1)", "(heating Pan_1)"]);
    w.run("GoToObject r2 Potato_1\nPickupObject r2 Potato_1 CounterTop_1\nGoToObject r2 Pan_1");
    w.run("PutObject r2 Potato_1 Pan_1");
    w.check(&["(cooked Potato_1)", "(hot Potato_1)"]);
    w.run(&format!("GoToObject r1 {burner}\nPickupObject r1 Pan_1 {burner}"));
    w.check(&["!(heating Pan_1)", "(hot Potato_1)"]);
}

#[test]
fn a_microwave_runs_closed_only() {
    let mut w = kitchen();
    w.run("GoToObject r1 Potato_1\nPickupObject r1 Potato_1 CounterTop_1\nGoToObject r1 Plate_1");
    w.run("PutObject r1 Potato_1 Plate_1\nPickupObject r1 Plate_1 CounterTop_1\nGoToObject r1 Microwave_1");
    w.run("OpenObject r1 Microwave_1\nPutObject r1 Plate_1 Microwave_1");
    w.refuses("SwitchOn r1 Microwave_1", "can-switch-on microwave_1");
    w.run("CloseObject r1 Microwave_1\nSwitchOn r1 Microwave_1");
    w.check(&["(cooked Potato_1)", "(hot Potato_1)", "(hot Plate_1)", "!(cooked Plate_1)"]);
    w.refuses("OpenObject r1 Microwave_1", "can-open microwave_1");
    w.run("SwitchOff r1 Microwave_1\nOpenObject r1 Microwave_1\nPickupObject r1 Plate_1 Microwave_1");
}

#[test]
fn a_toaster_takes_sliced_bread_and_cooks_it() {
    let mut w = kitchen();
    w.run("GoToObject r1 Bread_1\nPickupObject r1 Bread_1 CounterTop_1\nGoToObject r1 Toaster_1");
    w.refuses("PutObject r1 Bread_1 Toaster_1", "accepts toaster_1 bread_1");
    w.run("GoToObject r1 CounterTop_2\nPutObject r1 Bread_1 CounterTop_2\nGoToObject r1 CounterTop_2");
    w.run("PickupObject r1 Knife_1 CounterTop_2\nSliceObject r1 Bread_1\nPutObject r1 Knife_1 CounterTop_2");
    w.run("PickupObject r1 Bread_1 CounterTop_2\nGoToObject r1 Toaster_1\nPutObject r1 Bread_1 Toaster_1");
    w.check(&["!(cooked Bread_1)"]);
    w.run("SwitchOn r1 Toaster_1");
    w.check(&["(cooked Bread_1)", "(hot Bread_1)"]);
}

#[test]
fn an_egg_cooks_once_cracked() {
    let mut w = kitchen();
    w.run("GoToObject r1 Fridge_1\nOpenObject r1 Fridge_1\nBreakObject r1 Egg_1\nPickupObject r1 Egg_1 Fridge_1");
    w.run("GoToObject r1 Microwave_1\nOpenObject r1 Microwave_1\nPutObject r1 Egg_1 Microwave_1");
    w.run("CloseObject r1 Microwave_1\nSwitchOn r1 Microwave_1");
    w.check(&["(cooked Egg_1)", "(broken Egg_1)", "(hot Egg_1)", "!(cold Egg_1)"]);
}

#[test]
fn a_coffee_machine_fills_and_heats_a_mug() {
    for on_first in [true, false] {
        let mut w = kitchen();
        w.run("GoToObject r2 CoffeeMachine_1");
        if on_first {
            w.run("SwitchOn r2 CoffeeMachine_1");
        }
        w.run("GoToObject r1 Mug_1\nPickupObject r1 Mug_1 CounterTop_1");
        w.run("GoToObject r1 CoffeeMachine_1\nPutObject r1 Mug_1 CoffeeMachine_1");
        if !on_first {
            w.run("SwitchOn r2 CoffeeMachine_1");
        }
        w.check(&["(filled Mug_1)", "(filled-with Mug_1 coffee)", "(hot Mug_1)"]);
    }
}

#[test]
fn a_fridge_cools_what_is_in_it_and_on_the_plate_in_it() {
    let mut w = kitchen();
    w.run("GoToObject r1 Fridge_1\nOpenObject r1 Fridge_1\nGoToObject r1 Apple_1");
    w.run("PickupObject r1 Apple_1 CounterTop_1\nGoToObject r1 Plate_1\nPutObject r1 Apple_1 Plate_1");
    w.run("PickupObject r1 Plate_1 CounterTop_1\nGoToObject r1 Fridge_1\nPutObject r1 Plate_1 Fridge_1");
    w.check(&["(cold Plate_1)", "(cold Apple_1)", "(cooling Plate_1)"]);
    w.run("GoToObject r2 Potato_1\nPickupObject r2 Potato_1 CounterTop_1\nGoToObject r2 Plate_1");
    w.run("PutObject r2 Potato_1 Plate_1\nPickupObject r1 Plate_1 Fridge_1");
    w.check(&["(cold Potato_1)", "!(cooling Plate_1)"]);
}

#[test]
fn running_water_cleans_and_fills() {
    for on_first in [true, false] {
        let mut w = World::new(
            "FloorPlan6",
            &able(1),
            Some(r#"[{"type": "Bowl", "in": "CounterTop_1", "is": {"isDirty": true}}]"#),
        );
        w.check(&["(dirty Bowl_1)"]);
        if on_first {
            w.run("GoToObject r1 Faucet_1\nSwitchOn r1 Faucet_1");
        }
        w.run("GoToObject r1 Bowl_1\nPickupObject r1 Bowl_1 CounterTop_1\nGoToObject r1 SinkBasin_1");
        w.run("PutObject r1 Bowl_1 SinkBasin_1");
        if !on_first {
            w.run("GoToObject r1 Faucet_1\nSwitchOn r1 Faucet_1");
        }
        w.check(&["!(dirty Bowl_1)", "(filled Bowl_1)", "(filled-with Bowl_1 water)"]);
        w.run("GoToObject r1 Bowl_1\nEmptyObject r1 Bowl_1\nDirtyObject r1 Bowl_1\nCleanObject r1 Bowl_1");
        w.run("FillObject r1 Bowl_1 wine");
        w.check(&["(filled-with Bowl_1 wine)", "!(filled-with Bowl_1 water)", "!(dirty Bowl_1)"]);
        w.refuses("FillObject r1 Bowl_1 water", "filled bowl_1");
    }
}

#[test]
fn breaking_cannot_be_undone_and_pieces_cannot_be_picked_up() {
    let mut w = kitchen();
    w.run("GoToObject r1 Plate_1\nBreakObject r1 Plate_1");
    w.refuses("PickupObject r1 Plate_1 CounterTop_1", "pickupable plate_1");
    w.refuses("BreakObject r1 Plate_1", "broken plate_1");
    w.run("GoToObject r1 Apple_1\nPickupObject r1 Apple_1 CounterTop_1\nGoToObject r1 Plate_1");
    w.refuses("PutObject r1 Apple_1 Plate_1", "accessible plate_1");
    w.refuses("BreakObject r1 Apple_1", "breakable apple_1");
}

#[test]
fn a_broken_television_stays_dark() {
    let mut w = World::new("FloorPlan201", &able(1), None);
    w.run("GoToObject r1 Television_1\nSwitchOn r1 Television_1\nBreakObject r1 Television_1");
    w.check(&["!(toggled Television_1)"]);
    w.refuses("SwitchOn r1 Television_1", "can-switch-on television_1");
}

#[test]
fn dropping_and_throwing_end_on_the_floor() {
    let mut w = kitchen();
    w.run("GoToObject r1 Mug_1\nPickupObject r1 Mug_1 CounterTop_1\nDropHandObject r1 Mug_1");
    w.check(&["(in Mug_1 Floor_1)", "(at r1 Mug_1)", "!(broken Mug_1)", "(hand-free r1)"]);
    w.run("PickupObject r1 Mug_1 Floor_1\nThrowObject r1 Mug_1");
    w.check(&["(in Mug_1 Floor_1)", "!(at r1 Mug_1)", "(broken Mug_1)"]);
    w.run("GoToObject r1 Apple_1\nPickupObject r1 Apple_1 CounterTop_1\nPutObject r1 Apple_1 Floor_1");
    w.check(&["(in Apple_1 Floor_1)"]);
    w.run("PushObject r1 Apple_1");
    w.refuses("PullObject r1 Fridge_1", "pushable fridge_1");
}

#[test]
fn doors_and_switches_go_to_and_fro() {
    let mut w = World::new("FloorPlan303", &able(1), None);
    w.run("GoToObject r1 LightSwitch_1");
    w.refuses("SwitchOn r1 LightSwitch_1", "toggled lightswitch_1");
    w.run("SwitchOff r1 LightSwitch_1\nSwitchOn r1 LightSwitch_1");
    w.run("GoToObject r1 Laptop_1\nOpenObject r1 Laptop_1\nSwitchOn r1 Laptop_1\nCloseObject r1 Laptop_1");
    w.check(&["(toggled Laptop_1)", "!(open Laptop_1)"]);
    w.run("GoToObject r1 Blinds_1\nOpenObject r1 Blinds_1\nCloseObject r1 Blinds_1");
    w.run("GoToObject r1 Book_1");
    w.refuses("CloseObject r1 Book_1", "open book_1");
    w.refuses("SwitchOn r1 Book_1", "toggleable book_1");
}

#[test]
fn a_lost_robot_leaves_what_it_held_on_the_floor() {
    let mut w = kitchen();
    w.run("GoToObject r1 Apple_1\nPickupObject r1 Apple_1 CounterTop_1\nRobotLost r1");
    w.check(&["(in Apple_1 Floor_1)", "!(holding r1 Apple_1)", "!(at r1 CounterTop_1)", "!(hand-free r1)"]);
    w.run("GoToObject r2 Apple_1\nPickupObject r2 Apple_1 Floor_1");
    w.refuses("GoToObject r1 Apple_1", "mobile r1");
}

#[test]
fn soap_and_paper_are_used_up_once() {
    let things = r#"[{"type": "ToiletPaper", "in": "Toilet"}, {"type": "Plunger", "in": "Floor"}]"#;
    let mut w = World::new("FloorPlan414", &able(1), Some(things));
    w.run("GoToObject r1 ToiletPaper_1");
    w.check(&["!(used-up ToiletPaper_1)"]);
    w.run("UseUpObject r1 ToiletPaper_1");
    w.check(&["(used-up ToiletPaper_1)"]);
    w.refuses("UseUpObject r1 ToiletPaper_1", "used-up toiletpaper_1");
    w.run("GoToObject r1 Plunger_1");
    w.refuses("UseUpObject r1 Plunger_1", "consumable plunger_1");
}

#[test]
fn robots_do_not_block_each_other_unless_the_task_says_so() {
    let mut w = kitchen();
    w.run("GoToObject r1 Fridge_1\nGoToObject r2 Fridge_1");
    let rules = Rules { exclusive: vec!["Fridge".to_string()], ..Rules::default() };
    let mut w = World::with("FloorPlan6", &able(2), Some(KITCHEN), &rules);
    w.run("GoToObject r1 Fridge_1");
    w.refuses("GoToObject r2 Fridge_1", "at");
    w.refuses("GoToObject r2 Egg_1", "at"); // which lies in the fridge
    w.run("GoToObject r1 Egg_1\nGoToObject r1 CounterTop_1\nGoToObject r2 Egg_1\nGoToObject r1 CounterTop_1");
    w.run("GoToObject r2 CounterTop_1"); // only the fridge is exclusive
}

#[test]
fn rules_speak_of_furniture_of_the_scene() {
    for (name, wanted) in
        [("Frige", "did you mean `Fridge`"), ("Apple", "no furniture"), ("Floor", "no furniture")]
    {
        let rules = Rules { exclusive: vec![name.to_string()], ..Rules::default() };
        let error = setup_with("FloorPlan6", &able(1), None, 0, &rules).unwrap_err().to_string();
        assert!(error.contains(wanted), "{name}: {error}");
    }
}

#[test]
fn what_happens_without_the_team_follows_the_same_rules() {
    let mut w = kitchen();
    w.run("GoToObject r1 Apple_1\nObjectMoved Apple_1 CounterTop_2");
    w.check(&["(in Apple_1 CounterTop_2)", "!(at r1 Apple_1)", "(exposed Apple_1)"]);
    w.refuses("ObjectMoved Apple_1 Cabinet_1", "accessible cabinet_1");
    w.run("GoToObject r1 Fridge_1\nOpenObject r1 Fridge_1\nDoorClosed Fridge_1");
    w.check(&["!(open Fridge_1)", "!(accessible Fridge_1)", "!(exposed Egg_1)"]);
    w.refuses("DoorClosed Fridge_1", "open fridge_1");
}
