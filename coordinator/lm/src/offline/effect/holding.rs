//! What is held or looked at in the end.

use super::{Change, Interpreter, is_lamp};
use crate::offline::lexicon::{Act, Verb};
use crate::offline::mention::Spoken;
use crate::offline::syntax::{Clause, Head, Place, Relation};

impl<'a> Interpreter<'_, 'a> {
    pub(super) fn hold(&mut self, clause: &Clause<'a>) -> Spoken {
        let goal = clause.places.iter().rposition(|place| {
            place.relation == Relation::To
                && matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| self.discourse.scene.has(kind)))
        });
        if let Some(goal) = goal {
            if !is_lamp(&clause.places[goal].phrase) {
                let mut at = clause.places.clone();
                let to = at.remove(goal);
                return self.put(clause, &at, &to);
            }
            let mut spoken = self.examine(clause);
            let lamps = self.discourse.mention(&clause.places[goal].phrase, &[], Some("toggleable"));
            spoken.places.extend(lamps);
            return spoken;
        }
        if let Some(goal) = clause.places.iter().rposition(|place| self.is_got_into(clause, place)) {
            let mut at = clause.places.clone();
            let to = at.remove(goal);
            return self.put(clause, &at, &to);
        }
        let held_up = clause.verb_text.starts_with("hold");
        let by_light = |place: &Place| {
            is_lamp(&place.phrase)
                && (place.under
                    || place.relation == Relation::With
                    || held_up && place.relation == Relation::Near)
        };
        if clause.places.iter().any(by_light) {
            return self.examine(clause);
        }
        let at: Vec<Place> = clause
            .places
            .iter()
            .filter(|p| !matches!(p.relation, Relation::With | Relation::For))
            .cloned()
            .collect();
        let objects = self.objects(clause, &at, Some("pickupable"));
        self.take(&objects);
        let places = self.places_spoken_of(&clause.places);
        Spoken { objects, places, placed: false, ..Spoken::default() }
    }

    /// "get the milk in the fridge": it is to be put there, where the scene knows that it lies elsewhere.
    fn is_got_into(&self, clause: &Clause<'a>, place: &Place) -> bool {
        let (Head::Noun(home), [phrase]) = (&place.phrase.head, clause.objects.as_slice()) else {
            return false;
        };
        let Head::Noun(thing) = &phrase.head else { return false };
        let scene = self.discourse.scene;
        let lies_elsewhere = |kind: &String| {
            let objects = scene.of_kind(kind);
            !objects.is_empty()
                && objects.iter().all(|object| {
                    !object.parents.is_empty()
                        && !scene.lies_in(object, &|parent| home.kinds.contains(&parent.kind))
                })
        };
        clause.verb_text == "get"
            && place.relation == Relation::In
            && home.kinds.iter().any(|kind| scene.affords(kind, "receptacle"))
            && thing.kinds.iter().find(|kind| scene.has(kind)).is_some_and(lies_elsewhere)
    }

    pub(super) fn take(&mut self, objects: &[usize]) {
        for &entity in objects {
            let kind = self.discourse.entities[entity].kind().to_owned();
            if self.discourse.scene.affords(&kind, "pickupable") {
                self.add(entity, Change::Held);
            } else {
                let text = self.discourse.entities[entity].text.clone();
                self.discourse.problem(format!("\"{text}\" ({kind}) cannot be picked up"), 0.3);
            }
        }
    }

    /// Things named only to say where something is; remembered for "it".
    pub(super) fn places_spoken_of(&mut self, places: &[Place]) -> Vec<usize> {
        let scene = self.discourse.scene;
        let mut found = Vec::new();
        for place in places {
            let known = matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.has(kind)));
            if known && matches!(place.relation, Relation::In | Relation::From | Relation::Near) {
                found.extend(self.discourse.mention(&place.phrase, &[], None));
            }
        }
        found
    }

    pub(super) fn examine(&mut self, clause: &Clause<'a>) -> Spoken {
        let is_light = |place: &&Place| is_lamp(&place.phrase);
        let with: Vec<Place> = clause
            .objects
            .iter()
            .flat_map(|phrase| &phrase.with)
            .map(|phrase| Place::new(Relation::With, "with", phrase.clone()))
            .collect();
        let light = clause.places.iter().chain(&with).find(is_light).cloned();
        let at: Vec<Place> = clause
            .places
            .iter()
            .filter(|place| !is_light(place) && matches!(place.relation, Relation::In | Relation::From))
            .cloned()
            .collect();
        let objects = self.objects(clause, &at, Some("pickupable"));
        self.take(&objects);
        let mut places = Vec::new();
        if let Some(light) = light {
            self.lamp_wanted = true;
            let phrase = self.with_lamps_first(&light.phrase, &[]);
            places = self.discourse.mention(&phrase, &[], Some("toggleable"));
            for &lamp in &places {
                self.add(lamp, Change::State("isToggled".to_owned(), crate::offline::yes()));
            }
        }
        Spoken { objects, places, placed: false, ..Spoken::default() }
    }

    /// A tool is no goal, except a lamp that is used to look at something.
    pub(super) fn use_tool(&mut self, clause: &Clause<'a>, next: Option<&Clause<'a>>) -> Spoken {
        let examines = next.is_some_and(|next| next.verbs.iter().any(|verb| verb.act == Act::Examine));
        let on = |verb: &Verb| verb.set.get("isToggled") == Some(&crate::offline::yes());
        let lights = |next: &Clause<'a>| next.objects.iter().any(is_lamp) && next.verbs.iter().any(|v| on(v));
        // "use the book to turn on the lamp": it is in the hand that does.
        if next.is_some_and(lights) && clause.objects.iter().any(|phrase| self.is_movable(phrase)) {
            return self.hold(clause);
        }
        if !examines {
            // "use the spray and the cloth to clean the mirror, then put them away"
            let reached =
                clause.objects.iter().filter(|phrase| self.is_movable(phrase)).cloned().collect::<Vec<_>>();
            let reached =
                reached.iter().flat_map(|phrase| self.discourse.mention(phrase, &[], None)).collect();
            return Spoken { reached, ..Spoken::default() };
        }
        let lamps = self.objects(clause, &clause.places, Some("toggleable"));
        for &lamp in &lamps {
            if self.discourse.scene.affords(self.discourse.entities[lamp].kind(), "toggleable") {
                self.add(lamp, Change::State("isToggled".to_owned(), crate::offline::yes()));
            }
        }
        Spoken { places: lamps, ..Spoken::default() }
    }
}
