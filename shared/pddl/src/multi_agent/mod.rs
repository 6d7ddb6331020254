//! Multi-agent PDDL (MA-PDDL, Kovács 2012, in the two forms of CoDMAP 2015): from the files to one classical
//! task of the whole team.
//!
//! *Unfactored*: one domain and one problem; `:agent` marks who acts ([`unfactored`]). *Factored*: a domain and
//! a problem for each agent, who knows nothing else ([`Part`], [`union`]). Either way the result is a
//! [`TeamTask`]: a classical domain in which the first parameter of every action is the agent that acts, the
//! usual compilation that validators accept.

mod error;
mod part;
mod rewrite;
mod unfactored;
mod union;
mod universe;
mod veil;

use crate::ast::{Condition, Domain, GroundAtom, Init, Metric, Problem, TypedName};
use crate::name::Name;

pub use error::TeamTaskError;
pub use part::Part;
pub use unfactored::{is_multi_agent, unfactored};
pub use union::union;
pub use veil::Veil;

/// The task of a team: ⟨agents, domain, their actions, facts, initial state, goal⟩.
#[derive(Clone, Debug, PartialEq)]
pub struct TeamTask {
    /// Everybody's actions. The first parameter of each is the agent that acts.
    pub domain: Domain,
    /// The objects beside the domain's constants, agents among them.
    pub objects: Vec<TypedName>,
    /// What holds at the start.
    pub init: Vec<Init>,
    /// What shall hold at the end.
    pub goal: Condition,
    /// What to minimise beside the time, if the files say so.
    pub metric: Option<Metric>,
    /// Who acts, in a fixed order.
    pub agents: Vec<TeamAgent>,
    /// Actions whose agent no parameter of the user's files names: it was added in front.
    pub agentless: Vec<Name>,
}

/// One agent of a [`TeamTask`].
#[derive(Clone, Debug, PartialEq)]
pub struct TeamAgent {
    /// The object that stands for it.
    pub name: Name,
    /// The actions of the team's domain that it can do.
    pub actions: Vec<Name>,
}

impl TeamTask {
    /// The problem that belongs to [`TeamTask::domain`].
    pub fn problem(&self) -> Problem {
        Problem {
            name: Name::new("team"),
            domain: self.domain.name.clone(),
            objects: self.objects.clone(),
            init: self.init.clone(),
            goal: self.goal.clone(),
            metric: self.metric.clone(),
        }
    }

    /// What one agent knows of the domain: everything but the actions of the others.
    pub fn domain_of(&self, agent: &TeamAgent) -> Domain {
        let mut domain = self.domain.clone();
        domain.actions.retain(|action| agent.actions.contains(&action.name));
        domain
    }

    /// An agent's act in the words of [`TeamTask::domain`], from the agent's own words without itself.
    pub fn compiled_act(&self, agent: &str, action: &str, args: &[String]) -> (Name, Vec<Name>) {
        let agent = Name::new(agent);
        let known = |name: Name, declared: bool| if declared { name } else { owned(&name, &agent) };
        let object = |text: &String| {
            let name = Name::new(text);
            let declared = self.domain.constants.iter().chain(&self.objects).any(|o| o.name == name);
            known(name, declared)
        };
        let name = Name::new(action);
        let declared = self.domain.actions.iter().any(|a| a.name == name);
        let args = std::iter::once(agent.clone()).chain(args.iter().map(object)).collect();
        (known(name, declared), args)
    }

    /// The facts that hold at the start.
    pub fn facts(&self) -> impl Iterator<Item = &GroundAtom> {
        self.init.iter().filter_map(|item| match item {
            Init::Fact(fact) => Some(fact),
            Init::Value(..) => None,
        })
    }
}

/// What stands between a name of one agent's own and the agent, where two agents use it for different things.
const OF: &str = "--";

/// The name for the whole team of what `agent` alone calls `name`.
fn owned(name: &Name, agent: &Name) -> Name {
    Name::new(format!("{name}{OF}{agent}"))
}

/// What `agent` itself calls it.
pub fn own_name<'t>(text: &'t str, agent: &str) -> &'t str {
    let owner = |head: &'t str| head.strip_suffix(OF);
    let at = text.len().checked_sub(agent.len()).filter(|at| text.is_char_boundary(*at));
    at.map(|at| text.split_at(at))
        .filter(|(_, tail)| tail.eq_ignore_ascii_case(agent))
        .and_then(|(head, _)| owner(head))
        .unwrap_or(text)
}
