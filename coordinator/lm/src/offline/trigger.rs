//! Triggers of situations and uses: sets of words that must all be said, split and numbered when the lexicon is
//! read, so that thousands of them are tried against a sentence in some microseconds.

use std::collections::BTreeMap;

use super::inflect;

/// What only says of which sort a thing is, before the thing: who says "coffee mug" speaks of no coffee.
const SORTS: [(&[&str], &[&str]); 5] = [
    (&["coffee", "tea", "cocoa"], &["mug", "cup", "table", "towel"]),
    (&["wine", "champagne"], &["glass"]),
    (&["tv", "television", "telly"], &["stand", "unit", "cabinet", "table", "bench"]),
    (&["shower", "bath"], &["curtain", "door", "towel", "mat", "robe", "gel", "cap"]),
    (&["dinner", "lunch", "breakfast", "supper"], &["plate", "fork", "knife", "bowl", "tray"]),
];

/// The words of all triggers by number.
#[derive(Clone, Debug, Default)]
pub struct TriggerWords {
    numbers: BTreeMap<String, usize>,
}

/// A trigger: `a b/c !d` is "a" and one of "b" and "c", but not "d".
#[derive(Clone, Debug)]
pub struct Trigger {
    /// Of each of these sets one word must be there.
    needed: Vec<Vec<usize>>,
    /// None of these may be there.
    absent: Vec<usize>,
    /// It speaks of a negation itself.
    says_not: bool,
}

/// What a text says: which words of triggers, in any form.
pub struct Said {
    words: Vec<u64>,
    /// "I am not hungry" is no hunger.
    denied: bool,
}

impl TriggerWords {
    /// Reads a trigger.
    pub fn trigger(&mut self, pattern: &str) -> Trigger {
        let mut trigger =
            Trigger { needed: Vec::new(), absent: Vec::new(), says_not: pattern.contains("not") };
        for part in pattern.split_whitespace() {
            match part.strip_prefix('!') {
                Some(absent) => trigger.absent.extend(absent.split('/').map(|word| self.number(word))),
                None => trigger.needed.push(part.split('/').map(|word| self.number(word)).collect()),
            }
        }
        trigger
    }

    fn number(&mut self, word: &str) -> usize {
        let next = self.numbers.len();
        *self.numbers.entry(word.to_owned()).or_insert(next)
    }

    /// The words of triggers among some words and what those may be forms of.
    pub fn said(&self, words: &[String]) -> Said {
        let mut said = Said { words: vec![0; self.numbers.len().div_ceil(64)], denied: is_denied(words) };
        let mut mark = |form: &str| {
            if let Some(number) = self.numbers.get(form) {
                said.words[number / 64] |= 1 << (number % 64);
            }
        };
        for (index, word) in words.iter().enumerate() {
            if words.get(index + 1).is_some_and(|next| is_sort_of(word, next)) {
                continue;
            }
            mark(word);
            inflect::singulars(word).iter().for_each(|form| mark(form));
            inflect::bases(word).iter().for_each(|(form, _)| mark(form));
        }
        said
    }
}

fn is_sort_of(word: &str, thing: &str) -> bool {
    let thing = thing.strip_suffix('s').unwrap_or(thing);
    SORTS.iter().any(|(sorts, things)| sorts.contains(&word) && things.contains(&thing))
}

fn is_denied(words: &[String]) -> bool {
    words
        .windows(2)
        .any(|two| two[1] == "not" && ["am", "im", "is", "are", "its", "it"].contains(&two[0].as_str()))
}

impl Said {
    fn has(&self, number: &usize) -> bool {
        self.words.get(number / 64).is_some_and(|block| block & 1 << (number % 64) != 0)
    }
}

impl Trigger {
    /// How many words it explains, if it fits.
    pub fn fits(&self, said: &Said) -> Option<usize> {
        let met = !self.needed.is_empty()
            && self.needed.iter().all(|options| options.iter().any(|word| said.has(word)))
            && !self.absent.iter().any(|word| said.has(word))
            && (self.says_not || !said.denied);
        met.then_some(self.needed.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trigger_fits_forms_and_alternatives_but_nothing_it_excludes() {
        let mut words = TriggerWords::default();
        let trigger = words.trigger("make/get dark !light");
        let fits = |text: &str| {
            let said: Vec<String> = text.split(' ').map(str::to_owned).collect();
            trigger.fits(&words.said(&said))
        };
        assert_eq!(fits("it is getting dark"), Some(2));
        assert_eq!(fits("make the dark wood light"), None);
        assert_eq!(fits("make it"), None);
        assert_eq!(fits("get the dark mug"), Some(2));
        assert_eq!(fits("it is not getting dark"), None);
    }
}
