//! Nothing is ever brought into the opposite of the state that was asked for, however it was asked: a situation may
//! answer "shower", but not "stop the shower". What is not understood may be asked about.

use std::collections::BTreeSet;
use std::time::Duration;

use lamma_domains::goal::PropertyValue;
use lamma_lm::{Answer, ObjectView, Offline, Request};

const SCENES: [&str; 4] = ["FloorPlan6", "FloorPlan201", "FloorPlan301", "FloorPlan401"];

const SWITCHED: [&str; 20] = [
    "the tv",
    "the television",
    "the shower",
    "the shower head",
    "the bath",
    "the tap",
    "the faucet",
    "the water",
    "the stove",
    "the burner",
    "the toaster",
    "the coffee machine",
    "the microwave",
    "the laptop",
    "the phone",
    "the candle",
    "the lamp",
    "the desk lamp",
    "the light",
    "the lights",
];

const OFF: [&str; 16] = [
    "stop X",
    "X off",
    "put the towel away, X off",
    "have X off",
    "get X off",
    "leave X off",
    "keep X off",
    "let X be off",
    "make X stop",
    "X should stop",
    "X must not run",
    "turn X off, and wash the cloth",
    "X should be off, the cloth clean",
    "with X off, wash the cloth",
    "wash the cloth, with X not running",
    "turn on nothing and leave X off",
];

const ON: [&str; 12] = [
    "start X",
    "X on",
    "put the towel away, X on",
    "have X on",
    "get X on",
    "leave X on",
    "keep X on",
    "X should run",
    "turn X on, and wash the cloth",
    "X should be on, the cloth clean",
    "with X on, wash the cloth",
    "turn X to on",
];

const OPENED: [&str; 7] =
    ["the fridge", "the drawer", "the cabinet", "the microwave", "the laptop", "the blinds", "the book"];

const OPEN: [&str; 6] =
    ["open X", "X open", "leave X open", "keep X open", "X should be open", "do not close X"];
const CLOSE: [&str; 6] =
    ["close X", "X closed", "leave X shut", "keep X closed", "X should be shut", "do not leave X open"];

/// What of the goal of a sentence has a property with a value.
fn brought_about(
    offline: &Offline,
    text: &str,
    objects: &[ObjectView],
    state: (&str, bool),
) -> BTreeSet<String> {
    let answer = offline.read(&Request {
        instruction: text.to_owned(),
        objects: objects.to_vec(),
        robots: Vec::new(),
        assume: false,
        deadline: Duration::from_secs(5),
    });
    let Answer::Understood(decomposition) = answer else { return BTreeSet::new() };
    let (property, value) = state;
    let goals = decomposition.subtasks.into_iter().filter(|subtask| subtask.lasting).flat_map(|s| s.goal);
    goals
        .filter(|entry| entry.is.get(property) == Some(&PropertyValue::Flag(value)))
        .map(|entry| entry.object)
        .collect()
}

fn never_the_opposite(things: &[&str], said: &[&str], opposite: (&str, bool)) {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let mut wrong = String::new();
    for scene in SCENES {
        let world = lamma_domains::world::setup(scene, &[], None, 0).expect("the scene is built in");
        let objects = lamma_domains::view::views(&world, world.facts());
        for thing in things {
            for said in said {
                let text = said.replace('X', thing);
                let of = brought_about(&offline, &text, &objects, opposite);
                if !of.is_empty() {
                    wrong.push_str(&format!("{scene}: \"{text}\" makes {opposite:?} of {of:?}\n"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn what_should_be_off_is_not_switched_on() {
    never_the_opposite(&SWITCHED, &OFF, ("isToggled", true));
}

#[test]
fn what_should_be_on_is_not_switched_off() {
    never_the_opposite(&SWITCHED, &ON, ("isToggled", false));
}

#[test]
fn what_should_be_closed_is_not_opened_and_the_other_way_round() {
    never_the_opposite(&OPENED, &CLOSE, ("isOpen", true));
    never_the_opposite(&OPENED, &OPEN, ("isOpen", false));
}
