//! The instances of the rules as propositional operators, effects and axioms.

use lamma_pddl::ast::{ArithmeticOp, Comparison};

use super::join::UNBOUND;
use super::propositional::{AtomName, Ground, GroundEffect, GroundOperator, GroundRule, Lit, Stretch};
use super::quantified::Expander;
use super::reach::Reached;
use super::{GroundError, GroundLimits};
use crate::id_table::{IdTable, Slot, hash_words};
use crate::lifted::{Body, Change, Expr, Head, Lifted, LiftedAtom, Role, Term};

/// Turns the fixpoint into a propositional task.
pub(crate) fn instantiate(
    lifted: &Lifted,
    reached: &Reached,
    limits: &GroundLimits,
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
    Ok(builder.ground)
}

/// Conditional effects by action and by the row of the action's reached instance.
type EffectsByRow = Vec<Vec<(u32, GroundEffect)>>;

/// What a literal comes to.
pub(super) enum Value {
    Constant(bool),
    Open(Lit),
}

struct Builder<'a> {
    world: World<'a>,
    expander: Expander,
    ground: Ground,
    limits: &'a GroundLimits,
}

/// The reached facts with their numbers as atoms, and the numbers that never change.
pub(super) struct World<'a> {
    pub lifted: &'a Lifted,
    pub reached: &'a Reached,
    /// The number of each predicate's first atom.
    base: Vec<u32>,
    /// Initial values: rows of function and arguments.
    value_keys: Vec<Vec<u32>>,
    values: Vec<f64>,
    value_table: IdTable,
}

impl<'a> Builder<'a> {
    fn new(lifted: &'a Lifted, reached: &'a Reached, limits: &'a GroundLimits) -> Self {
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
        let mut world = World {
            lifted,
            reached,
            base,
            value_keys: Vec::new(),
            values: Vec::new(),
            value_table: IdTable::default(),
        };
        for (predicate, args) in &lifted.init {
            let Some(atom) = world.atom(*predicate, args) else { continue };
            if ground.derived[atom as usize] {
                // A derived atom listed as a fact: an axiom without conditions.
                ground.rules.push(GroundRule { head: atom, body: Stretch::default() });
            } else {
                ground.init[atom as usize] = true;
            }
        }
        for (function, args, value) in &lifted.values {
            world.set_value(*function, args, *value);
        }
        Builder { world, expander: Expander::default(), ground, limits }
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
            let held =
                self.world.compare(comparison.comparison, &comparison.left, &comparison.right, binding)?;
            if held.is_none_or(|held| held != comparison.positive) {
                return Ok(false);
            }
        }
        for (at, forall) in body.foralls.iter().enumerate() {
            let key = (rule, at as u32);
            let limit = self.limits.instances;
            let ranges = &body.variables;
            if !self.expander.expand(
                &self.world,
                &mut self.ground,
                key,
                forall,
                ranges,
                binding,
                limit,
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

    fn effects(&mut self) -> Result<EffectsByRow, GroundError> {
        let lifted = self.world.lifted;
        let mut by_row: EffectsByRow = vec![Vec::new(); lifted.schemas.len()];
        let (mut binding, mut condition) = (Vec::new(), Vec::new());
        for (index, rule) in lifted.rules.iter().enumerate() {
            let Head::Effect { action, effect } = rule.head else { continue };
            let schema = &lifted.schemas[action as usize];
            let (atom, holds) = match &schema.conditional[effect as usize] {
                Change::Add(atom) => (atom, true),
                Change::Delete(atom) => (atom, false),
                Change::Assign => continue,
            };
            // The first atom says that the action was reached, the second of a delete that it can matter.
            let skip = if holds { 1 } else { 2 };
            let width = rule.body.bound.len();
            for instance in 0..self.world.reached.counts[index] {
                let values = &self.world.reached.instances[index][instance * width..(instance + 1) * width];
                Self::bind(&rule.body, values, &mut binding);
                if !self.condition(index as u32, &rule.body, skip, &mut binding, &mut condition)? {
                    continue;
                }
                let Value::Open(mut effect) = self.world.literal(atom, true, &binding) else { continue };
                if !holds {
                    effect = effect.negated();
                }
                let applied = &self.world.reached.relations[schema.applied as usize];
                let Some(row) = applied.find(&values[..schema.params]) else { continue };
                let condition = self.ground.store(&condition);
                by_row[action as usize].push((row, GroundEffect { condition, effect }));
            }
        }
        for effects in &mut by_row {
            // Stable, so that effects keep the order of their rules.
            effects.sort_by_key(|&(row, _)| row);
        }
        Ok(by_row)
    }

    fn operators(&mut self, index: usize, action: u32, effects: &EffectsByRow) -> Result<(), GroundError> {
        let (lifted, reached) = (self.world.lifted, self.world.reached);
        let (rule, schema) = (&lifted.rules[index], &lifted.schemas[action as usize]);
        let width = rule.body.bound.len();
        let (mut binding, mut lits, mut plain) = (Vec::new(), Vec::new(), Vec::new());
        for instance in 0..reached.counts[index] {
            let values = &reached.instances[index][instance * width..(instance + 1) * width];
            Self::bind(&rule.body, values, &mut binding);
            if !self.condition(index as u32, &rule.body, 0, &mut binding, &mut lits)? {
                continue;
            }
            let Some(cost) = self.world.cost(schema, lifted.has_costs, &binding)? else { continue };
            let precondition = self.ground.store(&lits);
            plain.clear();
            for change in &schema.effects {
                let (atom, holds) = match change {
                    Change::Add(atom) => (atom, true),
                    Change::Delete(atom) => (atom, false),
                    Change::Assign => continue,
                };
                // Atoms that are never true need no delete.
                if let Value::Open(lit) = self.world.literal(atom, true, &binding) {
                    plain.push(if holds { lit } else { lit.negated() });
                }
            }
            let conditional =
                self.conditional_effects(schema.applied, values, &effects[action as usize], &mut plain);
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
                cost,
            });
        }
        Ok(())
    }

    /// Copies the effects of one reached action; those whose condition always holds join the plain ones.
    fn conditional_effects(
        &mut self,
        applied: u32,
        values: &[u32],
        effects: &[(u32, GroundEffect)],
        plain: &mut Vec<Lit>,
    ) -> Stretch {
        let start = self.ground.conditional.len() as u32;
        if !effects.is_empty() {
            let row = self.world.reached.relations[applied as usize].find(values).unwrap_or(UNBOUND);
            let first = effects.partition_point(|&(r, _)| r < row);
            for &(_, effect) in effects[first..].iter().take_while(|&&(r, _)| r == row) {
                if effect.condition.len == 0 {
                    plain.push(effect.effect);
                } else {
                    self.ground.conditional.push(effect);
                }
            }
        }
        Stretch { start, len: self.ground.conditional.len() as u32 - start }
    }

    fn axioms(&mut self, index: usize, head: &LiftedAtom) -> Result<(), GroundError> {
        let (lifted, reached) = (self.world.lifted, self.world.reached);
        let body = &lifted.rules[index].body;
        let width = body.bound.len();
        let (mut binding, mut lits) = (Vec::new(), Vec::new());
        for instance in 0..reached.counts[index] {
            let values = &reached.instances[index][instance * width..(instance + 1) * width];
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

    fn set_value(&mut self, function: u32, args: &[u32], value: f64) {
        let key: Vec<u32> = std::iter::once(function).chain(args.iter().copied()).collect();
        let hash = hash_words(&key);
        match self.value_table.find(hash, |id| self.value_keys[id as usize] == key) {
            Slot::Found(id) => self.values[id as usize] = value,
            Slot::Free(at) => {
                let id = self.values.len() as u32;
                self.value_keys.push(key);
                self.values.push(value);
                let keys = &self.value_keys;
                self.value_table.insert(at, hash, id, |id| hash_words(&keys[id as usize]));
            }
        }
    }

    /// The value of an expression of functions that never change; `None` where one has no value.
    fn evaluate(&self, expr: &Expr, binding: &[u32]) -> Result<Option<f64>, GroundError> {
        Ok(match expr {
            Expr::Number(value) => Some(*value),
            Expr::Value(of) => {
                let declared = &self.lifted.symbols.functions[of.predicate as usize];
                if declared.role != Role::Static {
                    return Err(GroundError::Unsupported(format!(
                        "the number `({})` changes and is read; the planner cannot search over numbers yet",
                        declared.name
                    )));
                }
                let key: Vec<u32> = std::iter::once(of.predicate)
                    .chain(of.args.iter().map(|&t| object(t, binding)))
                    .collect();
                match self.value_table.find(hash_words(&key), |id| self.value_keys[id as usize] == key) {
                    Slot::Found(id) => Some(self.values[id as usize]),
                    Slot::Free(_) => None,
                }
            }
            Expr::Operation(op, parts) => {
                let mut values = Vec::with_capacity(parts.len());
                for part in parts {
                    match self.evaluate(part, binding)? {
                        Some(value) => values.push(value),
                        None => return Ok(None),
                    }
                }
                calculate(*op, &values)
            }
        })
    }

    /// Whether a comparison of numbers that never change holds; `None` where one has no value.
    pub fn compare(
        &self,
        comparison: Comparison,
        left: &Expr,
        right: &Expr,
        binding: &[u32],
    ) -> Result<Option<bool>, GroundError> {
        let (Some(left), Some(right)) = (self.evaluate(left, binding)?, self.evaluate(right, binding)?)
        else {
            return Ok(None);
        };
        Ok(Some(match comparison {
            Comparison::Less => left < right,
            Comparison::LessEqual => left <= right,
            Comparison::Equal => left == right,
            Comparison::GreaterEqual => left >= right,
            Comparison::Greater => left > right,
        }))
    }

    /// An operator's cost; `None` where it has no value, so that the operator cannot be applied.
    fn cost(
        &self,
        schema: &crate::lifted::Schema,
        has_costs: bool,
        binding: &[u32],
    ) -> Result<Option<f64>, GroundError> {
        if !has_costs {
            return Ok(Some(1.0));
        }
        let mut sum = 0.0;
        for part in &schema.cost {
            match self.evaluate(part, binding)? {
                Some(value) if value < 0.0 => {
                    return Err(GroundError::Unsupported(format!(
                        "the action `{}` has a negative cost",
                        schema.name
                    )));
                }
                Some(value) => sum += value,
                None => return Ok(None),
            }
        }
        Ok(Some(sum))
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

/// Arithmetic; `None` for a division by zero.
pub(super) fn calculate(op: ArithmeticOp, values: &[f64]) -> Option<f64> {
    let (&first, rest) = values.split_first()?;
    if rest.is_empty() && op == ArithmeticOp::Subtract {
        return Some(-first);
    }
    rest.iter().try_fold(first, |sum, &value| match op {
        ArithmeticOp::Add => Some(sum + value),
        ArithmeticOp::Subtract => Some(sum - value),
        ArithmeticOp::Multiply => Some(sum * value),
        ArithmeticOp::Divide => (value != 0.0).then(|| sum / value),
    })
}
