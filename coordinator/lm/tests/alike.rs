//! Pairs of sentences of our own that say the same in plain and in less plain words: the same must be read.

#[path = "judge/mod.rs"]
#[allow(dead_code, reason = "sentences are compared with each other, not with goals")]
mod judge;

use lamma_lm::Offline;

/// A scene, what is said plainly, and what says the same.
const PAIRS: &[(&str, &str, &str)] = &[
    ("FloorPlan6", "put the fork and the spoon in the drawer", "in the drawer go the fork and the spoon"),
    ("FloorPlan6", "put the egg in the pan", "the egg needs to be in the pan"),
    ("FloorPlan6", "put the egg in the pan", "make sure that there's an egg in the pan"),
    ("FloorPlan6", "put the egg in the pan", "bung the egg in the pan"),
    ("FloorPlan6", "put the egg in the pan", "leave the knife, put the egg in the pan"),
    ("FloorPlan6", "put the egg in the pan", "the bread stays where it is; put the egg in the pan"),
    (
        "FloorPlan6",
        "put the egg and the apple in the fridge",
        "the fridge should contain the egg and the apple",
    ),
    (
        "FloorPlan6",
        "put the egg and the apple in the fridge",
        "put the following in the fridge: egg and apple",
    ),
    (
        "FloorPlan6",
        "put the egg and the apple in the fridge",
        "grab the egg, then the apple and put all of them in the fridge",
    ),
    (
        "FloorPlan6",
        "put the egg and the apple in the fridge",
        "put the egg in the fridge. the apple should be there too",
    ),
    (
        "FloorPlan6",
        "wash the cup and put it in the cabinet",
        "the cup is to be washed and returned to the cabinet",
    ),
    ("FloorPlan6", "wash the cup and put it in the cabinet", "having washed the cup, put it in the cabinet"),
    (
        "FloorPlan6",
        "wash the cup and put it in the cabinet",
        "once you've washed the cup, it should be in the cabinet",
    ),
    (
        "FloorPlan6",
        "wash the cup and put it in the cabinet",
        "instead of leaving the cup dirty, wash it and put it in the cabinet",
    ),
    (
        "FloorPlan6",
        "slice the apple and the tomato and put them in the bowl",
        "slice the apple and the tomato, then put everything you cut in the bowl",
    ),
    (
        "FloorPlan6",
        "slice the apple and the tomato and put them in the bowl",
        "the apple and the tomato should be sliced, and every slice should be put in the bowl",
    ),
    (
        "FloorPlan6",
        "wash the fork and the mug, put the fork in the drawer and the mug in the sink",
        "wash the fork and the mug, put the former in the drawer and the latter in the sink",
    ),
    (
        "FloorPlan6",
        "fill the pot with water and put it on the stove",
        "put the pot, full of water, on the stove",
    ),
    ("FloorPlan6", "cook the potato", "cook the potato in the microwave"),
    (
        "FloorPlan6",
        "turn off the toaster and close the fridge",
        "the toaster must be off, no fridge may be open",
    ),
    ("FloorPlan6", "turn the toaster on", "turn the toaster on if it isn't on already"),
    ("FloorPlan6", "turn the toaster on", "if the toaster is off turn it on"),
    (
        "FloorPlan6",
        "put the cup in the sink and wash the plate",
        "you'll find the cup on the counter; put it in the sink and do wash the plate",
    ),
    (
        "FloorPlan6",
        "wash the apple, the egg and the tomato, put the apple and the egg in the bowl and the tomato on the plate",
        "wash the apple, the egg and the tomato, put the first two in the bowl and the last one on the plate",
    ),
    (
        "FloorPlan6",
        "slice the bread and the tomato and put them on the plate",
        "slice the bread and the tomato and put everything on the plate",
    ),
    (
        "FloorPlan6",
        "wash the cup and the mug, fill the cup with water",
        "wash the cup and the mug, fill one of them with water",
    ),
    (
        "FloorPlan6",
        "put the plate and the cup on the counter, the bowl and the mug in the sink",
        "put the plate and the cup on the counter and the rest of the dishes in the sink",
    ),
    ("FloorPlan6", "wash the plate, the bowl, the cup and the mug", "wash every dish"),
    (
        "FloorPlan6",
        "slice the bread and put it on the plate",
        "take two slices of bread and put them on the plate",
    ),
    ("FloorPlan6", "wash the tomato", "wash the tomato that sits in the sink"),
    (
        "FloorPlan304",
        "put the book and the pen on the desk",
        "prepare the desk: put the book and the pen on it",
    ),
    (
        "FloorPlan304",
        "wash the mug and put it on the bed",
        "if there is a mug on the desk, wash it and put it on the bed",
    ),
    ("FloorPlan6", "turn off the toaster", "the toaster: off"),
    ("FloorPlan6", "put a plate and a cup on the counter", "the counter needs a plate and a cup on it"),
    ("FloorPlan6", "wash the plate and the cup", "Wash the plate. Also the cup."),
    ("FloorPlan6", "put the spoon in the drawer", "could the spoon be put in the drawer?"),
    (
        "FloorPlan6",
        "wash the plate and put it in the cabinet",
        "Guests are coming! Wash the plate and put it in the cabinet",
    ),
    (
        "FloorPlan304",
        "put the book, the pen and the pencil on the desk, put the pen and the pencil in the mug",
        "put the book, the pen and the pencil on the desk, the latter two in the mug",
    ),
    (
        "FloorPlan304",
        "put the phone, the keys and the card on the desk",
        "put my stuff (phone, keys, card) on the desk",
    ),
    ("FloorPlan402", "close the toilet", "the toilet lid should be down"),
];

#[test]
fn the_same_is_read_whatever_the_words() {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let mut told = String::new();
    for (scene, plain, other) in PAIRS {
        let lines = format!("{scene} | {plain} | none\n{scene} | {other} | none\n");
        let outcomes = judge::outcomes(&lines, &offline).expect("the lines are whole");
        // Without how sure it is.
        let goal = |at: usize| outcomes[at].told.split(" (").next().unwrap_or_default().to_owned();
        if goal(0) != goal(1) || !goal(0).starts_with("got") {
            told.push_str(&format!("{plain}\n    {}\n{other}\n    {}\n", outcomes[0].told, outcomes[1].told));
        }
    }
    assert!(told.is_empty(), "{told}");
}
