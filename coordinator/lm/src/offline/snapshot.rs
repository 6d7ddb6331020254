//! What an attempt at a clause may change, so that another may be made.

use super::effect::forbid::Prohibition;
use super::effect::{Fact, Interpreter};
use super::mention::{Confidence, Entity, Spoken};

/// What an attempt at a clause may change.
pub struct Snapshot {
    facts: Vec<Fact>,
    entities: Vec<Entity>,
    spoken: Vec<Spoken>,
    /// What is switched by what and what is forbidden name entities by number, so they go with those.
    controls: Vec<(usize, usize)>,
    prohibitions: Vec<Prohibition>,
    assumptions: Vec<String>,
    problem_list: Vec<String>,
    /// How many problems there were.
    pub problems: usize,
    confidence: Confidence,
}

impl Snapshot {
    /// Of what there is now.
    pub fn take(interpreter: &Interpreter<'_, '_>) -> Self {
        let discourse = &interpreter.discourse;
        Self {
            facts: interpreter.facts.clone(),
            entities: discourse.entities.clone(),
            spoken: discourse.spoken.clone(),
            controls: discourse.controls.clone(),
            prohibitions: interpreter.prohibitions.clone(),
            assumptions: discourse.assumptions.clone(),
            problem_list: discourse.problems.clone(),
            problems: discourse.problems.len(),
            confidence: discourse.confidence,
        }
    }

    /// Puts back what there was.
    pub fn restore(&self, interpreter: &mut Interpreter<'_, '_>) {
        interpreter.facts.clone_from(&self.facts);
        interpreter.discourse.entities.clone_from(&self.entities);
        interpreter.discourse.spoken.clone_from(&self.spoken);
        interpreter.discourse.controls.clone_from(&self.controls);
        interpreter.prohibitions.clone_from(&self.prohibitions);
        interpreter.discourse.assumptions.clone_from(&self.assumptions);
        interpreter.discourse.problems.clone_from(&self.problem_list);
        interpreter.discourse.confidence = self.confidence;
    }
}
