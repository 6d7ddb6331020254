//! What is said beside what is wanted: when, why, and who.

use super::super::super::lexicon::Act;
use super::super::super::syntax::{is_determiner, is_function_word};
use super::super::super::text::POSSESSIVE;
use super::Chunker;

/// Words that open a clause that only says when or why.
const WHEN: [&[&str]; 16] = [
    &["so"],
    &["by", "the", "time"],
    &["as", "soon", "as"],
    &["so", "that"],
    &["even", "though"],
    &["when"],
    &["once"],
    &["before"],
    &["after"],
    &["until"],
    &["till"],
    &["because"],
    &["since"],
    &["though"],
    &["while"],
    &["as"],
];

/// Somebody, of whom it is said.
const WHO: [&str; 23] = [
    "i",
    "im",
    "ive",
    "ill",
    "id",
    "we",
    "weve",
    "you",
    "youve",
    "youre",
    "he",
    "she",
    "they",
    "theyve",
    "theyre",
    "everyone",
    "everybody",
    "nobody",
    "somebody",
    "someone",
    "were",
    "who",
    "people",
];

/// What is so once all is done.
const DONE: [&str; 9] = ["done", "finished", "over", "ready", "so", "through", "complete", "sorted", "that"];

impl Chunker<'_> {
    /// How many words at a place are such an aside.
    pub(super) fn aside(&self, at: usize, opens: bool) -> Option<usize> {
        if ["whole", "entire"].contains(&self.at(at + 1)) && self.at(at + 2) == "time" {
            return Some(3);
        }
        self.statement(at, opens)
            .or_else(|| self.ban_on_all(at))
            .or_else(|| self.where_it_was(at))
            .or_else(|| self.off_to(at, opens))
            .or_else(|| self.time_or_reason(at))
            .or_else(|| self.known_by(at))
            .or_else(|| self.purpose(at, opens))
            .or_else(|| self.of_somebody(at, opens))
    }

    /// "my son has a bad cold", "camp starts tomorrow": told of somebody or something that is not here.
    fn statement(&self, at: usize, opens: bool) -> Option<usize> {
        if !opens {
            return None;
        }
        let end = self.mark_after(at);
        let mine = usize::from(["my", "our", "his", "her", "the", "your", "their"].contains(&self.at(at)));
        let subject = self.at(at + mine);
        let known = subject.is_empty()
            || is_function_word(subject)
            || ",.".contains(subject)
            || self.parser.longest_noun_at(at + mine).is_some()
            || self.lexicon.adjective(&[subject]).is_some()
            || mine == 0 && (!self.lexicon.verbs(subject).is_empty() || self.is_said_of_nothing(subject));
        let told = (at + mine + 1..(at + mine + 3).min(end)).any(|at| {
            let word = self.at(at);
            ["is", "has", "was", "are", "have", POSSESSIVE].contains(&word)
                || word.len() > 3 && word.ends_with('s') && self.thing(at).is_none() && !word.ends_with("ss")
        });
        let named = (at..end)
            .any(|at| is_determiner(self.at(at)) && self.thing(at).is_some_and(|(thing, _)| !thing.absent));
        let goes = (at..end).any(|at| {
            matches!(self.place(at, None), Some((super::Chunk::Place(_, _, super::Where::At(thing)), _)) if !thing.absent)
        });
        (!known && told && !goes && !named && !self.orders_in(at, end)).then_some(end - at)
    }

    fn is_said_of_nothing(&self, word: &str) -> bool {
        ["polite", "asides", "sequence", "parallel", "modifiers"]
            .iter()
            .any(|list| self.lexicon.is_small(list, &[word]))
    }

    /// "don't turn anything on yet"
    fn ban_on_all(&self, at: usize) -> Option<usize> {
        let denied = ["dont", "not"].contains(&self.at(at)) && !self.at(at + 1).is_empty();
        (denied && self.at(at + 2) == "anything").then(|| self.mark_after(at) - at)
    }

    /// "where the vase was"
    fn where_it_was(&self, at: usize) -> Option<usize> {
        let (_, length) = self.thing(at + 1).filter(|_| self.at(at) == "where")?;
        let was = at + 1 + length;
        ["was", "is", "stands", "stood", "were", "are"].contains(&self.at(was)).then_some(was + 1 - at)
    }

    /// "off to bed now", "before bed": where somebody goes.
    fn off_to(&self, at: usize, opens: bool) -> Option<usize> {
        let end = self.mark_after(at);
        let leaves = opens && self.starts(at, &["off", "to"]);
        let time = ["before", "after"].contains(&self.at(at))
            && end - at <= 3
            && self.lexicon.verbs(self.at(at + 1)).is_empty()
            && !["it", "that", "them"].contains(&self.at(at + 1));
        (leaves || time).then_some(end - at)
    }

    fn mark_after(&self, at: usize) -> usize {
        (at..self.words.len()).find(|&at| [",", "."].contains(&self.at(at))).unwrap_or(self.words.len())
    }

    /// "when I get back from the bank,", "once that's done", "before the kids come in"
    fn time_or_reason(&self, at: usize) -> Option<usize> {
        let opens = self.one_of(at, &WHEN)?;
        let who = at + opens;
        let it = ["it", "its", "that", "thats", "this", "they", "theyre", "all", "everything"]
            .contains(&self.at(who));
        if it {
            // "once it is done": and what comes then is said
            let is = (who + 1..who + 5).find(|&at| DONE.contains(&self.at(at)));
            let said_of =
                |at: usize| (who..at).all(|at| is_function_word(self.at(at)) || self.at(at).ends_with('s'));
            if let Some(done) = is.filter(|&done| said_of(done)) {
                return Some(done + 1 - at);
            }
            let have = ["have", "has", "are", "is"].contains(&self.at(who + 1))
                && [",", "."].contains(&self.at(who + 2));
            return have.then_some(opens + 2);
        }
        let end = self.mark_after(at);
        let purpose = self.starts(at, &["so", "that"]) && (at == 0 || self.at(at - 1) == ".");
        if purpose && !self.orders_in(who, end) {
            return Some(end - at);
        }
        let person = WHO.contains(&self.at(who)) || self.thing(who).is_none() && self.is_somebody(who);
        let done = self.at(who).starts_with("you") && self.acts_in(who, end);
        (person && !done && !self.orders_in(who, end)).then_some(end - at)
    }

    /// Whether something here is done in a range: "after you have filled the pot".
    fn acts_in(&self, from: usize, to: usize) -> bool {
        let known = |at: usize| {
            self.lexicon
                .verbs(self.at(at))
                .iter()
                .any(|(_, _, verb)| !matches!(verb.act, Act::Go | Act::Hold))
        };
        let here = |at: usize| {
            ["it", "them"].contains(&self.at(at)) || self.thing(at).is_some_and(|(thing, _)| !thing.absent)
        };
        (from..to).any(known) && (from..to).any(here)
    }

    /// "the kids", "my wife": somebody nobody here knows.
    fn is_somebody(&self, at: usize) -> bool {
        let article = ["the", "my", "our", "his", "her"].contains(&self.at(at));
        let noun = self.at(at + 1);
        article
            && !noun.is_empty()
            && !is_function_word(noun)
            && self.parser.longest_noun_at(at + 1).is_none()
    }

    /// Whether something is ordered or wished in a range.
    fn orders_in(&self, from: usize, to: usize) -> bool {
        let shall =
            |at: usize| ["has", "have", "is", "are"].contains(&self.at(at)) && self.at(at + 1) == "to";
        (from..to).any(|at| {
            shall(at)
                || ["want", "need", "should", "must", "please", "expect", "wants", "needs"]
                    .contains(&self.at(at))
        })
    }

    /// "which he loathes", "that nobody has washed", "you used", "that cut it"
    fn known_by(&self, at: usize) -> Option<usize> {
        let which = ["which", "that", "who", "whom", "where"].contains(&self.at(at));
        if !which || at == 0 {
            return None;
        }
        let person = WHO.contains(&self.at(at + 1)) && !["were", "you"].contains(&self.at(at + 1));
        let end = self.mark_after(at);
        if person && !self.orders_in(at, end) {
            return Some(end - at);
        }
        let it = ["it", "them"].contains(&self.at(at + 2)) && self.at(at) == "that";
        it.then_some(3)
    }

    /// "To make room on the table, …", "to get ready for bed, …": what it is for.
    fn purpose(&self, at: usize, opens: bool) -> Option<usize> {
        let first = at == 0 || self.at(at - 1) == ".";
        let end = self.mark_after(at);
        let order = self.is_order(at + 1);
        (opens && first && self.at(at) == "to" && order && self.at(end) == ",").then_some(end - at)
    }

    /// "nobody is watching", "we are leaving for the weekend": told of somebody who wants nothing by it.
    fn of_somebody(&self, at: usize, opens: bool) -> Option<usize> {
        let no_teller = ["you", "were", "id", "who", "people"];
        if !opens || !WHO.contains(&self.at(at)) || no_teller.contains(&self.at(at)) {
            return None;
        }
        let end = self.mark_after(at);
        let told = ["am", "are", "is", "have", "has", "was", "were", "cant", "cannot", "will", "do", "never"]
            .contains(&self.at(at + 1))
            || self.at(at) == "ill"
            || self.at(at + 1) == POSSESSIVE
            || self.at(at + 1).ends_with("ed")
            || ["left", "put", "forgot", "took", "keep", "hate", "love"].contains(&self.at(at + 1))
            || ["im", "ive", "weve", "theyre", "youre", "youve"].contains(&self.at(at));
        let shall = ["has", "have"].contains(&self.at(at + 1)) && self.at(at + 2) == "to";
        if shall || self.report(at + 1).is_some() {
            return None;
        }
        let report = ["somebody", "someone", "everyone", "everybody", "nobody", "he", "she", "they"]
            .contains(&self.at(at));
        if !told || self.orders_in(at, end) {
            return None;
        }
        let named = (at..end).any(|at| self.thing(at).is_some_and(|(thing, _)| !thing.absent));
        (report || !named).then_some(end - at)
    }
}
