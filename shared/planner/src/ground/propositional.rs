//! The grounded task over propositions, between instantiation and finite-domain encoding.

use super::numbers::Numbers;

/// An atom or its negation: twice the atom's number, plus one where it must be (or becomes) false.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Lit(pub u32);

impl Lit {
    pub fn new(atom: u32, holds: bool) -> Self {
        Lit(atom * 2 + u32::from(!holds))
    }
    pub fn atom(self) -> usize {
        (self.0 >> 1) as usize
    }
    pub fn holds(self) -> bool {
        self.0 & 1 == 0
    }
    pub fn negated(self) -> Self {
        Lit(self.0 ^ 1)
    }
}

/// A stretch of a pool of literals.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stretch {
    pub start: u32,
    pub len: u32,
}

impl Stretch {
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
}

/// Where an atom's name is: a row of a predicate, or nowhere (made by the grounder).
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtomName {
    pub predicate: u32,
    pub row: u32,
}

/// A conditional effect: `effect` where `condition` held.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundEffect {
    pub condition: Stretch,
    pub effect: Lit,
}

/// A ground operator.
#[derive(Clone, Debug)]
pub(crate) struct GroundOperator {
    pub schema: u32,
    /// Where its arguments start in [`Ground::args`].
    pub args: u32,
    pub precondition: Stretch,
    /// Unconditional effects.
    pub effects: Stretch,
    /// Stretch of [`Ground::conditional`].
    pub conditional: Stretch,
    /// Stretch of the effects in [`Ground::numbers`].
    pub numeric: Stretch,
    pub cost: f64,
}

/// `head` holds where `body` does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundRule {
    pub head: u32,
    pub body: Stretch,
}

/// The grounded task.
#[derive(Debug, Default)]
pub(crate) struct Ground {
    /// The atoms' names; `None` for conditions that only exist on ground level.
    pub names: Vec<Option<AtomName>>,
    /// Whether each atom is derived.
    pub derived: Vec<bool>,
    /// Whether each atom holds at first (derived ones: not yet).
    pub init: Vec<bool>,
    pub pool: Vec<Lit>,
    pub args: Vec<u32>,
    pub operators: Vec<GroundOperator>,
    pub conditional: Vec<GroundEffect>,
    pub rules: Vec<GroundRule>,
    /// What changes and compares numbers.
    pub numbers: Numbers,
    pub goal: Stretch,
    /// Parts of the goal that can never hold, as text. Not empty: the task has no solution.
    pub impossible: Vec<String>,
    /// Goal literals that simplification found to be out of reach.
    pub unreachable_goals: Vec<Lit>,
    /// Whether each atom can matter for the goal.
    pub relevant: Vec<bool>,
    /// Set where the fixpoint ignored a condition (a universal quantifier), so that reachability on ground
    /// level may find less reachable.
    pub approximate: bool,
}

impl Ground {
    pub fn lits(&self, stretch: Stretch) -> &[Lit] {
        &self.pool[stretch.range()]
    }

    /// A derived atom that only exists on ground level.
    pub fn new_derived(&mut self) -> u32 {
        self.names.push(None);
        self.derived.push(true);
        self.init.push(false);
        self.names.len() as u32 - 1
    }

    /// Stores literals.
    pub fn store(&mut self, lits: &[Lit]) -> Stretch {
        let start = self.pool.len() as u32;
        self.pool.extend_from_slice(lits);
        Stretch { start, len: lits.len() as u32 }
    }

    /// Keeps, in place, the literals of a stretch that `keep` wants.
    pub fn retain(pool: &mut [Lit], stretch: &mut Stretch, keep: impl Fn(Lit) -> bool) {
        let start = stretch.start as usize;
        let mut kept = 0;
        for at in 0..stretch.len as usize {
            let lit = pool[start + at];
            if keep(lit) {
                pool[start + kept] = lit;
                kept += 1;
            }
        }
        stretch.len = kept as u32;
    }
}
