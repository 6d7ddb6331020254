//! Prohibitions and conditions: what must not become so, and what must be so for a clause to count.

use super::super::lexicon::{Act, Settings};
use super::super::mention::{Entity, Spoken, Which};
use super::super::scene::is_in_state;
use super::super::syntax::{Clause, Head, Phrase, Quantity};
use super::{Change, Fact, Interpreter};
use crate::ObjectView;
use lamma_domains::goal::PropertyValue;

/// States that must not come about.
pub struct Ban {
    clause: usize,
    text: String,
    entities: Vec<usize>,
    states: Settings,
}

impl<'a> Interpreter<'_, 'a> {
    /// "do not open the fridge": kept as a ban where it is about a state; else it is said that it is not.
    pub(super) fn forbid(&mut self, clause: &Clause<'a>) -> Spoken {
        let verb = self.choose(clause);
        let states = match verb {
            _ if !clause.complement.is_empty() => clause.complement.clone(),
            Some(verb) if verb.act == Act::Set => verb.set.clone(),
            _ => Settings::new(),
        };
        if states.is_empty() || clause.objects.is_empty() {
            let text = format!("\"not {}\" cannot be put as a goal, and nobody watches over it", clause.text);
            self.discourse.assume(text, 0.95);
            // "… put it in the bowl" may follow.
            let scene = self.discourse.scene;
            let is_here = |phrase: &&Phrase| matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.has(kind)));
            let phrases: Vec<&Phrase> = clause.objects.iter().filter(is_here).collect();
            let objects =
                phrases.into_iter().flat_map(|phrase| self.discourse.mention(phrase, &[], None)).collect();
            let places = self.places_spoken_of(&clause.places);
            return Spoken { objects, places, ..Spoken::default() };
        }
        let known = self.discourse.entities.len();
        let wants = verb.and_then(|verb| verb.wants.as_deref());
        let mut entities = Vec::new();
        let mut said = Vec::new();
        for phrase in &clause.objects {
            let wants = wants.filter(|wants| *wants != "breakable");
            for entity in self.discourse.mention(phrase, &[], wants) {
                said.push(entity);
                let fresh = entity >= known && phrase.quantity == Quantity::One;
                let thing = &mut self.discourse.entities[entity];
                if fresh && thing.which == Which::Any && self.discourse.scene.of_kind(thing.kind()).len() > 1
                {
                    thing.which = Which::All;
                }
                entities.push(self.switch_of(entity, &states));
            }
        }
        self.bans.push(Ban {
            clause: self.clause,
            text: clause.text.clone(),
            entities: entities.clone(),
            states,
        });
        Spoken { objects: entities, places: said, ..Spoken::default() }
    }

    /// Turns bans into goals for the end, once everything is known; asks where the rest breaks one.
    pub fn settle_bans(&mut self) {
        for ban in std::mem::take(&mut self.bans) {
            for &entity in &ban.entities {
                for (property, value) in &ban.states {
                    if let PropertyValue::Flag(flag) = value {
                        self.settle(&ban, entity, property, *flag);
                    }
                }
            }
        }
    }

    fn settle(&mut self, ban: &Ban, entity: usize, property: &str, flag: bool) {
        let kind = self.discourse.entities[entity].kind().to_owned();
        if let Some(reason) = self.broken_by(entity, property, flag) {
            let text = format!("\"{}\" is forbidden, but {reason}", ban.text);
            self.discourse.problem(text, 0.3);
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

    /// "if the light is on": whether it is so now.
    pub fn condition(&mut self, index: usize, clause: &Clause<'a>) -> bool {
        self.clause = index;
        let wants = if clause.complement.contains_key("isToggled") { Some("toggleable") } else { None };
        let mut objects = Vec::new();
        for phrase in &clause.objects {
            objects.extend(self.discourse.mention(phrase, &clause.places, wants));
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
