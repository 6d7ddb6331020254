//! What is wrong with a text, where, and what to do about it.

use std::fmt;

use serde_json::{Value, json};

use crate::name::Span;
use crate::source::Source;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The text can be used; a planner or validator elsewhere may refuse it.
    Warning,
    /// The text cannot be used.
    Error,
}

/// A place and what is to be said about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What.
    pub text: String,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// A stable name for this kind of finding; [`crate::codes::explain`] says more about it.
    pub code: &'static str,
    /// What is wrong, in one sentence.
    pub message: String,
    /// Where; `Span::NONE` if no text says it.
    pub span: Span,
    /// What stands under the caret.
    pub label: String,
    /// Other places that matter.
    pub secondary: Vec<Label>,
    /// What to do.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A finding that makes the text unusable.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic {
            severity: Severity::Error,
            code,
            message: message.into(),
            span,
            label: String::new(),
            secondary: Vec::new(),
            help: None,
        }
    }

    /// A finding the text can be used in spite of.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    /// Puts a text under the caret.
    pub fn label(mut self, text: impl Into<String>) -> Self {
        self.label = text.into();
        self
    }

    /// Points at another place.
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        if span != Span::NONE {
            self.secondary.push(Label { span, text: text.into() });
        }
        self
    }

    /// Says what to do.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }
}

/// The findings about one text, in the order they were made.
#[derive(Clone, Debug)]
pub struct Report {
    source: Source,
    diagnostics: Vec<Diagnostic>,
    omitted: usize,
    errors: usize,
}

impl Report {
    /// Findings kept; of the others only the number is known. Text that is no PDDL at all would otherwise
    /// cost more memory in findings than in itself.
    pub const MAX_DIAGNOSTICS: usize = 100;

    /// Nothing found in `source` so far.
    pub fn new(source: &Source) -> Self {
        Report { source: source.clone(), diagnostics: Vec::new(), omitted: 0, errors: 0 }
    }

    /// Adds a finding.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let is_error = diagnostic.severity == Severity::Error;
        self.errors += usize::from(is_error);
        // The first error stays visible behind any number of warnings.
        if self.diagnostics.len() < Self::MAX_DIAGNOSTICS || (is_error && self.errors == 1) {
            self.diagnostics.push(diagnostic);
        } else {
            self.omitted += 1;
        }
    }

    /// Adds the findings of another report about the same text.
    pub fn extend(&mut self, other: Report) {
        let kept_errors = other.errors().count();
        self.omitted += other.omitted;
        self.errors += other.errors - kept_errors;
        other.diagnostics.into_iter().for_each(|diagnostic| self.push(diagnostic));
    }

    /// The text the findings are about.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The findings.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The findings that make the text unusable.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error)
    }

    /// The findings the text can be used in spite of.
    pub fn warnings(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Warning)
    }

    /// Whether the text is unusable.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// Whether further findings are only counted, so that it is no use to word them.
    pub fn is_full(&self) -> bool {
        self.diagnostics.len() >= Self::MAX_DIAGNOSTICS && self.has_errors()
    }

    /// How many findings there were beyond those kept.
    pub fn omitted(&self) -> usize {
        self.omitted
    }

    /// The report as data: `{"diagnostics": [{"severity", "code", "message", "file", "line", "column", "end_line",
    /// "end_column", "label", "help", "related": [{"line", "column", "message"}]}], "omitted": 0}`. Lines and
    /// columns count from 1, and are null where no text is concerned.
    pub fn to_json(&self) -> Value {
        let diagnostics: Vec<Value> = self.diagnostics.iter().map(|d| self.diagnostic_to_json(d)).collect();
        json!({ "diagnostics": diagnostics, "omitted": self.omitted })
    }

    fn diagnostic_to_json(&self, diagnostic: &Diagnostic) -> Value {
        let place = |offset: u32, span: Span| -> (Value, Value) {
            if span == Span::NONE {
                return (Value::Null, Value::Null);
            }
            let (line, column) = self.source.position(offset as usize);
            (line.into(), column.into())
        };
        let related: Vec<Value> = diagnostic
            .secondary
            .iter()
            .map(|label| {
                let (line, column) = place(label.span.start, label.span);
                json!({ "line": line, "column": column, "message": label.text })
            })
            .collect();
        let (line, column) = place(diagnostic.span.start, diagnostic.span);
        let (end_line, end_column) = place(diagnostic.span.end, diagnostic.span);
        json!({
            "severity": match diagnostic.severity { Severity::Error => "error", Severity::Warning => "warning" },
            "code": diagnostic.code,
            "message": diagnostic.message,
            "file": &*self.source.name,
            "line": line,
            "column": column,
            "end_line": end_line,
            "end_column": end_column,
            "label": diagnostic.label,
            "help": diagnostic.help,
            "related": related,
        })
    }
}

/// Plain text with carets, as [`Report::render`] gives it.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render())
    }
}

impl std::error::Error for Report {}

/// What was read, and what was noticed while reading it.
#[derive(Clone, Debug)]
pub struct Parsed<T> {
    /// What was read.
    pub value: T,
    /// Findings it can be used in spite of.
    pub warnings: Report,
}
