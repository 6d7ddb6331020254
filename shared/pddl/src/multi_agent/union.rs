//! The parts of a factored task as one task of the whole team.
//!
//! What is private belongs to its agent even where two agents use the same word: a private object that two parts
//! declare is two objects, and a private predicate whose facts two parts could both mean is two predicates. Each
//! agent acts on what it knows: where the team has more objects of a type than an agent's part, the action asks
//! that the agent knows the object.

use std::collections::{BTreeMap, BTreeSet};

use super::rewrite::{Rewrite, atoms_of};
use super::unfactored::free_name;
use super::universe::Universe;
use super::{Part, TeamAgent, TeamTask, TeamTaskError, owned};
use crate::ast::{Action, Atom, Condition, Domain, GroundAtom, Init, Signature, Term, TypedName};
use crate::name::Name;

/// The task of the agents whose parts these are, in this order.
pub fn union(parts: &[Part]) -> Result<TeamTask, TeamTaskError> {
    let Some(first) = parts.first() else { return Err(TeamTaskError::NoAgents) };
    let mut names = BTreeSet::new();
    if let Some(twice) = parts.iter().find(|part| !names.insert(&part.agent)) {
        return Err(TeamTaskError::Twice(twice.agent.clone()));
    }
    let parts = &told_apart(parts);
    let types = typed(parts.iter().flat_map(|part| &part.domain.types));
    let objects = typed(parts.iter().flat_map(|part| &part.objects));
    let (actions, agents) = actions(parts);
    let mut requirements: Vec<Name> = Vec::new();
    for requirement in parts.iter().flat_map(|part| &part.domain.requirements) {
        if !requirements.contains(requirement) {
            requirements.push(requirement.clone());
        }
    }
    let mut task = TeamTask {
        domain: Domain {
            name: first.domain.name.clone(),
            requirements,
            types,
            constants: Vec::new(),
            predicates: signatures(parts, |domain| &domain.predicates)?,
            functions: signatures(parts, |domain| &domain.functions)?,
            actions,
            axioms: Vec::new(),
        },
        init: init(parts)?,
        goal: goal(parts),
        metric: parts.iter().find_map(|part| part.metric.clone()),
        agents,
        agentless: Vec::new(),
        objects,
    };
    for axiom in parts.iter().flat_map(|part| &part.domain.axioms) {
        if !task.domain.axioms.contains(axiom) {
            task.domain.axioms.push(axiom.clone());
        }
    }
    ask_for_knowledge(&mut task, parts);
    Ok(task)
}

/// New names for the words that two agents use privately for different things.
struct Apart {
    predicates: BTreeMap<Name, Name>,
    objects: BTreeMap<Name, Name>,
}

impl Rewrite for Apart {
    fn predicate(&self, name: &Name) -> Name {
        self.predicates.get(name).unwrap_or(name).clone()
    }

    fn term(&self, term: &Term) -> Term {
        match term {
            Term::Constant(name) => Term::Constant(self.objects.get(name).unwrap_or(name).clone()),
            variable => variable.clone(),
        }
    }
}

fn told_apart(parts: &[Part]) -> Vec<Part> {
    let objects = twice(parts.iter().flat_map(|part| &part.private_objects));
    let predicates = twice(parts.iter().flat_map(|part| &part.private_predicates));
    let predicates: BTreeSet<Name> = predicates.into_iter().filter(|p| !is_anchored(p, parts)).collect();
    parts.iter().map(|part| apart(part, &objects, &predicates)).collect()
}

fn apart(part: &Part, objects: &BTreeSet<Name>, predicates: &BTreeSet<Name>) -> Part {
    let own = |private: &BTreeSet<Name>, shared: &BTreeSet<Name>| -> BTreeMap<Name, Name> {
        let own = private.intersection(shared).filter(|name| **name != part.agent);
        own.map(|name| (name.clone(), owned(name, &part.agent))).collect()
    };
    let names = Apart {
        predicates: own(&part.private_predicates, predicates),
        objects: own(&part.private_objects, objects),
    };
    if names.predicates.is_empty() && names.objects.is_empty() {
        return part.clone();
    }
    let mut part = part.clone();
    part.domain.actions.iter_mut().for_each(|action| *action = names.body(action));
    for declared in &mut part.domain.predicates {
        declared.name = names.predicate(&declared.name);
    }
    for object in &mut part.objects {
        object.name = names.objects.get(&object.name).unwrap_or(&object.name).clone();
    }
    part.private_objects =
        part.private_objects.iter().map(|name| names.objects.get(name).unwrap_or(name).clone()).collect();
    for item in &mut part.init {
        match item {
            Init::Fact(fact) => *fact = names.ground(fact),
            Init::Value(function, _) => *function = names.ground(function),
        }
    }
    part.goal = names.condition(&part.goal);
    part
}

fn twice<'n>(names: impl Iterator<Item = &'n Name>) -> BTreeSet<Name> {
    let mut seen = BTreeSet::new();
    names.filter(|name| !seen.insert(*name)).cloned().collect()
}

/// Whether facts of the predicate always name who they belong to, in the same place in all parts: then no two
/// agents can mean the same fact.
fn is_anchored(predicate: &Name, parts: &[Part]) -> bool {
    let using = parts.iter().filter(|part| part.private_predicates.contains(predicate));
    let mut places: Option<BTreeSet<usize>> = None;
    for part in using {
        let universe = Universe::new(&part.domain.types, &part.objects);
        let is_own = |name: &Name| *name == part.agent || part.private_objects.contains(name);
        for action in &part.domain.actions {
            let actor = action.params.first().map(|param| &param.name);
            atoms_of(action, &mut |atom: &Atom, scope: &[TypedName]| {
                if atom.predicate != *predicate {
                    return;
                }
                let own = |term: &Term| match term {
                    Term::Constant(name) => is_own(name),
                    Term::Variable(name) => {
                        let bound = scope.iter().rev().find(|bound| bound.name == *name);
                        Some(name) == actor || bound.is_some_and(|b| universe.of(&b.types).all(is_own))
                    }
                };
                let here = (0..atom.args.len()).filter(|&at| own(&atom.args[at])).collect::<BTreeSet<_>>();
                places = Some(match places.take() {
                    Some(before) => before.intersection(&here).copied().collect(),
                    None => here,
                });
            });
        }
    }
    places.is_none_or(|places| !places.is_empty())
}

/// Names with all types that any part gives them, in the order of first mention.
fn typed<'t>(names: impl Iterator<Item = &'t TypedName>) -> Vec<TypedName> {
    let mut at: BTreeMap<&Name, usize> = BTreeMap::new();
    let mut all: Vec<TypedName> = Vec::new();
    for declared in names {
        let known = *at.entry(&declared.name).or_insert(all.len());
        match all.get_mut(known) {
            None => all.push(TypedName { private_to: None, ..declared.clone() }),
            Some(known) => {
                let new = declared.types.iter().filter(|name| !known.types.contains(name)).cloned();
                let new: Vec<Name> = new.collect();
                known.types.extend(new);
            }
        }
    }
    all
}

fn signatures(
    parts: &[Part],
    of: impl Fn(&Domain) -> &Vec<Signature>,
) -> Result<Vec<Signature>, TeamTaskError> {
    let mut first: BTreeMap<&Name, (&Name, &Signature)> = BTreeMap::new();
    let mut all = Vec::new();
    for (part, declared) in parts.iter().flat_map(|part| of(&part.domain).iter().map(move |s| (part, s))) {
        match first.get(&declared.name) {
            None => {
                first.insert(&declared.name, (&part.agent, declared));
                all.push(Signature { private_to: None, ..declared.clone() });
            }
            Some((one, known)) if known.params.len() != declared.params.len() => {
                return Err(TeamTaskError::Arity {
                    name: declared.name.clone(),
                    first: known.params.len(),
                    one: (*one).clone(),
                    second: declared.params.len(),
                    other: part.agent.clone(),
                });
            }
            Some(_) => {}
        }
    }
    Ok(all)
}

fn init(parts: &[Part]) -> Result<Vec<Init>, TeamTaskError> {
    let mut facts = BTreeSet::new();
    let mut values = BTreeMap::new();
    let mut all = Vec::new();
    for part in parts {
        for item in &part.init {
            let new = match item {
                Init::Fact(fact) => facts.insert(fact),
                Init::Value(function, value) => match values.insert(function, (value, &part.agent)) {
                    Some((before, one)) if before.value() != value.value() => {
                        let (one, other) = (one.clone(), part.agent.clone());
                        return Err(TeamTaskError::Value { function: function.to_string(), one, other });
                    }
                    before => before.is_none(),
                },
            };
            if new {
                all.push(item.clone());
            }
        }
    }
    Ok(all)
}

/// What anybody wants.
fn goal(parts: &[Part]) -> Condition {
    let mut all: Vec<Condition> = Vec::new();
    let mut open: Vec<&Condition> = parts.iter().rev().map(|part| &part.goal).collect();
    while let Some(condition) = open.pop() {
        match condition {
            Condition::And(conjuncts) => open.extend(conjuncts.iter().rev()),
            other if all.contains(other) => {}
            other => all.push(other.clone()),
        }
    }
    Condition::And(all)
}

/// Everybody's actions. What agents can do in the same way is one action; what only has the same name is told
/// apart.
fn actions(parts: &[Part]) -> (Vec<Action>, Vec<TeamAgent>) {
    let mut by_name: BTreeMap<&Name, Vec<&Action>> = BTreeMap::new();
    for action in parts.iter().flat_map(|part| &part.domain.actions) {
        by_name.entry(&action.name).or_default().push(action);
    }
    let mut all: Vec<Action> = Vec::new();
    let mut agents = Vec::with_capacity(parts.len());
    for part in parts {
        let mut own = Vec::with_capacity(part.domain.actions.len());
        for action in &part.domain.actions {
            let same = by_name[&action.name].iter().all(|other| *other == action);
            let name = if same { action.name.clone() } else { owned(&action.name, &part.agent) };
            if !all.iter().any(|known| known.name == name) {
                all.push(Action { name: name.clone(), agent: None, ..action.clone() });
            }
            own.push(name);
        }
        agents.push(TeamAgent { name: part.agent.clone(), actions: own });
    }
    (all, agents)
}

/// Restricts each agent's actions to the objects of its own part.
fn ask_for_knowledge(task: &mut TeamTask, parts: &[Part]) {
    let taken = task.domain.predicates.iter().map(|p| p.name.clone()).collect();
    let knows = free_name("knows", &taken);
    let universe = Universe::new(&task.domain.types, &task.objects);
    let own: Vec<Universe<'_>> =
        parts.iter().map(|part| Universe::new(&part.domain.types, &part.objects)).collect();
    let mut facts: BTreeSet<GroundAtom> = BTreeSet::new();
    for action in &mut task.domain.actions {
        let agents = || (0..parts.len()).filter(|&a| task.agents[a].actions.contains(&action.name));
        let Some(actor) = action.params.first() else { continue };
        let mut asked = Vec::new();
        for param in &action.params[1..] {
            let all: BTreeSet<&Name> = universe.of(&param.types).collect();
            let known = |a: usize| own[a].of(&param.types).collect::<BTreeSet<&Name>>();
            if agents().all(|a| known(a).len() == all.len()) {
                continue;
            }
            for a in agents() {
                let fact =
                    |object: &Name| GroundAtom::new(knows.clone(), [parts[a].agent.clone(), object.clone()]);
                facts.extend(known(a).into_iter().map(fact));
            }
            let args = [actor, param].map(|p| Term::Variable(p.name.clone())).to_vec();
            asked.push(Condition::Atom(Atom { predicate: knows.clone(), args }));
        }
        if !asked.is_empty() {
            let rest = std::mem::replace(&mut action.precondition, Condition::TRUE);
            asked.insert(0, rest);
            action.precondition = Condition::And(asked);
        }
    }
    if !facts.is_empty() {
        let param = |name: &str| TypedName { name: Name::new(name), types: Vec::new(), private_to: None };
        let params = vec![param("agent"), param("object")];
        task.domain.predicates.push(Signature { name: knows, params, private_to: None });
        task.init.extend(facts.into_iter().map(Init::Fact));
    }
}
