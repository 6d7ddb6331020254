//! The bodies of axioms as joins of facts, so that what follows from a large state is found by looking facts up,
//! not by trying all objects for all variables.
//!
//! This is deliberately not the join of `ground`: what one gets wrong, the other shall show.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use lamma_pddl::Name;
use lamma_pddl::ast::{Atom, Axiom, Condition, GroundAtom, NumericExpr, Term};

use super::Interpreter;
use super::ground::Grounder;
use super::state::{View, WorldState};

/// A body is split at its disjunctions into at most so many rules; a disjunction beyond that is looked at as a
/// whole.
const MAX_RULES: usize = 64;

const UNBOUND: u32 = u32::MAX;

/// One way for an axiom's head to hold.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub head: Name,
    /// How many of the slots, the first ones, are the head's parameters.
    params: usize,
    /// What each variable ranges over: a number among [`Objects::ranges`].
    slots: Vec<usize>,
    atoms: Vec<Pattern>,
    filters: Vec<Filter>,
}

/// An atom to look up.
#[derive(Clone, Debug)]
struct Pattern {
    predicate: Name,
    args: Vec<Arg>,
}

#[derive(Clone, Copy, Debug)]
enum Arg {
    Slot(usize),
    Object(u32),
}

/// Any other condition, with the slots of the variables it can see.
#[derive(Clone, Debug)]
struct Filter {
    condition: Condition,
    scope: Vec<(Name, usize)>,
}

/// The objects by number, and the sets of them that variables range over.
#[derive(Clone, Debug, Default)]
pub(super) struct Objects {
    names: Vec<Name>,
    ids: BTreeMap<Name, u32>,
    ranges: Vec<Range>,
}

#[derive(Clone, Debug)]
struct Range {
    types: Vec<Name>,
    members: Vec<u32>,
    contains: Vec<bool>,
}

impl Objects {
    pub fn new(interpreter: &Interpreter) -> Self {
        let names: Vec<Name> = interpreter.objects.keys().cloned().collect();
        let ids = names.iter().cloned().zip(0..).collect();
        Objects { names, ids, ranges: Vec::new() }
    }

    fn range(&mut self, interpreter: &Interpreter, types: &[Name]) -> usize {
        if let Some(known) = self.ranges.iter().position(|range| range.types == types) {
            return known;
        }
        let members: Vec<u32> = interpreter.of_types(types).iter().map(|name| self.ids[name]).collect();
        let mut contains = vec![false; self.names.len()];
        members.iter().for_each(|&member| contains[member as usize] = true);
        self.ranges.push(Range { types: types.to_vec(), members, contains });
        self.ranges.len() - 1
    }

    pub fn atom(&self, predicate: &Name, row: &[u32]) -> GroundAtom {
        let args = row.iter().map(|&object| self.names[object as usize].clone()).collect();
        GroundAtom { predicate: predicate.clone(), args }
    }
}

/// The rules whose disjunction is the axiom. Every name in it is declared and bound.
pub(super) fn rules(axiom: &Axiom, interpreter: &Interpreter, objects: &mut Objects) -> Vec<Rule> {
    let params = &axiom.head.params;
    let start = Rule {
        head: axiom.head.name.clone(),
        params: params.len(),
        slots: params.iter().map(|param| objects.range(interpreter, &param.types)).collect(),
        atoms: Vec::new(),
        filters: Vec::new(),
    };
    let scope: Vec<(Name, usize)> = params.iter().map(|param| param.name.clone()).zip(0..).collect();
    let mut finished = Vec::new();
    let mut open = vec![(start, vec![(&axiom.body, scope)])];
    while let Some((mut rule, mut agenda)) = open.pop() {
        loop {
            let Some((condition, mut scope)) = agenda.pop() else {
                finished.push(rule);
                break;
            };
            match condition {
                Condition::And(parts) => agenda.extend(parts.iter().map(|part| (part, scope.clone()))),
                Condition::Exists(params, body) => {
                    for param in params {
                        scope.push((param.name.clone(), rule.slots.len()));
                        rule.slots.push(objects.range(interpreter, &param.types));
                    }
                    agenda.push((body, scope));
                }
                Condition::Or(parts) if finished.len() + open.len() + parts.len() <= MAX_RULES => {
                    for part in parts {
                        let mut rest = agenda.clone();
                        rest.push((part, scope.clone()));
                        open.push((rule.clone(), rest));
                    }
                    break;
                }
                Condition::Atom(atom) => rule.atoms.push(pattern(atom, &scope, objects)),
                other => rule.filters.push(filter(other, scope)),
            }
        }
    }
    finished
}

/// The condition with the variables that it mentions, of those with one name the innermost.
fn filter(condition: &Condition, scope: Vec<(Name, usize)>) -> Filter {
    let mentioned = mentioned(condition);
    let mut seen = BTreeSet::new();
    let mut scope: Vec<(Name, usize)> = scope
        .into_iter()
        .rev()
        .filter(|(name, _)| mentioned.contains(name) && seen.insert(name.clone()))
        .collect();
    scope.reverse();
    Filter { condition: condition.clone(), scope }
}

/// The variables in a condition, those of its own quantifiers included.
fn mentioned(condition: &Condition) -> BTreeSet<&Name> {
    let mut found = BTreeSet::new();
    let (mut open, mut numbers, mut terms) = (vec![condition], Vec::new(), Vec::new());
    while let Some(condition) = open.pop() {
        match condition {
            Condition::And(parts) | Condition::Or(parts) => open.extend(parts),
            Condition::Not(body) | Condition::Exists(_, body) | Condition::Forall(_, body) => open.push(body),
            Condition::Imply(if_, then) => open.extend([&**if_, &**then]),
            Condition::Atom(atom) => terms.extend(&atom.args),
            Condition::Equal(left, right) => terms.extend([left, right]),
            Condition::Compare(_, left, right) => numbers.extend([left, right]),
        }
    }
    while let Some(number) = numbers.pop() {
        match number {
            NumericExpr::Number(_) => {}
            NumericExpr::Function(function) => terms.extend(&function.args),
            NumericExpr::Operation(_, parts) => numbers.extend(parts),
        }
    }
    for term in terms {
        if let Term::Variable(name) = term {
            found.insert(name);
        }
    }
    found
}

fn pattern(atom: &Atom, scope: &[(Name, usize)], objects: &Objects) -> Pattern {
    let slot = |name: &Name| scope.iter().rev().find(|(known, _)| known == name).map(|&(_, slot)| slot);
    let arg = |term: &Term| match term {
        Term::Constant(name) => Arg::Object(objects.ids[name]),
        Term::Variable(name) => Arg::Slot(slot(name).expect("scopes are checked before axioms become rules")),
    };
    Pattern { predicate: atom.predicate.clone(), args: atom.args.iter().map(arg).collect() }
}

impl Rule {
    /// Positions of atoms of these predicates.
    pub fn positions<'r>(&'r self, of: &'r BTreeSet<&Name>) -> impl Iterator<Item = usize> + 'r {
        (0..self.atoms.len()).filter(|&at| of.contains(&self.atoms[at].predicate))
    }

    /// Whether a condition that is not looked up mentions one of these predicates.
    pub fn filters_mention(&self, of: &BTreeSet<&Name>) -> bool {
        let mut mentioned = self.filters.iter().flat_map(|filter| super::axioms::mentions(&filter.condition));
        mentioned.any(|(predicate, _)| of.contains(predicate))
    }

    pub fn predicates(&self) -> impl Iterator<Item = &Name> {
        self.atoms.iter().map(|atom| &atom.predicate)
    }
}

/// The facts of one predicate.
#[derive(Default)]
struct Relation {
    rows: Vec<Vec<u32>>,
    known: HashSet<Vec<u32>>,
    /// For each position the rows with each object there.
    index: Vec<HashMap<u32, Vec<u32>>>,
    /// Rows from here on are new.
    fresh: usize,
}

/// The facts that rules look up.
#[derive(Default)]
pub(super) struct Facts {
    relations: BTreeMap<Name, Relation>,
}

impl Facts {
    /// Of the state, those of the predicates that the rules ask for.
    pub fn new<'r>(rules: impl Iterator<Item = &'r Rule>, objects: &Objects, state: &WorldState) -> Self {
        let mut facts = Facts::default();
        for predicate in rules.flat_map(Rule::predicates) {
            facts.relations.entry(predicate.clone()).or_default();
        }
        for atom in &state.facts {
            let row: Option<Vec<u32>> = atom.args.iter().map(|arg| objects.ids.get(arg).copied()).collect();
            facts.insert(&atom.predicate, row.unwrap_or_default());
        }
        facts
    }

    pub fn insert(&mut self, predicate: &Name, row: Vec<u32>) {
        let Some(relation) = self.relations.get_mut(predicate) else { return };
        if !relation.known.insert(row.clone()) {
            return;
        }
        relation.index.resize_with(row.len().max(relation.index.len()), HashMap::new);
        for (position, &object) in row.iter().enumerate() {
            relation.index[position].entry(object).or_default().push(relation.rows.len() as u32);
        }
        relation.rows.push(row);
    }

    /// What comes from now on is new.
    pub fn settle(&mut self) {
        self.relations.values_mut().for_each(|relation| relation.fresh = relation.rows.len());
    }
}

/// One rule on one set of facts.
pub(super) struct Query<'a> {
    pub interpreter: &'a Interpreter,
    pub objects: &'a Objects,
    pub facts: &'a Facts,
    pub view: &'a View<'a>,
    pub rule: &'a Rule,
}

impl Query<'_> {
    /// The heads that follow, some more than once. With `fresh`, the atom there must be a new fact.
    pub fn heads(&self, fresh: Option<usize>, found: &mut Vec<Vec<u32>>) {
        let mut binding = vec![UNBOUND; self.rule.slots.len()];
        let mut pending: Vec<usize> = (0..self.rule.atoms.len()).collect();
        if !self.filters_allow(&binding, &[]) {
            return;
        }
        if let Some(at) = fresh {
            let Some(relation) = self.facts.relations.get(&self.rule.atoms[at].predicate) else { return };
            pending.retain(|&other| other != at);
            for row in &relation.rows[relation.fresh..] {
                self.try_row(at, row, &mut pending.clone(), &mut binding, found);
            }
        } else {
            self.extend(&mut pending, &mut binding, found);
        }
    }

    fn extend(&self, pending: &mut Vec<usize>, binding: &mut [u32], found: &mut Vec<Vec<u32>>) {
        let Some(at) = self.smallest(pending, binding) else { return self.enumerate(binding, found) };
        pending.retain(|&other| other != at);
        let Some(relation) = self.facts.relations.get(&self.rule.atoms[at].predicate) else { return };
        match self.candidates(at, relation, binding) {
            Some(rows) => {
                for &row in rows {
                    self.try_row(at, &relation.rows[row as usize], pending, binding, found);
                }
            }
            None => {
                for row in &relation.rows {
                    self.try_row(at, row, pending, binding, found);
                }
            }
        }
        pending.push(at);
    }

    /// The pending atom with the fewest facts to try.
    fn smallest(&self, pending: &[usize], binding: &[u32]) -> Option<usize> {
        pending.iter().copied().min_by_key(|&at| {
            let relation = self.facts.relations.get(&self.rule.atoms[at].predicate);
            relation.map_or(0, |r| self.candidates(at, r, binding).map_or(r.rows.len(), <[u32]>::len))
        })
    }

    /// The rows that agree with what is bound in one place; `None` where nothing is bound.
    fn candidates<'r>(&self, at: usize, relation: &'r Relation, binding: &[u32]) -> Option<&'r [u32]> {
        let args = self.rule.atoms[at].args.iter().enumerate();
        let bound = args.filter_map(|(position, &arg)| {
            let object = value(arg, binding);
            let rows = relation.index.get(position).and_then(|index| index.get(&object));
            (object != UNBOUND).then(|| rows.map_or(&[][..], Vec::as_slice))
        });
        bound.min_by_key(|rows| rows.len())
    }

    fn try_row(
        &self,
        at: usize,
        row: &[u32],
        pending: &mut Vec<usize>,
        binding: &mut [u32],
        found: &mut Vec<Vec<u32>>,
    ) {
        let args = &self.rule.atoms[at].args;
        let mut trail = Vec::new();
        let agrees = args.len() == row.len()
            && args.iter().zip(row).all(|(&arg, &object)| match (arg, value(arg, binding)) {
                (Arg::Slot(slot), UNBOUND) => {
                    binding[slot] = object;
                    trail.push(slot);
                    self.objects.ranges[self.rule.slots[slot]].contains[object as usize]
                }
                (_, bound) => bound == object,
            });
        if agrees && self.filters_allow(binding, &trail) {
            self.extend(pending, binding, found);
        }
        trail.into_iter().for_each(|slot| binding[slot] = UNBOUND);
    }

    /// Lets the variables that no atom binds run over their objects.
    fn enumerate(&self, binding: &mut [u32], found: &mut Vec<Vec<u32>>) {
        let Some(slot) = binding.iter().position(|&object| object == UNBOUND) else {
            found.push(binding[..self.rule.params].to_vec());
            return;
        };
        for &object in &self.objects.ranges[self.rule.slots[slot]].members {
            binding[slot] = object;
            if self.filters_allow(binding, &[slot]) {
                self.enumerate(binding, found);
            }
        }
        binding[slot] = UNBOUND;
    }

    /// Whether the filters hold that just became closed, by binding the slots `last` (none: without any).
    fn filters_allow(&self, binding: &[u32], last: &[usize]) -> bool {
        self.rule.filters.iter().all(|filter| {
            let slots = || filter.scope.iter().map(|&(_, slot)| slot);
            let open = slots().any(|slot| binding[slot] == UNBOUND);
            let touched =
                if last.is_empty() { filter.scope.is_empty() } else { slots().any(|s| last.contains(&s)) };
            open || !touched || self.holds(filter, binding)
        })
    }

    fn holds(&self, filter: &Filter, binding: &[u32]) -> bool {
        let name = |slot: usize| self.objects.names[binding[slot] as usize].clone();
        let bindings = filter.scope.iter().map(|(variable, slot)| (variable.clone(), name(*slot))).collect();
        Grounder::new(self.interpreter, bindings).holds(&filter.condition, self.view)
    }
}

fn value(arg: Arg, binding: &[u32]) -> u32 {
    match arg {
        Arg::Slot(slot) => binding[slot],
        Arg::Object(object) => object,
    }
}
