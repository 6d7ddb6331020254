//! Conditions, effects and numbers: every name in them.

use super::requirements::Requirement;
use super::{Checker, Fit};
use crate::ast::{AssignOp, Condition, Effect, NumericExpr, Signature, Term, TypedName};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::{Name, Span};

/// The variables that mean something, the innermost last.
pub(super) type Scope<'d> = Vec<&'d TypedName>;

/// What a name before arguments is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    Predicate,
    Function,
}

/// An argument with its types.
struct Argument<'a> {
    name: &'a Name,
    types: Vec<&'a Name>,
    is_object: bool,
}

impl<'d> Checker<'d> {
    fn uses(&mut self, requirement: Requirement, at: Span) {
        self.used.entry(requirement).or_insert(at);
    }

    pub(super) fn condition<'c: 'd>(&mut self, condition: &'c Condition, scope: &mut Scope<'d>) {
        match condition {
            Condition::And(parts) => parts.iter().for_each(|part| self.condition(part, scope)),
            Condition::Or(parts) => {
                self.uses(Requirement::Disjunction, place(condition));
                parts.iter().for_each(|part| self.condition(part, scope));
            }
            Condition::Not(inner) => {
                let requirement = match **inner {
                    Condition::Atom(_) => Requirement::Negation,
                    Condition::Equal(..) => Requirement::Equality,
                    _ => Requirement::Disjunction,
                };
                self.uses(requirement, place(condition));
                self.condition(inner, scope);
            }
            Condition::Imply(if_, then) => {
                self.uses(Requirement::Disjunction, place(condition));
                self.condition(if_, scope);
                self.condition(then, scope);
            }
            Condition::Exists(params, body) => {
                self.uses(Requirement::Existential, place(condition));
                self.bind(params, scope, |checker, scope| checker.condition(body, scope));
            }
            Condition::Forall(params, body) => {
                self.uses(Requirement::Universal, place(condition));
                self.bind(params, scope, |checker, scope| checker.condition(body, scope));
            }
            Condition::Atom(atom) => self.symbol(Use::Predicate, &atom.predicate, &atom.args, scope),
            Condition::Equal(left, right) => {
                self.uses(Requirement::Equality, place(condition));
                self.argument(left, scope);
                self.argument(right, scope);
            }
            Condition::Compare(_, left, right) => {
                self.uses(Requirement::Numbers, place(condition));
                self.numeric(left, scope);
                self.numeric(right, scope);
            }
        }
    }

    pub(super) fn effect<'c: 'd>(&mut self, effect: &'c Effect, scope: &mut Scope<'d>) {
        match effect {
            Effect::And(parts) => parts.iter().for_each(|part| self.effect(part, scope)),
            Effect::Forall(params, body) => {
                let at = params.first().map_or(Span::NONE, |param| param.name.span());
                self.uses(Requirement::ConditionalEffects, at);
                self.bind(params, scope, |checker, scope| checker.effect(body, scope));
            }
            Effect::When(condition, body) => {
                self.uses(Requirement::ConditionalEffects, place(condition));
                self.condition(condition, scope);
                self.effect(body, scope);
            }
            Effect::Add(atom) | Effect::Delete(atom) => {
                if self.derived.contains(&atom.predicate) {
                    self.derived_set(&atom.predicate);
                }
                self.symbol(Use::Predicate, &atom.predicate, &atom.args, scope);
            }
            Effect::Assign(op, function, value) => {
                let is_cost = *op == AssignOp::Increase && function.function == "total-cost";
                let requirement = if is_cost { Requirement::ActionCosts } else { Requirement::Numbers };
                self.uses(requirement, function.function.span());
                self.symbol(Use::Function, &function.function, &function.args, scope);
                self.numeric(value, scope);
            }
        }
    }

    /// A quantifier's variables for the length of its body.
    fn bind(
        &mut self,
        params: &'d [TypedName],
        scope: &mut Scope<'d>,
        body: impl FnOnce(&mut Self, &mut Scope<'d>),
    ) {
        let outside = scope.len();
        for param in params {
            self.types_known(&param.types);
            let before = scope.iter().position(|before| before.name == param.name);
            match before.and_then(|at| scope.get(at).map(|before| (at, before.name.span()))) {
                Some((at, span)) if at >= outside => self.duplicate("variable", &param.name, span, true),
                Some((_, span)) => {
                    let message = format!("`?{}` already means something here", param.name);
                    let found = Diagnostic::warning(codes::SHADOWED, param.name.span(), message);
                    self.report.push(found.also(span, "the outer one").help("give one of them another name"));
                }
                None => {}
            }
            scope.push(param);
        }
        body(self, scope);
        scope.truncate(outside);
    }

    pub(super) fn numeric(&mut self, expression: &NumericExpr, scope: &Scope<'d>) {
        match expression {
            NumericExpr::Number(_) => {}
            NumericExpr::Function(function) => {
                self.symbol(Use::Function, &function.function, &function.args, scope);
            }
            NumericExpr::Operation(_, operands) => operands.iter().for_each(|o| self.numeric(o, scope)),
        }
    }

    /// A metric may name the length of the plan without a declaration.
    pub(super) fn metric(&mut self, expression: &NumericExpr) {
        match expression {
            NumericExpr::Function(function) if function.function == "total-time" => {}
            NumericExpr::Operation(_, operands) => operands.iter().for_each(|o| self.metric(o)),
            _ => self.numeric(expression, &Scope::new()),
        }
    }

    /// A predicate or function before terms.
    fn symbol(&mut self, kind: Use, name: &Name, args: &[Term], scope: &Scope<'d>) {
        let signature = self.signature(kind, name);
        let types: Vec<Option<Argument<'_>>> = args.iter().map(|term| self.argument(term, scope)).collect();
        if let Some(signature) = signature {
            self.fits(kind, name, signature, types);
        }
    }

    /// A predicate or function before objects.
    pub(super) fn ground_use(&mut self, kind: Use, name: &Name, args: &[Name]) {
        let signature = self.signature(kind, name);
        let types: Vec<Option<Argument<'_>>> = args.iter().map(|arg| self.object(arg)).collect();
        if let Some(signature) = signature {
            self.fits(kind, name, signature, types);
        }
    }

    fn signature(&mut self, kind: Use, name: &Name) -> Option<&'d Signature> {
        let (declared, what, code, section) = match kind {
            Use::Predicate => (&self.predicates, "predicate", codes::UNKNOWN_PREDICATE, ":predicates"),
            Use::Function => (&self.functions, "function", codes::UNKNOWN_FUNCTION, ":functions"),
        };
        let found = declared.get(name).copied();
        if found.is_none() {
            let other = if kind == Use::Predicate { &self.functions } else { &self.predicates };
            let help = match other.contains_key(name) {
                true if kind == Use::Predicate => {
                    format!("`{name}` is a function: compare it, `(> ({name} ...) 0)`")
                }
                true => format!("`{name}` is a predicate, which has no value"),
                false => {
                    let otherwise = format!("declare it in the domain's ({section} ...)");
                    self.suggest(name, declared.keys().copied(), otherwise)
                }
            };
            if self.first_report(code, name) {
                let message = format!("unknown {what} `{name}`");
                self.report.push(Diagnostic::error(code, name.span(), message).help(help));
            }
        }
        found
    }

    /// The types of a term; `None` if it means nothing, which is then reported.
    fn argument<'a>(&mut self, term: &'a Term, scope: &Scope<'d>) -> Option<Argument<'a>>
    where
        'd: 'a,
    {
        match term {
            Term::Constant(name) => self.object(name),
            Term::Variable(name) => {
                let declared = scope.iter().rev().find(|declared| declared.name == *name);
                if declared.is_none() {
                    let known: Vec<&Name> = scope.iter().map(|declared| &declared.name).collect();
                    let otherwise = "add it to :parameters, or bind it by forall or exists";
                    let help = self.suggest(name, known, otherwise);
                    let message = format!("unknown variable `?{name}`");
                    self.report
                        .push(Diagnostic::error(codes::UNKNOWN_VARIABLE, name.span(), message).help(help));
                }
                declared.map(|d| Argument { name, types: d.types.iter().collect(), is_object: false })
            }
        }
    }

    fn object<'a>(&mut self, name: &'a Name) -> Option<Argument<'a>>
    where
        'd: 'a,
    {
        let types = self.objects.get(name).cloned();
        if types.is_none() && self.first_report(codes::UNKNOWN_OBJECT, name) {
            let otherwise = "declare it in the problem's (:objects ...) or the domain's (:constants ...); \
                             a variable has a `?` before it";
            let help = self.suggest(name, self.objects.keys().copied(), otherwise);
            let message = format!("unknown object `{name}`");
            self.report.push(Diagnostic::error(codes::UNKNOWN_OBJECT, name.span(), message).help(help));
        }
        types.map(|types| Argument { name, types, is_object: true })
    }

    fn fits(&mut self, kind: Use, name: &Name, signature: &Signature, args: Vec<Option<Argument<'_>>>) {
        let expected = signature.params.len();
        if args.len() != expected {
            let what = if kind == Use::Predicate { "predicate" } else { "function" };
            let message = format!("the {what} `{name}` takes {expected} arguments, not {}", args.len());
            let found = Diagnostic::error(codes::WRONG_ARITY, name.span(), message);
            self.report.push(found.help(format!("it is declared as {signature}")));
            return;
        }
        for (argument, param) in args.iter().zip(&signature.params) {
            let Some(argument) = argument else { continue };
            let fit = self.fit(&argument.types, &param.types, argument.is_object);
            if fit != Fit::All {
                self.wrong_type(argument, param, signature, fit);
            }
        }
    }

    fn wrong_type(&mut self, argument: &Argument<'_>, param: &TypedName, signature: &Signature, fit: Fit) {
        let list = |types: Vec<&Name>| match types.is_empty() {
            true => "object".to_owned(),
            false => types.iter().map(|name| name.as_str()).collect::<Vec<_>>().join(" or "),
        };
        let (mark, found_types) = (if argument.is_object { "" } else { "?" }, list(argument.types.clone()));
        let (name, wanted) = (argument.name, list(param.types.iter().collect()));
        let at = name.span();
        let found = match fit {
            Fit::Some => {
                let message = format!("`{mark}{name}` may be any {found_types}; only {wanted} fits here");
                Diagnostic::warning(codes::WRONG_TYPE, at, message)
            }
            _ => {
                let message = format!("`{mark}{name}` is a {found_types}, not a {wanted}");
                Diagnostic::error(codes::WRONG_TYPE, at, message)
            }
        };
        self.report.push(found.help(format!("the declaration is {signature}")));
    }
}

/// The first place in a condition that has one.
fn place(condition: &Condition) -> Span {
    let term = |term: &Term| match term {
        Term::Constant(name) | Term::Variable(name) => name.span(),
    };
    match condition {
        Condition::And(parts) | Condition::Or(parts) => parts.first().map_or(Span::NONE, place),
        Condition::Not(inner) | Condition::Imply(inner, _) => place(inner),
        Condition::Exists(params, body) | Condition::Forall(params, body) => {
            params.first().map_or_else(|| place(body), |param| param.name.span())
        }
        Condition::Atom(atom) => atom.predicate.span(),
        Condition::Equal(left, _) => term(left),
        Condition::Compare(_, left, right) => number(left).or_else(|| number(right)).unwrap_or_default(),
    }
}

fn number(expression: &NumericExpr) -> Option<Span> {
    match expression {
        NumericExpr::Number(_) => None,
        NumericExpr::Function(function) => Some(function.function.span()),
        NumericExpr::Operation(_, operands) => operands.iter().find_map(number),
    }
}
