//! What a tree that was read says wrong: names that mean nothing, wrong numbers and types of arguments,
//! declarations that contradict each other.
//!
//! An error leaves a text without a meaning; a warning is about what is understood all the same. A name that is
//! not declared is an error: its reader cannot know whether it is a misspelling.

mod axioms;
mod formula;
mod hierarchy;
mod requirements;

use std::collections::{BTreeMap, BTreeSet};

use crate::ast::{Domain, Init, Problem, Signature, TypedName};
use crate::codes;
use crate::diagnostic::{Diagnostic, Report};
use crate::name::{Name, Span};
use crate::source::Source;
use crate::suggest::did_you_mean;

use formula::{Scope, Use};
use hierarchy::{Fit, Hierarchy};
use requirements::Requirement;

/// What is wrong with a domain.
pub fn check_domain(domain: &Domain, source: &Source) -> Report {
    let mut checker = Checker::new(domain, &[], source);
    checker.types();
    checker.typed_names(&domain.constants, "constant");
    checker.signatures(&domain.predicates, "predicate");
    checker.signatures(&domain.functions, "function");
    checker.actions();
    checker.axioms();
    checker.requirements_declared();
    checker.report
}

/// What is wrong with a problem for this domain. `source` is the problem's text.
pub fn check_problem(domain: &Domain, problem: &Problem, source: &Source) -> Report {
    let mut checker = Checker::new(domain, &problem.objects, source);
    if problem.domain != domain.name {
        let message = format!("the problem is for the domain `{}`, not `{}`", problem.domain, domain.name);
        let found = Diagnostic::warning(codes::DOMAIN_MISMATCH, problem.domain.span(), message);
        checker
            .report
            .push(found.help(format!("if it is meant for this domain, write `(:domain {})`", domain.name)));
    }
    checker.typed_names(&problem.objects, "object");
    checker.constants_again(&problem.objects);
    checker.init(&problem.init);
    checker.condition(&problem.goal, &mut Scope::new());
    if let Some(metric) = &problem.metric {
        checker.metric(&metric.expression);
    }
    // The domain's types need the same and are reported with the domain.
    checker.used.remove(&Requirement::Typing);
    checker.requirements_used();
    checker.report
}

/// What the names of a domain (and of a problem's objects) mean, and what was found.
struct Checker<'d> {
    domain: &'d Domain,
    hierarchy: Hierarchy<'d>,
    predicates: BTreeMap<&'d Name, &'d Signature>,
    functions: BTreeMap<&'d Name, &'d Signature>,
    /// The types of each object and constant; of one that is both, those of both.
    objects: BTreeMap<&'d Name, Vec<&'d Name>>,
    derived: BTreeSet<&'d Name>,
    /// The first use of each part of the language that needs a requirement.
    used: BTreeMap<Requirement, Span>,
    /// Unknown names that were reported: once each is enough.
    reported: BTreeSet<(&'static str, Name)>,
    report: Report,
}

impl<'d> Checker<'d> {
    fn new(domain: &'d Domain, objects: &'d [TypedName], source: &Source) -> Self {
        let mut known: BTreeMap<&Name, Vec<&Name>> = BTreeMap::new();
        for object in domain.constants.iter().chain(objects) {
            known.entry(&object.name).or_default().extend(&object.types);
        }
        Checker {
            domain,
            hierarchy: Hierarchy::new(&domain.types),
            predicates: domain.predicates.iter().map(|s| (&s.name, s)).collect(),
            functions: domain.functions.iter().map(|s| (&s.name, s)).collect(),
            objects: known,
            derived: domain.axioms.iter().map(|axiom| &axiom.head.name).collect(),
            used: BTreeMap::new(),
            reported: BTreeSet::new(),
            report: Report::new(source),
        }
    }

    fn types(&mut self) {
        let mut first: BTreeMap<&Name, Span> = BTreeMap::new();
        for declared in &self.domain.types {
            if let Some(before) = first.insert(&declared.name, declared.name.span()) {
                self.duplicate("type", &declared.name, before, false);
            }
        }
        for supertype in self.domain.types.iter().flat_map(|declared| &declared.types) {
            if !first.contains_key(supertype)
                && supertype != "object"
                && self.first_report(codes::UNKNOWN_TYPE, supertype)
            {
                let message = format!("the type `{supertype}` is only declared as a supertype");
                let help = format!("add `{supertype} - object` to (:types ...)");
                self.report
                    .push(Diagnostic::warning(codes::UNKNOWN_TYPE, supertype.span(), message).help(help));
            }
        }
        for name in self.hierarchy.cycles() {
            let message = format!("the type `{name}` is a kind of itself");
            let help = "remove one of the supertypes on the way from it to itself";
            self.report.push(Diagnostic::error(codes::CYCLIC_TYPES, name.span(), message).help(help));
        }
    }

    /// Constants or objects.
    fn typed_names(&mut self, names: &'d [TypedName], kind: &str) {
        let mut first: BTreeMap<&Name, &TypedName> = BTreeMap::new();
        for declared in names {
            self.types_known(&declared.types);
            match first.get(&declared.name) {
                Some(before) => {
                    let contradicts = before.types != declared.types;
                    self.duplicate(kind, &declared.name, before.name.span(), contradicts);
                }
                None => drop(first.insert(&declared.name, declared)),
            }
        }
    }

    /// Objects that are constants of the domain as well, with other types.
    fn constants_again(&mut self, objects: &[TypedName]) {
        let constants: BTreeMap<&Name, &TypedName> =
            self.domain.constants.iter().map(|c| (&c.name, c)).collect();
        for object in objects {
            let constant = constants.get(&object.name);
            if let Some(constant) = constant.filter(|constant| constant.types != object.types) {
                let message = format!("`{}` is also a constant of the domain, of another type", object.name);
                let help = format!("it is of both types here; remove it, the domain has `{}`", constant.name);
                self.report
                    .push(Diagnostic::warning(codes::DUPLICATE, object.name.span(), message).help(help));
            }
        }
    }

    fn signatures(&mut self, signatures: &'d [Signature], kind: &str) {
        let mut first: BTreeMap<&Name, &Signature> = BTreeMap::new();
        for declared in signatures {
            for name in declared.params.iter().flat_map(|param| &param.types) {
                self.type_of_signature(name);
            }
            match first.get(&declared.name) {
                Some(before) => {
                    let contradicts = before.params.len() != declared.params.len();
                    self.duplicate(kind, &declared.name, before.name.span(), contradicts);
                }
                None => drop(first.insert(&declared.name, declared)),
            }
        }
    }

    fn actions(&mut self) {
        let mut first: BTreeMap<&Name, Span> = BTreeMap::new();
        for action in &self.domain.actions {
            if let Some(before) = first.insert(&action.name, action.name.span()) {
                self.duplicate("action", &action.name, before, true);
            }
            if let Some(agent) = &action.agent {
                self.used.entry(Requirement::MultiAgent).or_insert(agent.name.span());
            }
            let mut scope = self.parameters(&action.params);
            self.condition(&action.precondition, &mut scope);
            self.effect(&action.effect, &mut scope);
            if let Some(duration) = &action.duration {
                self.used.entry(Requirement::DurativeActions).or_insert(action.name.span());
                self.numeric(duration, &scope);
            }
        }
    }

    /// The scope of an action or axiom.
    fn parameters(&mut self, params: &'d [TypedName]) -> Scope<'d> {
        let mut scope = Scope::new();
        for param in params {
            self.types_known(&param.types);
            if let Some(before) = scope.iter().find(|before| before.name == param.name) {
                self.duplicate("parameter", &param.name, before.name.span(), true);
            }
            scope.push(param);
        }
        scope
    }

    fn init(&mut self, init: &[Init]) {
        let mut values = BTreeMap::new();
        for item in init {
            match item {
                Init::Fact(atom) => {
                    if self.derived.contains(&atom.predicate) {
                        self.derived_set(&atom.predicate);
                    }
                    self.ground_use(Use::Predicate, &atom.predicate, &atom.args);
                }
                Init::Value(function, value) => {
                    self.ground_use(Use::Function, &function.predicate, &function.args);
                    let before = values.insert(function, value);
                    if before.is_some_and(|before| before != value) {
                        let message = format!("{function} gets a second value");
                        let found = Diagnostic::error(codes::DUPLICATE, function.predicate.span(), message);
                        self.report.push(found.help("remove one of them"));
                    }
                }
            }
        }
    }

    fn derived_set(&mut self, predicate: &Name) {
        let message = format!("`{predicate}` is derived by a rule and cannot be set");
        let found = Diagnostic::error(codes::DERIVED_EFFECT, predicate.span(), message);
        self.report.push(found.help("set the facts it follows from"));
    }

    fn duplicate(&mut self, kind: &str, name: &Name, before: Span, is_error: bool) {
        let message = format!("the {kind} `{name}` is declared twice");
        let found = match is_error {
            true => Diagnostic::error(codes::DUPLICATE, name.span(), message),
            false => Diagnostic::warning(codes::DUPLICATE, name.span(), message),
        };
        self.report.push(found.also(before, "the first").help("remove or rename one of them"));
    }

    fn types_known(&mut self, types: &[Name]) {
        if let Some(first) = types.first() {
            self.used.entry(Requirement::Typing).or_insert(first.span());
        }
        for name in types {
            if !self.hierarchy.is_declared(name) && self.first_report(codes::UNKNOWN_TYPE, name) {
                let found =
                    Diagnostic::error(codes::UNKNOWN_TYPE, name.span(), format!("unknown type `{name}`"));
                let help = self.suggest(name, self.hierarchy.names(), "declare it in (:types ...)");
                self.report.push(found.help(help));
            }
        }
    }

    /// Types of a predicate's parameters only restrict; one that is not declared restricts nothing.
    fn type_of_signature(&mut self, name: &Name) {
        self.used.entry(Requirement::Typing).or_insert(name.span());
        if !self.hierarchy.is_declared(name) && self.first_report(codes::UNKNOWN_TYPE, name) {
            let found =
                Diagnostic::warning(codes::UNKNOWN_TYPE, name.span(), format!("unknown type `{name}`"));
            let help = self.suggest(name, self.hierarchy.names(), "declare it in (:types ...)");
            self.report.push(found.help(help));
        }
    }

    /// The nearest of the known names; nothing where nobody will read it, because it takes time.
    fn suggest<'n>(
        &self,
        wanted: &Name,
        known: impl IntoIterator<Item = &'n Name>,
        otherwise: impl Into<String>,
    ) -> String {
        if self.report.is_full() { String::new() } else { did_you_mean(wanted.as_str(), known, otherwise) }
    }

    /// Whether this is the first time, so that it shall be reported.
    fn first_report(&mut self, code: &'static str, name: &Name) -> bool {
        self.reported.insert((code, name.clone()))
    }

    /// Whether an argument of the types `found` may stand where `allowed` is declared.
    fn fit(&self, found: &[&Name], allowed: &[Name], is_object: bool) -> Fit {
        self.hierarchy.fit(found, allowed, is_object)
    }
}
