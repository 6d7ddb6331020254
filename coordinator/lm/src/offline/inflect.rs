//! English inflection: from a word as written to the forms a lexicon may hold it under, and back.
//!
//! Rules with a short list of exceptions; a stemmer would fold words together that mean different things
//! ("dishes" are not a "dish").

/// Nouns whose plural no rule gives.
const IRREGULAR_PLURALS: [(&str, &str); 6] = [
    ("knives", "knife"),
    ("shelves", "shelf"),
    ("loaves", "loaf"),
    ("halves", "half"),
    ("leaves", "leaf"),
    ("mice", "mouse"),
];

/// Past forms no rule gives: (form, base).
const IRREGULAR_PAST: [(&str, &str); 33] = [
    ("threw", "throw"),
    ("thrown", "throw"),
    ("took", "take"),
    ("taken", "take"),
    ("brought", "bring"),
    ("held", "hold"),
    ("got", "get"),
    ("gotten", "get"),
    ("made", "make"),
    ("broke", "break"),
    ("broken", "break"),
    ("froze", "freeze"),
    ("frozen", "freeze"),
    ("kept", "keep"),
    ("left", "leave"),
    ("laid", "lay"),
    ("stood", "stand"),
    ("stuck", "stick"),
    ("hung", "hang"),
    ("lit", "light"),
    ("drew", "draw"),
    ("drawn", "draw"),
    ("went", "go"),
    ("found", "find"),
    ("hidden", "hide"),
    ("swept", "sweep"),
    ("ate", "eat"),
    ("eaten", "eat"),
    ("drank", "drink"),
    ("written", "write"),
    ("wrote", "write"),
    ("worn", "wear"),
    ("slept", "sleep"),
];

/// The singulars a noun may be the plural of, likeliest first; empty when it does not look like a plural.
pub fn singulars(word: &str) -> Vec<String> {
    if let Some((_, singular)) = IRREGULAR_PLURALS.iter().find(|(plural, _)| *plural == word) {
        return vec![(*singular).to_owned()];
    }
    let mut found = Vec::new();
    if word.len() > 2
        && let Some(stem) = word.strip_suffix('s')
        && !stem.ends_with('s')
    {
        found.push(stem.to_owned());
        if let Some(stem) = word.strip_suffix("ies") {
            found.push(format!("{stem}y"));
        }
        if let Some(stem) = word.strip_suffix("ves") {
            found.push(format!("{stem}fe"));
            found.push(format!("{stem}f"));
        }
        if let Some(stem) = word.strip_suffix("es") {
            found.push(stem.to_owned());
        }
    } else if let Some(stem) = word.strip_suffix("sses") {
        found.push(format!("{stem}ss"));
    }
    found
}

/// How a verb was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerbForm {
    /// `wash`, `washes`
    Base,
    /// `washing`
    Gerund,
    /// `washed`: also a participle, so also an adjective
    Past,
}

/// The base forms a verb form may come from, likeliest first.
pub fn bases(word: &str) -> Vec<(String, VerbForm)> {
    let mut found = vec![(word.to_owned(), VerbForm::Base)];
    for (form, base) in IRREGULAR_PAST {
        if form == word {
            found.push((base.to_owned(), VerbForm::Past));
        }
    }
    for (suffix, form) in [("ing", VerbForm::Gerund), ("ed", VerbForm::Past)] {
        let Some(stem) = word.strip_suffix(suffix).filter(|stem| stem.len() >= 2) else { continue };
        found.push((stem.to_owned(), form));
        found.push((format!("{stem}e"), form));
        let mut letters = stem.chars().rev();
        if let (Some(last), Some(before)) = (letters.next(), letters.next())
            && last == before
        {
            found.push((stem[..stem.len() - last.len_utf8()].to_owned(), form));
        }
        if let Some(stem) = stem.strip_suffix('i') {
            found.push((format!("{stem}y"), form));
        }
    }
    if word.len() > 3
        && let Some(stem) = word.strip_suffix('s')
        && !stem.ends_with('s')
    {
        found.push((stem.to_owned(), VerbForm::Base));
        if let Some(stem) = word.strip_suffix("es") {
            found.push((stem.to_owned(), VerbForm::Base));
        }
        if let Some(stem) = word.strip_suffix("ies") {
            found.push((format!("{stem}y"), VerbForm::Base));
        }
    }
    found
}

/// The number a word stands for.
pub fn number(word: &str) -> Option<usize> {
    const WORDS: [&str; 13] = [
        "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
        "twelve",
    ];
    if let Some(value) = WORDS.iter().position(|known| *known == word) {
        return Some(value);
    }
    word.parse::<usize>().ok().filter(|value| (1..=99).contains(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plurals_and_verb_forms_lead_back_to_their_bases() {
        for (plural, singular) in [
            ("tomatoes", "tomato"),
            ("knives", "knife"),
            ("veggies", "veggie"),
            ("batteries", "battery"),
            ("boxes", "box"),
            ("glasses", "glass"),
            ("cups", "cup"),
        ] {
            assert!(singulars(plural).iter().any(|found| found == singular), "{plural}");
        }
        for (form, base) in [
            ("putting", "put"),
            ("placed", "place"),
            ("washes", "wash"),
            ("carried", "carry"),
            ("slicing", "slice"),
            ("thrown", "throw"),
            ("chopped", "chop"),
        ] {
            assert!(bases(form).iter().any(|(found, _)| found == base), "{form}");
        }
        assert!(singulars("glass").is_empty());
        assert_eq!(number("three"), Some(3));
    }
}
