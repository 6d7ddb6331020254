//! Derived atoms with a single rule are replaced by the rule's body: "some knife is held" with one knife in
//! the kitchen is then an ordinary condition.

use super::propositional::{Ground, Lit, Stretch};

/// Chains of derived atoms are followed this far.
const MAX_DEPTH: usize = 32;

/// Replaces such atoms wherever they are asked for positively, in place.
pub(super) fn inline(ground: &mut Ground) {
    if ground.rules.is_empty() {
        return;
    }
    let mut bodies: Vec<Option<Stretch>> = vec![None; ground.names.len()];
    let mut count = vec![0u32; ground.names.len()];
    for rule in &ground.rules {
        count[rule.head as usize] += 1;
        bodies[rule.head as usize] = Some(rule.body);
    }
    for (body, &count) in bodies.iter_mut().zip(&count) {
        if count != 1 {
            *body = None;
        }
    }
    let mut operators = std::mem::take(&mut ground.operators);
    operators.retain_mut(|operator| replace(ground, &bodies, &mut operator.precondition));
    ground.operators = operators;
    let mut conditional = std::mem::take(&mut ground.conditional);
    let mut impossible = vec![false; conditional.len()];
    for (effect, impossible) in conditional.iter_mut().zip(&mut impossible) {
        *impossible = !replace(ground, &bodies, &mut effect.condition);
    }
    let mut kept = Vec::with_capacity(conditional.len());
    for operator in &mut ground.operators {
        let start = kept.len() as u32;
        kept.extend(operator.conditional.range().filter(|&at| !impossible[at]).map(|at| conditional[at]));
        operator.conditional = Stretch { start, len: kept.len() as u32 - start };
    }
    ground.conditional = kept;
    let mut rules = std::mem::take(&mut ground.rules);
    rules.retain_mut(|rule| {
        let mut others = bodies[rule.head as usize].take();
        let possible = replace(ground, &bodies, &mut rule.body);
        std::mem::swap(&mut bodies[rule.head as usize], &mut others);
        possible
    });
    ground.rules = rules;
    let mut goal = ground.goal;
    if replace(ground, &bodies, &mut goal) {
        ground.goal = goal;
    }
}

/// Replaces in one condition; false if it contradicts itself afterwards.
fn replace(ground: &mut Ground, bodies: &[Option<Stretch>], stretch: &mut Stretch) -> bool {
    let replaceable = |lit: &Lit| lit.holds() && bodies[lit.atom()].is_some();
    if !ground.lits(*stretch).iter().any(replaceable) {
        return true;
    }
    let mut lits = ground.lits(*stretch).to_vec();
    for _ in 0..MAX_DEPTH {
        if !lits.iter().any(replaceable) {
            lits.sort_unstable();
            lits.dedup();
            if lits.windows(2).any(|pair| pair[0].atom() == pair[1].atom()) {
                return false;
            }
            *stretch = ground.store(&lits);
            return true;
        }
        let mut next = Vec::with_capacity(lits.len() + 4);
        for lit in lits {
            match bodies[lit.atom()].filter(|_| lit.holds()) {
                Some(body) => next.extend_from_slice(ground.lits(body)),
                None => next.push(lit),
            }
        }
        next.sort_unstable();
        next.dedup();
        lits = next;
    }
    // A long chain or a cycle: the axioms themselves stay.
    true
}
