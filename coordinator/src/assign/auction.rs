//! An assignment soon: pieces are auctioned one by one, then moved and swapped while that helps.

use super::{Score, Work};

/// Work of the improvement, in assignments of one piece that are looked at; those that wait cost more to look at.
const EFFORT: u64 = 6_000_000;
const EFFORT_IN_ORDER: u64 = 4_000_000;

/// Members that a piece on the critical path is offered to.
const OFFERS: usize = 8;

/// The member cannot do the piece.
const NEVER: u64 = u64::MAX;

/// Sequential single-item auction with the bid "when I would be done" (Lagoudakis et al., "Auction-based
/// multi-robot routing", RSS 2005, rule MiniMax), the largest pieces first; then local improvement.
pub(super) fn auction(work: &[Work]) -> Vec<usize> {
    let table = Table::new(work);
    if work.iter().all(|w| w.after.is_empty()) {
        let mut order: Vec<usize> = (0..work.len()).collect();
        order.sort_by_key(|&i| std::cmp::Reverse(work[i].cost.values().min().copied().unwrap_or(0)));
        let mut members = table.bid(&order);
        Loads::new(&table, &members).improve(&mut members);
        return members;
    }
    let order: Vec<usize> = (0..work.len()).collect();
    let mut members = table.bid(&order);
    table.shorten_chains(&mut members);
    members
}

/// The costs where they are found quickly.
struct Table<'a> {
    work: &'a [Work],
    members: usize,
    /// Piece by piece.
    cost: Vec<u64>,
}

impl<'a> Table<'a> {
    fn new(work: &'a [Work]) -> Self {
        let members = work.iter().flat_map(|w| w.cost.keys().copied()).max().map_or(0, |m| m + 1);
        let mut cost = vec![NEVER; work.len() * members];
        for (piece, work) in work.iter().enumerate() {
            for (&member, &steps) in &work.cost {
                cost[piece * members + member] = steps;
            }
        }
        Table { work, members, cost }
    }

    fn cost(&self, piece: usize, member: usize) -> u64 {
        self.cost[piece * self.members + member]
    }

    /// When the piece is done by a member that is free then.
    fn end(&self, piece: usize, member: usize, free: u64, end: &[u64]) -> u64 {
        let steps = self.cost(piece, member);
        let waits = self.work[piece].after.iter().map(|&p| end[p] + u64::from(steps > 0)).max();
        free.saturating_add(steps).max(waits.unwrap_or(0))
    }

    fn bid(&self, order: &[usize]) -> Vec<usize> {
        let mut free = vec![0u64; self.members];
        let mut end = vec![0u64; self.work.len()];
        let mut members = vec![0usize; self.work.len()];
        for &piece in order {
            let able = self.work[piece].cost.iter();
            let bids = able.map(|(&m, &steps)| (self.end(piece, m, free[m], &end), steps, m));
            if let Some((at, _, member)) = bids.min() {
                members[piece] = member;
                free[member] = at;
                end[piece] = at;
            }
        }
        members
    }

    /// When every piece is done, in `end`, and the score of that.
    fn ends(&self, members: &[usize], end: &mut Vec<u64>, free: &mut Vec<u64>) -> Score {
        free.clear();
        free.resize(self.members, 0);
        end.clear();
        let (mut last, mut total) = (0, 0);
        for (piece, &member) in members.iter().enumerate() {
            let at = self.end(piece, member, free[member], end);
            free[member] = at;
            end.push(at);
            last = last.max(at);
            total += self.cost(piece, member);
        }
        (last, total, free.iter().map(|end| end * end).sum())
    }

    /// Pieces that wait for each other are given to others while that helps: those that the makespan hangs on,
    /// and all of them where that is not enough.
    fn shorten_chains(&self, members: &mut [usize]) {
        let (mut end, mut free) = (Vec::new(), Vec::new());
        let mut best = self.ends(members, &mut end, &mut free);
        let mut left = EFFORT_IN_ORDER;
        let (mut tried, mut idle) = (Vec::new(), Vec::new());
        let mut all = false;
        loop {
            let before = best;
            let pieces = if all { (0..members.len()).collect() } else { self.critical(members, &end) };
            for piece in pieces {
                let mut offers: Vec<(u64, usize)> = self.work[piece]
                    .cost
                    .iter()
                    .filter(|&(&m, _)| m != members[piece])
                    .map(|(&m, &steps)| (free[m] + steps, m))
                    .collect();
                offers.sort_unstable();
                // With few members all of them; with many those that are free soon and those that are quick.
                offers.truncate(OFFERS.max(2_000 / self.work.len().max(1)));
                for (_, member) in offers {
                    left = left.saturating_sub(self.work.len() as u64);
                    if left == 0 {
                        return;
                    }
                    let old = std::mem::replace(&mut members[piece], member);
                    let found = self.ends(members, &mut tried, &mut idle);
                    if found < best {
                        best = found;
                        std::mem::swap(&mut end, &mut tried);
                        std::mem::swap(&mut free, &mut idle);
                    } else {
                        members[piece] = old;
                    }
                }
            }
            if best == before && all {
                return;
            }
            all = best == before;
        }
    }

    /// The pieces that the makespan hangs on: from the last one back to what each waited for, a member or a piece.
    fn critical(&self, members: &[usize], end: &[u64]) -> Vec<usize> {
        let mut chain = Vec::new();
        let mut next = (0..end.len()).max_by_key(|&piece| (end[piece], std::cmp::Reverse(piece)));
        while let Some(piece) = next {
            chain.push(piece);
            let earlier = (0..piece).rev().find(|&p| members[p] == members[piece]);
            let steps = self.cost(piece, members[piece]);
            let own = earlier.filter(|&p| end[p] + steps == end[piece]);
            let awaited = self.work[piece].after.iter().copied();
            next = own.or(awaited.filter(|&p| end[p] + u64::from(steps > 0) == end[piece]).max());
        }
        chain
    }
}

/// Pieces that wait for nothing: only the members' loads matter.
struct Loads<'a> {
    table: &'a Table<'a>,
    load: Vec<u64>,
    pieces: Vec<Vec<usize>>,
    left: u64,
}

/// Pieces that change hands, each from one member to another.
type Exchange = Vec<(usize, usize, usize)>;

impl<'a> Loads<'a> {
    fn new(table: &'a Table<'a>, members: &[usize]) -> Self {
        let (load, pieces) = (vec![0; table.members], vec![Vec::new(); table.members]);
        let mut loads = Loads { table, load, pieces, left: EFFORT };
        for (piece, &member) in members.iter().enumerate() {
            loads.load[member] += table.cost(piece, member);
            loads.pieces[member].push(piece);
        }
        loads
    }

    /// Takes work from the busiest member, by an exchange that leaves all who take part better off than it was,
    /// until there is none.
    fn improve(&mut self, members: &mut [usize]) {
        while let Some(busiest) = (0..self.load.len()).max_by_key(|&m| (self.load[m], std::cmp::Reverse(m))) {
            let Some(exchange) = self.relief(busiest).or_else(|| self.relief_by_third(busiest)) else {
                break;
            };
            for (piece, from, to) in exchange {
                self.shift(piece, from, to, members);
            }
        }
        // What remains: the same makespan with less work.
        let makespan = self.load.iter().max().copied().unwrap_or(0);
        for piece in 0..members.len() {
            let from = members[piece];
            let now = self.table.cost(piece, from);
            let mut able = self.table.work[piece].cost.iter();
            let cheaper =
                able.find(|&(&to, &steps)| to != from && steps < now && self.load[to] + steps <= makespan);
            if let Some((&to, _)) = cheaper {
                self.shift(piece, from, to, members);
            }
        }
    }

    /// The best move of a piece to another member, or swap with one of its pieces.
    fn relief(&mut self, busiest: usize) -> Option<Exchange> {
        let (table, top) = (self.table, self.load[busiest]);
        let mut best: Option<(u64, Exchange)> = None;
        for &piece in &self.pieces[busiest] {
            let mine = table.cost(piece, busiest);
            for (&to, &steps) in table.work[piece].cost.iter().filter(|&(&to, _)| to != busiest) {
                if self.left == 0 {
                    return None;
                }
                self.left -= 1;
                let mut offer = |height: u64, back: Option<usize>| {
                    if height < top && best.as_ref().is_none_or(|b| height < b.0) {
                        let back = back.map(|back| (back, to, busiest));
                        best = Some((height, std::iter::once((piece, busiest, to)).chain(back).collect()));
                    }
                };
                offer((self.load[to] + steps).max(top - mine), None);
                if self.load[to] + steps >= top.saturating_add(mine) {
                    continue;
                }
                self.left = self.left.saturating_sub(self.pieces[to].len() as u64);
                for &back in &self.pieces[to] {
                    let taken = table.cost(back, busiest);
                    if taken != NEVER {
                        let height = self.load[to] + steps - table.cost(back, to);
                        offer((top - mine + taken).max(height), Some(back));
                    }
                }
            }
        }
        best.map(|(_, exchange)| exchange)
    }

    /// A move to a member that passes on one of its own pieces to a third.
    fn relief_by_third(&mut self, busiest: usize) -> Option<Exchange> {
        let (table, top) = (self.table, self.load[busiest]);
        for &piece in &self.pieces[busiest] {
            for (&to, &steps) in table.work[piece].cost.iter().filter(|&(&to, _)| to != busiest) {
                for &passed in &self.pieces[to] {
                    if self.load[to] + steps - table.cost(passed, to) >= top {
                        continue;
                    }
                    let able = &table.work[passed].cost;
                    if self.left < able.len() as u64 {
                        return None;
                    }
                    self.left -= able.len() as u64;
                    let third = able.iter().find(|&(&third, &cost)| {
                        third != to && third != busiest && self.load[third] + cost < top
                    });
                    if let Some((&third, _)) = third {
                        return Some(vec![(piece, busiest, to), (passed, to, third)]);
                    }
                }
            }
        }
        None
    }

    fn shift(&mut self, piece: usize, from: usize, to: usize, members: &mut [usize]) {
        self.load[from] -= self.table.cost(piece, from);
        self.load[to] += self.table.cost(piece, to);
        self.pieces[from].retain(|&p| p != piece);
        self.pieces[to].push(piece);
        members[piece] = to;
    }
}
