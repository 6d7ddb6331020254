//! That every name means something, so that nothing after this can fail for a name.

use std::collections::BTreeMap;

use lamma_pddl::Name;
use lamma_pddl::ast::{Condition, Domain, Effect, GroundAtom, NumericExpr, Term, TypedName};

use super::Interpreter;
use super::error::InterpretError;

type Scope = Vec<Name>;

impl Interpreter {
    pub(super) fn check_domain(&self, domain: &Domain) -> Result<(), InterpretError> {
        for action in &domain.actions {
            let mut scope = Vec::new();
            self.bind(&action.params, &mut scope)?;
            self.check_condition(&action.precondition, &mut scope)?;
            self.check_effect(&action.effect, &mut scope)?;
            action.duration.iter().try_for_each(|duration| self.check_expression(duration, &scope))?;
        }
        for axiom in &domain.axioms {
            let mut scope = Vec::new();
            self.bind(&axiom.head.params, &mut scope)?;
            check_arity(&self.predicates, "predicate", &axiom.head.name, axiom.head.params.len())?;
            self.check_condition(&axiom.body, &mut scope)?;
        }
        Ok(())
    }

    fn bind(&self, params: &[TypedName], scope: &mut Scope) -> Result<(), InterpretError> {
        for name in params.iter().flat_map(|param| &param.types) {
            if !self.types.contains_key(name) {
                return Err(InterpretError::UnknownType { name: name.clone() });
            }
        }
        scope.extend(params.iter().map(|param| param.name.clone()));
        Ok(())
    }

    pub(super) fn check_condition(
        &self,
        condition: &Condition,
        scope: &mut Scope,
    ) -> Result<(), InterpretError> {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => {
                parts.iter().try_for_each(|part| self.check_condition(part, scope))
            }
            Condition::Not(inner) => self.check_condition(inner, scope),
            Condition::Imply(if_, then) => {
                self.check_condition(if_, scope)?;
                self.check_condition(then, scope)
            }
            Condition::Exists(params, body) | Condition::Forall(params, body) => {
                let outside = scope.len();
                self.bind(params, scope)?;
                self.check_condition(body, scope)?;
                scope.truncate(outside);
                Ok(())
            }
            Condition::Atom(atom) => {
                self.check_use(&self.predicates, "predicate", &atom.predicate, &atom.args, scope)
            }
            Condition::Equal(left, right) => {
                self.check_term(left, scope)?;
                self.check_term(right, scope)
            }
            Condition::Compare(_, left, right) => {
                self.check_expression(left, scope)?;
                self.check_expression(right, scope)
            }
        }
    }

    fn check_effect(&self, effect: &Effect, scope: &mut Scope) -> Result<(), InterpretError> {
        match effect {
            Effect::And(parts) => parts.iter().try_for_each(|part| self.check_effect(part, scope)),
            Effect::Forall(params, body) => {
                let outside = scope.len();
                self.bind(params, scope)?;
                self.check_effect(body, scope)?;
                scope.truncate(outside);
                Ok(())
            }
            Effect::When(condition, body) => {
                self.check_condition(condition, scope)?;
                self.check_effect(body, scope)
            }
            Effect::Add(atom) | Effect::Delete(atom) => {
                if self.axioms.derives(&atom.predicate) {
                    return Err(InterpretError::DerivedEffect { predicate: atom.predicate.clone() });
                }
                self.check_use(&self.predicates, "predicate", &atom.predicate, &atom.args, scope)
            }
            Effect::Assign(_, function, value) => {
                self.check_use(&self.functions, "function", &function.function, &function.args, scope)?;
                self.check_expression(value, scope)
            }
        }
    }

    pub(super) fn check_expression(
        &self,
        expression: &NumericExpr,
        scope: &Scope,
    ) -> Result<(), InterpretError> {
        match expression {
            NumericExpr::Number(_) => Ok(()),
            NumericExpr::Function(function) => {
                self.check_use(&self.functions, "function", &function.function, &function.args, scope)
            }
            NumericExpr::Operation(_, operands) => {
                operands.iter().try_for_each(|operand| self.check_expression(operand, scope))
            }
        }
    }

    fn check_use(
        &self,
        declared: &BTreeMap<Name, usize>,
        kind: &'static str,
        name: &Name,
        args: &[Term],
        scope: &Scope,
    ) -> Result<(), InterpretError> {
        check_arity(declared, kind, name, args.len())?;
        args.iter().try_for_each(|term| self.check_term(term, scope))
    }

    fn check_term(&self, term: &Term, scope: &Scope) -> Result<(), InterpretError> {
        match term {
            Term::Constant(name) if !self.objects.contains_key(name) => {
                Err(InterpretError::UnknownObject { name: name.clone() })
            }
            Term::Variable(name) if !scope.contains(name) => {
                Err(InterpretError::UnknownVariable { name: name.clone() })
            }
            _ => Ok(()),
        }
    }

    pub(super) fn check_ground(
        &self,
        declared: &BTreeMap<Name, usize>,
        kind: &'static str,
        atom: &GroundAtom,
    ) -> Result<(), InterpretError> {
        check_arity(declared, kind, &atom.predicate, atom.args.len())?;
        match atom.args.iter().find(|arg| !self.objects.contains_key(*arg)) {
            Some(unknown) => Err(InterpretError::UnknownObject { name: unknown.clone() }),
            None => Ok(()),
        }
    }
}

fn check_arity(
    declared: &BTreeMap<Name, usize>,
    kind: &'static str,
    name: &Name,
    found: usize,
) -> Result<(), InterpretError> {
    match declared.get(name) {
        None => Err(InterpretError::UnknownSymbol { kind, name: name.clone() }),
        Some(&expected) if expected != found => {
            Err(InterpretError::WrongArity { kind, name: name.clone(), expected, found })
        }
        Some(_) => Ok(()),
    }
}
