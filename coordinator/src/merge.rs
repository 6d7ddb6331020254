//! Sub-plans into one linear plan of the team, package by package.
//!
//! Robots plan without knowing of each other, so two of them may open the same fridge. A package is merged
//! by replaying it on the state that the packages before it leave: an action whose effects hold already is
//! dropped, and one that is simply impossible there makes the package a conflict, to be planned again from
//! that state.

use std::sync::Arc;

use lamma_planner::GroundAct;
use lamma_planner::interpreter::{GroundAction, GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::TeamStep;

/// The linear plan so far and the state it leads to.
#[derive(Clone, Debug)]
pub struct Merger {
    /// Where the plan starts.
    pub initial: WorldState,
    /// Where it ends.
    pub state: WorldState,
    /// Its steps.
    pub steps: Vec<TeamStep>,
    /// For each merged package, its steps (indices into `steps`).
    pub packages: Vec<MergedPackage>,
}

/// A package's share of the linear plan.
#[derive(Clone, Debug)]
pub struct MergedPackage {
    /// Which package.
    pub package: usize,
    /// Its steps.
    pub steps: std::ops::Range<usize>,
    /// What holds when they are done.
    pub goal: GroundCondition,
}

/// A package that does not fit after those before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// The action that is impossible there.
    pub act: GroundAct,
    /// Why.
    pub reason: String,
}

impl Merger {
    /// An empty plan.
    pub fn new(initial: WorldState) -> Self {
        Merger { state: initial.clone(), initial, steps: Vec::new(), packages: Vec::new() }
    }

    /// Appends a package's plan, or leaves everything as it was.
    pub fn merge(
        &mut self,
        interpreter: &Interpreter,
        package: usize,
        agent: usize,
        acts: &[GroundAct],
        goal: &GroundCondition,
    ) -> Result<(), Conflict> {
        let mut state = self.state.clone();
        let mut added = Vec::new();
        for act in acts {
            let conflict = |reason: String| Conflict { act: act.clone(), reason };
            let action = interpreter.instantiate(act).map_err(|e| conflict(e.to_string()))?;
            let mut next = state.clone();
            match interpreter.apply(&mut next, &action) {
                Ok(_) if next == state => {}
                Ok(_) => {
                    state = next;
                    added.push(TeamStep { agent, action: Arc::new(action) });
                }
                Err(_) if is_done_already(&state, &action) => {}
                Err(violation) => return Err(conflict(violation.to_string())),
            }
        }
        if !interpreter.holds(&state, goal) {
            let act = acts.last().cloned().unwrap_or_else(|| GroundAct::new("nothing", [""; 0]));
            return Err(Conflict { act, reason: "the package's goal is not reached".into() });
        }
        let start = self.steps.len();
        self.steps.extend(added);
        let steps = start..self.steps.len();
        self.packages.push(MergedPackage { package, steps, goal: goal.clone() });
        self.state = state;
        Ok(())
    }

    /// The same plan with one step left out.
    pub fn without(&self, step: usize) -> Merger {
        let mut shorter = self.clone();
        shorter.steps.remove(step);
        for package in &mut shorter.packages {
            let moved = |at: usize| if at > step { at - 1 } else { at };
            package.steps = moved(package.steps.start)..moved(package.steps.end);
        }
        shorter
    }

    /// Whether every step from `from` on is possible, every package that ends there or later reaches its goal,
    /// and `goal` holds at the end. `state` is the one before step `from`.
    pub fn is_valid_from(
        &self,
        interpreter: &Interpreter,
        from: usize,
        mut state: WorldState,
        goal: &GroundCondition,
    ) -> bool {
        for at in from..=self.steps.len() {
            let mut ending = self.packages.iter().filter(|p| p.steps.end == at);
            if !ending.all(|p| interpreter.holds(&state, &p.goal)) {
                return false;
            }
            if let Some(step) = self.steps.get(at)
                && interpreter.apply(&mut state, &step.action).is_err()
            {
                return false;
            }
        }
        interpreter.holds(&state, goal)
    }
}

/// Whether everything the action is sure to bring about holds.
fn is_done_already(state: &WorldState, action: &GroundAction) -> bool {
    let mut unconditional = action
        .literal_effects()
        .filter(|(condition, _)| condition.is_true())
        .map(|(_, effect)| effect)
        .peekable();
    unconditional.peek().is_some()
        && unconditional.all(|effect| state.facts.contains(&effect.atom) == effect.holds)
}
