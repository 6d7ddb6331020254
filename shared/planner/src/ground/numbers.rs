//! Numbers on ground level: which there are, how they compare, and how operators change them.

use std::collections::HashMap;

use lamma_pddl::ast::AssignOp;

use super::instantiate::{Value, World, object};
use super::propositional::{Ground, Lit, Stretch};
use crate::id_table::{IdTable, Slot, hash_words};
use crate::lifted::{Expr, Lifted, LiftedAtom, LiftedComparison, Role, Schema, compared, sign};
use crate::numeric::{Comparison, Expression};

/// The numbers that the problem gives at first.
#[derive(Default)]
pub(super) struct InitialValues {
    /// Rows of function and arguments.
    keys: Vec<Vec<u32>>,
    values: Vec<f64>,
    table: IdTable,
}

impl InitialValues {
    pub fn new(lifted: &Lifted) -> Self {
        let mut known = InitialValues::default();
        for (function, args, value) in &lifted.values {
            known.set(*function, args, *value);
        }
        for (id, function) in lifted.symbols.functions.iter().enumerate() {
            // Where nothing is said, costs start at zero.
            if function.name == "total-cost" && function.arity == 0 && known.get(&[id as u32]).is_none() {
                known.set(id as u32, &[], 0.0);
            }
        }
        known
    }

    fn set(&mut self, function: u32, args: &[u32], value: f64) {
        let key: Vec<u32> = std::iter::once(function).chain(args.iter().copied()).collect();
        let hash = hash_words(&key);
        match self.table.find(hash, |id| self.keys[id as usize] == key) {
            Slot::Found(id) => self.values[id as usize] = value,
            Slot::Free(at) => {
                let id = self.values.len() as u32;
                self.keys.push(key);
                self.values.push(value);
                let keys = &self.keys;
                self.table.insert(at, hash, id, |id| hash_words(&keys[id as usize]));
            }
        }
    }

    fn get(&self, key: &[u32]) -> Option<f64> {
        match self.table.find(hash_words(key), |id| self.keys[id as usize] == key) {
            Slot::Found(id) => Some(self.values[id as usize]),
            Slot::Free(_) => None,
        }
    }
}

/// Changes a number where its condition held before.
#[derive(Clone, Debug)]
pub(crate) struct GroundNumericEffect {
    pub condition: Stretch,
    pub op: AssignOp,
    pub target: u32,
    pub value: Expression,
}

/// The numbers that change, and what is asked of them.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    /// The text of each number: `(fuel truck1)`.
    pub names: Vec<String>,
    /// Their values at first; NaN: none.
    pub initial: Vec<f64>,
    ids: HashMap<Vec<u32>, u32>,
    /// Each with the atom that stands for it, and its text.
    pub comparisons: Vec<(u32, Comparison, String)>,
    /// The atom of each comparison, by its text.
    atoms: HashMap<String, u32>,
    /// Grouped by operator.
    pub effects: Vec<GroundNumericEffect>,
    /// What to say of numbers without values, noted before anything is simplified away.
    pub missing: Option<String>,
}

impl Numbers {
    /// The number of a function's value under these arguments.
    fn number(&mut self, world: &World<'_>, key: Vec<u32>) -> u32 {
        if let Some(&id) = self.ids.get(&key) {
            return id;
        }
        let id = self.initial.len() as u32;
        self.initial.push(world.initial.get(&key).unwrap_or(f64::NAN));
        let symbols = &world.lifted.symbols;
        let mut name = String::from("(");
        name.push_str(symbols.functions[key[0] as usize].name.as_str());
        for &arg in &key[1..] {
            name.push(' ');
            name.push_str(symbols.objects[arg as usize].as_str());
        }
        name.push(')');
        self.names.push(name);
        self.ids.insert(key, id);
        id
    }

    /// What to say of numbers that are asked for, that an action would change, and that never get a value.
    pub fn warning(&self) -> Option<String> {
        let mut missing = vec![false; self.initial.len()];
        for effect in self.effects.iter().filter(|effect| effect.op != AssignOp::Assign) {
            missing[effect.target as usize] = self.initial[effect.target as usize].is_nan();
        }
        for effect in self.effects.iter().filter(|effect| effect.op == AssignOp::Assign) {
            missing[effect.target as usize] = false;
        }
        let mut names: Vec<&str> = Vec::new();
        for (_, comparison, _) in &self.comparisons {
            comparison.for_each_variable(&mut |number| {
                if std::mem::replace(&mut missing[number as usize], false) {
                    names.push(&self.names[number as usize]);
                }
            });
        }
        let (first, more) = (names.first()?, names.len() - 1);
        let others = if more > 0 { format!(" (and {more} more)") } else { String::new() };
        Some(format!(
            "{first}{others} is asked for and has no value in `:init`: comparisons with it do not hold, and actions \
             that increase or decrease it do not apply"
        ))
    }

    fn text(&self, of: &Expression) -> String {
        match of {
            Expression::Constant(value) => value.to_string(),
            Expression::Variable(variable) => self.names[*variable as usize].clone(),
            Expression::Operation(op, parts) => {
                let parts: String = parts.iter().map(|part| format!(" {}", self.text(part))).collect();
                format!("({}{parts})", sign(*op))
            }
        }
    }

    /// Whether an effect has a result wherever its numbers have the values they start with.
    pub fn is_safe(&self, effect: &GroundNumericEffect) -> bool {
        let mut defined = !effect.value.divides() && effect.op != AssignOp::ScaleDown;
        let mut check = |variable: u32| defined &= !self.initial[variable as usize].is_nan();
        effect.value.for_each_variable(&mut check);
        if effect.op != AssignOp::Assign {
            check(effect.target);
        }
        defined && !effect.value.constant().is_some_and(f64::is_nan)
    }
}

impl World<'_> {
    /// The expression under a binding; not a number where a function in it never has a value.
    fn expression(&self, of: &Expr, binding: &[u32], numbers: &mut Numbers) -> Expression {
        match of {
            Expr::Number(value) => Expression::Constant(*value),
            Expr::Value(of) => {
                let key = key(of, binding);
                if self.lifted.symbols.functions[of.predicate as usize].role == Role::Static {
                    return Expression::Constant(self.initial.get(&key).unwrap_or(f64::NAN));
                }
                Expression::Variable(numbers.number(self, key))
            }
            Expr::Operation(op, parts) => {
                let parts = parts.iter().map(|part| self.expression(part, binding, numbers)).collect();
                Expression::operation(*op, parts)
            }
        }
    }

    /// What a comparison comes to.
    pub fn compare(&self, of: &LiftedComparison, binding: &[u32], ground: &mut Ground) -> Value {
        let left = self.expression(&of.left, binding, &mut ground.numbers);
        let right = self.expression(&of.right, binding, &mut ground.numbers);
        if let (Some(left), Some(right)) = (left.constant(), right.constant()) {
            return Value::Constant(of.relation.holds(left, right));
        }
        let text = compared(of.relation, &ground.numbers.text(&left), &ground.numbers.text(&right));
        if let Some(&atom) = ground.numbers.atoms.get(&text) {
            return Value::Open(Lit::new(atom, true));
        }
        let atom = ground.new_derived();
        ground.approximate = true;
        ground.numbers.atoms.insert(text.clone(), atom);
        ground.numbers.comparisons.push((atom, Comparison { relation: of.relation, left, right }, text));
        Value::Open(Lit::new(atom, true))
    }

    /// A change of a number under a condition.
    pub fn change(
        &self,
        (op, target, value): (AssignOp, &LiftedAtom, &Expr),
        condition: Stretch,
        binding: &[u32],
        numbers: &mut Numbers,
    ) -> GroundNumericEffect {
        let value = self.expression(value, binding, numbers);
        GroundNumericEffect { condition, op, target: numbers.number(self, key(target, binding)), value }
    }

    /// An operator's cost; `None` where it has no value, so that the operator cannot be applied.
    pub fn cost(&self, schema: &Schema, binding: &[u32], numbers: &mut Numbers) -> Option<f64> {
        if !self.lifted.has_costs {
            return Some(1.0);
        }
        let values = schema.cost.iter().map(|part| self.expression(part, binding, numbers).constant());
        let sum: f64 = values.map(|value| value.unwrap_or(f64::NAN)).sum();
        // No search here looks for gains on the way: an action that pays is taken as free.
        (!sum.is_nan()).then_some(sum.max(0.0))
    }
}

fn key(of: &LiftedAtom, binding: &[u32]) -> Vec<u32> {
    std::iter::once(of.predicate).chain(of.args.iter().map(|&term| object(term, binding))).collect()
}
