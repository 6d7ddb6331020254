//! The unfactored form: one domain and one problem, in which `:agent` marks who acts.

use std::collections::BTreeSet;

use super::universe::Universe;
use super::{TeamAgent, TeamTask, TeamTaskError};
use crate::ast::{Domain, Problem, TypedName};
use crate::name::Name;

/// Who does what the files give to nobody.
const SOLO: &str = "solo";

/// Whether the domain says who acts.
pub fn is_multi_agent(domain: &Domain) -> bool {
    domain.actions.iter().any(|action| action.agent.is_some())
}

/// The team's task of an unfactored domain and problem.
///
/// Everything that can fill an `:agent` parameter is an agent. Actions without `:agent` belong to one agent
/// more, called `solo`, that does one of them at a time; a plain classical task is a team of `solo` alone.
pub fn unfactored(domain: &Domain, problem: &Problem) -> Result<TeamTask, TeamTaskError> {
    let mut domain = public(domain);
    let mut objects: Vec<TypedName> = problem.objects.iter().map(unmarked).collect();
    let mut agentless = Vec::new();
    for action in &mut domain.actions {
        match action.agent.take() {
            // Usually it is the first anyway.
            Some(agent) => {
                let at = action.params.iter().position(|param| param.name == agent.name).unwrap_or(0);
                let param = action.params.remove(at);
                action.params.insert(0, param);
            }
            None => agentless.push(action.name.clone()),
        }
    }
    if !agentless.is_empty() {
        let taken: BTreeSet<Name> = domain
            .constants
            .iter()
            .chain(&objects)
            .chain(&domain.types)
            .map(|declared| declared.name.clone())
            .collect();
        let solo = free_name(SOLO, &taken);
        let kind = free_name(&format!("{SOLO}-agent"), &taken);
        domain.types.push(TypedName::new(kind.clone(), "object"));
        objects.push(TypedName::new(solo, kind.clone()));
        for action in domain.actions.iter_mut().filter(|action| agentless.contains(&action.name)) {
            let variables = action.params.iter().map(|param| param.name.clone()).collect();
            let agent = free_name("agent", &variables);
            action.params.insert(0, TypedName::new(agent, kind.clone()));
        }
    }
    let agents = agents_of(&domain, &objects);
    if agents.is_empty() {
        return Err(TeamTaskError::NoAgents);
    }
    Ok(TeamTask {
        domain,
        objects,
        init: problem.init.clone(),
        goal: problem.goal.clone(),
        metric: problem.metric.clone(),
        agents,
        agentless,
    })
}

/// A name that is not taken: this one, or with a number.
pub(super) fn free_name(wanted: &str, taken: &BTreeSet<Name>) -> Name {
    let numbered = (2..).map(|n| Name::new(format!("{wanted}-{n}")));
    let mut names = std::iter::once(Name::new(wanted)).chain(numbered);
    names.find(|name| !taken.contains(name)).unwrap_or_else(|| Name::new(wanted))
}

/// Objects that can be the first argument of an action, in the order of declaration.
fn agents_of(domain: &Domain, objects: &[TypedName]) -> Vec<TeamAgent> {
    let universe = Universe::new(&domain.types, domain.constants.iter().chain(objects));
    let mut agents: Vec<TeamAgent> =
        universe.of(&[]).map(|name| TeamAgent { name: name.clone(), actions: Vec::new() }).collect();
    for action in &domain.actions {
        let Some(actor) = action.params.first() else { continue };
        let can: BTreeSet<&Name> = universe.of(&actor.types).collect();
        for agent in agents.iter_mut().filter(|agent| can.contains(&agent.name)) {
            agent.actions.push(action.name.clone());
        }
    }
    let mut seen = BTreeSet::new();
    agents.retain(|agent| !agent.actions.is_empty() && seen.insert(agent.name.clone()));
    agents
}

/// The domain without the marks of MA-PDDL.
pub(super) fn public(domain: &Domain) -> Domain {
    let mut domain = domain.clone();
    let marks = [":multi-agent", ":unfactored-privacy", ":factored-privacy"];
    domain.requirements.retain(|requirement| !marks.iter().any(|mark| *requirement == *mark));
    domain.constants.iter_mut().for_each(|constant| *constant = unmarked(constant));
    domain.predicates.iter_mut().chain(&mut domain.functions).for_each(|declared| declared.private_to = None);
    domain
}

/// The object without the mark of privacy.
pub(super) fn unmarked(object: &TypedName) -> TypedName {
    TypedName { private_to: None, ..object.clone() }
}
