use super::*;
use crate::offline::text::tokens;

fn plain(text: &str) -> String {
    let lexicon = Lexicon::embedded().unwrap();
    let words: Vec<String> = rewritten(tokens(text), &lexicon).into_iter().map(|token| token.text).collect();
    words.join(" ")
}

#[test]
fn subordinate_clauses_become_main_ones() {
    for (said, meant) in [
        (
            "put the egg in the bowl, which goes in the fridge",
            "put the egg in the bowl . the bowl goes in the fridge",
        ),
        ("put the paper, which is old, in the bin", "put the paper in the bin"),
        ("put the egg, since it is off, in the bin", "put the egg in the bin"),
        ("neither the stove nor the tap should be on", "the stove and the tap should not be on"),
        ("robots wash the fork, another the spoon", "robots wash the fork , the spoon"),
        ("the book goes on the bed; so does the pillow", "the book goes on the bed , the pillow"),
        ("put all but the fork away", "put all except the fork away"),
        (
            "valuables - the watch and the keys - go in the safe",
            "valuables , the watch and the keys go in the safe",
        ),
        (
            "cut the bread next to the apple, which you also slice",
            "cut the bread next to the apple , and slice the apple",
        ),
    ] {
        assert_eq!(plain(said), meant);
    }
}

#[test]
fn what_is_plain_already_stays_as_it_is() {
    for said in
        ["put the mug on the table , and the other on the desk", "wash the fork , which is on the desk"]
    {
        assert_eq!(plain(said), said);
    }
}

#[test]
fn what_is_said_in_other_ways_is_put_plainly() {
    for (said, meant) in [
        ("the lamp isn't on", "the lamp is not on"),
        ("once you've cut the bread, toast it", "once you have cut the bread , toast it"),
        ("having washed the cup, dry it", "once you have washed the cup , dry it"),
        ("the bowl can go on the counter", "the bowl should go on the counter"),
        ("I can barely see the book", "i could barely see the book"),
        ("the remote has to lie on the table", "the remote should be on the table"),
        ("make sure that there's soap in the sink", "make sure that soap is in the sink"),
        ("there should be an egg in the pan", "an egg should be in the pan"),
        ("none of the drawers may be open", "no drawers may be open"),
        ("wash the cup that is lying in the sink", "wash the cup that is in the sink"),
        ("a fork placed in the sink", "a fork in the sink"),
        ("put the cup on the shelf where the vase was", "put the cup on the shelf"),
        ("make sure the toilet lid is down", "make sure the toilet lid is closed"),
        ("turn the lamp on if it isn't on already", "turn the lamp on"),
        ("close the box unless it's closed already", "close the box"),
        ("unless the box is open, open it", "if the box is not open , open it"),
        ("put everything else in the box", "put the rest in the box"),
        ("slice the bread that you find on the desk", "slice the bread that is on the desk"),
        ("wash the cup I left in the sink", "wash the cup that is in the sink"),
        ("put the mug, full of water, on the desk", "put the mug full of water on the desk"),
        ("the fridge must contain the egg and the milk", "the egg and the milk should be in the fridge"),
        ("cut the egg and put everything you cut in the bowl", "cut the egg and put all of them in the bowl"),
        ("the bowl which you then put in the sink", "the bowl . put the bowl in the sink"),
    ] {
        assert_eq!(plain(said), meant, "{said}");
    }
}

#[test]
fn words_are_put_in_their_usual_order() {
    for (said, meant) in [
        ("in the drawer go the fork and the spoon", "the fork and the spoon go in the drawer"),
        ("on the plate I want the egg", "i want the egg on the plate"),
        ("the plate I want on the table", "i want the plate on the table"),
        ("instead of leaving the cup in the sink, wash it", "the cup . wash it"),
        ("put the cup on the desk instead of on the bed", "put the cup on the desk"),
        (
            "the book and the pen each get their own shelf",
            "put the book in one shelf , put the pen in another shelf",
        ),
        ("neither the cup nor the mug belongs in the sink", "the cup and the mug should not be in the sink"),
        ("lay the table: a plate and a fork", "lay the table with a plate and a fork"),
    ] {
        assert_eq!(plain(said), meant, "{said}");
    }
}

#[test]
fn what_is_only_spoken_of_asks_for_nothing() {
    for (said, meant) in [
        ("you'll find the pot in the cabinet; fill it", "the pot . fill it"),
        ("no need to wash the plate, just put it away", "the plate . just put it away"),
        ("I don't want the cup on the desk, I want it in the sink", "the cup . i want it in the sink"),
        ("put the following in the box: the cup and the pen", "put the cup and the pen in the box"),
        ("stack these on the desk - cups, plates - and go", "stack cups , plates on the desk and go"),
        ("put my stuff (the phone and the keys) on the desk", "put the phone and the keys on the desk"),
        (
            "the first goes in the drawer, the second on the desk",
            "the former goes in the drawer , the latter on the desk",
        ),
        ("the cup stays where it is", "the cup stays"),
        ("off with the lights", "turn off the lights"),
        ("and do wash the bowl", "and wash the bowl"),
        ("if the lamp is off turn it on", "if the lamp is off , turn it on"),
        (
            "lay it on the plate, with the plate on the table",
            "lay it on the plate , and put the plate on the table",
        ),
        ("everything edible", "all the food"),
        ("bin the egg. Also the apple.", "bin the egg , the apple ."),
        ("the lamp: off", "the lamp off"),
        ("put it on the plate with the egg, also cut", "put it on the plate with the cut egg"),
        ("the table needs a cup and a fork on it", "a cup and a fork should be on the table"),
        ("for breakfast, fry the egg", "fry the egg"),
        ("turn of the lamp", "turn off the lamp"),
        ("no tap may run", "no tap may be on"),
        ("where does the cup go", "put away the cup"),
        ("put all papers in the bin, meaning the news", "put the news in the bin"),
        (
            "wash the cup if it is dirty, otherwise store it",
            "if the cup is dirty , wash it , otherwise store it",
        ),
        ("could the lights be turned off", "the lights should be turned off"),
        ("the salt is needed on the desk", "the salt should be on the desk"),
        ("I could do with a cup", "i want a cup"),
        ("whatever is on the desk", "everything on the desk"),
        ("the cup must be dried and put away", "the cup must be put away"),
        ("put it away once it is clean", "put it away"),
        ("take the cup the plate and the fork", "take the cup , the plate and the fork"),
        ("put the cup on the desk, drawers shut", "put the cup on the desk , drawers should be shut"),
    ] {
        assert_eq!(plain(said), meant, "{said}");
    }
}

#[test]
fn what_is_corrected_or_left_open_is_put_plainly() {
    for (said, meant) in [
        ("put the bear... I mean the statue, on the bed", "put the statue on the bed"),
        ("slice the egg, it doesn't matter which, and go", "slice the egg , and go"),
        (
            "put the first two in the bowl and the last one on the plate",
            "put the former two in the bowl and the latter on the plate",
        ),
        ("the stove should then be on", "the stove should be on"),
        ("the cups should be taken out and put on the desk", "the cups should be put on the desk"),
        ("bring it to me on the plate", "bring it on the plate"),
        ("either slice the apple or the bread", "slice the apple or the bread"),
        ("fold the cloth", "take the cloth"),
        ("it would be nice if the cup was on the desk", "the cup should be on the desk"),
        ("all cups have water in them", "all cups should be filled with water"),
        (
            "bin the egg but the apple shouldn't; it goes in the bowl",
            "bin the egg . the apple . it goes in the bowl",
        ),
        ("wash the cup that's on the desk", "wash the cup that is on the desk"),
        ("put the phone on the desk, next to the clock", "put the phone on the desk next to the clock"),
        ("put the plate away and on the plate lay an egg", "put the plate away . on the plate lay an egg"),
        ("shelves are for books, so move the phone to the desk", "move the phone to the desk"),
    ] {
        assert_eq!(plain(said), meant, "{said}");
    }
}

#[test]
fn who_does_it_is_left_out() {
    for (said, meant) in [
        ("would somebody please rinse the mug", "rinse the mug"),
        ("wash the cup and have another robot switch off the tv", "wash the cup and switch off the tv"),
        ("a third person should throw the cd away", "throw the cd away"),
    ] {
        assert_eq!(plain(said), meant);
    }
}

#[test]
fn places_are_told_by_what_is_there() {
    for (said, meant) in [
        ("the sofa needs the pillow", "the pillow should be in the sofa"),
        ("put the phone where the laptop was", "put the phone in the place of the laptop"),
        (
            "there is a ball on the desk that should be on the floor, a pen on the bed that should be in the mug",
            "a ball on the desk should be on the floor . a pen on the bed should be in the mug",
        ),
        ("the statue joins it", "the statue should go beside it"),
        ("move the box that was there to the sofa", "move the box to the sofa"),
    ] {
        assert_eq!(plain(said), meant);
    }
}

#[test]
fn what_is_put_in_between_changes_nothing() {
    for (said, meant) in [
        ("the clock, though, stays on the desk", "the clock stays on the desk"),
        ("get the mug ready on the counter", "put the mug on the counter"),
        ("cook the potato. when cooked put it on the plate", "cook the potato . then put it on the plate"),
        (
            "the cloth wants rinsing and then goes on the desk",
            "the cloth needs rinsing and then put it on the desk",
        ),
        ("a slice goes in the toaster", "put a slice in the toaster"),
        (
            "the cup is to be washed, the plate put on the table, and the statue left alone",
            "the cup is to be washed , the plate should be put on the table",
        ),
    ] {
        assert_eq!(plain(said), meant);
    }
}

#[test]
fn slips_that_are_words_are_mended() {
    for (said, meant) in [
        ("take the pen and put in on the desk", "take the pen and put it on the desk"),
        ("put in it the drawer", "put it in the drawer"),
        ("move to forks to the sink", "move two forks to the sink"),
        ("the over cooked egg", "the cooked egg"),
        ("put the cup in the fridge, then the sink", "put the cup in the fridge , then put it in the sink"),
        (
            "move the pot to the fridge and to the stove",
            "move the pot to the fridge and then put it to the stove",
        ),
        ("move the cup from the fridge to the sink", "move the cup from the fridge to the sink"),
        ("move to the sink", "move to the sink"),
    ] {
        assert_eq!(plain(said), meant);
    }
}
