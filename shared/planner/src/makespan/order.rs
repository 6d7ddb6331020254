//! When the operators of a linear plan can run at the earliest and must run at the latest.
//!
//! The same rules as in [`crate::partial_order`], on the grounded task and only for operators without
//! conditional effects: makers come before who relies on them, who relies before who undoes, who undoes before
//! who makes good again, and an agent does one thing after the other.

use crate::task::{OperatorId, Task};

/// A linear plan with the order it needs.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub plan: Vec<OperatorId>,
    /// The step at which each operator runs if all run as early as they can.
    pub earliest: Vec<u32>,
    /// The same if all run as late as they can without the plan taking longer.
    pub latest: Vec<u32>,
    pub makespan: u32,
}

/// Somebody relies on a fact: who made it (none: it was so at the start), who relies (the plan's length stands
/// for the goal), and which fact.
struct Link {
    maker: Option<u32>,
    user: u32,
    fact: u32,
}

impl Order {
    /// Orders a plan that leads from the task's start to its goal.
    pub fn new(task: &Task, agent_of: &[u32], plan: Vec<OperatorId>) -> Self {
        let before = before(task, agent_of, &plan);
        let mut earliest = vec![0u32; plan.len()];
        for (at, before) in before.iter().enumerate() {
            earliest[at] = before.iter().map(|&b| earliest[b as usize] + 1).max().unwrap_or(0);
        }
        let makespan = earliest.iter().map(|&step| step + 1).max().unwrap_or(0);
        let mut latest = vec![makespan.saturating_sub(1); plan.len()];
        for (at, before) in before.iter().enumerate().rev() {
            for &b in before {
                latest[b as usize] = latest[b as usize].min(latest[at] - 1);
            }
        }
        Order { plan, earliest, latest, makespan }
    }

    /// The operators step by step, each as early as it can.
    pub fn steps(&self) -> Vec<Vec<OperatorId>> {
        let mut steps = vec![Vec::new(); self.makespan as usize];
        for (&operator, &step) in self.plan.iter().zip(&self.earliest) {
            steps[step as usize].push(operator);
        }
        steps
    }
}

/// For each operator of the plan those that must run before it.
fn before(task: &Task, agent_of: &[u32], plan: &[OperatorId]) -> Vec<Vec<u32>> {
    let variable = |fact: u32| task.facts[fact as usize].variable as usize;
    let mut holds: Vec<u32> = task.variables.iter().map(|v| v.fact(&task.init).0).collect();
    let mut maker: Vec<Option<u32>> = vec![None; task.variables.len()];
    let mut writers: Vec<Vec<(u32, u32)>> = vec![Vec::new(); task.variables.len()];
    let mut last_of: Vec<Option<u32>> = vec![None; agent_of.iter().max().map_or(0, |&a| a as usize + 1)];
    let mut links = Vec::new();
    let mut before = vec![Vec::new(); plan.len()];
    for (at, &operator) in plan.iter().enumerate() {
        let at = at as u32;
        for fact in task.preconditions(operator) {
            links.push(Link { maker: maker[variable(fact.0)], user: at, fact: fact.0 });
        }
        for fact in task.effects(operator) {
            let variable = variable(fact.0);
            writers[variable].push((at, fact.0));
            if std::mem::replace(&mut holds[variable], fact.0) != fact.0 {
                maker[variable] = Some(at);
            }
        }
        before[at as usize].extend(last_of[agent_of[operator.index()] as usize].replace(at));
    }
    let end = plan.len() as u32;
    links.extend(task.goal.iter().map(|f| Link { maker: maker[variable(f.0)], user: end, fact: f.0 }));
    for Link { maker, user, fact } in links {
        if user < end {
            before[user as usize].extend(maker);
        }
        for &(other, made) in &writers[variable(fact)] {
            if made == fact || Some(other) == maker || other == user {
                continue;
            }
            match maker {
                Some(maker) if other < maker => before[maker as usize].push(other),
                _ if other > user => before[other as usize].push(user),
                _ => {}
            }
        }
    }
    for list in &mut before {
        list.sort_unstable();
        list.dedup();
    }
    before
}
