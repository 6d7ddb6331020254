//! Which of the places of a clause is where things shall be.

use super::super::lexicon::Settings;
use super::super::mention::Spoken;
use super::super::syntax::{Clause, Head, Phrase, Place, Relation};
use super::Interpreter;
use crate::ObjectView;

impl<'a> Interpreter<'_, 'a> {
    /// The goal, the movable receptacle it is reached in, and the places that say where things were.
    pub(super) fn sort_places(&self, clause: &Clause<'a>) -> (Option<Place>, Option<Place>, Vec<Place>) {
        let scene = self.discourse.scene;
        let is_there = |place: &Place| match &place.phrase.head {
            Head::Noun(noun) => {
                noun.kinds.iter().any(|kind| scene.affords(kind, "receptacle"))
                    || !noun.kinds.iter().any(|kind| scene.has(kind))
            }
            Head::Named(_) | Head::Pronoun { .. } => true,
            Head::Unknown(_) => true,
            _ => false,
        };
        let goals: Vec<usize> = (0..clause.places.len())
            .filter(|&i| {
                matches!(clause.places[i].relation, Relation::In | Relation::To)
                    && is_there(&clause.places[i])
            })
            .collect();
        let Some(&last) = goals.last() else {
            let at = clause.places.iter().filter(|p| p.relation == Relation::From).cloned().collect();
            return (None, None, at);
        };
        let to = goals.iter().rev().find(|&&i| clause.places[i].relation == Relation::To).copied();
        let movable = |i: usize| {
            matches!(&clause.places[i].phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|k| scene.affords(k, "pickupable") && scene.affords(k, "receptacle")))
        };
        let relation = |i: usize| clause.places[i].relation;
        let compartment = |i: usize| {
            matches!(&clause.places[i].phrase.head, Head::Noun(noun)
            if noun.kinds.iter().find(|k| scene.has(k)).or(noun.kinds.first()).is_some_and(|k| {
                self.discourse.lexicon.is_small("compartments", &[&k.to_lowercase()])
            }))
        };
        // "on the top shelf inside the fridge": a part of the fridge.
        let shelves_of_its_own = |i: usize| {
            matches!(&clause.places[i].phrase.head, Head::Noun(noun)
                if noun.kinds.first().is_some_and(|k| scene.affords(k, "isColdSource")))
        };
        let (goal, inner) = match goals.as_slice() {
            // "put the cup in the sink on the table": where it is, and where it goes.
            [a, b] if self.lie_there(clause, *a) && (names_many(clause) || !self.lie_there(clause, *b)) => {
                (*b, None)
            }
            [.., a, b] if movable(*a) && !movable(*b) => (*b, Some(*a)),
            [a, b] if compartment(*a) && shelves_of_its_own(*b) => (*b, None),
            [a, b] if shelves_of_its_own(*a) && compartment(*b) => (*a, None),
            [a, b] if compartment(*a) && !compartment(*b) && relation(*b) == Relation::In => (*a, None),
            // "in a cabinet over the sink"
            [a, b] if compartment(*a) && clause.places[*b].over => (*a, None),
            _ => (to.unwrap_or(last), None),
        };
        let at = (0..clause.places.len())
            .filter(|&i| i != goal && Some(i) != inner)
            .filter(|&i| matches!(clause.places[i].relation, Relation::In | Relation::From))
            .filter(|&i| i < goal || clause.places[i].relation == Relation::From)
            .map(|i| clause.places[i].clone())
            .collect();
        (Some(clause.places[goal].clone()), inner.map(|i| clause.places[i].clone()), at)
    }

    /// Whether something that a clause names lies at one of its places, which can itself not be carried.
    fn lie_there(&self, clause: &Clause<'a>, place: usize) -> bool {
        let scene = self.discourse.scene;
        let Some(place) = clause.places.get(place) else { return false };
        let furniture = matches!(&place.phrase.head, Head::Noun(noun)
            if !noun.kinds.iter().any(|kind| scene.affords(kind, "pickupable")));
        let named = clause.objects.iter().filter_map(|phrase| match &phrase.head {
            Head::Noun(noun) => Some(noun),
            _ => None,
        });
        let whole = clause.objects.iter().any(|phrase| phrase.head == Head::Everything);
        let lies_there =
            |kind: &str| scene.of_kind(kind).iter().any(|object| self.discourse.is_at(object, place));
        let lies = |kind: &String| lies_there(kind);
        furniture && (named.flat_map(|noun| &noun.kinds).any(lies) || whole && scene.kinds().any(lies_there))
    }

    /// "it waits in the closed fridge": where "closed" tells none from another, it is to be closed in the end.
    pub(super) fn close_what_is_closed(&mut self, phrase: &Phrase, places: &[usize]) {
        let closed = Settings::from([("isOpen".to_owned(), crate::offline::no())]);
        if phrase.selects.get("isOpen") != closed.get("isOpen") {
            return;
        }
        for &place in places {
            let kind = self.discourse.entities[place].kind();
            let open = |object: &&ObjectView| object.states.iter().any(|state| state == "isOpen");
            if !self.discourse.scene.of_kind(kind).iter().any(open) {
                self.add_states(place, &closed);
            }
        }
    }

    /// "set the table with a plate, a cup and water": without the water, which is for the cup.
    pub(super) fn with_a_drink(&self, clause: &Clause<'a>) -> Option<(Clause<'a>, String)> {
        let with = |place: &&Place| place.relation == Relation::With;
        // "lay the table with …": what is laid on it is told with it.
        let table =
            matches!(clause.objects.as_slice(), [table] if table.with.len() > 1 && !self.is_movable(table));
        let laid = clause.objects.first().filter(|_| table).map_or(&[][..], |table| &table.with);
        let placed = clause.places.iter().filter(with).map(|place| &place.phrase);
        let listed = clause.objects.iter().chain(placed).chain(laid);
        let liquid = listed.clone().find_map(plain_liquid)?.to_owned();
        let vessel = |phrase: &Phrase| {
            matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| {
                self.discourse.scene.affords(kind, "canFillWithLiquid")
            }))
        };
        // "put the bowl on the table with water" is one thing and what is in it.
        if listed.clone().count() < 3 || !listed.clone().any(vessel) {
            return None;
        }
        let mut solid = clause.clone();
        solid.objects.retain(|phrase| plain_liquid(phrase).is_none());
        solid
            .places
            .retain(|place| place.relation != Relation::With || plain_liquid(&place.phrase).is_none());
        if table && let Some(table) = solid.objects.first_mut() {
            table.with.retain(|phrase| plain_liquid(phrase).is_none());
        }
        Some((solid, liquid))
    }

    /// Pours a liquid into what one drinks from of the things that were put somewhere, else into the first that holds it.
    pub(super) fn pour_for(&mut self, spoken: &Spoken, liquid: &str) {
        let discourse = &self.discourse;
        let holds = |e: &&usize| discourse.scene.affords(discourse.entities[**e].kind(), "canFillWithLiquid");
        let drinks = |e: &&usize| ["Cup", "Mug"].contains(&discourse.entities[**e].kind());
        let mut vessels = spoken.objects.iter().filter(holds);
        let vessel = vessels.clone().find(drinks).or_else(|| vessels.next()).copied();
        match vessel {
            Some(vessel) => self.add_states(vessel, &super::super::mention::filled(liquid)),
            None => self.discourse.problem(format!("it is not said what the {liquid} is to be in"), 0.3),
        }
    }
}

/// The liquid that a phrase is, if it is nothing else: "water", not "a bottle of wine".
fn plain_liquid(phrase: &Phrase) -> Option<&str> {
    match &phrase.head {
        Head::Liquid(_) => phrase.liquid(),
        Head::Noun(noun) if ["water", "coffee"].contains(&noun.word.as_str()) => Some(noun.word.as_str()),
        _ => None,
    }
}

/// Whether a clause names things of which some may be elsewhere: "everything in the sink", "the food on the counter".
fn names_many(clause: &Clause<'_>) -> bool {
    clause.objects.iter().any(|phrase| match &phrase.head {
        Head::Noun(noun) => noun.class,
        head => *head == Head::Everything,
    })
}
