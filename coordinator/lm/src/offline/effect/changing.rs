//! Verbs that change what a thing is: washed, cut, heated, switched, filled.

use lamma_domains::goal::PropertyValue;

use super::super::lexicon::{Act, Settings, Verb};
use super::super::mention::{Spoken, Which};
use super::super::syntax::{Clause, Head, Phrase, Place, Relation};
use super::{Change, Interpreter};

impl<'a> Interpreter<'_, 'a> {
    pub(super) fn set(&mut self, clause: &Clause<'a>, verb: &Verb, next: Option<&Clause<'a>>) -> Spoken {
        if verb.set.get("isToggled") == Some(&super::super::yes()) && clause.places.iter().any(is_a_while) {
            let text = format!("\"{}\" does not last, so it is no goal", clause.text);
            self.discourse.assume(text, 0.98);
            return self.only_mention(clause);
        }
        let is_tool = |place: &Place| matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| verb.tools.contains(kind)));
        // "wash everything in the sink": what is in it, wherever it is washed.
        let everything = clause.objects.iter().any(|phrase| phrase.head == Head::Everything);
        let at: Vec<Place> = clause
            .places
            .iter()
            .filter(|place| everything || !is_tool(place))
            .filter(|place| matches!(place.relation, Relation::In | Relation::From))
            .cloned()
            .collect();
        let objects = match washed_with_water(clause, verb) {
            Some(washed) => self.objects(&washed, &at, verb.wants.as_deref()),
            None => self.objects(clause, &at, verb.wants.as_deref()),
        };
        let mut changed = Vec::new();
        for &entity in &objects {
            let switched = self.switched_for(entity, &verb.set);
            let target = self.switch_of(entity, switched.as_ref().unwrap_or(&verb.set));
            let states = switched.unwrap_or_else(|| self.discourse.adapted_states(target, verb));
            if states.is_empty() && !verb.set.is_empty() {
                // Never less than was said without saying so.
                let entity = &self.discourse.entities[entity];
                let text = format!("\"{}\" ({}) cannot change so", entity.text, entity.kind());
                self.discourse.problem(text, 0.3);
            }
            self.add_states(target, &states);
            self.discourse.entities[target].asked.extend(states);
            changed.push(target);
        }
        for place in clause.places.iter().filter(|place| is_tool(place)) {
            if matches!(verb.act, Act::Heat | Act::Cook) && verb.device.is_none() {
                let text = &place.phrase.text;
                self.discourse
                    .assume(format!("\"{text}\" is not part of the goal: any source of heat will do"), 0.99);
            }
        }
        if verb.wants.as_deref() == Some("sliceable")
            || clause.places.iter().any(|p| p.relation == Relation::To)
        {
            self.stay_where_cut(clause, verb, &changed);
        }
        self.stay_where_it_was_cooked(clause, verb, &changed);
        if next.is_none() {
            self.stay_where_it_was_said_to_be(clause, verb, &changed);
        }
        self.put_down_tools(verb);
        self.hold_what_is_with(clause, verb);
        let places = self.places_spoken_of(&clause.places);
        // "turn on the stove and put the pan on it": not on its knob.
        let reached = objects.into_iter().filter(|entity| !changed.contains(entity)).collect();
        Spoken { objects: changed, places, reached, ..Spoken::default() }
    }

    /// "take off the tomato": a thing that is carried and cannot be so is not to be so.
    pub(super) fn note_what_cannot_be(&mut self) {
        for fact in self.facts.iter().filter(|fact| fact.clause == self.clause) {
            let Change::State(property, value) = &fact.change else { continue };
            let whole = property == "isBroken" && *value == super::super::no();
            if !whole && self.discourse.affords(self.discourse.entities[fact.entity].kind(), "pickupable") {
                self.discourse.note_if_unable(fact.entity, property);
            }
        }
    }

    /// "heat the water in the mug": the mug is heated.
    pub(super) fn lies_in_a_vessel(&self, clause: &Clause<'a>) -> Option<Clause<'a>> {
        let scene = self.discourse.scene;
        let vessel = |place: &Place| {
            place.relation == Relation::In
                && matches!(&place.phrase.head, Head::Noun(noun)
                    if noun.kinds.iter().any(|kind| scene.affords(kind, "canFillWithLiquid")))
        };
        let at = clause.places.iter().position(vessel)?;
        let mut heated = clause.clone();
        heated.objects = vec![heated.places.remove(at).phrase];
        Some(heated)
    }

    /// What was spoken of last and holds liquids.
    pub(super) fn vessel_spoken_of(&self) -> Option<usize> {
        let discourse = &self.discourse;
        let holds = |&e: &usize| discourse.scene.affords(discourse.entities[e].kind(), "canFillWithLiquid");
        // "the plate, the bowl and a cup, and pour water": what one drinks from.
        let drinks = |e: &usize| ["Cup", "Mug"].contains(&discourse.entities[*e].kind());
        let of = |spoken: &'_ Spoken| {
            let named = || spoken.places.iter().chain(&spoken.objects).filter(|entity| holds(entity));
            named().find(|entity| drinks(entity)).or_else(|| named().next()).copied()
        };
        discourse.spoken.iter().rev().find_map(of)
    }

    /// "put the potato in the pot and add water": to the pot.
    pub(super) fn fill_vessel_spoken_of(&mut self, clause: &Clause<'a>) -> Spoken {
        let Some(vessel) = self.vessel_spoken_of() else { return Spoken::default() };
        for liquid in clause.objects.iter().filter_map(Phrase::liquid) {
            self.add_states(vessel, &super::super::mention::filled(liquid));
        }
        Spoken { objects: vec![vessel], ..Spoken::default() }
    }

    /// "slice the potato on the table": it is on the table when it is done.
    fn stay_where_cut(&mut self, clause: &Clause<'a>, verb: &Verb, objects: &[usize]) {
        let scene = self.discourse.scene;
        let cuts = verb.wants.as_deref() == Some("sliceable");
        let is_tool = |place: &Place| matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| verb.tools.contains(kind)));
        let takes = |place: &&Place| {
            (place.relation == Relation::In && cuts || place.relation == Relation::To && !is_tool(place))
                && match &place.phrase.head {
                    Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.affords(kind, "receptacle")),
                    Head::Pronoun { plural } => !plural && place.relation == Relation::To,
                    _ => false,
                }
        };
        let Some(place) = clause.places.iter().find(takes) else { return };
        if let [place, ..] = self.discourse.mention(&place.phrase, &[], Some("receptacle"))[..] {
            for &entity in objects.iter().filter(|&&entity| entity != place) {
                self.discourse.fit(entity, place);
                self.add(entity, Change::Inside(place));
            }
        }
    }

    /// What was picked up as the verb's tool is not held for its own sake.
    fn put_down_tools(&mut self, verb: &Verb) {
        let entities = &self.discourse.entities;
        self.facts.retain(|fact| {
            fact.change != Change::Held
                || !entities[fact.entity].kinds.iter().any(|kind| verb.tools.contains(kind))
        });
        // "take a knife and slice the bread, then put everything in the pot": not the knife.
        let tool = |e: &usize| entities[*e].kinds.iter().any(|kind| verb.tools.contains(kind));
        for spoken in self.discourse.spoken.iter_mut().rev().take(2) {
            if !spoken.placed && !spoken.objects.is_empty() && spoken.objects.iter().all(tool) {
                spoken.reached.append(&mut spoken.objects);
            }
        }
    }

    /// "turn on the lamp with a book in hand": the book is held.
    fn hold_what_is_with(&mut self, clause: &Clause<'a>, verb: &Verb) {
        if verb.wants.as_deref() != Some("toggleable") {
            return;
        }
        let with = clause.objects.iter().flat_map(|phrase| &phrase.with);
        let places = clause.places.iter().filter(|place| place.relation == Relation::With);
        let phrases: Vec<Phrase> = with.chain(places.map(|place| &place.phrase)).cloned().collect();
        for phrase in phrases {
            let held = self.discourse.mention(&phrase, &[], Some("pickupable"));
            // "turn on the TV with the remote": a tool of its own.
            let tool = |&e: &usize| self.discourse.entities[e].kind() == "RemoteControl";
            let screen = clause.objects.iter().any(|phrase| {
                matches!(&phrase.head, Head::Noun(noun) if noun.kinds.first().is_some_and(|kind| kind == "Television"))
            });
            if !(screen && held.iter().all(tool)) {
                self.take(&held);
            }
        }
    }

    /// What is itself a source of heat is hot while it is on: "heat up the stove", "the toaster should be cold".
    pub(super) fn switched_for(&self, entity: usize, states: &Settings) -> Option<Settings> {
        let (scene, kind) = (self.discourse.scene, self.discourse.entities[entity].kind());
        let temperature = states.get("temperature").filter(|_| states.len() == 1)?;
        let switch = self.discourse.lexicon.control(kind).unwrap_or(kind);
        let heats = scene.affords(kind, "isHeatSource") && scene.affords(switch, "toggleable");
        let on = *temperature == PropertyValue::Word("Hot".to_owned());
        heats.then(|| Settings::from([("isToggled".to_owned(), PropertyValue::Flag(on))]))
    }

    /// What is switched when an entity is to be on or off.
    pub(super) fn switch_of(&mut self, entity: usize, states: &Settings) -> usize {
        let kind = self.discourse.entities[entity].kind().to_owned();
        let control = self.discourse.lexicon.control(&kind).map(str::to_owned);
        match control {
            Some(control) if states.contains_key("isToggled") && self.discourse.scene.has(&control) => {
                let on = states.get("isToggled") == Some(&super::super::yes());
                self.discourse.control(entity, control, on)
            }
            _ => entity,
        }
    }

    pub(super) fn fill(&mut self, clause: &Clause<'a>, verb: &Verb) -> Spoken {
        let out_of = |place: &&Place| place.relation == Relation::From && place.phrase.liquid().is_none();
        let into = |place: &Place| matches!(place.relation, Relation::In | Relation::To);
        if let (Act::Pour, Some(from), false) =
            (verb.act, clause.places.iter().find(out_of), clause.places.iter().any(into))
        {
            let objects = vec![from.phrase.clone()];
            return self.empty(&Clause { objects, places: Vec::new(), ..clause.clone() });
        }
        let said = clause
            .objects
            .iter()
            .flat_map(|phrase| std::iter::once(phrase).chain(&phrase.with))
            .chain(clause.places.iter().map(|place| &place.phrase))
            .find_map(|phrase| phrase.liquid().map(str::to_owned));
        let vessels: Vec<Phrase> =
            clause.objects.iter().filter(|phrase| phrase.liquid().is_none()).cloned().collect();
        let mut fill = clause.clone();
        let poured = verb.act == Act::Pour && (vessels.is_empty() || clause.places.iter().any(into));
        if poured || vessels.is_empty() {
            fill.objects = clause
                .places
                .iter()
                .filter(|place| {
                    matches!(place.relation, Relation::In | Relation::To) && place.phrase.liquid().is_none()
                })
                .map(|place| place.phrase.clone())
                .collect();
        } else {
            fill.objects = vessels;
        }
        let solid =
            clause.objects.iter().any(|phrase| phrase.with.iter().any(|with| with.liquid().is_none()));
        let objects = match said.as_deref().filter(|_| fill.objects.is_empty()) {
            Some(liquid) => self.vessel_for(liquid, &fill),
            None => self.objects(&fill, &[], Some("canFillWithLiquid")),
        };
        if verb.act == Act::Pour && self.is_hung_up(&objects) {
            self.discourse.problem(format!("I do not know what to do for \"{}\"", clause.text), 0.25);
            return Spoken { objects, ..Spoken::default() };
        }
        if said.is_none() && solid {
            return Spoken { objects, ..Spoken::default() };
        }
        let said = said.or_else(|| self.is_by_the_coffee_machine(clause).then(|| "coffee".to_owned()));
        // "make coffee and pour it into the mug"
        let poured = clause.objects.iter().any(|phrase| matches!(phrase.head, Head::Pronoun { .. }));
        let brewed = self.facts.iter().rev().filter(|_| poured).find_map(|fact| match &fact.change {
            Change::State(property, PropertyValue::Word(liquid)) if property == "fillLiquid" => {
                Some(liquid.clone())
            }
            _ => None,
        });
        let liquid = said.or(brewed.filter(|_| verb.act == Act::Pour)).unwrap_or_else(|| {
            self.discourse.assume("it is filled with water".to_owned(), 0.98);
            "water".to_owned()
        });
        for &entity in &objects {
            self.add(entity, Change::State("isFilledWithLiquid".to_owned(), super::super::yes()));
            self.add(entity, Change::State("fillLiquid".to_owned(), PropertyValue::Word(liquid.clone())));
        }
        let from = clause.places.iter().filter(|place| place.relation == Relation::From);
        let reached = self.places_spoken_of(&from.cloned().collect::<Vec<_>>());
        Spoken { objects, reached, ..Spoken::default() }
    }

    /// "draw the curtains": nothing that liquid is drawn into.
    fn is_hung_up(&self, objects: &[usize]) -> bool {
        let kind = |e: &usize| self.discourse.entities[*e].kind();
        objects.iter().any(|e| ["Curtains", "Blinds", "ShowerCurtain"].contains(&kind(e)))
    }

    /// "use the coffee machine to fill the mug", "fill the mug with the coffee machine": with coffee.
    fn is_by_the_coffee_machine(&self, clause: &Clause<'a>) -> bool {
        let brews = |kind: &str| kind == "CoffeeMachine";
        let said_with = clause.places.iter().any(|place| {
            matches!(place.relation, Relation::With | Relation::From)
                && matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.first().is_some_and(|kind| brews(kind)))
        });
        let entities = &self.discourse.entities;
        let off = |e: usize| {
            let off = Change::State("isToggled".to_owned(), super::super::no());
            self.facts.iter().any(|fact| fact.entity == e && fact.change == off)
        };
        let brews_now = |e: usize| brews(entities[e].kind()) && !off(e) && clause.places.is_empty();
        let before = self.discourse.spoken.last().is_some_and(|spoken| {
            spoken.objects.iter().chain(&spoken.places).chain(&spoken.reached).any(|&e| brews_now(e))
        });
        said_with || before
    }

    /// "pour a coffee": into what was spoken of, else into what such a thing is drunk from.
    fn vessel_for(&mut self, liquid: &str, fill: &Clause<'a>) -> Vec<usize> {
        const DRUNK_FROM: [(&str, &[&str]); 3] =
            [("coffee", &["Mug", "Cup"]), ("water", &["Cup", "Mug"]), ("wine", &["Cup", "Mug"])];
        if self.vessel_spoken_of().is_some() {
            return self.objects(fill, &[], Some("canFillWithLiquid"));
        }
        let kinds = DRUNK_FROM.iter().find(|(name, _)| *name == liquid).map_or(&[][..], |(_, kinds)| kinds);
        let kind = kinds.iter().find(|kind| self.discourse.scene.has(kind));
        let Some(kind) = kind else { return self.objects(fill, &[], Some("canFillWithLiquid")) };
        self.discourse
            .assume(format!("it is not said what the {liquid} is to be in: a {kind} is taken"), 0.8);
        vec![self.discourse.entity(kind, Which::Any)]
    }

    pub(super) fn empty(&mut self, clause: &Clause<'a>) -> Spoken {
        let objects = self.objects(clause, &clause.places, Some("canFillWithLiquid"));
        for &entity in &objects {
            let kind = self.discourse.entities[entity].kind().to_owned();
            if self.discourse.scene.affords(&kind, "canFillWithLiquid") {
                self.add(entity, Change::State("isFilledWithLiquid".to_owned(), super::super::no()));
            } else {
                self.discourse.problem(format!("a {kind} holds no liquid to pour out"), 0.3);
            }
        }
        Spoken { objects, ..Spoken::default() }
    }
}

/// "for a few seconds"
fn is_a_while(place: &Place) -> bool {
    const TIMES: [&str; 8] = ["second", "seconds", "minute", "minutes", "moment", "while", "bit", "time"];
    place.relation == Relation::For
        && matches!(&place.phrase.head, Head::Unknown(word) if TIMES.contains(&word.as_str()))
}

/// "rinse the mug with water": by what it is rinsed, not what is to be in it.
fn washed_with_water<'a>(clause: &Clause<'a>, verb: &Verb) -> Option<Clause<'a>> {
    let water = |phrase: &Phrase| phrase.liquid() == Some("water");
    let with = clause.objects.iter().any(|phrase| phrase.with.iter().any(water));
    let washes = verb.set.get("isDirty") == Some(&super::super::no());
    (washes && with && !clause.says_any(&["in", "inside", "full", "filled"])).then(|| {
        let mut washed = clause.clone();
        washed.objects.iter_mut().for_each(|phrase| phrase.with.retain(|with| !water(with)));
        washed
    })
}
