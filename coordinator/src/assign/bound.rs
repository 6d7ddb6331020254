//! A lower bound of the makespan of any assignment.

use std::collections::BTreeMap;

use super::Work;

/// Steps of the subgradient method.
const ROUNDS: u32 = 60;

/// Shares are counted in so many parts, so that the bound is exact arithmetic.
pub(super) const PARTS: u64 = 1 << 16;

/// The larger of two bounds: the longest chain of pieces that wait for each other, each by its fastest
/// member; and the load. For the latter every member gets a share of one whole; a member busy for T steps
/// takes its share of T, all together T, so the sum over the pieces of the least share-weighted cost is never
/// more than T (Lagrangian relaxation of the members' capacities; the shares by the subgradient method: Held,
/// Wolfe & Crowder, "Validation of subgradient optimization", Mathematical Programming 6, 1974).
pub fn lower_bound(work: &[Work]) -> u64 {
    chain(work).max(shares(work).1)
}

fn chain(work: &[Work]) -> u64 {
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
    let members: Vec<usize> = {
        let mut all: Vec<usize> = work.iter().flat_map(|w| w.cost.keys().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    if members.is_empty() {
        return (BTreeMap::new(), 0);
    }
    let place: BTreeMap<usize, usize> = members.iter().enumerate().map(|(at, &m)| (m, at)).collect();
    let rows: Vec<Vec<(usize, f64)>> =
        work.iter().map(|w| w.cost.iter().map(|(m, &steps)| (place[m], steps as f64)).collect()).collect();
    let mut share = vec![1.0 / members.len() as f64; members.len()];
    let mut best = (whole(&share), 0);
    for round in 0..ROUNDS {
        let mut load = vec![0.0; members.len()];
        for row in &rows {
            let least = row.iter().min_by(|a, b| (a.1 * share[a.0]).total_cmp(&(b.1 * share[b.0])));
            if let Some(&(member, steps)) = least {
                load[member] += steps;
            }
        }
        let parts = whole(&share);
        let bound = bound_of(&rows, &parts);
        if bound > best.1 {
            best = (parts, bound);
        }
        // Who is overloaded gets a larger share, which makes its time dearer.
        let mean = load.iter().sum::<f64>() / load.len() as f64;
        if mean <= 0.0 {
            break;
        }
        let pace = 0.5 / f64::from(1 + round / 4);
        for (share, load) in share.iter_mut().zip(&load) {
            *share *= (pace * (load - mean) / mean).clamp(-0.5, 0.5).exp();
        }
        let sum: f64 = share.iter().sum();
        share.iter_mut().for_each(|s| *s /= sum);
    }
    (members.into_iter().zip(best.0).collect(), best.1)
}

fn whole(share: &[f64]) -> Vec<u64> {
    share.iter().map(|s| (s * PARTS as f64) as u64).collect()
}

fn bound_of(rows: &[Vec<(usize, f64)>], parts: &[u64]) -> u64 {
    let least = |row: &Vec<(usize, f64)>| row.iter().map(|&(m, steps)| steps as u64 * parts[m]).min();
    let sum: u64 = rows.iter().filter_map(least).sum();
    sum.div_ceil(PARTS)
}
