//! Where the words come from, and how phrases and the names of types are filed.

/// The files of a lexicon and those that are built in.
pub const FILES: [(&str, &str); 7] = [
    ("nouns.toml", include_str!("../../../../../domains/household/lexicon/nouns.toml")),
    ("senses.toml", include_str!("../../../../../domains/household/lexicon/senses.toml")),
    ("uses.toml", include_str!("../../../../../domains/household/lexicon/uses.toml")),
    ("verbs.toml", include_str!("../../../../../domains/household/lexicon/verbs.toml")),
    ("words.toml", include_str!("../../../../../domains/household/lexicon/words.toml")),
    ("english.toml", include_str!("../../../../../domains/household/lexicon/english.toml")),
    ("situations.toml", include_str!("../../../../../domains/household/lexicon/situations.toml")),
];

/// A phrase's key: its letters and digits alone, in lower case.
pub fn squash(phrase: &str) -> String {
    phrase.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// `TennisRacket` -> `tennis racket`, `TVStand` -> `tv stand`.
pub fn split_camel_case(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut phrase = String::new();
    for (i, &letter) in letters.iter().enumerate() {
        let after_lower = i > 0 && letters[i - 1].is_lowercase();
        let before_lower = i > 0 && letters.get(i + 1).is_some_and(|next| next.is_lowercase());
        if letter.is_uppercase() && (after_lower || before_lower) {
            phrase.push(' ');
        }
        phrase.extend(letter.to_lowercase());
    }
    phrase.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camel_case_splits_into_words() {
        assert_eq!(split_camel_case("TennisRacket"), "tennis racket");
        assert_eq!(split_camel_case("TVStand"), "tv stand");
        assert_eq!(split_camel_case("CD"), "cd");
    }
}
