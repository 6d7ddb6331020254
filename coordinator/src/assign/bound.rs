//! A lower bound of the makespan of any assignment.

use std::collections::BTreeMap;

use super::Work;

/// Costs looked at by the subgradient method, and the most and the fewest steps it takes with that.
const EFFORT: usize = 8_000_000;
const ROUNDS: std::ops::RangeInclusive<usize> = 60..=400;

/// Shares are counted in so many parts, so that the bound is exact arithmetic.
pub(super) const PARTS: u64 = 1 << 24;

/// The larger of two bounds: the longest chain of pieces that wait for each other, each by its fastest
/// member; and the load. For the latter every member gets a share of one whole; a member busy for T steps
/// takes its share of T, all together T, so the sum over the pieces of the least share-weighted cost is never
/// more than T (Lagrangian relaxation of the members' capacities; the shares by the subgradient method: Held,
/// Wolfe & Crowder, "Validation of subgradient optimization", Mathematical Programming 6, 1974).
pub fn lower_bound(work: &[Work]) -> u64 {
    chain(work).max(shares(work).1)
}

pub(super) fn chain(work: &[Work]) -> u64 {
    let mut end: Vec<u64> = Vec::with_capacity(work.len());
    for piece in work {
        let fastest = piece.cost.values().min().copied().unwrap_or(0);
        let waits = piece.after.iter().map(|&p| end[p] + u64::from(fastest > 0)).max().unwrap_or(0);
        end.push(fastest.max(waits));
    }
    end.into_iter().max().unwrap_or(0)
}

/// Each member's share, in [`PARTS`] that sum to no more than one whole, and the bound they give.
pub(super) fn shares(work: &[Work]) -> (BTreeMap<usize, u64>, u64) {
    let mut members: Vec<usize> = work.iter().flat_map(|w| w.cost.keys().copied()).collect();
    members.sort_unstable();
    members.dedup();
    if members.is_empty() {
        return (BTreeMap::new(), 0);
    }
    let place: BTreeMap<usize, usize> = members.iter().enumerate().map(|(at, &m)| (m, at)).collect();
    let rows: Vec<Vec<(usize, f64)>> =
        work.iter().map(|w| w.cost.iter().map(|(m, &steps)| (place[m], steps as f64)).collect()).collect();
    let parts = whole(&ascent(&rows, members.len()));
    let least = |w: &Work| w.cost.iter().map(|(m, &steps)| steps * parts[place[m]]).min();
    let sum: u64 = work.iter().filter_map(least).sum();
    (members.iter().copied().zip(parts.iter().copied()).collect(), sum.div_ceil(PARTS))
}

/// Shares that make the bound large: towards who is overloaded when every piece goes where it is cheapest. First in
/// proportion, which soon finds members that many pieces need; then by steps as long as the bound is hoped to grow.
fn ascent(rows: &[Vec<(usize, f64)>], members: usize) -> Vec<f64> {
    let entries: usize = rows.iter().map(Vec::len).sum();
    let rounds = (EFFORT / entries.max(1)).clamp(*ROUNDS.start(), *ROUNDS.end());
    let mut share = start(rows, members);
    let (mut best, mut best_bound) = (share.clone(), 0.0);
    // How much more is hoped for than the best so far.
    let mut hope = 0.25;
    let mut failures = 0;
    for round in 0..rounds {
        let (bound, load) = relaxed(rows, &share, members);
        if bound > best_bound {
            (best_bound, failures) = (bound, 0);
            best.clone_from(&share);
        } else {
            failures += 1;
        }
        let mean = load.iter().sum::<f64>() / members as f64;
        let norm: f64 = load.iter().map(|l| (l - mean) * (l - mean)).sum();
        if norm <= f64::EPSILON {
            break;
        }
        if round < rounds / 2 {
            let pace = 0.5 / (1 + round / 4) as f64;
            for (share, load) in share.iter_mut().zip(&load) {
                *share *= (pace * (load - mean) / mean).clamp(-0.5, 0.5).exp();
            }
        } else if failures >= 4 {
            (hope, failures) = (hope / 2.0, 0);
            share.clone_from(&best);
        } else {
            let pace = (best_bound * (1.0 + hope) - bound) / norm;
            for (share, load) in share.iter_mut().zip(&load) {
                *share = (*share + pace * (load - mean)).max(0.0);
            }
        }
        normalise(&mut share);
    }
    best
}

/// The bound that shares give, and the members' loads when every piece goes where it is cheapest.
fn relaxed(rows: &[Vec<(usize, f64)>], share: &[f64], members: usize) -> (f64, Vec<f64>) {
    let mut load = vec![0.0; members];
    let mut bound = 0.0;
    for row in rows {
        let mut least = (f64::INFINITY, 0, 0.0);
        for &(member, steps) in row {
            let weighted = steps * share[member];
            if weighted < least.0 {
                least = (weighted, member, steps);
            }
        }
        if least.0.is_finite() {
            bound += least.0;
            load[least.1] += least.2;
        }
    }
    (bound, load)
}

/// Who is quick gets a large share: its time is worth more.
fn start(rows: &[Vec<(usize, f64)>], members: usize) -> Vec<f64> {
    let (mut sum, mut count) = (vec![0.0; members], vec![0.0; members]);
    for &(member, steps) in rows.iter().flatten() {
        sum[member] += steps;
        count[member] += 1.0;
    }
    let mut share: Vec<f64> = sum.iter().zip(&count).map(|(s, n)| n / f64::max(*s, 1.0)).collect();
    normalise(&mut share);
    share
}

fn normalise(share: &mut [f64]) {
    let sum: f64 = share.iter().sum();
    let even = 1.0 / share.len() as f64;
    share.iter_mut().for_each(|s| *s = if sum > 0.0 { *s / sum } else { even });
}

/// In parts, never more than one whole together.
fn whole(share: &[f64]) -> Vec<u64> {
    let mut parts: Vec<u64> = share.iter().map(|s| (s * PARTS as f64) as u64).collect();
    let excess = parts.iter().sum::<u64>().saturating_sub(PARTS);
    if let Some(largest) = parts.iter_mut().max() {
        *largest = largest.saturating_sub(excess);
    }
    parts
}
