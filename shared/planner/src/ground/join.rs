//! All instances of a rule's body, by backtracking over its atoms, smallest choice first.

use super::relation::Relation;
use super::relevance::{Values, matters};
use super::{GroundError, GroundLimits};
use crate::lifted::{Body, LiftedAtom, Role, Symbols, Term};

/// The mark of an unbound variable.
pub(crate) const UNBOUND: u32 = u32::MAX;

/// The clock is read once in so many steps.
const STEPS_BETWEEN_CHECKS: u64 = 1 << 14;

/// The fact that a join starts from: it must be used at `position`, and at no earlier one.
#[derive(Clone, Copy)]
pub(crate) struct Trigger {
    pub position: usize,
    pub predicate: u32,
    pub row: u32,
}

/// One join; `found` receives the values of the body's bound variables, instance after instance.
pub(crate) struct Join<'a> {
    pub symbols: &'a Symbols,
    pub relations: &'a [Relation],
    pub body: &'a Body,
    /// Which instances are wanted; `None`: all.
    pub filter: Option<&'a [Values]>,
    /// The view of its relation that each atom of the body looks at.
    pub views: &'a [u32],
    pub binding: &'a mut Vec<u32>,
    pub found: &'a mut Vec<u32>,
    /// Work space: the atoms not joined yet, and the slots bound so far.
    pub pending: &'a mut Vec<usize>,
    pub trail: &'a mut Vec<u32>,
    /// The number of instances found.
    pub count: usize,
    /// Stops after so many instances ...
    pub max_count: usize,
    /// ... or when this many steps are used up ...
    pub steps_left: u64,
    /// ... or when the caller's time is, which is then noted here.
    pub stopped: Option<GroundError>,
    pub limits: &'a GroundLimits<'a>,
}

impl<'a> Join<'a> {
    /// Runs the join. With a trigger, only instances that use that fact at that position (semi-naive).
    pub fn run(&mut self, trigger: Option<Trigger>) {
        self.binding.clear();
        self.binding.resize(self.body.variables.len(), UNBOUND);
        let mut pending = std::mem::take(self.pending);
        pending.clear();
        pending.extend(0..self.body.atoms.len());
        self.trail.clear();
        self.start(&mut pending, trigger);
        *self.pending = pending;
    }

    fn start(&mut self, pending: &mut Vec<usize>, trigger: Option<Trigger>) {
        if let Some(start) = trigger {
            pending.swap_remove(start.position);
            let body = self.body;
            let relations = self.relations;
            let row = relations[start.predicate as usize].row(start.row);
            if !self.matches(&body.atoms[start.position], row) || !self.consistent() {
                return;
            }
        } else if !self.consistent() {
            return;
        }
        self.extend(pending, trigger);
    }

    /// Counts a step; false if the join has to end.
    #[inline]
    fn step(&mut self) -> bool {
        if self.count >= self.max_count || self.steps_left == 0 {
            return false;
        }
        self.steps_left -= 1;
        if self.steps_left.is_multiple_of(STEPS_BETWEEN_CHECKS) {
            self.stopped = self.limits.check_time().err();
            if self.stopped.is_some() {
                self.steps_left = 0;
            }
        }
        true
    }

    fn extend(&mut self, pending: &mut [usize], trigger: Option<Trigger>) {
        if !self.step() {
            return;
        }
        let Some(best) = self.smallest(pending) else {
            return self.enumerate(0);
        };
        let last = pending.len() - 1;
        pending.swap(best, last);
        let position = pending[last];
        let body = self.body;
        let atom = &body.atoms[position];
        let relations = self.relations;
        let relation = &relations[atom.predicate as usize];
        // The same fact at two positions of the body is found from the first of them only.
        let skip = match trigger {
            Some(t) if t.predicate == atom.predicate && position < t.position => t.row,
            _ => UNBOUND,
        };
        let rest = &mut pending[..last];
        match self.candidates(position) {
            Candidates::One(row) => {
                if row != skip {
                    self.extend(rest, trigger);
                }
            }
            Candidates::Listed(rows) => {
                for &row in rows {
                    self.try_row(atom, relation, row, skip, rest, trigger);
                }
            }
            Candidates::None => {}
        }
    }

    fn try_row(
        &mut self,
        atom: &LiftedAtom,
        relation: &Relation,
        row: u32,
        skip: u32,
        rest: &mut [usize],
        trigger: Option<Trigger>,
    ) {
        if row == skip {
            return;
        }
        let before = self.trail.len();
        if self.matches(atom, relation.row(row)) && (self.trail.len() == before || self.consistent()) {
            self.extend(rest, trigger);
        }
        for slot in self.trail.drain(before..) {
            self.binding[slot as usize] = UNBOUND;
        }
    }

    /// The pending atom with the fewest candidate rows.
    fn smallest(&self, pending: &[usize]) -> Option<usize> {
        let mut best = None;
        let mut best_size = usize::MAX;
        for (at, &position) in pending.iter().enumerate() {
            let atom = &self.body.atoms[position];
            let relation = &self.relations[atom.predicate as usize];
            let view = self.views[position];
            let mut size = relation.rows_of(view).len();
            let mut bound = 0;
            for (k, &term) in atom.args.iter().enumerate() {
                let object = self.value(term);
                if object != UNBOUND {
                    bound += 1;
                    size = size.min(relation.with(view, k, object).len());
                }
            }
            if bound == atom.args.len() {
                size = 0;
            }
            if size < best_size {
                best_size = size;
                best = Some(at);
                if size == 0 {
                    break;
                }
            }
        }
        best
    }

    fn candidates(&self, position: usize) -> Candidates<'a> {
        let (atom, view) = (&self.body.atoms[position], self.views[position]);
        let relations: &'a [Relation] = self.relations;
        let relation = &relations[atom.predicate as usize];
        let mut shortest: Option<&'a [u32]> = None;
        let mut args = [0u32; 8];
        let mut bound = 0;
        for (k, &term) in atom.args.iter().enumerate() {
            let object = self.value(term);
            if object != UNBOUND {
                if bound < 8 {
                    args[bound] = object;
                }
                bound += 1;
                let rows = relation.with(view, k, object);
                if shortest.is_none_or(|s| rows.len() < s.len()) {
                    shortest = Some(rows);
                }
            }
        }
        if bound == atom.args.len() && bound <= 8 {
            return match relation.find(&args[..bound]) {
                Some(row) if (row as usize) < relation.shown() => Candidates::One(row),
                _ => Candidates::None,
            };
        }
        // The relations outlive the join, so the list may be walked while variables are bound.
        Candidates::Listed(shortest.unwrap_or_else(|| relation.rows_of(view)))
    }

    #[inline]
    fn value(&self, term: Term) -> u32 {
        match term {
            Term::Object(object) => object,
            Term::Variable(slot) => self.binding[slot as usize],
        }
    }

    /// Binds the atom's variables to the row; the trail lists what was bound, also where it fails.
    fn matches(&mut self, atom: &LiftedAtom, row: &[u32]) -> bool {
        for (&term, &object) in atom.args.iter().zip(row) {
            match term {
                Term::Object(expected) => {
                    if expected != object {
                        return false;
                    }
                }
                Term::Variable(slot) => {
                    let bound = self.binding[slot as usize];
                    if bound == UNBOUND {
                        let range = &self.symbols.ranges[self.body.variables[slot as usize] as usize];
                        if !range.contains[object as usize] {
                            return false;
                        }
                        self.binding[slot as usize] = object;
                        self.trail.push(slot);
                    } else if bound != object {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// Whether the (in)equalities and the absent static atoms allow the binding so far.
    fn consistent(&self) -> bool {
        let equal_allows = self.body.equal.iter().all(|&(left, right, same)| {
            let (left, right) = (self.value(left), self.value(right));
            left == UNBOUND || right == UNBOUND || (left == right) == same
        });
        equal_allows && self.body.absent.iter().all(|atom| self.absent_allows(atom))
    }

    fn absent_allows(&self, atom: &LiftedAtom) -> bool {
        if self.symbols.predicates[atom.predicate as usize].role != Role::Static {
            return true;
        }
        let mut buffer = [0u32; 8];
        let mut large = Vec::new();
        let args = if atom.args.len() <= buffer.len() {
            &mut buffer[..atom.args.len()]
        } else {
            large.resize(atom.args.len(), 0);
            &mut large[..]
        };
        args.iter_mut().zip(&atom.args).for_each(|(arg, &term)| *arg = self.value(term));
        args.contains(&UNBOUND) || self.relations[atom.predicate as usize].find(args).is_none()
    }

    /// Lets the variables that no atom binds run over their ranges.
    fn enumerate(&mut self, from: usize) {
        if !self.step() {
            return;
        }
        let body = self.body;
        let free = body.bound[from..].iter().position(|&slot| self.binding[slot as usize] == UNBOUND);
        let Some(free) = free else {
            let binding = &self.binding;
            if self.filter.is_some_and(|filter| !matters(filter, binding)) {
                return;
            }
            self.count += 1;
            self.found.extend(body.bound.iter().map(|&slot| binding[slot as usize]));
            return;
        };
        let slot = body.bound[from + free];
        let symbols = self.symbols;
        for &object in &symbols.ranges[body.variables[slot as usize] as usize].members {
            self.binding[slot as usize] = object;
            if self.consistent() {
                self.enumerate(from + free + 1);
            }
        }
        self.binding[slot as usize] = UNBOUND;
    }
}

enum Candidates<'a> {
    None,
    /// The atom is bound and this is its row.
    One(u32),
    Listed(&'a [u32]),
}
