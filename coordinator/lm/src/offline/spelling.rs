//! Known words by their letters: which of them a strange word may be a slip for.
//!
//! An edit changes two letters of a word's alphabet at most, so a mask of 26 bits leaves few words whose distance
//! has to be worked out.

use super::text::damerau_levenshtein;

/// Words in their order, with what tells them from far ones.
#[derive(Clone, Debug, Default)]
pub struct Spelling {
    words: Vec<Known>,
}

#[derive(Clone, Debug)]
struct Known {
    word: String,
    letters: Vec<char>,
    alphabet: u32,
    /// Said so often that a slip is rather one for it than for another.
    common: bool,
}

impl Spelling {
    /// Of some words, none commoner than another.
    pub fn of<'a>(words: impl Iterator<Item = &'a str>) -> Self {
        Self::with_common(words, |_| false)
    }

    /// Of some words, of which some are said most.
    pub fn with_common<'a>(words: impl Iterator<Item = &'a str>, common: impl Fn(&str) -> bool) -> Self {
        let known = |word: &str| Known {
            word: word.to_owned(),
            letters: word.chars().collect(),
            alphabet: letter_set(word),
            common: common(word),
        };
        Self { words: words.map(known).collect() }
    }

    /// The words of at least three letters that are exactly one edit away, in order.
    pub fn one_edit_away(&self, word: &str) -> impl Iterator<Item = &str> {
        let letters: Vec<char> = word.chars().collect();
        let alphabet = letter_set(word);
        let near = move |known: &&Known| {
            (alphabet ^ known.alphabet).count_ones() <= 2
                && known.letters.len() >= 3
                && known.letters.len().abs_diff(letters.len()) <= 1
                && damerau_levenshtein(&letters, &known.letters) == 1
        };
        self.words.iter().filter(near).map(|known| known.word.as_str())
    }

    /// The nearest word and its distance, if it is near enough; of equally near ones, a common one, the one of the same
    /// length and first letter, then the first in order.
    pub fn nearest(&self, word: &str) -> Option<(String, usize)> {
        let letters: Vec<char> = word.chars().collect();
        let limit = if letters.len() >= 7 { 2 } else { 1 };
        let alphabet = letter_set(word);
        let mut best: Option<((usize, bool, bool, usize), String)> = None;
        for known in &self.words {
            // A plural adds a letter to the two of each edit.
            if (alphabet ^ known.alphabet).count_ones() as usize > 2 * limit + 1
                || known.letters.len() < if known.common { 3 } else { 4 }
                || known.letters.len().abs_diff(letters.len()) > limit
            {
                continue;
            }
            let mut consider = |other: &[char]| {
                let distance = damerau_levenshtein(&letters, other);
                let (first, length) = (letters.first() != other.first(), other.len().abs_diff(letters.len()));
                let score = (distance, !known.common, first, length);
                if distance <= limit && best.as_ref().is_none_or(|(found, _)| score < *found) {
                    best = Some((score, other.iter().collect()));
                }
            };
            consider(&known.letters);
            if letters.last() == Some(&'s') && known.letters.last() != Some(&'s') {
                consider(&[&known.letters[..], &['s']].concat());
            }
        }
        best.map(|(score, answer)| (answer, score.0))
    }
}

/// Which of the letters a to z are in a word.
fn letter_set(word: &str) -> u32 {
    word.bytes().filter(u8::is_ascii_lowercase).fold(0, |set, letter| set | 1 << (letter - b'a'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_the_one_of_the_same_length_and_first_letter() {
        let known = Spelling::of(["bowl", "bread", "fork", "fridge", "tomato"].into_iter());
        assert_eq!(known.nearest("tomatos"), Some(("tomatos".to_owned(), 0)));
        assert_eq!(known.nearest("firdge"), Some(("fridge".to_owned(), 1)));
        assert_eq!(known.nearest("brad"), Some(("bread".to_owned(), 1)));
        assert_eq!(known.nearest("xyzzy"), None);
        assert_eq!(known.one_edit_away("bowk").collect::<Vec<_>>(), ["bowl"]);
    }

    #[test]
    fn a_slip_is_rather_one_for_a_common_word() {
        let words = ["cool", "doll", "pan", "plant", "roll"];
        let known = Spelling::with_common(words.into_iter(), |word| ["cool", "pan"].contains(&word));
        assert_eq!(known.nearest("coll"), Some(("cool".to_owned(), 1)));
        assert_eq!(known.nearest("plan"), Some(("pan".to_owned(), 1)));
    }
}
