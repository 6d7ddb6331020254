//! S-expressions to the abstract syntax tree.
//!
//! A parsing function reports what it cannot read and answers `None`; its caller goes on with what comes next,
//! so that one run finds many mistakes.

mod action;
mod condition;
mod domain;
mod durative;
mod effect;
mod numeric;
mod problem;
mod typed;

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::ast::{Condition, Domain, GroundAtom, Problem, Term};
use crate::codes;
use crate::diagnostic::{Diagnostic, Parsed, Report};
use crate::name::{Name, Span};
use crate::sexpr::{self, List, Sexpr, Word};
use crate::source::Source;

/// Reads a domain.
pub fn parse_domain(source: &Source) -> Result<Parsed<Domain>, Report> {
    parse(source, |parser, top| parser.domain_file(top))
}

/// Reads a problem.
pub fn parse_problem(source: &Source) -> Result<Parsed<Problem>, Report> {
    parse(source, |parser, top| parser.problem_file(top))
}

/// Reads one fact, such as `(at robot1 Fridge_1)`.
pub fn parse_ground_atom(text: &str) -> Result<GroundAtom, Report> {
    let source = Source::new("<fact>", text);
    let parsed = parse(&source, |parser, top| {
        let only = parser.only(top, "a fact such as `(at robot1 Fridge_1)`")?;
        parser.ground_atom(only)
    });
    parsed.map(|parsed| parsed.value)
}

/// Reads one condition, such as `(and (open Fridge_1) (not (dirty Plate_1)))`.
pub fn parse_condition(text: &str) -> Result<Condition, Report> {
    let source = Source::new("<condition>", text);
    let parsed = parse(&source, |parser, top| {
        let only = parser.only(top, "a condition such as `(open Fridge_1)`")?;
        parser.condition(only)
    });
    parsed.map(|parsed| parsed.value)
}

fn parse<T>(
    source: &Source,
    read: impl FnOnce(&mut Parser, &[Sexpr<'_>]) -> Option<T>,
) -> Result<Parsed<T>, Report> {
    let mut report = Report::new(source);
    let top = sexpr::read(source, &mut report);
    let mut parser = Parser { report, names: HashSet::new(), typings: 0 };
    let value = top.and_then(|top| read(&mut parser, &top));
    match value {
        Some(value) if !parser.report.has_errors() => Ok(Parsed { value, warnings: parser.report }),
        _ => Err(parser.report),
    }
}

/// The findings so far, and each spelling once.
struct Parser {
    report: Report,
    // Looked up, never iterated.
    names: HashSet<Arc<str>>,
    /// Pairs of a name and one of its types so far.
    typings: usize,
}

impl Parser {
    fn error(&mut self, code: &'static str, span: Span, message: impl Into<String>) {
        self.report.push(Diagnostic::error(code, span, message));
    }

    /// "expected X", with the form to use as help.
    fn expected(&mut self, span: Span, what: &str, help: &str) {
        self.report.push(Diagnostic::error(codes::SYNTAX, span, format!("expected {what}")).help(help));
    }

    fn unsupported(&mut self, span: Span, what: &str, help: &str) {
        let message = format!("{what} is not supported");
        self.report.push(Diagnostic::error(codes::UNSUPPORTED, span, message).help(help));
    }

    /// The one expression of a text that holds only one.
    fn only<'t, 's>(&mut self, top: &'t [Sexpr<'s>], what: &str) -> Option<&'t Sexpr<'s>> {
        match top {
            [] => self.error(codes::SYNTAX, Span::NONE, format!("the text is empty; expected {what}")),
            [only] => return Some(only),
            [_, second, ..] => {
                self.error(codes::TRAILING, second.place(), "there is more text than one expression")
            }
        }
        None
    }

    /// `text` as a name, each spelling stored once.
    fn intern(&mut self, text: &str, span: Span) -> Name {
        if let Some(shared) = self.names.get(text) {
            return Name::shared(Arc::clone(shared), span);
        }
        let shared: Arc<str> = Arc::from(text);
        self.names.insert(Arc::clone(&shared));
        Name::shared(shared, span)
    }

    /// A name without a mark: an object, predicate, type, action.
    fn name(&mut self, sexpr: &Sexpr<'_>, what: &str) -> Option<Name> {
        let Some(word) = sexpr.as_word() else {
            self.expected(sexpr.place(), what, "a name here, not a list");
            return None;
        };
        if word.is_variable() || word.is_keyword() {
            self.expected(word.span, what, "a plain name: `?` marks variables and `:` keywords");
            return None;
        }
        self.spelling(word, word.text)
    }

    /// A variable, without its question mark.
    fn variable(&mut self, sexpr: &Sexpr<'_>) -> Option<Name> {
        if let Some(word) = sexpr.as_word().filter(|word| !word.text.is_ascii()) {
            return self.spelling(word, word.text);
        }
        let Some((word, text)) = sexpr.as_word().and_then(|word| Some((word, word.text.strip_prefix('?')?)))
        else {
            self.expected(sexpr.place(), "a variable", "variables begin with `?`, as in `?x`");
            return None;
        };
        self.spelling(word, text)
    }

    /// A constant or variable.
    fn term(&mut self, sexpr: &Sexpr<'_>) -> Option<Term> {
        match sexpr.as_word() {
            Some(word) if word.is_variable() => self.variable(sexpr).map(Term::Variable),
            Some(_) => self.name(sexpr, "an object or a variable").map(Term::Constant),
            None => {
                let help = "arguments are objects or variables; object fluents and nested predicates are not supported";
                self.expected(sexpr.place(), "an object or a variable", help);
                None
            }
        }
    }

    /// All of them, or `None` after every bad one was reported.
    fn terms(&mut self, items: &[Sexpr<'_>]) -> Option<Vec<Term>> {
        let read: Vec<Option<Term>> = items.iter().map(|item| self.term(item)).collect();
        read.into_iter().collect()
    }

    /// `word` as a name spelt `text`, if it is made of the letters PDDL allows.
    fn spelling(&mut self, word: Word<'_>, text: &str) -> Option<Name> {
        let allowed = |c: char| c.is_ascii_alphanumeric() || "-_.@#$%&*+/<=>!^~|[]{}".contains(c);
        let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
        let mut unusual = text.char_indices().filter(|(_, c)| !u8::try_from(*c).is_ok_and(is_plain));
        let bad_character = unusual.find(|(at, c)| !(allowed(*c) || (*at == 0 && *c == '?')));
        if let Some((offset, bad)) = bad_character {
            let start = word.span.end as usize - text.len() + offset;
            let place = Span::new(start, start + bad.len_utf8());
            let found =
                Diagnostic::error(codes::BAD_CHARACTER, place, format!("`{bad}` cannot be part of a name"));
            let help = match bad {
                '\u{2010}'..='\u{2015}' => {
                    "write `-` (the key between 0 and =), with a space before and after it in a typed list"
                }
                _ => "use ASCII letters, digits, `-` and `_`; comments begin with `;`",
            };
            self.report.push(found.help(help));
            return None;
        }
        if text.is_empty() || text == "-" {
            self.expected(word.span, "a name", "a name begins with a letter");
            return None;
        }
        Some(self.intern(text, word.span))
    }

    /// The one `(define …)` at the top level and its header, such as `(domain NAME)`.
    fn define<'t, 's>(
        &mut self,
        top: &'t [Sexpr<'s>],
        kind: &str,
        other: &str,
    ) -> Option<(Name, &'t [Sexpr<'s>])> {
        let form = format!("a {kind} file has the form `(define ({kind} NAME) ...)`");
        let Some((first, more)) = top.split_first() else {
            let found =
                Diagnostic::error(codes::WRONG_FILE, Span::NONE, format!("the text is empty, not a {kind}"));
            self.report.push(found.help(form));
            return None;
        };
        let Some(define) = first.as_list().filter(|list| list.head_is("define")) else {
            let found =
                Diagnostic::error(codes::WRONG_FILE, first.place(), format!("this is not a PDDL {kind}"));
            self.report.push(found.label("expected `(define`").help(form));
            return None;
        };
        if let Some(next) = more.first() {
            let found =
                Diagnostic::error(codes::TRAILING, next.place(), "there is more text after the definition");
            let found =
                found.label("outside of `(define ...)`").also(define.close(), "the definition ends here");
            self.report.push(found.help("remove it, or move the `)` that closes the definition behind it"));
        }
        let header = define.items.get(1).and_then(Sexpr::as_list);
        let Some(header) = header.filter(|list| list.head_is(kind) && list.items.len() == 2) else {
            let place = define.items.get(1).map_or(define.place(), Sexpr::place);
            let found = Diagnostic::error(codes::WRONG_FILE, place, format!("this is not a PDDL {kind}"));
            let is_other = header.is_some_and(|list| list.head_is(other));
            let mixed_up = format!("this is a {other}; were the two files given in the wrong order?");
            self.report.push(found.help(if is_other { mixed_up } else { form }));
            return None;
        };
        let name = self.name(&header.items[1], "a name")?;
        Some((name, &define.items[2..]))
    }

    /// The section's keyword, if `sexpr` is a section at all.
    fn section<'t, 's>(&mut self, sexpr: &'t Sexpr<'s>) -> Option<(Word<'s>, &'t List<'s>)> {
        let section = sexpr.as_list().and_then(|list| Some((list.head()?, list)));
        if section.is_none_or(|(head, _)| !head.is_keyword()) {
            self.expected(sexpr.place(), "a section", "sections have the form `(:keyword ...)`");
            return None;
        }
        section
    }

    /// Reports the second of two sections that should be one. They are joined.
    fn once(&mut self, seen: &mut HashMap<&'static str, Span>, section: &'static str, list: &List<'_>) {
        if let Some(first) = seen.insert(section, list.place()) {
            let message = format!("a second `{section}` section");
            let found = Diagnostic::warning(codes::DUPLICATE_SECTION, list.place(), message);
            self.report.push(found.also(first, "the first").help("write it as one section; both are used"));
        }
    }
}
