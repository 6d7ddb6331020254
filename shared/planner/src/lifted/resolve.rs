//! Conditions and numbers of the syntax tree, resolved: names become numbers, negation moves to the
//! literals, quantifiers to where their variables are used.

use lamma_pddl::Name;
use lamma_pddl::ast::{Atom, Comparison, Condition, FunctionTerm, NumericExpr, Term as AstTerm, TypedName};

use super::{Change, Expr, Formula, LiftedAtom, LiftedComparison, Symbols, Term, number};
use crate::ground::GroundError;
use crate::numeric::Relation;

/// Conditions nested deeper than this are refused; the recursion below is then safe. Text that the parser takes is
/// never nested so deep.
pub(super) const MAX_DEPTH: usize = 256;

/// The variables that are visible, and every slot ever given out.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scope {
    /// The range of each slot.
    pub ranges: Vec<u32>,
    /// The name of each slot.
    pub names: Vec<Name>,
    visible: Vec<(Name, u32)>,
}

impl Scope {
    /// Opens variables; returns their slots. Close them with [`Scope::close`].
    pub fn open(&mut self, symbols: &mut Symbols, variables: &[TypedName]) -> Vec<u32> {
        let mut slots = Vec::with_capacity(variables.len());
        for variable in variables {
            let slot = self.ranges.len() as u32;
            self.ranges.push(symbols.range(&variable.types));
            self.names.push(variable.name.clone());
            self.visible.push((variable.name.clone(), slot));
            slots.push(slot);
        }
        slots
    }

    /// Forgets the `count` variables opened last.
    pub fn close(&mut self, count: usize) {
        self.visible.truncate(self.visible.len() - count);
    }

    fn slot(&self, name: &Name) -> Result<u32, GroundError> {
        let found = self.visible.iter().rev().find(|(known, _)| known == name);
        found.map(|&(_, slot)| slot).ok_or_else(|| {
            GroundError::Malformed(format!(
                "the variable `?{name}` is not a parameter and not quantified here"
            ))
        })
    }
}

/// A term in `scope`.
pub(crate) fn term(symbols: &Symbols, scope: &Scope, term: &AstTerm) -> Result<Term, GroundError> {
    match term {
        AstTerm::Constant(name) => Ok(Term::Object(symbols.object(name)?)),
        AstTerm::Variable(name) => Ok(Term::Variable(scope.slot(name)?)),
    }
}

/// An atom in `scope`.
pub(crate) fn atom(symbols: &mut Symbols, scope: &Scope, atom: &Atom) -> Result<LiftedAtom, GroundError> {
    let predicate = symbols.predicate(&atom.predicate, atom.args.len())?;
    let args = atom.args.iter().map(|a| term(symbols, scope, a)).collect::<Result<_, _>>()?;
    Ok(LiftedAtom { predicate, args })
}

/// A function's value in `scope`.
pub(crate) fn function(
    symbols: &mut Symbols,
    scope: &Scope,
    of: &FunctionTerm,
) -> Result<LiftedAtom, GroundError> {
    let predicate = symbols.function(&of.function, of.args.len())?;
    let args = of.args.iter().map(|a| term(symbols, scope, a)).collect::<Result<_, _>>()?;
    Ok(LiftedAtom { predicate, args })
}

/// A numeric expression in `scope`.
pub(crate) fn expression(
    symbols: &mut Symbols,
    scope: &Scope,
    of: &NumericExpr,
    depth: usize,
) -> Result<Expr, GroundError> {
    check_depth(depth)?;
    Ok(match of {
        NumericExpr::Number(decimal) => Expr::Number(number(decimal)),
        NumericExpr::Function(term) => Expr::Value(function(symbols, scope, term)?),
        NumericExpr::Operation(op, parts) => Expr::Operation(
            *op,
            parts.iter().map(|p| expression(symbols, scope, p, depth + 1)).collect::<Result<_, _>>()?,
        ),
    })
}

fn check_depth(depth: usize) -> Result<(), GroundError> {
    if depth < MAX_DEPTH {
        return Ok(());
    }
    Err(GroundError::Malformed(format!("a condition or expression is nested deeper than {MAX_DEPTH} levels")))
}

/// `condition` (or its negation) in negation normal form.
pub(crate) fn formula(
    symbols: &mut Symbols,
    scope: &mut Scope,
    condition: &Condition,
    positive: bool,
    depth: usize,
) -> Result<Formula, GroundError> {
    check_depth(depth)?;
    Ok(match condition {
        Condition::And(parts) | Condition::Or(parts) => {
            let conjunction = matches!(condition, Condition::And(_)) == positive;
            let parts = parts
                .iter()
                .map(|part| formula(symbols, scope, part, positive, depth + 1))
                .collect::<Result<Vec<_>, _>>()?;
            if conjunction { and(parts) } else { or(parts) }
        }
        Condition::Not(inner) => formula(symbols, scope, inner, !positive, depth + 1)?,
        Condition::Imply(premise, conclusion) => {
            let premise = formula(symbols, scope, premise, !positive, depth + 1)?;
            let conclusion = formula(symbols, scope, conclusion, positive, depth + 1)?;
            let parts = vec![premise, conclusion];
            if positive { or(parts) } else { and(parts) }
        }
        Condition::Exists(variables, inner) | Condition::Forall(variables, inner) => {
            let existential = matches!(condition, Condition::Exists(..)) == positive;
            let slots = scope.open(symbols, variables);
            let inner = formula(symbols, scope, inner, positive, depth + 1);
            scope.close(variables.len());
            quantify(symbols, scope, slots, inner?, existential)
        }
        Condition::Atom(of) => Formula::Literal { atom: atom(symbols, scope, of)?, positive },
        Condition::Equal(left, right) => {
            let (left, right) = (term(symbols, scope, left)?, term(symbols, scope, right)?);
            match (left, right) {
                (Term::Object(a), Term::Object(b)) => constant((a == b) == positive),
                _ if left == right => constant(positive),
                _ => Formula::Equal { left, right, positive },
            }
        }
        Condition::Compare(of, left, right) => {
            let left = expression(symbols, scope, left, depth + 1)?;
            let right = expression(symbols, scope, right, depth + 1)?;
            comparison(*of, left, right, positive)
        }
    })
}

/// A comparison or its negation. A negated one, too, holds only where both sides have a value.
fn comparison(of: Comparison, left: Expr, right: Expr, positive: bool) -> Formula {
    let compare = |relation, left, right| Formula::Compare(LiftedComparison { relation, left, right });
    match (of, positive) {
        (Comparison::GreaterEqual, true) | (Comparison::Less, false) => {
            compare(Relation::AtLeast, left, right)
        }
        (Comparison::Greater, true) | (Comparison::LessEqual, false) => compare(Relation::Above, left, right),
        (Comparison::LessEqual, true) | (Comparison::Greater, false) => {
            compare(Relation::AtLeast, right, left)
        }
        (Comparison::Less, true) | (Comparison::GreaterEqual, false) => compare(Relation::Above, right, left),
        (Comparison::Equal, false) => compare(Relation::Differs, left, right),
        (Comparison::Equal, true) => and(vec![
            compare(Relation::AtLeast, left.clone(), right.clone()),
            compare(Relation::AtLeast, right, left),
        ]),
    }
}

fn constant(value: bool) -> Formula {
    if value { Formula::And(Vec::new()) } else { Formula::Or(Vec::new()) }
}

/// The conjunction, flat, with the constants gone.
pub(crate) fn and(parts: Vec<Formula>) -> Formula {
    let mut flat = Vec::with_capacity(parts.len());
    for part in parts {
        match part {
            Formula::And(inner) => flat.extend(inner),
            Formula::Or(inner) if inner.is_empty() => return Formula::Or(inner),
            other => flat.push(other),
        }
    }
    if flat.len() == 1 { flat.remove(0) } else { Formula::And(flat) }
}

/// The disjunction, flat, with the constants gone.
pub(crate) fn or(parts: Vec<Formula>) -> Formula {
    let mut flat = Vec::with_capacity(parts.len());
    for part in parts {
        match part {
            Formula::Or(inner) => flat.extend(inner),
            Formula::And(inner) if inner.is_empty() => return Formula::And(inner),
            other => flat.push(other),
        }
    }
    if flat.len() == 1 { flat.remove(0) } else { Formula::Or(flat) }
}

/// Quantifies over `slots`, each part only over the variables it shares with others (miniscoping): of
/// "some fridge holds two apples and a lettuce" the apples and the lettuce are then chosen apart.
fn quantify(symbols: &Symbols, scope: &Scope, slots: Vec<u32>, inner: Formula, existential: bool) -> Formula {
    // A variable without any object decides the condition.
    let range = |slot: u32| &symbols.ranges[scope.ranges[slot as usize] as usize];
    if slots.iter().any(|&slot| range(slot).members.is_empty()) {
        return constant(!existential);
    }
    match inner {
        // A quantifier distributes over its own connective ...
        Formula::Or(parts) if existential => {
            or(parts.into_iter().map(|p| quantify(symbols, scope, slots.clone(), p, true)).collect())
        }
        Formula::And(parts) if !existential => {
            and(parts.into_iter().map(|p| quantify(symbols, scope, slots.clone(), p, false)).collect())
        }
        // ... and splits the other by connected parts.
        Formula::And(parts) => and(quantify_parts(&slots, parts, true)),
        Formula::Or(parts) => or(quantify_parts(&slots, parts, false)),
        single => quantify_group(&slots, vec![single], existential),
    }
}

fn quantify_parts(slots: &[u32], parts: Vec<Formula>, existential: bool) -> Vec<Formula> {
    // Groups of parts that share quantified variables.
    let mut groups: Vec<(Vec<u32>, Vec<Formula>)> = Vec::new();
    for part in parts {
        let mut used = free_variables(&part);
        used.retain(|slot| slots.contains(slot));
        let mut merged = (used, vec![part]);
        let mut kept = Vec::new();
        for group in groups {
            if group.0.iter().any(|slot| merged.0.contains(slot)) {
                let (slots, mut members) = group;
                merged.0.extend(slots);
                members.append(&mut merged.1);
                merged.1 = members;
            } else {
                kept.push(group);
            }
        }
        kept.push(merged);
        groups = kept;
    }
    groups.into_iter().map(|(used, members)| quantify_group(&used, members, existential)).collect()
}

fn quantify_group(slots: &[u32], members: Vec<Formula>, existential: bool) -> Formula {
    let inner = if existential { and(members) } else { or(members) };
    let free = free_variables(&inner);
    let slots: Vec<u32> = free.into_iter().filter(|slot| slots.contains(slot)).collect();
    match inner {
        inner if slots.is_empty() => inner,
        Formula::Exists(mut more, inner) if existential => {
            more.extend(slots);
            Formula::Exists(more, inner)
        }
        Formula::Forall(mut more, inner) if !existential => {
            more.extend(slots);
            Formula::Forall(more, inner)
        }
        inner if existential => Formula::Exists(slots, Box::new(inner)),
        inner => Formula::Forall(slots, Box::new(inner)),
    }
}

/// The free variables of a formula, in order of slot.
pub(crate) fn free_variables(formula: &Formula) -> Vec<u32> {
    let (mut used, mut quantified) = (Vec::new(), Vec::new());
    collect_variables(formula, &mut used, &mut quantified);
    // Every quantifier has slots of its own, so none is free in one place and bound in another.
    used.retain(|slot| !quantified.contains(slot));
    used.sort_unstable();
    used.dedup();
    used
}

fn collect_variables(formula: &Formula, used: &mut Vec<u32>, quantified: &mut Vec<u32>) {
    let add = |term: &Term| {
        if let Term::Variable(slot) = term {
            used.push(*slot);
        }
    };
    match formula {
        Formula::Literal { atom, .. } => atom.args.iter().for_each(add),
        Formula::Equal { left, right, .. } => [left, right].into_iter().for_each(add),
        Formula::Compare(LiftedComparison { left, right, .. }) => {
            [left, right].into_iter().for_each(|e| expression_variables(e, used))
        }
        Formula::And(parts) | Formula::Or(parts) => {
            parts.iter().for_each(|part| collect_variables(part, used, quantified));
        }
        Formula::Exists(slots, inner) | Formula::Forall(slots, inner) => {
            quantified.extend(slots);
            collect_variables(inner, used, quantified);
        }
    }
}

/// The variables of what an effect does.
pub(super) fn change_variables(change: &Change) -> Vec<u32> {
    let mut used = Vec::new();
    let (Change::Add(of) | Change::Delete(of) | Change::Numeric(_, of, _)) = change;
    atom_variables(of, &mut used);
    if let Change::Numeric(_, _, value) = change {
        expression_variables(value, &mut used);
    }
    used
}

fn atom_variables(atom: &LiftedAtom, used: &mut Vec<u32>) {
    used.extend(atom.args.iter().filter_map(|arg| match arg {
        Term::Variable(slot) => Some(*slot),
        Term::Object(_) => None,
    }));
}

fn expression_variables(expression: &Expr, used: &mut Vec<u32>) {
    match expression {
        Expr::Number(_) => {}
        Expr::Value(of) => atom_variables(of, used),
        Expr::Operation(_, parts) => parts.iter().for_each(|part| expression_variables(part, used)),
    }
}
