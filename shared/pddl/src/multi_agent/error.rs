//! Why files make no team's task.

use thiserror::Error;

use crate::name::Name;

/// What contradicts itself between the files of a team, or within them.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TeamTaskError {
    /// There is nobody.
    #[error("no object can be the agent of any action: give the `:agent` types objects")]
    NoAgents,
    /// Two parts for the same agent.
    #[error("two parts are for the agent `{0}`: one domain and one problem per agent")]
    Twice(Name),
    /// The agents do not agree on what a name takes.
    #[error(
        "`{name}` takes {first} arguments for {one} and {second} for {other}: the parts do not fit together"
    )]
    Arity {
        /// The predicate or function.
        name: Name,
        /// Arguments in the first part that declares it.
        first: usize,
        /// That part's agent.
        one: Name,
        /// Arguments in another part.
        second: usize,
        /// That part's agent.
        other: Name,
    },
    /// The agents do not agree on a number.
    #[error("{function} has one value for {one} and another for {other}: the parts do not fit together")]
    Value {
        /// The function.
        function: String,
        /// The first agent.
        one: Name,
        /// The other.
        other: Name,
    },
}
