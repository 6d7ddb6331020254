//! Types and their supertypes.

use std::collections::{BTreeMap, BTreeSet};

use crate::ast::TypedName;
use crate::name::Name;

/// Which types are kinds of which.
pub(super) struct Hierarchy<'d> {
    index: BTreeMap<&'d Name, usize>,
    /// Of each type a bit set of its kinds, itself included.
    kinds: Vec<Vec<u64>>,
    cyclic: Vec<&'d Name>,
}

/// Whether the objects of some types are among those of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    All,
    Some,
    None,
}

impl<'d> Hierarchy<'d> {
    pub fn new(types: &'d [TypedName]) -> Self {
        let names = types.iter().flat_map(|declared| declared.types.iter().chain([&declared.name]));
        let mut index: BTreeMap<&Name, usize> =
            names.filter(|name| *name != "object").map(|n| (n, 0)).collect();
        index.values_mut().enumerate().for_each(|(at, value)| *value = at);
        let mut above = vec![BTreeSet::new(); index.len()];
        for declared in types.iter().filter(|declared| declared.name != "object") {
            let supertypes = declared.types.iter().filter_map(|name| index.get(name));
            above[index[&declared.name]].extend(supertypes.copied());
        }
        let mut kinds = vec![vec![0; index.len().div_ceil(64)]; index.len()];
        let mut cyclic = Vec::new();
        for (name, &start) in &index {
            let mut open: Vec<usize> = above[start].iter().copied().collect();
            while let Some(next) = open.pop() {
                if set(&mut kinds[next], start) {
                    open.extend(&above[next]);
                }
            }
            if !set(&mut kinds[start], start) {
                cyclic.push(*name);
            }
        }
        Hierarchy { index, kinds, cyclic }
    }

    /// Types that are kinds of themselves.
    pub fn cycles(&self) -> Vec<&'d Name> {
        self.cyclic.clone()
    }

    pub fn names(&self) -> impl Iterator<Item = &Name> {
        self.index.keys().copied()
    }

    pub fn is_declared(&self, name: &Name) -> bool {
        name == "object" || self.index.contains_key(name)
    }

    fn is_a(&self, name: &Name, other: &Name) -> bool {
        if other == "object" {
            return true;
        }
        let (Some(&name), Some(&other)) = (self.index.get(name), self.index.get(other)) else { return false };
        self.kinds[other][name / 64] & (1 << (name % 64)) != 0
    }

    /// Whether some type is a kind of both.
    fn overlap(&self, a: &Name, b: &Name) -> bool {
        let (Some(&a), Some(&b)) = (self.index.get(a), self.index.get(b)) else { return true };
        self.kinds[a].iter().zip(&self.kinds[b]).any(|(a, b)| a & b != 0)
    }

    /// How objects of any of the types `found` (for one object: of all of them) fit where `allowed` is declared.
    /// No type means `object`. Types that are not declared fit: they were reported already.
    pub fn fit(&self, found: &[&Name], allowed: &[Name], is_object: bool) -> Fit {
        let unknown = |name: &Name| !self.is_declared(name);
        let anything =
            allowed.is_empty() || allowed.iter().any(|wanted| wanted == "object" || unknown(wanted));
        if anything || found.iter().any(|name| unknown(name)) {
            return Fit::All;
        }
        let fits = |name: &Name| allowed.iter().any(|wanted| self.is_a(name, wanted));
        if is_object {
            return if found.iter().any(|name| fits(name)) { Fit::All } else { Fit::None };
        }
        if found.is_empty() {
            return Fit::Some;
        }
        if found.iter().all(|name| fits(name)) {
            return Fit::All;
        }
        let any = found.iter().any(|name| allowed.iter().any(|wanted| self.overlap(name, wanted)));
        if any { Fit::Some } else { Fit::None }
    }
}

/// Sets a bit. Whether it was not set before.
fn set(bits: &mut [u64], at: usize) -> bool {
    let before = bits[at / 64];
    bits[at / 64] |= 1 << (at % 64);
    bits[at / 64] != before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fitting_follows_the_supertypes() {
        let types = [("cup", "thing"), ("fridge", "thing"), ("robot", "object"), ("a", "b"), ("b", "a")];
        let types: Vec<TypedName> = types.iter().map(|(name, of)| TypedName::new(*name, *of)).collect();
        let hierarchy = Hierarchy::new(&types);
        let fit = |found: &str, wanted: &str, is_object| {
            hierarchy.fit(&[&Name::new(found)], &[Name::new(wanted)], is_object)
        };
        assert_eq!(fit("cup", "thing", false), Fit::All);
        assert_eq!(fit("thing", "cup", false), Fit::Some, "a variable over things may be a cup");
        assert_eq!(fit("thing", "cup", true), Fit::None, "a thing that is no cup is no cup");
        assert_eq!(fit("robot", "thing", false), Fit::None);
        assert_eq!(fit("object", "cup", false), Fit::Some);
        assert_eq!(fit("cup", "object", false), Fit::All);
        assert_eq!(hierarchy.cycles(), [&Name::new("a"), &Name::new("b")]);
    }
}
