//! Sets of rows of objects, such as a predicate's facts, as a few patterns: rows with gaps.

use super::join::UNBOUND;
use crate::lifted::{LiftedAtom, Term};

/// The patterns of one set before they become one.
const MAX_PATTERNS: usize = 48;

/// For each argument an object, or [`UNBOUND`]: any.
pub(super) type Pattern = Vec<u32>;

/// A set of rows, as a few patterns.
#[derive(Clone, Default)]
pub(super) struct Patterns(pub Vec<Pattern>);

impl Patterns {
    /// Adds a pattern; returns what that makes new, which may be more.
    pub fn add(&mut self, pattern: Pattern) -> Option<Pattern> {
        if self.0.iter().any(|known| covers(known, &pattern)) {
            return None;
        }
        let mut added = pattern;
        if self.0.len() >= MAX_PATTERNS {
            for known in &self.0 {
                added.iter_mut().zip(known).filter(|(a, b)| a != b).for_each(|(a, _)| *a = UNBOUND);
            }
        }
        self.0.retain(|known| !covers(&added, known));
        self.0.push(added.clone());
        Some(added)
    }
}

/// Whether every row of one pattern is a row of the other.
pub(super) fn covers(general: &[u32], special: &[u32]) -> bool {
    general.iter().zip(special).all(|(&a, &b)| a == UNBOUND || a == b)
}

/// What two patterns have in common.
pub(super) fn meet(a: &[u32], b: &[u32]) -> Option<Pattern> {
    let one = |(&a, &b): (&u32, &u32)| match (a, b) {
        (UNBOUND, other) | (other, UNBOUND) => Some(other),
        (a, b) => (a == b).then_some(a),
    };
    a.iter().zip(b).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_grows_and_says_what_is_new() {
        let mut set = Patterns::default();
        assert_eq!(set.add(vec![1, 2]), Some(vec![1, 2]));
        assert_eq!(set.add(vec![1, 2]), None, "known");
        assert_eq!(set.add(vec![1, UNBOUND]), Some(vec![1, UNBOUND]));
        assert_eq!(set.0, [vec![1, UNBOUND]], "the special one is part of the general one");
        for object in 0..MAX_PATTERNS as u32 {
            set.add(vec![7, object]);
        }
        assert_eq!(set.0, [vec![UNBOUND, UNBOUND]], "too many become one that covers all");
        assert_eq!(meet(&[1, UNBOUND], &[UNBOUND, 2]), Some(vec![1, 2]));
        assert_eq!(meet(&[1, 2], &[2, UNBOUND]), None);
    }
}

/// An atom's arguments under a binding.
pub(super) fn row(atom: &LiftedAtom, binding: &[u32]) -> Pattern {
    let value = |term: &Term| match term {
        Term::Object(object) => *object,
        Term::Variable(slot) => binding.get(*slot as usize).copied().unwrap_or(UNBOUND),
    };
    atom.args.iter().map(value).collect()
}
