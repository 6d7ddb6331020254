//! Who gets what: an assignment of work to members with the smallest estimated makespan.

use std::collections::BTreeMap;

/// Assignments tried one by one up to this many; beyond it, a greedy one is improved by single moves.
const EXHAUSTIVE: usize = 20_000;

/// A piece of work.
#[derive(Clone, Debug)]
pub struct Work {
    /// Pieces that come before it, by index; they point backwards.
    pub after: Vec<usize>,
    /// How many steps it takes each member that can do it; not empty.
    pub cost: BTreeMap<usize, u64>,
}

/// For each piece, its member. Ties go to the least total work, then to roster order.
pub fn assign(work: &[Work]) -> Vec<usize> {
    let options: Vec<Vec<usize>> = work.iter().map(|w| w.cost.keys().copied().collect()).collect();
    let members = |pick: &[usize]| -> Vec<usize> { pick.iter().zip(&options).map(|(&i, o)| o[i]).collect() };
    let score = |pick: &[usize]| estimate(work, &members(pick));
    let choices = options.iter().try_fold(1usize, |n, o| n.checked_mul(o.len()));
    let mut pick = vec![0usize; work.len()];
    if choices.is_some_and(|n| n <= EXHAUSTIVE) {
        let mut best = (score(&pick), pick.clone());
        while advance(&mut pick, &options) {
            let found = score(&pick);
            if found < best.0 {
                best = (found, pick.clone());
            }
        }
        return members(&best.1);
    }
    improve(&mut pick, &options, score);
    members(&pick)
}

/// The next combination, counting like an odometer; false after the last.
fn advance(pick: &mut [usize], options: &[Vec<usize>]) -> bool {
    for i in (0..pick.len()).rev() {
        pick[i] += 1;
        if pick[i] < options[i].len() {
            return true;
        }
        pick[i] = 0;
    }
    false
}

/// Single moves as long as one helps.
fn improve(pick: &mut [usize], options: &[Vec<usize>], score: impl Fn(&[usize]) -> Score) {
    let mut best = score(pick);
    loop {
        let before = best;
        for i in 0..pick.len() {
            for choice in 0..options[i].len() {
                let old = std::mem::replace(&mut pick[i], choice);
                let found = score(pick);
                if found < best {
                    best = found;
                } else {
                    pick[i] = old;
                }
            }
        }
        if best == before {
            return;
        }
    }
}

/// Makespan, total work, and the squares of the members' ends, in steps: the last term leads away from a
/// plateau on which one busy member is as good as another.
type Score = (u64, u64, u64);

/// The score of an assignment. A member does its pieces one after the other; what comes after
/// something else can be prepared before, so that only its last step waits.
fn estimate(work: &[Work], members: &[usize]) -> Score {
    let mut free: BTreeMap<usize, u64> = BTreeMap::new();
    let mut end: Vec<u64> = Vec::with_capacity(work.len());
    let mut total = 0;
    for (piece, &member) in work.iter().zip(members) {
        let steps = piece.cost.get(&member).copied().unwrap_or(0);
        let own = free.get(&member).copied().unwrap_or(0) + steps;
        let waits = piece.after.iter().map(|&p| end[p] + u64::from(steps > 0)).max().unwrap_or(0);
        let at = own.max(waits);
        free.insert(member, at);
        end.push(at);
        total += steps;
    }
    let squares = free.values().map(|end| end * end).sum();
    (end.into_iter().max().unwrap_or(0), total, squares)
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
    fn many_pieces_are_balanced_by_single_moves() {
        let work: Vec<Work> = (0..40).map(|_| piece(&[], &[(0, 3), (1, 3), (2, 3), (3, 3)])).collect();
        let members = assign(&work);
        let load = |m| members.iter().filter(|&&x| x == m).count();
        assert!((0..4).all(|m| load(m) == 10), "{members:?}");
    }
}
