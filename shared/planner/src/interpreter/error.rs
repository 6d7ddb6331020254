//! Why a domain cannot be interpreted, an action not be named, a condition not be met.

use std::fmt;

use lamma_pddl::Name;
use lamma_pddl::ast::{GroundAtom, TypedName};

use super::condition::GroundCondition;
use crate::plan::{GroundAct, Literal};

/// Why a domain, an initial state or a goal has no meaning. The checker of `lamma-pddl` finds all of these with
/// their places; this is the second line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InterpretError {
    /// A type that is not declared.
    #[error("the type `{name}` is not declared; add it to (:types ...)")]
    UnknownType {
        /// The type.
        name: Name,
    },
    /// A predicate or function that is not declared.
    #[error("the {kind} `{name}` is not declared; add it to the domain")]
    UnknownSymbol {
        /// `predicate` or `function`.
        kind: &'static str,
        /// The predicate or function.
        name: Name,
    },
    /// Another number of arguments than declared.
    #[error("the {kind} `{name}` takes {expected} arguments, not {found}")]
    WrongArity {
        /// `predicate` or `function`.
        kind: &'static str,
        /// The predicate or function.
        name: Name,
        /// As declared.
        expected: usize,
        /// As used.
        found: usize,
    },
    /// A variable that nothing binds.
    #[error("the variable `?{name}` is not bound; add it to the parameters")]
    UnknownVariable {
        /// The variable.
        name: Name,
    },
    /// An object that is not declared.
    #[error("the object `{name}` is not declared; add it to (:objects ...)")]
    UnknownObject {
        /// The object.
        name: Name,
    },
    /// An effect or initial fact about a derived predicate.
    #[error("`{predicate}` is derived by an axiom and cannot be set by an action or (:init ...)")]
    DerivedEffect {
        /// The predicate.
        predicate: Name,
    },
    /// An axiom that depends on its own negation.
    #[error("the axioms for `{predicate}` depend on their own negation, so they have no order")]
    Unstratified {
        /// One predicate of the circle.
        predicate: Name,
    },
    /// A metric without a value.
    #[error("the metric has no value: {reason}")]
    Metric {
        /// Why.
        reason: String,
    },
    /// Too many ground conditions, or too many objects with too many types.
    #[error("the condition has too many ground instances; use fewer nested quantifiers")]
    TooLarge,
}

/// Why an act names no action.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ActError {
    /// The domain has no such action.
    UnknownAction {
        /// As named.
        action: Name,
        /// What may have been meant.
        nearest: Option<Name>,
    },
    /// Another number of arguments than the action has parameters.
    WrongArity {
        /// The act.
        act: GroundAct,
        /// Parameters of the action.
        expected: usize,
        /// Arguments of the act.
        found: usize,
    },
    /// An argument that is no object.
    UnknownObject {
        /// The act.
        act: GroundAct,
        /// The argument.
        object: Name,
        /// What may have been meant.
        nearest: Option<Name>,
    },
    /// An argument of the wrong type.
    WrongType {
        /// The act.
        act: GroundAct,
        /// The argument.
        object: Name,
        /// The parameter with its types.
        param: Box<TypedName>,
    },
    /// The action has too many ground conditions and effects.
    TooLarge {
        /// The act.
        act: GroundAct,
    },
}

impl fmt::Display for ActError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let suggestion = |nearest: &Option<Name>| match nearest {
            Some(name) => format!("; did you mean `{name}`?"),
            None => String::new(),
        };
        match self {
            ActError::UnknownAction { action, nearest } => {
                write!(f, "the domain has no action `{action}`{}", suggestion(nearest))
            }
            ActError::WrongArity { act, expected, found } => {
                write!(f, "{act} has {found} arguments; `{}` takes {expected}", act.action)
            }
            ActError::UnknownObject { act, object, nearest } => {
                write!(f, "there is no object `{object}`, which {act} names{}", suggestion(nearest))
            }
            ActError::WrongType { act, object, param } => {
                let types: Vec<&str> = param.types.iter().map(Name::as_str).collect();
                write!(
                    f,
                    "`{object}` in {act} is not of the type {} that ?{} needs",
                    types.join(" or "),
                    param.name
                )
            }
            ActError::TooLarge { act } => {
                write!(f, "{act} has too many ground instances; use fewer nested quantifiers")
            }
        }
    }
}

impl std::error::Error for ActError {}

/// A part of a condition that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Unmet {
    /// The literal is the other way round.
    Literal(Literal),
    /// A disjunction or comparison is false.
    Condition(GroundCondition),
    /// A function has no value in the state.
    Undefined(GroundAtom),
    /// A value would be infinite or no number, as after a division by 0.
    NotFinite(String),
}

impl fmt::Display for Unmet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unmet::Literal(Literal { atom, holds: true }) => write!(f, "{atom} does not hold"),
            Unmet::Literal(Literal { atom, holds: false }) => write!(f, "{atom} holds but must not"),
            Unmet::Condition(condition) => write!(f, "{condition} does not hold"),
            Unmet::Undefined(function) => write!(f, "{function} has no value"),
            Unmet::NotFinite(expression) => write!(f, "{expression} is not a finite number"),
        }
    }
}

/// An action that may not be done in a state, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The action.
    pub act: GroundAct,
    /// What does not hold.
    pub unmet: Vec<Unmet>,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unmet: Vec<String> = self.unmet.iter().map(Unmet::to_string).collect();
        write!(f, "{} is not possible: {}", self.act, unmet.join(", "))
    }
}

impl std::error::Error for Violation {}
