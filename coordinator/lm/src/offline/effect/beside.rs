//! Places that are told by other things: beside them, or where they were.

use super::super::mention::{Spoken, Which};
use super::super::syntax::{Clause, Place};
use super::{Change, Interpreter};

impl<'a> Interpreter<'_, 'a> {
    /// "next to the toaster": on what the toaster stands on, or the likeliest surface.
    pub(super) fn put_beside(&mut self, clause: &Clause<'a>, at: &[Place], near: &Place) -> Spoken {
        let objects = self.objects(clause, at, Some("pickupable"));
        let mentioned = self.discourse.mention(&near.phrase, &[], None);
        let Some(&first) = objects.first() else { return Spoken::default() };
        if near.was {
            return self.put_where_it_was(clause, objects, &mentioned);
        }
        let thing = self.discourse.entities[first].kind().to_owned();
        let scene = self.discourse.scene;
        let reference = mentioned.first().map(|&e| self.discourse.entities[e].kind().to_owned());
        if near.there
            && let Some(&place) = mentioned.first()
            && reference.as_deref().is_some_and(|kind| scene.accepts(kind, &thing))
        {
            for &entity in &objects {
                self.put_in(entity, place);
            }
            return Spoken { objects, places: vec![place], placed: true, ..Spoken::default() };
        }
        // What it is put next to may have been put somewhere itself.
        let stands = mentioned.first().and_then(|&e| {
            self.facts.iter().rev().find_map(|fact| match fact.change {
                Change::Inside(place) if fact.entity == e => {
                    Some(self.discourse.entities[place].kind().to_owned())
                }
                _ => None,
            })
        });
        let stands = stands.filter(|kind| scene.accepts(kind, &thing));
        let under =
            reference.as_deref().filter(|_| near.under).and_then(|kind| self.discourse.lexicon.under(kind));
        let stands_on = reference.as_deref().and_then(|kind| {
            let object = scene.of_kind(kind).first()?;
            scene
                .parents(object)
                .map(|parent| parent.kind.as_str())
                .find(|kind| *kind != "Floor" && scene.accepts(kind, &thing))
        });
        let mut surfaces = self.discourse.lexicon.beside(reference.as_deref());
        let likely = surfaces.find(|kind| scene.surely_accepts(kind, &thing));
        let kinds = self.discourse.entities[first].kinds.clone();
        let likes = |kind| self.discourse.lexicon.likes(kind).iter().map(String::as_str);
        let chosen = under
            .into_iter()
            .flat_map(|place| std::iter::once(place).chain(likes(place)))
            .find(|place| kinds.iter().any(|kind| scene.accepts(place, kind)))
            .or(stands.as_deref())
            .or(stands_on)
            .or(likely)
            .map(str::to_owned);
        let Some(chosen) = chosen else {
            self.discourse.problem(format!("there is no surface for \"{}\"", clause.text), 0.3);
            return Spoken { objects, ..Spoken::default() };
        };
        self.discourse
            .assume(format!("the place by \"{}\" is taken to be the {chosen}", near.phrase.text), 0.8);
        let place = self.discourse.place_of_kind(&chosen);
        for &entity in &objects {
            self.put_in(entity, place);
        }
        Spoken { objects, places: vec![place], placed: true, reached: mentioned }
    }

    /// "where the tomato was", "in the place of the tomato": what that lies in or on at the start, wherever it goes.
    fn put_where_it_was(&mut self, clause: &Clause<'a>, objects: Vec<usize>, mentioned: &[usize]) -> Spoken {
        let place = mentioned.first().and_then(|&gone| {
            let scene = self.discourse.scene;
            let entity = &self.discourse.entities[gone];
            let object = match &entity.which {
                Which::Named(name) => scene.named(name),
                _ => scene.of_kind(entity.kind()).first().copied(),
            }?;
            let takes = |kind: &str| {
                objects.iter().all(|&entity| scene.accepts(kind, self.discourse.entities[entity].kind()))
            };
            let parent = scene.parents(object).find(|parent| takes(&parent.kind))?;
            Some((parent.kind.clone(), parent.name.clone()))
        });
        let Some((kind, name)) = place else {
            self.discourse.problem(format!("the place meant in \"{}\" does not take it", clause.text), 0.3);
            return Spoken { objects, ..Spoken::default() };
        };
        self.discourse.assume(format!("the place meant in \"{}\" is {name}", clause.text), 0.9);
        let place = self.discourse.add(vec![kind], Which::Named(name.clone()), &name);
        for &entity in &objects {
            self.put_in(entity, place);
        }
        Spoken { objects, places: vec![place], placed: true, reached: mentioned.to_vec() }
    }

    /// The type of what a thing was said to be in, or lies in now.
    pub(super) fn where_it_was(&self, entity: usize) -> Option<String> {
        let scene = self.discourse.scene;
        let said = self.discourse.spoken.iter().find(|s| !s.placed && s.objects.contains(&entity));
        if let Some(&place) = said.and_then(|spoken| spoken.places.first()) {
            return Some(self.discourse.entities[place].kind().to_owned());
        }
        let object = scene.of_kind(self.discourse.entities[entity].kind()).first()?;
        scene.parents(object).next().map(|parent| parent.kind.clone())
    }
}
