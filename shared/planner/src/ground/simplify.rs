//! Removes what cannot matter: constant atoms, operators that can never apply, atoms that nothing asks for.

use super::bounds::Bounds;
use super::numbers::GroundNumericEffect;
use super::propositional::{Ground, GroundOperator, Lit, Stretch};
use crate::csr::Csr;

/// Reachability is worked out again at most so often; each round may find a little more.
const MAX_ROUNDS: usize = 4;
const NONE: u32 = u32::MAX;

/// Simplifies the task in place.
pub(crate) fn simplify(ground: &mut Ground) {
    for _ in 0..MAX_ROUNDS {
        if !ground.impossible.is_empty() {
            ground.operators.clear();
            ground.rules.clear();
            ground.goal = Stretch::default();
            ground.relevant = vec![false; ground.names.len()];
            return;
        }
        let reachable = if ground.approximate { reachable(ground) } else { vec![true; ground.names.len()] };
        if !remove_constants(ground, &reachable) {
            break;
        }
        ground.approximate = true;
    }
    super::inline::inline(ground);
    remove_irrelevant(ground);
}

/// The atoms that hold in some state if deletes are ignored and numbers go as far as they can.
fn reachable(ground: &Ground) -> Vec<bool> {
    let mut bounds = Bounds::new(ground);
    loop {
        let mut reached = ground.init.clone();
        bounds.possible(ground).for_each(|atom| reached[atom] = true);
        reach_from(ground, &mut reached);
        if !bounds.widen(ground, &reached) {
            return reached;
        }
    }
}

/// Adds to `reached` what follows when deletes are ignored.
fn reach_from(ground: &Ground, reached: &mut [bool]) {
    // Nodes: operators, then conditional effects (which also wait for their operator), then rules.
    let (operators, conditional) = (ground.operators.len(), ground.conditional.len());
    let mut waits = vec![0u32; operators + conditional + ground.rules.len()];
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    let mut wait = |node: usize, stretch: Stretch, extra: u32| {
        let positive = ground.lits(stretch).iter().filter(|lit| lit.holds());
        let before = pairs.len();
        pairs.extend(positive.map(|lit| (lit.atom() as u32, node as u32)));
        waits[node] = (pairs.len() - before) as u32 + extra;
    };
    for (node, operator) in ground.operators.iter().enumerate() {
        wait(node, operator.precondition, 0);
    }
    for (at, effect) in ground.conditional.iter().enumerate() {
        wait(operators + at, effect.condition, 1);
    }
    for (at, rule) in ground.rules.iter().enumerate() {
        wait(operators + conditional + at, rule.body, 0);
    }
    let needed_by = Csr::from_pairs(ground.names.len(), pairs.iter().copied());
    let mut agenda: Vec<usize> = (0..reached.len()).filter(|&atom| reached[atom]).collect();
    let mut ready: Vec<usize> = (0..waits.len()).filter(|&node| waits[node] == 0).collect();
    loop {
        while let Some(node) = ready.pop() {
            let mut reach = |lit: Lit| {
                if lit.holds() && !reached[lit.atom()] {
                    reached[lit.atom()] = true;
                    agenda.push(lit.atom());
                }
            };
            if node < operators {
                let operator = &ground.operators[node];
                ground.lits(operator.effects).iter().for_each(|&lit| reach(lit));
                for effect in operator.conditional.range() {
                    waits[operators + effect] -= 1;
                    if waits[operators + effect] == 0 {
                        ready.push(operators + effect);
                    }
                }
            } else if node < operators + conditional {
                reach(ground.conditional[node - operators].effect);
            } else {
                reach(Lit::new(ground.rules[node - operators - conditional].head, true));
            }
        }
        let Some(atom) = agenda.pop() else { return };
        for &node in needed_by.row(atom) {
            waits[node as usize] -= 1;
            if waits[node as usize] == 0 {
                ready.push(node as usize);
            }
        }
    }
}

/// Atoms that hold in every reachable state.
fn always_true(ground: &Ground, reachable: &[bool]) -> Vec<bool> {
    let mut always = ground.init.clone();
    for operator in &ground.operators {
        let conditional = ground.conditional[operator.conditional.range()].iter().map(|e| e.effect);
        for lit in ground.lits(operator.effects).iter().copied().chain(conditional) {
            if !lit.holds() {
                always[lit.atom()] = false;
            }
        }
    }
    // Derived atoms with a rule that always fires; chains of rules need several passes.
    loop {
        let mut changed = false;
        for rule in &ground.rules {
            let fires = |lit: &Lit| if lit.holds() { always[lit.atom()] } else { !reachable[lit.atom()] };
            if !always[rule.head as usize] && ground.lits(rule.body).iter().all(fires) {
                always[rule.head as usize] = true;
                changed = true;
            }
        }
        if !changed {
            return always;
        }
    }
}

/// Removes constants from all conditions, and what they make impossible. Returns whether operators, effects
/// or rules went.
fn remove_constants(ground: &mut Ground, reachable: &[bool]) -> bool {
    let always = always_true(ground, reachable);
    let certain = |lit: Lit| if lit.holds() { always[lit.atom()] } else { !reachable[lit.atom()] };
    let pool = &mut ground.pool;
    // Shortens a condition; false if it can never hold.
    let shorten = |pool: &mut Vec<Lit>, stretch: &mut Stretch| {
        if pool[stretch.range()].iter().any(|&lit| certain(lit.negated())) {
            return false;
        }
        Ground::retain(pool, stretch, |lit| !certain(lit));
        true
    };
    let before = (ground.operators.len(), ground.rules.len());
    let mut effects_removed = false;
    let mut conditional = Vec::with_capacity(ground.conditional.len());
    let mut numeric = Vec::with_capacity(ground.numbers.effects.len());
    ground.operators.retain_mut(|operator| {
        if !shorten(pool, &mut operator.precondition) {
            return false;
        }
        // Adding what always holds and deleting what never does is no effect.
        Ground::retain(pool, &mut operator.effects, |lit| !certain(lit));
        let start = conditional.len() as u32;
        for at in operator.conditional.range() {
            let mut effect = ground.conditional[at];
            if certain(effect.effect) || !shorten(pool, &mut effect.condition) {
                effects_removed = true;
                continue;
            }
            conditional.push(effect);
        }
        operator.conditional = Stretch { start, len: conditional.len() as u32 - start };
        let start = numeric.len() as u32;
        for at in operator.numeric.range() {
            let mut effect = ground.numbers.effects[at].clone();
            if shorten(pool, &mut effect.condition) {
                numeric.push(effect);
            }
        }
        operator.numeric = Stretch { start, len: numeric.len() as u32 - start };
        true
    });
    ground.conditional = conditional;
    ground.numbers.effects = numeric;
    ground.rules.retain_mut(|rule| !always[rule.head as usize] && shorten(pool, &mut rule.body));
    let goal: Vec<Lit> = pool[ground.goal.range()].to_vec();
    if !shorten(pool, &mut ground.goal) {
        for lit in goal.into_iter().filter(|lit| certain(lit.negated())) {
            ground.unreachable_goals.push(lit);
        }
        // The encoder, which knows the names, says them.
        ground.impossible = vec![String::new(); ground.unreachable_goals.len()];
    }
    effects_removed || before != (ground.operators.len(), ground.rules.len())
}

/// Keeps only the atoms that the goal asks for, directly or through conditions.
fn remove_irrelevant(ground: &mut Ground) {
    let atoms = ground.names.len();
    // For each literal what can make it true: operators (and the effect's condition) and rules.
    let mut makers: Vec<(u32, u32)> = Vec::new();
    // For each atom all effects on it, as conditions that matter once the atom does.
    let mut on_atom: Vec<(u32, u32)> = Vec::new();
    for (index, operator) in ground.operators.iter().enumerate() {
        makers.extend(ground.lits(operator.effects).iter().map(|lit| (lit.0, index as u32)));
        for at in operator.conditional.range() {
            let effect = ground.conditional[at].effect;
            makers.push((effect.0, index as u32));
            on_atom.push((effect.atom() as u32, at as u32));
        }
    }
    let makers = Csr::from_pairs(atoms * 2, makers.iter().copied());
    let on_atom = Csr::from_pairs(atoms, on_atom.iter().copied());
    let mut numbers = NeededNumbers::new(ground);
    let rules =
        Csr::from_pairs(atoms, ground.rules.iter().enumerate().map(|(at, rule)| (rule.head, at as u32)));
    let mut needed = vec![false; atoms * 2];
    let mut useful = vec![false; ground.operators.len()];
    let mut agenda: Vec<Lit> = ground.lits(ground.goal).to_vec();
    for maker in numbers.fallible(ground, &mut agenda) {
        useful[maker as usize] = true;
        agenda.extend(ground.lits(ground.operators[maker as usize].precondition));
    }
    while let Some(lit) = agenda.pop() {
        for maker in numbers.asked_by(ground, lit, &mut agenda) {
            if !std::mem::replace(&mut useful[maker as usize], true) {
                agenda.extend(ground.lits(ground.operators[maker as usize].precondition));
            }
        }
        if std::mem::replace(&mut needed[lit.0 as usize], true) {
            continue;
        }
        for &maker in makers.row(lit.0 as usize) {
            if !std::mem::replace(&mut useful[maker as usize], true) {
                agenda.extend(ground.lits(ground.operators[maker as usize].precondition));
            }
        }
        if needed[lit.negated().0 as usize] {
            continue;
        }
        for &effect in on_atom.row(lit.atom()) {
            agenda.extend(ground.lits(ground.conditional[effect as usize].condition));
        }
        for &rule in rules.row(lit.atom()) {
            for &body in ground.lits(ground.rules[rule as usize].body) {
                agenda.extend([body, body.negated()]);
            }
        }
    }
    let relevant = |lit: Lit| needed[lit.0 as usize] || needed[lit.negated().0 as usize];
    let (pool, conditional) = (&mut ground.pool, &ground.conditional);
    let mut kept = Vec::with_capacity(conditional.len());
    let mut index = 0;
    ground.operators.retain_mut(|operator| {
        index += 1;
        if !useful[index - 1] {
            return false;
        }
        Ground::retain(pool, &mut operator.effects, relevant);
        let start = kept.len() as u32;
        kept.extend(
            conditional[operator.conditional.range()].iter().filter(|effect| relevant(effect.effect)),
        );
        operator.conditional = Stretch { start, len: kept.len() as u32 - start };
        numbers.keep(operator);
        operator.effects.len + operator.conditional.len + operator.numeric.len > 0
    });
    ground.conditional = kept;
    ground.numbers.effects = numbers.kept;
    ground.rules.retain(|rule| relevant(Lit::new(rule.head, true)));
    ground.relevant = (0..atoms as u32).map(|atom| relevant(Lit::new(atom, true))).collect();
}

/// The numbers that comparisons ask for, directly or through the values of effects.
struct NeededNumbers {
    /// The comparison that each atom stands for.
    comparison_of: Vec<u32>,
    /// The effects on each number, and the operator of each effect.
    effects: Csr<u32>,
    operator_of: Vec<u32>,
    needed: Vec<bool>,
    /// Effects that may have no result decide whether their operators apply, so they stay.
    fallible: Vec<bool>,
    all: Vec<GroundNumericEffect>,
    kept: Vec<GroundNumericEffect>,
}

impl NeededNumbers {
    fn new(ground: &mut Ground) -> Self {
        let numbers = &mut ground.numbers;
        let mut comparison_of =
            vec![NONE; if numbers.comparisons.is_empty() { 0 } else { ground.names.len() }];
        for (at, (atom, ..)) in numbers.comparisons.iter().enumerate() {
            comparison_of[*atom as usize] = at as u32;
        }
        let fallible = numbers.effects.iter().map(|effect| !numbers.is_safe(effect)).collect();
        let all = std::mem::take(&mut numbers.effects);
        let mut operator_of = vec![NONE; all.len()];
        for (at, operator) in ground.operators.iter().enumerate() {
            operator_of[operator.numeric.range()].fill(at as u32);
        }
        let targets = all.iter().enumerate().map(|(at, effect)| (effect.target, at as u32));
        NeededNumbers {
            comparison_of,
            effects: Csr::from_pairs(numbers.initial.len(), targets),
            operator_of,
            needed: vec![false; numbers.initial.len()],
            fallible,
            all,
            kept: Vec::new(),
        }
    }

    /// The operators that change numbers which the literal asks for.
    fn asked_by(&mut self, ground: &Ground, lit: Lit, agenda: &mut Vec<Lit>) -> Vec<u32> {
        let Some(&comparison) = self.comparison_of.get(lit.atom()).filter(|&&at| at != NONE) else {
            return Vec::new();
        };
        let mut open = Vec::new();
        ground.numbers.comparisons[comparison as usize].1.for_each_variable(&mut |number| open.push(number));
        self.need(ground, open, agenda)
    }

    /// The operators that change numbers which an effect that may have no result reads.
    fn fallible(&mut self, ground: &Ground, agenda: &mut Vec<Lit>) -> Vec<u32> {
        let mut open = Vec::new();
        for (effect, _) in self.all.iter().zip(&self.fallible).filter(|(_, fallible)| **fallible) {
            open.push(effect.target);
            effect.value.for_each_variable(&mut |number| open.push(number));
        }
        self.need(ground, open, agenda)
    }

    /// The operators that change the numbers; what their effects ask for in turn goes to `agenda`.
    fn need(&mut self, ground: &Ground, mut open: Vec<u32>, agenda: &mut Vec<Lit>) -> Vec<u32> {
        let mut operators = Vec::new();
        while let Some(number) = open.pop() {
            if std::mem::replace(&mut self.needed[number as usize], true) {
                continue;
            }
            for &effect in self.effects.row(number as usize) {
                let effect = effect as usize;
                // Simplification may have removed the operator.
                if self.operator_of[effect] == NONE {
                    continue;
                }
                operators.push(self.operator_of[effect]);
                agenda.extend(ground.lits(self.all[effect].condition));
                self.all[effect].value.for_each_variable(&mut |number| open.push(number));
            }
        }
        operators
    }

    /// Keeps the operator's effects that matter.
    fn keep(&mut self, operator: &mut GroundOperator) {
        let start = self.kept.len() as u32;
        for at in operator.numeric.range() {
            if self.needed[self.all[at].target as usize] || self.fallible[at] {
                self.kept.push(self.all[at].clone());
            }
        }
        operator.numeric = Stretch { start, len: self.kept.len() as u32 - start };
    }
}
