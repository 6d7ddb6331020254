//! The embedded default: what it makes of sentences of our own, and what must not change it.

mod scenes;

use std::time::Duration;

use lamma_lm::{Answer, Decomposition, Offline, Request};
use proptest::prelude::*;
use scenes::{bedroom, kitchen, with_distractors};
use serde_json::{Value, json};

fn request(instruction: &str, objects: Vec<lamma_lm::ObjectView>, assume: bool) -> Request {
    Request {
        instruction: instruction.to_owned(),
        objects,
        robots: Vec::new(),
        assume,
        deadline: Duration::from_secs(5),
    }
}

fn offline() -> Offline {
    Offline::new().expect("the built-in lexicon reads")
}

#[track_caller]
fn understood(instruction: &str, objects: Vec<lamma_lm::ObjectView>) -> Decomposition {
    match offline().read(&request(instruction, objects, false)) {
        Answer::Understood(decomposition) => decomposition,
        Answer::Clarify(clarification) => panic!("{instruction:?} is not understood: {clarification:?}"),
    }
}

/// The goals that last, in order, as JSON.
fn goals(decomposition: &Decomposition) -> Value {
    let goals =
        decomposition.subtasks.iter().filter(|subtask| subtask.lasting).flat_map(|subtask| &subtask.goal);
    serde_json::to_value(goals.collect::<Vec<_>>()).expect("goals are plain data")
}

#[track_caller]
fn check(instruction: &str, objects: Vec<lamma_lm::ObjectView>, expected: Value) {
    assert_eq!(goals(&understood(instruction, objects)), expected, "{instruction}");
}

#[test]
fn kitchen_commands_have_the_goals_they_say() {
    let hot = json!({"temperature": "Hot"});
    let clean = json!({"isDirty": false});
    let cases = [
        ("put the tomato into the fridge", json!([{"object": "Fridge", "contains": ["Tomato"]}])),
        (
            "Bring the egg, the lettuce and the tomato to the refrigerator.",
            json!([{"object": "Fridge", "contains": ["Egg", "Lettuce", "Tomato"]}]),
        ),
        ("get rid of the egg", json!([{"object": "GarbageCan", "contains": ["Egg"]}])),
        ("turn the light off", json!([{"object": "LightSwitch", "is": {"isToggled": false}}])),
        ("kill the light", json!([{"object": "LightSwitch", "is": {"isToggled": false}}])),
        ("shut the microwave", json!([{"object": "Microwave", "is": {"isOpen": false}}])),
        ("chop up the potato", json!([{"object": "Potato", "is": {"isSliced": true}}])),
        ("smash the mug", json!([{"object": "Mug", "is": {"isBroken": true}}])),
        ("cook the potato", json!([{"object": "Potato", "is": {"isCooked": true}}])),
        ("warm up the tomato", json!([{"object": "Tomato", "is": hot}])),
        (
            "fill the mug with water",
            json!([{"object": "Mug", "is": {"fillLiquid": "water", "isFilledWithLiquid": true}}]),
        ),
        (
            "chill the tomato",
            json!([{"object": "Fridge", "contains": [{"object": "Tomato", "is": {"temperature": "Cold"}}]}]),
        ),
        (
            "rinse the fork and put it in the bowl",
            json!([
                {"object": "Fork", "is": clean},
                {"object": "Bowl", "contains": [{"object": "Fork", "is": clean}]}
            ]),
        ),
        (
            "place a hot potato on a clean plate",
            json!([{"object": "Plate", "is": clean, "contains": [{"object": "Potato", "is": hot}]}]),
        ),
        (
            "put the bowl with the egg in it on the dining table",
            json!([{"object": "DiningTable", "contains": [{"object": "Bowl", "contains": ["Egg"]}]}]),
        ),
        (
            "put the fork in the mug and set it on the counter",
            json!([
                {"object": "Mug", "contains": ["Fork"]},
                {"object": "CounterTop", "contains": [{"object": "Mug", "contains": ["Fork"]}]}
            ]),
        ),
        ("switch on the stove", json!([{"object": "StoveKnob", "is": {"isToggled": true}}])),
        ("leave the fridge closed", json!([{"object": "Fridge", "is": {"isOpen": false}}])),
    ];
    for (instruction, expected) in cases {
        check(instruction, kitchen(), expected);
    }
}

#[test]
fn the_scene_decides_what_a_word_means() {
    // Only a mug fits the coffee machine, so that is the cup meant.
    check(
        "put the cup into the coffee maker",
        kitchen(),
        json!([{"object": "CoffeeMachine", "contains": ["Mug"]}]),
    );
    check(
        "look at the watch under the lamp",
        bedroom(),
        json!([{"object": "Watch", "is": {"isPickedUp": true}}, {"object": "DeskLamp", "is": {"isToggled": true}}]),
    );
    check(
        "put the book that is on the bed into the box",
        bedroom(),
        json!([{"object": "Box", "contains": ["Book_2"]}]),
    );
    check(
        "put everything on the bed except the pillow into the box",
        bedroom(),
        json!([{"object": "Box", "contains": ["Book_2", "CellPhone_1"]}]),
    );
    check(
        "put all the books on the desk",
        bedroom(),
        json!([{"object": "Desk", "contains": ["Book_1", "Book_2", "Book_3"]}]),
    );
    check("put two books on the desk", bedroom(), json!([{"object": "Desk", "contains": ["Book", "Book"]}]));
}

#[test]
fn where_a_thing_was_says_where_it_is_to_be() {
    let hot = json!({"temperature": "Hot"});
    let cases = [
        // Nobody says where it goes, but where it was.
        (
            "heat the apple on the counter",
            json!([{"object": "CounterTop", "contains": [{"object": "Apple_1", "is": hot}]}]),
        ),
        // Thrown away from there, not put there.
        ("throw away the bread on the counter", json!([{"object": "GarbageCan", "contains": ["Bread"]}])),
        (
            "rinse the fork and return to the counter",
            json!([
                {"object": "Fork", "is": {"isDirty": false}},
                {"object": "CounterTop", "contains": [{"object": "Fork", "is": {"isDirty": false}}]}
            ]),
        ),
        // The bowl is not said to get cold: it was in the fridge.
        (
            "put the spoon in the bowl in the fridge and put the bowl on the counter",
            json!([
                {"object": "Bowl", "contains": ["Spoon"]},
                {"object": "CounterTop", "contains": [{"object": "Bowl", "contains": ["Spoon"]}]}
            ]),
        ),
    ];
    for (instruction, expected) in cases {
        check(instruction, kitchen(), expected);
    }
}

#[test]
fn order_words_order_and_others_do_not() {
    let after = |instruction: &str| -> Vec<Vec<String>> {
        understood(instruction, kitchen()).subtasks.into_iter().map(|subtask| subtask.after).collect()
    };
    assert_eq!(after("slice the tomato and wash the plate"), [vec![], Vec::<String>::new()]);
    assert_eq!(after("slice the tomato, then wash the plate"), [vec![], vec!["s1".to_owned()]]);
    assert_eq!(after("slice the tomato while washing the plate"), [vec![], Vec::<String>::new()]);
    let before = understood("before you put the egg in the fridge, wash the plate", kitchen());
    assert_eq!(before.subtasks[0].text, "wash the plate");
    assert_eq!(before.subtasks[1].after, ["s1"]);
    let after_it = understood("wash the plate after slicing the tomato", kitchen());
    assert_eq!(after_it.subtasks[0].text, "slicing the tomato");
}

#[test]
fn what_a_later_step_undoes_does_not_last() {
    let decomposition =
        understood("open the fridge, put the egg in the fridge and close the fridge", kitchen());
    let lasting: Vec<bool> = decomposition.subtasks.iter().map(|subtask| subtask.lasting).collect();
    assert_eq!(lasting, [false, true, true]);
    let moved = understood("put the tomato in the microwave, then move it to the fridge", kitchen());
    assert!(!moved.subtasks[0].lasting && moved.subtasks[1].lasting);
}

#[test]
fn one_of_several_is_the_same_one_throughout() {
    let decomposition = understood("slice an apple and put it on the plate", kitchen());
    assert_eq!(
        goals(&decomposition),
        json!([
            {"object": "Apple", "is": {"isSliced": true}, "same": "apple-1"},
            {"object": "Plate", "contains": [{"object": "Apple", "is": {"isSliced": true}, "same": "apple-1"}]}
        ])
    );
}

#[test]
fn what_is_not_understood_is_asked_and_never_guessed() {
    for (instruction, expected) in [
        ("polish the zeppelin", "zeppelin"),
        ("put the spoon on the piano", "piano"),
        ("frobnicate the egg", "frobnicate"),
        ("put the watering can on the table", "watering can"),
        ("put three eggs in the fridge", "3"),
        ("put it there", "it"),
        ("move the fork", "fork"),
        ("slice the fork", "sliceable"),
        ("", ""),
    ] {
        match offline().read(&request(instruction, kitchen(), false)) {
            Answer::Clarify(clarification) => {
                let text = format!("{:?}", clarification.not_understood).to_lowercase();
                assert!(text.contains(expected), "{instruction:?}: {text}");
                assert!(clarification.readings.len() <= 3 && !clarification.question.is_empty());
            }
            Answer::Understood(decomposition) => panic!("{instruction:?}: {decomposition:?}"),
        }
    }
}

#[test]
fn told_to_assume_it_takes_the_best_reading_and_says_what_is_doubtful() {
    match offline().read(&request("put three apples in the fridge", kitchen(), true)) {
        Answer::Understood(decomposition) => {
            assert!(decomposition.confidence < 0.5);
            assert!(
                decomposition.assumptions.iter().any(|a| a.contains('3')),
                "{:?}",
                decomposition.assumptions
            );
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn vague_commands_are_read_as_situations_of_this_room() {
    check(
        "it is far too bright in here",
        bedroom(),
        json!([
            {"object": "LightSwitch", "is": {"isToggled": false}},
            {"object": "DeskLamp", "is": {"isToggled": false}},
            {"object": "Blinds", "is": {"isOpen": false}}
        ]),
    );
    check(
        "I would love a coffee",
        kitchen(),
        json!([{
            "object": "CoffeeMachine",
            "contains": [{"object": "Mug", "is": {"isFilledWithLiquid": true, "fillLiquid": "coffee"}}],
            "is": {"isToggled": true}
        }]),
    );
    let assumptions = understood("I would love a coffee", kitchen()).assumptions;
    assert!(
        assumptions.iter().any(|a| a.contains("coffee")),
        "a situation is always stated: {assumptions:?}"
    );
}

/// Pairs that must mean the same.
#[test]
fn wording_does_not_change_the_goal() {
    let pairs = [
        ("put the tomato in the fridge", "could you please put the tomato in the fridge?"),
        ("put the tomato in the fridge", "I want you to place the tomato inside the refrigerator, thanks"),
        ("put the tomato in the fridge", "put the tomatoe in the firdge"),
        ("slice the potato", "slcie the potatoe"),
        ("wash the plate", "wash the dish"),
        ("put the lettuce into the microwave", "put the lettuce into the micro wave"),
        ("throw the egg away", "throw away the egg"),
        ("turn on the light", "switch the light on"),
        ("put the fork and the mug in the sink", "put the fork in the sink and the mug in the sink"),
    ];
    for (one, other) in pairs {
        let merged = |instruction: &str| {
            let mut facts: Vec<String> = Vec::new();
            for subtask in understood(instruction, kitchen()).subtasks {
                for entry in subtask.goal {
                    for content in &entry.contains {
                        facts.push(format!(
                            "{} in {}",
                            serde_json::to_string(content).unwrap_or_default(),
                            entry.object
                        ));
                    }
                    facts.extend(
                        entry
                            .is
                            .iter()
                            .map(|(property, value)| format!("{} {property} {value:?}", entry.object)),
                    );
                }
            }
            facts.sort();
            facts
        };
        assert_eq!(merged(one), merged(other), "{one:?} and {other:?}");
    }
}

#[test]
fn the_order_of_independent_clauses_changes_nothing_but_the_order() {
    let one = understood("slice the tomato and turn off the light", kitchen());
    let other = understood("turn off the light and slice the tomato", kitchen());
    assert_eq!(one.subtasks[0].goal, other.subtasks[1].goal);
    assert_eq!(one.subtasks[1].goal, other.subtasks[0].goal);
}

#[test]
fn a_number_changes_how_many_and_nothing_else() {
    for count in 1..=2 {
        let word = ["one", "two"][count - 1];
        let noun = if count == 1 { "apple" } else { "apples" };
        let decomposition = understood(&format!("put {word} {noun} in the bowl"), kitchen());
        assert_eq!(goals(&decomposition), json!([{"object": "Bowl", "contains": vec!["Apple"; count]}]));
    }
}

/// Objects that the sentence neither names nor implies must not appear, however many stand around.
#[test]
fn distractors_are_left_alone() {
    let sentences: [(&str, &[&str]); 6] = [
        ("put the tomato in the fridge and turn off the light", &["Tomato", "Fridge", "LightSwitch"]),
        ("wash the fork, then put it in the bowl", &["Fork", "Bowl"]),
        ("slice the potato and throw away the egg", &["Potato", "Egg", "GarbageCan"]),
        ("put the cutlery in the sink", &["Fork", "Spoon", "Knife", "ButterKnife", "SinkBasin"]),
        ("heat the plate and put it on the table", &["Plate", "DiningTable", "SideTable", "CoffeeTable"]),
        ("open the microwave", &["Microwave"]),
    ];
    for seed in 0..200 {
        let objects = with_distractors(kitchen(), seed);
        let (sentence, allowed) = sentences[usize::try_from(seed).unwrap_or(0) % sentences.len()];
        let decomposition = match offline_once().read(&request(sentence, objects.clone(), true)) {
            Answer::Understood(decomposition) => decomposition,
            Answer::Clarify(clarification) => panic!("seed {seed}: {sentence:?}: {clarification:?}"),
        };
        let text = goals(&decomposition).to_string();
        for object in &objects {
            let quoted = [format!("\"{}\"", object.kind), format!("\"{}\"", object.name)];
            let mentioned = quoted.iter().any(|name| text.contains(name.as_str()));
            assert!(
                !mentioned || allowed.contains(&object.kind.as_str()),
                "seed {seed}: {sentence:?} -> {text}"
            );
        }
    }
}

fn offline_once() -> &'static Offline {
    static ONCE: std::sync::OnceLock<Offline> = std::sync::OnceLock::new();
    ONCE.get_or_init(offline)
}

const SEEDS: [&str; 12] = [
    "put the tomato and the lettuce in the fridge, then switch off the light",
    "before you slice all the apples except the big one, wash them and the knife with the sponge",
    "the dirty plate of the two in the sink should be clean",
    "put a box with a key chain in it on the sofa's left side",
    "turn the lamp on and then off again while holding the book",
    "make sure the microwave is closed and the faucet is not on",
    "I would like three slices of bread in a bowl on the table next to the toaster",
    "don't break it, without opening the drawer",
    "everything but the rest of the others",
    "put it back where it belongs",
    "get ready for movie night",
    "of of the with in it a a and , . ; then",
];

fn mutated() -> impl Strategy<Value = String> {
    let edit = (any::<prop::sample::Index>(), 0..5u8, any::<prop::sample::Index>());
    (prop::sample::select(SEEDS.to_vec()), prop::collection::vec(edit, 0..8)).prop_map(|(seed, edits)| {
        let mut words: Vec<String> = seed.split(' ').map(str::to_owned).collect();
        let pool: Vec<&str> = SEEDS.iter().flat_map(|seed| seed.split(' ')).collect();
        for (at, kind, other) in edits {
            let i = at.index(words.len());
            match kind {
                0 if words.len() > 1 => drop(words.remove(i)),
                1 => words.insert(i, pool[other.index(pool.len())].to_owned()),
                2 => words[i] = words[i].chars().rev().collect(),
                3 => {
                    let j = other.index(words.len());
                    words.swap(i, j);
                }
                _ => words[i] = words[i].chars().skip(1).collect(),
            }
        }
        words.join(" ")
    })
}

/// No panic, the same answer twice, and every goal about something of the scene.
fn holds_its_promises(instruction: &str) {
    let objects = kitchen();
    let request = request(instruction, objects, true);
    let first = offline_once().read(&request);
    assert_eq!(first, offline_once().read(&request), "{instruction:?} is read in two ways");
    if let Answer::Understood(decomposition) = first {
        assert!((0.0..=1.0).contains(&decomposition.confidence), "{instruction:?}");
        let text = json!({
            "subtasks": decomposition.subtasks,
            "assumptions": decomposition.assumptions,
            "confidence": decomposition.confidence
        });
        // The embedded default passes the checks that a model's answer must pass.
        if let Err(errors) = lamma_lm::decode::decode(&text.to_string(), &request) {
            panic!("{instruction:?}: {errors:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_survived(text in "\\PC{0,200}") {
        holds_its_promises(&text);
    }

    #[test]
    fn mutated_sentences_are_survived(text in mutated()) {
        holds_its_promises(&text);
    }
}

/// An attempt at a clause that is given up takes its prohibitions with it.
#[test]
fn what_was_given_up_forbids_nothing() {
    for text in ["left the things the fridge open", "fork left fork anything the fridge on put open"] {
        holds_its_promises(text);
    }
}

/// `LAMMA_FUZZ=1000000 cargo test -p lamma-lm --release -- --ignored a_million`; without the variable a
/// thousand.
#[test]
#[ignore = "takes minutes; run it in release"]
fn a_million_inputs_are_survived() {
    let cases = std::env::var("LAMMA_FUZZ").ok().and_then(|count| count.parse().ok());
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig {
        cases: cases.unwrap_or(1000),
        failure_persistence: None,
        ..ProptestConfig::default()
    });
    let strategy = prop_oneof![mutated(), "\\PC{0,120}"];
    runner
        .run(&strategy, |text| {
            holds_its_promises(&text);
            Ok(())
        })
        .expect("every input is survived");
}

#[test]
fn a_very_long_instruction_is_cut_and_says_so() {
    let long = "put the tomato in the fridge and ".repeat(5000);
    match offline().read(&request(&long, kitchen(), true)) {
        Answer::Understood(decomposition) => {
            assert!(decomposition.assumptions.iter().any(|a| a.contains("too long")));
            assert!(decomposition.subtasks.len() <= 64);
        }
        other => panic!("{other:?}"),
    }
}
