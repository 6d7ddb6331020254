//! Two small rooms of our own for the tests.

use lamma_lm::ObjectView;

const FOOD: [&str; 6] = ["Apple", "Bread", "Egg", "Lettuce", "Potato", "Tomato"];
const TABLEWARE: [&str; 8] = ["Plate", "Bowl", "Cup", "Mug", "Fork", "Spoon", "Knife", "ButterKnife"];

fn object(name: &str, affordances: &str, accepts: &[&str], parent: &str) -> ObjectView {
    ObjectView {
        name: name.to_owned(),
        kind: name.rsplit_once('_').map_or(name, |(kind, _)| kind).to_owned(),
        parents: if parent.is_empty() { Vec::new() } else { vec![parent.to_owned()] },
        affordances: affordances.split(' ').filter(|a| !a.is_empty()).map(str::to_owned).collect(),
        accepts: accepts.iter().map(|a| (*a).to_owned()).collect(),
        ..ObjectView::default()
    }
}

/// A kitchen with two apples and one of everything else.
pub fn kitchen() -> Vec<ObjectView> {
    let all: Vec<&str> = FOOD.iter().chain(&TABLEWARE).copied().collect();
    let with = |more: &[&'static str]| -> Vec<&str> { FOOD.iter().chain(more).copied().collect() };
    let dishes = with(&["Plate", "Bowl", "Cup", "Mug"]);
    let cutlery = with(&["Fork", "Spoon", "Knife", "ButterKnife"]);
    vec![
        object("Apple_1", "pickupable sliceable", &[], "CounterTop_1"),
        object("Apple_2", "pickupable sliceable", &[], "DiningTable_1"),
        object("Bread_1", "pickupable sliceable", &[], "CounterTop_1"),
        object("Egg_1", "pickupable sliceable breakable", &[], "Fridge_1"),
        object("Lettuce_1", "pickupable sliceable", &[], "CounterTop_1"),
        object("Potato_1", "pickupable sliceable cookable", &[], "CounterTop_1"),
        object("Tomato_1", "pickupable sliceable", &[], "CounterTop_1"),
        object("Plate_1", "pickupable receptacle breakable dirtyable", &cutlery, "CounterTop_1"),
        object(
            "Bowl_1",
            "pickupable receptacle breakable dirtyable canFillWithLiquid",
            &cutlery,
            "CounterTop_1",
        ),
        object(
            "Cup_1",
            "pickupable receptacle breakable canFillWithLiquid",
            &["Fork", "Spoon"],
            "CounterTop_1",
        ),
        object(
            "Mug_1",
            "pickupable receptacle breakable canFillWithLiquid",
            &["Fork", "Spoon"],
            "CounterTop_1",
        ),
        object("Fork_1", "pickupable", &[], "CounterTop_1"),
        object("Spoon_1", "pickupable", &[], "CounterTop_1"),
        object("Knife_1", "pickupable", &[], "CounterTop_1"),
        object("ButterKnife_1", "pickupable", &[], "CounterTop_1"),
        object("CounterTop_1", "receptacle", &all, ""),
        object("DiningTable_1", "receptacle", &all, ""),
        object("SinkBasin_1", "receptacle", &all, ""),
        object("Fridge_1", "receptacle openable isColdSource", &dishes, ""),
        object("Microwave_1", "receptacle openable toggleable isHeatSource", &dishes, ""),
        object("GarbageCan_1", "receptacle", &FOOD, ""),
        object("Drawer_1", "receptacle openable", &TABLEWARE[4..], ""),
        object("CoffeeMachine_1", "receptacle toggleable isHeatSource", &["Mug"], ""),
        object("StoveBurner_1", "receptacle isHeatSource", &["Pan", "Pot"], ""),
        object("StoveKnob_1", "toggleable", &[], ""),
        object("Faucet_1", "toggleable", &[], ""),
        object("LightSwitch_1", "toggleable", &[], ""),
    ]
}

/// A bedroom with three books, one of them on the bed.
pub fn bedroom() -> Vec<ObjectView> {
    let small = ["Book", "CellPhone", "Watch", "Pillow", "Box"];
    vec![
        object("Book_1", "pickupable openable", &[], "Desk_1"),
        object("Book_2", "pickupable openable", &[], "Bed_1"),
        object("Book_3", "pickupable openable", &[], "Desk_1"),
        object("CellPhone_1", "pickupable toggleable breakable", &[], "Bed_1"),
        object("Pillow_1", "pickupable", &[], "Bed_1"),
        object("Watch_1", "pickupable", &[], "Desk_1"),
        object("Box_1", "pickupable receptacle openable", &["Book", "CellPhone", "Watch"], "Desk_1"),
        object("Bed_1", "receptacle", &small, ""),
        object("Desk_1", "receptacle", &small, ""),
        object("DeskLamp_1", "toggleable", &[], "Desk_1"),
        object("LightSwitch_1", "toggleable", &[], ""),
        object("Blinds_1", "openable", &[], ""),
    ]
}

#[allow(dead_code, reason = "not every test draws them")]
/// Adds things that no sentence of the tests speaks of, drawn by the seed.
pub fn with_distractors(mut objects: Vec<ObjectView>, seed: u64) -> Vec<ObjectView> {
    const KINDS: [(&str, &str); 16] = [
        ("Vase", "pickupable breakable"),
        ("Statue", "pickupable breakable"),
        ("Pencil", "pickupable"),
        ("SprayBottle", "pickupable"),
        ("Laptop", "pickupable openable toggleable breakable"),
        ("Television", "toggleable breakable"),
        ("Kettle", "pickupable openable canFillWithLiquid"),
        ("Pan", "pickupable receptacle dirtyable"),
        ("Cabinet", "receptacle openable"),
        ("Shelf", "receptacle"),
        ("Sofa", "receptacle"),
        ("Candle", "pickupable toggleable"),
        ("SaltShaker", "pickupable"),
        ("Window", "breakable"),
        ("TissueBox", "pickupable"),
        ("Toaster", "receptacle toggleable isHeatSource"),
    ];
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    for number in 1..=8 {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let (kind, affordances) = KINDS[usize::try_from(state % 16).unwrap_or(0)];
        objects.push(object(&format!("{kind}_{number}"), affordances, &[], ""));
    }
    objects
}
