//! One object by its name where a type would leave open which: several at once, or one of several that is
//! changed and changed back.

use std::collections::{BTreeMap, BTreeSet};

use super::super::effect::{Change, Fact};
use super::super::lexicon::Settings;
use super::super::scene::is_in_state;
use super::{Discourse, Which};

impl Discourse<'_> {
    /// Binds what the goal's separate entries could not tell apart.
    pub fn bind_names(&mut self, facts: &[Fact]) {
        let mut groups: BTreeMap<(String, String), BTreeSet<usize>> = BTreeMap::new();
        let mut wanted: BTreeMap<usize, Settings> = BTreeMap::new();
        let mut undone: BTreeSet<usize> = BTreeSet::new();
        for (i, fact) in facts.iter().enumerate() {
            let entity = fact.entity;
            let placed =
                facts[i..].iter().any(|f| f.entity == entity && matches!(f.change, Change::Inside(_)));
            match &fact.change {
                Change::Inside(_) => continue,
                Change::Held if placed => continue,
                Change::Held => {}
                Change::State(property, value) => {
                    let states = wanted.entry(entity).or_default();
                    if states.get(property).is_some_and(|known| known != value) {
                        undone.insert(entity);
                    }
                    states.entry(property.clone()).or_insert_with(|| value.clone());
                }
            }
            let kind = self.entities[entity].kind().to_owned();
            groups.entry((format!("{:?}", fact.change), kind)).or_default().insert(entity);
        }
        let several = groups.into_values().filter(|group| group.len() > 1).flatten();
        let bound: BTreeSet<usize> = several.chain(undone).collect();
        for entity in bound {
            self.bind(entity, &wanted.remove(&entity).unwrap_or_default());
        }
    }

    /// Says of what is to be put somewhere that it lies there already: no robot will move it.
    pub fn note_what_is_so(&mut self, facts: &[Fact]) {
        for fact in facts {
            let Change::Inside(place) = fact.change else { continue };
            let (thing, place) = (&self.entities[fact.entity], self.entities[place].kind());
            let lies = self.scene.of_kind(thing.kind()).iter().any(|object| {
                let named = matches!(&thing.which, Which::Named(name) if *name != object.name);
                !named
                    && object
                        .parents
                        .iter()
                        .filter_map(|parent| self.scene.named(parent))
                        .any(|parent| parent.kind == place)
            });
            let moved = facts.iter().any(|other| {
                other.entity == fact.entity && matches!(other.change, Change::Inside(_)) && other != fact
            });
            if lies && !moved {
                let text = format!("the {} is in or on the {place} already and may stay", thing.kind());
                self.assume(text, 1.0);
            }
        }
    }

    /// Binds an entity to an object that is not yet as wanted, if there is one; the first by name.
    fn bind(&mut self, entity: usize, wanted: &Settings) {
        let thing = &self.entities[entity];
        let objects = self.scene.of_kind(thing.kind());
        if thing.which != Which::Any || objects.len() < 2 {
            return;
        }
        let taken: BTreeSet<&str> = self
            .entities
            .iter()
            .filter_map(|e| if let Which::Named(name) = &e.which { Some(name.as_str()) } else { None })
            .collect();
        let free: Vec<_> = objects.iter().filter(|object| !taken.contains(object.name.as_str())).collect();
        let chosen = free.iter().find(|object| !is_in_state(object, wanted)).or(free.first());
        if let Some(object) = chosen {
            let name = object.name.clone();
            let text = self.entities[entity].text.clone();
            self.entities[entity].which = Which::Named(name.clone());
            self.assume(format!("\"{text}\" is {name}"), 1.0);
        }
    }
}
