//! What is only spoken of: things to be found, things that need nothing, lists announced by "these".

use super::{LONGEST_ASIDE, Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{is_determiner, preposition};

/// What says of a thing only that it is there.
const FOUND: [&[&str]; 8] = [
    &["youll", "find"],
    &["you", "will", "find"],
    &["you", "should", "find"],
    &["you", "could", "find"],
    &["you", "can", "find"],
    &["you", "may", "find"],
    &["youll", "see"],
    &["you", "will", "see"],
];

/// What says that something need not be done.
const NEEDLESS: [&[&str]; 12] = [
    &["no", "need", "to"],
    &["there", "is", "no", "need", "to"],
    &["there", "no", "need", "to"],
    &["you", "dont", "need", "to"],
    &["you", "dont", "have", "to"],
    &["you", "do", "not", "need", "to"],
    &["you", "do", "not", "have", "to"],
    &["you", "neednt"],
    &["dont", "bother", "to"],
    &["dont", "bother"],
    &["do", "not", "bother"],
    &["never", "mind"],
];

impl Rewriting<'_> {
    fn begins(&self, index: usize) -> bool {
        index == 0 || [",", ".", "and", "but"].contains(&self.at(index - 1))
    }

    /// "you'll find the pot in the cabinet", "no need to wash the plate": the pot, the plate.
    pub(super) fn topics(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let found = self.one_of(index, &FOUND);
            let needless = self.one_of(index, &NEEDLESS).map(|length| length + 1);
            let unwanted = (self.starts(index, &["i", "dont", "want"])
                || self.starts(index, &["we", "dont", "want"]))
                && (index + 3..self.tokens.len())
                    .any(|at| self.starts(at, &["want", "them"]) || self.starts(at, &["want", "it"]));
            let length = found.or(needless).or(unwanted.then_some(3));
            if let (true, Some(length)) = (self.begins(index), length)
                && is_determiner(self.at(index + length))
            {
                let end = self.next_mark(index, &[",", "."]);
                let things = index + length;
                let place = (things..end).find(|&at| self.is_place(at)).unwrap_or(end);
                self.say(place, end + 1, &["."]);
                self.say(index, things, &[]);
                let joined = index > 0 && ["and", "but"].contains(&self.at(index - 1));
                if joined {
                    self.say(index - 1, index, &["."]);
                }
            }
            index += 1;
        }
    }

    /// "put the following in the box: the cup and the mug", "stack these on the table - cups, plates -": the things
    /// themselves.
    pub(super) fn announced_lists(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let length = match (self.at(index), self.at(index + 1), self.at(index + 2)) {
                ("the", "following", "things" | "items" | "objects") => 3,
                (number, "things" | "items" | "objects", _)
                    if (preposition(&[self.at(index + 2)]).is_some_and(|_| self.at(index + 2) != "to")
                        || self.is_opening(index + 2)
                        || self.at(index + 2) == "," && is_determiner(self.at(index + 3))
                        || is_going(self.at(index + 2)))
                        && (["several", "some", "few", "these"].contains(&number)
                            || crate::offline::inflect::number(number).is_some()) =>
                {
                    2
                }
                ("the", "following", _) | ("these", "things" | "items" | "objects", _) => 2,
                ("these", next, _)
                    if self.mark_at(index + 1) || preposition(&[next]).is_some() || is_going(next) =>
                {
                    1
                }
                _ => 0,
            };
            let comma = length == 2 && self.at(index + 2) == "," && !self.is_opening(index + 2);
            if comma {
                // "two things, the cup and the mug"
                self.say(index, index + 3, &[]);
                continue;
            }
            self.named_behind(index);
            let opens = (index..self.tokens.len().min(index + LONGEST_ASIDE + 4))
                .find(|&at| self.is_opening(at))
                .filter(|_| length > 0);
            if let Some(opens) = opens {
                let typed = self.tokens[opens].typed.clone();
                let closes = (opens + 1..self.tokens.len())
                    .find(|&at| self.at(at) == "." || typed != ":" && self.is_closing(at, &typed))
                    .unwrap_or(self.tokens.len());
                let list = self.words(opens + 1..closes);
                let after = usize::from(self.tokens.get(closes).is_some_and(|token| token.text == ","));
                self.say(opens, closes + after, &[]);
                // "all of these go in the sink: …"
                let all = index > 1
                    && self.at(index - 1) == "of"
                    && ["all", "each", "both"].contains(&self.at(index - 2));
                let first = index - 2 * usize::from(all);
                self.say_all(first, index + length, &list);
                index = first + list.len();
            }
            index += 1;
        }
    }

    /// "two things need chilling, the cup and the mug", "everything small goes in the box: the pen and the card": the
    /// things themselves.
    fn named_behind(&mut self, index: usize) {
        let number = crate::offline::inflect::number(self.at(index)).is_some();
        let things = number && ["things", "items", "objects"].contains(&self.at(index + 1));
        if number {
            self.so_many_of_a_class(index);
        }
        let whole = self.at(index) == "everything" && self.begins(index);
        let end = self.next_mark(index, &[","]).min(
            (index..self.tokens.len()).find(|&at| self.tokens[at].text == ".").unwrap_or(self.tokens.len()),
        );
        let Some(mark) = self.tokens.get(end).map(|token| token.typed.clone()) else { return };
        let close = self.next_mark(end + 1, &["."]);
        let told = (index + 1..end)
            .find(|&at| is_going(self.at(at)) || ["need", "needs", "should", "must"].contains(&self.at(at)));
        let Some(told) = told.filter(|_| things || whole && mark == ":") else { return };
        let alone = things && told == index + 2 || whole && told > index + 1 && told - index <= 5;
        if alone && [",", ":"].contains(&mark.as_str()) && self.names_only(end + 1, close) {
            let list = self.words(end + 1..close);
            self.say(end, close, &[]);
            self.say_all(index, told, &list);
        }
    }

    /// "put three dishes on the table: the plate, the bowl and the cup": those.
    fn so_many_of_a_class(&mut self, index: usize) {
        let class = self.lexicon.noun(&[self.at(index + 1)]).is_some_and(|(noun, _)| noun.class);
        let mark = self.next_mark(index, &[",", "."]);
        let colon = self.tokens.get(mark).is_some_and(|token| token.typed == ":");
        let end = self.next_mark(mark + 1, &["."]);
        if class && colon && self.names_only(mark + 1, end) {
            let list = self.words(mark + 1..end);
            self.say(mark, end, &[]);
            self.say_all(index, index + 2, &list);
        }
    }

    /// "my stuff (the phone and the keys)": the phone and the keys.
    pub(super) fn listed_in_brackets(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let general = ["stuff", "things", "items", "belongings", "junk", "bits", "objects", "everything"]
                .contains(&self.at(index - 1));
            let most =
                self.at(index - 1).ends_with("est") && self.lexicon.noun(&[self.at(index - 1)]).is_none();
            let typed = self.tokens[index].typed.clone();
            let set_apart = typed != ":" && self.is_opening(index);
            if (general || most) && self.at(index) == "," && set_apart {
                let closes = (index + 1..self.tokens.len()).find(|&at| self.is_closing(at, &typed));
                if let Some(closes) = closes {
                    let back = (index.saturating_sub(4)..index - 1).rev();
                    let article =
                        back.take_while(|&at| !self.is_mark(at)).find(|&at| is_determiner(self.at(at)));
                    let first = article.unwrap_or(index - 1);
                    self.say(closes, closes + 1, &[]);
                    self.say(first, index + 1, &[]);
                }
            }
            index += 1;
        }
    }

    fn mark_at(&self, index: usize) -> bool {
        [",", "."].contains(&self.at(index))
    }

    /// ":", " - " or "(": a list begins.
    fn is_opening(&self, at: usize) -> bool {
        let typed = self.tokens.get(at).map_or("", |token| token.typed.as_str());
        [":", "-", "(", "\u{2013}", "\u{2014}"].contains(&typed)
    }

    fn is_closing(&self, at: usize, opening: &str) -> bool {
        let typed = self.tokens.get(at).map_or("", |token| token.typed.as_str());
        if opening == "(" { typed == ")" } else { typed == opening }
    }

    /// "the first goes in the drawer, the second on the desk": the former, the latter.
    pub(super) fn first_and_second(&mut self) {
        let stands = |this: &Self, at: usize, word: &str| {
            this.starts(at, &["the", word]) && {
                let next = this.at(at + 2);
                is_going(next) || SHALL.contains(&next) || this.is_place(at + 2)
            }
        };
        let first = (0..self.tokens.len()).find(|&at| stands(self, at, "first"));
        let Some(first) = first else { return };
        let second = |at: &usize| ["second", "last", "other"].iter().any(|word| stands(self, *at, word));
        if let Some(second) = (first + 2..self.tokens.len()).find(second) {
            self.say(first + 1, first + 2, &["former"]);
            self.say(second + 1, second + 2, &["latter"]);
        }
    }

    /// "off with the lights", "do wash the cup", "whereas", "stays where it is", "by the time I am back"
    pub(super) fn turns_of_phrase(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens = self.begins(index)
                || index > 0 && ["then", "please", "before", "you", "should"].contains(&self.at(index - 1));
            if opens && ["off", "on"].contains(&self.at(index)) && self.at(index + 1) == "with" {
                let particle = self.at(index).to_owned();
                self.say(index, index + 2, &["turn", &particle]);
            } else if opens
                && self.at(index) == "do"
                && self.lexicon.noun(&[self.at(index + 1)]).is_none()
                && self.is_base_verb(index + 1)
            {
                self.say(index, index + 1, &[]);
            } else if self.starts(index, &["next", "to", "each", "other"])
                || self.starts(index, &["side", "by", "side"])
            {
                let comma = usize::from(index > 0 && self.at(index - 1) == ",");
                let length = if self.at(index) == "side" { 3 } else { 4 };
                self.say(index - comma, index + length, &[]);
                index -= comma;
            } else if self.at(index) == "included"
                && self.noun_before(index).is_some()
                && self.mark_at(index + 1)
            {
                let start = (0..index).rev().find(|&at| self.mark_at(at)).unwrap_or(0);
                self.say(start, index + 1, &[]);
                index = start;
            } else if ["everything", "all"].contains(&self.at(index)) && self.at(index + 1) == "that" {
                let is = usize::from(["is", "are"].contains(&self.at(index + 2)));
                let state = ["on", "open", "running", "off"].contains(&self.at(index + 2 + is));
                if state && self.is_mark(index + 3 + is) {
                    self.say(index, index + 3 + is, &["everything"]);
                }
            } else if self.at(index) == "whereas" {
                self.say(index, index + 1, &["and"]);
            } else if self.starts(index, &["by", "the", "time"]) {
                let end = self.next_mark(index, &[",", "."]);
                self.say(index, end, &[]);
            } else if ["stay", "stays", "remain", "remains"].contains(&self.at(index)) {
                self.stays(index);
            } else if self.at(index) == "edible"
                && ["everything", "anything"].contains(&self.at(index.wrapping_sub(1)))
            {
                self.say(index - 1, index + 1, &["all", "the", "food"]);
            } else if self.at(index) == "for"
                && index > 0
                && ["want", "need", "like", "love"].contains(&self.at(index - 1))
                && (index..self.next_mark(index, &["."])).any(|at| self.starts(at, &["to", "be"]))
            {
                self.say(index, index + 1, &[]);
            }
            index += 1;
        }
    }

    /// "stays where it is", "stay put": stays.
    fn stays(&mut self, index: usize) {
        let next = index + 1;
        let length = match (self.at(next), self.at(next + 1), self.at(next + 2)) {
            ("where" | "as", "it" | "they", "is" | "are") => 3,
            ("right" | "exactly" | "just", "where", _) => 4,
            ("put" | "there" | "untouched" | "alone", _, _) if self.is_mark(next + 1) => 1,
            _ => 0,
        };
        if length > 0 && (self.is_mark(next + length) || ["and", "but"].contains(&self.at(next + length))) {
            self.say(next, next + length, &[]);
        }
    }

    /// "with the plate on the table": the plate goes on the table.
    pub(super) fn with_something_somewhere(&mut self) {
        let mut index = 1;
        while index < self.tokens.len() {
            let end = self.next_mark(index + 1, &[",", "."]);
            let opens =
                self.at(index - 1) == "," && self.at(index) == "with" && is_determiner(self.at(index + 1));
            let place =
                (index + 2..end).find(|&at| ["in", "on", "inside", "onto", "into"].contains(&self.at(at)));
            let named =
                place.is_some_and(|at| is_determiner(self.at(at + 1)) && self.noun_before(at).is_some());
            // "with the remote beside it"
            let beside = (index + 2..end).find(|&at| ["beside", "near", "under"].contains(&self.at(at)));
            let beside_it = beside.is_some_and(|at| {
                ["it", "them"].contains(&self.at(at + 1)) && at + 2 == end && self.noun_before(at).is_some()
            });
            let told = named && self.noun_before(end).is_some() || beside_it;
            if opens && told && self.is_mark(end) {
                self.say(index, index + 1, &["and", "put"]);
            }
            index += 1;
        }
    }

    /// What is only cleared by what is said next.
    pub(super) fn clearings(&mut self) {
        for index in 0..self.tokens.len() {
            self.cleared(index);
        }
    }

    /// "clear the table, taking the cup to the sink", "get the table cleared: the cup …": what comes says how.
    fn cleared(&mut self, index: usize) {
        if index > 0 && self.at(index - 1) != "." {
            return;
        }
        let end = self.next_mark(index, &[",", "."]);
        let gets = ["get", "have"].contains(&self.at(index)) && self.at(end.wrapping_sub(1)) == "cleared";
        let clears = self.at(index) == "clear" && is_determiner(self.at(index + 1));
        let colon = self.tokens.get(end).is_some_and(|token| token.typed == ":");
        let taking =
            ["taking", "moving", "bringing", "putting", "placing", "carrying"].contains(&self.at(end + 1));
        if !(gets || clears) || end > index + 6 || !(colon || self.at(end) == "," && taking) {
            return;
        }
        let order = match self.at(end + 1) {
            "taking" | "moving" | "bringing" | "carrying" => "move",
            _ => "put",
        };
        if taking {
            self.say(end + 1, end + 2, &[order]);
        }
        self.say(index, end + 1, &[]);
    }
}
