//! Domain files.

use std::collections::{BTreeSet, HashMap};

use super::Parser;
use super::typed::Declares;
use crate::ast::{Axiom, Domain};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::Name;
use crate::sexpr::{List, Sexpr, Word};
use crate::suggest::did_you_mean;

/// Types a domain may have.
const MAX_TYPES: usize = 1024;

const SECTIONS: &[&str] = &[
    ":requirements",
    ":types",
    ":constants",
    ":predicates",
    ":functions",
    ":action",
    ":durative-action",
    ":derived",
];

impl Parser {
    pub(super) fn domain_file(&mut self, top: &[Sexpr<'_>]) -> Option<Domain> {
        let (name, sections) = self.define(top, "domain", "problem")?;
        let mut domain = Domain {
            name,
            requirements: Vec::new(),
            types: Vec::new(),
            constants: Vec::new(),
            predicates: Vec::new(),
            functions: Vec::new(),
            actions: Vec::new(),
            axioms: Vec::new(),
        };
        let mut seen = HashMap::new();
        for sexpr in sections {
            let Some((head, list)) = self.section(sexpr) else { continue };
            let keyword = head.text.to_ascii_lowercase();
            if let Some(section) = SECTIONS[..5].iter().find(|section| **section == keyword) {
                self.once(&mut seen, section, list);
            }
            match keyword.as_str() {
                ":requirements" => domain.requirements.extend(self.requirements(list)),
                ":types" => domain.types.extend(self.typed_list(list.rest(), Declares::Types)),
                ":constants" => domain.constants.extend(self.typed_list(list.rest(), Declares::Objects)),
                ":predicates" => domain.predicates.extend(self.signatures(list.rest(), false)),
                ":functions" => domain.functions.extend(self.signatures(list.rest(), true)),
                ":action" => domain.actions.extend(self.action(list)),
                ":durative-action" => domain.actions.extend(self.durative_action(list)),
                ":derived" => domain.axioms.extend(self.axiom(list)),
                _ => self.unknown_section(head, SECTIONS),
            }
        }
        self.few_types(&domain);
        Some(domain)
    }

    /// The checker keeps which types are kinds of which, for every pair of them.
    fn few_types(&mut self, domain: &Domain) {
        let all = domain.types.iter().flat_map(|declared| declared.types.iter().chain([&declared.name]));
        if all.collect::<BTreeSet<_>>().len() > MAX_TYPES {
            self.error(
                codes::TOO_LARGE,
                domain.name.span(),
                format!("the domain has more than {MAX_TYPES} types"),
            );
        }
    }

    /// Names with their colon. Of problems too, where they say nothing the domain did not say.
    pub(super) fn requirements(&mut self, list: &List<'_>) -> Vec<Name> {
        let mut requirements = Vec::new();
        for item in list.rest() {
            match item.as_word().and_then(|word| Some((word, word.text.strip_prefix(':')?))) {
                Some((word, bare)) => {
                    if self.spelling(word, bare).is_some() {
                        requirements.push(self.intern(word.text, word.span));
                    }
                }
                None => {
                    self.expected(item.place(), "a requirement", "requirements begin with a colon: `:strips`")
                }
            }
        }
        requirements
    }

    pub(super) fn unknown_section(&mut self, head: Word<'_>, known: &[&str]) {
        let unsupported = [
            (":constraints", "state what shall hold at the end in `:goal`"),
            (":preferences", "make it a goal, or leave it out"),
            (":process", "only actions change the world"),
            (":event", "only actions change the world"),
            (":task", "hierarchical tasks need another planner"),
            (":method", "hierarchical tasks need another planner"),
            (":htn", "hierarchical tasks need another planner"),
            (":shared-data", "use `(:private ...)`, as CoDMAP does"),
            (":global-goal", "use `(:goal ...)`"),
        ];
        if let Some((section, help)) = unsupported.iter().find(|(section, _)| head.is(section)) {
            self.unsupported(head.span, &format!("`{section}`"), help);
            return;
        }
        let names: Vec<Name> = known.iter().map(Name::new).collect();
        let help = did_you_mean(head.text, &names, format!("the sections are {}", known.join(" ")));
        let found =
            Diagnostic::error(codes::UNKNOWN_SECTION, head.span, format!("unknown section `{}`", head.text));
        self.report.push(found.help(help));
    }

    /// `(:derived (p ?x) condition)`
    fn axiom(&mut self, list: &List<'_>) -> Option<Axiom> {
        let help = "`(:derived (above ?x ?y) (on ?x ?y))`";
        let [head, body] = self.operands(list, "a predicate with its variables and a condition", help)?;
        let Some(head) = head.as_list() else {
            self.expected(head.place(), "a predicate with its variables", help);
            return None;
        };
        let (head, body) = (self.signature(head), self.condition(body));
        Some(Axiom { head: head?, body: body? })
    }
}
