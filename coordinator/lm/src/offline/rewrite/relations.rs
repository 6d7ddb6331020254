//! Relative clauses that say where something shall be: "the bowl, whose place is …", "the table where the plate goes
//! too", "on which it stands", "the cup that I want on the desk". Each is said in a sentence of its own.

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::is_determiner;

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn places_in_relatives(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let _ = self.whose_place(index)
                || self.table_where(index)
                || self.on_which(index)
                || self.that_i_want(index)
                || self.that_is_none(index);
            index += 1;
        }
    }

    /// "the bowl, whose place is the cabinet,": it goes there.
    fn whose_place(&mut self, index: usize) -> bool {
        let home = ["place", "home", "spot", "destination"].contains(&self.at(index + 1));
        if self.at(index) != "whose" || !home || self.at(index + 2) != "is" {
            return false;
        }
        let comma = usize::from(self.at(index - 1) == ",");
        let Some(noun) = self.noun_before(index - comma) else { return false };
        let place: &[&str] = if self.is_place(index + 3) { &["goes"] } else { &["goes", "in"] };
        let end = self.next_mark(index, &[",", "."]);
        let and = (index + 3..end).find(|&at| self.at(at) == "and").unwrap_or(end);
        let mut told: Vec<&str> = vec![".", "the"];
        told.extend(noun.iter().map(String::as_str));
        told.extend(place);
        if self.at(and) == "," {
            self.say(and, and + 1, &["."]);
        }
        self.say(index - comma, index + 3, &told);
        true
    }

    /// "to the table where the plate should go too": the plate should be there.
    fn table_where(&mut self, index: usize) -> bool {
        let comma = usize::from(self.at(index - 1) == ",");
        let Some(noun) = self.noun_before(index - comma).filter(|_| self.at(index) == "where") else {
            return false;
        };
        let end = self.next_mark(index, &[",", "."]);
        let shall = (index + 2..end).find(|&at| {
            (SHALL[..3].contains(&self.at(at)) || is_going(self.at(at))) && self.noun_before(at).is_some()
        });
        let Some(shall) = shall.filter(|_| is_determiner(self.at(index + 1))) else { return false };
        // Nothing else may be told of it there: "where the plate should be washed".
        let rest = shall + 1..end;
        let plain = rest.clone().all(|at| {
            is_going(self.at(at))
                || [
                    "be", "too", "also", "as", "well", "stand", "sit", "lie", "rest", "live", "end", "up",
                    "both",
                ]
                .contains(&self.at(at))
        });
        if !plain {
            return false;
        }
        self.say(shall, end, &["should", "be", "in", "the"]);
        self.say_all(shall + 4, shall + 4, &noun);
        self.say(index - comma, index + 1, &["."]);
        true
    }

    /// "the table, on which the statue should stand": the statue should be on it.
    fn on_which(&mut self, index: usize) -> bool {
        let joint = ["on", "in", "into", "onto", "beside", "inside"].contains(&self.at(index));
        let comma = usize::from(self.at(index - 1) == ",");
        let noun = self.noun_before(index - comma).filter(|_| joint && self.at(index + 1) == "which");
        let Some(noun) = noun else { return false };
        let end = self.next_mark(index, &[",", "."]);
        let shall = (index + 3..end).find(|&at| SHALL[..3].contains(&self.at(at)) || is_going(self.at(at)));
        let Some(shall) = shall.filter(|&at| self.noun_before(at).is_some()) else { return false };
        let mut there =
            vec!["should".to_owned(), "be".to_owned(), self.at(index).to_owned(), "the".to_owned()];
        there.extend(noun);
        self.say_all(shall, end, &there);
        self.say(index - comma, index + 2, &["."]);
        true
    }

    /// "light the candle that I want on the table": it should be there.
    fn that_i_want(&mut self, index: usize) -> bool {
        let wish = ["i", "we"].contains(&self.at(index + 1))
            && ["want", "need"].contains(&self.at(index + 2))
            && self.is_place(index + 3);
        let that = ["that", "which"].contains(&self.at(index));
        let Some(noun) = self.noun_before(index).filter(|_| wish && that) else { return false };
        let end = self.next_mark(index, &[",", "."]);
        let joined = (index + 3..end)
            .find(|&at| self.at(at) == "and" && (self.is_order(at + 1) || self.at(at + 1) == "then"));
        if self.at(end) == "," || joined.is_some() {
            let at = joined.unwrap_or(end);
            self.say(at, at + 1, &["."]);
        }
        let mut told: Vec<&str> = vec![".", "the"];
        told.extend(noun.iter().map(String::as_str));
        told.extend(["should", "be"]);
        self.say(index, index + 3, &told);
        true
    }

    /// "all the cutlery that is not a knife": except the knife.
    fn that_is_none(&mut self, index: usize) -> bool {
        let that = ["that", "which"].contains(&self.at(index)) && ["is", "are"].contains(&self.at(index + 1));
        let (article, length) = match (self.at(index + 2), self.at(index + 3)) {
            ("not", "a" | "an" | "the") => (true, 4),
            ("not", _) => (false, 3),
            ("no", _) => (false, 3),
            _ => return false,
        };
        let noun = self.lexicon.noun(&[self.at(index + length)]).is_some();
        let all = (index.saturating_sub(LONGEST_ASIDE)..index)
            .any(|at| ["every", "all", "everything", "any", "each"].contains(&self.at(at)));
        if !that || !noun || !all || self.noun_before(index).is_none() && self.at(index - 1) != "everything" {
            return false;
        }
        let said: &[&str] = if article { &["except", "the"] } else { &["except"] };
        self.say(index, index + length, said);
        true
    }

    /// "put the vase on the shelf, and where it stood put the lamp": the place it was taken from.
    pub(super) fn where_it_stood(&mut self) {
        let mut index = 2;
        while index < self.tokens.len() {
            let stood = ["where", "there"].contains(&self.at(index))
                && ["it", "that", "they"].contains(&self.at(index + 1))
                && ["stood", "was", "were", "lay", "sat"].contains(&self.at(index + 2));
            let from = (index.saturating_sub(LONGEST_ASIDE * 3)..index)
                .rev()
                .find(|&at| ["off", "from"].contains(&self.at(at)) && is_determiner(self.at(at + 1)));
            let noun = from.and_then(|from| (from + 3..from + 6).find(|&at| self.noun_before(at).is_some()));
            if let (true, Some(from), Some(end)) = (stood, from, noun) {
                let mut place = vec!["in".to_owned()];
                place.extend(self.words(from + 1..end));
                let more = usize::from(self.at(index + 3) == "before");
                self.say_all(index, index + 3 + more, &place);
                if ["and", "then"].contains(&self.at(index - 1)) {
                    self.say(index - 1, index, &["."]);
                }
            }
            index += 1;
        }
    }
}
