//! The instances of the rules as propositional operators, effects and axioms.

use super::join::UNBOUND;
use super::limits::Ticks;
use super::numbers::{GroundNumericEffect, InitialValues};
use super::propositional::{AtomName, Ground, GroundEffect, GroundOperator, GroundRule, Lit, Stretch};
use super::quantified::Expander;
use super::reach::Reached;
use super::{GroundError, GroundLimits};
use crate::lifted::{
    Applied, Body, Change, ConditionalChange, Formula, Head, Lifted, LiftedAtom, Role, Schema, Term, describe,
};

/// Turns the fixpoint into a propositional task.
pub(crate) fn instantiate(
    lifted: &Lifted,
    reached: &Reached,
    limits: &GroundLimits<'_>,
) -> Result<Ground, GroundError> {
    let mut builder = Builder::new(lifted, reached, limits);
    let effects = builder.effects()?;
    for (index, rule) in lifted.rules.iter().enumerate() {
        match &rule.head {
            Head::Act { action } => builder.operators(index, *action, &effects)?,
            Head::Derived(head) => builder.axioms(index, head)?,
            Head::Effect { .. } => {}
        }
    }
    builder.goal()?;
    builder.ground.pool.shrink_to_fit();
    builder.ground.numbers.missing = builder.ground.numbers.warning();
    Ok(builder.ground)
}

/// Effects of actions, by the row of the action's reached instance.
type ByRow<T> = Vec<(u32, T)>;

/// The conditional effects of one action that depend on the same parameters.
#[derive(Clone, Default)]
struct Conditional {
    facts: ByRow<GroundEffect>,
    numbers: ByRow<GroundNumericEffect>,
}

/// The effects of one row.
fn of_row<T>(effects: &ByRow<T>, row: u32) -> impl Iterator<Item = &T> {
    let first = effects.partition_point(|&(of, _)| of < row);
    effects[first..].iter().take_while(move |&&(of, _)| of == row).map(|(_, effect)| effect)
}

/// What a literal comes to.
pub(super) enum Value {
    Constant(bool),
    Open(Lit),
}

struct Builder<'a> {
    world: World<'a>,
    expander: Expander,
    ground: Ground,
    ticks: Ticks,
    limits: &'a GroundLimits<'a>,
    /// Work space: arguments of an [`Applied`].
    args: Vec<u32>,
    /// How many effects were copied: instances that no rule counts.
    copies: usize,
}

/// The reached facts with their numbers as atoms, and the numbers that never change.
pub(super) struct World<'a> {
    pub lifted: &'a Lifted,
    pub reached: &'a Reached,
    /// The number of each predicate's first atom.
    base: Vec<u32>,
    pub initial: InitialValues,
}

impl<'a> Builder<'a> {
    fn new(lifted: &'a Lifted, reached: &'a Reached, limits: &'a GroundLimits<'a>) -> Self {
        let mut ground = Ground::default();
        let mut base = Vec::with_capacity(lifted.symbols.predicates.len());
        for (predicate, declared) in lifted.symbols.predicates.iter().enumerate() {
            base.push(ground.names.len() as u32);
            if matches!(declared.role, Role::Fluent | Role::Derived) {
                let rows = reached.relations[predicate].len() as u32;
                let names = (0..rows).map(|row| Some(AtomName { predicate: predicate as u32, row }));
                ground.names.extend(names);
                ground.derived.resize(ground.names.len(), declared.role == Role::Derived);
            }
        }
        ground.init = vec![false; ground.names.len()];
        let world = World { lifted, reached, base, initial: InitialValues::new(lifted) };
        for (predicate, args) in &lifted.init {
            let Some(atom) = world.atom(*predicate, args) else { continue };
            if ground.derived[atom as usize] {
                // A derived atom listed as a fact: an axiom without conditions.
                ground.rules.push(GroundRule { head: atom, body: Stretch::default() });
            } else {
                ground.init[atom as usize] = true;
            }
        }
        Builder {
            world,
            expander: Expander::default(),
            ground,
            ticks: Ticks::default(),
            limits,
            args: Vec::new(),
            copies: 0,
        }
    }

    /// The binding of a rule's scope for one of its instances.
    fn bind(body: &Body, values: &[u32], binding: &mut Vec<u32>) {
        binding.clear();
        binding.resize(body.variables.len(), UNBOUND);
        for (&slot, &value) in body.bound.iter().zip(values) {
            binding[slot as usize] = value;
        }
    }

    /// The literals of a body; false if it can never hold. `skip` atoms at the front are not conditions.
    fn condition(
        &mut self,
        rule: u32,
        body: &Body,
        skip: usize,
        binding: &mut Vec<u32>,
        out: &mut Vec<Lit>,
    ) -> Result<bool, GroundError> {
        out.clear();
        for (atoms, positive) in [(&body.atoms[skip..], true), (&body.absent[..], false)] {
            for atom in atoms {
                match self.world.literal(atom, positive, binding) {
                    Value::Constant(true) => {}
                    Value::Constant(false) => return Ok(false),
                    Value::Open(lit) => out.push(lit),
                }
            }
        }
        for comparison in &body.comparisons {
            match self.world.compare(comparison, binding, &mut self.ground) {
                Value::Constant(true) => {}
                Value::Constant(false) => return Ok(false),
                Value::Open(lit) => out.push(lit),
            }
        }
        for (at, forall) in body.foralls.iter().enumerate() {
            let key = (rule, at as u32);
            let ranges = &body.variables;
            if !self.expander.expand(
                &self.world,
                &mut self.ground,
                key,
                forall,
                ranges,
                binding,
                self.limits,
                out,
            )? {
                return Ok(false);
            }
        }
        out.sort_unstable();
        out.dedup();
        // An atom and its negation stand side by side.
        Ok(out.windows(2).all(|pair| pair[0].atom() != pair[1].atom()))
    }

    /// The effects of each action, for each of its [`crate::lifted::Schema::applied`].
    fn effects(&mut self) -> Result<Vec<Vec<Conditional>>, GroundError> {
        let lifted = self.world.lifted;
        let mut by_action: Vec<_> =
            lifted.schemas.iter().map(|schema| vec![Conditional::default(); schema.applied.len()]).collect();
        let (mut binding, mut condition) = (Vec::new(), Vec::new());
        for (index, rule) in lifted.rules.iter().enumerate() {
            let Head::Effect { action, effect } = rule.head else { continue };
            let schema = &lifted.schemas[action as usize];
            let ConditionalChange { change, applied } = &schema.conditional[effect as usize];
            // The first atom says that the action was reached, the second of a delete that it can matter.
            let skip = if matches!(change, Change::Delete(_)) { 2 } else { 1 };
            let into = &mut by_action[action as usize][*applied];
            let asked = schema.applied[*applied].params.len();
            let applied = &self.world.reached.relations[schema.applied[*applied].predicate as usize];
            let width = rule.body.bound.len();
            for instance in 0..self.world.reached.counts[index] {
                let values = &self.world.reached.instances[index][instance * width..(instance + 1) * width];
                self.ticks.tick(self.limits)?;
                Self::bind(&rule.body, values, &mut binding);
                if !self.condition(index as u32, &rule.body, skip, &mut binding, &mut condition)? {
                    continue;
                }
                let Some(row) = applied.find(&values[..asked]) else { continue };
                let (Change::Add(atom) | Change::Delete(atom)) = change else {
                    let condition = self.ground.store(&condition);
                    into.numbers.extend(self.number(change, condition, &binding).map(|effect| (row, effect)));
                    continue;
                };
                let Value::Open(mut effect) = self.world.literal(atom, true, &binding) else { continue };
                if matches!(change, Change::Delete(_)) {
                    effect = effect.negated();
                }
                let condition = self.ground.store(&condition);
                into.facts.push((row, GroundEffect { condition, effect }));
            }
        }
        for effects in by_action.iter_mut().flatten() {
            // Stable, so that effects keep the order of their rules.
            effects.facts.sort_by_key(|&(row, _)| row);
            effects.numbers.sort_by_key(|&(row, _)| row);
        }
        Ok(by_action)
    }

    /// The effect on a number, if the change is one.
    fn number(
        &mut self,
        change: &Change,
        condition: Stretch,
        binding: &[u32],
    ) -> Option<GroundNumericEffect> {
        let Change::Numeric(op, target, value) = change else { return None };
        Some(self.world.change((*op, target, value), condition, binding, &mut self.ground.numbers))
    }

    fn operators(
        &mut self,
        index: usize,
        action: u32,
        effects: &[Vec<Conditional>],
    ) -> Result<(), GroundError> {
        let (lifted, reached) = (self.world.lifted, self.world.reached);
        let (rule, schema) = (&lifted.rules[index], &lifted.schemas[action as usize]);
        let width = rule.body.bound.len();
        let (mut binding, mut lits, mut plain) = (Vec::new(), Vec::new(), Vec::new());
        for instance in 0..reached.counts[index] {
            let values = &reached.instances[index][instance * width..(instance + 1) * width];
            self.ticks.tick(self.limits)?;
            Self::bind(&rule.body, values, &mut binding);
            if !self.condition(index as u32, &rule.body, 0, &mut binding, &mut lits)? {
                continue;
            }
            let Some(cost) = self.world.cost(schema, &binding, &mut self.ground.numbers) else { continue };
            let precondition = self.ground.store(&lits);
            plain.clear();
            for change in &schema.effects {
                let (atom, holds) = match change {
                    Change::Add(atom) => (atom, true),
                    Change::Delete(atom) => (atom, false),
                    Change::Numeric(..) => continue,
                };
                // Atoms that are never true need no delete.
                if let Value::Open(lit) = self.world.literal(atom, true, &binding) {
                    plain.push(if holds { lit } else { lit.negated() });
                }
            }
            let effects = &effects[action as usize];
            let conditional = self.conditional_effects(schema, values, effects, &mut plain)?;
            let numeric = self.numeric_effects(schema, values, effects, &binding)?;
            // Where an action both deletes and adds an atom, the add wins; it is the smaller literal.
            plain.sort_unstable();
            plain.dedup_by_key(|lit| lit.atom());
            let stored = self.ground.store(&plain);
            let args = self.ground.args.len() as u32;
            self.ground.args.extend_from_slice(&values[..schema.params]);
            self.ground.operators.push(GroundOperator {
                schema: action,
                args,
                precondition,
                effects: stored,
                conditional,
                numeric,
                cost,
            });
        }
        Ok(())
    }

    /// The row of the reached action that some of its effects begin with.
    fn row(&mut self, applied: &Applied, values: &[u32]) -> u32 {
        applied.args(values, &mut self.args);
        self.world.reached.relations[applied.predicate as usize].find(&self.args).unwrap_or(UNBOUND)
    }

    /// Copies the effects of one reached action; those whose condition always holds join the plain ones.
    fn conditional_effects(
        &mut self,
        schema: &Schema,
        values: &[u32],
        effects: &[Conditional],
        plain: &mut Vec<Lit>,
    ) -> Result<Stretch, GroundError> {
        let start = self.ground.conditional.len() as u32;
        for (applied, effects) in schema.applied.iter().zip(effects).filter(|(_, e)| !e.facts.is_empty()) {
            let row = self.row(applied, values);
            for effect in of_row(&effects.facts, row) {
                self.count_copy()?;
                if effect.condition.len == 0 {
                    plain.push(effect.effect);
                } else {
                    let condition = self.own(effect.condition);
                    self.ground.conditional.push(GroundEffect { condition, ..*effect });
                }
            }
        }
        Ok(Stretch { start, len: self.ground.conditional.len() as u32 - start })
    }

    /// Counts a copy of an effect like an instance of a rule.
    fn count_copy(&mut self) -> Result<(), GroundError> {
        self.ticks.tick(self.limits)?;
        self.copies += 1;
        if self.copies > self.limits.instances {
            let limit = self.limits.instances as u64;
            return Err(GroundError::TooLarge { what: "conditional and quantified effects", limit });
        }
        Ok(())
    }

    /// A copy of a condition: it is shortened for each effect apart.
    fn own(&mut self, condition: Stretch) -> Stretch {
        let start = self.ground.pool.len() as u32;
        self.ground.pool.extend_from_within(condition.range());
        Stretch { start, ..condition }
    }

    /// Stores the effects on numbers of one reached action, the plain ones first.
    fn numeric_effects(
        &mut self,
        schema: &Schema,
        values: &[u32],
        conditional: &[Conditional],
        binding: &[u32],
    ) -> Result<Stretch, GroundError> {
        let start = self.ground.numbers.effects.len() as u32;
        for change in &schema.effects {
            let effect = self.number(change, Stretch::default(), binding);
            self.ground.numbers.effects.extend(effect);
        }
        for (applied, effects) in
            schema.applied.iter().zip(conditional).filter(|(_, e)| !e.numbers.is_empty())
        {
            let row = self.row(applied, values);
            for effect in of_row(&effects.numbers, row) {
                self.count_copy()?;
                let condition = self.own(effect.condition);
                self.ground.numbers.effects.push(GroundNumericEffect { condition, ..effect.clone() });
            }
        }
        Ok(Stretch { start, len: self.ground.numbers.effects.len() as u32 - start })
    }

    fn axioms(&mut self, index: usize, head: &LiftedAtom) -> Result<(), GroundError> {
        let (lifted, reached) = (self.world.lifted, self.world.reached);
        let body = &lifted.rules[index].body;
        let width = body.bound.len();
        let (mut binding, mut lits) = (Vec::new(), Vec::new());
        for instance in 0..reached.counts[index] {
            let values = &reached.instances[index][instance * width..(instance + 1) * width];
            self.ticks.tick(self.limits)?;
            Self::bind(body, values, &mut binding);
            if !self.condition(index as u32, body, 0, &mut binding, &mut lits)? {
                continue;
            }
            if let Value::Open(head) = self.world.literal(head, true, &binding) {
                let body = self.ground.store(&lits);
                self.ground.rules.push(GroundRule { head: head.atom() as u32, body });
            }
        }
        Ok(())
    }

    fn goal(&mut self) -> Result<(), GroundError> {
        let lifted = self.world.lifted;
        let body = &lifted.goal;
        let mut binding = vec![UNBOUND; body.variables.len()];
        for atom in &body.atoms {
            if let Value::Constant(false) = self.world.literal(atom, true, &binding) {
                let text = self.world.describe(atom);
                self.ground.impossible.push(text);
            }
        }
        for atom in &body.absent {
            if let Value::Constant(false) = self.world.literal(atom, false, &binding) {
                let text = format!("(not {})", self.world.describe(atom));
                self.ground.impossible.push(text);
            }
        }
        for comparison in &body.comparisons {
            if let Value::Constant(false) = self.world.compare(comparison, &binding, &mut self.ground) {
                let text = describe(&Formula::Compare(comparison.clone()), &lifted.symbols, &[]);
                self.ground.impossible.push(text);
            }
        }
        let mut lits = Vec::new();
        for (forall, text) in body.foralls.iter().zip(&lifted.goal_foralls) {
            let alone =
                Body { variables: body.variables.clone(), foralls: vec![forall.clone()], ..Body::default() };
            if !self.condition(u32::MAX - 1, &alone, 0, &mut binding, &mut lits)? {
                self.ground.impossible.push(text.clone());
            }
            self.expander.forget(u32::MAX - 1);
        }
        let possible = self.condition(u32::MAX, body, 0, &mut binding, &mut lits)?;
        if (!possible || body.never) && self.ground.impossible.is_empty() {
            self.ground.impossible.push("the goal contradicts itself or what never changes".into());
        }
        self.ground.goal = self.ground.store(if possible { &lits } else { &[] });
        Ok(())
    }
}

impl World<'_> {
    /// The atom of a fluent or derived predicate, if it can become true.
    pub fn atom(&self, predicate: u32, args: &[u32]) -> Option<u32> {
        let role = self.lifted.symbols.predicates[predicate as usize].role;
        if !matches!(role, Role::Fluent | Role::Derived) {
            return None;
        }
        self.reached.relations[predicate as usize].find(args).map(|row| self.base[predicate as usize] + row)
    }

    /// What a literal comes to under a full binding of its variables.
    pub fn literal(&self, atom: &LiftedAtom, positive: bool, binding: &[u32]) -> Value {
        let mut buffer = [0u32; 16];
        let mut large = Vec::new();
        let args: &[u32] = if atom.args.len() <= buffer.len() {
            for (arg, &term) in buffer.iter_mut().zip(&atom.args) {
                *arg = object(term, binding);
            }
            &buffer[..atom.args.len()]
        } else {
            large.extend(atom.args.iter().map(|&term| object(term, binding)));
            &large
        };
        let relation = &self.reached.relations[atom.predicate as usize];
        match (relation.find(args), self.lifted.symbols.predicates[atom.predicate as usize].role) {
            (None, _) => Value::Constant(!positive),
            (Some(_), Role::Static) => Value::Constant(positive),
            (Some(row), _) => Value::Open(Lit::new(self.base[atom.predicate as usize] + row, positive)),
        }
    }

    /// A goal atom for people.
    fn describe(&self, atom: &LiftedAtom) -> String {
        let explained = &self.lifted.explained;
        if let Some((_, text)) = explained.iter().find(|(predicate, _)| *predicate == atom.predicate) {
            return text.clone();
        }
        let symbols = &self.lifted.symbols;
        let args: String =
            atom.args.iter().map(|&t| format!(" {}", symbols.objects[object(t, &[]) as usize])).collect();
        format!("({}{args})", symbols.predicates[atom.predicate as usize].name)
    }
}

/// The object a term stands for.
pub(super) fn object(term: Term, binding: &[u32]) -> u32 {
    match term {
        Term::Object(object) => object,
        Term::Variable(slot) => binding[slot as usize],
    }
}
