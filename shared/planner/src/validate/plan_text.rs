//! Plans as text, in the format of the planning competitions: an action a line, `(action argument …)`.
//!
//! Read also are time stamps and durations, `0.000: (action argument …) [1.000]`. Comments run from `;` to the
//! end of the line.

use std::fmt::{self, Write};

use lamma_pddl::diagnostic::{Diagnostic, Report};
use lamma_pddl::source::MAX_SOURCE_BYTES;
use lamma_pddl::{Name, Source, Span, codes};

use crate::plan::{GroundAct, Plan};

const MAX_ACTS: usize = 1 << 20;
const MAX_WORD_BYTES: usize = 1024;

/// What the cost of a plan counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostKind {
    /// Actions.
    Unit,
    /// The problem's metric.
    Metric,
}

impl fmt::Display for CostKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CostKind::Unit => "unit cost",
            CostKind::Metric => "general cost",
        })
    }
}

/// The plan as text, its cost in a comment at the end: `; cost = 7 (unit cost)`.
pub fn write_plan(plan: &Plan, kind: CostKind) -> String {
    let mut text = String::new();
    for act in &plan.acts {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{act}");
    }
    let _ = writeln!(text, "; cost = {} ({kind})", plan.cost);
    text
}

/// The acts of a plan. With time stamps at all of them they are in the order of time; those that start at the same
/// time stay in the order of the text.
pub fn read_plan(source: &Source) -> Result<Vec<GroundAct>, Report> {
    let mut report = Report::new(source);
    if source.text.len() > MAX_SOURCE_BYTES {
        let message = format!("the plan has {} bytes; the limit is {MAX_SOURCE_BYTES}", source.text.len());
        report.push(Diagnostic::error(codes::TOO_LARGE, Span::NONE, message));
        return Err(report);
    }
    let mut acts: Vec<(Option<f64>, GroundAct)> = Vec::new();
    let mut line_start = 0;
    for line in source.text.split_inclusive('\n') {
        let text = line.split(';').next().unwrap_or_default();
        let mut cursor = Cursor { text, at: 0, offset: line_start };
        line_start += line.len();
        while !cursor.is_at_end() {
            match cursor.step() {
                Ok(step) => acts.push(step),
                Err(found) => {
                    report.push(*found);
                    break;
                }
            }
        }
        if acts.len() > MAX_ACTS {
            let place = Span::new(cursor.offset, cursor.offset + 1);
            report.push(Diagnostic::error(codes::TOO_LARGE, place, format!("more than {MAX_ACTS} actions")));
            break;
        }
    }
    if report.has_errors() {
        return Err(report);
    }
    if acts.iter().all(|(time, _)| time.is_some()) {
        let time = |act: &(Option<f64>, GroundAct)| act.0.unwrap_or_default();
        acts.sort_by(|a, b| time(a).total_cmp(&time(b)));
    }
    Ok(acts.into_iter().map(|(_, act)| act).collect())
}

/// One line, without its comment.
struct Cursor<'a> {
    text: &'a str,
    at: usize,
    /// Of the line in the text.
    offset: usize,
}

impl Cursor<'_> {
    fn is_at_end(&mut self) -> bool {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.at == self.text.len()
    }

    fn rest(&mut self) -> &str {
        self.is_at_end();
        &self.text[self.at..]
    }

    /// `[time:] (action argument …) [[duration]]`
    fn step(&mut self) -> Result<(Option<f64>, GroundAct), Box<Diagnostic>> {
        let time = self.time()?;
        let act = self.act()?;
        if self.rest().starts_with('[') {
            let Some(end) = self.rest().find(']') else {
                return Err(self.fault("expected `]` after the duration"));
            };
            let duration = self.rest()[1..end].trim().parse::<f64>();
            if !duration.is_ok_and(|duration| duration.is_finite() && duration >= 0.0) {
                return Err(self.fault("expected a duration, such as `[1.000]`"));
            }
            self.at += end + 1;
        }
        Ok((time, act))
    }

    fn time(&mut self) -> Result<Option<f64>, Box<Diagnostic>> {
        if self.rest().starts_with('(') {
            return Ok(None);
        }
        let Some(colon) = self.rest().find(':') else {
            return Err(self.fault("expected `(action argument ...)`"));
        };
        match self.rest()[..colon].trim().parse::<f64>() {
            Ok(time) if time.is_finite() => {
                self.at += colon + 1;
                Ok(Some(time))
            }
            _ => Err(self.fault("expected a time, such as `0.000:`, or an action")),
        }
    }

    fn act(&mut self) -> Result<GroundAct, Box<Diagnostic>> {
        if !self.rest().starts_with('(') {
            return Err(self.fault("expected `(`"));
        }
        let Some(close) = self.rest().find(')') else {
            return Err(self.fault("expected `)` at the end of the action"));
        };
        let mut names = Vec::new();
        let from = self.at + 1;
        let inside = &self.text[from..self.at + close];
        for word in inside.split_ascii_whitespace() {
            // A word is a slice of the line.
            let start = self.offset + from + (word.as_ptr() as usize - inside.as_ptr() as usize);
            let place = Span::new(start, start + word.len());
            if word.len() > MAX_WORD_BYTES || !word.bytes().all(|b| b.is_ascii_graphic() && b != b'(') {
                let found = Diagnostic::error(codes::PLAN_SYNTAX, place, "this cannot be a name");
                return Err(Box::new(found.help("names have ASCII letters, digits, `-` and `_`")));
            }
            names.push(Name::at(word, place));
        }
        if names.is_empty() {
            return Err(self.fault("expected the name of an action"));
        }
        self.at += close + 1;
        let args = names.split_off(1);
        let action = names.remove(0);
        Ok(GroundAct { action, args })
    }

    fn fault(&mut self, message: &str) -> Box<Diagnostic> {
        let length = self.rest().chars().next().map_or(0, char::len_utf8);
        let start = self.offset + self.at;
        let help = "a plan has one action a line: `(GoToObject robot1 Fridge_1)`";
        Box::new(Diagnostic::error(codes::PLAN_SYNTAX, Span::new(start, start + length), message).help(help))
    }
}
