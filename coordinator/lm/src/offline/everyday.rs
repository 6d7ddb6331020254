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
    everyday.lids();
    everyday.cuts();
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
        let said = words.iter().map(|word| Token { text: (*word).to_owned(), typed: (*word).to_owned() });
        self.tokens.splice(from..to, said);
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
        ] {
            let words: Vec<String> =
                plainer(text::tokens(said), &lexicon).into_iter().map(|token| token.text).collect();
            assert_eq!(words.join(" ").trim_end_matches(" ."), plain);
        }
    }
}
