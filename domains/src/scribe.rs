//! Writes one group of a goal: entries that speak of the same objects.

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::Name;
use lamma_pddl::ast::{Atom, Condition, Term, TypedName};

use crate::condition::{GoalFact, GoalGroup};
use crate::goal::{Content, GoalEntry, PropertyValue};
use crate::goal_error::{GoalProblem, GoalProblemKind};
use crate::kinds::Kinds;
use crate::property::Property;
use crate::resolve::{Candidates, is_a, resolve};
use crate::world::{Thing, WorldSetup};

/// How deep contents may be nested in a goal: deeper than any nesting of the world.
const MAX_DEPTH: usize = 6;

/// An object of the goal: one of the world, or a variable over those of a type.
#[derive(Clone)]
struct Meant {
    term: Term,
    kind: String,
    label: String,
}

/// A fact with its variables still free.
struct Draft {
    text: String,
    condition: Condition,
}

/// The group so far.
pub(crate) struct Scribe<'a> {
    setup: &'a WorldSetup,
    variables: Vec<TypedName>,
    marks: BTreeMap<String, Meant>,
    facts: Vec<Draft>,
    /// Pairs of objects that must differ.
    distinct: Vec<(Term, Term)>,
    pub(crate) problems: Vec<GoalProblem>,
}

impl<'a> Scribe<'a> {
    pub(crate) fn new(setup: &'a WorldSetup) -> Self {
        Scribe {
            setup,
            variables: Vec::new(),
            marks: BTreeMap::new(),
            facts: Vec::new(),
            distinct: Vec::new(),
            problems: Vec::new(),
        }
    }

    /// An entry at the top of the goal.
    pub(crate) fn entry(&mut self, entry: &GoalEntry, path: &str) {
        if entry.contains.is_empty() && entry.is.is_empty() {
            self.problems.push(GoalProblem::malformed(path, "says nothing; give `contains` or `is`"));
        }
        if entry.all {
            self.every(entry, path, |scribe, one, path| {
                if let Some(meant) = scribe.bind(one, path) {
                    scribe.describe(&meant, one, path, 0);
                }
            });
        } else if let Some(meant) = self.bind(entry, path) {
            self.describe(&meant, entry, path, 0);
        }
    }

    /// Does the same for each object of the type and makes one fact of each of the facts it gets.
    fn every(&mut self, entry: &GoalEntry, path: &str, mut each: impl FnMut(&mut Self, &GoalEntry, &str)) {
        if entry.same.is_some() {
            let what = "`same` is about one object, `all` about several; use one of them";
            self.problems.push(GoalProblem::malformed(path, what));
            return;
        }
        let Some(candidates) = self.candidates(entry, path) else { return };
        let mut merged: Vec<(String, Vec<Condition>)> = Vec::new();
        for thing in &candidates.things {
            let one = GoalEntry { object: thing.name.clone(), all: false, ..entry.clone() };
            let start = self.facts.len();
            each(self, &one, path);
            for (index, fact) in self.facts.drain(start..).enumerate() {
                if index == merged.len() {
                    let text = fact.text.replace(&thing.name, &format!("every {}", candidates.kind));
                    merged.push((text, Vec::new()));
                }
                merged[index].1.push(fact.condition);
            }
            if !self.problems.is_empty() {
                return;
            }
        }
        let fact = |(text, parts)| Draft { text, condition: Condition::And(parts) };
        self.facts.extend(merged.into_iter().map(fact));
    }

    /// The object the entry is about.
    fn bind(&mut self, entry: &GoalEntry, path: &str) -> Option<Meant> {
        let candidates = self.candidates(entry, path)?;
        if let Some(known) = entry.same.as_ref().and_then(|mark| self.marks.get(mark)).cloned() {
            if known.kind != candidates.kind {
                let what =
                    format!("`same` ties a {} to a {}; one object has one type", known.kind, candidates.kind);
                self.problems.push(GoalProblem::malformed(path, &what));
                return None;
            }
            return Some(known);
        }
        let term = match candidates.things.as_slice() {
            [one] => Term::Constant(Name::new(&one.name)),
            _ => {
                let kind = candidates.kind;
                let name = format!("{}{}", kind.to_ascii_lowercase(), self.variables.len() + 1);
                self.variables.push(TypedName::new(name.as_str(), kind));
                Term::Variable(Name::new(name))
            }
        };
        let meant = Meant { term, kind: candidates.kind.to_string(), label: candidates.label };
        if let Some(mark) = &entry.same {
            self.marks.insert(mark.clone(), meant.clone());
        }
        Some(meant)
    }

    /// The objects the entry can be about, given what it says of them.
    fn candidates(&mut self, entry: &GoalEntry, path: &str) -> Option<Candidates<'a>> {
        let found = self.find(entry, path);
        found.map_err(|problem| self.problems.push(problem)).ok()
    }

    fn find(&mut self, entry: &GoalEntry, path: &str) -> Result<Candidates<'a>, GoalProblem> {
        let impossible = |what: String| GoalProblem::new(GoalProblemKind::Impossible, path, what);
        let mut candidates = resolve(self.setup, &entry.object, path)?;
        for (name, value) in &entry.is {
            let unknown = |what: String| GoalProblem::new(GoalProblemKind::Unknown, path, what);
            let property = Property::parse(name).map_err(unknown)?;
            property.check_value(value).map_err(unknown)?;
            let has = |thing: &Thing| property.applies(&thing.kind, |a| thing.can(a));
            candidates = candidates.retain(has, |c| impossible(format!("a {} has no `{name}`", c.kind)))?;
        }
        if !entry.contains.is_empty() {
            let holds = |thing: &Thing| thing.can("receptacle");
            candidates = candidates.retain(holds, |c| impossible(format!("a {} holds nothing", c.kind)))?;
        }
        Ok(candidates)
    }

    /// What the entry says of its object.
    fn describe(&mut self, meant: &Meant, entry: &GoalEntry, path: &str, depth: usize) {
        for (name, value) in &entry.is {
            if let Ok(property) = Property::parse(name) {
                let text = format!("{} {}", meant.label, words(property, value));
                let condition = property.condition(&meant.term, value);
                self.facts.push(Draft { text, condition });
            }
        }
        if depth >= MAX_DEPTH {
            let what = format!("is nested more than {MAX_DEPTH} deep");
            self.problems.push(GoalProblem::malformed(path, &what));
            return;
        }
        let mut inside: Vec<Meant> = Vec::new();
        for (index, content) in entry.contains.iter().enumerate() {
            let path = format!("{path}.contains[{index}]");
            let named;
            let inner = match content {
                Content::Named(object) => {
                    named = GoalEntry { object: object.clone(), ..GoalEntry::default() };
                    &named
                }
                Content::With(inner) => inner.as_ref(),
            };
            if inner.all {
                self.every(inner, &path, |scribe, one, path| {
                    scribe.content(meant, one, path, depth, &mut Vec::new());
                });
            } else {
                self.content(meant, inner, &path, depth, &mut inside);
            }
        }
    }

    /// That the container holds this, and what is said of it.
    fn content(
        &mut self,
        container: &Meant,
        inner: &GoalEntry,
        path: &str,
        depth: usize,
        inside: &mut Vec<Meant>,
    ) {
        let Some(meant) = self.bind(inner, path) else { return };
        if !self.takes(container, &meant) {
            let what = format!("a {} does not take a {}", container.kind, meant.kind);
            self.problems.push(GoalProblem::new(GoalProblemKind::Impossible, path, what));
            return;
        }
        let like: Vec<Meant> = inside
            .iter()
            .filter(|other| is_a(&other.kind, &meant.kind) || is_a(&meant.kind, &other.kind))
            .cloned()
            .collect();
        if like.iter().any(|other| other.term == meant.term && matches!(meant.term, Term::Constant(_))) {
            let what = format!("asks for a second {}, but {} has one", meant.kind, self.setup.scene);
            self.problems.push(GoalProblem::new(GoalProblemKind::Absent, path, what));
            return;
        }
        let holds = |x: &Meant| {
            let args = vec![x.term.clone(), container.term.clone()];
            Condition::Atom(Atom { predicate: Name::new("in"), args })
        };
        // "Another apple" is there when two are: alone it would be the first one again.
        let mut parts: Vec<Condition> = like.iter().map(holds).collect();
        parts.push(holds(&meant));
        for other in &like {
            parts.push(different(&other.term, &meant.term));
            self.distinct.push((other.term.clone(), meant.term.clone()));
        }
        let another = if like.is_empty() { "" } else { "another " };
        let text = format!("{} contains {another}{}", container.label, meant.label);
        let condition = if parts.len() == 1 { holds(&meant) } else { Condition::And(parts) };
        self.facts.push(Draft { text, condition });
        inside.push(meant.clone());
        self.describe(&meant, inner, path, depth + 1);
    }

    /// Whether any container of that kind takes any thing of the other.
    fn takes(&self, container: &Meant, meant: &Meant) -> bool {
        let kinds = Kinds::get();
        let any = |asked: &str, kind: &str| is_a(kind, asked);
        let containers = self.setup.things.iter().filter(|t| any(&container.kind, &t.kind));
        let mut containers = containers.filter(|t| t.can("receptacle"));
        containers.any(|t| kinds.accepts(&t.kind, &meant.kind) || kinds.accepts_cut(&t.kind, &meant.kind))
    }

    /// The group, each variable bound where it is used.
    pub(crate) fn finish(self) -> (GoalGroup, Vec<GoalProblem>) {
        let mut parts: Vec<Condition> = Vec::new();
        for fact in &self.facts {
            flatten(&fact.condition, &mut parts);
        }
        parts.extend(self.distinct.iter().map(|(a, b)| different(a, b)));
        let mut unique: Vec<Condition> = Vec::new();
        for part in parts {
            if !unique.contains(&part) {
                unique.push(part);
            }
        }
        let joint = close(&self.variables, conjunction(unique));
        let facts = self
            .facts
            .into_iter()
            .map(|d| GoalFact { text: d.text, condition: close(&self.variables, d.condition) })
            .collect();
        (GoalGroup { facts, joint }, self.problems)
    }
}

fn different(a: &Term, b: &Term) -> Condition {
    Condition::Not(Box::new(Condition::Equal(a.clone(), b.clone())))
}

fn conjunction(mut parts: Vec<Condition>) -> Condition {
    match (parts.len(), parts.pop()) {
        (1, Some(one)) => one,
        (_, last) => {
            parts.extend(last);
            Condition::And(parts)
        }
    }
}

fn flatten(condition: &Condition, into: &mut Vec<Condition>) {
    match condition {
        Condition::And(parts) => parts.iter().for_each(|p| flatten(p, into)),
        other => into.push(other.clone()),
    }
}

/// Some objects of the variables' types make the condition true.
fn close(variables: &[TypedName], condition: Condition) -> Condition {
    let mut used = BTreeSet::new();
    names(&condition, &mut used);
    let bound: Vec<TypedName> = variables.iter().filter(|v| used.contains(&v.name)).cloned().collect();
    if bound.is_empty() { condition } else { Condition::Exists(bound, Box::new(condition)) }
}

/// Every variable named in a condition of the shapes written here.
fn names(condition: &Condition, into: &mut BTreeSet<Name>) {
    let mut term = |t: &Term| {
        if let Term::Variable(name) = t {
            into.insert(name.clone());
        }
    };
    match condition {
        Condition::Atom(atom) => atom.args.iter().for_each(term),
        Condition::Equal(a, b) => [a, b].into_iter().for_each(&mut term),
        Condition::And(parts) | Condition::Or(parts) => parts.iter().for_each(|p| names(p, into)),
        Condition::Not(inner) | Condition::Exists(_, inner) | Condition::Forall(_, inner) => {
            names(inner, into);
        }
        Condition::Imply(a, b) => [a, b].into_iter().for_each(|c| names(c, into)),
        Condition::Compare(..) => {}
    }
}

/// A property and its value for people.
fn words(property: Property, value: &PropertyValue) -> String {
    let yes = value == &PropertyValue::Flag(true);
    let not = if yes { "is" } else { "is not" };
    match (property, value) {
        (Property::Open, _) => if yes { "is open" } else { "is closed" }.to_string(),
        (Property::Toggled, _) => if yes { "is on" } else { "is off" }.to_string(),
        (Property::Dirty, _) => if yes { "is dirty" } else { "is clean" }.to_string(),
        (Property::Sliced, _) => format!("{not} sliced"),
        (Property::Cooked, _) => format!("{not} cooked"),
        (Property::Broken, _) => format!("{not} broken"),
        (Property::UsedUp, _) => format!("{not} used up"),
        (Property::PickedUp, _) => format!("{not} held"),
        (Property::Filled, _) => format!("{not} filled"),
        (Property::FillLiquid, PropertyValue::Word(word)) => format!("is filled with {word}"),
        (Property::Temperature, PropertyValue::Word(word)) => match word.as_str() {
            "Hot" => "is hot".to_string(),
            "Cold" => "is cold".to_string(),
            _ => "is at room temperature".to_string(),
        },
        _ => property.name().to_string(),
    }
}
