//! Opaque names for what an agent keeps to itself.

use std::collections::BTreeMap;

use super::rewrite::Rewrite;
use super::{OF, Part, owned};
use crate::ast::{Action, Condition, Domain, Effect, Init, Problem, Term, TypedName};
use crate::name::Name;

/// What one agent's private words are called outside of it: numbers in the order of its own files. Private are
/// the objects and predicates it declares so, and the names of its actions with their parameters. What stays is
/// the *structure* of its part: whoever plans for the agent sees that there is a fourth private fact, not what
/// it means.
///
/// (Cf. the levels of privacy in Maliah, Shani & Stern, "Stronger privacy preserving projections for
/// multi-agent planning", ICAPS 2016: this is the weakest of them, and loses no plan.)
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Veil {
    predicates: BTreeMap<Name, Name>,
    objects: BTreeMap<Name, Name>,
    actions: BTreeMap<Name, Name>,
}

impl Veil {
    /// The veil of an agent. The agent's own name is public.
    pub fn of(part: &Part) -> Veil {
        let agent = &part.agent;
        let numbered = |letter: &'static str, names: Vec<&Name>| -> BTreeMap<Name, Name> {
            let opaque = |i: usize| owned(&Name::new(format!("veiled-{letter}{i}")), agent);
            names.into_iter().enumerate().map(|(i, name)| (name.clone(), opaque(i))).collect()
        };
        let predicates = part.domain.predicates.iter().map(|p| &p.name);
        let objects = part.objects.iter().map(|o| &o.name).filter(|name| *name != agent);
        Veil {
            predicates: numbered("p", predicates.filter(|n| part.private_predicates.contains(*n)).collect()),
            objects: numbered("o", objects.filter(|n| part.private_objects.contains(*n)).collect()),
            actions: numbered("a", part.domain.actions.iter().map(|a| &a.name).collect()),
        }
    }

    /// The part as the others may see it.
    pub fn over(&self, part: &Part) -> Part {
        let domain = Domain {
            predicates: part
                .domain
                .predicates
                .iter()
                .cloned()
                .map(|mut declared| {
                    declared.name = self.predicate(&declared.name);
                    declared.params.iter_mut().enumerate().for_each(|(i, p)| p.name = variable(i));
                    declared
                })
                .collect(),
            actions: part.domain.actions.iter().map(|action| self.action(action)).collect(),
            ..part.domain.clone()
        };
        let object = |object: &TypedName| TypedName { name: self.object(&object.name), ..object.clone() };
        let init = |item: &Init| match item {
            Init::Fact(fact) => Init::Fact(self.ground(fact)),
            Init::Value(function, value) => Init::Value(self.ground(function), value.clone()),
        };
        Part {
            agent: part.agent.clone(),
            domain,
            objects: part.objects.iter().map(object).collect(),
            private_objects: part.private_objects.iter().map(|name| self.object(name)).collect(),
            private_predicates: part.private_predicates.iter().map(|name| self.predicate(name)).collect(),
            init: part.init.iter().map(init).collect(),
            goal: self.condition(&part.goal),
            metric: part.metric.clone(),
        }
    }

    /// What the agent itself calls the action or object, with or without its name behind it; anything else is
    /// left as it is.
    pub fn lifted<'t>(&'t self, opaque: &'t str) -> &'t str {
        let name = Name::new(opaque);
        let all = self.actions.iter().chain(&self.objects).chain(&self.predicates);
        let is_it = |veiled: &Name| {
            *veiled == name || veiled.as_str().strip_prefix(opaque).is_some_and(|rest| rest.starts_with(OF))
        };
        all.into_iter().find(|(_, veiled)| is_it(veiled)).map_or(opaque, |(own, _)| own.as_str())
    }

    fn object(&self, name: &Name) -> Name {
        self.objects.get(name).unwrap_or(name).clone()
    }

    fn action(&self, action: &Action) -> Action {
        let renamed = Variables { veil: self, names: names_of(action) };
        let mut body = renamed.body(action);
        body.name = self.actions.get(&action.name).unwrap_or(&action.name).clone();
        body.params.iter_mut().for_each(|param| param.name = renamed.variable(&param.name));
        body
    }
}

impl Rewrite for Veil {
    fn predicate(&self, name: &Name) -> Name {
        self.predicates.get(name).unwrap_or(name).clone()
    }

    fn term(&self, term: &Term) -> Term {
        match term {
            Term::Constant(name) => Term::Constant(self.object(name)),
            variable => variable.clone(),
        }
    }
}

fn variable(number: usize) -> Name {
    Name::new(format!("v{number}"))
}

/// The variables of an action get numbers too: their names tell what they are for.
struct Variables<'v> {
    veil: &'v Veil,
    names: BTreeMap<Name, Name>,
}

impl Variables<'_> {
    fn variable(&self, name: &Name) -> Name {
        self.names.get(name).unwrap_or(name).clone()
    }
}

impl Rewrite for Variables<'_> {
    fn predicate(&self, name: &Name) -> Name {
        self.veil.predicate(name)
    }

    fn term(&self, term: &Term) -> Term {
        match term {
            Term::Variable(name) => Term::Variable(self.variable(name)),
            constant => self.veil.term(constant),
        }
    }

    fn bound(&self, names: &[TypedName]) -> Vec<TypedName> {
        names.iter().map(|b| TypedName { name: self.variable(&b.name), ..b.clone() }).collect()
    }
}

fn names_of(action: &Action) -> BTreeMap<Name, Name> {
    let mut names = BTreeMap::new();
    let mut add = |declared: &[TypedName]| {
        for variable_ in declared {
            let number = names.len();
            names.entry(variable_.name.clone()).or_insert_with(|| variable(number));
        }
    };
    add(&action.params);
    let mut conditions = vec![&action.precondition];
    let mut effects = vec![&action.effect];
    while let Some(effect) = effects.pop() {
        match effect {
            Effect::And(parts) => effects.extend(parts),
            Effect::Forall(bound, inner) => {
                add(bound);
                effects.push(inner);
            }
            Effect::When(condition, inner) => {
                conditions.push(condition);
                effects.push(inner);
            }
            Effect::Add(_) | Effect::Delete(_) | Effect::Assign(..) => {}
        }
    }
    while let Some(condition) = conditions.pop() {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => conditions.extend(parts),
            Condition::Not(inner) => conditions.push(inner),
            Condition::Imply(left, right) => conditions.extend([&**left, &**right]),
            Condition::Exists(bound, inner) | Condition::Forall(bound, inner) => {
                add(bound);
                conditions.push(inner);
            }
            Condition::Atom(_) | Condition::Equal(..) | Condition::Compare(..) => {}
        }
    }
    names
}

impl Part {
    /// The part as a problem for its domain; objects and constants stand together.
    pub fn problem(&self) -> Problem {
        Problem {
            name: Name::new("part"),
            domain: self.domain.name.clone(),
            objects: self.objects.clone(),
            init: self.init.clone(),
            goal: self.goal.clone(),
            metric: self.metric.clone(),
        }
    }
}
