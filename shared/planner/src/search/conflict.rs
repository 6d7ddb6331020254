//! Why a search that left no state out found nothing: which parts of the goal never hold together.

use std::collections::BTreeSet;

use super::registry::{Registry, StateId};
use crate::successor::Successors;
use crate::task::Task;

/// A smallest set of parts of the goal of which no reachable state has all, none of them to spare, as text. `None`
/// where there is no such set, or where more than `states` states would have to be looked at to know.
pub fn never_together(task: &Task, states: usize) -> Option<Vec<String>> {
    if task.goal.is_empty() || task.goal.len() > u64::BITS as usize || !task.impossible.is_empty() {
        return None;
    }
    let met = goals_met(task, states)?;
    let possible = |goals: u64| met.iter().any(|met| goals & !met == 0);
    let mut goals = u64::MAX >> (u64::BITS as usize - task.goal.len());
    if possible(goals) {
        return None;
    }
    for goal in 0..task.goal.len() {
        let without = goals & !(1 << goal);
        if !possible(without) {
            goals = without;
        }
    }
    let parts = task.goal.iter().enumerate().filter(|(goal, _)| goals >> goal & 1 == 1);
    Some(parts.map(|(_, &fact)| task.fact_text(fact)).collect())
}

/// For each reachable state the set of goals that hold in it, each set once.
fn goals_met(task: &Task, states: usize) -> Option<BTreeSet<u64>> {
    let successors = Successors::new(task);
    let mut registry = Registry::new(task);
    let mut met = BTreeSet::new();
    let (mut state, mut next) = (task.init.clone(), task.init.clone());
    let mut applicable = Vec::new();
    let (mut at, mut count) = (0, 1);
    while at < count {
        state.copy_from_slice(registry.state(StateId(at)));
        let holding = task.goal.iter().enumerate().filter(|&(_, &fact)| task.holds(&state, fact));
        met.insert(holding.fold(0u64, |set, (goal, _)| set | 1 << goal));
        applicable.clear();
        successors.applicable(task, &state, &mut applicable);
        for &operator in &applicable {
            task.apply(&state, operator, &mut next);
            let (_, new) = registry.insert(&next, StateId(at), operator);
            count += u32::from(new);
        }
        if count as usize > states {
            return None;
        }
        at += 1;
    }
    Some(met)
}
