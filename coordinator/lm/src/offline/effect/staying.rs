//! Where a thing is in the end that nobody is asked to put anywhere.

use super::super::lexicon::{Act, Verb};
use super::super::syntax::{Clause, Head, Place, Relation};
use super::{Change, Interpreter};

impl<'a> Interpreter<'_, 'a> {
    /// "wash the pan on the stove", "cool the egg that is on the counter": it goes back there when it is done.
    pub(super) fn stay_where_it_was_said_to_be(
        &mut self,
        clause: &Clause<'a>,
        verb: &Verb,
        objects: &[usize],
    ) {
        let washes = verb.set.get("isDirty") == Some(&crate::offline::no());
        let cuts = verb.wants.as_deref() == Some("sliceable");
        let treats = washes || cuts || matches!(verb.act, Act::Heat | Act::Chill | Act::Cook);
        let named = |place: &Place, kinds: &[String]| matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| kinds.contains(kind)));
        let tool = |place: &Place| named(place, &verb.tools);
        let goes = clause
            .places
            .iter()
            .any(|place| place.relation == Relation::To || verb.device.is_some() && tool(place));
        if !treats || goes || !clause.complement.is_empty() {
            return;
        }
        let scene = self.discourse.scene;
        let furniture = |place: &&Place| {
            let stands = |kind: &String| scene.is_furniture(kind);
            place.relation == Relation::In
                && !tool(place)
                && matches!(&place.phrase.head, Head::Noun(noun) if !noun.class && noun.kinds.iter().any(stands))
        };
        let said = clause.objects.iter().flat_map(|phrase| &phrase.at).chain(&clause.places);
        let Some(place) = said.clone().find(furniture) else { return };
        let places = self.discourse.mention(&place.phrase, &[], Some("receptacle"));
        let Some(&place) = places.first() else { return };
        let home = self.discourse.entities[place].kind().to_owned();
        for &entity in objects.iter().filter(|&&entity| entity != place) {
            let kind = self.discourse.entities[entity].kind().to_owned();
            let placed =
                self.facts.iter().any(|f| f.entity == entity && matches!(f.change, Change::Inside(_)));
            if !placed && self.discourse.scene.accepts(&home, &kind) {
                self.discourse.assume(format!("the {kind} is in or on the {home} again in the end"), 0.9);
                self.put_in(entity, place);
            }
        }
    }

    /// "fry the egg in the pan", "crack it in the bowl": it is in there when that is done.
    pub(super) fn stay_where_it_was_cooked(&mut self, clause: &Clause<'a>, verb: &Verb, objects: &[usize]) {
        let cracks = verb.set.get("isBroken") == Some(&crate::offline::yes());
        if verb.act != Act::Cook && !cracks {
            return;
        }
        let scene = self.discourse.scene;
        let vessel = |kind: &String| scene.affords(kind, "receptacle") && scene.affords(kind, "pickupable");
        let named = |place: &&Place| match &place.phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(vessel),
            Head::Pronoun { plural } => !plural,
            _ => false,
        };
        let Some(place) = clause.places.iter().filter(|place| place.relation == Relation::In).find(named)
        else {
            return;
        };
        let places = self.discourse.mention(&place.phrase, &[], Some("receptacle"));
        let Some(&place) = places.first() else { return };
        let home = self.discourse.entities[place].kind().to_owned();
        let fits = |this: &Self, entity: usize| {
            entity != place && this.discourse.scene.accepts(&home, this.discourse.entities[entity].kind())
        };
        for &entity in objects.iter().filter(|_| vessel(&home)) {
            if fits(self, entity) {
                self.put_in(entity, place);
            }
        }
    }
}
