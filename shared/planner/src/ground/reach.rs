//! What can be reached when deletes are ignored: the fixpoint of the task's rules, computed fact by fact
//! (semi-naive; Helmert 2009, section 6.3).

use std::collections::{BTreeMap, VecDeque};

use super::join::{Join, Trigger};
use super::relation::Relation;
use super::relevance::Filters;
use super::{GroundError, GroundLimits};
use crate::lifted::{Body, Change, Head, Lifted, LiftedAtom, Role, Term};

/// The fixpoint.
pub(crate) struct Reached {
    /// The facts of each predicate.
    pub relations: Vec<Relation>,
    /// For each rule its instances, as values of the body's bound variables, one after the other.
    pub instances: Vec<Vec<u32>>,
    /// How many instances each rule has.
    pub counts: Vec<usize>,
}

/// Computes the fixpoint, of the instances that the filters let pass.
pub(crate) fn reach(
    lifted: &Lifted,
    filters: &Filters,
    limits: &GroundLimits<'_>,
) -> Result<Reached, GroundError> {
    let mut fixpoint = Fixpoint::new(lifted, filters, limits);
    fixpoint.load();
    for rule in 0..lifted.rules.len() {
        if !fixpoint.is_late(rule) && fixpoint.first_changing_atom(rule).is_none() {
            fixpoint.fire(rule, None)?;
        }
    }
    while let Some((predicate, row)) = fixpoint.queue.pop_front() {
        fixpoint.relations[predicate as usize].show_next(&lifted.symbols.ranges);
        fixpoint.trigger(predicate, row)?;
    }
    for rule in 0..lifted.rules.len() {
        if fixpoint.is_late(rule) {
            fixpoint.fire(rule, None)?;
        }
    }
    let Fixpoint { relations, instances, counts, .. } = fixpoint;
    Ok(Reached { relations, instances, counts })
}

/// Where a predicate occurs in bodies: rule and position. Domains written for one problem name its objects
/// in most places, and a fact about others then need not look at them.
#[derive(Clone, Default)]
struct Occurrences {
    /// Occurrences without constants.
    anywhere: Vec<(u32, u32)>,
    /// The others by their first constant: which argument, and the object.
    with_constant: BTreeMap<(u32, u32), Vec<(u32, u32)>>,
}

impl Occurrences {
    fn add(&mut self, atom: &LiftedAtom, place: (u32, u32)) {
        let constant = atom.args.iter().enumerate().find_map(|(at, term)| match term {
            Term::Object(object) => Some((at as u32, *object)),
            Term::Variable(_) => None,
        });
        match constant {
            Some(key) => self.with_constant.entry(key).or_default().push(place),
            None => self.anywhere.push(place),
        }
    }
}

/// What a fact takes in tables and queue.
const WORDS_A_FACT: usize = 6;

struct Fixpoint<'a> {
    lifted: &'a Lifted,
    filters: &'a Filters,
    limits: &'a GroundLimits<'a>,
    relations: Vec<Relation>,
    instances: Vec<Vec<u32>>,
    counts: Vec<usize>,
    /// For each rule the views that the atoms of its body look at.
    views: Vec<Vec<u32>>,
    /// Where each predicate occurs.
    triggers: Vec<Occurrences>,
    queue: VecDeque<(u32, u32)>,
    facts: usize,
    total: usize,
    /// Words of instances and facts.
    words: usize,
    steps_left: u64,
    binding: Vec<u32>,
    found: Vec<u32>,
    pending: Vec<usize>,
    trail: Vec<u32>,
}

impl<'a> Fixpoint<'a> {
    fn new(lifted: &'a Lifted, filters: &'a Filters, limits: &'a GroundLimits<'a>) -> Self {
        let symbols = &lifted.symbols;
        let objects = symbols.objects.len();
        let mut fixpoint = Fixpoint {
            lifted,
            filters,
            limits,
            relations: symbols.predicates.iter().map(|p| Relation::new(p.arity, objects)).collect(),
            instances: vec![Vec::new(); lifted.rules.len()],
            counts: vec![0; lifted.rules.len()],
            views: Vec::with_capacity(lifted.rules.len()),
            triggers: vec![Occurrences::default(); symbols.predicates.len()],
            queue: VecDeque::new(),
            facts: 0,
            total: 0,
            words: 0,
            steps_left: limits.steps,
            binding: Vec::new(),
            found: Vec::new(),
            pending: Vec::new(),
            trail: Vec::new(),
        };
        for rule in &lifted.rules {
            let views = rule.body.atoms.iter().map(|atom| fixpoint.view(&rule.body, atom)).collect();
            fixpoint.views.push(views);
        }
        for (index, rule) in lifted.rules.iter().enumerate() {
            if fixpoint.is_late(index) || fixpoint.is_idle(index) {
                continue;
            }
            for (position, atom) in rule.body.atoms.iter().enumerate() {
                if fixpoint.changes(atom.predicate) {
                    fixpoint.triggers[atom.predicate as usize].add(atom, (index as u32, position as u32));
                }
            }
        }
        fixpoint
    }

    /// The view of the rows that can match an atom of a body: its variables' ranges.
    fn view(&mut self, body: &Body, atom: &LiftedAtom) -> u32 {
        let symbols = &self.lifted.symbols;
        let kinds = atom.args.iter().map(|term| match term {
            Term::Object(_) => None,
            Term::Variable(slot) => {
                let range = body.variables[*slot as usize];
                let all = symbols.ranges[range as usize].members.len() == symbols.objects.len();
                (!all).then_some(range)
            }
        });
        self.relations[atom.predicate as usize].view(kinds.collect())
    }

    fn changes(&self, predicate: u32) -> bool {
        self.lifted.symbols.predicates[predicate as usize].role != Role::Static
    }

    /// Rules that reach no fact are joined once, at the end.
    fn is_late(&self, rule: usize) -> bool {
        match self.lifted.rules[rule].head {
            Head::Effect { action, effect } => !matches!(
                self.lifted.schemas[action as usize].conditional[effect as usize].change,
                Change::Add(_)
            ),
            Head::Act { .. } | Head::Derived(_) => false,
        }
    }

    fn first_changing_atom(&self, rule: usize) -> Option<usize> {
        self.lifted.rules[rule].body.atoms.iter().position(|atom| self.changes(atom.predicate))
    }

    fn load(&mut self) {
        for (predicate, args) in &self.lifted.init {
            let relation = &mut self.relations[*predicate as usize];
            let Some(row) = relation.insert(args) else { continue };
            if self.lifted.symbols.predicates[*predicate as usize].role == Role::Static {
                relation.show_next(&self.lifted.symbols.ranges);
            } else {
                self.queue.push_back((*predicate, row));
            }
        }
    }

    /// Fires the rules that a fact, shown just now, can take part in.
    fn trigger(&mut self, predicate: u32, row: u32) -> Result<(), GroundError> {
        let occurrences = std::mem::take(&mut self.triggers[predicate as usize]);
        let arity = self.lifted.symbols.predicates[predicate as usize].arity;
        let result = (0..=arity).try_for_each(|argument| {
            let places = match argument.checked_sub(1) {
                None => &occurrences.anywhere,
                Some(at) => {
                    let object = self.relations[predicate as usize].row(row)[at];
                    occurrences.with_constant.get(&(at as u32, object)).unwrap_or(const { &Vec::new() })
                }
            };
            places.iter().try_for_each(|&(rule, position)| {
                self.fire(rule as usize, Some(Trigger { position: position as usize, predicate, row }))
            })
        });
        self.triggers[predicate as usize] = occurrences;
        result
    }

    /// Whether no instance of the rule matters.
    fn is_idle(&self, rule: usize) -> bool {
        self.filters[rule].as_ref().is_some_and(Vec::is_empty)
    }

    fn fire(&mut self, index: usize, trigger: Option<Trigger>) -> Result<(), GroundError> {
        if self.is_idle(index) {
            return Ok(());
        }
        let rule = &self.lifted.rules[index];
        let width = rule.body.bound.len();
        let mut found = std::mem::take(&mut self.found);
        found.clear();
        // A rule over no variables has one instance at most.
        let room = self.limits.instances + 1 - self.total;
        let max_count = if width == 0 { 1 - self.counts[index].min(1) } else { room };
        let mut join = Join {
            symbols: &self.lifted.symbols,
            relations: &self.relations,
            body: &rule.body,
            filter: self.filters[index].as_deref(),
            views: &self.views[index],
            binding: &mut self.binding,
            found: &mut found,
            pending: &mut self.pending,
            trail: &mut self.trail,
            count: 0,
            max_count,
            steps_left: self.steps_left,
            stopped: None,
            limits: self.limits,
        };
        join.run(trigger);
        if let Some(stopped) = join.stopped.take() {
            return Err(stopped);
        }
        let count = join.count;
        self.steps_left = join.steps_left;
        self.counts[index] += count;
        self.total += count;
        if self.total > self.limits.instances {
            return Err(GroundError::TooLarge {
                what: "instances of actions, effects and axioms",
                limit: self.limits.instances as u64,
            });
        }
        if self.steps_left == 0 {
            return Err(GroundError::TooLarge { what: "steps of joining facts", limit: self.limits.steps });
        }
        self.conclude(index, &found, count);
        self.instances[index].extend_from_slice(&found);
        self.words += found.len();
        self.found = found;
        self.limits.check_memory(self.words * size_of::<u32>())?;
        if self.facts > self.limits.facts {
            return Err(GroundError::TooLarge { what: "reachable facts", limit: self.limits.facts as u64 });
        }
        Ok(())
    }

    /// Adds what the instances in `found` reach.
    fn conclude(&mut self, index: usize, found: &[u32], count: usize) {
        let lifted = self.lifted;
        let rule = &lifted.rules[index];
        let width = rule.body.bound.len();
        let mut args = Vec::new();
        for instance in 0..count {
            let values = &found[instance * width..(instance + 1) * width];
            let value = |term: &Term| match term {
                Term::Object(object) => *object,
                Term::Variable(slot) => {
                    // An action's parameters come first and in order; others are looked up.
                    match rule.body.bound.get(*slot as usize) {
                        Some(at) if at == slot => values[*slot as usize],
                        _ => rule.body.bound.iter().position(|b| b == slot).map_or(0, |at| values[at]),
                    }
                }
            };
            match &rule.head {
                Head::Act { action } => {
                    let schema = &lifted.schemas[*action as usize];
                    for applied in &schema.applied {
                        applied.args(values, &mut args);
                        self.add(applied.predicate, &args);
                    }
                    for change in &schema.effects {
                        if let Change::Add(atom) = change {
                            self.add_atom(atom, &value);
                        }
                    }
                }
                Head::Effect { action, effect } => {
                    let schema = &lifted.schemas[*action as usize];
                    if let Change::Add(atom) = &schema.conditional[*effect as usize].change {
                        self.add_atom(atom, &value);
                    }
                }
                Head::Derived(atom) => self.add_atom(atom, &value),
            }
        }
    }

    fn add_atom(&mut self, atom: &LiftedAtom, value: &impl Fn(&Term) -> u32) {
        let mut args = [0u32; 16];
        if atom.args.len() <= args.len() {
            for (arg, term) in args.iter_mut().zip(&atom.args) {
                *arg = value(term);
            }
            self.add(atom.predicate, &args[..atom.args.len()]);
        } else {
            let args: Vec<u32> = atom.args.iter().map(value).collect();
            self.add(atom.predicate, &args);
        }
    }

    fn add(&mut self, predicate: u32, args: &[u32]) {
        if let Some(row) = self.relations[predicate as usize].insert(args) {
            self.facts += 1;
            self.words += WORDS_A_FACT + args.len() * 2;
            self.queue.push_back((predicate, row));
        }
    }
}
