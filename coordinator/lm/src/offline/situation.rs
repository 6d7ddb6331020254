//! Vague commands: situations as data, each a set of trigger words and goal templates over object types.
//!
//! A template names types; what the scene has of them is what the goal is about, so one situation fits any
//! room. The situation whose triggers explain most of the words is taken.

use lamma_domains::goal::PropertyValue;
use serde::Deserialize;

use super::effect::{Change, Interpreter};
use super::lexicon::{LONGEST, Lexicon, Settings, squash};
use super::mention::{Spoken, Which};
use super::scene::is_in_state;
use super::syntax::Clause;
use super::trigger::{Said, Trigger, TriggerWords};

/// As many situations are tried as there may be nothing for in the scene.
const MOST_TRIED: usize = 4;

/// "egg stuck to the plate", "tomato all over the pan": what that is said of is not what is spoken of.
const STUCK: [&str; 7] = ["stuck", "all", "smeared", "dried", "caked", "crusted", "everywhere"];

/// A situation.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Situation {
    /// For the record.
    pub name: String,
    /// Sets of words that must all be there; `a/b` is either, `!a` must not be there.
    pub when: Vec<String>,
    /// Words none of which may be there, whatever else is: a film that is over is no film.
    #[serde(default)]
    pub unless: Vec<String>,
    /// What is brought about.
    pub goal: Vec<Template>,
    /// It is taken even when the words could be read word by word.
    #[serde(default)]
    pub strong: bool,
    /// `when`, as it is tried.
    #[serde(skip)]
    pub triggers: Vec<Trigger>,
}

/// A goal over whatever the scene has of some types.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Template {
    /// Every object of each of these types.
    #[serde(default)]
    pub each: Vec<String>,
    /// One object of the first of these types that is there.
    #[serde(default)]
    pub one: Vec<String>,
    /// One object of each of these types that is there.
    #[serde(default)]
    pub one_of_each: Vec<String>,
    /// What the sentence names, as far as it affords this or is in the list of this name: "the lettuce will wilt".
    #[serde(default)]
    pub said: Option<String>,
    /// Its states.
    #[serde(default)]
    pub is: Settings,
    /// The receptacle it ends in: the first of these types that is there and takes it.
    #[serde(default)]
    pub into: Vec<String>,
    /// It ends where such things are kept.
    #[serde(default)]
    pub home: bool,
    /// It ends in a hand.
    #[serde(default)]
    pub held: bool,
    /// The situation makes no sense without it.
    #[serde(default)]
    pub needed: bool,
    /// Left out when an earlier template of the situation found something.
    #[serde(default)]
    pub otherwise: bool,
}

impl Situation {
    /// The patterns of its triggers, each without the words that may not be there.
    pub fn patterns(&self) -> Vec<String> {
        let absent: String = self.unless.iter().map(|word| format!(" !{word}")).collect();
        self.when.iter().map(|when| format!("{when}{absent}")).collect()
    }

    /// Numbers the words of its triggers.
    pub fn learn_triggers(&mut self, words: &mut TriggerWords) {
        self.triggers = self.patterns().iter().map(|when| words.trigger(when)).collect();
    }

    /// How many words a trigger explains, if one fits.
    pub fn fits(&self, said: &Said) -> Option<usize> {
        self.triggers.iter().filter_map(|trigger| trigger.fits(said)).max()
    }
}

/// The words of triggers, for spelling.
pub fn vocabulary(when: &[String]) -> Vec<String> {
    let words = when.iter().flat_map(|pattern| pattern.split([' ', '/', '!']));
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// The situations that explain something of the words and how much, those that explain most first; of those that
/// explain as much, strong ones, then in the order of the file.
pub fn ranked<'s>(lexicon: &'s Lexicon, words: &[String], strong_only: bool) -> Vec<(&'s Situation, usize)> {
    let said = lexicon.said(words);
    let mut found: Vec<(&Situation, usize)> = lexicon
        .situations()
        .iter()
        .filter(|situation| situation.strong || !strong_only)
        .filter_map(|situation| Some((situation, situation.fits(&said)?)))
        .collect();
    found.sort_by_key(|(situation, score)| std::cmp::Reverse((*score, situation.strong)));
    found.truncate(MOST_TRIED);
    found
}

impl Interpreter<'_, '_> {
    /// The first of some situations that the scene has something for; false if there is none.
    pub fn first_situation(
        &mut self,
        index: usize,
        ranked: &[(&Situation, usize)],
        words: &[String],
    ) -> bool {
        ranked.iter().any(|(situation, _)| self.situation(index, situation, words))
    }

    /// What a situation spoke of, where the next clause carries it on: "make a coffee and bring it to the table".
    pub fn speak_of_what_came_about(&mut self, index: usize, clauses: &[Clause<'_>]) {
        let carried = clauses.get(index + 1).is_some_and(|next| next.carries_it() || next.discards_it());
        let spoken = if carried { self.brought_about(index) } else { Spoken::default() };
        self.discourse.spoken.push(spoken);
    }

    fn brought_about(&self, index: usize) -> Spoken {
        let mine = self.facts.iter().filter(|fact| fact.clause == index);
        let mut objects: Vec<usize> = mine
            .map(|fact| fact.entity)
            .filter(|&e| self.discourse.scene.affords(self.discourse.entities[e].kind(), "pickupable"))
            .collect();
        objects.dedup();
        // A salad is carried in its bowl.
        let mine = self.facts.iter().filter(|fact| fact.clause == index);
        let vessel = mine.filter_map(|fact| match fact.change {
            Change::Inside(place) => Some(place),
            _ => None,
        });
        let carried =
            |&e: &usize| self.discourse.scene.affords(self.discourse.entities[e].kind(), "pickupable");
        let mut places: Vec<usize> = vessel.filter(carried).collect();
        places.dedup();
        Spoken { objects, placed: !places.is_empty(), places, ..Spoken::default() }
    }

    /// Adds the facts of a situation; false when the scene has nothing for it.
    pub fn situation(&mut self, index: usize, situation: &Situation, words: &[String]) -> bool {
        self.at_clause(index);
        let before = self.facts.len();
        let mut meant = Vec::new();
        let mut so_already = false;
        for template in &situation.goal {
            if template.otherwise && self.facts.len() > before {
                continue;
            }
            let mut found = self.instances(template, words);
            if let Some(affordance) = &template.said {
                found.extend(self.named_in(words, affordance));
            }
            if found.is_empty() && template.needed {
                self.facts.truncate(before);
                return false;
            }
            for entity in found {
                so_already |= self.is_asked_for(entity, template);
                let kind = self.discourse.entities[entity].kind().to_owned();
                if self.bring_about(entity, template, words) && !meant.contains(&kind) {
                    meant.push(kind);
                }
            }
        }
        if self.facts.len() == before {
            return so_already;
        }
        self.situations.push(index);
        self.discourse.assume(format!("took it as \"{}\": {}", situation.name, meant.join(", ")), 0.75);
        true
    }

    /// Whether the states that a template asks of a thing were asked for before.
    fn is_asked_for(&self, entity: usize, template: &Template) -> bool {
        let asked = |(property, value): (&String, &PropertyValue)| {
            let same = Change::State(property.clone(), value.clone());
            self.facts.iter().any(|fact| fact.entity == entity && fact.change == same)
        };
        !template.is.is_empty() && template.is.iter().all(asked)
    }

    /// The things of the scene that words name and that afford something.
    fn named_in(&mut self, words: &[String], affordance: &str) -> Vec<usize> {
        let (lexicon, scene) = (self.discourse.lexicon, self.discourse.scene);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let mut found = Vec::new();
        let mut at = 0;
        while at < words.len() {
            // "the cutlery has egg stuck to it": of the cutlery.
            if !found.is_empty() && ["has", "have", "got", "with"].contains(&words[at]) {
                break;
            }
            let longest = (1..=LONGEST.min(words.len() - at)).rev();
            let noun = longest.map(|length| (lexicon.noun(&words[at..at + length]), length));
            let Some((noun, plural, length)) =
                noun.into_iter().find_map(|(noun, length)| noun.map(|(noun, plural)| (noun, plural, length)))
            else {
                at += 1;
                continue;
            };
            at += length;
            if STUCK.contains(&words.get(at).copied().unwrap_or_default()) {
                continue;
            }
            // A stove is switched by its knobs.
            let switched = |kind: &String| {
                let control = lexicon.control(kind).filter(|_| affordance == "toggleable" && scene.has(kind));
                control.map_or_else(|| kind.clone(), str::to_owned)
            };
            let listed = |kind: &String| lexicon.is_small(affordance, &[&kind.to_lowercase()]);
            let fits = |kind: &String| scene.has(kind) && (scene.affords(kind, affordance) || listed(kind));
            let kinds: Vec<String> = noun.kinds.iter().map(switched).filter(fits).collect();
            for kind in kinds.iter().take(if noun.class { usize::MAX } else { 1 }) {
                let controls = affordance == "toggleable" && !noun.kinds.contains(kind);
                let all = (plural || controls) && scene.of_kind(kind).len() > 1;
                found.push(self.discourse.entity(kind, if all { Which::All } else { Which::Any }));
            }
        }
        found
    }

    /// "too dark at the desk": whether what is switched stands on what is named.
    fn stands_at_what_is_named(&self, kind: &str, words: &[String]) -> bool {
        let (scene, lexicon) = (self.discourse.scene, self.discourse.lexicon);
        if !scene.affords(kind, "toggleable") || scene.affords(kind, "isHeatSource") {
            return false;
        }
        let furniture = |word: &String| {
            let kinds = lexicon.noun(&[word]).map(|(noun, _)| noun.kinds.as_slice()).unwrap_or_default();
            kinds.first().filter(|kind| scene.is_furniture(kind))
        };
        words.iter().filter_map(furniture).any(|place| {
            kind.strip_suffix("Lamp") == Some(place)
                || scene
                    .of_kind(kind)
                    .iter()
                    .any(|object| scene.lies_in(object, &|parent| parent.kind == *place))
        })
    }

    fn instances(&mut self, template: &Template, words: &[String]) -> Vec<usize> {
        let (scene, lexicon) = (self.discourse.scene, self.discourse.lexicon);
        // "read his paper" is about the newspaper, whatever else there is to read.
        let named = |kind: &&String| {
            words
                .iter()
                .any(|word| lexicon.noun(&[word]).is_some_and(|(noun, _)| noun.kinds.first() == Some(kind)))
        };
        let mut found = Vec::new();
        for kind in template.each.iter().filter(|kind| scene.has(kind)) {
            let which = if scene.of_kind(kind).len() > 1 { Which::All } else { Which::Any };
            found.push(self.discourse.entity(kind, which));
        }
        let mut here = template.one.iter().filter(|kind| scene.has(kind));
        let one = here
            .clone()
            .find(|kind| self.stands_at_what_is_named(kind, words))
            .or_else(|| here.clone().find(named));
        let one = one.or_else(|| here.clone().next());
        // Where the light is on and it is still too dark, a lamp is wanted besides.
        let is_so = |kind: &&String| {
            let objects = scene.of_kind(kind);
            !template.is.is_empty() && objects.iter().all(|object| is_in_state(object, &template.is))
        };
        let besides = one.filter(is_so).and_then(|_| here.find(|kind| !is_so(kind)));
        for kind in
            one.into_iter().chain(besides).chain(template.one_of_each.iter().filter(|kind| scene.has(kind)))
        {
            found.push(self.discourse.entity(kind, Which::Any));
        }
        found
    }

    /// Adds what a template says of one entity; false when that is not possible here.
    fn bring_about(&mut self, entity: usize, template: &Template, words: &[String]) -> bool {
        let (scene, lexicon) = (self.discourse.scene, self.discourse.lexicon);
        let named = |place: &&String| {
            let first = |word: &String| {
                let kind = lexicon.noun(&[word]).and_then(|(noun, _)| noun.kinds.first());
                kind == Some(*place)
            };
            words.iter().any(first)
        };
        let kind = self.discourse.entities[entity].kind().to_owned();
        let before = self.facts.len();
        for (property, value) in &self.discourse.possible_states(entity, template.is.clone()) {
            let possible = match property.as_str() {
                "isOpen" => scene.affords(&kind, "openable"),
                "isToggled" => scene.affords(&kind, "toggleable"),
                "isSliced" => scene.affords(&kind, "sliceable"),
                _ => true,
            } && scene.team_has(skills_for(property, value));
            if possible {
                self.add(entity, Change::State(property.clone(), value.clone()));
            }
        }
        let home = if template.home {
            self.discourse.lexicon.homes(&kind).find(|home| scene.accepts(home, &kind)).map(str::to_owned)
        } else {
            // "on the sofa": there, of all the places it may go.
            let mut takes = template.into.iter().filter(|place| scene.accepts(place, &kind));
            takes.clone().find(named).or_else(|| takes.next()).cloned()
        };
        let carried = scene.team_has(&["PickupObject", "PutObject"]) && scene.team_lifts(&kind);
        if let Some(home) = home.filter(|_| carried) {
            let place = self.discourse.place_of_kind(&home);
            self.add(entity, Change::Inside(place));
        }
        if template.held && scene.team_has(&["PickupObject"]) && scene.team_lifts(&kind) {
            self.add(entity, Change::Held);
        }
        self.facts.len() > before
    }
}

/// The skills without which nobody brings a state about.
fn skills_for(property: &str, value: &PropertyValue) -> &'static [&'static str] {
    let on = *value == super::yes();
    match property {
        "isToggled" if on => &["SwitchOn"],
        "isToggled" => &["SwitchOff"],
        "isOpen" if on => &["OpenObject"],
        "isOpen" => &["CloseObject"],
        "isSliced" => &["SliceObject"],
        "isBroken" => &["BreakObject"],
        _ => &[],
    }
}

/// "don't let the fern die": whether what is forbidden comes about by doing nothing.
pub fn is_left_to(words: &[String]) -> bool {
    let has = |any: &[&str]| words.iter().any(|word| any.contains(&word.as_str()));
    has(&["let"]) && has(&["die", "wilt", "starve", "thirst", "dry", "shrivel", "perish", "freeze"])
}

/// The words of a text that are worth matching.
pub fn words_of(words: &[String]) -> Vec<String> {
    words.iter().map(|word| squash(word)).filter(|word| !word.is_empty()).collect()
}
