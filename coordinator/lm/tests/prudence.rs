//! The embedded default: prohibitions, counts, identity, choices and questions — never more than was said,
//! and never less without saying so.

mod scenes;

use std::time::Duration;

use lamma_lm::{Answer, Clarification, Decomposition, ObjectView, Offline, Request};
use scenes::{bedroom, kitchen};
use serde_json::{Value, json};

fn read(instruction: &str, objects: Vec<ObjectView>) -> Answer {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let instruction = instruction.to_owned();
    offline.read(&Request {
        instruction,
        objects,
        robots: Vec::new(),
        assume: false,
        deadline: Duration::from_secs(5),
    })
}

#[track_caller]
fn understood(instruction: &str, objects: Vec<ObjectView>) -> Decomposition {
    match read(instruction, objects) {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(clarification) => panic!("{instruction:?} is not understood: {clarification:?}"),
    }
}

#[track_caller]
fn asked(instruction: &str, objects: Vec<ObjectView>) -> Clarification {
    match read(instruction, objects) {
        Answer::Clarify(clarification) => clarification,
        Answer::Understood(decomposition) => panic!("{instruction:?} is taken as {decomposition:?}"),
    }
}

/// All goals in order, those that do not last included.
#[track_caller]
fn check(instruction: &str, objects: Vec<ObjectView>, expected: Value) {
    let decomposition = understood(instruction, objects);
    let goals: Vec<_> = decomposition.subtasks.iter().flat_map(|subtask| &subtask.goal).collect();
    assert_eq!(serde_json::to_value(goals).expect("goals are plain data"), expected, "{instruction}");
}

/// A kitchen with three cabinets, of which the first is open, and two burners with their knobs.
fn large_kitchen() -> Vec<ObjectView> {
    let mut objects = kitchen();
    let more = [
        ("Cabinet_1", "Cabinet", "receptacle openable", "isOpen"),
        ("Cabinet_2", "Cabinet", "receptacle openable", ""),
        ("Cabinet_3", "Cabinet", "receptacle openable", ""),
        ("StoveBurner_2", "StoveBurner", "receptacle isHeatSource", ""),
        ("StoveKnob_2", "StoveKnob", "toggleable", ""),
    ];
    for (name, kind, affordances, state) in more {
        objects.push(ObjectView {
            name: name.to_owned(),
            kind: kind.to_owned(),
            affordances: affordances.split(' ').map(str::to_owned).collect(),
            states: state.split(' ').filter(|s| !s.is_empty()).map(str::to_owned).collect(),
            ..ObjectView::default()
        });
    }
    objects
}

#[test]
fn a_prohibition_becomes_an_end_state() {
    check(
        "Place the tomato in the fridge and do not shut the fridge",
        kitchen(),
        json!([{"object": "Fridge", "contains": ["Tomato"]}, {"object": "Fridge", "is": {"isOpen": true}}]),
    );
    check(
        "slice the potato without opening the drawer",
        kitchen(),
        json!([{"object": "Potato", "is": {"isSliced": true}}, {"object": "Drawer", "is": {"isOpen": false}}]),
    );
    check(
        "never switch on the microwave",
        kitchen(),
        json!([{"object": "Microwave", "is": {"isToggled": false}}]),
    );
}

#[test]
fn a_prohibition_that_the_goal_breaks_is_asked_about() {
    for (instruction, reason) in [
        ("put the lettuce in the fridge but never open the fridge", "closed Fridge"),
        ("don't open the fridge and place the egg on the plate", "lies in the closed Fridge"),
        ("cool the tomato without opening the fridge", "cannot get cold"),
        ("turn on the faucet and do not turn on the faucet", "also asked for"),
    ] {
        let problems = asked(instruction, kitchen()).not_understood.join("; ");
        assert!(problems.contains(reason), "{instruction:?}: {problems}");
    }
}

#[test]
fn so_many_means_so_many_different_ones() {
    check(
        "open two cabinets",
        large_kitchen(),
        json!([{"object": "Cabinet_2", "is": {"isOpen": true}}, {"object": "Cabinet_3", "is": {"isOpen": true}}]),
    );
    check(
        "open a cabinet and open another cabinet",
        large_kitchen(),
        json!([{"object": "Cabinet_2", "is": {"isOpen": true}}, {"object": "Cabinet_3", "is": {"isOpen": true}}]),
    );
    check(
        "make sure no cabinet is open",
        large_kitchen(),
        json!([{"object": "Cabinet", "all": true, "is": {"isOpen": false}}]),
    );
    check(
        "light both stove burners",
        large_kitchen(),
        json!([
            {"object": "StoveKnob_1", "is": {"isToggled": true}},
            {"object": "StoveKnob_2", "is": {"isToggled": true}}
        ]),
    );
}

#[test]
fn what_was_opened_is_what_is_closed() {
    check(
        "Open a cabinet. Place the cup inside. Shut it.",
        large_kitchen(),
        json!([
            {"object": "Cabinet_2", "is": {"isOpen": true}},
            {"object": "Cabinet_2", "contains": ["Cup"]},
            {"object": "Cabinet_2", "is": {"isOpen": false}}
        ]),
    );
    check(
        "switch on a burner, then switch it off",
        large_kitchen(),
        json!([
            {"object": "StoveKnob_1", "is": {"isToggled": true}},
            {"object": "StoveKnob_1", "is": {"isToggled": false}}
        ]),
    );
    check(
        "First open the microwave, second place the egg in there, third shut it, lastly run it",
        kitchen(),
        json!([
            {"object": "Microwave", "is": {"isOpen": true}},
            {"object": "Microwave", "contains": ["Egg"]},
            {"object": "Microwave", "is": {"isOpen": false}},
            {"object": "Microwave", "is": {"isToggled": true}}
        ]),
    );
}

#[test]
fn one_of_two_is_one_and_the_other_is_none() {
    for (instruction, expected) in [
        (
            "place the knife, not the spoon, in the drawer",
            json!([{"object": "Drawer", "contains": ["Knife"]}]),
        ),
        ("put the egg in the bowl instead of the plate", json!([{"object": "Bowl", "contains": ["Egg"]}])),
        ("put the potato or the egg in the bowl", json!([{"object": "Bowl", "contains": ["Potato"]}])),
        ("put the fork in the bowl or on the plate", json!([{"object": "Bowl", "contains": ["Fork"]}])),
    ] {
        check(instruction, kitchen(), expected);
    }
    let choice = understood("put the potato or the egg in the bowl", kitchen()).assumptions.join("; ");
    assert!(choice.contains("\"the egg\""), "a choice is said: {choice}");
}

#[test]
fn questions_quote_the_words_that_were_typed() {
    for (instruction, word) in [
        ("Mettez la tomate dans le frigo", "mettez la tomate"),
        ("touch the egg", "touch"),
        ("neither here nor there", ""),
        ("flush the bowl", "flush"),
        ("put the tomatoe on the zeppelin", "zeppelin"),
    ] {
        let question = asked(instruction, kitchen()).question;
        assert!(question.contains(word), "{instruction:?}: {question}");
    }
}

#[test]
fn conditions_are_those_of_now() {
    let mut lit = kitchen();
    for object in lit.iter_mut().filter(|object| object.kind == "LightSwitch") {
        object.states.push("isToggled".to_owned());
    }
    let off = json!([{"object": "LightSwitch", "is": {"isToggled": false}}]);
    check("if the light is on, switch it off", lit.clone(), off.clone());
    check("switch the light off if it is on", lit, off);
    let question = asked("if the light is on, switch it off", kitchen()).question;
    assert!(question.contains("does not hold now"), "{question}");
}

#[test]
fn robots_are_advice_and_going_is_a_step() {
    let advised = understood("robot1 should rinse the plate and robot 2 must slice the egg", kitchen());
    let robots: Vec<_> = advised.subtasks.iter().map(|subtask| subtask.robots.clone()).collect();
    assert_eq!(robots, [["robot1"], ["robot2"]]);
    check("walk to the fridge and open it", kitchen(), json!([{"object": "Fridge", "is": {"isOpen": true}}]));
    assert!(!asked("walk to the bed", bedroom()).question.is_empty());
    check(
        "grab the knife, then slice the egg plz",
        kitchen(),
        json!([{"object": "Egg", "is": {"isSliced": true}}]),
    );
}

#[test]
fn what_is_left_out_is_said() {
    assert!(asked("put the egg on top of the fridge", kitchen()).question.contains("on top of"));
    for (instruction, part) in [
        ("heat the potato on the stove", "the stove"),
        ("put everything but the plate in the fridge", "takes no"),
        ("grab the potato and put it on the counter", "already"),
    ] {
        let said = understood(instruction, kitchen()).assumptions.join("; ");
        assert!(said.contains(part), "{instruction:?}: {said}");
    }
}
