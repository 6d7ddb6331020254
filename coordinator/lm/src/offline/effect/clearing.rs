//! Surfaces that are cleared: what lies on them is put where it is kept.

use super::super::clause::goes_somewhere;
use super::super::mention::{Spoken, Which};
use super::super::syntax::{Clause, Head};
use super::Interpreter;

/// Orders to clear a surface.
const CLEARS: [&str; 9] =
    ["clear", "clear off", "clear up", "clear out", "clear away", "declutter", "free up", "tidy", "tidy up"];

/// Crockery and cutlery, which goes from a table to the sink.
const TABLEWARE: [&str; 8] = ["Plate", "Bowl", "Cup", "Mug", "Fork", "Spoon", "Knife", "ButterKnife"];

/// Where things may stand that are kept nowhere.
pub(super) const ANYWHERE: [&str; 10] = [
    "Shelf",
    "CounterTop",
    "Dresser",
    "SideTable",
    "Desk",
    "DiningTable",
    "CoffeeTable",
    "Sofa",
    "ArmChair",
    "Bed",
];

impl<'a> Interpreter<'_, 'a> {
    /// "clear the coffee table": what lies on it is put away. False where that is no surface or nothing lies on it.
    pub fn clears(&mut self, index: usize, clauses: &[Clause<'a>]) -> bool {
        let clause = &clauses[index];
        let Some((surface, things)) = self.surface_to_clear(clause) else { return false };
        let others = clauses.iter().enumerate().filter(|(other, clause)| *other != index && puts(clause));
        if others.count() > 1 {
            self.discourse.assume(format!("\"{}\" is done by what else is said", clause.text), 0.9);
            self.discourse.spoken.push(Spoken::default());
            return true;
        }
        let keeps = clause.verb_text.starts_with("tidy");
        let mut objects = Vec::new();
        let mut places = Vec::new();
        for (kind, name) in things {
            let Some(home) = self.home_off(&surface, &kind, keeps) else { continue };
            self.at_clause(index);
            let entity = self.discourse.add(vec![kind.clone()], Which::Named(name), &kind);
            let place = self.discourse.place_of_kind(&home);
            self.put_in(entity, place);
            objects.push(entity);
            places.push(place);
        }
        if objects.is_empty() {
            return false;
        }
        let names: Vec<&str> = objects.iter().map(|&e| self.discourse.entities[e].kind()).collect();
        let text = format!("\"{}\": what lies there is put away: {}", clause.text, names.join(", "));
        self.discourse.assume(text, 0.8);
        places.dedup();
        self.spoke = true;
        self.discourse.spoken.push(Spoken { objects, placed: true, places, ..Spoken::default() });
        true
    }

    /// The type of the surface that a clause clears, and what can be carried of what lies right on it.
    fn surface_to_clear(&self, clause: &Clause<'a>) -> Option<(String, Vec<(String, String)>)> {
        let [phrase] = clause.objects.as_slice() else { return None };
        let Head::Noun(noun) = &phrase.head else { return None };
        let said = CLEARS.contains(&clause.verb_text.as_str()) && clause.places.is_empty() && !clause.negated;
        let scene = self.discourse.scene;
        let things = |surface: &str| -> Vec<(String, String)> {
            let objects = scene.kinds().flat_map(|kind| scene.of_kind(kind));
            let lies = objects.filter(|object| {
                scene.affords(&object.kind, "pickupable")
                    && scene.parents(object).next().is_some_and(|parent| parent.kind == surface)
            });
            lies.map(|object| (object.kind.clone(), object.name.clone())).collect()
        };
        let surface = |kind: &&String| scene.is_furniture(kind) && !scene.affords(kind, "openable");
        let mut there = noun.kinds.iter().filter(|_| said && !noun.class).filter(surface);
        there.find_map(|kind| Some((kind.clone(), things(kind))).filter(|(_, things)| !things.is_empty()))
    }

    /// Where a thing goes that may not stay on a surface, if that is not where it is kept.
    fn home_off(&self, surface: &str, kind: &str, keeps: bool) -> Option<String> {
        let (scene, lexicon) = (self.discourse.scene, self.discourse.lexicon);
        if keeps && lexicon.homes(kind).next() == Some(surface) {
            return None;
        }
        let washed_up = TABLEWARE.contains(&kind) && surface.ends_with("Table");
        let sink = ["SinkBasin", "Sink"].into_iter().filter(|_| washed_up);
        let mut places = sink.chain(lexicon.homes(kind)).chain(ANYWHERE);
        places.find(|home| *home != surface && scene.accepts(home, kind)).map(str::to_owned)
    }
}

/// Whether a clause puts something somewhere.
fn puts(clause: &Clause<'_>) -> bool {
    !clause.objects.is_empty() && !clause.negated && goes_somewhere(clause)
}
