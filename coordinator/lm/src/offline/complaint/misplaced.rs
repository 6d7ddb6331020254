//! Things complained of for where they are: "who left the mug in the sink?" asks for it to be put away.

use super::super::lexicon::Noun;
use super::super::syntax::{Relation, is_determiner, preposition};
use super::{BLAMED, Complaint, EVER, LEFT};

/// What says that something is.
const IS: [&str; 7] = ["is", "are", "was", "were", "s", "be", "being"];

/// How something lies where it is.
const LIES: [&str; 20] = [
    "lying",
    "sitting",
    "standing",
    "lies",
    "sits",
    "stands",
    "left",
    "all",
    "just",
    "still",
    "always",
    "doing",
    "lie",
    "loose",
    "about",
    "around",
    "again",
    "hanging",
    "scattered",
    "strewn",
];

/// What denies that something belongs where it is, and how sure that is said.
const BELONGS: [&str; 18] = [
    "doesnt", "dont", "does", "do", "not", "belong", "live", "has", "have", "no", "business", "place",
    "shouldnt", "should", "really", "to", "been", "down",
];

/// What is thought of that.
const DISLIKES: [&str; 16] = [
    "hate",
    "hates",
    "stand",
    "annoys",
    "annoying",
    "bugs",
    "sick",
    "tired",
    "fed",
    "angry",
    "dislike",
    "dislikes",
    "disgusting",
    "dont",
    "cross",
    "bothers",
];

/// From where to where a thing is named, and the place it should not be at.
pub(super) struct Misplaced {
    pub(super) thing: std::ops::Range<usize>,
    pub(super) place: std::ops::Range<usize>,
}

impl Complaint<'_> {
    /// What is complained of in a part for where it is.
    pub(super) fn misplaced(&self, from: usize, to: usize) -> Option<Misplaced> {
        let start = self
            .blamed_for(from, to)
            .or_else(|| self.asked_why(from, to))
            .or_else(|| self.disliked(from, to))
            .or_else(|| self.does_not_belong(from, to))
            .or_else(|| self.is_there_again(from, to))?;
        // "…, put it in the box" says where it goes.
        let next = self.end(to + 1);
        let goes_on = self.has(to, next, &["it", "them"]);
        self.thing_at_a_place(start, to).filter(|_| !goes_on)
    }

    /// "somebody left food in the sink"
    fn blamed_for(&self, from: usize, to: usize) -> Option<usize> {
        const SOMEBODY: [&str; 9] =
            ["they", "he", "she", "kids", "children", "lot", "youve", "theyve", "people"];
        let blamed = |at: &usize| {
            // "what is left in the bottle"
            BLAMED.contains(&self.at(*at)) && self.at(*at) != "what" || SOMEBODY.contains(&self.at(*at))
        };
        let who = (from..to.min(from + 5)).find(blamed)?;
        let left = (who + 1..to.min(who + 7)).find(|&at| {
            LEFT[..3].contains(&self.at(at)) || ["dumped", "forgot", "dropped"].contains(&self.at(at))
        })?;
        let asks = self.has(from, left, &["if", "can", "could", "should", "want", "please", "will"]);
        (!asks).then_some(left + 1)
    }

    /// "why is the mug in the sink?", "what on earth is the sponge doing on the table?"
    fn asked_why(&self, from: usize, to: usize) -> Option<usize> {
        let what =
            (from..to.min(from + 3)).find(|&at| ["why", "what", "whats", "how"].contains(&self.at(at)))?;
        let doing = self.has(what, to, &["doing"]);
        let why = self.at(what) == "why" || self.at(what) == "how" && self.at(what + 1) == "come";
        if !doing && !why {
            return None;
        }
        let be = (what + 1..to.min(what + 6)).find(|&at| ["is", "are", "s"].contains(&self.at(at)));
        // "what's the mug doing there?"
        be.map(|be| be + 1).or_else(|| (doing && !why).then_some(what + 1))
    }

    /// "Mum hates it when the pans are all over the table", "I'm sick of shoes on the sofa"
    fn disliked(&self, from: usize, to: usize) -> Option<usize> {
        let dislikes = (from..to.min(from + 6)).find(|&at| DISLIKES.contains(&self.at(at)))?;
        let denied = self.at(dislikes) == "dont";
        if denied && !["like", "want"].contains(&self.at(dislikes + 1))
            || self.at(dislikes) == "stand"
                && !self.has(from, dislikes, &["cant", "cannot", "couldnt", "not"])
        {
            return None;
        }
        let after = dislikes + 1 + usize::from(denied);
        let told = (after..to.min(after + 3)).find(|&at| {
            ["when", "that", "how", "of", "with", "seeing", "having", "finding", "about"]
                .contains(&self.at(at))
        });
        let start = told.map_or(after, |told| told + 1);
        let there = usize::from(["there", "theres"].contains(&self.at(start)));
        Some(start + there + usize::from(["having", "seeing", "finding"].contains(&self.at(start + there))))
    }

    /// "the tomato doesn't belong in the sink", "the mug has no business on the bed", "should not be lying in the sink"
    fn does_not_belong(&self, from: usize, to: usize) -> Option<usize> {
        let denied = |at: usize| {
            ["doesnt", "dont", "not"].contains(&self.at(at)) && ["belong", "live"].contains(&self.at(at + 1))
                || ["has", "have"].contains(&self.at(at))
                    && self.at(at + 1) == "no"
                    && ["business", "place"].contains(&self.at(at + 2))
                || (self.at(at) == "shouldnt" || self.at(at) == "not" && self.at(at - 1) == "should")
                    && self.at(at + 1) == "be"
                    && LIES.contains(&self.at(at + 2))
        };
        (from + 1..to).find(|&at| denied(at)).map(|_| from)
    }

    /// "the cup is on the counter again", "the pot is still in the sink"
    fn is_there_again(&self, from: usize, to: usize) -> Option<usize> {
        let be = (from + 2..to.min(from + 6)).find(|&at| ["is", "are"].contains(&self.at(at)))?;
        let ever = self.has(be, to, &["again", "still", "always"]) && is_determiner(self.at(from));
        let asks =
            self.has(from, to, &["if", "should", "not", "when", "while", "once", "until", "make", "sure"]);
        (ever && !asks).then_some(from)
    }

    /// The thing named first, and the place it is at.
    fn thing_at_a_place(&self, start: usize, to: usize) -> Option<Misplaced> {
        let near = |at: usize| {
            let words: Vec<&str> = (at..to.min(at + 4)).map(|at| self.at(at)).collect();
            preposition(&words).filter(|(relation, _)| *relation == Relation::In || self.at(at) == "under")
        };
        let (at, length) = (start + 1..to).find_map(|at| near(at).map(|(_, length)| (at, length)))?;
        let passed = |at: usize| {
            let word = self.at(at);
            IS.contains(&word) || LIES.contains(&word) || BELONGS.contains(&word)
        };
        let end = (start + 1..=at).rev().find(|&end| !passed(end - 1))?;
        let first = (start..end).find(|&at| !passed(at))?;
        if !["stuff", "things"].contains(&self.at(end - 1)) {
            self.noun_in(first, end)?;
        }
        let until =
            (at + length..to).find(|&at| EVER.contains(&self.at(at)) || self.at(at) == "and").unwrap_or(to);
        let place = self.noun_in(at + length, until)?;
        let receptacle = |kind: &String| self.scene.affords(kind, "receptacle");
        place
            .kinds
            .iter()
            .any(receptacle)
            .then_some(Misplaced { thing: first..end, place: at + length..until })
    }

    /// The last noun between two words.
    fn noun_in(&self, from: usize, to: usize) -> Option<&Noun> {
        (from..to).rev().find_map(|last| {
            (from..=last).find_map(|first| {
                let words: Vec<&str> = (first..=last).map(|at| self.at(at)).collect();
                self.lexicon.noun(&words).map(|(noun, _)| noun)
            })
        })
    }
}
