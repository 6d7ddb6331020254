//! What is complained of or feared, put as what is asked for: "who left the fridge open?" is "close the fridge", and
//! "…, before it gets broken" breaks nothing.
//!
//! Read word by word, both ask for the opposite of what is meant; so they go before anything else is read.

use super::lexicon::{LONGEST, Lexicon};
use super::scene::Scene;
use super::syntax::is_determiner;
use super::text::Token;

mod misplaced;

/// Who is blamed.
const BLAMED: [&str; 10] =
    ["who", "whoever", "which", "what", "why", "some", "someone", "somebody", "youve", "you"];

/// What is left so.
const LEFT: [&str; 4] = ["left", "leaves", "leaving", "leave"];

/// That something is so longer or more often than it should.
const EVER: [&str; 6] = ["still", "always", "again", "constantly", "forever", "permanently"];

/// What may stand before how something was left.
const HOW: [&str; 12] = [
    "wide",
    "hanging",
    "standing",
    "fully",
    "all",
    "half",
    "still",
    "always",
    "switched",
    "turned",
    "gaping",
    "constantly",
];

/// What may follow "on" and "up" where they say how something was left, and no place.
const BEHIND: [&str; 15] = [
    "again",
    "all",
    "overnight",
    "for",
    "since",
    "when",
    "while",
    "at",
    "this",
    "last",
    "and",
    "but",
    "so",
    "in",
    "every",
];

/// What is feared follows one of these.
const BEFORE: [&str; 7] = ["before", "lest", "or", "otherwise", "else", "so", "case"];

/// Of whom or what it is feared.
const SUBJECTS: [&str; 19] = [
    "it",
    "they",
    "this",
    "that",
    "these",
    "those",
    "someone",
    "somebody",
    "anyone",
    "anybody",
    "nobody",
    "noone",
    "nothing",
    "everything",
    "we",
    "i",
    "he",
    "she",
    "you",
];

/// What an instruction asks for without its complaints and fears, and the fears.
pub fn mended(tokens: Vec<Token>, lexicon: &Lexicon, scene: &Scene<'_>) -> (Vec<Token>, Vec<String>) {
    let mut complaint = Complaint { tokens, lexicon, scene };
    let fears = complaint.leave_out_fears();
    complaint.put_right();
    (complaint.tokens, fears)
}

struct Complaint<'a> {
    tokens: Vec<Token>,
    lexicon: &'a Lexicon,
    scene: &'a Scene<'a>,
}

impl Complaint<'_> {
    fn at(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    fn is_mark(&self, index: usize) -> bool {
        index >= self.tokens.len() || [",", "."].contains(&self.at(index))
    }

    /// Where the part that begins here ends.
    fn end(&self, from: usize) -> usize {
        (from..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len())
    }

    fn has(&self, from: usize, to: usize, any: &[&str]) -> bool {
        (from..to).any(|at| any.contains(&self.at(at)))
    }

    /// Leaves out what is feared: "before it gets wet", "so nobody trips over it", "or it will go off".
    fn leave_out_fears(&mut self) -> Vec<String> {
        let mut fears = Vec::new();
        let mut index = 0;
        while index < self.tokens.len() {
            match self.fear(index) {
                Some((from, to)) => {
                    let words: Vec<&str> = (from..to).map(|at| self.at(at)).collect();
                    fears.push(words.join(" "));
                    self.tokens.drain(from..to);
                    // The comma before it, where another mark follows, or the one behind what is said first.
                    let first = from == 0 || self.at(from - 1) == ".";
                    if first && self.at(from) == "," {
                        self.tokens.remove(from);
                    } else if from > 0 && self.at(from - 1) == "," && self.is_mark(from) {
                        self.tokens.remove(from - 1);
                    }
                    index = from;
                }
                None => index += 1,
            }
        }
        fears
    }

    /// From where to where something is feared that begins with a word.
    fn fear(&self, index: usize) -> Option<(usize, usize)> {
        let opens = self.at(index);
        let before = index.checked_sub(1).map_or(".", |before| self.at(before));
        // "before it gets wet, turn it off"
        let first = before == "." && opens == "before";
        if !BEFORE.contains(&opens) || before == "." && !first || opens == "case" && before != "in" {
            return None;
        }
        let from = index - usize::from(opens == "case");
        let subject = index + 1 + usize::from(["that", "else"].contains(&self.at(index + 1)));
        // "before you turn off the lamp" is what a robot does.
        let named = self.at(subject) != "you"
            && (SUBJECTS.contains(&self.at(subject)) || is_determiner(self.at(subject)));
        let to = self.fear_end(subject);
        let denies =
            ["not", "wont", "doesnt", "dont", "cant", "cannot", "never", "nobody", "noone", "nothing", "no"];
        let threat = ["will", "might", "could", "may", "ill", "itll", "theyll", "is", "gets", "goes"];
        let fits = match opens {
            "so" => self.has(subject, to, &denies),
            "or" | "otherwise" | "else" => {
                self.has(subject, to, &threat)
                    || (subject..to).any(|at| self.tokens[at].typed.ends_with("'ll"))
            }
            _ => true,
        };
        let feared = (subject + 1..to).any(|at| self.lexicon.is_small("mishaps", &[self.at(at)]));
        (named && fits && feared && (!first || self.at(to) == ",")).then_some((from, to))
    }

    /// Where what is feared ends: at a mark, or before another order.
    fn fear_end(&self, from: usize) -> usize {
        let end = self.end(from);
        let order = |at: usize| {
            self.at(at) == "and"
                && (self.at(at + 1) == "then"
                    || !self.lexicon.verbs(self.at(at + 1)).is_empty()
                        && (is_determiner(self.at(at + 2)) || ["it", "them"].contains(&self.at(at + 2))))
        };
        (from..end).find(|&at| order(at)).unwrap_or(end)
    }

    /// Says of each thing that was left as it should not be what is to be done to it.
    fn put_right(&mut self) {
        let mut from = 0;
        while from < self.tokens.len() {
            let to = self.end(from);
            let so = self.left_so(from, to).or_else(|| self.is_so(from, to));
            match so.or_else(|| self.cannot_with(from, to)) {
                Some((verb, thing, state)) => {
                    let mut said: Vec<Token> = verb.split(' ').map(Token::said).collect();
                    said.extend_from_slice(&self.tokens[thing..state]);
                    let length = said.len();
                    self.tokens.splice(from..to, said);
                    from += length + 1;
                }
                None => from = self.put_away(from, to) + 1,
            }
        }
    }

    /// "who left the mug in the sink?": it is to be put away; where the part ends then.
    fn put_away(&mut self, from: usize, to: usize) -> usize {
        let Some(misplaced) = self.misplaced(from, to) else { return to };
        let mut said = vec![Token::said("put"), Token::said("away")];
        said.extend_from_slice(&self.tokens[misplaced.thing]);
        said.push(Token::said("from"));
        said.extend_from_slice(&self.tokens[misplaced.place]);
        let end = from + said.len();
        self.tokens.splice(from..to, said);
        end
    }

    /// "which of you left the lid up?": what mends it, and from where to where the thing is named.
    fn left_so(&self, from: usize, to: usize) -> Option<(&'static str, usize, usize)> {
        let start = (from..to).find(|&at| BLAMED.contains(&self.at(at)))?;
        let left = (start + 1..to).find(|&at| LEFT.contains(&self.at(at)))?;
        // "you leave the door open": that may be an order.
        let blames = match self.at(start) {
            "you" | "youve" => {
                ["left", "leaving"].contains(&self.at(left)) || self.has(start, left, &["always"])
            }
            "what" | "some" => left > start + 1 && left < start + 4,
            "who" | "which" | "why" | "whoever" => left < start + 7,
            _ => self.at(left) != "leave" && left < start + 4,
        };
        let asks = self.has(from, left, &["if", "can", "could", "should", "want", "please"]);
        if !blames || asks || start > from + 3 {
            return None;
        }
        self.mended_state(left + 1, to)
    }

    /// "why is the lid always up?", "the lamp is still on": as above.
    fn is_so(&self, from: usize, to: usize) -> Option<(&'static str, usize, usize)> {
        let why = self.at(from) == "why" || self.at(from) == "how" && self.at(from + 1) == "come";
        if why {
            let be = (from + 1..to.min(from + 6)).find(|&at| ["is", "are", "s"].contains(&self.at(at)))?;
            let thing = if is_determiner(self.at(be + 1)) { be + 1 } else { from + 2 };
            return self.mended_state(thing, to);
        }
        let be = (from + 2..to.min(from + 6)).find(|&at| ["is", "are"].contains(&self.at(at)))?;
        let ever = self.has(be, to, &EVER) && is_determiner(self.at(from));
        if !ever || self.has(from, to, &["if", "should", "not"]) {
            return None;
        }
        let (verb, thing, _) = self.mended_state(from, to)?;
        Some((verb, thing, be))
    }

    /// "I can't sleep with the lamp on", "I hate it when the lid is left open": as above.
    fn cannot_with(&self, from: usize, to: usize) -> Option<(&'static str, usize, usize)> {
        let dislikes =
            ["hate", "hates", "stand", "annoys", "annoying", "bugs", "sick", "tired", "fed", "angry"];
        if let Some(hates) = (from..to).find(|&at| dislikes.contains(&self.at(at))) {
            let when =
                (hates + 1..to).find(|&at| ["when", "that", "how", "if", "of"].contains(&self.at(at)))?;
            return self.mended_state(when + 1, to);
        }
        let cannot = ["cant", "cannot", "couldnt", "impossible", "hard", "hopeless"];
        let start = (from..to).find(|&at| cannot.contains(&self.at(at)))?;
        let with = (start + 2..to).find(|&at| self.at(at) == "with")?;
        self.mended_state(with + 1, to)
    }

    /// What mends the state that is told at the end of some words, of the thing that they begin with.
    fn mended_state(&self, thing: usize, to: usize) -> Option<(&'static str, usize, usize)> {
        let state = (thing + 1..to).find(|&at| self.is_state(at, to))?;
        let verb = self.mends(self.at(state), thing, state)?;
        let skipped = |at: &usize| {
            HOW.contains(&self.at(*at))
                || EVER.contains(&self.at(*at))
                || ["is", "are", "left"].contains(&self.at(*at))
        };
        let end = (thing + 1..=state).rev().find(|end| !skipped(&(end - 1)))?;
        (end > thing).then_some((verb, thing, end))
    }

    /// Whether a word says how something is, and not where.
    fn is_state(&self, at: usize, to: usize) -> bool {
        match self.at(at) {
            "open" | "ajar" | "unlocked" | "running" | "burning" | "blaring" | "shut" | "closed" => true,
            "on" | "up" | "down" | "off" => at + 1 >= to || BEHIND.contains(&self.at(at + 1)),
            _ => false,
        }
    }

    /// What is to be done to a thing that is so and should not be.
    fn mends(&self, state: &str, thing: usize, end: usize) -> Option<&'static str> {
        let kinds = (thing..end).rev().find_map(|at| {
            let longest = LONGEST.min(at + 1 - thing);
            (1..=longest).rev().find_map(|length| {
                let words: Vec<&str> = (at + 1 - length..=at).map(|at| self.at(at)).collect();
                self.lexicon.noun(&words).map(|(noun, _)| noun.kinds.as_slice())
            })
        })?;
        let affords = |affordance: &str| {
            kinds.iter().any(|kind| {
                self.scene.affords(kind, affordance)
                    || affordance == "toggleable" && self.lexicon.control(kind).is_some()
            })
        };
        match state {
            "on" | "running" | "burning" | "blaring" => affords("toggleable").then_some("turn off"),
            "off" => affords("toggleable").then_some("turn on"),
            "down" | "shut" | "closed" => affords("openable").then_some("open"),
            _ => affords("openable").then_some("close"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::text;
    use super::*;
    use crate::ObjectView;

    fn read(said: &str) -> String {
        let lexicon = Lexicon::embedded().unwrap();
        let view = |kind: &str, affordance: &str| ObjectView {
            name: format!("{kind}_1"),
            kind: kind.to_owned(),
            affordances: vec![affordance.to_owned()],
            ..ObjectView::default()
        };
        let objects =
            [view("Fridge", "openable"), view("Toilet", "openable"), view("FloorLamp", "toggleable")];
        let scene = Scene::new(&objects, &[]);
        let (tokens, _) = mended(text::tokens(said), &lexicon, &scene);
        tokens.into_iter().map(|token| token.text).collect::<Vec<_>>().join(" ").replace(" .", "")
    }

    #[test]
    fn a_complaint_asks_for_the_opposite() {
        assert_eq!(read("Who left the fridge wide open?"), "close the fridge");
        assert_eq!(read("Which clown left the toilet lid up again?"), "close the toilet lid");
        assert_eq!(read("why is the floor lamp always on"), "turn off the floor lamp");
        assert_eq!(read("I hate it when the toilet lid is left open."), "close the toilet lid");
        assert_eq!(read("I can't sleep with the floor lamp on."), "turn off the floor lamp");
        assert_eq!(read("You leave the fridge open."), "you leave the fridge open");
        assert_eq!(read("who left the mug on the fridge"), "who left the mug on the fridge");
    }

    #[test]
    fn what_is_feared_is_no_order() {
        assert_eq!(read("close the fridge before it gets warm"), "close the fridge");
        assert_eq!(read("wash the egg before it gets sliced"), "wash the egg before it gets sliced");
        assert_eq!(
            read("close the fridge so nothing goes off, then open it"),
            "close the fridge , then open it"
        );
    }
}
