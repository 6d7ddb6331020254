//! Removes what cannot matter: constant atoms, operators that can never apply, atoms that nothing asks for.

use super::bounds::Bounds;
use super::propositional::{Ground, Lit, Stretch};
use crate::csr::Csr;

/// Reachability is worked out again at most so often; each round may find a little more.
const MAX_ROUNDS: usize = 4;

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
    super::needed::keep_needed(ground);
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
