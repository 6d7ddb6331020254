//! The prepositions, and what they say of where a thing is.

use super::Relation;

/// Prepositions, the longer first.
const PREPOSITIONS: [(&str, Relation); 95] = [
    ("along side of", Relation::Near),
    ("along side", Relation::Near),
    ("alongside", Relation::Near),
    ("at the side of", Relation::Near),
    ("on each side of", Relation::Near),
    ("on either side of", Relation::Near),
    ("on both sides of", Relation::Near),
    ("in the front of", Relation::Near),
    ("in the place of", Relation::Near),
    ("on top the", Relation::In),
    ("next the", Relation::Near),
    ("next a", Relation::Near),
    ("beside of", Relation::Near),
    ("to the left side of", Relation::Near),
    ("to the right side of", Relation::Near),
    ("to the left of", Relation::Near),
    ("to the right of", Relation::Near),
    ("on the left of", Relation::Near),
    ("on the right of", Relation::Near),
    ("at the left of", Relation::Near),
    ("at the right of", Relation::Near),
    ("to the side of", Relation::Near),
    ("with the help of", Relation::With),
    ("by the light of", Relation::With),
    ("in the light of", Relation::With),
    ("under the light of", Relation::With),
    ("with the light of", Relation::With),
    ("in the direction of", Relation::Near),
    ("in front of", Relation::Near),
    ("in back of", Relation::Near),
    ("on top of", Relation::In),
    ("to the top of", Relation::To),
    ("in between", Relation::Near),
    ("left of", Relation::Near),
    ("right of", Relation::Near),
    ("next to", Relation::Near),
    ("close to", Relation::Near),
    ("closest to", Relation::Near),
    ("nearest to", Relation::Near),
    ("adjacent to", Relation::Near),
    ("across from", Relation::Near),
    ("opposite of", Relation::Near),
    ("facing", Relation::Near),
    ("out of", Relation::From),
    ("away from", Relation::From),
    ("off of", Relation::From),
    ("inside of", Relation::In),
    ("back to", Relation::To),
    ("back into", Relation::To),
    ("back onto", Relation::To),
    ("back in", Relation::To),
    ("back on", Relation::To),
    ("over to", Relation::To),
    ("on to", Relation::To),
    ("in to", Relation::To),
    ("over at", Relation::In),
    ("down on", Relation::In),
    ("along with", Relation::With),
    ("together with", Relation::With),
    ("by means of", Relation::With),
    ("beside", Relation::Near),
    ("besides", Relation::Near),
    ("beneath", Relation::Near),
    ("underneath", Relation::Near),
    ("under", Relation::Near),
    ("below", Relation::Near),
    ("above", Relation::Near),
    ("behind", Relation::Near),
    ("between", Relation::Near),
    ("among", Relation::Near),
    ("against", Relation::Near),
    ("around", Relation::Near),
    ("near", Relation::Near),
    ("nearest", Relation::Near),
    ("by", Relation::Near),
    ("beyond", Relation::Near),
    ("into", Relation::To),
    ("onto", Relation::To),
    ("to", Relation::To),
    ("towards", Relation::To),
    ("toward", Relation::To),
    ("inside", Relation::In),
    ("within", Relation::In),
    ("upon", Relation::In),
    ("atop", Relation::In),
    ("over", Relation::In),
    ("in", Relation::In),
    ("on", Relation::In),
    ("at", Relation::Near),
    ("from", Relation::From),
    ("off", Relation::From),
    ("with", Relation::With),
    ("using", Relation::With),
    ("via", Relation::With),
    ("for", Relation::For),
];

/// The preposition at the start of the words: its relation and length.
pub fn preposition(words: &[&str]) -> Option<(Relation, usize)> {
    let first = words.first()?;
    if let Some(length) = to_one_side_of(words) {
        return Some((Relation::Near, length));
    }
    if !may_begin_one(first) {
        return None;
    }
    PREPOSITIONS.iter().find_map(|(phrase, relation)| {
        let rest = phrase.strip_prefix(first)?;
        if rest.is_empty() {
            return Some((*relation, 1));
        }
        let mut length = 1;
        for part in rest.strip_prefix(' ')?.split(' ') {
            if words.get(length) != Some(&part) {
                return None;
            }
            length += 1;
        }
        Some((*relation, length))
    })
}

/// "to the bottom left of", "to the far right side of": its length.
fn to_one_side_of(words: &[&str]) -> Option<usize> {
    const SIDES: [&str; 13] = [
        "left",
        "right",
        "side",
        "hand",
        "far",
        "near",
        "bottom",
        "top",
        "upper",
        "lower",
        "immediate",
        "other",
        "rear",
    ];
    let sides = words.strip_prefix(&["to", "the"])?;
    let length = sides.iter().take_while(|word| SIDES.contains(word)).count();
    let beside = sides[..length].iter().any(|word| ["left", "right", "side"].contains(word));
    (beside && sides.get(length) == Some(&"of")).then_some(length + 3)
}

/// Whether a word begins a preposition: most do not, and this is asked of every word many times.
fn may_begin_one(word: &str) -> bool {
    matches!(
        word,
        "above"
            | "across"
            | "adjacent"
            | "against"
            | "along"
            | "alongside"
            | "among"
            | "around"
            | "at"
            | "atop"
            | "away"
            | "back"
            | "behind"
            | "below"
            | "beneath"
            | "beside"
            | "besides"
            | "between"
            | "beyond"
            | "by"
            | "close"
            | "closest"
            | "down"
            | "facing"
            | "for"
            | "from"
            | "in"
            | "inside"
            | "into"
            | "left"
            | "near"
            | "nearest"
            | "next"
            | "off"
            | "on"
            | "onto"
            | "opposite"
            | "out"
            | "over"
            | "right"
            | "to"
            | "together"
            | "toward"
            | "towards"
            | "under"
            | "underneath"
            | "upon"
            | "using"
            | "via"
            | "with"
            | "within"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preposition_is_found_by_its_words() {
        for (phrase, _) in PREPOSITIONS {
            let words: Vec<&str> = phrase.split(' ').collect();
            assert_eq!(preposition(&words).map(|(_, length)| length), Some(words.len()), "{phrase}");
        }
    }
}
