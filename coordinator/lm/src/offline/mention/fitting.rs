//! What a thing can be: types that go together, states it can take, what switches it.

use super::super::lexicon::{Settings, squash};
use super::super::syntax::Phrase;
use super::{Discourse, Which};
use crate::ObjectView;

impl Discourse<'_> {
    /// A thing of a type, or all of the type, that a situation speaks of.
    pub fn entity(&mut self, kind: &str, which: Which) -> usize {
        let known = self.entities.iter().position(|entity| entity.kind() == kind && entity.which == which);
        known.unwrap_or_else(|| self.add(vec![kind.to_owned()], which, kind))
    }

    /// A thing of a type that was not named itself.
    pub fn place_of_kind(&mut self, kind: &str) -> usize {
        let known = self.entities.iter().position(|entity| entity.kind() == kind);
        known.unwrap_or_else(|| self.add(vec![kind.to_owned()], Which::Any, kind))
    }

    /// What switches an entity: one of them to be on, all of them to be off.
    pub fn control(&mut self, entity: usize, control: String, on: bool) -> usize {
        let text = self.entities[entity].text.clone();
        self.assume(format!("\"{text}\" is switched by the {control}"), 0.98);
        // All were off; one is to be on.
        let known =
            self.controls.iter().rev().find(|(switched, _)| *switched == entity).map(|(_, known)| *known);
        if let Some(known) = known.filter(|known| !on || self.entities[*known].which != Which::All) {
            return known;
        }
        // "two burners" have two knobs; "the sink" and "the faucet" have one.
        let (kind, which) = (self.entities[entity].kind(), &self.entities[entity].which);
        let alike = |e: &super::Entity| e.kind() == kind && e.text == text && *which == e.which;
        let one_of_several = self.entities.iter().filter(|e| alike(e)).count() > 1;
        let taken = |e: usize| {
            self.controls.iter().any(|(other, known)| *known == e && self.entities[*other].kind() == kind)
        };
        let known = (0..self.entities.len()).find(|&e| self.entities[e].kind() == control && !taken(e));
        let many = self.scene.of_kind(&control).len() > 1;
        let which = if on || !many || one_of_several { Which::Any } else { Which::All };
        let found = known.unwrap_or_else(|| self.add(vec![control], which, &text));
        self.controls.push((entity, found));
        found
    }

    /// Lets the receptacle and the thing decide what each other is: the best pair of types that go together.
    /// What a receptacle is called counts for more: "a knife in a cup" is a small knife rather than a mug.
    pub fn fit(&mut self, entity: usize, place: usize) {
        let (things, places) = (self.entities[entity].kinds.clone(), self.entities[place].kinds.clone());
        // "cup" is the name of a type, "holder" is not: it says less of which is meant.
        let named = places.first().is_some_and(|kind| squash(kind) == squash(&self.entities[place].noun));
        let weight = if named { 3 } else { 1 };
        let mut best: Option<(usize, &str, &str)> = None;
        for (i, thing) in things.iter().enumerate() {
            for (j, place) in places.iter().enumerate() {
                let rank = 2 * i + weight * j + if self.scene.surely_accepts(place, thing) { 0 } else { 3 };
                if self.scene.accepts(place, thing) && best.is_none_or(|(known, _, _)| rank < known) {
                    best = Some((rank, thing, place));
                }
            }
        }
        let Some((_, _, chosen)) = best else {
            let (thing, place) =
                (self.entities[entity].kind().to_owned(), self.entities[place].kind().to_owned());
            self.assume(format!("a {place} is not known to take a {thing}"), 0.93);
            return;
        };
        let chosen = chosen.to_owned();
        let scene = self.scene;
        self.entities[entity].kinds.retain(|thing| scene.accepts(&chosen, thing));
        let thing = self.entities[entity].kind().to_owned();
        let place = &mut self.entities[place].kinds;
        place.retain(|kind| scene.accepts(kind, &thing));
        place.sort_by_key(|kind| *kind != chosen);
    }

    /// Asked-for states, with "cooked" read as "hot" for what nothing can cook.
    pub fn possible_states(&self, entity: usize, states: Settings) -> Settings {
        let sliced = states.get("isCooked") == Some(&super::super::yes())
            && self.cooks_in_slices(self.entities[entity].kind());
        let sliced = sliced.then(|| ("isSliced".to_owned(), super::super::yes()));
        // "one roll empty, one full": no liquid.
        let kind = self.entities[entity].kind();
        let fillable = self.scene.affords(kind, "canFillWithLiquid");
        // "the cold tap": what is fixed is told apart by it, and neither heated nor cooled.
        let fixed = self.scene.has(kind) && !self.scene.affords(kind, "pickupable");
        states
            .into_iter()
            .filter(|(property, _)| {
                (fillable || !["isFilledWithLiquid", "fillLiquid"].contains(&property.as_str()))
                    && !(fixed && property == "temperature")
            })
            .chain(sliced)
            .map(|(property, value)| {
                let kind = self.entities[entity].kind();
                // A tap is closed by being turned off.
                let switch = self.scene.affords(kind, "toggleable") && !self.scene.affords(kind, "openable");
                if property == "isOpen" && switch {
                    ("isToggled".to_owned(), value)
                } else if property == "isCooked" && !self.can_be_cooked(self.entities[entity].kind()) {
                    ("temperature".to_owned(), lamma_domains::goal::PropertyValue::Word("Hot".to_owned()))
                } else {
                    (property, value)
                }
            })
            .collect()
    }

    fn can_be_cooked(&self, kind: &str) -> bool {
        let opened = || {
            self.lexicon.is_small("cooked_once_open", &[&kind.to_lowercase()])
                && (self.scene.team_has(&["SliceObject"]) || self.scene.team_has(&["BreakObject"]))
        };
        self.scene.affords(kind, "cookable") || self.cooks_in_slices(kind) || opened()
    }

    fn cooks_in_slices(&self, kind: &str) -> bool {
        self.lexicon.is_small("cooked_in_slices", &[&kind.to_lowercase()])
    }

    /// The states a verb brings to a thing of this kind; notes what is not possible.
    pub fn adapted_states(&mut self, entity: usize, verb: &super::super::lexicon::Verb) -> Settings {
        let kind = self.entities[entity].kind().to_owned();
        let mut states = self.possible_states(entity, verb.set.clone());
        if states.contains_key("isCooked")
            && self.cooks_in_slices(&kind)
            && states.insert("isSliced".to_owned(), super::super::yes()).is_none()
        {
            self.assume(format!("only slices of the {kind} can be cooked"), 0.99);
        }
        for property in states.keys() {
            self.note_if_unable(entity, property);
        }
        if verb.set.contains_key("isCooked") && states.contains_key("temperature") {
            self.assume(format!("cooking the {kind} means heating it"), 0.97);
        }
        states
    }

    /// Says of a thing that is to be so what it cannot be: "the tomato off".
    pub fn note_if_unable(&mut self, entity: usize, property: &str) {
        let needed = match property {
            "isOpen" => "openable",
            "isToggled" => "toggleable",
            "isSliced" => "sliceable",
            "isBroken" => "breakable",
            _ => return,
        };
        let this = &self.entities[entity];
        let able = self.scene.affords(this.kind(), needed);
        let text = format!("\"{}\" ({}) is not {needed}", this.text, this.kind());
        if !able && !this.kinds.is_empty() && !self.problems.contains(&text) {
            self.problem(text, 0.3);
        }
    }

    /// "put a full cup on the table" where no cup is full: it is asked for.
    pub(super) fn is_to_be_full(&self, entity: usize, phrase: &Phrase) -> bool {
        let kind = self.entities[entity].kind();
        let full = "isFilledWithLiquid";
        let is_so = |object: &&ObjectView| object.states.iter().any(|state| state == full);
        phrase.selects.get(full) == Some(&super::super::yes())
            && phrase.with.iter().all(|with| with.liquid().is_none())
            && self.scene.affords(kind, "canFillWithLiquid")
            && !self.scene.of_kind(kind).iter().any(is_so)
    }
}
