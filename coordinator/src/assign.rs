//! Who gets what: an assignment of work to members with the smallest estimated makespan.
//!
//! Up to a few dozen pieces the smallest is found and proved by branch and bound ([`exact`]); more than that is
//! auctioned and improved by moves and swaps ([`auction`]), with a lower bound ([`bound`]) beside it.

mod auction;
mod bound;
mod exact;

use std::collections::BTreeMap;

pub use bound::lower_bound;

/// Pieces up to which a proof is tried.
const EXACT: usize = 24;

/// Nodes of the search for a proof: a fraction of a second.
const NODES: u64 = 3_000_000;

/// A piece of work.
#[derive(Clone, Debug)]
pub struct Work {
    /// Pieces that come before it, by index; they point backwards.
    pub after: Vec<usize>,
    /// How many steps it takes each member that can do it; not empty.
    pub cost: BTreeMap<usize, u64>,
}

/// An assignment and what is known about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// For each piece, its member.
    pub members: Vec<usize>,
    /// When the last piece is done, in steps.
    pub makespan: u64,
    /// No assignment of these pieces is done earlier.
    pub bound: u64,
}

impl Assignment {
    /// Whether it is proved to have the smallest makespan.
    pub fn is_proved(&self) -> bool {
        self.makespan <= self.bound
    }
}

/// For each piece, its member. Ties go to the least total work, then to roster order.
pub fn assign(work: &[Work]) -> Vec<usize> {
    assign_proved(work).members
}

/// [`assign`] with its makespan and a lower bound.
pub fn assign_proved(work: &[Work]) -> Assignment {
    let start = auction::auction(work);
    let bound = lower_bound(work);
    if work.len() > EXACT {
        return Assignment { makespan: estimate(work, &start).0, members: start, bound };
    }
    let (members, complete) = exact::search(work, start, bound, NODES);
    let makespan = estimate(work, &members).0;
    Assignment { makespan, members, bound: if complete { makespan } else { bound } }
}

/// Makespan, total work, and the squares of the members' ends, in steps: the last term leads away from a
/// plateau on which one busy member is as good as another.
type Score = (u64, u64, u64);

/// The score of an assignment. A member does its pieces one after the other; what comes after
/// something else can be prepared before, so that only its last step waits.
fn estimate(work: &[Work], members: &[usize]) -> Score {
    let mut free = vec![0u64; members.iter().max().map_or(0, |&m| m + 1)];
    let mut end: Vec<u64> = Vec::with_capacity(work.len());
    let mut total = 0;
    for (piece, &member) in work.iter().zip(members) {
        let steps = piece.cost.get(&member).copied().unwrap_or(0);
        let at = piece_end(piece, steps, free[member], &end);
        free[member] = at;
        end.push(at);
        total += steps;
    }
    (end.into_iter().max().unwrap_or(0), total, free.iter().map(|end| end * end).sum())
}

/// When a piece of so many steps is done by a member that is free then.
fn piece_end(piece: &Work, steps: u64, free: u64, end: &[u64]) -> u64 {
    let waits = piece.after.iter().map(|&p| end[p] + u64::from(steps > 0)).max().unwrap_or(0);
    (free + steps).max(waits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(after: &[usize], cost: &[(usize, u64)]) -> Work {
        Work { after: after.to_vec(), cost: cost.iter().copied().collect() }
    }

    #[test]
    fn equal_work_goes_to_different_members() {
        let work = [piece(&[], &[(0, 5), (1, 5)]), piece(&[], &[(0, 5), (1, 5)])];
        assert_eq!(assign(&work), [0, 1]);
    }

    #[test]
    fn who_is_free_prepares_what_has_to_wait() {
        let work =
            [piece(&[], &[(0, 5), (1, 5)]), piece(&[], &[(0, 5), (1, 5)]), piece(&[0, 1], &[(0, 2), (2, 2)])];
        assert_eq!(assign(&work), [0, 1, 2]);
    }

    #[test]
    fn a_slow_member_is_left_out_when_that_is_faster() {
        let work = [piece(&[], &[(0, 2), (1, 20)]), piece(&[], &[(0, 2), (1, 20)])];
        assert_eq!(assign(&work), [0, 0]);
    }

    #[test]
    fn many_pieces_are_balanced() {
        let work: Vec<Work> = (0..40).map(|_| piece(&[], &[(0, 3), (1, 3), (2, 3), (3, 3)])).collect();
        let found = assign_proved(&work);
        let load = |m| found.members.iter().filter(|&&x| x == m).count();
        assert!((0..4).all(|m| load(m) == 10), "{found:?}");
        assert!(found.is_proved(), "{found:?}");
    }

    /// Every assignment, one by one.
    fn exhaustive(work: &[Work]) -> Score {
        let options: Vec<Vec<usize>> = work.iter().map(|w| w.cost.keys().copied().collect()).collect();
        let mut best = (u64::MAX, 0, 0);
        let count: usize = options.iter().map(Vec::len).product();
        for mut code in 0..count {
            let members: Vec<usize> = options
                .iter()
                .map(|o| {
                    let pick = o[code % o.len()];
                    code /= o.len();
                    pick
                })
                .collect();
            best = best.min(estimate(work, &members));
        }
        best
    }

    #[test]
    fn branch_and_bound_finds_what_trying_everything_finds() {
        let mut seed = 7u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) % n
        };
        for case in 0..300 {
            let (pieces, members) = (1 + random(6) as usize, 1 + random(3) as usize);
            let work: Vec<Work> = (0..pieces)
                .map(|i| {
                    let after = (0..i).filter(|_| random(5) == 0).collect();
                    let mut cost: BTreeMap<usize, u64> = BTreeMap::new();
                    for member in 0..members {
                        if random(4) > 0 {
                            cost.insert(member, random(12));
                        }
                    }
                    cost.entry(random(members as u64) as usize).or_insert(4);
                    Work { after, cost }
                })
                .collect();
            let found = assign_proved(&work);
            let best = exhaustive(&work);
            let score = estimate(&work, &found.members);
            assert!(found.is_proved(), "case {case}: {found:?}");
            assert_eq!((score.0, score.1), (best.0, best.1), "case {case}: {work:?}");
            assert!(lower_bound(&work) <= best.0, "case {case}: the bound is above the best");
        }
    }
}
