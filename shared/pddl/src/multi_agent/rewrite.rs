//! Other names in the same tree.

use crate::ast::{Action, Atom, Condition, Effect, FunctionTerm, GroundAtom, NumericExpr, Term, TypedName};
use crate::name::Name;

/// Says what a predicate or function, and what a term becomes.
pub(super) trait Rewrite {
    /// A predicate.
    fn predicate(&self, name: &Name) -> Name {
        name.clone()
    }

    /// An object or constant.
    fn term(&self, term: &Term) -> Term {
        term.clone()
    }

    /// Variables bound by a quantifier.
    fn bound(&self, names: &[TypedName]) -> Vec<TypedName> {
        names.to_vec()
    }

    fn atom(&self, atom: &Atom) -> Atom {
        let args = atom.args.iter().map(|arg| self.term(arg)).collect();
        Atom { predicate: self.predicate(&atom.predicate), args }
    }

    fn ground(&self, atom: &GroundAtom) -> GroundAtom {
        let arg = |name: &Name| match self.term(&Term::Constant(name.clone())) {
            Term::Constant(name) | Term::Variable(name) => name,
        };
        GroundAtom { predicate: self.predicate(&atom.predicate), args: atom.args.iter().map(arg).collect() }
    }

    fn function(&self, term: &FunctionTerm) -> FunctionTerm {
        FunctionTerm {
            function: term.function.clone(),
            args: term.args.iter().map(|arg| self.term(arg)).collect(),
        }
    }

    fn number(&self, expression: &NumericExpr) -> NumericExpr {
        match expression {
            NumericExpr::Number(number) => NumericExpr::Number(number.clone()),
            NumericExpr::Function(term) => NumericExpr::Function(self.function(term)),
            NumericExpr::Operation(op, operands) => {
                NumericExpr::Operation(*op, operands.iter().map(|o| self.number(o)).collect())
            }
        }
    }

    fn condition(&self, condition: &Condition) -> Condition {
        let all = |parts: &[Condition]| parts.iter().map(|part| self.condition(part)).collect();
        let boxed = |inner: &Condition| Box::new(self.condition(inner));
        match condition {
            Condition::And(parts) => Condition::And(all(parts)),
            Condition::Or(parts) => Condition::Or(all(parts)),
            Condition::Not(inner) => Condition::Not(boxed(inner)),
            Condition::Imply(left, right) => Condition::Imply(boxed(left), boxed(right)),
            Condition::Exists(names, inner) => Condition::Exists(self.bound(names), boxed(inner)),
            Condition::Forall(names, inner) => Condition::Forall(self.bound(names), boxed(inner)),
            Condition::Atom(atom) => Condition::Atom(self.atom(atom)),
            Condition::Equal(left, right) => Condition::Equal(self.term(left), self.term(right)),
            Condition::Compare(by, left, right) => {
                Condition::Compare(*by, self.number(left), self.number(right))
            }
        }
    }

    fn effect(&self, effect: &Effect) -> Effect {
        match effect {
            Effect::And(parts) => Effect::And(parts.iter().map(|part| self.effect(part)).collect()),
            Effect::Forall(names, inner) => Effect::Forall(self.bound(names), Box::new(self.effect(inner))),
            Effect::When(condition, inner) => {
                Effect::When(self.condition(condition), Box::new(self.effect(inner)))
            }
            Effect::Add(atom) => Effect::Add(self.atom(atom)),
            Effect::Delete(atom) => Effect::Delete(self.atom(atom)),
            Effect::Assign(op, term, value) => Effect::Assign(*op, self.function(term), self.number(value)),
        }
    }

    /// Everything but the name and the parameters.
    fn body(&self, action: &Action) -> Action {
        Action {
            name: action.name.clone(),
            agent: None,
            params: action.params.clone(),
            precondition: self.condition(&action.precondition),
            effect: self.effect(&action.effect),
            duration: action.duration.as_ref().map(|duration| self.number(duration)),
        }
    }
}

/// Calls `see` with every atom of the action and the variables in whose scope it stands.
pub(super) fn atoms_of(action: &Action, see: &mut dyn FnMut(&Atom, &[TypedName])) {
    let mut scope = action.params.clone();
    in_condition(&action.precondition, &mut scope, see);
    in_effect(&action.effect, &mut scope, see);
}

fn in_condition(condition: &Condition, scope: &mut Vec<TypedName>, see: &mut dyn FnMut(&Atom, &[TypedName])) {
    match condition {
        Condition::And(parts) | Condition::Or(parts) => {
            parts.iter().for_each(|part| in_condition(part, scope, see));
        }
        Condition::Not(inner) => in_condition(inner, scope, see),
        Condition::Imply(left, right) => {
            in_condition(left, scope, see);
            in_condition(right, scope, see);
        }
        Condition::Exists(names, inner) | Condition::Forall(names, inner) => {
            let outer = scope.len();
            scope.extend(names.iter().cloned());
            in_condition(inner, scope, see);
            scope.truncate(outer);
        }
        Condition::Atom(atom) => see(atom, scope),
        Condition::Equal(..) | Condition::Compare(..) => {}
    }
}

fn in_effect(effect: &Effect, scope: &mut Vec<TypedName>, see: &mut dyn FnMut(&Atom, &[TypedName])) {
    match effect {
        Effect::And(parts) => parts.iter().for_each(|part| in_effect(part, scope, see)),
        Effect::Forall(names, inner) => {
            let outer = scope.len();
            scope.extend(names.iter().cloned());
            in_effect(inner, scope, see);
            scope.truncate(outer);
        }
        Effect::When(condition, inner) => {
            in_condition(condition, scope, see);
            in_effect(inner, scope, see);
        }
        Effect::Add(atom) | Effect::Delete(atom) => see(atom, scope),
        Effect::Assign(..) => {}
    }
}
