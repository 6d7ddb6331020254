//! Which facts may hold together, and when: the planning graph of the team with its exclusions (Blum & Furst, "Fast
//! planning through planning graph analysis", AIJ 90, 1997), for steps in which every agent does at most one action.
//!
//! Two facts may hold before a step if they may have held before the one before, or if an action of that step makes
//! one of them and leaves the other alone, or if two agents' actions that need not fear each other make them. The
//! rules are those of the formulas ([`super::formula`]), so what is excluded here has no model there: a goal of which
//! two parts may not hold together yet is not reached yet, and an operator that needs such a pair waits.

use super::layers::{NEVER, Reach};
use super::model::{Lit, Maker, Model};

/// Rows of bits, of the same length.
struct Bits {
    words: usize,
    bits: Vec<u64>,
}

impl Bits {
    fn new(rows: usize, columns: usize) -> Self {
        let words = columns.div_ceil(64);
        Bits { words, bits: vec![0; rows * words] }
    }

    fn row(&self, row: usize) -> &[u64] {
        &self.bits[row * self.words..(row + 1) * self.words]
    }

    fn row_mut(&mut self, row: usize) -> &mut [u64] {
        &mut self.bits[row * self.words..(row + 1) * self.words]
    }

    fn set(&mut self, row: usize, column: usize) {
        self.bits[row * self.words + column / 64] |= 1 << (column % 64);
    }

    fn has(&self, row: usize, column: usize) -> bool {
        self.bits[row * self.words + column / 64] >> (column % 64) & 1 == 1
    }
}

/// The positions of the bits that are set.
fn ones(words: &[u64]) -> impl Iterator<Item = usize> + '_ {
    words.iter().enumerate().flat_map(|(at, &word)| {
        let mut rest = word;
        std::iter::from_fn(move || {
            let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
            rest &= rest - 1;
            Some(at * 64 + bit)
        })
    })
}

/// The graph while it is built, over the facts and operators that count.
struct Graph<'a> {
    model: &'a Model,
    lits: Vec<Lit>,
    operators: Vec<u32>,
    needs: Vec<Vec<u32>>,
    makes: Vec<Vec<u32>>,
    /// For each operator, what it undoes.
    undoes: Bits,
    /// For each fact, who makes it and who undoes it.
    makers: Bits,
    undoers: Bits,
    /// For each operator, which never share a step with it: those of its agent, and those that undo what it needs or
    /// whose needs it undoes.
    never: Bits,
    /// Values of the same variable.
    exclusive: Bits,
    /// Which facts may hold together before the current step; a fact with itself if it may hold at all.
    can: Bits,
    /// The first step of each operator.
    first: Vec<u32>,
    /// The first layer of each fact.
    since: Vec<u32>,
}

/// What the graph says.
pub(super) struct Raised {
    /// The first layer in which all of the goal may hold.
    pub depth: u32,
    /// Facts that never hold together.
    pub apart: Vec<(Lit, Lit)>,
}

/// Raises the first layers in `reach` to those of the planning graph, and says in which layer all of the goal may
/// hold. Looks no further when `work` (words of bits looked at) is used up; what is not reached by then comes later.
/// For tasks without conditional effects and derived facts.
pub(super) fn raise(model: &Model, relevant: &[bool], reach: &mut Reach, mut work: u64) -> Raised {
    let mut depth = reach.goal(&model.goal);
    let Some(mut graph) = Graph::new(model, relevant, reach, work) else {
        return Raised { depth, apart: Vec::new() };
    };
    let (mut layer, mut complete) = (0, None);
    // From this layer on nothing is known.
    let unknown = loop {
        graph.act(layer, reach);
        if complete.is_none() && graph.has(&model.goal) {
            complete = Some(layer);
        }
        match graph.grow(&mut work) {
            None => break layer + 1,
            Some(false) => break NEVER,
            Some(true) => {}
        }
        layer += 1;
        graph.note(layer);
    };
    depth = depth.max(complete.unwrap_or(layer + 1));
    for (at, &lit) in graph.lits.iter().enumerate() {
        let own = &mut reach.lits[lit.index()];
        *own = (*own).max(graph.since[at].min(unknown));
    }
    for (at, &operator) in graph.operators.iter().enumerate() {
        let own = &mut reach.operators[operator as usize];
        *own = (*own).max(graph.first[at].min(unknown));
    }
    let apart = if unknown == NEVER { graph.apart() } else { Vec::new() };
    Raised { depth, apart }
}

impl<'a> Graph<'a> {
    /// The graph with its first layer; `None` if it is too large for the work.
    fn new(model: &'a Model, relevant: &[bool], reach: &Reach, work: u64) -> Option<Self> {
        let counts = |o: &u32| relevant[*o as usize] && reach.operators[*o as usize] != NEVER;
        let operators: Vec<u32> = (0..model.preconditions.len() as u32).filter(counts).collect();
        let mut lits: Vec<Lit> =
            operators.iter().flat_map(|&o| model.preconditions.row(o as usize)).copied().collect();
        lits.extend(&model.goal);
        lits.sort_unstable();
        lits.dedup();
        let (f, o) = (lits.len(), operators.len());
        let words = o.div_ceil(64) as u64;
        if (o as u64 * words).max((f * f) as u64) > work {
            return None;
        }
        let position = |lit: &Lit| lits.binary_search(lit).ok();
        let needs: Vec<Vec<u32>> = operators
            .iter()
            .map(|&o| {
                model.preconditions.row(o as usize).iter().filter_map(position).map(|p| p as u32).collect()
            })
            .collect();
        let mut graph = Graph {
            model,
            needs,
            makes: vec![Vec::new(); o],
            undoes: Bits::new(o, f),
            makers: Bits::new(f, o),
            undoers: Bits::new(f, o),
            never: Bits::new(o, o),
            exclusive: Bits::new(f, f),
            can: Bits::new(f, f),
            first: vec![NEVER; o],
            since: vec![NEVER; f],
            lits,
            operators,
        };
        graph.effects();
        graph.exclusions();
        let at_first: Vec<usize> = (0..f).filter(|&p| model.initially[graph.lits[p].index()]).collect();
        for &p in &at_first {
            at_first.iter().for_each(|&q| graph.can.set(p, q));
        }
        graph.note(0);
        Some(graph)
    }

    fn effects(&mut self) {
        for (p, lit) in self.lits.iter().enumerate() {
            for maker in &self.model.makers[lit.index()] {
                let Maker::Operator(operator) = *maker else { continue };
                if let Ok(o) = self.operators.binary_search(&operator) {
                    self.makes[o].push(p as u32);
                    self.makers.set(p, o);
                }
            }
            for threat in &self.model.threats[lit.index()] {
                if let Ok(o) = self.operators.binary_search(&threat.operator) {
                    self.undoes.set(o, p);
                    self.undoers.set(p, o);
                }
            }
        }
    }

    fn exclusions(&mut self) {
        for (a, &lit) in self.lits.iter().enumerate() {
            for (b, &other) in self.lits.iter().enumerate() {
                if self.model.excludes(lit, other) {
                    self.exclusive.set(a, b);
                }
            }
        }
        let agent = |o: usize| self.model.agent_of[self.operators[o] as usize] as usize;
        let mut of_agent = Bits::new(self.model.agents, self.operators.len());
        (0..self.operators.len()).for_each(|o| of_agent.set(agent(o), o));
        for a in 0..self.operators.len() {
            self.never.row_mut(a).copy_from_slice(of_agent.row(agent(a)));
            for &p in &self.needs[a] {
                let undoers = self.undoers.row(p as usize);
                self.never.row_mut(a).iter_mut().zip(undoers).for_each(|(own, other)| *own |= other);
            }
        }
        // Whose needs it undoes: the same seen from the other side.
        for a in 0..self.operators.len() {
            for &p in &self.needs[a] {
                for b in ones(self.undoers.row(p as usize)) {
                    self.never.set(b, a);
                }
            }
        }
    }

    /// The facts that never hold together, beyond the values of a variable.
    fn apart(&self) -> Vec<(Lit, Lit)> {
        let facts = self.lits.len();
        let may_hold: Vec<usize> = (0..facts).filter(|&p| self.can.has(p, p)).collect();
        let pairs =
            may_hold.iter().enumerate().flat_map(|(at, &p)| may_hold[..at].iter().map(move |&q| (q, p)));
        let apart = pairs.filter(|&(q, p)| !self.can.has(p, q) && !self.exclusive.has(p, q));
        apart.map(|(q, p)| (self.lits[q], self.lits[p])).collect()
    }

    /// Notes the facts that are new in this layer.
    fn note(&mut self, layer: u32) {
        for p in 0..self.lits.len() {
            if self.since[p] == NEVER && self.can.has(p, p) {
                self.since[p] = layer;
            }
        }
    }

    /// Which operators may act now.
    fn act(&mut self, layer: u32, reach: &Reach) {
        for o in 0..self.operators.len() {
            let needs = &self.needs[o];
            let together =
                |(i, &p): (usize, &u32)| needs[..=i].iter().all(|&q| self.can.has(p as usize, q as usize));
            let late = reach.operators[self.operators[o] as usize] > layer;
            if self.first[o] == NEVER && !late && needs.iter().enumerate().all(together) {
                self.first[o] = layer;
            }
        }
    }

    fn has(&self, goal: &[Lit]) -> bool {
        let at: Option<Vec<usize>> = goal.iter().map(|lit| self.lits.binary_search(lit).ok()).collect();
        at.is_some_and(|at| at.iter().all(|&p| at.iter().all(|&q| self.can.has(p, q))))
    }

    /// The next layer; whether it differs. `None` if the work is used up.
    fn grow(&mut self, work: &mut u64) -> Option<bool> {
        let (facts, operators) = (self.lits.len(), self.operators.len());
        let mut next = Bits { words: self.can.words, bits: self.can.bits.clone() };
        // For each fact, the operators that may act while it holds.
        let mut beside = Bits::new(facts, operators);
        let active: Vec<usize> = (0..operators).filter(|&o| self.first[o] != NEVER).collect();
        let mut all_active = Bits::new(1, operators);
        let mut held = Bits::new(1, facts);
        (0..facts).filter(|&p| self.can.has(p, p)).for_each(|p| held.set(0, p));
        for &o in &active {
            all_active.set(0, o);
            let mut after = held.row(0).to_vec();
            for &p in &self.needs[o] {
                after.iter_mut().zip(self.can.row(p as usize)).for_each(|(own, other)| *own &= other);
            }
            ones(&after).for_each(|p| beside.set(p, o));
            self.makes[o].iter().for_each(|&p| after[p as usize / 64] |= 1 << (p % 64));
            after.iter_mut().zip(self.undoes.row(o)).for_each(|(own, undone)| *own &= !undone);
            for &p in &self.makes[o] {
                let p = p as usize;
                if after[p / 64] >> (p % 64) & 1 == 1 {
                    next.row_mut(p).iter_mut().zip(&after).for_each(|(own, other)| *own |= other);
                }
            }
            *work = work.saturating_sub(facts as u64);
        }
        for p in 0..facts {
            let row: Vec<usize> = ones(next.row(p)).collect();
            row.into_iter().for_each(|q| next.set(q, p));
        }
        for &a in &active {
            if *work == 0 {
                return None;
            }
            let mut free: Vec<u64> = all_active.row(0).to_vec();
            free.iter_mut().zip(self.never.row(a)).for_each(|(own, never)| *own &= !never);
            for &p in &self.needs[a] {
                free.iter_mut().zip(beside.row(p as usize)).for_each(|(own, other)| *own &= other);
            }
            *work = work.saturating_sub((free.len() * (1 + self.needs[a].len())) as u64);
            self.with_another(a, &free, &mut next, work);
        }
        let grown = next.bits != self.can.bits;
        self.can = next;
        Some(grown)
    }

    /// What an operator makes together with what others make beside it.
    fn with_another(&self, a: usize, others: &[u64], next: &mut Bits, work: &mut u64) {
        for &p in &self.makes[a] {
            let p = p as usize;
            if self.undoes.has(a, p) {
                continue;
            }
            let known = next.row(p).iter().zip(self.exclusive.row(p)).zip(self.undoes.row(a));
            let open: Vec<u64> =
                known.map(|((together, apart), undone)| !(together | apart | undone)).collect();
            // The last word has bits that stand for no fact.
            let open: Vec<usize> = ones(&open).take_while(|&q| q < self.lits.len()).collect();
            *work = work.saturating_sub((self.lits.len() + open.len() * others.len()) as u64);
            for q in open {
                let makers = self.makers.row(q).iter().zip(self.undoers.row(p)).zip(others);
                if makers.into_iter().any(|((maker, undoer), other)| maker & !undoer & other != 0) {
                    next.set(p, q);
                    next.set(q, p);
                }
            }
        }
    }
}
