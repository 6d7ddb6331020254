//! `--compat`: what the released evaluator would say of a final state. For comparison only.
//!
//! Its formulas, with their oddities (`end_thread.py` of LaMMA-P, the same in SMART-LLM): each entry of the ground
//! truth is compared with *every* object whose name contains the entry's as a substring, each match counts one,
//! and each thing in it whose name contains a wanted one counts one more; GCR is that number divided by the number
//! of entries, so it can exceed 1; TC is 1 only if GCR is exactly 1. `BROKEN`, `EMPTY` and `Sliced` are not
//! implemented there and never match. Its RU counts blank lines in generated Python, which we do not generate, so
//! its SR (TC and RU = 1) is given as TC.

use lamma_coordinator::result::RunResult;
use lamma_domains::goal::{Content, GoalEntry, PropertyValue};
use lamma_domains::matthor::TruthEntry;
use lamma_domains::view::{ObjectView, views};
use lamma_domains::world::WorldSetup;
use lamma_planner::{GroundAct, Interpreter};
use serde_json::{Value, json};

/// The evaluator's scores of a run.
#[derive(Clone, Copy, Debug)]
pub struct Compat {
    /// 1 exactly if GCR is.
    pub tc: f64,
    /// Matches by entries.
    pub gcr: f64,
}

impl Compat {
    /// As it is written into the results.
    pub fn json(self) -> Value {
        json!({ "tc": self.tc, "gcr": self.gcr })
    }
}

/// The scores of the state to which the run's actions lead; `None` if they do not lead anywhere (a run with
/// refusals or events from outside).
pub fn score(setup: &WorldSetup, result: &RunResult, truth: &[TruthEntry]) -> Option<Compat> {
    let interpreter = Interpreter::new(&setup.domain, &setup.objects).ok()?;
    let mut state = interpreter.initial(&setup.init).ok()?;
    for step in &result.plan.actions {
        let args = std::iter::once(step.robot.as_str()).chain(step.args.iter().map(String::as_str));
        let action = interpreter.instantiate(&GroundAct::new(step.action.as_str(), args)).ok()?;
        interpreter.apply(&mut state, &action).ok()?;
    }
    Some(evaluate(&views(setup, state.facts.iter()), truth))
}

fn evaluate(objects: &[ObjectView], truth: &[TruthEntry]) -> Compat {
    if truth.is_empty() {
        return Compat { tc: 1.0, gcr: 1.0 };
    }
    let mut complete = 0;
    for entry in truth {
        for object in objects.iter().filter(|o| o.kind.contains(entry.name.as_str())) {
            complete += usize::from(entry.state.as_deref().is_some_and(|s| matches(object, s)));
            let inside: Vec<&ObjectView> =
                objects.iter().filter(|o| o.parents.contains(&object.name)).collect();
            let contained = |wanted: &&String| inside.iter().any(|o| o.kind.contains(wanted.as_str()));
            complete += entry.contains.iter().filter(contained).count();
        }
    }
    let gcr = complete as f64 / truth.len() as f64;
    Compat { tc: f64::from(u8::from(complete == truth.len())), gcr }
}

fn matches(object: &ObjectView, state: &str) -> bool {
    let is = |name: &str| object.states.iter().any(|s| s == name);
    match state {
        "SLICED" => is("isSliced"),
        "ON" => is("isToggled"),
        "OFF" => !is("isToggled"),
        "HOT" => is("temperature:Hot"),
        "COOKED" => is("isCooked"),
        "OPENED" => is("isOpen"),
        "CLOSED" => !is("isOpen"),
        "PICKED" => is("isPickedUp"),
        _ => false,
    }
}

/// A goal in the evaluator's own terms: one entry for each object, and one more for each further state.
pub fn truth_of(goal: &[GoalEntry]) -> Vec<TruthEntry> {
    let mut truth = Vec::new();
    for entry in goal {
        let named = |content: &Content| match content {
            Content::Named(name) => name.clone(),
            Content::With(inner) => inner.object.clone(),
        };
        let mut states = entry.is.iter().map(|(name, value)| state(name, value));
        let contains: Vec<String> = entry.contains.iter().map(named).collect();
        truth.push(TruthEntry { name: entry.object.clone(), contains, state: states.next() });
        truth.extend(states.map(|s| TruthEntry {
            name: entry.object.clone(),
            contains: Vec::new(),
            state: Some(s),
        }));
        let inner: Vec<GoalEntry> = entry
            .contains
            .iter()
            .filter_map(|c| match c {
                Content::With(inner) if !inner.is.is_empty() => Some(inner.as_ref().clone()),
                _ => None,
            })
            .collect();
        truth.extend(truth_of(&inner));
    }
    truth
}

fn state(name: &str, value: &PropertyValue) -> String {
    let word = match (name, value) {
        ("isSliced", PropertyValue::Flag(true)) => "SLICED",
        ("isToggled", PropertyValue::Flag(true)) => "ON",
        ("isToggled", PropertyValue::Flag(false)) => "OFF",
        ("temperature", PropertyValue::Word(word)) if word == "Hot" => "HOT",
        ("isCooked", PropertyValue::Flag(true)) => "COOKED",
        ("isOpen", PropertyValue::Flag(true)) => "OPENED",
        ("isOpen", PropertyValue::Flag(false)) => "CLOSED",
        ("isPickedUp", PropertyValue::Flag(true)) => "PICKED",
        ("isBroken", _) => "BROKEN",
        _ => "UNSUPPORTED",
    };
    word.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(name: &str, parents: &[&str], states: &[&str]) -> ObjectView {
        let words = |list: &[&str]| list.iter().map(ToString::to_string).collect();
        let kind = name.split('_').next().unwrap_or_default().to_string();
        ObjectView {
            name: name.into(),
            kind,
            parents: words(parents),
            states: words(states),
            ..Default::default()
        }
    }

    fn entry(name: &str, contains: &[&str], state: Option<&str>) -> TruthEntry {
        let contains = contains.iter().map(ToString::to_string).collect();
        TruthEntry { name: name.into(), contains, state: state.map(Into::into) }
    }

    #[test]
    fn the_oddities_of_the_released_evaluator_are_kept() {
        let objects = [
            object("Fridge_1", &[], &[]),
            object("Apple_1", &["Fridge_1"], &["isSliced"]),
            object("Egg_1", &["Fridge_1"], &[]),
            object("Pencil_1", &[], &["isPickedUp"]),
            object("Pen_1", &[], &["isPickedUp"]),
            object("Vase_1", &[], &["isBroken"]),
        ];
        for (truth, gcr, what) in [
            (vec![entry("Fridge", &["Apple"], None)], 1.0, "one thing in one place"),
            (vec![entry("Fridge", &["Apple", "Egg"], None)], 2.0, "two things in one entry score 2 of 1"),
            (vec![entry("Fridge", &["Apple", "Tomato"], None)], 1.0, "half done counts as success"),
            (vec![entry("Pen", &[], Some("PICKED"))], 2.0, "Pen is in Pencil"),
            (vec![entry("Vase", &[], Some("BROKEN"))], 0.0, "BROKEN is not implemented"),
            (vec![entry("Apple", &[], Some("Sliced"))], 0.0, "nor is Sliced"),
            (vec![], 1.0, "nothing asked for"),
        ] {
            let found = evaluate(&objects, &truth);
            assert_eq!(found.gcr, gcr, "{what}");
            assert_eq!(found.tc, f64::from(u8::from(gcr == 1.0)), "{what}");
        }
    }
}
