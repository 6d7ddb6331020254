//! The assignment with the smallest makespan, and among those the least work, by branch and bound.

use std::collections::BTreeMap;

use super::bound::{PARTS, shares};
use super::{Score, Work, estimate, piece_end};

struct Search<'a> {
    work: &'a [Work],
    /// The order in which pieces are decided: as given where some wait for others.
    order: Vec<usize>,
    share: BTreeMap<usize, u64>,
    /// For each place in the order: the least share-weighted cost of the pieces from there on.
    rest: Vec<u64>,
    /// For each place in the order: the least work of the pieces from there on.
    least: Vec<u64>,
    members: Vec<usize>,
    end: Vec<u64>,
    free: Vec<u64>,
    /// Members with the same skills and costs, the first of each kind standing for it.
    kind: Vec<usize>,
    best: Vec<usize>,
    score: Score,
    bound: u64,
    nodes: u64,
    /// Whether less work for the same makespan is looked for, too.
    ties: bool,
    /// For each place in the order: whether the piece is like the one before it.
    alike: Vec<bool>,
    /// Where nothing waits: places and ends of all members that were reached, with the least work that took.
    reached: BTreeMap<(usize, Vec<u64>), u64>,
    unordered: bool,
}

/// So many ends of all members are remembered, and none where fewer pieces than that are left.
const REMEMBERED: usize = 300_000;
const LEFT: usize = 4;

/// Nodes for looking for less work.
const TIES: u64 = 100_000;

/// Improves on `start`; says whether what it returns is proved to have the smallest makespan. `bound` is a lower
/// bound of it.
pub(super) fn search(work: &[Work], start: Vec<usize>, bound: u64, nodes: u64) -> (Vec<usize>, bool) {
    let mut order: Vec<usize> = (0..work.len()).collect();
    let unordered = work.iter().all(|w| w.after.is_empty());
    if unordered {
        let size = |i: usize| std::cmp::Reverse(work[i].cost.values().min().copied().unwrap_or(0));
        order.sort_by(|&a, &b| size(a).cmp(&size(b)).then_with(|| work[a].cost.cmp(&work[b].cost)));
    }
    let like_before = |at: usize| unordered && at > 0 && work[order[at]].cost == work[order[at - 1]].cost;
    let alike = (0..order.len()).map(like_before).collect();
    let share = shares(work).0;
    let weighted = |i: usize| work[i].cost.iter().map(|(m, &steps)| steps * share[m]).min().unwrap_or(0);
    let least = |i: usize| work[i].cost.values().min().copied().unwrap_or(0);
    let sums = |of: &dyn Fn(usize) -> u64| {
        let mut sums = vec![0; order.len() + 1];
        for at in (0..order.len()).rev() {
            sums[at] = sums[at + 1] + of(order[at]);
        }
        sums
    };
    let most = work.iter().flat_map(|w| w.cost.keys().copied()).max().map_or(0, |m| m + 1);
    let column =
        |member: usize| -> Vec<Option<u64>> { work.iter().map(|w| w.cost.get(&member).copied()).collect() };
    let columns: Vec<_> = (0..most).map(column).collect();
    let kind = (0..most).map(|m| columns.iter().position(|c| *c == columns[m]).unwrap_or(m)).collect();
    let mut search = Search {
        rest: sums(&weighted),
        least: sums(&least),
        order: order.clone(),
        work,
        share,
        members: start.clone(),
        end: vec![0; work.len()],
        free: vec![0; most],
        kind,
        score: estimate(work, &start),
        best: start,
        bound,
        nodes,
        ties: false,
        alike,
        reached: BTreeMap::new(),
        unordered,
    };
    let complete = search.score.0 <= bound || search.descend(0, 0, 0);
    let proved = complete || search.score.0 <= bound;
    if proved {
        search.bound = search.score.0;
    }
    search.nodes = TIES;
    search.ties = true;
    search.reached.clear();
    search.descend(0, 0, 0);
    (search.best, proved)
}

impl Search<'_> {
    /// Decides the pieces from `at` on; false if the nodes are used up.
    fn descend(&mut self, at: usize, makespan: u64, total: u64) -> bool {
        if at == self.order.len() {
            let score = estimate(self.work, &self.members);
            if score.0 < self.score.0 || self.ties && score < self.score {
                self.score = score;
                self.best.clone_from(&self.members);
            }
            return true;
        }
        if self.nodes == 0 {
            return false;
        }
        self.nodes -= 1;
        if self.was_here(at, total) {
            return true;
        }
        let piece = self.order[at];
        // Pieces that are alike go to members in roster order: which of them goes where makes no difference.
        let first = if self.alike[at] { self.members[self.order[at - 1]] } else { 0 };
        let mut choices: Vec<(u64, u64, usize)> = Vec::with_capacity(self.work[piece].cost.len());
        for (&member, &steps) in self.work[piece].cost.range(first..) {
            // Of equal members that are equally far, one is enough.
            let twin = |&(_, _, m): &(u64, u64, usize)| {
                self.kind[m] == self.kind[member] && self.free[m] == self.free[member]
            };
            if !choices.iter().any(twin) {
                choices.push((
                    piece_end(&self.work[piece], steps, self.free[member], &self.end),
                    steps,
                    member,
                ));
            }
        }
        choices.sort_unstable();
        let mut complete = true;
        for (end, steps, member) in choices {
            let before = std::mem::replace(&mut self.free[member], end);
            self.members[piece] = member;
            self.end[piece] = end;
            let makespan = makespan.max(end);
            if self.promises(at + 1, makespan, total + steps) {
                complete &= self.descend(at + 1, makespan, total + steps);
            }
            self.free[member] = before;
        }
        complete
    }

    /// Whether the members were as busy before at this place, with no more work: then nothing new lies ahead.
    fn was_here(&mut self, at: usize, total: u64) -> bool {
        // What is like the piece before it may go to fewer members than it might have before.
        if !self.unordered || self.alike[at] || at + LEFT > self.order.len() {
            return false;
        }
        let key = (at, self.free.clone());
        match self.reached.get_mut(&key) {
            Some(least) if *least <= total => true,
            Some(least) => {
                *least = total;
                // Less work matters only where ties are looked at.
                !self.ties
            }
            None => {
                if self.reached.len() < REMEMBERED {
                    self.reached.insert(key, total);
                }
                false
            }
        }
    }

    /// Whether the rest may still lead to something better.
    fn promises(&self, at: usize, makespan: u64, total: u64) -> bool {
        let busy: u64 = self.share.iter().map(|(&m, &share)| share * self.free[m]).sum();
        let load = (busy + self.rest[at]).div_ceil(PARTS);
        let reach = makespan.max(load).max(self.bound);
        if reach >= self.score.0 {
            // As good at best: then only with less work.
            return self.ties && reach == self.score.0 && total + self.least[at] < self.score.1;
        }
        let latest = self.score.0 - u64::from(!self.ties);
        self.order[at..]
            .iter()
            .all(|&i| self.work[i].cost.iter().any(|(&m, &steps)| self.free[m] + steps <= latest))
    }
}
