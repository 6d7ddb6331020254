//! Verbs that put things somewhere: which of the places is the goal, and which only say where things were.

use super::super::lexicon::{Act, Settings, Verb};
use super::super::mention::{Spoken, Which};
use super::super::phrase::is_one_of;
use super::super::scene::is_in_state;
use super::super::syntax::{Clause, Head, Link, Phrase, Place, Relation};
use super::clearing::ANYWHERE;
use super::{Change, Interpreter};

impl<'a> Interpreter<'_, 'a> {
    /// `put`, `store`, `throw away`.
    pub(super) fn place(&mut self, clause: &Clause<'a>, verb: &Verb, next: Option<&Clause<'a>>) -> Spoken {
        if clause.objects.is_empty() && clause.places.is_empty() && !clause.complement.is_empty() {
            return self.keep(clause);
        }
        if !clause.complement.is_empty() && clause.places.is_empty() {
            return self.keep(clause);
        }
        if let Some(taken) = self.thrown_away_from(clause, verb) {
            return self.place(&taken, verb, next);
        }
        if let Some((solid, liquid)) = self.with_a_drink(clause) {
            let spoken = self.place(&solid, verb, next);
            self.pour_for(&spoken, &liquid);
            return spoken;
        }
        if let Some(laid) = self.laid_with(clause) {
            return self.place(&laid, verb, next);
        }
        if let Some(joined) = self.joined_with(clause) {
            return self.place(&joined, verb, next);
        }
        let (goal, inner, at) = self.sort_places(clause);
        if let Some(goal) = goal {
            if let Some(inner) = inner {
                if next.is_some_and(|next| moves_on(&inner, next)) {
                    return self.put(clause, &at, &inner);
                }
                return self.put_nested(clause, &at, &inner, &goal);
            }
            if let Some(under) = self.is_said_to_stand(&goal) {
                return self.put_nested(clause, &at, &goal, &under);
            }
            return self.put(clause, &at, &goal);
        }
        if clause.verb_text == "add" && clause.places.is_empty() && verb.act == Act::Place {
            let objects = self.objects(clause, &at, Some("pickupable"));
            if let Some(place) = self.place_spoken_of(&objects) {
                objects.iter().for_each(|&entity| self.put_in(entity, place));
                return Spoken { objects, placed: true, places: vec![place], ..Spoken::default() };
            }
        }
        if is_left_alone(clause) {
            self.discourse.assume(format!("\"{}\": it stays as it is", clause.text), 0.95);
            return self.only_mention(clause);
        }
        let meanwhile = clause.link == Link::While && self.lamp_wanted && self.switches_on;
        // "put the fork with the plate": where that is.
        let near = |place: &&Place| match place.relation {
            Relation::Near => true,
            Relation::With => matches!(place.phrase.head, Head::Pronoun { .. }),
            _ => false,
        };
        if let Some(near) = clause.places.iter().find(near)
            && verb.act == Act::Place
            && !meanwhile
        {
            return self.put_beside(clause, &at, near);
        }
        // "move the clock while turning on the lamp": it is carried to the light.
        let to_light = self.lamp_wanted && self.switches_on && verb.default.is_empty();
        let carried = to_light || clause.verbs.iter().any(|verb| verb.act == Act::Hold);
        if carried && verb.act == Act::Place && !clause.back {
            return self.hold(clause);
        }
        let objects = self.objects(clause, &at, Some("pickupable"));
        let goes_on = next.is_some_and(|next| {
            let again = |phrase: &Phrase| {
                matches!(phrase.head, Head::Pronoun { .. } | Head::Slices | Head::Everything)
                    || clause.objects.iter().any(|mine| mine.head == phrase.head)
                    || clause.objects.iter().any(|mine| is_one_of(phrase, mine))
            };
            (next.objects.is_empty() || next.objects.iter().any(again))
                && next
                    .verbs
                    .iter()
                    .any(|verb| matches!(verb.act, Act::Place | Act::Store | Act::Discard | Act::Set))
        });
        let homes: Vec<String> = match verb.act {
            Act::Discard => vec!["GarbageCan".to_owned()],
            _ => verb.default.clone(),
        };
        let mut places = Vec::new();
        for &entity in &objects {
            let kind = self.discourse.entities[entity].kind().to_owned();
            let home = match (verb.act, clause.back) {
                (_, true) => self.where_it_was(entity),
                (Act::Store, _) => self.home_of(&kind, &at),
                (Act::Discard, _) => homes.iter().find(|home| self.discourse.scene.has(home)).cloned(),
                _ => homes.iter().find(|home| self.discourse.scene.accepts(home, &kind)).cloned(),
            };
            match home {
                Some(home) => {
                    let place = self.discourse.place_of_kind(&home);
                    if verb.act != Act::Discard {
                        self.discourse.assume(format!("the place for the {kind} is the {home}"), 0.96);
                    }
                    self.put_in(entity, place);
                    places.push(place);
                }
                None if goes_on || clause.back || clause.verb_text.ends_with(" down") => {}
                None if self.is_served_as_it_is(clause, entity) => {
                    self.discourse.assume(format!("\"{}\": it stays where it was put", clause.text), 0.95);
                    self.spoke = true;
                }
                None => {
                    let text = self.discourse.entities[entity].text.clone();
                    self.discourse.problem(format!("it is not said where \"{text}\" goes"), 0.3);
                }
            }
        }
        Spoken { objects, placed: !places.is_empty(), places, ..Spoken::default() }
    }

    /// "put the slices in the bowl and serve them": where they were put.
    fn is_served_as_it_is(&self, clause: &Clause<'a>, entity: usize) -> bool {
        const SERVES: [&str; 9] = [
            "serve",
            "present",
            "arrange",
            "mix",
            "combine",
            "display",
            "gather",
            "mix together",
            "assemble",
        ];
        let placed = |fact: &super::Fact| {
            fact.entity == entity && matches!(fact.change, Change::Inside(_))
                || fact.change == Change::Inside(entity)
        };
        SERVES.contains(&clause.verb_text.as_str()) && self.facts.iter().any(placed)
    }

    /// "throw away the bottle on the counter": from there.
    fn thrown_away_from(&self, clause: &Clause<'a>, verb: &Verb) -> Option<Clause<'a>> {
        let bin = |place: &Place| matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| kind == "GarbageCan"));
        let lies = |place: &Place| place.relation == Relation::In;
        let said = verb.act == Act::Discard && clause.places.iter().any(lies);
        (said && !clause.places.iter().any(bin)).then(|| {
            let mut taken = clause.clone();
            for place in taken.places.iter_mut().filter(|place| lies(place)) {
                place.relation = Relation::From;
            }
            taken
        })
    }

    /// "in a box that is on a chair": the box is on the chair in the end.
    fn is_said_to_stand(&self, goal: &Place) -> Option<Place> {
        let scene = self.discourse.scene;
        let vessel = matches!(&goal.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| {
            scene.affords(kind, "pickupable") && scene.affords(kind, "receptacle")
        }));
        let takes = |place: &&Place| {
            place.relation == Relation::In
                && matches!(&place.phrase.head, Head::Noun(noun)
                    if noun.kinds.iter().any(|kind| scene.affords(kind, "receptacle")))
        };
        goal.phrase.at.iter().find(takes).filter(|_| vessel).cloned()
    }

    /// "lay the paper with the book on the table": both go there.
    fn joined_with(&self, clause: &Clause<'a>) -> Option<Clause<'a>> {
        let goes = |place: &Place| matches!(place.relation, Relation::In | Relation::To);
        let with = |place: &&Place| place.relation == Relation::With && self.is_movable(&place.phrase);
        let things: Vec<Phrase> =
            clause.places.iter().filter(with).map(|place| place.phrase.clone()).collect();
        // One thing named behind the place may stand there already: "on the desk with the laptop".
        let before = clause.places.first().is_some_and(|place| with(&place));
        let joins = !clause.objects.is_empty()
            && clause.places.iter().any(goes)
            && (before && !things.is_empty() || things.len() > 1);
        joins.then(|| {
            let mut joined = clause.clone();
            joined.places.retain(|place| !with(&place));
            joined.objects.extend(things);
            joined
        })
    }

    /// "set the table with a plate and a fork": the plate and the fork go on the table.
    fn laid_with(&self, clause: &Clause<'a>) -> Option<Clause<'a>> {
        let [place] = clause.objects.as_slice() else { return None };
        let with = |place: &&Place| place.relation == Relation::With && self.is_movable(&place.phrase);
        let things: Vec<Phrase> = clause
            .places
            .iter()
            .filter(with)
            .map(|place| place.phrase.clone())
            .chain(place.with.clone())
            .collect();
        let scene = self.discourse.scene;
        let takes =
            matches!(&place.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.is_furniture(kind)));
        (takes && !things.is_empty()).then(|| {
            let mut laid = clause.clone();
            let place = Phrase { with: Vec::new(), ..place.clone() };
            laid.places = vec![Place::new(Relation::In, "on", place)];
            laid.objects = things;
            laid
        })
    }

    /// The receptacles that a clause names, for "in it" later.
    pub(super) fn receptacles_spoken_of(&mut self, clause: &Clause<'a>) -> Vec<usize> {
        let scene = self.discourse.scene;
        let takes = |phrase: &&Phrase| matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.affords(kind, "receptacle")));
        let named = clause.places.iter().map(|place| &place.phrase).chain(&clause.objects).find(takes);
        named.map(|phrase| self.discourse.mention(phrase, &[], Some("receptacle"))).unwrap_or_default()
    }

    /// The objects end in the place.
    pub(super) fn put(&mut self, clause: &Clause<'a>, at: &[Place], goal: &Place) -> Spoken {
        let mut objects = self.objects(clause, at, Some("pickupable"));
        let defaults: Vec<&String> = clause.verbs.iter().flat_map(|verb| &verb.default).collect();
        let mut goal = goal.clone();
        if let (Head::Noun(noun), false) = (&mut goal.phrase.head, defaults.is_empty()) {
            noun.kinds.sort_by_key(|kind| !defaults.contains(&kind));
        }
        self.sort_by_top(&mut goal);
        let mut places = self.discourse.mention(&goal.phrase, &[], Some("receptacle"));
        if matches!(goal.phrase.head, Head::Pronoun { .. })
            && places.iter().any(|place| objects.contains(place))
        {
            places = self.place_spoken_of(&objects).into_iter().collect();
        }
        self.leave_what_does_not_fit(clause, &mut objects, &places);
        if let (true, Some(&place)) = (goal.on_top, places.first()) {
            let kind = self.discourse.entities[place].kind().to_owned();
            let lid = self.discourse.lexicon.is_small("lids", &[&kind.to_lowercase()]);
            if self.discourse.scene.affords(&kind, "openable") && !lid {
                let text = format!("nothing is known to stand on top of the {kind}, only within it");
                self.discourse.problem(text, 0.45);
            }
        }
        self.add_asked(&places);
        self.switch_on_what_is_lit(&goal.phrase, &places);
        self.close_what_is_closed(&goal.phrase, &places);
        // "serve the potato hot on the plate"
        for &entity in objects.iter().filter(|_| !clause.complement.is_empty()) {
            let states = self.discourse.possible_states(entity, clause.complement.clone());
            self.add_states(entity, &states);
        }
        if let Some(&place) = places.first() {
            // What surely fits says which place is meant, whatever else goes there.
            let home = self.discourse.entities[place].kind().to_owned();
            let fits = |&entity: &usize| {
                !self.discourse.scene.surely_accepts(&home, self.discourse.entities[entity].kind())
            };
            let mut in_order = objects.clone();
            in_order.sort_by_key(fits);
            let several = in_order.len() > 1 && in_order.first().is_some_and(|entity| !fits(entity));
            if several {
                self.discourse.entities[place].kinds.truncate(1);
            }
            for &entity in in_order.iter().filter(|&&entity| entity != place) {
                self.put_in(entity, place);
            }
        }
        Spoken { objects, placed: !places.is_empty(), places, ..Spoken::default() }
    }

    /// The place that something else was put in last: "fill the cup and put it there too".
    fn place_spoken_of(&self, objects: &[usize]) -> Option<usize> {
        let scene = self.discourse.scene;
        let kind = |entity: usize| self.discourse.entities[entity].kind();
        let takes = |place: &usize| {
            !objects.contains(place)
                && objects.iter().all(|&object| scene.accepts(kind(*place), kind(object)))
        };
        // "fill the pot and add the potato": to what was spoken of, where that did not go to a place that takes it.
        let spoken = || self.discourse.spoken.iter().rev();
        let nearest =
            spoken().find_map(|spoken| spoken.places.iter().chain(&spoken.objects).find(|e| takes(e)));
        let receptacle =
            |place: &&usize| !objects.contains(place) && scene.affords(kind(**place), "receptacle");
        nearest.or_else(|| spoken().flat_map(|spoken| &spoken.places).find(receptacle)).copied()
    }

    /// "everything in the fridge": what the fridge takes.
    fn leave_what_does_not_fit(&mut self, clause: &Clause<'a>, objects: &mut Vec<usize>, places: &[usize]) {
        let everything = |phrase: &Phrase| phrase.head == Head::Everything;
        let Some(&place) = places.first().filter(|_| clause.objects.iter().all(everything)) else { return };
        let scene = self.discourse.scene;
        let entities = &self.discourse.entities;
        let home = entities[place].kind().to_owned();
        let left: Vec<usize> =
            // What was spoken of before is meant whether it fits or not.
            objects
                .iter()
                .copied()
                .filter(|&e| matches!(entities[e].which, Which::Named(_)))
                .filter(|&e| !scene.accepts(&home, entities[e].kind()))
                .collect();
        if left.is_empty() || left.len() == objects.len() {
            return;
        }
        let mut names: Vec<&str> = left.iter().map(|&e| entities[e].kind()).collect();
        names.dedup();
        let text = format!("the {home} takes no {}: left where they are", names.join(", "));
        objects.retain(|entity| !left.contains(entity));
        self.discourse.assume(text, 0.97);
    }

    /// What is put "on" a cabinet is put on what has a top rather than in what has a door, and "in" a dresser means in a
    /// drawer.
    fn sort_by_top(&self, place: &mut Place) {
        let scene = self.discourse.scene;
        let Head::Noun(noun) = &mut place.phrase.head else { return };
        let takes = |kind: &str| scene.is_furniture(kind);
        let opens = |kind: &str| scene.affords(kind, "openable");
        let fits = |kind: &str| takes(kind) && opens(kind) == place.within;
        if !noun.class && (place.upon || place.within) && noun.kinds.iter().any(|kind| fits(kind)) {
            noun.kinds.sort_by_key(|kind| takes(kind) && !fits(kind));
        }
    }

    /// "a spoon in a cup on the table": the spoon in the cup, and the cup on the table.
    fn put_nested(&mut self, clause: &Clause<'a>, at: &[Place], inner: &Place, goal: &Place) -> Spoken {
        let spoken = self.put(clause, at, inner);
        let mut goal = goal.clone();
        self.sort_by_top(&mut goal);
        let places = self.discourse.mention(&goal.phrase, &[], Some("receptacle"));
        if let (Some(&carrier), Some(&place)) = (spoken.places.first(), places.first()) {
            self.put_in(carrier, place);
        }
        Spoken { objects: spoken.objects, places: spoken.places, placed: true, ..Spoken::default() }
    }

    /// Places one thing, and lets what the receptacle takes decide what both are.
    pub(super) fn put_in(&mut self, entity: usize, place: usize) {
        self.discourse.fit(entity, place);
        self.add(entity, Change::Inside(place));
    }

    /// "on a lit burner": where none is lit now, it is to be lit.
    fn switch_on_what_is_lit(&mut self, phrase: &Phrase, places: &[usize]) {
        let on = Settings::from([("isToggled".to_owned(), crate::offline::yes())]);
        if phrase.selects.get("isToggled") != on.get("isToggled") {
            return;
        }
        for &place in places {
            let switch = self.switch_of(place, &on);
            let kind = self.discourse.entities[switch].kind().to_owned();
            let objects = self.discourse.scene.of_kind(&kind);
            let lit = objects.iter().any(|object| is_in_state(object, &on));
            if !lit && self.discourse.scene.affords(&kind, "toggleable") {
                self.add_states(switch, &on);
            }
        }
    }

    /// Where things of a type are kept, other than where it comes from.
    fn home_of(&self, kind: &str, from: &[Place]) -> Option<String> {
        let scene = self.discourse.scene;
        let left = |home: &str| {
            let of = |place: &Place| {
                let Head::Noun(noun) = &place.phrase.head else { return false };
                let here = noun.kinds.iter().find(|kind| scene.has(kind));
                place.relation == Relation::From && here.is_some_and(|kind| kind == home)
            };
            from.iter().any(of)
        };
        let mut homes = self.discourse.lexicon.homes(kind).filter(|home| scene.accepts(home, kind));
        let home = homes.find(|home| !left(home)).map(str::to_owned);
        // What may not stay where it is kept goes elsewhere.
        let elsewhere = || {
            let free = |place: &&str| !left(place) && scene.accepts(place, kind);
            ANYWHERE.into_iter().find(free).map(str::to_owned)
        };
        home.or_else(|| from.iter().any(|place| place.relation == Relation::From).then(elsewhere)?)
    }
}

/// "leave the knife", "leave them alone": nothing is done.
fn is_left_alone(clause: &Clause<'_>) -> bool {
    let left = clause.verb_text == "leave" && !clause.objects.is_empty();
    left && clause.places.is_empty() && clause.complement.is_empty() && !clause.back
}

/// "put the spoon in the bowl in the fridge and put the bowl on the table": the bowl was in the fridge and goes elsewhere.
fn moves_on(inner: &Place, next: &Clause<'_>) -> bool {
    let goes = |place: &Place| matches!(place.relation, Relation::In | Relation::To);
    let same = |phrase: &Phrase| match (&phrase.head, &inner.phrase.head) {
        (Head::Noun(a), Head::Noun(b)) => a.word == b.word,
        (Head::Pronoun { plural }, _) => !plural,
        _ => false,
    };
    next.verbs.iter().any(|verb| matches!(verb.act, Act::Place | Act::Hold))
        && next.places.iter().any(goes)
        && matches!(next.objects.as_slice(), [phrase] if same(phrase))
}
