//! Objects, types, predicates and functions by number.

use std::collections::{BTreeSet, HashMap};
use std::hash::{BuildHasherDefault, Hasher};

use lamma_pddl::Name;
use lamma_pddl::ast::{Domain, Effect, Problem, TypedName};

use super::Role;
use crate::ground::GroundError;

/// A quick hash for names; nothing ever iterates over the maps that use it.
#[derive(Default)]
pub(crate) struct NameHasher(u64);

impl Hasher for NameHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&b| self.write_u8(b));
    }
    fn write_u8(&mut self, byte: u8) {
        self.0 = (self.0.rotate_left(5) ^ u64::from(byte)).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
}

type NameMap = HashMap<Name, u32, BuildHasherDefault<NameHasher>>;

/// A predicate.
#[derive(Clone, Debug)]
pub(crate) struct Predicate {
    pub name: Name,
    pub arity: usize,
    pub role: Role,
}

/// A set of objects that a variable ranges over.
#[derive(Clone, Debug)]
pub(crate) struct Range {
    /// In increasing order.
    pub members: Vec<u32>,
    /// Whether each object belongs.
    pub contains: Vec<bool>,
}

/// All names of a task.
#[derive(Debug, Default)]
pub(crate) struct Symbols {
    pub objects: Vec<Name>,
    object_ids: NameMap,
    pub predicates: Vec<Predicate>,
    predicate_ids: NameMap,
    pub functions: Vec<Predicate>,
    function_ids: NameMap,
    type_ids: NameMap,
    /// The objects of each type, subtypes included.
    type_members: Vec<BTreeSet<u32>>,
    pub ranges: Vec<Range>,
    range_ids: HashMap<Vec<u32>, u32>,
}

impl Symbols {
    pub fn new(domain: &Domain, problem: &Problem) -> Result<Self, GroundError> {
        let mut symbols = Symbols::default();
        let parents = symbols.declare_types(domain);
        for object in domain.constants.iter().chain(&problem.objects) {
            symbols.declare_object(object, &parents);
        }
        for signature in &domain.predicates {
            symbols.declare_predicate(&signature.name, signature.params.len(), Role::Static);
        }
        for signature in &domain.functions {
            symbols.declare_function(&signature.name, signature.params.len());
        }
        symbols.find_roles(domain)?;
        Ok(symbols)
    }

    /// Numbers the types and returns the direct supertypes of each; type 0 is `object`.
    fn declare_types(&mut self, domain: &Domain) -> Vec<Vec<u32>> {
        let mut parents = Vec::new();
        self.type_id(&Name::new("object"), &mut parents);
        for declared in &domain.types {
            let id = self.type_id(&declared.name, &mut parents);
            for parent in &declared.types {
                let parent = self.type_id(parent, &mut parents);
                parents[id as usize].push(parent);
            }
        }
        parents
    }

    fn type_id(&mut self, name: &Name, parents: &mut Vec<Vec<u32>>) -> u32 {
        if let Some(&id) = self.type_ids.get(name) {
            return id;
        }
        let id = self.type_members.len() as u32;
        self.type_ids.insert(name.clone(), id);
        self.type_members.push(BTreeSet::new());
        parents.push(Vec::new());
        id
    }

    fn declare_object(&mut self, object: &TypedName, parents: &[Vec<u32>]) {
        let id = match self.object_ids.get(&object.name) {
            Some(&id) => id,
            None => {
                let id = self.objects.len() as u32;
                self.objects.push(object.name.clone());
                self.object_ids.insert(object.name.clone(), id);
                id
            }
        };
        self.type_members[0].insert(id);
        let mut agenda: Vec<u32> = Vec::new();
        for name in &object.types {
            match self.type_ids.get(name) {
                Some(&known) => agenda.push(known),
                // An undeclared type has this object all the same, as older domains expect.
                None => agenda.push(self.type_id(name, &mut Vec::new())),
            }
        }
        while let Some(of) = agenda.pop() {
            if self.type_members[of as usize].insert(id) {
                agenda.extend(parents.get(of as usize).into_iter().flatten());
            }
        }
    }

    fn declare_predicate(&mut self, name: &Name, arity: usize, role: Role) -> u32 {
        if let Some(&id) = self.predicate_ids.get(name) {
            return id;
        }
        let id = self.predicates.len() as u32;
        self.predicates.push(Predicate { name: name.clone(), arity, role });
        self.predicate_ids.insert(name.clone(), id);
        id
    }

    fn declare_function(&mut self, name: &Name, arity: usize) -> u32 {
        if let Some(&id) = self.function_ids.get(name) {
            return id;
        }
        let id = self.functions.len() as u32;
        self.functions.push(Predicate { name: name.clone(), arity, role: Role::Static });
        self.function_ids.insert(name.clone(), id);
        id
    }

    /// A predicate that no text names.
    pub fn fresh_predicate(&mut self, name: String, arity: usize, role: Role) -> u32 {
        self.predicates.push(Predicate { name: Name::new(name), arity, role });
        self.predicates.len() as u32 - 1
    }

    fn find_roles(&mut self, domain: &Domain) -> Result<(), GroundError> {
        for action in &domain.actions {
            let mut agenda = vec![&action.effect];
            while let Some(effect) = agenda.pop() {
                match effect {
                    Effect::And(parts) => agenda.extend(parts),
                    Effect::Forall(_, inner) | Effect::When(_, inner) => agenda.push(inner),
                    Effect::Add(atom) | Effect::Delete(atom) => {
                        let id = self.declare_predicate(&atom.predicate, atom.args.len(), Role::Fluent);
                        self.predicates[id as usize].role = Role::Fluent;
                    }
                    Effect::Assign(_, target, _) => {
                        let id = self.declare_function(&target.function, target.args.len());
                        self.functions[id as usize].role = Role::Fluent;
                    }
                }
            }
        }
        for axiom in &domain.axioms {
            let head = &axiom.head;
            let id = self.declare_predicate(&head.name, head.params.len(), Role::Derived) as usize;
            if self.predicates[id].role == Role::Fluent {
                return Err(GroundError::Malformed(format!(
                    "`{}` is a derived predicate, so no action may add or delete it",
                    head.name
                )));
            }
            self.predicates[id].role = Role::Derived;
        }
        Ok(())
    }

    /// The number of an object.
    pub fn object(&self, name: &Name) -> Result<u32, GroundError> {
        self.object_ids.get(name).copied().ok_or_else(|| {
            GroundError::Malformed(format!("`{name}` is not declared in `:objects` or `:constants`"))
        })
    }

    /// The number of a predicate used with `arity` arguments. An undeclared one is taken as it is used.
    pub fn predicate(&mut self, name: &Name, arity: usize) -> Result<u32, GroundError> {
        let id = self.declare_predicate(name, arity, Role::Static);
        check_arity("predicate", name, self.predicates[id as usize].arity, arity)?;
        Ok(id)
    }

    /// The number of a function used with `arity` arguments.
    pub fn function(&mut self, name: &Name, arity: usize) -> Result<u32, GroundError> {
        let id = self.declare_function(name, arity);
        check_arity("function", name, self.functions[id as usize].arity, arity)?;
        Ok(id)
    }

    /// The range of a variable of the given types (any of them; none means every object).
    pub fn range(&mut self, types: &[Name]) -> u32 {
        let mut ids: Vec<u32> =
            types.iter().map(|t| self.type_ids.get(t).copied().unwrap_or(u32::MAX)).collect();
        if ids.is_empty() {
            ids.push(0);
        }
        ids.sort_unstable();
        ids.dedup();
        if let Some(&id) = self.range_ids.get(&ids) {
            return id;
        }
        let mut members = BTreeSet::new();
        for &id in &ids {
            members.extend(self.type_members.get(id as usize).into_iter().flatten().copied());
        }
        let mut contains = vec![false; self.objects.len()];
        members.iter().for_each(|&m| contains[m as usize] = true);
        let id = self.ranges.len() as u32;
        self.ranges.push(Range { members: members.into_iter().collect(), contains });
        self.range_ids.insert(ids, id);
        id
    }
}

fn check_arity(what: &str, name: &Name, declared: usize, used: usize) -> Result<(), GroundError> {
    if declared == used {
        return Ok(());
    }
    Err(GroundError::Malformed(format!(
        "the {what} `{name}` takes {declared} arguments but is used with {used}"
    )))
}
