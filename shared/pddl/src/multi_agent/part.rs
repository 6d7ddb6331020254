//! The factored form: what one agent knows.

use std::collections::BTreeSet;

use super::rewrite::Rewrite;
use super::unfactored::{free_name, public, unmarked};
use super::universe::Universe;
use crate::ast::{Action, Condition, Domain, Init, Metric, Problem, Term, TypedName};
use crate::name::Name;

/// One agent's own domain and problem, with the agent as first parameter of each of its actions. Made from that
/// agent's files alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Whose.
    pub agent: Name,
    /// Its domain; constants stand among the objects.
    pub domain: Domain,
    /// Its objects and constants, itself among them.
    pub objects: Vec<TypedName>,
    /// Objects that nobody else shall hear of.
    pub private_objects: BTreeSet<Name>,
    /// Predicates that nobody else shall hear of.
    pub private_predicates: BTreeSet<Name>,
    /// What it knows to hold at the start.
    pub init: Vec<Init>,
    /// What it wants.
    pub goal: Condition,
    /// What it minimises.
    pub metric: Option<Metric>,
}

impl Part {
    /// The agent called `agent` in its own files. Who acts is told by the file's name, not by the file, so the
    /// agent is looked for in each action: `:agent`; a parameter that nobody else can fill; the first parameter,
    /// if the agent can fill it (the convention of CoDMAP); or else it is added in front, and then an action
    /// `drive_t1` of the agent `t1` is called `drive`, as in the unfactored form.
    pub fn new(agent: &Name, domain: &Domain, problem: &Problem) -> Part {
        let mut own = public(domain);
        let declared = || domain.constants.iter().chain(&problem.objects);
        let private_objects =
            declared().filter(|object| object.private_to.is_some()).map(|object| object.name.clone());
        let private_objects = private_objects.collect();
        let private_predicates = domain.predicates.iter().filter(|p| p.private_to.is_some());
        let private_predicates: BTreeSet<Name> = private_predicates.map(|p| p.name.clone()).collect();
        let mut objects: Vec<TypedName> = declared().map(unmarked).collect();
        if !objects.iter().any(|object| object.name == *agent) {
            objects.push(TypedName::new(agent.clone(), "object"));
        }
        own.constants.clear();
        let universe = Universe::new(&own.types, &objects);
        let names: BTreeSet<Name> = own.actions.iter().map(|action| action.name.clone()).collect();
        let actions = domain.actions.iter().map(|action| acting(agent, action, &universe, &objects, &names));
        let actions = actions.collect();
        own.actions = actions;
        Part {
            agent: agent.clone(),
            domain: own,
            private_objects,
            private_predicates,
            init: problem.init.clone(),
            goal: problem.goal.clone(),
            metric: problem.metric.clone(),
            objects,
        }
    }
}

/// The action with the agent as its first parameter.
fn acting(
    agent: &Name,
    action: &Action,
    universe: &Universe<'_>,
    objects: &[TypedName],
    names: &BTreeSet<Name>,
) -> Action {
    let mut action = action.clone();
    let marked = action.agent.take().map(|marked| marked.name);
    let only = |param: &&TypedName| universe.of(&param.types).eq([agent]);
    let marked = marked.or_else(|| action.params.iter().find(only).map(|param| param.name.clone()));
    let at = match marked {
        Some(name) => action.params.iter().position(|param| param.name == name),
        // Whoever is named outright acts: a first parameter beside it is another, as the receiver of a message.
        None if names_outright(agent, &action) => None,
        None => action.params.first().filter(|p| universe.of(&p.types).any(|o| o == agent)).map(|_| 0),
    };
    let param = match at {
        Some(at) => action.params.remove(at),
        None => {
            action.name = without_suffix(&action.name, agent, names);
            let variables = action.params.iter().map(|param| param.name.clone()).collect();
            let types = objects.iter().find(|o| o.name == *agent).map(|o| o.types.clone());
            let types = types.filter(|types| !types.is_empty()).unwrap_or_else(|| vec![Name::new("object")]);
            TypedName { name: free_name("agent", &variables), types, private_to: None }
        }
    };
    let body = AsVariable { agent, variable: param.name.clone() }.body(&action);
    action.params.insert(0, param);
    Action { params: action.params, ..body }
}

/// Whether the action speaks of the agent by name.
fn names_outright(agent: &Name, action: &Action) -> bool {
    AsVariable { agent, variable: agent.clone() }.body(action) != *action
}

/// `drive` for `drive_t1` of `t1`, unless there is a `drive` too.
fn without_suffix(action: &Name, agent: &Name, names: &BTreeSet<Name>) -> Name {
    let text = action.as_str();
    let head = text.len().checked_sub(agent.as_str().len() + 1).filter(|at| text.is_char_boundary(*at));
    let short = head.filter(|&at| at > 0).and_then(|at| {
        let tail = text[at..].strip_prefix(['_', '-'])?;
        tail.eq_ignore_ascii_case(agent.as_str()).then(|| Name::new(&text[..at]))
    });
    short.filter(|short| !names.contains(short)).unwrap_or_else(|| action.clone())
}

/// Within its own actions the agent is who acts.
struct AsVariable<'a> {
    agent: &'a Name,
    variable: Name,
}

impl Rewrite for AsVariable<'_> {
    fn term(&self, term: &Term) -> Term {
        match term {
            Term::Constant(name) if name == self.agent => Term::Variable(self.variable.clone()),
            other => other.clone(),
        }
    }
}
