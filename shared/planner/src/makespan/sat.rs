//! The SAT solver, with limits that are the same on every machine and a deadline on top.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::MakespanLimits;
use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface, SolverOpts, Var, lbool};

/// A literal of the formula.
pub(super) type Bool = Lit;

/// What a search for a model came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    Model,
    /// There is none.
    Contradiction,
    /// A limit was reached.
    Stopped,
}

/// Work that may be done, counted down.
#[derive(Debug)]
pub(super) struct Fuel<'a> {
    /// Conflicts of the solver.
    pub conflicts: u64,
    /// Literals in all clauses of a formula.
    pub size: u64,
    /// Literals of all formulas, and what the solver looks at.
    pub work: u64,
    pub deadline: Option<Instant>,
    pub cancel: &'a AtomicBool,
}

impl<'a> Fuel<'a> {
    pub fn new(limits: &MakespanLimits, cancel: &'a AtomicBool) -> Self {
        let deadline = limits.time.and_then(|time| Instant::now().checked_add(time));
        Fuel { conflicts: limits.conflicts, size: limits.size, work: limits.work, deadline, cancel }
    }

    /// Does something that may use no more than so many conflicts, with formulas in proportion.
    pub fn for_window<T>(&mut self, conflicts: u64, what: impl FnOnce(&mut Self) -> T) -> T {
        let given = conflicts.min(self.conflicts);
        let all = std::mem::replace(&mut self.conflicts, given);
        let smaller = self.size.min(conflicts.saturating_mul(SIZE_PER_CONFLICT));
        let size = std::mem::replace(&mut self.size, smaller);
        let result = what(self);
        self.size = size;
        self.conflicts = all - (given - self.conflicts);
        result
    }

    /// Does something that may use no more than so much work.
    pub fn slice<T>(&mut self, work: u64, what: impl FnOnce(&mut Self) -> T) -> T {
        let given = work.min(self.work);
        let all = std::mem::replace(&mut self.work, given);
        let result = what(self);
        self.work = all - (given - self.work);
        result
    }

    /// Whether no more than a few conflicts of the solver can be paid for.
    pub fn is_for_a_few_conflicts(&self) -> bool {
        self.is_empty() || self.work < LOOKS_PER_CONFLICT * A_FEW
    }

    /// Whether nothing more can be done.
    pub fn is_empty(&self) -> bool {
        self.conflicts == 0 || self.work == 0 || self.stopped()
    }

    pub fn stopped(&self) -> bool {
        is_over(self.deadline, self.cancel)
    }
}

fn is_over(deadline: Option<Instant>, cancel: &AtomicBool) -> bool {
    cancel.load(Ordering::Relaxed) || deadline.is_some_and(|deadline| Instant::now() >= deadline)
}

/// Decisions and conflicts between two looks at the clock.
const LOOK: u32 = 256;

/// How many assignments the solver propagates for a conflict, roughly.
const LOOKS_PER_CONFLICT: u64 = 1_000;

/// So many conflicts are not worth going on for.
const A_FEW: u64 = 100;

/// Literals that the formula of a window may have for each conflict that may be spent on it.
const SIZE_PER_CONFLICT: u64 = 1_000;

/// Clauses loaded between two looks at the clock.
const LOAD: usize = 1 << 16;

struct Watch<'a> {
    conflicts: u64,
    limit: u64,
    deadline: Option<Instant>,
    cancel: &'a AtomicBool,
    ticks: Cell<u32>,
    stopped: Cell<bool>,
}

impl Callbacks for Watch<'_> {
    fn on_new_clause(&mut self, _: &[Lit], kind: ClauseKind) {
        if matches!(kind, ClauseKind::Learnt) {
            self.conflicts += 1;
        }
    }

    fn stop(&self) -> bool {
        let ticks = self.ticks.get() + 1;
        self.ticks.set(ticks % LOOK);
        if ticks == LOOK && is_over(self.deadline, self.cancel) {
            self.stopped.set(true);
        }
        self.stopped.get() || self.conflicts >= self.limit
    }
}

/// A formula in conjunctive normal form, while it is built.
pub(super) struct Clauses {
    variables: u32,
    lits: Vec<Lit>,
    ends: Vec<usize>,
}

impl Clauses {
    pub fn new() -> Self {
        Clauses { variables: 0, lits: Vec::new(), ends: Vec::new() }
    }

    pub fn variable(&mut self) -> Bool {
        self.variables += 1;
        Lit::new(Var::unsafe_from_idx(self.variables - 1), true)
    }

    pub fn clause(&mut self, lits: impl IntoIterator<Item = Bool>) {
        self.lits.extend(lits);
        self.ends.push(self.lits.len());
    }

    /// Literals in all clauses.
    pub fn size(&self) -> u64 {
        self.lits.len() as u64
    }

    /// At most one of these, by groups: pairwise within a group, and at most one group (the commander
    /// encoding; Klieber & Kwon, "Efficient CNF encoding for selecting 1 from n objects", CFV 2007).
    pub fn at_most_one(&mut self, lits: &[Bool]) {
        const GROUP: usize = 5;
        let mut level = lits.to_vec();
        while level.len() > GROUP {
            let mut commanders = Vec::with_capacity(level.len().div_ceil(GROUP));
            for group in level.chunks(GROUP) {
                self.exclude(group);
                let commander = self.variable();
                group.iter().for_each(|&lit| self.clause([!lit, commander]));
                commanders.push(commander);
            }
            level = commanders;
        }
        self.exclude(&level);
    }

    fn exclude(&mut self, lits: &[Bool]) {
        for (i, &a) in lits.iter().enumerate() {
            lits[..i].iter().for_each(|&b| self.clause([!a, !b]));
        }
    }

    /// Loads the formula into a solver, which uses up as much work as it has literals. `None` if the fuel is used up.
    pub fn question<'a>(&self, fuel: &mut Fuel<'a>) -> Option<Question<'a>> {
        let watch = Watch {
            conflicts: 0,
            limit: 0,
            deadline: fuel.deadline,
            cancel: fuel.cancel,
            ticks: Cell::new(0),
            stopped: Cell::new(false),
        };
        let mut solver = Solver::new(SolverOpts::default(), watch);
        for _ in 0..self.variables {
            solver.new_var_default();
        }
        let mut start = 0;
        let mut clause = Vec::new();
        let mut possible = true;
        for (count, &end) in self.ends.iter().enumerate() {
            if count % LOAD == 0 && fuel.stopped() {
                return None;
            }
            clause.clear();
            clause.extend_from_slice(&self.lits[start..end]);
            start = end;
            possible = possible && solver.add_clause_reuse(&mut clause);
        }
        // The last question may use more than there is: it is worth an answer.
        fuel.work = fuel.work.saturating_sub(self.size()).max(1);
        Some(Question { solver, possible })
    }
}

/// A formula in a solver. It can be asked again with more to spend: what was learnt is kept.
pub(super) struct Question<'a> {
    solver: Solver<Watch<'a>>,
    possible: bool,
}

impl Question<'_> {
    /// Looks for a model; `fuel` is used up by what that takes. A model is given as the values of all
    /// variables.
    pub fn ask(&mut self, fuel: &mut Fuel<'_>) -> (Found, Vec<bool>) {
        if fuel.conflicts == 0 || fuel.stopped() {
            return (Found::Stopped, Vec::new());
        }
        let solver = &mut self.solver;
        let before = (solver.num_conflicts(), solver.num_propagations());
        let watch = solver.cb_mut();
        watch.conflicts = 0;
        // What the solver looks at for a conflict is known only afterwards; this much is usual.
        watch.limit = fuel.conflicts.min(fuel.work / LOOKS_PER_CONFLICT + 1);
        let answer = if self.possible { solver.solve_limited(&[]) } else { lbool::FALSE };
        let found = if answer == lbool::TRUE {
            Found::Model
        } else if answer == lbool::FALSE {
            Found::Contradiction
        } else {
            Found::Stopped
        };
        let model = match found {
            Found::Model => solver.get_model().iter().map(|&value| value == lbool::TRUE).collect(),
            _ => Vec::new(),
        };
        let conflicts = solver.num_conflicts() - before.0;
        let looks = solver.num_propagations() - before.1;
        fuel.conflicts = fuel.conflicts.saturating_sub(conflicts);
        fuel.work = fuel.work.saturating_sub(looks);
        (found, model)
    }
}

/// Whether the model makes the variable of this positive literal true.
pub(super) fn is_true(model: &[bool], lit: Bool) -> bool {
    model.get(lit.var().idx() as usize).copied().unwrap_or(false)
}
