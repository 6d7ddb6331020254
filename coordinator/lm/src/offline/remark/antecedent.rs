//! What is told of a thing before it is asked for by a pronoun: "That cloth stinks. Wash it." is "Wash that cloth."

use super::super::syntax::is_determiner;
use super::super::text::Token;
use super::{Part, Remarks, telling};

/// What may stand for a thing that was spoken of.
const PRONOUNS: [&str; 8] = ["it", "them", "that", "those", "these", "they", "both", "this"];

/// What asks or tells where something is, and that it is there.
const SPOKEN_OF: [&[&str]; 17] = [
    &["my", "turn"],
    &["where", "is"],
    &["where", "are"],
    &["why", "is", "there"],
    &["why", "are", "there"],
    &["why", "is"],
    &["why", "are"],
    &["there", "is"],
    &["there", "are"],
    &["is", "there"],
    &["are", "there"],
    &["somebody", "left"],
    &["someone", "left"],
    &["somebody", "has", "left"],
    &["someone", "has", "left"],
    &["i", "left"],
    &["i", "see"],
];

impl Remarks<'_> {
    /// Leaves out what is told of things, and names them where a pronoun stands for them.
    pub(super) fn name_what_is_told_of(mut self) -> Vec<Token> {
        let mut told: Vec<Vec<Token>> = Vec::new();
        let mut at = 0;
        loop {
            let parts = self.parts();
            let Some(&part) = parts.get(at) else { break };
            if let Some(things) = self.told_of(part, told.is_empty()) {
                let end = part.to + usize::from(part.to < self.tokens.len());
                let rest = parts.get(at + 1).is_some();
                if rest {
                    told.push(self.tokens[things.from..things.to].to_vec());
                    self.tokens.drain(part.from..end);
                    continue;
                }
            } else if !told.is_empty() && self.says_where_it_is(part) {
                let end = part.to + usize::from(part.to < self.tokens.len());
                self.tokens.drain(part.from..end);
                continue;
            } else if !told.is_empty()
                && let Some(pronoun) = self.pronoun(part)
            {
                let joined = Token { text: "and".to_owned(), typed: String::new() };
                let things = std::mem::take(&mut told).join(&joined);
                self.tokens.splice(pronoun..=pronoun, things);
            } else if self.names_a_thing(part) {
                told.clear();
            }
            at += 1;
        }
        self.tokens
    }

    /// "it is on some shelf": no more than where.
    fn says_where_it_is(&self, part: Part) -> bool {
        let words = telling::spelled_out(&self.tokens[part.from..part.to]);
        let said: Vec<&str> = words.iter().map(String::as_str).collect();
        matches!(said.as_slice(), ["it", "is", "in" | "on", ..] | ["they", "are", "in" | "on", ..])
    }

    /// The first word that stands for what was spoken of.
    fn pronoun(&self, part: Part) -> Option<usize> {
        (part.from..part.to).find(|&at| {
            let next = self.at(at + 1);
            let alone =
                at + 1 >= part.to || !is_determiner(next) && self.thing(at + 1).is_none() && next != "one";
            PRONOUNS.contains(&self.at(at)) && (["it", "them"].contains(&self.at(at)) || alone)
        })
    }

    /// The thing that a part tells of: "that cloth in the tub stinks", "where is my pen", "my phone is in a drawer".
    fn told_of(&self, part: Part, first: bool) -> Option<Part> {
        let words = telling::spelled_out(&self.tokens[part.from..part.to]);
        // "Phone. It is on a shelf."
        let alone = self.thing(part.from).is_some_and(|length| part.from + length == part.to);
        if alone && self.at(part.to) == "." {
            return Some(part);
        }
        let said: Vec<&str> = words.iter().map(String::as_str).collect();
        let person = telling::person(&words, &[], self.lexicon).is_some() || said[0] == "whoever";
        let wished = [
            "want", "wants", "need", "needs", "like", "love", "should", "must", "will", "prefer", "to",
            "says", "said", "told", "asked",
        ];
        let someone = person && !words.iter().any(|word| wished.contains(&word.as_str()));
        let asks = someone
            || SPOKEN_OF.iter().any(|spoken| said.starts_with(spoken))
            || self.at(part.to) == "." && said[0] == "where";
        let start = (part.from..part.to).find(|&at| self.thing(at).is_some())?;
        let bare =
            start == part.from && self.typed(start + 1).starts_with('\'') || self.at(start + 1) == "'s";
        let from = (part.from..start).rev().find(|&at| is_determiner(self.at(at)));
        let from = from.or((start == part.from && bare).then_some(start))?;
        if start - from > 3 {
            return None;
        }
        let to = start + self.thing(start)?;
        let opens =
            from == part.from || from == part.from + 1 && ["and", "so", "but"].contains(&self.at(part.from));
        let behind = telling::spelled_out(&self.tokens[to..part.to]);
        let place = self.place_behind(to, part.to);
        if asks {
            return Some(Part { from, to: place });
        }
        if !opens {
            return None;
        }
        // "my pen? my pencil?"
        let bare = !first && to == part.to && self.typed(to) == "?";
        let tells = telling::tells_of_a_thing(&behind, self.lexicon)
            || place > to
                && telling::tells_of_a_thing(
                    &telling::spelled_out(&self.tokens[place..part.to]),
                    self.lexicon,
                );
        (bare || tells).then_some(Part { from, to: if bare { to } else { place } })
    }

    /// Where the place ends that stands behind a thing: "(that cloth) in the tub".
    fn place_behind(&self, at: usize, end: usize) -> usize {
        let placed = ["in", "on", "from", "inside"].contains(&self.at(at)) && is_determiner(self.at(at + 1));
        let thing = (at + 2..end.min(at + 4)).find_map(|at| self.thing(at).map(|length| at + length));
        thing.filter(|_| placed).unwrap_or(at)
    }
}
