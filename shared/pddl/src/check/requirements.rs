//! `(:requirements …)`: what is declared and what is used.

use super::Checker;
use crate::ast::Private;
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::{Name, Span};
use crate::suggest::did_you_mean;

/// A part of the language that must be declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Requirement {
    Typing,
    Negation,
    Disjunction,
    Equality,
    Existential,
    Universal,
    ConditionalEffects,
    ActionCosts,
    Numbers,
    DerivedPredicates,
    DurativeActions,
    MultiAgent,
    Privacy,
}

impl Requirement {
    /// What of it is used, and the requirements that declare it, the usual one first.
    fn declared_by(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Requirement::Typing => ("types", &[":typing", ":adl", ":ucpop"]),
            Requirement::Negation => ("negated conditions", &[":negative-preconditions", ":adl", ":ucpop"]),
            Requirement::Disjunction => ("disjunctions", &[":disjunctive-preconditions", ":adl", ":ucpop"]),
            Requirement::Equality => ("equality", &[":equality", ":adl", ":ucpop"]),
            Requirement::Existential => {
                ("`exists`", &[":existential-preconditions", ":quantified-preconditions", ":adl", ":ucpop"])
            }
            Requirement::Universal => (
                "`forall` in conditions",
                &[":universal-preconditions", ":quantified-preconditions", ":adl", ":ucpop"],
            ),
            Requirement::ConditionalEffects => {
                ("`when` or `forall` in effects", &[":conditional-effects", ":adl", ":ucpop"])
            }
            Requirement::ActionCosts => ("action costs", &[":action-costs", ":numeric-fluents", ":fluents"]),
            Requirement::Numbers => ("numbers", &[":numeric-fluents", ":fluents"]),
            Requirement::DerivedPredicates => {
                ("derived predicates", &[":derived-predicates", ":domain-axioms", ":axioms"])
            }
            Requirement::DurativeActions => ("durative actions", &[":durative-actions"]),
            Requirement::MultiAgent => ("`:agent`", &[":multi-agent"]),
            Requirement::Privacy => ("`(:private ...)`", &[":unfactored-privacy", ":factored-privacy"]),
        }
    }
}

/// Those that declare nothing in `Requirement::declared_by`.
const OTHERS: &[&str] = &[
    ":strips",
    ":constraints",
    ":preferences",
    ":timed-initial-literals",
    ":duration-inequalities",
    ":continuous-effects",
    ":object-fluents",
    ":time",
    ":goal-utilities",
    ":foreach-expansions",
    ":dag-expansions",
    ":safety-constraints",
    ":open-world",
    ":true-negation",
    ":expression-evaluation",
    ":non-deterministic",
    ":probabilistic-effects",
];

const ALL: [Requirement; 13] = [
    Requirement::Typing,
    Requirement::Negation,
    Requirement::Disjunction,
    Requirement::Equality,
    Requirement::Existential,
    Requirement::Universal,
    Requirement::ConditionalEffects,
    Requirement::ActionCosts,
    Requirement::Numbers,
    Requirement::DerivedPredicates,
    Requirement::DurativeActions,
    Requirement::MultiAgent,
    Requirement::Privacy,
];

impl Checker<'_> {
    /// Of a domain: what it declares, and what it uses without declaring.
    pub(super) fn requirements_declared(&mut self) {
        let known: Vec<Name> =
            ALL.iter().flat_map(|r| r.declared_by().1).chain(OTHERS).map(Name::new).collect();
        for declared in self.domain.requirements.iter().filter(|declared| !known.contains(declared)) {
            let message = format!("unknown requirement `{declared}`");
            let found = Diagnostic::warning(codes::UNKNOWN_REQUIREMENT, declared.span(), message);
            self.report.push(found.help(did_you_mean(declared.as_str(), &known, "remove it")));
        }
        if let Some(first) = self.domain.types.first() {
            self.used.entry(Requirement::Typing).or_insert(first.name.span());
        }
        if let Some(first) = self.domain.axioms.first() {
            self.used.entry(Requirement::DerivedPredicates).or_insert(first.head.name.span());
        }
        if let Some(span) = self.first_private() {
            self.used.entry(Requirement::Privacy).or_insert(span);
        }
        self.requirements_used();
    }

    fn first_private(&self) -> Option<Span> {
        let signatures = self.domain.predicates.iter().chain(&self.domain.functions);
        let signatures = signatures.map(|s| (&s.name, &s.private_to));
        let all = signatures.chain(self.domain.constants.iter().map(|c| (&c.name, &c.private_to)));
        all.into_iter()
            .find(|(_, private): &(&Name, &Option<Private>)| private.is_some())
            .map(|(name, _)| name.span())
    }

    /// What is used without being declared in the domain.
    pub(super) fn requirements_used(&mut self) {
        let used = std::mem::take(&mut self.used);
        for (requirement, at) in used {
            let (what, declared_by) = requirement.declared_by();
            let is_declared = |name: &&str| self.domain.requirements.iter().any(|declared| declared == *name);
            if !declared_by.iter().any(is_declared) {
                let usual = declared_by[0];
                let message = format!("{what} need `{usual}`, which the domain does not declare");
                let found = Diagnostic::warning(codes::UNDECLARED_REQUIREMENT, at, message);
                self.report.push(found.help(format!("add `{usual}` to (:requirements ...)")));
            }
        }
    }
}
