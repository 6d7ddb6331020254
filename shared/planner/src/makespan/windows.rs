//! Shortening a schedule window by window.
//!
//! A window is a stretch of steps. What can be done before it is done before, what can wait is left until after
//! it; what remains is the window's own work, from a known state to what the rest relies on. If that can be done
//! in fewer steps, all that follows moves up. (Plan neighbourhoods as in Siddiqui & Haslum, "Continuing plan
//! quality optimisation", JAIR 54, 2015, but in time, and each a propositional formula.) Windows slide over the
//! schedule and grow while nothing gets shorter, until they are the whole schedule or the work is used up. Where a
//! window is too much for the solver, only two agents may do something new in it; the others may do what they did.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::layers::{NEVER, Reach};
use super::model::Lit;
use super::order::Order;
use super::sat::{Found, Fuel};
use super::{Scheduler, Steps};
use crate::task::{FactId, OperatorId, Task};

/// Steps of the first windows.
const NARROW: u32 = 4;

/// Conflicts of the solver for one window, at first.
const CONFLICTS: u64 = 1_000;

/// Operators that cost a unit of work to see whether they can be reached.
const OPERATORS_A_UNIT: u64 = 8;

/// Who may do something new in a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Who {
    All,
    /// The one who does most in it, and another: so many places after it.
    Two(usize),
}

/// A stretch of a schedule.
struct Window {
    /// What is done before it, in order.
    before: Vec<OperatorId>,
    /// What is done in it.
    work: Vec<OperatorId>,
    /// What is done after it, in order.
    after: Vec<OperatorId>,
    steps: u32,
    /// The state it begins in.
    state: Vec<u64>,
    /// What the rest relies on.
    goal: Vec<FactId>,
}

/// A schedule that gets shorter.
pub(super) struct Windows<'a> {
    scheduler: &'a Scheduler<'a>,
    pub order: Order,
    /// No schedule has fewer steps.
    pub bound: u32,
    /// Windows that did not get shorter.
    tried: BTreeSet<u64>,
    /// Steps of the windows that are looked at now.
    width: u32,
    /// Conflicts of the solver for one window.
    conflicts: u64,
    /// Some window of the sweep was too much for the solver.
    unclear: bool,
}

impl<'a> Windows<'a> {
    pub fn new(scheduler: &'a Scheduler<'a>, plan: Vec<OperatorId>, bound: u32) -> Self {
        let order = Order::new(scheduler.task, &scheduler.model.agent_of, plan);
        Windows {
            scheduler,
            order,
            bound,
            tried: BTreeSet::new(),
            width: NARROW,
            conflicts: CONFLICTS,
            unclear: false,
        }
    }

    /// Shortens until the bound is met or the fuel is used up.
    pub fn shorten(&mut self, fuel: &mut Fuel<'_>) {
        while self.order.makespan > self.bound && !fuel.is_empty() {
            let whole = self.width >= self.order.makespan;
            self.unclear = false;
            if self.sweep(Who::All, fuel) || fuel.is_empty() {
                continue;
            }
            let others = 1..self.scheduler.model.agents;
            if self.unclear && others.into_iter().any(|other| self.sweep(Who::Two(other), fuel)) {
                continue;
            }
            self.width += (self.width / 2).max(1);
            if whole {
                // Again, and try harder.
                self.conflicts = self.conflicts.saturating_mul(4);
                self.width = NARROW;
                self.tried.clear();
            }
        }
    }

    /// Slides a window over the schedule; whether the schedule got shorter.
    fn sweep(&mut self, who: Who, fuel: &mut Fuel<'_>) -> bool {
        let width = self.width;
        let mut gained = false;
        let stride = (width / 3).max(1);
        let mut from = 0;
        loop {
            let to = (from + width).min(self.order.makespan);
            let start = to.saturating_sub(width);
            if self.window(start, to, who, fuel) {
                gained = true;
                // What comes before may have become improvable.
                from = start.saturating_sub(width / 2);
            } else {
                from += stride;
            }
            if fuel.is_empty() || self.order.makespan <= self.bound || to >= self.order.makespan {
                return gained;
            }
        }
    }

    /// Tries to shorten the steps from `from` to before `to`.
    fn window(&mut self, from: u32, to: u32, who: Who, fuel: &mut Fuel<'_>) -> bool {
        if to - from < 2 {
            return false;
        }
        let window = self.cut(from, to);
        let mut hasher = DefaultHasher::new();
        (who, window.steps, &window.state, &window.goal).hash(&mut hasher);
        let mark = hasher.finish();
        if !self.tried.insert(mark) {
            return false;
        }
        let Some(steps) = self.shorter(&window, who, fuel) else {
            if fuel.is_empty() {
                // It had no fair chance.
                self.tried.remove(&mark);
            }
            return false;
        };
        let middle = steps.iter().flatten().copied();
        let plan: Vec<OperatorId> = window.before.into_iter().chain(middle).chain(window.after).collect();
        let task = self.scheduler.task;
        if !task.leads_to(&task.init, &plan, &task.goal) {
            return false;
        }
        let plan = crate::search::eliminate(task, plan);
        let order = Order::new(task, &self.scheduler.model.agent_of, plan);
        let better = order.makespan < self.order.makespan;
        if better {
            self.order = order;
        }
        better
    }

    /// The fewest steps found that do the window's work in less time than it has.
    fn shorter(&mut self, window: &Window, who: Who, fuel: &mut Fuel<'_>) -> Option<Steps> {
        let Scheduler { task, model, waiting, .. } = self.scheduler;
        let holds = |lit: Lit| model.holds(task, &window.state, lit);
        let reach = Reach::new(model, waiting, holds, window.steps - 1);
        // Looking at what can be reached is not free, either.
        fuel.work = fuel.work.saturating_sub(model.agent_of.len() as u64 / OPERATORS_A_UNIT);
        let goal = model.literals(&window.goal);
        let depth = reach.goal(&goal);
        let allowed = self.allowed(window, who);
        let mut best = None;
        let mut length = window.steps;
        while depth != NEVER && length > depth {
            let (found, steps) = fuel.for_window(self.conflicts, |fuel| {
                self.scheduler.span(&reach, &goal, &allowed, length - 1, fuel)
            });
            self.unclear |= found == Found::Stopped;
            if found != Found::Model {
                break;
            }
            length -= 1;
            best = Some(steps);
        }
        best
    }

    /// Which operators the window may be done with.
    fn allowed(&self, window: &Window, who: Who) -> Vec<bool> {
        let Scheduler { model, .. } = self.scheduler;
        let Who::Two(other) = who else { return vec![true; model.agent_of.len()] };
        let mut load = vec![0u32; model.agents];
        window.work.iter().for_each(|o| load[model.agent_of[o.index()] as usize] += 1);
        let busiest = (0..model.agents).max_by_key(|&agent| load[agent]).unwrap_or(0);
        let two = [busiest, (busiest + other) % model.agents];
        let mut allowed: Vec<bool> = model.agent_of.iter().map(|&a| two.contains(&(a as usize))).collect();
        window.work.iter().for_each(|o| allowed[o.index()] = true);
        allowed
    }

    /// Cuts a window out of the schedule.
    fn cut(&self, from: u32, to: u32) -> Window {
        let task = self.scheduler.task;
        let Order { plan, earliest, latest, .. } = &self.order;
        let (mut before, mut work, mut after) = (Vec::new(), Vec::new(), Vec::new());
        for at in 0..plan.len() {
            if earliest[at] < from {
                before.push((earliest[at], at));
            } else if latest[at] >= to {
                after.push((latest[at], at));
            } else {
                work.push(plan[at]);
            }
        }
        before.sort_unstable();
        after.sort_unstable();
        let operators = |list: &[(u32, usize)]| list.iter().map(|&(_, at)| plan[at]).collect::<Vec<_>>();
        let (before, after) = (operators(&before), operators(&after));
        let (mut state, mut next) = (task.init.clone(), task.init.clone());
        for &operator in &before {
            task.apply(&state, operator, &mut next);
            std::mem::swap(&mut state, &mut next);
        }
        let goal = needed(task, &after);
        Window { before, work, after, steps: to - from, state, goal }
    }
}

/// What must hold for the operators to run one after the other and lead to the goal.
fn needed(task: &Task, operators: &[OperatorId]) -> Vec<FactId> {
    let mut needed: BTreeSet<FactId> = task.goal.iter().copied().collect();
    for &operator in operators.iter().rev() {
        for fact in task.effects(operator) {
            needed.remove(fact);
        }
        needed.extend(task.preconditions(operator));
    }
    needed.into_iter().collect()
}
