//! PDDL text to a spanned abstract syntax tree, with diagnostics a person or a language model can act on.

pub mod ast;
pub mod check;
pub mod codes;
pub mod diagnostic;
mod layout;
pub mod multi_agent;
pub mod name;
pub mod parse;
mod print;
mod render;
mod sexpr;
pub mod source;
pub mod suggest;

pub use check::{check_domain, check_problem};
pub use codes::explain;
pub use diagnostic::{Diagnostic, Parsed, Report, Severity};
pub use name::{Name, Span};
pub use parse::{parse_condition, parse_domain, parse_ground_atom, parse_problem};
pub use source::Source;
