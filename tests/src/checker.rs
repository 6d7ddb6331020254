//! Invariants of the arbiter, checked after every input it takes, and of the end of a run.

use lamma_pddl::ast::GroundAtom;
use lamma_planner::interpreter::WorldState;
use lamma_protocol::message::Request;
use lamma_protocol::{AgentId, Epoch, StepIndex};
use lamma_simulator::Arbiter;

/// What of the arbiter the next check compares with.
pub struct Snapshot {
    epoch: Epoch,
    progress: Vec<StepIndex>,
    state: WorldState,
}

impl Snapshot {
    /// Of an arbiter as it is.
    pub fn of(arbiter: &Arbiter) -> Self {
        Snapshot {
            epoch: arbiter.epoch(),
            progress: arbiter.progress().to_vec(),
            state: arbiter.state().clone(),
        }
    }
}

/// What the arbiter was given.
pub enum Given<'a> {
    /// A robot's request.
    Request(AgentId, &'a Request),
    /// A grant.
    Grant,
    /// Something that must not change the world.
    Other,
}

/// Checks one input of the arbiter; the text names the invariant that is violated.
pub fn invariant_of_arbiter(before: &Snapshot, given: Given<'_>, arbiter: &Arbiter) -> Result<(), String> {
    let after = Snapshot::of(arbiter);
    if after.epoch < before.epoch {
        return Err(format!("EPOCH-MONOTONE: {:?} follows {:?}", after.epoch, before.epoch));
    }
    let moved: Vec<usize> =
        (0..after.progress.len()).filter(|&a| after.progress[a] != before.progress[a]).collect();
    let changed = after.state != before.state;
    match given {
        Given::Grant if after.epoch > before.epoch => {
            if after.progress.iter().any(|p| *p != StepIndex(0)) {
                return Err("NEW-EPOCH-NEW-PROGRESS: progress survives a grant".into());
            }
        }
        Given::Grant => {
            if !moved.is_empty() {
                return Err("GRANT-IS-NO-STEP: progress without a request".into());
            }
        }
        Given::Request(agent, request) => {
            if moved.iter().any(|&a| a != agent.index()) {
                return Err("OWN-PROGRESS: a request moved somebody else".into());
            }
            let own = moved.contains(&agent.index());
            if own && request.epoch != before.epoch {
                return Err("FENCE: a request of another epoch was applied".into());
            }
            if own && request.step != before.progress[agent.index()] {
                return Err("GAPLESS-ONCE: a step was skipped or applied twice".into());
            }
            if own && request.gates.iter().any(|g| before.progress[g.agent.index()] < g.done) {
                return Err("BARRIER: a step was applied before its gates were open".into());
            }
            if changed && !own {
                return Err("REFUSED-IS-PURE: the world changed without progress".into());
            }
        }
        Given::Other => {
            if changed || !moved.is_empty() {
                return Err("ONLY-REQUESTS-ACT: the world changed by itself".into());
            }
        }
    }
    one_place(&after.state)
}

/// Each thing is in one place or one hand.
fn one_place(state: &WorldState) -> Result<(), String> {
    let mut places: std::collections::BTreeMap<&str, Vec<&GroundAtom>> = Default::default();
    for fact in &state.facts {
        let thing = match fact.predicate.as_str().to_ascii_lowercase().as_str() {
            "in" => fact.args.first(),
            "holding" => fact.args.get(1),
            _ => None,
        };
        if let Some(thing) = thing {
            places.entry(thing.as_str()).or_default().push(fact);
        }
    }
    match places.iter().find(|(_, facts)| facts.len() > 1) {
        Some((thing, facts)) => Err(format!("ONE-PLACE: {thing} is in several places: {facts:?}")),
        None => Ok(()),
    }
}
