//! Keeps only what the goal asks for, directly or through conditions: the rule of [`super::relevance`] and its
//! proof, on ground literals, where it is sharpest.

use super::numbers::GroundNumericEffect;
use super::propositional::{Ground, GroundOperator, Lit, Stretch};
use crate::csr::Csr;

const NONE: u32 = u32::MAX;

/// Removes operators, effects, atoms and rules that nobody needs, and from conditions what then always holds.
pub(super) fn keep_needed(ground: &mut Ground) {
    let mut search = Search::new(ground);
    search.run(ground);
    search.remove_rest(ground);
}

struct Search {
    /// The operators that can make each literal true.
    makers: Csr<u32>,
    /// The conditional effects on each atom, and the operator of each effect.
    on_atom: Csr<u32>,
    operator_of: Vec<u32>,
    /// The rules of each atom.
    rules: Csr<u32>,
    numbers: NeededNumbers,
    /// By literal: whether it is needed, and whether a useful operator can make it false.
    needed: Vec<bool>,
    falsified: Vec<bool>,
    useful: Vec<bool>,
    /// Literals to need, and needed ones whose makers are useful.
    agenda: Vec<Lit>,
    live: Vec<Lit>,
}

impl Search {
    fn new(ground: &mut Ground) -> Self {
        let atoms = ground.names.len();
        let mut makers: Vec<(u32, u32)> = Vec::new();
        let mut on_atom: Vec<(u32, u32)> = Vec::new();
        let mut operator_of = vec![NONE; ground.conditional.len()];
        for (index, operator) in ground.operators.iter().enumerate() {
            makers.extend(ground.lits(operator.effects).iter().map(|lit| (lit.0, index as u32)));
            for at in operator.conditional.range() {
                let effect = ground.conditional[at].effect;
                makers.push((effect.0, index as u32));
                on_atom.push((effect.atom() as u32, at as u32));
                operator_of[at] = index as u32;
            }
        }
        let rules = ground.rules.iter().enumerate().map(|(at, rule)| (rule.head, at as u32));
        Search {
            makers: Csr::from_pairs(atoms * 2, makers.iter().copied()),
            on_atom: Csr::from_pairs(atoms, on_atom.iter().copied()),
            operator_of,
            rules: Csr::from_pairs(atoms, rules),
            numbers: NeededNumbers::new(ground),
            needed: vec![false; atoms * 2],
            falsified: vec![false; atoms * 2],
            useful: vec![false; ground.operators.len()],
            agenda: Vec::new(),
            live: Vec::new(),
        }
    }

    fn run(&mut self, ground: &Ground) {
        self.agenda.extend(ground.lits(ground.goal));
        for operator in self.numbers.fallible(ground, &mut self.agenda) {
            self.involve(ground, operator);
        }
        loop {
            if let Some(lit) = self.live.pop() {
                for at in self.makers.range(lit.0 as usize) {
                    self.involve(ground, self.makers.items()[at]);
                }
            } else if let Some(lit) = self.agenda.pop() {
                self.need(ground, lit);
            } else {
                return;
            }
        }
    }

    fn need(&mut self, ground: &Ground, lit: Lit) {
        if std::mem::replace(&mut self.needed[lit.0 as usize], true) {
            return;
        }
        for operator in self.numbers.asked_by(ground, lit, &mut self.agenda) {
            self.involve(ground, operator);
        }
        let at_first = ground.init[lit.atom()] == lit.holds();
        if !at_first || self.falsified[lit.0 as usize] {
            self.live.push(lit);
        }
        for at in self.on_atom.range(lit.atom()) {
            let effect = self.on_atom.items()[at] as usize;
            if self.useful[self.operator_of[effect] as usize] {
                self.ask(ground, effect, lit);
            }
        }
        for &rule in self.rules.row(lit.atom()) {
            let body = ground.lits(ground.rules[rule as usize].body);
            self.agenda.extend(body.iter().flat_map(|&lit| [lit, lit.negated()]));
        }
    }

    fn involve(&mut self, ground: &Ground, operator: u32) {
        if std::mem::replace(&mut self.useful[operator as usize], true) {
            return;
        }
        let operator = &ground.operators[operator as usize];
        self.agenda.extend(ground.lits(operator.precondition));
        for &effect in ground.lits(operator.effects) {
            self.falsify(effect.negated());
        }
        for at in operator.conditional.range() {
            let effect = ground.conditional[at].effect;
            self.falsify(effect.negated());
            for lit in [effect, effect.negated()] {
                if self.needed[lit.0 as usize] {
                    self.ask(ground, at, lit);
                }
            }
        }
    }

    fn falsify(&mut self, lit: Lit) {
        if !std::mem::replace(&mut self.falsified[lit.0 as usize], true) && self.needed[lit.0 as usize] {
            self.live.push(lit);
        }
    }

    /// What a conditional effect on something needed asks for.
    fn ask(&mut self, ground: &Ground, effect: usize, needed: Lit) {
        let effect = &ground.conditional[effect];
        let condition = ground.lits(effect.condition).iter();
        if effect.effect == needed {
            self.agenda.extend(condition);
        } else {
            self.agenda.extend(condition.map(|lit| lit.negated()));
        }
    }

    fn remove_rest(self, ground: &mut Ground) {
        let Search { mut numbers, needed, falsified, useful, .. } = self;
        // What holds at first and never stops to hold is no condition.
        let open: Vec<bool> = (0..needed.len() as u32)
            .map(|lit| {
                let (lit, derived) = (Lit(lit), ground.derived[lit as usize / 2]);
                derived || ground.init[lit.atom()] != lit.holds() || falsified[lit.0 as usize]
            })
            .collect();
        let open = |lit: Lit| open[lit.0 as usize];
        let asked = |lit: Lit| needed[lit.0 as usize] && open(lit);
        let relevant: Vec<bool> = (0..ground.names.len() as u32)
            .map(|atom| asked(Lit::new(atom, true)) || asked(Lit::new(atom, false)))
            .collect();
        let (pool, conditional) = (&mut ground.pool, &mut ground.conditional);
        let mut kept = Vec::with_capacity(conditional.len());
        let mut index = 0;
        ground.operators.retain_mut(|operator| {
            index += 1;
            if !useful[index - 1] {
                return false;
            }
            Ground::retain(pool, &mut operator.precondition, open);
            Ground::retain(pool, &mut operator.effects, |lit| relevant[lit.atom()]);
            let start = kept.len() as u32;
            for effect in &mut conditional[operator.conditional.range()] {
                // What never holds lets no effect happen.
                let never = pool[effect.condition.range()].iter().any(|lit| !open(lit.negated()));
                if relevant[effect.effect.atom()] && !never {
                    Ground::retain(pool, &mut effect.condition, open);
                    kept.push(*effect);
                }
            }
            operator.conditional = Stretch { start, len: kept.len() as u32 - start };
            numbers.keep(operator);
            operator.effects.len + operator.conditional.len + operator.numeric.len > 0
        });
        ground.conditional = kept;
        ground.numbers.effects = numbers.kept;
        for effect in &mut ground.numbers.effects {
            Ground::retain(pool, &mut effect.condition, open);
        }
        ground.rules.retain_mut(|rule| {
            Ground::retain(pool, &mut rule.body, open);
            relevant[rule.head as usize]
        });
        Ground::retain(pool, &mut ground.goal, open);
        ground.relevant = relevant;
    }
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
                agenda.extend(ground.lits(self.all[effect].condition).iter().flat_map(|c| [*c, c.negated()]));
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
