//! From clauses to facts: what each verb makes of its objects and places.

use lamma_domains::goal::PropertyValue;

use super::lexicon::{Act, Settings, Verb};
use super::mention::{Discourse, Spoken};
use super::syntax::{Clause, Head, Phrase, Place, Relation};

/// What a clause makes of an entity.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// A property takes a value.
    State(String, PropertyValue),
    /// It is in or on another entity.
    Inside(usize),
    /// It is in a hand.
    Held,
}

/// A change, and the clause that makes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// The clause.
    pub clause: usize,
    /// The entity.
    pub entity: usize,
    /// The change.
    pub change: Change,
}

/// Interprets clauses one after the other.
pub struct Interpreter<'d, 'a> {
    /// What was spoken of.
    pub discourse: &'d mut Discourse<'a>,
    /// The facts so far.
    pub facts: Vec<Fact>,
    /// Whether something is held up to be looked at, so that a light is a lamp.
    pub lamp_wanted: bool,
    /// Whether some clause switches something on.
    switches_on: bool,
    clause: usize,
    /// What must not become so.
    bans: Vec<forbid::Ban>,
    /// Whether the clause at hand said anything, new or not.
    pub spoke: bool,
}

impl<'d, 'a> Interpreter<'d, 'a> {
    /// An interpreter with no facts yet.
    pub fn new(discourse: &'d mut Discourse<'a>, clauses: &[Clause<'a>]) -> Self {
        let holds = |clause: &Clause<'_>| {
            clause.verbs.iter().any(|verb| matches!(verb.act, Act::Hold | Act::Examine | Act::Place))
        };
        let sets_down = clauses.iter().any(|clause| {
            holds(clause)
                && clause.places.iter().any(|place| {
                    matches!(place.relation, Relation::To)
                        || place.relation == Relation::In
                            && clause.verbs.iter().any(|verb| verb.act == Act::Place)
                })
        });
        let lamp_wanted = clauses.iter().any(holds) && !sets_down;
        let switches_on = clauses
            .iter()
            .any(|clause| clause.verbs.iter().any(|verb| verb.set.get("isToggled") == Some(&super::yes())));
        Self {
            discourse,
            facts: Vec::new(),
            lamp_wanted,
            switches_on,
            clause: 0,
            bans: Vec::new(),
            spoke: false,
        }
    }

    /// The clause that facts are added for from now on.
    pub fn at_clause(&mut self, index: usize) {
        self.clause = index;
    }

    /// Adds the facts of a clause. `next` is the verb of the one after it.
    pub fn clause(&mut self, index: usize, clause: &Clause<'a>, next: Option<&Clause<'a>>) {
        self.clause = index;
        self.spoke = false;
        let mut spoken = Spoken::default();
        if clause.negated {
            spoken = self.forbid(clause);
        } else if let Some(verb) = self.choose(clause) {
            spoken = match verb.act {
                Act::Go => self.go(clause, next),
                Act::Keep => self.keep(clause),
                Act::Use => self.use_tool(clause, next),
                Act::Place | Act::Discard | Act::Store => self.place(clause, verb, next),
                Act::Hold => self.hold(clause),
                Act::Examine => self.examine(clause),
                Act::Chill | Act::Heat | Act::Cook | Act::Set => self.set(clause, verb),
                Act::Fill | Act::Pour => self.fill(clause, verb),
                Act::Empty => self.empty(clause),
            };
        } else if !clause.complement.is_empty() {
            // "the lamp should be off" asks for it; "the lamp is off" only says so.
            if clause
                .words
                .iter()
                .any(|word| ["should", "must", "needs", "need", "shall", "be"].contains(&word.as_str()))
            {
                spoken = self.keep(clause);
            } else {
                self.discourse.problem(format!("it is not said what to do about \"{}\"", clause.text), 0.3);
            }
        } else if !clause.objects.is_empty() || !clause.unknown.is_empty() {
            self.discourse.problem(format!("I do not know what to do for \"{}\"", clause.text), 0.25);
        }
        for word in clause.unknown.iter().skip(usize::from(clause.verbs.is_empty())) {
            self.discourse.assume(format!("passed over \"{word}\""), 0.85);
        }
        self.discourse.spoken.push(spoken);
    }

    /// The first reading of the verb whose object can be had.
    fn choose(&self, clause: &Clause<'a>) -> Option<&'a Verb> {
        let complements = !clause.complement.is_empty();
        if complements && let Some(keep) = clause.verbs.iter().find(|verb| verb.act == Act::Keep) {
            return Some(keep);
        }
        let scene = self.discourse.scene;
        let fits = |verb: &&&Verb| {
            let Some(wants) = &verb.wants else { return verb.act != Act::Keep || complements };
            clause.objects.iter().any(|phrase| match &phrase.head {
                Head::Noun(noun) => noun.kinds.iter().any(|kind| {
                    scene.affords(kind, wants)
                        || wants == "toggleable" && self.discourse.lexicon.control(kind).is_some()
                }),
                Head::Named(name) => {
                    scene.named(name).is_some_and(|object| object.affordances.iter().any(|a| a == wants))
                }
                Head::Pronoun { .. } => self.discourse.spoken.iter().any(|spoken| {
                    spoken.objects.iter().chain(&spoken.places).any(|&e| {
                        self.discourse.entities[e].kinds.iter().any(|kind| scene.affords(kind, wants))
                    })
                }),
                _ => false,
            })
        };
        clause.verbs.iter().find(fits).or(clause.verbs.first()).copied()
    }

    pub(super) fn add(&mut self, entity: usize, change: Change) {
        self.spoke = true;
        // What is so already is not said twice; what was changed in between is.
        let last = self
            .facts
            .iter()
            .rev()
            .find(|fact| fact.entity == entity && about_the_same(&fact.change, &change));
        if last.is_none_or(|last| last.change != change) {
            self.facts.push(Fact { clause: self.clause, entity, change });
        }
    }

    fn add_states(&mut self, entity: usize, states: &Settings) {
        for (property, value) in states {
            self.add(entity, Change::State(property.clone(), value.clone()));
        }
    }

    /// States and contents that the words themselves asked for.
    fn add_asked(&mut self, entities: &[usize]) {
        for &entity in entities {
            let asked = self.discourse.entities[entity].asked.clone();
            let fresh: Settings = asked
                .into_iter()
                .filter(|(property, _)| {
                    !self.facts.iter().any(|fact| {
                        fact.entity == entity
                            && matches!(&fact.change, Change::State(known, _) if known == property)
                    })
                })
                .collect();
            self.add_states(entity, &self.discourse.possible_states(entity, fresh));
            for content in self.discourse.entities[entity].holds.clone() {
                if !self.facts.iter().any(|f| f.entity == content && f.change == Change::Inside(entity)) {
                    self.add(content, Change::Inside(entity));
                }
                self.add_asked(&[content]);
            }
        }
    }

    /// What the clause is done to: what it says, else what was spoken of last.
    fn objects(&mut self, clause: &Clause<'a>, at: &[Place], wants: Option<&str>) -> Vec<usize> {
        let mut found: Vec<usize> = Vec::new();
        for phrase in &clause.objects {
            let phrase = self.with_lamps_first(phrase);
            for entity in self.discourse.mention(&phrase, at, wants) {
                if !found.contains(&entity) {
                    found.push(entity);
                }
            }
        }
        if clause.objects.is_empty() {
            let many = self
                .discourse
                .spoken
                .iter()
                .rev()
                .find(|s| !s.objects.is_empty())
                .is_some_and(|s| s.objects.len() > 1);
            let pronoun = Phrase::bare(Head::Pronoun { plural: many }, "it");
            found = self.discourse.mention(&pronoun, at, wants);
        }
        self.add_asked(&found);
        found
    }

    /// While something is held up to a light, the light is a lamp.
    fn with_lamps_first(&self, phrase: &Phrase) -> Phrase {
        let mut phrase = phrase.clone();
        if let (Head::Noun(noun), true) = (&mut phrase.head, self.lamp_wanted)
            && noun.kinds.len() > 1
            && noun.kinds.iter().any(|kind| kind == "DeskLamp")
        {
            noun.kinds.sort_by_key(|kind| kind == "LightSwitch");
            noun.class = false;
        }
        phrase
    }

    fn keep(&mut self, clause: &Clause<'a>) -> Spoken {
        let property = clause.complement.keys().next();
        let wants = property.and_then(|property| match property.as_str() {
            "isOpen" => Some("openable"),
            "isToggled" => Some("toggleable"),
            _ => None,
        });
        let objects = self.objects(clause, &clause.places, wants);
        if clause.complement.is_empty() {
            self.discourse.problem(format!("I do not know what is to hold in \"{}\"", clause.text), 0.3);
        }
        for &entity in &objects {
            let entity = self.switch_of(entity, &clause.complement);
            self.add_states(entity, &clause.complement);
        }
        Spoken { objects, ..Spoken::default() }
    }

    /// A tool is no goal, except a lamp that is used to look at something.
    fn use_tool(&mut self, clause: &Clause<'a>, next: Option<&Clause<'a>>) -> Spoken {
        let examines = next.is_some_and(|next| next.verbs.iter().any(|verb| verb.act == Act::Examine));
        if !examines {
            return Spoken::default();
        }
        let lamps = self.objects(clause, &clause.places, Some("toggleable"));
        for &lamp in &lamps {
            if self.discourse.scene.affords(self.discourse.entities[lamp].kind(), "toggleable") {
                self.add(lamp, Change::State("isToggled".to_owned(), super::yes()));
            }
        }
        Spoken { places: lamps, ..Spoken::default() }
    }

    fn hold(&mut self, clause: &Clause<'a>) -> Spoken {
        let goal = clause.places.iter().rposition(|place| {
            place.relation == Relation::To
                && matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| self.discourse.scene.has(kind)))
        });
        if let Some(goal) = goal {
            let lamp = matches!(&clause.places[goal].phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|kind| kind == "DeskLamp" || kind == "FloorLamp"));
            if !lamp {
                let mut at = clause.places.clone();
                let to = at.remove(goal);
                return self.put(clause, &at, &to);
            }
            let mut spoken = self.examine(clause);
            let lamps = self.discourse.mention(&clause.places[goal].phrase, &[], Some("toggleable"));
            spoken.places.extend(lamps);
            return spoken;
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
        Spoken { objects, places, placed: false }
    }

    fn take(&mut self, objects: &[usize]) {
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
    fn places_spoken_of(&mut self, places: &[Place]) -> Vec<usize> {
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

    fn examine(&mut self, clause: &Clause<'a>) -> Spoken {
        let is_light = |place: &&Place| {
            matches!(&place.phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|kind| kind == "DeskLamp" || kind == "FloorLamp"))
        };
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
            let phrase = self.with_lamps_first(&light.phrase);
            places = self.discourse.mention(&phrase, &[], Some("toggleable"));
            for &lamp in &places {
                self.add(lamp, Change::State("isToggled".to_owned(), super::yes()));
            }
        }
        Spoken { objects, places, placed: false }
    }

    fn set(&mut self, clause: &Clause<'a>, verb: &Verb) -> Spoken {
        let is_tool = |place: &Place| matches!(&place.phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| verb.tools.contains(kind)));
        let at: Vec<Place> = clause
            .places
            .iter()
            .filter(|place| !is_tool(place) && matches!(place.relation, Relation::In | Relation::From))
            .cloned()
            .collect();
        let objects = self.objects(clause, &at, verb.wants.as_deref());
        let mut changed = Vec::new();
        for &entity in &objects {
            let target = self.switch_of(entity, &verb.set);
            let states = self.discourse.adapted_states(target, verb);
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
        self.put_down_tools(verb);
        self.hold_what_is_with(clause, verb);
        let places = self.places_spoken_of(&clause.places);
        Spoken { objects: changed, places, placed: false }
    }

    /// What was picked up as the verb's tool is not held for its own sake.
    fn put_down_tools(&mut self, verb: &Verb) {
        let entities = &self.discourse.entities;
        self.facts.retain(|fact| {
            fact.change != Change::Held
                || !entities[fact.entity].kinds.iter().any(|kind| verb.tools.contains(kind))
        });
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
            self.take(&held);
        }
    }

    /// What is switched when an entity is to be on or off.
    fn switch_of(&mut self, entity: usize, states: &Settings) -> usize {
        let kind = self.discourse.entities[entity].kind().to_owned();
        let control = self.discourse.lexicon.control(&kind).map(str::to_owned);
        match control {
            Some(control) if states.contains_key("isToggled") && self.discourse.scene.has(&control) => {
                let on = states.get("isToggled") == Some(&super::yes());
                self.discourse.control(entity, control, on)
            }
            _ => entity,
        }
    }

    fn fill(&mut self, clause: &Clause<'a>, verb: &Verb) -> Spoken {
        let liquid_of = |phrase: &Phrase| match &phrase.head {
            Head::Liquid(liquid) => Some(liquid.clone()),
            Head::Noun(noun) if ["water", "wine", "coffee"].contains(&noun.word.as_str()) => {
                Some(noun.word.clone())
            }
            _ => None,
        };
        let said = clause
            .objects
            .iter()
            .flat_map(|phrase| std::iter::once(phrase).chain(&phrase.with))
            .chain(clause.places.iter().map(|place| &place.phrase))
            .find_map(liquid_of);
        let vessels: Vec<Phrase> =
            clause.objects.iter().filter(|phrase| liquid_of(phrase).is_none()).cloned().collect();
        let mut fill = clause.clone();
        if verb.act == Act::Pour || vessels.is_empty() {
            fill.objects = clause
                .places
                .iter()
                .filter(|place| {
                    matches!(place.relation, Relation::In | Relation::To)
                        && liquid_of(&place.phrase).is_none()
                })
                .map(|place| place.phrase.clone())
                .collect();
        } else {
            fill.objects = vessels;
        }
        let solid =
            clause.objects.iter().any(|phrase| phrase.with.iter().any(|with| liquid_of(with).is_none()));
        let objects = self.objects(&fill, &[], Some("canFillWithLiquid"));
        if said.is_none() && solid {
            return Spoken { objects, ..Spoken::default() };
        }
        let liquid = said.unwrap_or_else(|| {
            self.discourse.assume("it is filled with water".to_owned(), 0.98);
            "water".to_owned()
        });
        for &entity in &objects {
            self.add(entity, Change::State("isFilledWithLiquid".to_owned(), super::yes()));
            self.add(entity, Change::State("fillLiquid".to_owned(), PropertyValue::Word(liquid.clone())));
        }
        Spoken { objects, ..Spoken::default() }
    }

    fn empty(&mut self, clause: &Clause<'a>) -> Spoken {
        let objects = self.objects(clause, &clause.places, Some("canFillWithLiquid"));
        for &entity in &objects {
            let kind = self.discourse.entities[entity].kind().to_owned();
            if self.discourse.scene.affords(&kind, "canFillWithLiquid") {
                self.add(entity, Change::State("isFilledWithLiquid".to_owned(), super::no()));
            } else {
                self.discourse.problem(format!("a {kind} holds no liquid to pour out"), 0.3);
            }
        }
        Spoken { objects, ..Spoken::default() }
    }
}

/// Whether one change can undo the other.
fn about_the_same(a: &Change, b: &Change) -> bool {
    match (a, b) {
        (Change::State(a, _), Change::State(b, _)) => a == b,
        (Change::State(..), _) | (_, Change::State(..)) => false,
        _ => true,
    }
}

mod forbid;
mod placing;
