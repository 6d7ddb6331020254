//! From characters to words: case, punctuation, contractions, and spelling repaired against what the scene
//! and the lexicon know.

use super::lexicon::{DICTIONARY, Lexicon};
use super::scene::Scene;

/// The longest instruction read, in bytes.
pub const LONGEST_INSTRUCTION: usize = 4096;

/// The token behind a noun that ends in "'s".
pub const POSSESSIVE: &str = "'s";

/// Words whose "'s" is "is" or "us".
const CONTRACTED: [&str; 10] = ["it", "that", "there", "let", "what", "where", "here", "he", "she", "who"];

/// A word or a mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// In lower case, repaired.
    pub text: String,
    /// As it was typed.
    pub typed: String,
}

impl Token {
    /// A word that nobody typed.
    pub fn said(word: &str) -> Self {
        Self { text: word.to_owned(), typed: word.to_owned() }
    }
}

/// Splits an instruction into words and the marks that separate clauses.
pub fn tokens(instruction: &str) -> Vec<Token> {
    let instruction = &instruction.replace("i.e.", "ie").replace("I.e.", "ie").replace("e.g.", "eg");
    let mut found = Vec::new();
    let mut word = String::new();
    let flush = |word: &mut String, found: &mut Vec<Token>| {
        if word.is_empty() {
            return;
        }
        let typed = std::mem::take(word);
        let lower = typed.to_lowercase();
        let whole = lower.trim_matches('\'');
        let text = whole.trim_end_matches("'s").replace('\'', "");
        let possessive = whole.ends_with("'s") && !CONTRACTED.contains(&text.as_str());
        if !text.is_empty() {
            found.push(Token { text, typed });
        }
        if possessive {
            found.push(Token { text: POSSESSIVE.to_owned(), typed: String::new() });
        }
    };
    let mut before = ' ';
    let mut letters = instruction.chars().peekable();
    while let Some(c) = letters.next() {
        // " - " sets something apart; "t-shirt" does not.
        let apart = c == '-' && before == ' ' && letters.peek() == Some(&' ');
        before = c;
        match c {
            '\u{2013}' | '\u{2014}' | '(' | ')' => {
                flush(&mut word, &mut found);
                found.push(Token { text: ",".to_owned(), typed: c.to_string() });
            }
            '-' if apart => found.push(Token { text: ",".to_owned(), typed: c.to_string() }),
            c if c.is_alphanumeric() || c == '_' => word.push(c),
            '\'' | '\u{2019}' | '`' => word.push('\''),
            ',' | ';' | '.' | '!' | '?' | ':' | '\n' => {
                flush(&mut word, &mut found);
                let mark = match c {
                    ',' => ",",
                    _ => ".",
                };
                found.push(Token { text: mark.to_owned(), typed: c.to_string() });
            }
            '&' | '+' | '/' => {
                flush(&mut word, &mut found);
                found.push(Token { text: "and".to_owned(), typed: c.to_string() });
            }
            '>' | '=' | '\u{2192}' => {
                flush(&mut word, &mut found);
                found.push(Token { text: "to".to_owned(), typed: c.to_string() });
            }
            _ => flush(&mut word, &mut found),
        }
    }
    flush(&mut word, &mut found);
    found
}

/// Repairs words that neither the lexicon nor the scene knows, where exactly one known word is near.
/// Returns what was repaired.
pub fn repair_spelling(tokens: &mut [Token], lexicon: &Lexicon, scene: &Scene) -> Vec<String> {
    let mut repairs = Vec::new();
    let is_word = |token: &&Token| token.text.chars().any(char::is_alphabetic);
    let strange = |token: &&Token| {
        is_word(token)
            && !is_known(&token.text, lexicon, scene)
            && lexicon.longest_small("polite", &[&token.text]).is_none()
    };
    let unknown = tokens.iter().filter(strange).count();
    let plain = tokens.iter().filter(is_word).filter(|t| !super::syntax::is_function_word(&t.text)).count();
    if unknown > 8 && 2 * unknown > plain {
        return repairs;
    }
    let mut repaired: Vec<Token> = tokens.to_vec();
    // "bung the egg in the fridge": what stands where a verb is due is no thing misspelt.
    let verb_is_due = |at: usize| {
        let opens = at == 0 || [",", ".", "and", "then"].contains(&tokens[at - 1].text.as_str());
        opens && tokens.get(at + 1).is_some_and(|next| ["the", "a", "an", "my"].contains(&next.text.as_str()))
    };
    let due: Vec<bool> = (0..tokens.len()).map(verb_is_due).collect();
    // "We leave for Spain": a name is no slip, unless for the name of a thing.
    let name = |at: usize| {
        let large = tokens[at].typed.chars().next().is_some_and(char::is_uppercase);
        large && at > 0 && tokens[at - 1].text != "." && tokens[at].typed.chars().any(char::is_lowercase)
    };
    let names: Vec<bool> = (0..tokens.len()).map(name).collect();
    for ((token, due), name) in repaired.iter_mut().zip(due).zip(names) {
        let meant = repair(&token.text, lexicon, scene);
        let fits = |meant: &String| {
            (!due || super::syntax::is_function_word(meant) || !lexicon.verbs(meant).is_empty())
                && (!name || lexicon.noun(&[meant]).is_some())
        };
        if let Some(text) = meant.filter(fits) {
            token.text = text;
            repairs.push(repair_note(token));
        }
    }
    // Where most words are strange and stay so the sentence is not misspelt but in another language.
    if unknown > 2 && 2 * unknown > plain && repairs.len() < unknown {
        return Vec::new();
    }
    tokens.clone_from_slice(&repaired);
    repairs
}

/// The word that a strange one is taken for, if exactly one known word is near.
fn repair(word: &str, lexicon: &Lexicon, scene: &Scene) -> Option<String> {
    let strange = word.len() >= 4 && word.chars().all(|c| c.is_ascii_alphabetic());
    if !strange || is_known(word, lexicon, scene) || lexicon.is_small(DICTIONARY, &[word]) {
        return None;
    }
    // "putt": a letter struck twice.
    let mut letters = word.chars().rev();
    if letters.next() == letters.next() && !lexicon.verbs(&word[..word.len() - 1]).is_empty() {
        return Some(word[..word.len() - 1].to_owned());
    }
    let in_scene = scene.spelling().nearest(word);
    let in_lexicon = lexicon.spelling().nearest(word);
    let best = match (in_scene, in_lexicon) {
        (Some(scene), Some(lexicon)) if scene.1 <= lexicon.1 => Some(scene),
        (_, Some(lexicon)) => Some(lexicon),
        (scene, None) => scene,
    };
    best.map(|(repaired, _)| repaired)
}

/// Leaves out the numbers of a list: "1. wash the fork 2. dry it".
pub fn without_list_numbers(tokens: Vec<Token>) -> Vec<Token> {
    let is_number = |at: usize| {
        let digits = tokens[at].text.chars().all(|c| c.is_ascii_digit());
        let full_stop = tokens.get(at + 1).is_some_and(|next| next.text == ".");
        digits && full_stop && at + 2 < tokens.len()
    };
    let kept = (0..tokens.len()).filter(|&at| !is_number(at));
    kept.map(|at| tokens[at].clone()).collect()
}

/// Splits what was run together with an article: "putthe", "inthe".
pub fn split_articles(tokens: Vec<Token>, lexicon: &Lexicon, scene: &Scene) -> Vec<Token> {
    let mut found = Vec::with_capacity(tokens.len());
    for token in tokens {
        let front = token.text.strip_suffix("the").filter(|front| {
            let is_front = !lexicon.verbs(front).is_empty() || super::syntax::preposition(&[front]).is_some();
            front.len() > 1 && is_front && !is_known(&token.text, lexicon, scene)
        });
        match front {
            Some(front) => {
                found.push(Token { text: front.to_owned(), typed: token.typed.clone() });
                found.push(Token { text: "the".to_owned(), typed: String::new() });
            }
            None => found.push(token),
        }
    }
    found
}

/// How a repair is told.
pub fn repair_note(token: &Token) -> String {
    format!("read \"{}\" as \"{}\"", token.typed, token.text)
}

/// A text with a repaired word as it was typed, for questions.
pub fn in_own_words(text: &str, repaired: &str, typed: &str) -> String {
    let is_letter = |c: char| c.is_alphanumeric();
    let mut result = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(repaired) {
        let (front, behind) = (&rest[..at], &rest[at + repaired.len()..]);
        let whole = !front.chars().next_back().or(result.chars().next_back()).is_some_and(is_letter)
            && !behind.chars().next().is_some_and(is_letter);
        result.push_str(front);
        result.push_str(if whole { typed } else { repaired });
        rest = behind;
    }
    result + rest
}

/// An instruction as it is quoted: its beginning, if it is long.
pub fn shortened(instruction: &str) -> String {
    const LONGEST: usize = 120;
    let said = instruction.trim();
    match said.char_indices().nth(LONGEST) {
        Some((at, _)) => format!("{} …", said[..at].trim_end()),
        None => said.to_owned(),
    }
}

/// Words without those at the end of a sentence or of a part of it that say only how soon or how politely.
pub fn without_endings(words: &[String], lexicon: &Lexicon) -> Vec<String> {
    let is_end = |word: &str| [".", ","].contains(&word);
    let mut kept: Vec<String> = Vec::with_capacity(words.len());
    let mut part = 0;
    for word in words.iter().map(String::as_str).chain(std::iter::once(".")) {
        if is_end(word) {
            while let Some(length) = ending(&kept[part..], lexicon) {
                kept.truncate(kept.len() - length);
            }
        }
        kept.push(word.to_owned());
        if is_end(word) {
            part = kept.len();
        }
    }
    kept.pop();
    kept
}

/// How many words of an ending stand behind something else.
fn ending(words: &[String], lexicon: &Lexicon) -> Option<usize> {
    let longest = words.len().saturating_sub(1).min(super::lexicon::LONGEST);
    (1..=longest).rev().find(|&length| {
        let last: Vec<&str> = words[words.len() - length..].iter().map(String::as_str).collect();
        lexicon.is_small("endings", &last)
    })
}

/// Words without what is put in between commas and says nothing: "the bread, however, goes …".
pub fn without_asides(words: Vec<String>, lexicon: &Lexicon) -> Vec<String> {
    let aside = |at: usize| {
        words[at] == ","
            && (1..=super::lexicon::LONGEST).any(|length| {
                let between: Option<Vec<&str>> =
                    (at + 1..=at + length).map(|i| words.get(i).map(String::as_str)).collect();
                words.get(at + length + 1).is_some_and(|word| word == ",")
                    && between.is_some_and(|between| lexicon.is_small("asides", &between))
            })
    };
    let mut kept = Vec::with_capacity(words.len());
    let mut at = 0;
    while at < words.len() {
        if aside(at) {
            let closes = at + 1 + words[at + 1..].iter().position(|word| word == ",").unwrap_or(0);
            // "the cup, please, the bowl and …": the list goes on.
            let goes_on = words.get(closes + 1).is_some_and(|word| super::syntax::is_determiner(word));
            at = if goes_on { closes } else { closes + 1 };
        } else {
            kept.push(words[at].clone());
            at += 1;
        }
    }
    kept
}

/// Whether no word is known to mean a thing, a doing or a state.
pub fn says_nothing(words: &[String], lexicon: &Lexicon, scene: &Scene) -> bool {
    let means = |word: &String| {
        scene.named(word).is_some()
            || !super::syntax::is_function_word(word) && is_known(word, lexicon, scene)
            || super::syntax::preposition(&[word]).is_some()
    };
    !words.iter().any(means)
}

/// Whether a word needs no repair.
pub fn is_known(word: &str, lexicon: &Lexicon, scene: &Scene) -> bool {
    super::syntax::is_function_word(word)
        || lexicon.vocabulary().contains(word)
        || lexicon.noun(&[word]).is_some()
        || lexicon.adjective(&[word]).is_some()
        || !lexicon.verbs(word).is_empty()
        || super::inflect::number(word).is_some()
        || scene.has_word(word)
        || super::inflect::singulars(word)
            .iter()
            .any(|s| lexicon.vocabulary().contains(s) || scene.has_word(s))
}

/// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours
/// (F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM 7(3), 1964).
pub fn damerau_levenshtein(a: &[char], b: &[char]) -> usize {
    let width = b.len() + 1;
    let mut table = vec![0; (a.len() + 1) * width];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            table[i * width + j] = if i == 0 || j == 0 {
                i + j
            } else {
                let cost = usize::from(a[i - 1] != b[j - 1]);
                let mut best = (table[(i - 1) * width + j] + 1)
                    .min(table[i * width + j - 1] + 1)
                    .min(table[(i - 1) * width + j - 1] + cost);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    best = best.min(table[(i - 2) * width + j - 2] + 1);
                }
                best
            };
        }
    }
    table[a.len() * width + b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: &str, b: &str) -> usize {
        damerau_levenshtein(&a.chars().collect::<Vec<_>>(), &b.chars().collect::<Vec<_>>())
    }

    #[test]
    fn distances_count_swaps_as_one() {
        assert_eq!(distance("tomatoe", "tomato"), 1);
        assert_eq!(distance("firdge", "fridge"), 1);
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn marks_and_contractions_are_split() {
        let words: Vec<String> =
            tokens("Don't open it; it's Tom's CD's & book.").into_iter().map(|t| t.text).collect();
        assert_eq!(words, ["dont", "open", "it", ".", "it", "tom", "'s", "cd", "'s", "and", "book", "."]);
    }
}
