//! Which objects are of which type.

use std::collections::{BTreeMap, BTreeSet};

use crate::ast::TypedName;
use crate::name::Name;

/// Objects with all types they are of, supertypes included.
#[derive(Debug)]
pub(super) struct Universe<'t> {
    objects: Vec<(&'t Name, BTreeSet<&'t Name>)>,
}

impl<'t> Universe<'t> {
    pub fn new(types: &'t [TypedName], objects: impl IntoIterator<Item = &'t TypedName>) -> Self {
        let mut above: BTreeMap<&Name, Vec<&Name>> = BTreeMap::new();
        for declared in types {
            above.entry(&declared.name).or_default().extend(&declared.types);
        }
        let closure = |object: &'t TypedName| {
            let mut all = BTreeSet::new();
            let mut open: Vec<&Name> = object.types.iter().collect();
            while let Some(name) = open.pop() {
                if all.insert(name) {
                    open.extend(above.get(name).into_iter().flatten().copied());
                }
            }
            (&object.name, all)
        };
        Universe { objects: objects.into_iter().map(closure).collect() }
    }

    /// The objects of any of these types; no type means all.
    pub fn of<'a>(&'a self, types: &'a [Name]) -> impl Iterator<Item = &'t Name> + 'a {
        let all = types.is_empty() || types.iter().any(|name| *name == "object");
        let fits = move |of: &BTreeSet<&Name>| all || types.iter().any(|name| of.contains(name));
        self.objects.iter().filter(move |(_, of)| fits(of)).map(|(name, _)| *name)
    }
}
