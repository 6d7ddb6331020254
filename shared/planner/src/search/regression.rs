//! What must hold before the last steps of a plan so that they lead to the goal all the same.

use crate::task::{FactId, OperatorId, Task};

/// What the rest of a plan needs, worked out step by step from the goal backwards.
pub(super) struct Needs<'t> {
    task: &'t Task,
    /// The fact needed of each variable that axioms do not define.
    of: Vec<Option<FactId>>,
    /// With axioms and numbers, the whole state has to be the same: what those depend on is not traced back.
    exact: bool,
    state: Vec<u64>,
}

impl<'t> Needs<'t> {
    /// After the whole plan, which ends in `state`.
    pub fn of_goal(task: &'t Task, state: &[u64]) -> Self {
        let exact = !task.axioms.is_empty() || task.has_numbers();
        let mut needs = Needs { task, of: vec![None; task.variables.len()], exact, state: state.to_vec() };
        task.goal.iter().for_each(|&fact| needs.need(fact));
        needs
    }

    fn need(&mut self, fact: FactId) {
        self.of[self.task.facts[fact.index()].variable as usize] = Some(fact);
    }

    /// Goes back over one step, done in `state`.
    pub fn back(&mut self, operator: OperatorId, state: &[u64]) {
        self.state.copy_from_slice(state);
        let task = self.task;
        if self.exact {
            return;
        }
        let mut asked: Vec<FactId> = Vec::new();
        let variable = |fact: FactId| task.facts[fact.index()].variable as usize;
        for (condition, fact) in task.conditional_effects(operator) {
            let Some(needed) = self.of[variable(fact)] else { continue };
            // What happened and was needed has to happen again; what would have done harm must not.
            match condition.iter().find(|&&fact| !task.holds(state, fact)) {
                None => asked.extend(condition),
                Some(&missing) if needed != fact => asked.push(task.variables[variable(missing)].fact(state)),
                Some(_) => {}
            }
        }
        for (condition, fact) in task.conditional_effects(operator) {
            if self.of[variable(fact)] == Some(fact) && condition.iter().all(|&fact| task.holds(state, fact))
            {
                self.of[variable(fact)] = None;
            }
        }
        for &fact in task.effects(operator) {
            if self.of[variable(fact)] == Some(fact) {
                self.of[variable(fact)] = None;
            }
        }
        asked
            .into_iter()
            .chain(task.preconditions(operator).iter().copied())
            .for_each(|fact| self.need(fact));
    }

    /// Whether a state will do.
    pub fn are_met(&self, state: &[u64]) -> bool {
        if self.exact {
            return self.state == state;
        }
        self.of.iter().flatten().all(|&fact| self.task.holds(state, fact))
    }

    /// The facts needed.
    pub fn facts(&self) -> impl Iterator<Item = FactId> + '_ {
        let all = self.exact.then(|| self.task.facts_of(&self.state));
        all.into_iter().flatten().chain(self.of.iter().flatten().copied().filter(|_| !self.exact))
    }
}

/// The states along a plan from `from` on: one more than there are steps.
pub(super) fn states_along(task: &Task, from: &[u64], plan: &[OperatorId]) -> Vec<Vec<u64>> {
    let mut states = vec![from.to_vec()];
    for &operator in plan {
        let mut next = from.to_vec();
        task.apply(&states[states.len() - 1], operator, &mut next);
        states.push(next);
    }
    states
}
