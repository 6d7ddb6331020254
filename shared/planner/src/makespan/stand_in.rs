//! Objects that another can stand in for.
//!
//! A kitchen has thirty places to put an egg down, and where it does not matter which, one is enough. An object is
//! left out if, in every schedule, another can take its place: each operator that names it has a twin that names the
//! other in its stead (or can be left out altogether), and so has each literal (or nobody relies on it then). The
//! schedule of the twins is one, step for step, if for every operator `o` with its twin `o'`
//!
//! - what holds at the start and in the goal has a twin that does;
//! - what `o'` relies on is the twin of something that `o` relies on;
//! - what `o` makes true, `o'` makes true of the twin, relying on no more; or the twin follows from what `o` relies
//!   on, as the egg on the table is in reach whether or not somebody opens the cupboard;
//! - if `o'` may undo the twin of a literal, `o` may undo the literal, with no better excuses.
//!
//! So leaving the object out loses no shortest schedule, and the bound stays a bound. One robot never stands in for
//! another: an agent does one thing at a time.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use super::model::{Lit, Maker, Model};
use super::relevance::Relevance;
use crate::task::{AtomText, Task};

/// Literals looked at, at most: some tenths of a second.
const LOOKS: u64 = 4_000_000;

/// The operators that a shortest schedule may need, where objects stand in for each other.
pub(super) fn needed(task: &Task, model: &Model) -> Vec<bool> {
    let mut allowed = vec![true; model.preconditions.len()];
    let mut looks = LOOKS;
    loop {
        let relevance = Relevance::new(model, &allowed);
        // What operators do to numbers is not looked at here. And where effects have no conditions, there are so many
        // operators that looking takes longer than it saves.
        if task.has_numbers() || model.events.is_empty() {
            return relevance.operators;
        }
        let mut search = Search::new(task, model, relevance, looks);
        if !search.run() {
            return search.operators;
        }
        looks = search.looks.get();
        allowed = search.operators;
    }
}

struct Search<'a> {
    task: &'a Task,
    model: &'a Model,
    /// What is left.
    operators: Vec<bool>,
    /// What somebody may rely on.
    lits: Vec<bool>,
    /// What the operators do about such literals.
    makes: Vec<Vec<(Lit, Maker)>>,
    threatens: Vec<Vec<(Lit, &'a [Lit])>>,
    /// The operators that have to do with a literal.
    touching: BTreeMap<Lit, Vec<u32>>,
    /// The literals and the operators that name an object.
    lits_of: BTreeMap<u32, Vec<Lit>>,
    operators_of: BTreeMap<u32, Vec<u32>>,
    operator_called: BTreeMap<(u32, Vec<u32>), Vec<u32>>,
    fact_called: BTreeMap<(u32, Vec<u32>, bool), u32>,
    looks: Cell<u64>,
}

/// One object in the place of another.
struct Twins {
    from: u32,
    to: u32,
    /// For the literals that name the one: the same of the other, or none if nobody relies on that.
    of: BTreeMap<Lit, Option<Lit>>,
    /// The other way round.
    before: BTreeMap<Lit, Lit>,
}

impl Twins {
    fn of(&self, lit: Lit) -> Option<Lit> {
        self.of.get(&lit).copied().unwrap_or(Some(lit))
    }

    fn rename(&self, args: &[u32]) -> Vec<u32> {
        args.iter().map(|&arg| if arg == self.from { self.to } else { arg }).collect()
    }

    /// The literals whose twin this is.
    fn before(&self, lit: Lit) -> impl Iterator<Item = Lit> {
        let itself = (!self.of.contains_key(&lit)).then_some(lit);
        itself.into_iter().chain(self.before.get(&lit).copied())
    }
}

impl<'a> Search<'a> {
    fn new(task: &'a Task, model: &'a Model, relevance: Relevance, looks: u64) -> Self {
        let count = model.preconditions.len();
        let Relevance { operators, lits } = relevance;
        let mut search = Search {
            task,
            model,
            makes: vec![Vec::new(); count],
            threatens: vec![Vec::new(); count],
            touching: BTreeMap::new(),
            lits_of: BTreeMap::new(),
            operators_of: BTreeMap::new(),
            operator_called: BTreeMap::new(),
            fact_called: BTreeMap::new(),
            operators,
            lits,
            looks: Cell::new(looks),
        };
        for lit in (0..model.literals_count() as u32).map(Lit) {
            if search.lits[lit.index()] {
                search.literal(lit);
            }
        }
        for operator in 0..count as u32 {
            if !search.operators[operator as usize] {
                continue;
            }
            let (schema, args) = search.name(operator);
            for &arg in args.iter().collect::<BTreeSet<_>>() {
                search.operators_of.entry(arg).or_default().push(operator);
            }
            search.operator_called.entry((schema, args)).or_default().push(operator);
            let events = model.events_of[operator as usize].clone();
            let conditions = events.flat_map(|event| &model.events[event as usize].condition);
            for lit in model.preconditions.row(operator as usize).iter().chain(conditions) {
                search.touching.entry(*lit).or_default().push(operator);
            }
        }
        search
    }

    /// Takes a literal up that somebody relies on.
    fn literal(&mut self, lit: Lit) {
        let model = self.model;
        let mut touching = Vec::new();
        for &maker in &model.makers[lit.index()] {
            let operator = model.operator_of(maker);
            if self.operators[operator as usize] {
                self.makes[operator as usize].push((lit, maker));
                touching.push(operator);
            }
        }
        for threat in &model.threats[lit.index()] {
            if self.operators[threat.operator as usize] {
                self.threatens[threat.operator as usize].push((lit, &threat.harmless_if));
                touching.push(threat.operator);
            }
        }
        self.touching.insert(lit, touching);
        let Some((predicate, args, holds)) = self.atom(self.model.fact_of(lit)) else { return };
        for &arg in args.iter().collect::<BTreeSet<_>>() {
            self.lits_of.entry(arg).or_default().push(lit);
        }
        self.fact_called.insert((predicate, args, holds), self.model.fact_of(lit));
    }

    fn name(&self, operator: u32) -> (u32, Vec<u32>) {
        let operator = &self.task.operators[operator as usize];
        let (_, params) = self.task.names.schemas[operator.schema as usize];
        (
            operator.schema,
            self.task.names.args[operator.args as usize..operator.args as usize + params].to_vec(),
        )
    }

    /// The atom that a fact is about, and whether it holds.
    fn atom(&self, fact: u32) -> Option<(u32, Vec<u32>, bool)> {
        let (atom, holds) = self.task.facts.get(fact as usize)?.atom?;
        match &self.task.names.atoms[atom as usize] {
            AtomText::Condition(_) => None,
            AtomText::Atom { predicate, args } => {
                let args = self.task.names.args[args.start as usize..args.end as usize].to_vec();
                Some((*predicate, args, holds))
            }
        }
    }

    /// Leaves objects out, each that another can stand in for; whether there was one.
    fn run(&mut self) -> bool {
        let objects: Vec<u32> = self.operators_of.keys().copied().collect();
        let mut gone = BTreeSet::new();
        for &from in &objects {
            let mut others = objects.iter().filter(|&&to| to != from && !gone.contains(&to));
            if others.any(|&to| self.looks.get() > 0 && self.stands_in(from, to)) {
                gone.insert(from);
                for operator in self.operators_of.remove(&from).unwrap_or_default() {
                    self.operators[operator as usize] = false;
                }
            }
        }
        !gone.is_empty()
    }

    /// Whether `to` can stand in for `from`.
    fn stands_in(&self, from: u32, to: u32) -> bool {
        let Some(twins) = self.twins(from, to) else { return false };
        let naming: Vec<u32> =
            self.operators_of[&from].iter().copied().filter(|&o| self.operators[o as usize]).collect();
        if !naming.iter().all(|&operator| self.has_twin(operator, &twins)) || !self.derived(&twins) {
            return false;
        }
        let lits = twins.of.keys().chain(twins.before.keys());
        let concerned: BTreeSet<u32> = lits.flat_map(|lit| self.touching[lit].iter().copied()).collect();
        concerned.into_iter().all(|operator| {
            !self.operators[operator as usize]
                || naming.binary_search(&operator).is_ok()
                || self.is_own_twin(operator, &twins)
        })
    }

    /// The literals that correspond; `None` if start and goal do not.
    fn twins(&self, from: u32, to: u32) -> Option<Twins> {
        let model = self.model;
        let mut twins = Twins { from, to, of: BTreeMap::new(), before: BTreeMap::new() };
        let lits = self.lits_of.get(&from).map_or(&[][..], Vec::as_slice);
        self.looks.set(self.looks.get().saturating_sub(lits.len() as u64 + 1));
        for &lit in lits {
            if model.goal.contains(&lit) {
                return None;
            }
            let fact = model.fact_of(lit);
            let (predicate, args, holds) = self.atom(fact)?;
            let twin = self.fact_called.get(&(predicate, twins.rename(&args), holds));
            let twin = twin.map(|&twin| Lit(twin + lit.0 - fact)).filter(|twin| self.lits[twin.index()]);
            if let Some(twin) = twin {
                if model.initially[lit.index()] && !model.initially[twin.index()] {
                    return None;
                }
                if !model.alike(lit, twin) || twins.before.insert(twin, lit).is_some() {
                    return None;
                }
            }
            twins.of.insert(lit, twin);
        }
        Some(twins)
    }

    /// Whether what is derived from literals follows from their twins.
    fn derived(&self, twins: &Twins) -> bool {
        let follows = |head: Lit, body: &Vec<Lit>| {
            if !twins.of.contains_key(&head) && !body.iter().any(|lit| twins.of.contains_key(lit)) {
                return true;
            }
            let Some(head) = twins.of(head) else { return true };
            let given: Vec<Lit> = body.iter().filter_map(|&lit| twins.of(lit)).collect();
            let bodies = self.model.derivations.get(&head.0).into_iter().flatten();
            bodies.into_iter().any(|body| body.iter().all(|lit| given.contains(lit)))
        };
        let derivations = self.model.derivations.iter().map(|(&head, bodies)| (Lit(head), bodies));
        derivations
            .filter(|(head, _)| self.lits[head.index()])
            .all(|(head, bodies)| bodies.iter().all(|body| follows(head, body)))
    }

    /// Whether another operator, or none, does for the twins what this one does, which names the object.
    fn has_twin(&self, operator: u32, twins: &Twins) -> bool {
        let (schema, args) = self.name(operator);
        let called = self.operator_called.get(&(schema, twins.rename(&args))).map_or(&[][..], Vec::as_slice);
        let left = called.iter().copied().filter(|&twin| self.operators[twin as usize]);
        left.map(Some).chain([None]).any(|twin| {
            self.makes[operator as usize].iter().all(|&made| self.makes_twin(operator, made, twin, twins))
                && twin.is_none_or(|twin| self.asks_no_more(operator, twin, twins))
        })
    }

    /// Whether the operator does for the twins what it does itself, where it does not name the object.
    fn is_own_twin(&self, operator: u32, twins: &Twins) -> bool {
        let model = self.model;
        let renamed = |lit: &Lit| twins.of.contains_key(lit);
        let other = |&&(lit, maker): &&(Lit, Maker)| {
            let condition = self.condition(maker).iter().chain(model.preconditions.row(operator as usize));
            renamed(&lit) || condition.into_iter().any(renamed)
        };
        let makes = &self.makes[operator as usize];
        let threatens = &self.threatens[operator as usize];
        let looks = self.looks.get().saturating_sub((makes.len() + threatens.len()) as u64);
        self.looks.set(looks);
        let threatened = |&&(lit, excuses): &&(Lit, &[Lit])| {
            twins.before.contains_key(&lit) || excuses.iter().any(renamed)
        };
        makes.iter().filter(other).all(|&made| self.makes_twin(operator, made, Some(operator), twins))
            && model.preconditions.row(operator as usize).iter().all(|lit| !renamed(lit))
            && threatens.iter().filter(threatened).all(|&threat| self.is_warned(operator, threat, twins))
    }

    /// What an event asks for beyond its operator's precondition.
    fn condition(&self, maker: Maker) -> &'a [Lit] {
        match maker {
            Maker::Operator(_) => &[],
            Maker::Event(event) => &self.model.events[event as usize].condition,
        }
    }

    /// Whether the twin of what an operator makes true is made true by the operator's twin, or is true anyway.
    fn makes_twin(
        &self,
        operator: u32,
        (lit, maker): (Lit, Maker),
        twin: Option<u32>,
        twins: &Twins,
    ) -> bool {
        let Some(made) = twins.of(lit) else { return true };
        let before = self.model.preconditions.row(operator as usize);
        let given: Vec<Lit> =
            self.condition(maker).iter().chain(before).filter_map(|&lit| twins.of(lit)).collect();
        self.looks.set(self.looks.get().saturating_sub(given.len() as u64 + 1));
        let does = |&(_, by): &(Lit, Maker)| self.condition(by).iter().all(|lit| given.contains(lit));
        twin.is_some_and(|twin| about(&self.makes[twin as usize], made).iter().any(does))
            || given.iter().any(|&lit| self.implies(lit, made))
    }

    /// Whether the twin relies on no more than the operator, and undoes no more.
    fn asks_no_more(&self, operator: u32, twin: u32, twins: &Twins) -> bool {
        let model = self.model;
        let before = model.preconditions.row(operator as usize);
        let given = |lit: &Lit| before.iter().any(|&l| twins.of(l) == Some(*lit));
        model.agent_of[twin as usize] == model.agent_of[operator as usize]
            && model.preconditions.row(twin as usize).iter().all(given)
            && self.threatens[twin as usize].iter().all(|&threat| self.is_warned(operator, threat, twins))
    }

    /// Whether the operator may undo all that has this twin, if its own twin may undo that.
    fn is_warned(&self, operator: u32, (lit, excuses): (Lit, &[Lit]), twins: &Twins) -> bool {
        self.looks.set(self.looks.get().saturating_sub(1));
        twins.before(lit).all(|lit| self.threatens_too(operator, lit, excuses, twins))
    }

    /// Whether the operator may undo the literal, with excuses whose twins are among these, or can have nothing to
    /// do with it.
    fn threatens_too(&self, operator: u32, lit: Lit, excuses: &[Lit], twins: &Twins) -> bool {
        let no_better = |own: &[Lit]| own.iter().all(|&l| twins.of(l).is_some_and(|l| excuses.contains(&l)));
        about(&self.threatens[operator as usize], lit).iter().any(|(_, own)| no_better(own))
            || self.is_elsewhere(operator, lit)
    }

    /// Whether the operator relies on another value of the literal's variable, and does not make the literal.
    fn is_elsewhere(&self, operator: u32, lit: Lit) -> bool {
        self.model.preconditions.row(operator as usize).iter().any(|&l| self.model.excludes(l, lit))
            && about(&self.makes[operator as usize], lit).is_empty()
    }

    /// Whether the one never holds without the other: so it is at the start, whoever makes the one makes the other,
    /// and whoever may undo the other may undo the one.
    fn implies(&self, one: Lit, other: Lit) -> bool {
        let model = self.model;
        let cost = self.touching[&one].len() + self.touching[&other].len();
        self.looks.set(self.looks.get().saturating_sub(cost as u64));
        if one == other {
            return true;
        }
        if model.is_derived(one) || model.is_derived(other) || model.is_one_of_many(other) {
            return false;
        }
        if model.initially[one.index()] && !model.initially[other.index()] {
            return false;
        }
        let makers: Vec<Maker> = model.makers[one.index()]
            .iter()
            .copied()
            .filter(|&maker| self.operators[model.operator_of(maker) as usize])
            .collect();
        let threatens = |operator: u32, lit: Lit| {
            about(&self.threatens[operator as usize], lit).iter().map(|(_, excuses)| *excuses)
        };
        let also = |maker: &Maker| {
            let operator = model.operator_of(*maker);
            about(&self.makes[operator as usize], other).contains(&(other, *maker))
                && (matches!(maker, Maker::Event(_)) || threatens(operator, other).next().is_none())
        };
        // A value other than this one, which nothing that makes this one comes from.
        let left_behind = |excuse: Lit| {
            let value = model.denied(excuse);
            value.is_some_and(|value| {
                model.excludes(value, one)
                    && makers.iter().all(|&maker| {
                        let before = model.preconditions.row(model.operator_of(maker) as usize);
                        before.iter().any(|&l| model.excludes(l, one) && l != value)
                    })
            })
        };
        makers.iter().all(also)
            && self.touching[&other].iter().filter(|&&o| self.operators[o as usize]).all(|&operator| {
                threatens(operator, other).all(|excuses| {
                    threatens(operator, one).any(|own| own.iter().all(|l| excuses.contains(l)))
                        || model.is_one_of_many(one) && self.is_elsewhere(operator, one)
                        || excuses.iter().any(|&excuse| left_behind(excuse))
                })
            })
    }
}

/// What a list in order of literals says about one.
fn about<T>(list: &[(Lit, T)], lit: Lit) -> &[(Lit, T)] {
    let start = list.partition_point(|(l, _)| *l < lit);
    let end = start + list[start..].partition_point(|(l, _)| *l == lit);
    &list[start..end]
}

#[cfg(test)]
mod tests;
