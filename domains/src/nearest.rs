//! "Did you mean …": the nearest of the known names.

/// The candidate nearest to `word`, ignoring case, if it is near enough to be meant.
///
/// Distance is Damerau-Levenshtein with adjacent transpositions ("optimal string alignment"); up to a third
/// of the word may differ, at least one letter. Of equally near candidates the first is taken.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (word.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .map(|c| (distance(&word.to_ascii_lowercase(), &c.to_ascii_lowercase()), c))
        .filter(|(d, _)| *d <= allowed)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

/// `; did you mean …?` or nothing: for the end of an error message.
pub fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, candidates).map(|c| format!("; did you mean `{c}`?")).unwrap_or_default()
}

/// How many single-letter edits and swaps of neighbours lead from one word to the other.
pub fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let edge = |i: usize, j: usize| if i == 0 { j } else { i };
    let row = |i: usize| (0..=b.len()).map(|j| edge(i, j)).collect();
    let mut rows: Vec<Vec<usize>> = (0..=a.len()).map(row).collect();
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            let mut best = (rows[i - 1][j] + 1).min(rows[i][j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_found_and_a_stranger_is_not() {
        let names = ["Lettuce", "Laptop", "Fridge", "Pen", "Pencil"];
        assert_eq!(nearest("letuce", names), Some("Lettuce"));
        assert_eq!(nearest("Labtop", names), Some("Laptop"));
        assert_eq!(nearest("Pensil", names), Some("Pencil"));
        assert_eq!(nearest("Firdge", names), Some("Fridge"));
        assert_eq!(nearest("Zeppelin", names), None);
    }
}
