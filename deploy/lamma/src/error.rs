//! Failures of a command: what to print, and the exit code.

use std::fmt;
use std::path::Path;

use lamma_pddl::Report;
use serde_json::Value;

use crate::exit;

/// Why a command cannot do what it was asked.
#[derive(Debug)]
pub struct Failure {
    /// The exit code of the contract.
    pub code: u8,
    /// What to print, whole.
    pub text: String,
    /// The findings in the input as data, errors and warnings; empty where there are none.
    pub diagnostics: Vec<Value>,
}

impl Failure {
    /// The input is at fault.
    pub fn bad_input(text: impl fmt::Display) -> Self {
        Failure { code: exit::BAD_INPUT, text: text.to_string(), diagnostics: Vec::new() }
    }

    /// The input is at fault, and a report says where; `before` was found in what was read before.
    pub fn diagnosed(report: &Report, before: Vec<Value>) -> Self {
        let diagnostics = before.into_iter().chain(diagnostics(report)).collect();
        Failure { diagnostics, ..Failure::bad_input(report) }
    }

    /// The software or the host is at fault.
    pub fn fault(text: impl fmt::Display) -> Self {
        Failure { code: exit::FAULT, text: text.to_string(), diagnostics: Vec::new() }
    }

    /// A file named by the user cannot be used.
    pub fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        Failure::bad_input(format!("cannot read {}: {error}", path.display()))
    }

    /// A file of our own cannot be used.
    pub fn io(verb: &str, path: &Path, error: &std::io::Error) -> Self {
        Failure::fault(format!("cannot {verb} {}: {error}", path.display()))
    }
}

/// A report's findings as data.
pub fn diagnostics(report: &Report) -> Vec<Value> {
    let mut json = report.to_json();
    match json["diagnostics"].take() {
        Value::Array(findings) => findings,
        _ => Vec::new(),
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
