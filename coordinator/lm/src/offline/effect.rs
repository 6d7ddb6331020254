//! From clauses to facts: what each verb makes of its objects and places.

use lamma_domains::goal::PropertyValue;

use super::lexicon::{Act, Settings, Verb};
use super::mention::{Discourse, Spoken};
use super::syntax::{Clause, Head, Phrase, Place, Quantity, Relation};

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
    pub(super) prohibitions: Vec<forbid::Prohibition>,
    /// Whether the clause at hand said anything, new or not.
    pub spoke: bool,
    /// The clauses that were read as situations.
    pub situations: Vec<usize>,
}

impl<'d, 'a> Interpreter<'d, 'a> {
    /// An interpreter with no facts yet.
    pub fn new(discourse: &'d mut Discourse<'a>, clauses: &[Clause<'a>]) -> Self {
        let holds = |clause: &Clause<'_>| {
            clause.verbs.iter().any(|verb| matches!(verb.act, Act::Hold | Act::Examine | Act::Place))
        };
        let sets_down = clauses.iter().any(|clause| {
            holds(clause)
                && !clause.objects.is_empty()
                && clause.places.iter().any(|place| {
                    matches!(place.relation, Relation::To)
                        || place.relation == Relation::In
                            && clause.verbs.iter().any(|verb| verb.act == Act::Place)
                })
        });
        let in_hand = |clause: &Clause<'_>| {
            let scene = discourse.scene;
            let movable = |place: &&Place| {
                matches!(&place.phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|kind| scene.affords(kind, "pickupable")))
            };
            clause.verbs.iter().any(|verb| verb.wants.as_deref() == Some("toggleable"))
                && clause.places.iter().filter(|place| place.relation == Relation::With).any(|p| movable(&p))
        };
        let lamp_wanted = clauses.iter().any(|clause| holds(clause) || in_hand(clause)) && !sets_down;
        let switches_on = clauses
            .iter()
            .any(|clause| clause.verbs.iter().any(|verb| verb.set.get("isToggled") == Some(&super::yes())));
        Self {
            discourse,
            facts: Vec::new(),
            lamp_wanted,
            switches_on,
            clause: 0,
            prohibitions: Vec::new(),
            spoke: false,
            situations: Vec::new(),
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
            spoken = match (self.not_to_be_left(clause), self.not_there(clause)) {
                (Some(kept), _) => self.keep(&kept),
                (_, Some(elsewhere)) => self.put_elsewhere(&elsewhere, next),
                _ => self.forbid(clause),
            };
        } else if let Some(elsewhere) = self.not_there(clause) {
            spoken = self.put_elsewhere(&elsewhere, next);
        } else if says_the_same(clause) && self.same_again(clause, &mut spoken) {
        } else if let Some(mended) = left_so(clause).and_then(mended).or_else(|| left_running(clause)) {
            spoken = self.complaint(clause, &mended);
        } else if let Some(verb) = self.choose(clause) {
            let liquid = !clause.objects.is_empty() && clause.objects.iter().all(|o| o.liquid().is_some());
            spoken = match verb.act {
                Act::Place | Act::Hold | Act::Empty if liquid && self.poured_from(clause, verb).is_some() => {
                    let from = self.poured_from(clause, verb).into_iter().collect();
                    self.empty(&Clause { objects: from, places: Vec::new(), ..clause.clone() })
                }
                Act::Set if liquid && self.runs_into(clause, verb) => self.fill(clause, verb),
                Act::Heat | Act::Chill if liquid && self.lies_in_a_vessel(clause).is_some() => {
                    let vessel = self.lies_in_a_vessel(clause).unwrap_or_else(|| clause.clone());
                    self.set(&vessel, verb, next)
                }
                _ if is_a_trip(clause, next) => self.trip(clause),
                Act::Place | Act::Pour
                    if liquid && clause.places.is_empty() && self.vessel_spoken_of().is_some() =>
                {
                    self.fill_vessel_spoken_of(clause)
                }
                Act::Place | Act::Hold | Act::Keep
                    if liquid && clause.places.iter().any(|place| self.runs_in(place)) =>
                {
                    self.fill(clause, verb)
                }
                Act::Go => self.go(clause, next),
                Act::Keep if clause.complement.is_empty() && next.is_some_and(speaks_of_it) => {
                    self.only_mention(clause)
                }
                Act::Keep => self.keep(clause),
                Act::Use => self.use_tool(clause, next),
                Act::Place | Act::Discard | Act::Store => self.place(clause, verb, next),
                Act::Hold => self.hold(clause),
                Act::Examine => self.examine(clause),
                Act::Chill | Act::Heat | Act::Cook | Act::Set => self.set(clause, verb, next),
                Act::Fill | Act::Pour => self.fill(clause, verb),
                Act::Empty => self.empty(clause),
            };
        } else {
            spoken = self.without_verb(index, clause, next);
        }
        for word in clause.unknown.iter().skip(usize::from(clause.verbs.is_empty())) {
            self.discourse.assume(format!("passed over \"{word}\""), 0.85);
        }
        self.note_what_cannot_be();
        let kind_of = |e: usize| self.discourse.entities[e].kind().to_owned();
        let known: Vec<String> = spoken.reached.iter().map(|&e| kind_of(e)).collect();
        let besides = self.named_besides(clause);
        let fresh =
            besides.into_iter().filter(|&e| !known.contains(&self.discourse.entities[e].kind().to_owned()));
        spoken.reached.extend(fresh);
        self.discourse.spoken.push(spoken);
    }

    /// What a clause names only to say where, with what or from where: "next to the laptop … open it".
    fn named_besides(&mut self, clause: &Clause<'a>) -> Vec<usize> {
        let tool_again = |place: &&Place| {
            place.relation == Relation::With
                && place.phrase.head == (Head::Pronoun { plural: false })
                && clause.objects.len() > 1
                && self.discourse.spoken.iter().any(|spoken| !spoken.objects.is_empty())
        };
        let besides = |place: &&Place| {
            tool_again(place)
                || matches!(place.relation, Relation::Near | Relation::With | Relation::From)
                    && place.phrase.quantity == Quantity::One
                    && place.phrase.liquid().is_none()
                    && matches!(&place.phrase.head, Head::Noun(noun)
                    if !noun.class && noun.kinds.iter().any(|kind| self.discourse.scene.has(kind)))
        };
        let phrases: Vec<Phrase> =
            clause.places.iter().filter(besides).map(|place| place.phrase.clone()).collect();
        phrases.iter().flat_map(|phrase| self.discourse.mention(phrase, &[], None)).collect()
    }

    /// What was treated as something else shall be: of what was spoken of, the last that is cut like it, else the last.
    fn model_for(&self, phrases: &[Phrase]) -> Option<usize> {
        let scene = self.discourse.scene;
        let food = phrases.iter().any(|phrase| {
            matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.affords(kind, "sliceable")))
        });
        let alike = |e: &usize| scene.affords(self.discourse.entities[*e].kind(), "sliceable") == food;
        let mut spoken =
            self.discourse.spoken.iter().rev().filter_map(|spoken| spoken.objects.last().copied());
        let last = spoken.clone().next();
        spoken.find(alike).or(last)
    }

    /// "do the same with the spoon": all that was asked for of the thing spoken of last.
    fn same_again(&mut self, clause: &Clause<'a>, spoken: &mut Spoken) -> bool {
        let kind = |phrase: &&Phrase| matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| self.discourse.scene.has(kind)));
        let places = clause.places.iter().map(|place| &place.phrase);
        let phrases: Vec<Phrase> = clause.objects.iter().chain(places).filter(kind).cloned().collect();
        let Some(model) = self.model_for(&phrases) else { return false };
        let facts: Vec<Change> =
            self.facts.iter().filter(|fact| fact.entity == model).map(|fact| fact.change.clone()).collect();
        for phrase in &phrases {
            for entity in self.discourse.mention(phrase, &[], None) {
                facts.iter().for_each(|change| self.add(entity, change.clone()));
                spoken.objects.push(entity);
            }
        }
        !spoken.objects.is_empty()
    }

    /// Whether a liquid can be put into a place: wine in the fridge stays in its bottle.
    fn runs_in(&self, place: &Place) -> bool {
        let scene = self.discourse.scene;
        if !matches!(place.relation, Relation::In | Relation::To) {
            return false;
        }
        match &place.phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.affords(kind, "canFillWithLiquid")),
            Head::Named(_) | Head::Pronoun { .. } => true,
            _ => false,
        }
    }

    /// "tip the water out of the mug": the mug.
    fn poured_from(&self, clause: &Clause<'a>, verb: &Verb) -> Option<Phrase> {
        let scene = self.discourse.scene;
        let vessel = |place: &&Place| match &place.phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.affords(kind, "canFillWithLiquid")),
            Head::Pronoun { .. } => true,
            _ => false,
        };
        let elsewhere = |place: &Place| matches!(place.relation, Relation::In | Relation::To);
        // "bring some water from the kettle" is no wish for an empty kettle.
        let all_of_it = verb.act == Act::Empty || clause.objects.iter().all(|phrase| phrase.definite);
        let from = clause.places.iter().filter(|place| place.relation == Relation::From).find(vessel)?;
        (all_of_it && !clause.places.iter().any(elsewhere)).then(|| from.phrase.clone())
    }

    /// "run water into the mug": the mug is filled.
    fn runs_into(&self, clause: &Clause<'a>, verb: &Verb) -> bool {
        verb.set.get("isToggled") == Some(&super::yes())
            && clause.places.iter().any(|place| self.runs_in(place))
    }

    /// "take the mug to the sink and wash it": the sink is where it is washed, not where it stays.
    fn trip(&mut self, clause: &Clause<'a>) -> Spoken {
        let spoken = self.only_mention(&Clause { places: Vec::new(), ..clause.clone() });
        let reached = self.receptacles_spoken_of(&Clause { objects: Vec::new(), ..clause.clone() });
        Spoken { reached, ..spoken }
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
        // "take the cup, fill it and give it to me": it is held in the end, not on the way.
        let again = change == Change::Held
            && self.facts.iter().any(|fact| fact.entity == entity && fact.clause > last_clause(last));
        if again || last.is_none_or(|last| last.change != change) {
            if again {
                self.facts.retain(|fact| fact.entity != entity || fact.change != Change::Held);
            }
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
            let phrase = self.with_lamps_first(phrase, at);
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
            // "open and switch it on": one thing of them.
            let many = many && !wants.is_some_and(|wants| ["openable", "toggleable"].contains(&wants));
            let pronoun = Phrase::bare(Head::Pronoun { plural: many }, "it");
            found = self.discourse.mention(&pronoun, at, wants);
        }
        self.add_asked(&found);
        found
    }

    /// While something is held up to a light, the light is a lamp; so is one that stands on something.
    fn with_lamps_first(&self, phrase: &Phrase, at: &[Place]) -> Phrase {
        let mut phrase = phrase.clone();
        let stands = phrase.at.iter().chain(at).any(|place| {
            place.relation == Relation::In
                && matches!(&place.phrase.head, Head::Noun(noun)
                    if noun.kinds.iter().any(|kind| self.discourse.scene.affords(kind, "receptacle")))
        });
        if let (Head::Noun(noun), true) = (&mut phrase.head, self.lamp_wanted || stands)
            && noun.kinds.len() > 1
            && noun.kinds.iter().any(|kind| kind == "DeskLamp")
        {
            noun.kinds.sort_by_key(|kind| kind == "LightSwitch");
            noun.class = false;
        }
        phrase
    }

    fn is_movable(&self, phrase: &Phrase) -> bool {
        matches!(&phrase.head, Head::Noun(noun)
            if noun.kinds.iter().any(|kind| self.discourse.scene.affords(kind, "pickupable")))
    }

    fn keep(&mut self, clause: &Clause<'a>) -> Spoken {
        if clause.complement.is_empty() && clause.objects.iter().any(|phrase| self.is_movable(phrase)) {
            let (goal, _, at) = self.sort_places(clause);
            if let Some(goal) = goal {
                return self.put(clause, &at, &goal);
            }
        }
        let property = clause.complement.keys().next();
        let wants = property.and_then(|property| match property.as_str() {
            "isOpen" => Some("openable"),
            "isToggled" => Some("toggleable"),
            _ => None,
        });
        let objects = self.objects(clause, &clause.places, wants);
        if clause.complement.is_empty()
            && clause.says_any(&["want", "need", "like", "love", "have"])
            && !objects.is_empty()
        {
            if objects.iter().all(|&entity| self.discourse.entities[entity].asked.is_empty()) {
                self.take(&objects);
            }
        } else if clause.complement.is_empty() {
            self.discourse.problem(format!("I do not know what is to hold in \"{}\"", clause.text), 0.3);
        }
        let told = objects.first().and_then(|&entity| self.switched_for(entity, &clause.complement));
        let told = told.unwrap_or_else(|| clause.complement.clone());
        let switched: Vec<usize> = objects.iter().map(|&entity| self.switch_of(entity, &told)).collect();
        for &entity in &switched {
            let states = self.discourse.possible_states(entity, told.clone());
            self.add_states(entity, &states);
            // "the slices" may be spoken of later.
            let sliced = states.into_iter().filter(|(property, _)| property == "isSliced");
            self.discourse.entities[entity].asked.extend(sliced);
        }
        self.keep_on_the_way(clause, &switched);
        if !clause.complement.is_empty() && clause.objects.iter().any(|phrase| self.is_movable(phrase)) {
            let (goal, _, _) = self.sort_places(clause);
            if let Some(goal) = goal.filter(|goal| goal.relation == Relation::In) {
                let places = self.discourse.mention(&goal.phrase, &[], Some("receptacle"));
                if let Some(&place) = places.first() {
                    objects.iter().for_each(|&entity| self.put_in(entity, place));
                }
                return Spoken { objects, placed: true, places, ..Spoken::default() };
            }
        }
        Spoken { objects, ..Spoken::default() }
    }
}

/// "likewise", "do the same", "the same with the spoon", but not "in the same drawer".
fn says_the_same(clause: &Clause<'_>) -> bool {
    let alike = |two: &[String]| {
        two[0] == "same" && ["with", "for", "to", "goes", "applies", "thing"].contains(&two[1].as_str())
    };
    clause.says_any(&["likewise"])
        || clause.says_any(&["same"]) && clause.says_any(&["do", "doing"])
        || clause.words.windows(2).any(alike)
}

/// Whether a clause is about what was just spoken of.
fn speaks_of_it(clause: &Clause<'_>) -> bool {
    !clause.verbs.is_empty()
        && (clause.objects.is_empty()
            || clause.objects.iter().any(|phrase| matches!(phrase.head, Head::Pronoun { .. })))
}

/// Whether a clause carries something to a sink only for what the next one does to it there.
fn is_a_trip(clause: &Clause<'_>, next: Option<&Clause<'_>>) -> bool {
    const SINKS: [&str; 4] = ["SinkBasin", "Sink", "Faucet", "BathtubBasin"];
    let to_sink = |place: &Place| {
        place.relation == Relation::To
            && matches!(&place.phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|kind| SINKS.contains(&kind.as_str())))
    };
    let washes = |verb: &&Verb| {
        matches!(verb.act, Act::Fill | Act::Empty) || verb.set.get("isDirty") == Some(&super::no())
    };
    clause.verbs.iter().any(|verb| verb.act == Act::Hold)
        && matches!(clause.objects.as_slice(), [_])
        && !clause.places.is_empty()
        && clause.places.iter().all(to_sink)
        && next.is_some_and(|next| !next.negated && speaks_of_it(next) && next.verbs.iter().any(washes))
}

/// Whether a phrase may be a lamp.
pub(super) fn is_lamp(phrase: &Phrase) -> bool {
    matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| kind == "DeskLamp" || kind == "FloorLamp"))
}

/// The clause of a fact; no clause is before the first.
fn last_clause(fact: Option<&Fact>) -> usize {
    fact.map_or(usize::MAX, |fact| fact.clause)
}

/// Whether one change can undo the other.
fn about_the_same(a: &Change, b: &Change) -> bool {
    match (a, b) {
        (Change::State(a, _), Change::State(b, _)) => a == b,
        (Change::State(..), _) | (_, Change::State(..)) => false,
        _ => true,
    }
}

mod beside;
mod changing;
mod clearing;
pub(super) mod forbid;
mod goals;
mod going;
mod holding;
mod placing;
mod staying;
mod telling;

pub(in crate::offline) use telling::untrue_place;
use telling::{left_running, left_so, mended};
