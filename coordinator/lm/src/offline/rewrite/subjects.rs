//! Who of a team does it, which no order need say: "another the spoon", "a colleague should …", "by a second robot".

use super::Rewriting;
use crate::offline::syntax::is_determiner;

/// What one of a team is called.
const MEMBERS: [&str; 16] = [
    "robot",
    "agent",
    "unit",
    "bot",
    "helper",
    "teammate",
    "colleague",
    "partner",
    "worker",
    "assistant",
    "member",
    "droid",
    "mate",
    "person",
    "companion",
    "comrade",
];

/// What may stand between an article and who it is.
const WHICH: [&str; 16] = [
    "idle",
    "free",
    "different",
    "other",
    "first",
    "second",
    "third",
    "fourth",
    "spare",
    "available",
    "team",
    "single",
    "next",
    "further",
    "remaining",
    "fellow",
];

impl Rewriting<'_> {
    /// "another the spoon", "a third should …": somebody does it, and no matter who.
    pub(super) fn subjects(&mut self) {
        const WHO: [&[&str]; 17] = [
            &["one", "robot"],
            &["a", "robot"],
            &["another", "robot"],
            &["the", "other", "robot"],
            &["somebody"],
            &["one", "of", "you"],
            &["one", "of", "them"],
            &["another", "of", "you"],
            &["a", "second", "one"],
            &["a", "third", "one"],
            &["a", "second"],
            &["a", "third"],
            &["a", "fourth"],
            &["the", "second"],
            &["the", "third"],
            &["another"],
            &["the", "other"],
        ];
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = index == 0 || [",", ".", "and", "while", "then"].contains(&self.at(index - 1));
            let who = WHO.iter().find(|who| opens && self.starts(index, who));
            if let Some(length) = who.map(|who| who.len()) {
                let next = self.at(index + length);
                let ordered = ["should", "must", "shall", "can", "could", "will"].contains(&next);
                let of_you = length == 3 && next.ends_with('s') && !self.lexicon.verbs(next).is_empty();
                let doing = self.at(index + length + 1);
                if ["is", "are"].contains(&next)
                    && doing.ends_with("ing")
                    && !self.lexicon.verbs(doing).is_empty()
                {
                    self.say(index, index + length + 1, &[]);
                } else if is_determiner(next) || ordered && length > 1 || of_you {
                    self.say(index, index + length + usize::from(ordered), &[]);
                }
            }
            index += 1;
        }
    }

    /// "a colleague", "an idle team member", "its partner": another robot.
    pub(super) fn members_of_the_team(&mut self) {
        for index in 0..self.tokens.len() {
            let plain = self.starts(index + 1, &["robot"]) || self.starts(index + 1, &["other", "robot"]);
            if let Some(length) = self.member(index).filter(|_| !plain) {
                self.say(index, index + length, &["another", "robot"]);
            }
        }
    }

    /// How many words name one of the team here: "an idle team member".
    fn member(&self, index: usize) -> Option<usize> {
        const ARTICLES: [&str; 10] =
            ["a", "an", "one", "another", "the", "its", "some", "your", "each", "whichever"];
        if !ARTICLES.contains(&self.at(index)) {
            return None;
        }
        let which = (index + 1..index + 4).take_while(|&at| WHICH.contains(&self.at(at))).count();
        let who = index + 1 + which;
        if !MEMBERS.contains(&self.at(who)) {
            return None;
        }
        let of = usize::from(self.at(who + 1) == "of") * 2;
        let team = of == 0 || ["you", "yours", "them"].contains(&self.at(who + 2));
        Some(1 + which + 1 + if team { of } else { 0 })
    }
}
