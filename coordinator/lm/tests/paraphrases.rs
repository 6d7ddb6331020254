//! Paraphrases made by a small grammar of our own: every effect in many ways of saying it, each with the things
//! of a room and the goal it must have. What ALFRED's sentences lack (doors, switches, liquids, breaking) is here.

#[path = "judge/mod.rs"]
#[allow(dead_code, reason = "the lines of a grammar have no numbers")]
mod judge;

use lamma_lm::Offline;

/// One effect: how it is said of `X` (and `Y`), what it is said of, and the goal.
struct Effect {
    name: &'static str,
    scene: &'static str,
    /// Words and types of `X`, and of `Y` where the effect has one.
    things: &'static [(&'static str, &'static str, &'static str, &'static str)],
    said: &'static [&'static str],
    goal: &'static str,
}

const EFFECTS: &[Effect] = &[
    Effect {
        name: "put somewhere",
        scene: "FloorPlan6",
        things: &[
            ("tomato", "Tomato", "in the fridge", "Fridge"),
            ("spatula", "Spatula", "in a drawer", "Drawer"),
            ("bowl", "Bowl", "on the counter", "CounterTop"),
            ("plate", "Plate", "into the cabinet", "Cabinet"),
        ],
        said: &[
            "put the X Y",
            "place a X Y",
            "take the X and put it Y",
            "pick up the X, then set it Y",
            "grab the X and leave it Y",
            "the X goes Y",
            "the X should be Y",
            "the X belongs Y",
            "I want the X Y",
            "make sure the X is Y",
            "the X needs to be put Y",
            "find the X and drop it Y",
            "get the X, carry it over and place it Y",
            "the X has to go Y",
            "see to it that the X ends up Y",
            "after picking up the X, put it Y",
            "could you put the X Y for me",
            "I'd like the X to be Y",
            "X Y please",
        ],
        goal: "X@Y",
    },
    Effect {
        name: "open",
        scene: "FloorPlan6",
        things: &[("fridge", "Fridge", "", ""), ("microwave", "Microwave", "", "")],
        said: &[
            "open the X",
            "open up the X",
            "pull the X open",
            "make sure the X is open",
            "leave the X open",
            "the X should be open",
            "get the X open",
            "I want the X open",
            "swing open the X",
            "have the X opened",
            "go to the X and open it",
            "the X must be left open",
            "open the X door",
            "open the door of the X",
            "I need the X to be open",
        ],
        goal: "X:open",
    },
    Effect {
        name: "close",
        scene: "FloorPlan6",
        things: &[("fridge", "Fridge", "", ""), ("microwave", "Microwave", "", "")],
        said: &[
            "close the X",
            "shut the X",
            "push the X shut",
            "make sure the X is closed",
            "leave the X shut",
            "the X should be closed",
            "the X has to be shut",
            "get the X closed",
            "I want the X closed",
            "somebody left the X open, close it",
            "shut the door of the X",
            "close the X door",
            "the X is open, please shut it",
            "do not leave the X open",
        ],
        goal: "X:closed",
    },
    Effect {
        name: "switch on",
        scene: "FloorPlan301",
        things: &[("desk lamp", "DeskLamp", "", ""), ("laptop", "Laptop", "", "")],
        said: &[
            "turn on the X",
            "turn the X on",
            "switch the X on",
            "power up the X",
            "make sure the X is on",
            "the X should be on",
            "the X should be turned on",
            "get the X going",
            "have the X switched on",
            "I want the X on",
            "leave the X on",
            "X on please",
            "go over to the X and turn it on",
            "the X must be on",
            "see that the X is switched on",
        ],
        goal: "X:on",
    },
    Effect {
        name: "switch off",
        scene: "FloorPlan301",
        things: &[("desk lamp", "DeskLamp", "", ""), ("laptop", "Laptop", "", "")],
        said: &[
            "turn off the X",
            "turn the X off",
            "switch off the X",
            "power the X down",
            "shut the X off",
            "make sure the X is off",
            "the X should be off",
            "the X should be switched off",
            "I want the X off",
            "leave the X off",
            "X off please",
            "walk to the X and switch it off",
            "the X is on, turn it off",
            "kill the X",
            "do not leave the X on",
        ],
        goal: "X:off",
    },
    Effect {
        name: "clean",
        scene: "FloorPlan6",
        things: &[("mug", "Mug", "", ""), ("pan", "Pan", "", ""), ("fork", "Fork", "", "")],
        said: &[
            "wash the X",
            "clean the X",
            "rinse off the X",
            "give the X a wash",
            "give the X a good scrub",
            "scrub the X clean",
            "get the X clean",
            "make the X clean",
            "make sure the X is clean",
            "the X should be clean",
            "the X needs washing",
            "the X needs to be washed",
            "the X is dirty, wash it",
            "I want the X washed",
            "have the X cleaned",
            "rinse the X under the tap",
            "run the X under the faucet",
            "take the X to the sink and wash it",
            "wash the X in the sink with the sponge",
            "the X could use a wash",
            "put the X in the sink and wash it, then put it on the counter",
        ],
        goal: "X:clean",
    },
    Effect {
        name: "slice",
        scene: "FloorPlan6",
        things: &[("tomato", "Tomato", "", ""), ("potato", "Potato", "", ""), ("apple", "Apple", "", "")],
        said: &[
            "slice the X",
            "cut the X",
            "cut up the X",
            "chop the X up",
            "cut the X into slices",
            "cut the X into pieces",
            "slice the X with the knife",
            "use the knife to slice the X",
            "take the knife and cut the X",
            "I want the X sliced",
            "I need the X cut up",
            "make sure the X is sliced",
            "the X should be sliced",
            "the X needs to be cut",
            "have the X chopped",
            "cut the X in half",
            "get the X sliced",
            "slice up a X",
        ],
        goal: "X:sliced",
    },
    Effect {
        name: "break",
        scene: "FloorPlan6",
        things: &[("plate", "Plate", "", ""), ("bowl", "Bowl", "", "")],
        said: &[
            "break the X",
            "smash the X",
            "shatter the X",
            "smash the X to pieces",
            "the X should be broken",
            "I want the X broken",
            "smash up the X",
            "pick up the X and smash it",
            "make sure the X is broken",
        ],
        goal: "X:broken",
    },
    Effect {
        name: "fill",
        scene: "FloorPlan6",
        things: &[("mug", "Mug", "", ""), ("pot", "Pot", "", ""), ("kettle", "Kettle", "", "")],
        said: &[
            "fill the X with water",
            "fill the X",
            "fill up the X with water",
            "pour water into the X",
            "put some water in the X",
            "put water into the X",
            "get some water in the X",
            "run water into the X",
            "add water to the X",
            "the X should be filled with water",
            "the X should be full of water",
            "make sure the X is filled with water",
            "take the X to the sink and fill it with water",
            "I want the X full of water",
            "I need a X of water",
            "the X needs to be filled with water",
        ],
        goal: "X:full; X:water",
    },
    Effect {
        name: "empty",
        scene: "FloorPlan6",
        things: &[("mug", "Mug", "", ""), ("pot", "Pot", "", "")],
        said: &[
            "empty the X",
            "empty out the X",
            "pour out the X",
            "pour the water out of the X",
            "tip the water out of the X",
            "dump the water out of the X",
            "drain the X",
            "make sure the X is empty",
            "the X should be empty",
            "the X needs to be emptied",
            "get the water out of the X",
            "I want the X empty",
        ],
        goal: "X:empty",
    },
    Effect {
        name: "heat",
        scene: "FloorPlan6",
        things: &[("mug", "Mug", "", ""), ("plate", "Plate", "", "")],
        said: &[
            "heat the X",
            "heat up the X",
            "warm the X up",
            "make the X hot",
            "the X should be hot",
            "make sure the X is hot",
            "I want the X warm",
            "get the X hot",
            "the X needs to be heated",
            "have the X warmed up",
            "heat the X in the microwave",
        ],
        goal: "X:hot / X:hot; X@Microwave",
    },
    Effect {
        name: "cool",
        scene: "FloorPlan6",
        things: &[("tomato", "Tomato", "", ""), ("apple", "Apple", "", "")],
        said: &[
            "cool the X",
            "chill the X",
            "cool down the X",
            "make the X cold",
            "the X should be cold",
            "make sure the X is cold",
            "I want the X chilled",
            "get the X cold",
            "the X needs to be chilled",
            "chill the X in the fridge",
            "have the X cooled",
            "put the X in the fridge to cool it",
            "put the X in the fridge to chill",
        ],
        goal: "X:cold / X:cold; X@Fridge",
    },
    Effect {
        name: "cook",
        scene: "FloorPlan6",
        things: &[("potato", "Potato", "", ""), ("egg", "Egg", "", "")],
        said: &[
            "cook the X",
            "fry the X",
            "the X should be cooked",
            "make sure the X is cooked",
            "I want the X cooked",
            "the X needs to be cooked",
            "have the X cooked",
            "get the X cooked",
            "cook the X on the stove",
            "cook the X in the microwave",
        ],
        goal: "X:cooked / X:hot / X:hot; X@Microwave",
    },
    Effect {
        name: "throw away",
        scene: "FloorPlan6",
        things: &[("egg", "Egg", "", ""), ("bread", "Bread", "", ""), ("lettuce", "Lettuce", "", "")],
        said: &[
            "throw the X away",
            "throw away the X",
            "throw out the X",
            "toss the X in the trash",
            "get rid of the X",
            "put the X in the bin",
            "discard the X",
            "dispose of the X",
            "the X goes in the trash",
            "the X should be thrown away",
            "the X has to be thrown out",
            "chuck the X",
            "trash the X",
            "take the X and throw it away",
            "pick up the X and toss it",
            "the X is bad, throw it out",
            "dump the X into the garbage",
            "I want the X thrown out",
        ],
        goal: "X@GarbageCan",
    },
    Effect {
        name: "hold",
        scene: "FloorPlan301",
        things: &[("book", "Book", "", ""), ("pen", "Pen", "", "")],
        said: &[
            "pick up the X",
            "pick the X up",
            "grab the X",
            "take the X",
            "hold the X",
            "get the X",
            "fetch me the X",
            "bring me the X",
            "hand me the X",
            "I need the X",
            "go get the X",
            "could you pass me the X",
            "have the X in your hand",
            "lift up the X",
        ],
        goal: "X:held",
    },
];

/// What may stand around a command without changing it.
const SHELLS: [(&str, &str); 4] =
    [("", ""), ("please ", "."), ("okay robot, ", " now!"), ("hey, ", ", thanks")];

/// The lines of an effect, in the form that `judge` reads.
fn lines(effect: &Effect) -> String {
    let mut lines = String::new();
    let mut number = 0;
    for said in effect.said {
        for (x, kind, y, place) in effect.things {
            let (front, back) = SHELLS[number % SHELLS.len()];
            number += 1;
            let words: Vec<&str> = said
                .split(' ')
                .map(|word| match word {
                    "X" => x,
                    "Y" => y,
                    word => word,
                })
                .collect();
            let mut sentence = format!("{front}{}{back}", words.join(" ").replace("X,", &format!("{x},")));
            sentence = sentence.replace("a apple", "an apple");
            let mut goal = effect.goal.replace('Y', place).replace('X', kind);
            if said.contains("then put it on the counter") {
                goal = format!("{kind}:clean; {kind}@CounterTop");
            }
            lines.push_str(&format!("{} | {sentence} | {goal}\n", effect.scene));
        }
    }
    lines
}

#[test]
fn every_effect_is_understood_however_it_is_said() {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let (mut good, mut all, mut told) = (0, 0, String::new());
    for effect in EFFECTS {
        let outcomes = judge::outcomes(&lines(effect), &offline).expect("the grammar writes lines");
        let bad: Vec<_> = outcomes.iter().filter(|outcome| !outcome.good).collect();
        (good, all) = (good + outcomes.len() - bad.len(), all + outcomes.len());
        told.push_str(&format!("{}: {} of {}\n", effect.name, outcomes.len() - bad.len(), outcomes.len()));
        for judge::Outcome { sentence, goal, told: got, .. } in bad {
            told.push_str(&format!("    {sentence}\n        want {goal}\n        {got}\n"));
        }
    }
    println!("{told}");
    assert!(good * 100 >= all * 98, "{good} of {all}\n{told}");
}
