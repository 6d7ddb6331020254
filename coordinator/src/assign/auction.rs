//! An assignment soon: pieces are auctioned one by one, then moved and swapped while that helps.

use super::{Work, estimate, piece_end};

/// Work of the improvement, in pieces looked at.
const EFFORT: u64 = 6_000_000;

/// Sequential single-item auction with the bid "when I would be done" (Lagoudakis et al., "Auction-based
/// multi-robot routing", RSS 2005, rule MiniMax), the largest pieces first; then local improvement.
pub(super) fn auction(work: &[Work]) -> Vec<usize> {
    if work.iter().all(|w| w.after.is_empty()) {
        let mut order: Vec<usize> = (0..work.len()).collect();
        order.sort_by_key(|&i| std::cmp::Reverse(work[i].cost.values().min().copied().unwrap_or(0)));
        let mut members = bid(work, &order);
        Loads::new(work, &members).improve(&mut members);
        return members;
    }
    let order: Vec<usize> = (0..work.len()).collect();
    let mut members = bid(work, &order);
    single_moves(work, &mut members);
    members
}

fn bid(work: &[Work], order: &[usize]) -> Vec<usize> {
    let most = work.iter().flat_map(|w| w.cost.keys().copied()).max().map_or(0, |m| m + 1);
    let mut free = vec![0u64; most];
    let mut end = vec![0u64; work.len()];
    let mut members = vec![0usize; work.len()];
    for &i in order {
        let done = |(&member, &steps): (&usize, &u64)| {
            (piece_end(&work[i], steps, free[member], &end), steps, member)
        };
        if let Some((at, _, member)) = work[i].cost.iter().map(done).min() {
            members[i] = member;
            free[member] = at;
            end[i] = at;
        }
    }
    members
}

/// Single moves as long as one helps and the effort lasts.
fn single_moves(work: &[Work], members: &mut [usize]) {
    let mut best = estimate(work, members);
    let mut left = EFFORT / work.len().max(1) as u64;
    loop {
        let before = best;
        for i in 0..work.len() {
            for &choice in work[i].cost.keys() {
                if left == 0 {
                    return;
                }
                left -= 1;
                let old = std::mem::replace(&mut members[i], choice);
                let found = estimate(work, members);
                if found < best {
                    best = found;
                } else {
                    members[i] = old;
                }
            }
        }
        if best == before {
            return;
        }
    }
}

/// Pieces that wait for nothing: only the members' loads matter.
struct Loads<'a> {
    work: &'a [Work],
    load: Vec<u64>,
    pieces: Vec<Vec<usize>>,
    left: u64,
}

impl<'a> Loads<'a> {
    fn new(work: &'a [Work], members: &[usize]) -> Self {
        let most = work.iter().flat_map(|w| w.cost.keys().copied()).max().map_or(0, |m| m + 1);
        let mut loads = Loads { work, load: vec![0; most], pieces: vec![Vec::new(); most], left: EFFORT };
        for (i, &member) in members.iter().enumerate() {
            loads.load[member] += work[i].cost.get(&member).copied().unwrap_or(0);
            loads.pieces[member].push(i);
        }
        loads
    }

    /// Takes work from the busiest member, by a move or a swap that leaves both better off, until none does.
    fn improve(&mut self, members: &mut [usize]) {
        while let Some(busiest) = (0..self.load.len()).max_by_key(|&m| (self.load[m], std::cmp::Reverse(m))) {
            if !self.relieve(busiest, members) {
                break;
            }
        }
        // What remains: the same makespan with less work.
        let makespan = self.load.iter().max().copied().unwrap_or(0);
        for i in 0..self.work.len() {
            let from = members[i];
            let now = self.work[i].cost.get(&from).copied().unwrap_or(0);
            let cheaper = self.work[i]
                .cost
                .iter()
                .find(|&(&to, &steps)| to != from && steps < now && self.load[to] + steps <= makespan);
            if let Some((&to, _)) = cheaper {
                self.shift(i, from, to, members);
            }
        }
    }

    fn relieve(&mut self, busiest: usize, members: &mut [usize]) -> bool {
        let top = self.load[busiest];
        let mut best: Option<(u64, usize, usize, Option<usize>)> = None;
        for &i in &self.pieces[busiest] {
            let mine = self.work[i].cost.get(&busiest).copied().unwrap_or(0);
            for (&to, &steps) in self.work[i].cost.iter().filter(|&(&to, _)| to != busiest) {
                if self.left == 0 {
                    return false;
                }
                self.left -= 1;
                let moved = (self.load[to] + steps).max(top - mine);
                if moved < top && best.is_none_or(|b| (moved, i, to) < (b.0, b.1, b.2)) {
                    best = Some((moved, i, to, None));
                }
                if self.load[to] + steps < top.saturating_add(mine) {
                    self.left = self.left.saturating_sub(self.pieces[to].len() as u64);
                    for &back in &self.pieces[to] {
                        let theirs = self.work[back].cost.get(&to).copied().unwrap_or(0);
                        let Some(&taken) = self.work[back].cost.get(&busiest) else { continue };
                        let swapped = (top - mine + taken).max(self.load[to] + steps - theirs);
                        if swapped < top && best.is_none_or(|b| swapped < b.0) {
                            best = Some((swapped, i, to, Some(back)));
                        }
                    }
                }
            }
        }
        let Some((_, i, to, back)) = best else { return false };
        self.shift(i, busiest, to, members);
        if let Some(back) = back {
            self.shift(back, to, busiest, members);
        }
        true
    }

    fn shift(&mut self, piece: usize, from: usize, to: usize, members: &mut [usize]) {
        let cost = |member: usize| self.work[piece].cost.get(&member).copied().unwrap_or(0);
        self.load[from] -= cost(from);
        self.load[to] += cost(to);
        self.pieces[from].retain(|&p| p != piece);
        self.pieces[to].push(piece);
        members[piece] = to;
    }
}
