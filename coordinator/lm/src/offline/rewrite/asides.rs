//! Words put in between that change nothing: ", though,", "straight into the bin", "get the mug ready on the counter".

use super::{LONGEST_ASIDE, Rewriting};
use crate::offline::syntax::is_determiner;

/// Between commas they only link what is said to what was said.
const BETWEEN: [&[&str]; 7] = [
    &["though"],
    &["however"],
    &["in", "turn"],
    &["meanwhile"],
    &["of", "course"],
    &["as", "usual"],
    &["for", "its", "part"],
];

impl Rewriting<'_> {
    /// Leaves them out.
    pub(super) fn words_between(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let word = self.at(index).to_owned();
            if ["till", "til"].contains(&word.as_str()) {
                self.say(index, index + 1, &["until"]);
            } else if word == "," && index > 0 && self.noun_before(index).is_some() {
                let length = self.one_of(index + 1, &BETWEEN).unwrap_or(0);
                let end = self.next_mark(index + 1, &[",", "."]);
                let being = (index + 2..end).any(|at| self.at(at) == "being");
                if length > 0 && self.at(index + 1 + length) == "," {
                    self.say(index, index + 2 + length, &[]);
                } else if self.starts(index + 1, &["as", "opposed", "to"]) && self.at(end) == "," {
                    self.say(index, end + 1, &[]);
                } else if being && self.at(end) == "," && end - index <= LONGEST_ASIDE {
                    self.say(index, end, &[]);
                }
            } else if ["straight", "directly", "right"].contains(&word.as_str())
                && ["into", "in", "onto", "to"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
            } else if word == "ready"
                && index > 0
                && self.noun_before(index).is_some()
                && ["on", "in"].contains(&self.at(index + 1))
            {
                self.say(index, index + 1, &[]);
                if let Some(get) = (index.saturating_sub(4)..index).rev().find(|&at| self.at(at) == "get") {
                    self.say(get, get + 1, &["put"]);
                }
            } else if self.starts(index, &["the", "following", "done"]) && self.at(index + 3) == "," {
                // "I need the following done: …"
                let start = self.clause_start(index);
                self.say(start, index + 4, &[]);
                index = start;
                continue;
            } else if word == "down"
                && index > 1
                && ["wiped", "washed", "cleaned", "scrubbed", "dusted"].contains(&self.at(index - 1))
                && self.is_mark(index + 1)
            {
                self.say(index, index + 1, &[]);
            } else if ["wants", "want"].contains(&word.as_str())
                && index > 0
                && self.noun_before(index).is_some()
                && (self.starts(index + 1, &["to", "be"])
                    || self.at(index + 1) == "a" && self.is_base_verb(index + 2)
                    || self.at(index + 1).ends_with("ing")
                        && !self.lexicon.verbs(self.at(index + 1)).is_empty())
            {
                self.say(index, index + 1, &["needs"]);
            } else if self.starts(index, &["out", "with"])
                && is_determiner(self.at(index + 2))
                && (index == 0 || [",", ".", "and", "then", "while", "please"].contains(&self.at(index - 1)))
            {
                let end = self.next_mark(index, &[",", "."]);
                let from = (index..end).any(|at| ["of", "from"].contains(&self.at(at)));
                self.say(index, index + 2, if from { &["take", "out"] } else { &["throw", "away"] });
            }
            index += 1;
        }
    }
}
