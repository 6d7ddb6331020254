//! Mutex groups: sets of atoms of which at most one ever holds, such as the places of one truck.
//!
//! Candidates are lifted as in Helmert 2009 ("Concise finite-domain representations for PDDL planning
//! tasks", section 5): predicates that share key arguments, each with at most one counted argument. Unlike
//! there, a candidate is checked on the ground operators: every operator that adds an atom of a group
//! deletes another one of it that it asked for, or all others. One that fails is refined by what the operator
//! deletes.

use std::collections::{BTreeSet, BinaryHeap, VecDeque};

use super::propositional::{AtomName, Ground, GroundOperator, Lit};
use super::relation::Relation;
use super::{GroundError, GroundLimits};
use crate::id_table::{IdTable, Slot, hash_words};

/// At most so many candidates are looked at.
const MAX_CANDIDATES: usize = 300;
const NONE: u32 = u32::MAX;

/// A predicate's part in a candidate: which arguments are the key, in the candidate's order. At most one
/// argument is not: the counted one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    predicate: u32,
    key: Vec<usize>,
}

type Candidate = Vec<Part>;

/// At most so many atoms in groups that are not made variables are remembered.
const MAX_REMEMBERED: usize = 100_000;

/// Sets of atoms of which at most one ever holds.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    /// Disjoint ones, large ones first: these become variables.
    pub disjoint: Vec<Vec<u32>>,
    /// All, as they were found.
    pub all: Vec<Vec<u32>>,
}

/// Finds mutex groups among the relevant atoms.
pub(crate) fn mutex_groups(
    ground: &Ground,
    relations: &[Relation],
    limits: &GroundLimits<'_>,
) -> Result<Groups, GroundError> {
    let atoms = Atoms { ground, relations };
    let mut all = proved(&atoms, false, limits)?;
    let disjoint = choose(&all, ground.names.len());
    // Hands that are empty or hold something: the search does without, proofs do not.
    all.extend(proved(&atoms, true, limits)?);
    let mut remembered = 0;
    all.retain(|group| {
        remembered += group.len();
        remembered <= MAX_REMEMBERED
    });
    Ok(Groups { disjoint, all })
}

/// The groups of the first candidates, and of those that they are refined to, that are proved to be some.
fn proved(atoms: &Atoms<'_>, single: bool, limits: &GroundLimits<'_>) -> Result<Vec<Vec<u32>>, GroundError> {
    let ground = atoms.ground;
    let mut open = atoms.first_candidates(single);
    let samples = samples(ground);
    let adding = Adding::new(ground);
    let mut seen: BTreeSet<Candidate> = open.iter().cloned().collect();
    let mut looked_at = 0;
    let mut groups = Vec::new();
    while let Some(candidate) = open.pop_front() {
        looked_at += 1;
        limits.check_time()?;
        if looked_at > MAX_CANDIDATES {
            break;
        }
        let instances = Instances { single, ..atoms.instances(&candidate) };
        if single && !instances.weight.contains(&1) {
            continue;
        }
        // One operator of each action shows most candidates wrong at once.
        let sampled = samples.iter().map(|&at| &ground.operators[at as usize]);
        let adding = adding.to(&candidate);
        let mut involved =
            sampled.chain(&ground.operators).filter(|operator| adding[operator.schema as usize]);
        match involved.find(|operator| !instances.balanced(ground, operator)) {
            None => groups.extend(instances.groups(ground, &adding, limits)?),
            Some(operator) => {
                for refined in atoms.refine(&candidate, &instances, operator) {
                    if seen.insert(refined.clone()) {
                        open.push_back(refined);
                    }
                }
            }
        }
    }
    Ok(groups)
}

/// The first operator of each action.
fn samples(ground: &Ground) -> Vec<u32> {
    let mut seen = BTreeSet::new();
    (0..ground.operators.len() as u32)
        .filter(|&at| seen.insert(ground.operators[at as usize].schema))
        .collect()
}

/// The actions that add atoms of each predicate: the others need no look for a candidate.
struct Adding {
    /// By predicate and action.
    adds: Vec<bool>,
    actions: usize,
}

impl Adding {
    fn new(ground: &Ground) -> Self {
        let actions = ground.operators.iter().map(|operator| operator.schema as usize + 1).max().unwrap_or(0);
        let predicates = ground.names.iter().flatten().map(|name| name.predicate as usize + 1).max();
        let mut adds = vec![false; actions * predicates.unwrap_or(0)];
        for operator in &ground.operators {
            let conditional = ground.conditional[operator.conditional.range()].iter().map(|e| &e.effect);
            let all = ground.lits(operator.effects).iter().chain(conditional);
            for name in all.filter(|lit| lit.holds()).filter_map(|lit| ground.names[lit.atom()]) {
                adds[name.predicate as usize * actions + operator.schema as usize] = true;
            }
        }
        Adding { adds, actions }
    }

    /// By action, whether it adds atoms of a candidate's predicates.
    fn to(&self, candidate: &Candidate) -> Vec<bool> {
        let mut any = vec![false; self.actions];
        for part in candidate {
            let row = &self.adds[part.predicate as usize * self.actions..][..self.actions];
            any.iter_mut().zip(row).for_each(|(any, adds)| *any |= adds);
        }
        any
    }
}

/// Picks disjoint groups, at each step the one with the most atoms not yet covered.
fn choose(groups: &[Vec<u32>], atoms: usize) -> Vec<Vec<u32>> {
    let mut covered = vec![false; atoms];
    let mut heap: BinaryHeap<(usize, std::cmp::Reverse<usize>)> =
        groups.iter().enumerate().map(|(at, group)| (group.len(), std::cmp::Reverse(at))).collect();
    let mut chosen = Vec::new();
    while let Some((size, at)) = heap.pop() {
        let rest: Vec<u32> = groups[at.0].iter().copied().filter(|&atom| !covered[atom as usize]).collect();
        if rest.len() < 2 {
            continue;
        }
        if rest.len() < size {
            heap.push((rest.len(), at));
            continue;
        }
        rest.iter().for_each(|&atom| covered[atom as usize] = true);
        chosen.push(rest);
    }
    chosen
}

struct Atoms<'a> {
    ground: &'a Ground,
    relations: &'a [Relation],
}

/// A candidate's groups: the key that each atom belongs to.
struct Instances {
    /// By atom; `NONE` for atoms of other predicates.
    key_of: Vec<u32>,
    /// How many atoms of each key hold at first.
    weight: Vec<u32>,
    /// How many atoms each key has.
    size: Vec<u32>,
    /// An atom whose key no other has is to be refined: by itself it would be balanced, and no use.
    single: bool,
}

impl Atoms<'_> {
    fn args(&self, name: AtomName) -> &[u32] {
        self.relations[name.predicate as usize].row(name.row)
    }

    fn usable(&self, atom: usize) -> Option<AtomName> {
        self.ground.names[atom].filter(|_| self.ground.relevant[atom] && !self.ground.derived[atom])
    }

    /// A predicate each, with one argument counted or none. A single atom is no group by itself, but one that holds
    /// at first may be part of one (`single`: only those): its key is all that it has.
    fn first_candidates(&self, single: bool) -> VecDeque<Candidate> {
        let mut predicates = BTreeSet::new();
        for atom in 0..self.ground.names.len() {
            if let Some(name) = self.usable(atom) {
                predicates.insert((name.predicate, self.args(name).len()));
            }
        }
        let mut candidates = VecDeque::new();
        for (predicate, arity) in predicates {
            for counted in (0..arity).map(Some).chain([None]).filter(|counted| !single || counted.is_none()) {
                let key = (0..arity).filter(|&at| Some(at) != counted).collect();
                candidates.push_back(vec![Part { predicate, key }]);
            }
        }
        candidates
    }

    fn instances(&self, candidate: &Candidate) -> Instances {
        let key_of = vec![NONE; self.ground.names.len()];
        let mut instances = Instances { key_of, weight: Vec::new(), size: Vec::new(), single: false };
        let (mut keys, mut table, mut key) = (Vec::<Vec<u32>>::new(), IdTable::default(), Vec::new());
        for atom in 0..self.ground.names.len() {
            let Some(name) = self.usable(atom) else { continue };
            let Some(part) = candidate.iter().find(|part| part.predicate == name.predicate) else { continue };
            key.clear();
            let args = self.args(name);
            key.extend(part.key.iter().map(|&at| args[at]));
            let hash = hash_words(&key);
            let id = match table.find(hash, |id| keys[id as usize] == key) {
                Slot::Found(id) => id,
                Slot::Free(at) => {
                    let id = keys.len() as u32;
                    keys.push(key.clone());
                    instances.weight.push(0);
                    instances.size.push(0);
                    table.insert(at, hash, id, |id| hash_words(&keys[id as usize]));
                    id
                }
            };
            instances.key_of[atom] = id;
            instances.weight[id as usize] += u32::from(self.ground.init[atom]);
            instances.size[id as usize] += 1;
        }
        instances
    }

    /// Candidates with one more predicate, of an atom that `operator` asks for and deletes.
    fn refine(
        &self,
        candidate: &Candidate,
        instances: &Instances,
        operator: &GroundOperator,
    ) -> Vec<Candidate> {
        let ground = self.ground;
        let Some(added) = instances.unbalanced_add(ground, operator) else { return Vec::new() };
        let Some(name) = ground.names[added] else { return Vec::new() };
        let Some(part) = candidate.iter().find(|part| part.predicate == name.predicate) else {
            return Vec::new();
        };
        let key: Vec<u32> = part.key.iter().map(|&at| self.args(name)[at]).collect();
        let mut refined = Vec::new();
        for lit in ground.lits(operator.effects).iter().filter(|lit| !lit.holds()) {
            if ground.lits(operator.precondition).binary_search(&lit.negated()).is_err() {
                continue;
            }
            let Some(deleted) = self.usable(lit.atom()) else { continue };
            if candidate.iter().any(|part| part.predicate == deleted.predicate) {
                continue;
            }
            for positions in key_positions(self.args(deleted), &key) {
                let mut larger = candidate.clone();
                larger.push(Part { predicate: deleted.predicate, key: positions });
                larger.sort();
                refined.push(larger);
            }
        }
        refined
    }
}

/// The ways to find all of `key` among `args` with at most one argument left over.
fn key_positions(args: &[u32], key: &[u32]) -> Vec<Vec<usize>> {
    if args.len() < key.len() || args.len() > key.len() + 1 {
        return Vec::new();
    }
    let mut ways: Vec<Vec<usize>> = vec![Vec::new()];
    for object in key {
        let mut next = Vec::new();
        for way in &ways {
            for at in (0..args.len()).filter(|at| args[*at] == *object && !way.contains(at)) {
                next.push([&way[..], &[at]].concat());
            }
        }
        ways = next;
    }
    ways
}

impl Instances {
    fn balanced(&self, ground: &Ground, operator: &GroundOperator) -> bool {
        self.unbalanced_add(ground, operator).is_none()
    }

    /// An atom that the operator adds to a group of which one holds at first, and that is then perhaps the second.
    /// A group that more than one atom of holds at first is not looked at: it is no mutex group anyway.
    fn unbalanced_add(&self, ground: &Ground, operator: &GroundOperator) -> Option<usize> {
        self.unbalanced(ground, operator, &|key| self.weight[key as usize] == 1)
    }

    /// An atom of a watched group that the operator adds without deleting another of it that held before, or all
    /// others.
    fn unbalanced(
        &self,
        ground: &Ground,
        operator: &GroundOperator,
        watched: &dyn Fn(u32) -> bool,
    ) -> Option<usize> {
        let effects = ground.lits(operator.effects);
        let conditional = &ground.conditional[operator.conditional.range()];
        let precondition = ground.lits(operator.precondition);
        let watched = |lit: Lit| {
            // Most effects of an action that moves something are deletes.
            lit.holds() && {
                let key = self.key_of[lit.atom()];
                key != NONE && watched(key)
            }
        };
        let adds =
            || effects.iter().map(|&lit| (lit, None)).chain(conditional.iter().map(|e| (e.effect, Some(e))));
        for (add, effect) in adds().filter(|&(lit, _)| watched(lit)) {
            let key = self.key_of[add.atom()];
            // Two adds to one group would need disjoint conditions; that is not looked into.
            if adds().any(|(other, _)| other != add && other.holds() && self.key_of[other.atom()] == key) {
                return Some(add.atom());
            }
            let condition = effect.map_or(&[][..], |effect| ground.lits(effect.condition));
            let held = || precondition.iter().chain(condition);
            if held().any(|&lit| lit == add) {
                continue;
            }
            let deleted = |lit: &Lit| {
                effects.binary_search(&lit.negated()).is_ok()
                    || conditional.iter().any(|other| {
                        other.effect == lit.negated()
                            && ground.lits(other.condition).iter().all(|c| held().any(|h| h == c))
                    })
            };
            if held().any(|lit| lit.holds() && self.key_of[lit.atom()] == key && deleted(lit)) {
                continue;
            }
            let others = effects.iter().filter(|lit| !lit.holds() && self.key_of[lit.atom()] == key);
            let size = self.size[key as usize];
            let deleted = others.filter(|lit| lit.atom() != add.atom()).count() as u32;
            if deleted + 1 < size || self.single && size == 1 {
                return Some(add.atom());
            }
        }
        None
    }

    /// The groups of which at most one atom holds at first, and then ever. `adding`: the actions that add atoms of them.
    fn groups(
        &self,
        ground: &Ground,
        adding: &[bool],
        limits: &GroundLimits<'_>,
    ) -> Result<Vec<Vec<u32>>, GroundError> {
        let mut holds = self.weight.iter().map(|&weight| weight == 1).collect::<Vec<_>>();
        // Where none holds at first, each group is looked at alone: there are no better candidates to wait for.
        let mut empty: Vec<bool> =
            self.weight.iter().zip(&self.size).map(|(&weight, &size)| weight == 0 && size >= 2).collect();
        if empty.contains(&true) {
            limits.check_time()?;
            for operator in ground.operators.iter().filter(|operator| adding[operator.schema as usize]) {
                while let Some(atom) = self.unbalanced(ground, operator, &|key| empty[key as usize]) {
                    empty[self.key_of[atom] as usize] = false;
                }
            }
            holds.iter_mut().zip(&empty).for_each(|(holds, &empty)| *holds |= empty);
        }
        let mut groups = vec![Vec::new(); self.weight.len()];
        for atom in 0..ground.names.len() {
            let key = self.key_of[atom];
            if key != NONE && holds[key as usize] {
                groups[key as usize].push(atom as u32);
            }
        }
        groups.retain(|group| group.len() >= 2);
        Ok(groups)
    }
}
