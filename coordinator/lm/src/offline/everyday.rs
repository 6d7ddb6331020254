//! Everyday ways to say what has a plainer verb: "put the loo seat down" is "close", "the lid of the laptop" is the
//! laptop, and "a slice off the loaf" is one of it.

use super::lexicon::{LONGEST, Lexicon};
use super::syntax::is_determiner;
use super::text::Token;

/// What moves a lid.
const MOVES: [&str; 18] = [
    "put", "drop", "flip", "bring", "pull", "push", "set", "pop", "let", "lower", "shut", "close", "raise",
    "lift", "open", "leave", "get", "fold",
];

/// What a lid is called.
const LIDS: [&str; 6] = ["lid", "cover", "flap", "flaps", "seat", "top"];

/// What is cut off something.
const CUTS: [&str; 12] = [
    "slice", "slices", "piece", "pieces", "chunk", "chunks", "bit", "bits", "wedge", "sliver", "hunk", "half",
];

/// The same in plainer words.
pub fn plainer(tokens: Vec<Token>, lexicon: &Lexicon) -> Vec<Token> {
    let mut everyday = Everyday { tokens, lexicon };
    everyday.nobody();
    everyday.over_to_me();
    everyday.once_over();
    everyday.thirsty_plants();
    everyday.lids();
    everyday.cuts();
    everyday.until_it_is_done();
    everyday.with_it_there();
    everyday.where_it_lives();
    everyday.tokens
}

struct Everyday<'a> {
    tokens: Vec<Token>,
    lexicon: &'a Lexicon,
}

impl Everyday<'_> {
    fn at(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    fn say(&mut self, from: usize, to: usize, words: &[&str]) {
        self.tokens.splice(from..to, words.iter().map(|word| Token::said(word)));
    }

    /// How many words at a place name what is closed by its lid ("the loo seat"), or a lid of something ("the lid of
    /// the laptop").
    fn lid(&self, index: usize) -> Option<usize> {
        let from = index + usize::from(is_determiner(self.at(index)));
        let longest = LONGEST.min(self.tokens.len().saturating_sub(from));
        (1..=longest).rev().find_map(|length| {
            let words: Vec<&str> = (from..from + length).map(|at| self.at(at)).collect();
            let lidded = |kind: &String| self.lexicon.is_small("lids", &[&kind.to_lowercase()]);
            let named =
                self.lexicon.noun(&words).is_some_and(|(noun, _)| noun.kinds.first().is_some_and(lidded));
            named.then_some(from + length - index)
        })
    }

    /// "put the loo seat down", "lower the lid of the laptop": close it.
    fn lids(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            if MOVES.contains(&self.at(index)) {
                self.lid_of(index);
                self.seat(index);
            }
            index += 1;
        }
    }

    /// "put the lid of the box down": said of the box.
    fn lid_of(&mut self, verb: usize) {
        let way = usize::from(["down", "up"].contains(&self.at(verb + 1)));
        let lid = verb + 1 + way + usize::from(is_determiner(self.at(verb + 1 + way)));
        let of = ["of", "on"].contains(&self.at(lid + 1)) && is_determiner(self.at(lid + 2));
        let moved = match self.at(verb) {
            "raise" | "lift" | "open" => "open",
            "lower" | "shut" | "close" | "drop" | "fold" => "close",
            _ if self.at(verb + 1) == "down" => "close",
            _ if self.at(verb + 1) == "up" => "open",
            "pull" | "push" | "bring" | "put" if self.goes(lid, "down") => "close",
            "pull" | "push" | "flip" if self.goes(lid, "up") => "open",
            _ => return,
        };
        if LIDS.contains(&self.at(lid)) && lid > verb + 1 && of {
            if let Some(down) = (lid + 3..lid + 7).find(|&at| ["down", "up"].contains(&self.at(at))) {
                self.say(down, down + 1, &[]);
            }
            self.say(verb, lid + 2, &[moved]);
        }
    }

    /// Whether what is named behind a place is said to go up or down.
    fn goes(&self, from: usize, way: &str) -> bool {
        (from + 3..from + 7).any(|at| self.at(at) == way)
    }

    /// "drop the loo lid", "put the toilet seat up".
    fn seat(&mut self, verb: usize) {
        let before = usize::from(["down", "up"].contains(&self.at(verb + 1)));
        let Some(length) = self.lid(verb + 1 + before) else { return };
        let end = verb + 1 + before + length;
        let behind = usize::from(["down", "up"].contains(&self.at(end)));
        let way = if before == 1 { self.at(verb + 1) } else { self.at(end) };
        let moved = match (way, self.at(verb)) {
            ("down", _) | (_, "drop") => "close",
            ("up", _) | (_, "lift") => "open",
            _ => return,
        };
        self.say(end, end + behind, &[]);
        self.say(verb, verb + 1 + before, &[moved]);
    }

    /// "cut me a slice off the loaf": of it.
    fn cuts(&mut self) {
        for index in 1..self.tokens.len() {
            let off = ["off", "from"].contains(&self.at(index)) && is_determiner(self.at(index + 1));
            if !off || !CUTS.contains(&self.at(index - 1)) {
                continue;
            }
            let start = index.saturating_sub(6);
            let cuts =
                (start..index).any(|at| ["cut", "slice", "hack", "saw", "carve"].contains(&self.at(at)));
            let sliced = self.lexicon.noun(&[self.at(index + 2)]).is_some();
            if cuts && sliced {
                self.say(index, index + 1, &["of"]);
            }
        }
    }
}

impl Everyday<'_> {
    fn is_mark(&self, index: usize) -> bool {
        index >= self.tokens.len() || [",", "."].contains(&self.at(index))
    }

    /// "no one": nobody.
    fn nobody(&mut self) {
        for index in (1..self.tokens.len()).rev() {
            let one = self.at(index - 1) == "no" && self.at(index) == "one";
            if one && self.at(index + 1) != "of" {
                let typed = self.tokens[index].typed.replace("one", "nobody");
                self.tokens.remove(index);
                self.tokens[index - 1] = Token { text: "nobody".to_owned(), typed };
            }
        }
    }

    /// "chuck us the pillow": give it to me.
    fn over_to_me(&mut self) {
        const THROWS: [&str; 9] =
            ["chuck", "throw", "toss", "sling", "lob", "fling", "shove", "slide", "bung"];
        for index in 0..self.tokens.len() {
            let opens =
                index == 0 || self.is_mark(index - 1) || ["and", "then"].contains(&self.at(index - 1));
            if opens
                && THROWS.contains(&self.at(index))
                && ["us", "me"].contains(&self.at(index + 1))
                && (is_determiner(self.at(index + 2)) || ["over"].contains(&self.at(index + 2)))
            {
                self.say(index, index + 2, &["give", "me"]);
            }
        }
    }

    /// "give the mirror a once-over": a wipe.
    fn once_over(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let good = usize::from(["good", "quick", "proper", "thorough"].contains(&self.at(index)));
            let over =
                self.at(index + good + 1) == "over" && ["once", "going"].contains(&self.at(index + good));
            if self.at(index - 1) == "a" && over {
                self.say(index, index + good + 2, &["wipe"]);
            }
            index += 1;
        }
    }

    /// "the flowers need a drink": water them.
    fn thirsty_plants(&mut self) {
        const NEEDS: [&str; 7] = ["need", "needs", "want", "wants", "could", "deserve", "deserves"];
        let mut from = 0;
        while from < self.tokens.len() {
            let end = (from..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len());
            let needs = (from + 1..end).find(|&at| NEEDS.contains(&self.at(at)));
            let water = |at: usize| ["drink", "water", "watering", "drop"].contains(&self.at(at));
            if let Some(needs) = needs.filter(|&needs| (needs..end).any(water))
                && let Some(plant) = (from..needs).find(|&at| self.is_plant(at, needs))
            {
                self.say(needs, end, &[]);
                self.say(from, plant, &["water"]);
                from = plant + 1;
                continue;
            }
            from = end + 1;
        }
    }

    /// Whether the words up to a place name a plant, with what stands before its name.
    fn is_plant(&self, from: usize, to: usize) -> bool {
        let start = from + usize::from(is_determiner(self.at(from)));
        let words: Vec<&str> = (start..to).map(|at| self.at(at)).collect();
        let last = words.split_last().map(|(last, _)| *last).unwrap_or_default();
        [words.as_slice(), &[last]].iter().any(|words| {
            words.len() <= LONGEST
                && self
                    .lexicon
                    .noun(words)
                    .is_some_and(|(noun, _)| noun.kinds.first().is_some_and(|kind| kind == "HousePlant"))
        })
    }

    /// "nuke the spud till it's done": cook it.
    fn until_it_is_done(&mut self) {
        const DONE: [&str; 6] = ["cooked", "done", "tender", "soft", "edible", "baked"];
        const HEATS: [&str; 14] = [
            "nuke",
            "microwave",
            "zap",
            "heat",
            "oven",
            "pan",
            "stove",
            "boil",
            "hob",
            "cooker",
            "warm",
            "bung",
            "fry",
            "simmer",
        ];
        let mut index = 2;
        while index < self.tokens.len() {
            let end = (index..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len());
            let start = (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1);
            let it = ["it", "they", "its", "theyre", "thats"].contains(&self.at(index + 1));
            let done = (index + 2..end).any(|at| DONE.contains(&self.at(at)));
            let heat = (start..index).find(|&at| HEATS.contains(&self.at(at)));
            if ["until", "till", "til"].contains(&self.at(index))
                && it
                && done
                && end < index + 7
                && let Some(heat) = heat
            {
                if ["nuke", "microwave", "zap", "heat", "boil", "warm"].contains(&self.at(heat))
                    && heat <= start + 2
                {
                    self.say(index, end, &[]);
                    let up = usize::from(self.at(heat + 1) == "up");
                    self.say(heat, heat + 1 + up, &["cook"]);
                } else {
                    self.say(index, end, &["and", "cook", "it"]);
                }
            }
            index += 1;
        }
    }

    /// "get the coffee maker going with my mug underneath": the mug is put there.
    fn with_it_there(&mut self) {
        const THERE: [&str; 6] = ["in", "inside", "under", "underneath", "beneath", "below"];
        let mut index = 3;
        while index + 2 < self.tokens.len() {
            let start = (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1);
            let runs = (start..index).any(|at| {
                let words: Vec<&str> = (at..(at + 2).min(index)).map(|at| self.at(at)).collect();
                let brews =
                    |kind: &String| ["CoffeeMachine", "Microwave", "Toaster"].contains(&kind.as_str());
                self.lexicon.noun(&words).is_some_and(|(noun, _)| noun.kinds.first().is_some_and(brews))
            });
            let starts =
                (start..index).any(|at| ["start", "going", "on", "run", "running"].contains(&self.at(at)));
            let there = (index + 2..index + 6).find(|&at| THERE.contains(&self.at(at)));
            if self.at(index) == "with"
                && is_determiner(self.at(index + 1))
                && runs
                && starts
                && let Some(there) = there
            {
                let it = usize::from(self.at(there + 1) == "it");
                if self.is_mark(there + 1 + it) {
                    self.say(there, there + 1 + it, &["in", "it"]);
                    self.say(index, index + 1, &["and", "put"]);
                }
            }
            index += 1;
        }
    }

    /// "they live in the cupboard, put them back": what is said first says where.
    fn where_it_lives(&mut self) {
        let mut from = 0;
        while from < self.tokens.len() {
            let end = (from..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len());
            let lives =
                (from + 1..end).any(|at| ["live", "lives", "belong", "belongs"].contains(&self.at(at)));
            let and = usize::from(["so", "and"].contains(&self.at(end + 1)));
            let put = end + 1 + and;
            if lives
                && ["put", "pop", "return", "stick"].contains(&self.at(put))
                && ["it", "them", "both"].contains(&self.at(put + 1))
                && ["back", "away", "there"].contains(&self.at(put + 2))
                && self.is_mark(put + 3)
            {
                self.say(end, put + 3, &[]);
            }
            from = end + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::text;
    use super::*;

    #[test]
    fn everyday_words_become_plain_ones() {
        let lexicon = Lexicon::embedded().unwrap();
        for (said, plain) in [
            ("put the loo seat down", "close the loo seat"),
            ("drop the toilet lid", "close the toilet lid"),
            ("flip up the toilet seat", "open the toilet seat"),
            ("lower the lid on my laptop", "close my laptop"),
            ("pull the lid of the laptop down", "close the laptop"),
            ("put the lid on the pot", "put the lid on the pot"),
            ("cut a slice off the loaf", "cut a slice of the loaf"),
            ("take the mug off the shelf", "take the mug off the shelf"),
            ("the flowers need a drink", "water the flowers"),
            ("chuck us the pillow", "give me the pillow"),
            ("give the mirror a once over", "give the mirror a wipe"),
            ("nuke the spud until it's done", "cook the spud"),
            (
                "get the coffee maker going with my mug underneath",
                "get the coffee maker going and put my mug in it",
            ),
            ("the plates live in the cupboard, put them back", "the plates live in the cupboard"),
        ] {
            let words: Vec<String> =
                plainer(text::tokens(said), &lexicon).into_iter().map(|token| token.text).collect();
            assert_eq!(words.join(" ").trim_end_matches(" ."), plain);
        }
    }
}
