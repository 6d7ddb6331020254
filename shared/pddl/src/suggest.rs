//! "Did you mean": the known name nearest to an unknown one.

use crate::name::Name;

/// The name nearest to `wanted` by edit distance without regard to case, if it is near enough to be meant.
pub fn nearest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a Name>) -> Option<&'a Name> {
    // The time is quadratic in the length: beyond this nobody mistypes, somebody attacks.
    const LONGEST: usize = 64;
    const MOST: usize = 20_000;
    if wanted.len() > LONGEST {
        return None;
    }
    // Of one letter nothing is left to recognise.
    let letters = wanted.chars().count();
    if letters < 2 {
        return None;
    }
    let allowed = (letters / 3).max(1);
    known
        .into_iter()
        .filter(|name| name.as_str().len().abs_diff(wanted.len()) <= allowed && *name != wanted)
        .take(MOST)
        .map(|name| (edit_distance(wanted, name.as_str()), name))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by(|a, b| a.cmp(b))
        .map(|(_, name)| name)
}

/// "did you mean `x`?" for the nearest name, else `otherwise`.
pub fn did_you_mean<'a>(
    wanted: &str,
    known: impl IntoIterator<Item = &'a Name>,
    otherwise: impl Into<String>,
) -> String {
    match nearest(wanted, known) {
        Some(name) => format!("did you mean `{name}`?"),
        None => otherwise.into(),
    }
}

/// Insertions, deletions, substitutions and swaps of neighbours (optimal string alignment, Boytsov 2011).
fn edit_distance(a: &str, b: &str) -> usize {
    let letters = |s: &str| s.chars().map(|c| c.to_ascii_lowercase()).collect::<Vec<char>>();
    let (a, b) = (letters(a), letters(b));
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let substitute = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = substitute.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let known: Vec<Name> = ["holding", "at-location", "open"].map(Name::new).to_vec();
        let near = |wanted: &str| nearest(wanted, &known).map(Name::as_str);
        assert_eq!(near("holdign"), Some("holding"), "two letters swapped");
        assert_eq!(near("AT_LOCATION"), Some("at-location"));
        assert_eq!(near("closed"), None);
        assert_eq!(near(&"x".repeat(1000)), None);
        assert_eq!(nearest("p", &[Name::new("q")]), None, "any letter is one letter off any other");
    }
}
