//! PDDL text to a spanned abstract syntax tree, with diagnostics a person or a language model can act on.

pub mod ast;
pub mod name;

pub use name::{Name, Span};
