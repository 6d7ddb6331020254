//! Members named beside their class: "the valuables, namely the watch and the keys".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{is_determiner, preposition};

impl Rewriting<'_> {
    /// "the valuables (the watch and the keys) go in the safe", "the glasses, namely the cup and the mug, go …": no
    /// mark between a subject and its verb.
    pub(super) fn named_members(&mut self) {
        let mut named = false;
        let mut dashes = 0;
        let mut index = 0;
        while index < self.tokens.len() {
            let namely = if self.starts(index, &["that", "is"])
                && is_determiner(self.at(index + 2))
                && index > 0
                && self.at(index - 1) == ","
            {
                2
            } else {
                let means = self.at(index) == "which" && ["means", "mean"].contains(&self.at(index + 1));
                usize::from(index > 0 && ["namely", "ie", "meaning", "viz"].contains(&self.at(index)))
                    + 2 * usize::from(index > 0 && means)
            };
            if namely > 0 {
                // What is named is all that is meant: "the dishes, namely the pan and the pot, …" is no plate.
                let comma = usize::from(self.at(index + namely) == ",");
                let run = (index.saturating_sub(9)..index.saturating_sub(1))
                    .rev()
                    .take_while(|&at| !self.is_mark(at) && self.at(at) != "and");
                let run: Vec<usize> = run.collect();
                let whole = |at: &usize| ["anything", "everything"].contains(&self.at(*at));
                let class = run.iter().copied().find(whole);
                let class = class.or(run.into_iter().rfind(|&at| is_determiner(self.at(at))));
                let from = class.filter(|_| self.at(index - 1) == ",").unwrap_or(index);
                let place = (from..index.saturating_sub(1))
                    .find(|&at| preposition(&[self.at(at)]).is_some() && self.at(at) != "of");
                // "put all the papers in the bin, namely the news": the news goes there.
                let end = self.next_mark(index + namely + comma, &["."]);
                let goes = (index..end).any(|at| is_going(self.at(at)) || SHALL.contains(&self.at(at)));
                if let Some(place) = place.filter(|_| !goes && from < index && end >= self.tokens.len() - 1) {
                    let list = self.words(index + namely + comma..end);
                    self.say(index - 1, end, &[]);
                    self.say_all(from, place, &list);
                    index += 1;
                    continue;
                }
                self.say(from, index + namely + comma, &[]);
                index = from;
                named = true;
            }
            let mark = self.at(index).to_owned();
            let typed = self.tokens.get(index).map_or("", |token| token.typed.as_str());
            let dash = mark == "," && ["-", "\u{2013}", "\u{2014}"].contains(&typed);
            let closing = mark == "," && (typed == ")" || dash && dashes % 2 == 1 || named);
            dashes += usize::from(dash);
            let next = self.at(index + 1);
            let placed = named && ["in", "on", "into", "onto", "to"].contains(&next);
            if closing && (is_going(next) || SHALL.contains(&next) || placed) {
                self.say(index, index + 1, &[]);
                named = false;
            }
            if mark == "." {
                (named, dashes) = (false, 0);
            }
            index += 1;
        }
    }
}
