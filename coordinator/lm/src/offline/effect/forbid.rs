//! Prohibitions and conditions: what must not become so, and what must be so for a clause to count.

use super::super::lexicon::{Act, Settings, Verb};
use super::super::mention::{Entity, Spoken, Which};
use super::super::scene::{Scene, is_in_state};
use super::super::syntax::{Clause, Head, Phrase, Quantity, Relation};
use super::{Change, Fact, Interpreter};
use crate::ObjectView;
use lamma_domains::goal::PropertyValue;

/// What must not come about or be done.
#[derive(Clone)]
pub struct Prohibition {
    clause: usize,
    text: String,
    entities: Vec<usize>,
    /// States that must not come about.
    states: Settings,
    /// Skills that must not be used on the entities.
    skills: Vec<&'static str>,
    /// Where nothing, or only none of the entities, may be put.
    into: Vec<usize>,
    /// "keep it closed": on the way too, if nothing asked for speaks against it.
    soft: bool,
}

impl<'a> Interpreter<'_, 'a> {
    /// "do not open the fridge": held on the way, and at the end where it is about a state.
    pub(super) fn forbid(&mut self, clause: &Clause<'a>) -> Spoken {
        let verb = self.choose(clause);
        let states = match verb {
            _ if !clause.complement.is_empty() => clause.complement.clone(),
            Some(verb) if verb.act == Act::Set => verb.set.clone(),
            _ => Settings::new(),
        };
        let scene = self.discourse.scene;
        let mut entities = Vec::new();
        let mut said = Vec::new();
        for phrase in clause.objects.iter().filter(|phrase| is_here(scene, phrase)) {
            let wants = verb.and_then(|verb| verb.wants.as_deref()).filter(|wants| *wants != "breakable");
            let found = self.any_of(phrase, wants);
            said.extend(found.iter().copied());
            entities.extend(found.into_iter().map(|entity| self.switch_of(entity, &states)));
        }
        let mut into = Vec::new();
        for place in clause.places.iter().filter(|place| is_here(scene, &place.phrase)) {
            let is_goal = matches!(place.relation, Relation::In | Relation::To) || place.there;
            if is_goal && verb.is_some_and(|verb| verb.act == Act::Place) {
                into.extend(self.any_of(&place.phrase, Some("receptacle")));
            }
        }
        let skills = verb.map(|verb| self.skills_of(verb, &into)).unwrap_or_default();
        if states.is_empty() && skills.is_empty() && into.is_empty()
            || entities.is_empty() && !clause.objects.iter().all(|phrase| phrase.head == Head::Everything)
        {
            let text = format!("\"not {}\" cannot be put as a goal, and nobody watches over it", clause.text);
            self.discourse.assume(text, 0.95);
        }
        said.extend(self.places_spoken_of(&clause.places));
        let prohibition = Prohibition {
            clause: self.clause,
            text: clause.text.clone(),
            entities: entities.clone(),
            states,
            skills,
            into,
            soft: false,
        };
        self.prohibitions.push(prohibition);
        Spoken { objects: entities, places: said, ..Spoken::default() }
    }

    /// "don't leave the fridge open": it is to be closed at the end, whatever happens on the way.
    pub(super) fn not_to_be_left(&self, clause: &Clause<'a>) -> Option<Clause<'a>> {
        let leaves = clause.says_any(&["leave", "leaving", "forget", "keep", "keeping"]);
        (leaves && !clause.complement.is_empty()).then(|| {
            let mut kept = clause.clone();
            kept.complement.values_mut().for_each(|value| *value = super::super::opposite(value));
            kept.words.retain(|word| !["leave", "leaving", "keep", "keeping"].contains(&word.as_str()));
            kept
        })
    }

    /// "keep the fridge closed": also on the way, if it is so now and nothing else asks for it to be opened.
    pub(super) fn keep_on_the_way(&mut self, clause: &Clause<'a>, entities: &[usize]) {
        let lasts = clause.says_any(&["keep", "leave", "stay", "stays", "remain", "remains", "kept", "left"]);
        let states: Settings =
            clause.complement.iter().map(|(p, v)| (p.clone(), super::super::opposite(v))).collect();
        let is_so = |&entity: &usize| {
            let objects = self.objects_of(&self.discourse.entities[entity]);
            objects.iter().all(|object| is_in_state(object, &clause.complement))
        };
        if lasts && entities.iter().all(is_so) {
            self.prohibitions.push(Prohibition {
                clause: self.clause,
                text: clause.text.clone(),
                entities: entities.to_vec(),
                states,
                skills: Vec::new(),
                into: Vec::new(),
                soft: true,
            });
        }
    }

    /// What a phrase names, every one of it where it leaves open which.
    fn any_of(&mut self, phrase: &Phrase, wants: Option<&str>) -> Vec<usize> {
        let known = self.discourse.entities.len();
        let found = self.discourse.mention(phrase, &[], wants);
        for &entity in &found {
            let fresh = entity >= known && phrase.quantity == Quantity::One;
            let thing = &mut self.discourse.entities[entity];
            if fresh && thing.which == Which::Any && self.discourse.scene.of_kind(thing.kind()).len() > 1 {
                thing.which = Which::All;
            }
        }
        found
    }

    /// What a forbidden verb does to a thing, besides changing its state.
    fn skills_of(&self, verb: &Verb, into: &[usize]) -> Vec<&'static str> {
        match verb.act {
            Act::Use => vec!["PickupObject", "SwitchOn", "OpenObject", "PutObject"],
            Act::Place if into.is_empty() => vec!["PickupObject", "PushObject", "PullObject"],
            Act::Hold => vec!["PickupObject"],
            _ => Vec::new(),
        }
    }

    /// Turns prohibitions into bans and goals, once everything is known; asks where the rest breaks one.
    pub fn settle_bans(&mut self) {
        for prohibition in std::mem::take(&mut self.prohibitions) {
            for &entity in &prohibition.entities {
                for (property, value) in &prohibition.states {
                    if let PropertyValue::Flag(flag) = value {
                        self.settle(&prohibition, entity, property, *flag);
                    }
                }
            }
            self.settle_skills(&prohibition);
        }
        self.discourse.bans.sort();
        self.discourse.bans.dedup();
    }

    fn settle_skills(&mut self, prohibition: &Prohibition) {
        let moved = |fact: &Fact| matches!(fact.change, Change::Inside(_) | Change::Held);
        for &entity in prohibition.entities.iter().filter(|_| !prohibition.skills.is_empty()) {
            let kind = self.discourse.entities[entity].kind().to_owned();
            let carried = self.facts.iter().any(|fact| moved(fact) && self.same_thing(fact.entity, entity));
            if carried && prohibition.skills.contains(&"PickupObject") {
                let text = format!("\"{}\" is forbidden, but the {kind} is to be moved", prohibition.text);
                self.discourse.problem(text, 0.3);
                continue;
            }
            for skill in &prohibition.skills {
                self.ban(skill, entity, None);
            }
        }
        for &place in &prohibition.into {
            if prohibition.entities.is_empty() {
                self.ban("PutObject", place, None);
            }
            for &entity in &prohibition.entities {
                let placed = |fact: &Fact| {
                    matches!(fact.change, Change::Inside(at) if self.same_thing(at, place))
                        && self.same_thing(fact.entity, entity)
                };
                if !self.facts.iter().any(placed) {
                    self.ban("PutObject", place, Some(entity));
                }
            }
        }
        if !prohibition.skills.is_empty() || !prohibition.into.is_empty() {
            self.discourse.assume(format!("\"not {}\" is held on the way", prohibition.text), 0.99);
        }
    }

    /// Nobody may use a skill on an entity.
    fn ban(&mut self, skill: &str, entity: usize, item: Option<usize>) {
        let name = |entity: usize| match &self.discourse.entities[entity].which {
            Which::Named(name) => name.clone(),
            _ => self.discourse.entities[entity].kind().to_owned(),
        };
        let ban = crate::Ban { skill: skill.to_owned(), object: name(entity), item: item.map(name) };
        self.discourse.bans.push(ban);
    }

    fn settle(&mut self, ban: &Prohibition, entity: usize, property: &str, flag: bool) {
        let kind = self.discourse.entities[entity].kind().to_owned();
        if let Some(reason) = self.broken_by(entity, property, flag) {
            if ban.soft {
                return;
            }
            let text = format!("\"{}\" is forbidden, but {reason}", ban.text);
            self.discourse.problem(text, 0.3);
            return;
        }
        if let Some(skill) = skill_to(property, flag) {
            self.ban(skill, entity, None);
        }
        if ban.soft {
            return;
        }
        let banned = Settings::from([(property.to_owned(), PropertyValue::Flag(flag))]);
        let objects = self.objects_of(&self.discourse.entities[entity]);
        let already = objects.iter().any(|object| is_in_state(object, &banned));
        let other_now = objects.iter().any(|object| !is_in_state(object, &banned));
        let used = self.facts.iter().any(|fact| {
            matches!(fact.change, Change::Inside(place) if self.same_thing(place, entity))
                && property == "isOpen"
                || self.same_thing(fact.entity, entity)
                    && matches!(&fact.change, Change::State(p, v) if p == property && *v != PropertyValue::Flag(flag))
        });
        if (already || !other_now) && !used {
            self.discourse
                .assume(format!("nothing is done for \"not {}\": it is so already", ban.text), 0.97);
            return;
        }
        let change = Change::State(property.to_owned(), PropertyValue::Flag(!flag));
        let text = format!("\"not {}\" is ensured for the end: {kind} {property} is {}", ban.text, !flag);
        self.discourse.assume(text, 0.97);
        self.facts.push(Fact { clause: ban.clause, entity, change });
    }

    /// Why the goal cannot be reached without breaking a ban.
    fn broken_by(&self, entity: usize, property: &str, flag: bool) -> Option<String> {
        let scene = self.discourse.scene;
        let kind = self.discourse.entities[entity].kind();
        let banned = Settings::from([(property.to_owned(), PropertyValue::Flag(flag))]);
        let objects = self.objects_of(&self.discourse.entities[entity]);
        let shut = property == "isOpen"
            && flag
            && scene.affords(kind, "openable")
            && !objects.iter().any(|object| is_in_state(object, &banned));
        self.facts.iter().find_map(|fact| {
            let thing = self.discourse.entities[fact.entity].kind();
            let mine = self.same_thing(fact.entity, entity);
            match &fact.change {
                Change::State(p, v) if mine && p == property && *v == PropertyValue::Flag(flag) => {
                    Some(format!("it is also asked for of the {kind}"))
                }
                Change::Inside(place) if shut && self.same_thing(*place, entity) => {
                    Some(format!("the {thing} cannot get into the closed {kind} otherwise"))
                }
                Change::State(p, v)
                    if shut
                        && p == "temperature"
                        && scene.affords(kind, "isColdSource")
                        && *v == PropertyValue::Word("Cold".to_owned()) =>
                {
                    Some(format!("the {thing} cannot get cold without the {kind}"))
                }
                _ if shut && !mine => {
                    let things = self.objects_of(&self.discourse.entities[fact.entity]);
                    let within = |object: &&ObjectView| {
                        scene.lies_in(object, &|parent| objects.iter().any(|o| o.name == parent.name))
                    };
                    (!things.is_empty() && things.iter().all(within))
                        .then(|| format!("the {thing} lies in the closed {kind}"))
                }
                _ => None,
            }
        })
    }

    fn objects_of(&self, entity: &Entity) -> Vec<&'a ObjectView> {
        match &entity.which {
            Which::Named(name) => self.discourse.scene.named(name).into_iter().collect(),
            _ => self.discourse.scene.of_kind(entity.kind()).to_vec(),
        }
    }

    /// Whether two mentions speak of one object, as far as it can be told.
    fn same_thing(&self, a: usize, b: usize) -> bool {
        let (one, other) = (&self.discourse.entities[a], &self.discourse.entities[b]);
        let single = self.discourse.scene.of_kind(one.kind()).len() < 2;
        a == b
            || one.kind() == other.kind()
                && (single
                    || one.which == other.which && one.which != Which::Any
                    || one.which == Which::All
                    || other.which == Which::All)
    }

    /// Whether all of some things stand at every place that a clause names.
    fn stands_there(&self, clause: &Clause<'a>, things: &[usize]) -> bool {
        let scene = self.discourse.scene;
        let at = |kind: &str, noun: &super::super::lexicon::Noun| {
            scene.of_kind(kind).iter().any(|object| {
                object.parents.is_empty()
                    || scene.lies_in(object, &|parent| noun.kinds.contains(&parent.kind))
            })
        };
        things.iter().all(|&entity| {
            let kind = self.discourse.entities[entity].kind();
            clause.places.iter().all(|place| match &place.phrase.head {
                Head::Noun(noun) => at(kind, noun),
                _ => true,
            })
        })
    }

    /// "if the light is on": whether it is so now.
    pub fn condition(&mut self, index: usize, clause: &Clause<'a>) -> bool {
        self.clause = index;
        let wants = if clause.complement.contains_key("isToggled") { Some("toggleable") } else { None };
        let mut objects = Vec::new();
        for phrase in &clause.objects {
            objects.extend(self.discourse.mention(phrase, &clause.places, wants));
        }
        if clause.complement.is_empty() && clause.says_any(&["there"]) && clause.verbs.is_empty() {
            // "if there is a mug on the desk"
            let scene = self.discourse.scene;
            let named = clause.objects.iter().any(|phrase| is_here(scene, phrase));
            let there = named && !objects.is_empty() && self.stands_there(clause, &objects);
            self.discourse.spoken.push(Spoken { objects, ..Spoken::default() });
            return there;
        }
        if clause.complement.is_empty() || objects.is_empty() {
            self.discourse.problem(format!("I cannot tell whether \"{}\" holds", clause.text), 0.3);
        }
        let holds = !objects.is_empty()
            && objects.iter().all(|&entity| {
                let switch = self.switch_of(entity, &clause.complement);
                let things = self.objects_of(&self.discourse.entities[switch]);
                things.iter().any(|object| is_in_state(object, &clause.complement))
            });
        self.discourse.spoken.push(Spoken { objects, ..Spoken::default() });
        holds
    }
}

fn is_here(scene: &Scene<'_>, phrase: &Phrase) -> bool {
    match &phrase.head {
        Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.has(kind)),
        Head::Named(_) | Head::Pronoun { .. } => true,
        _ => false,
    }
}

/// The skill that brings a state about.
fn skill_to(property: &str, flag: bool) -> Option<&'static str> {
    Some(match (property, flag) {
        ("isOpen", true) => "OpenObject",
        ("isOpen", false) => "CloseObject",
        ("isToggled", true) => "SwitchOn",
        ("isToggled", false) => "SwitchOff",
        ("isSliced", true) => "SliceObject",
        ("isBroken", true) => "BreakObject",
        _ => return None,
    })
}
