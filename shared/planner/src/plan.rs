//! Plans: ground actions in order.

use std::fmt;

use lamma_pddl::Name;
use lamma_pddl::ast::GroundAtom;

/// A ground action, by name.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroundAct {
    /// The action.
    pub action: Name,
    /// Its arguments.
    pub args: Vec<Name>,
}

impl GroundAct {
    /// `(action args…)`.
    pub fn new(action: impl Into<Name>, args: impl IntoIterator<Item = impl Into<Name>>) -> Self {
        GroundAct { action: action.into(), args: args.into_iter().map(Into::into).collect() }
    }
}

impl fmt::Display for GroundAct {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}", self.action)?;
        self.args.iter().try_for_each(|a| write!(f, " {a}"))?;
        f.write_str(")")
    }
}

/// A fact that holds or does not.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Literal {
    /// The fact.
    pub atom: GroundAtom,
    /// Whether it holds.
    pub holds: bool,
}

/// A sequential plan and its cost (number of actions, or the metric where the domain has action costs).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The actions, in order.
    pub acts: Vec<GroundAct>,
    /// Its cost.
    pub cost: f64,
}
