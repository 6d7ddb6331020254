//! The shortest schedule of a team: proved lower bounds of the makespan, and schedules that meet them.
//!
//! A schedule is a sequence of steps; in each, every agent does at most one action, and the actions of a step
//! may happen in any order. The least number of steps is the makespan of the best plan that can be carried out
//! under the rules of [`crate::partial_order`], where every action takes one step. For a given number of steps
//! the question "is there a schedule?" is a propositional formula ([`formula`]); that it has no model proves
//! that no plan of the team is so short.

mod auction;
mod formula;
mod improve;
mod layers;
mod limits;
mod milestones;
mod model;
mod order;
mod pairs;
mod pieces;
mod relevance;
mod sat;
mod stand_in;
mod together;
mod windows;
mod work;

use std::sync::atomic::AtomicBool;

use crate::search::eliminate;
use crate::task::{OperatorId, Task};
use layers::{NEVER, Reach, Waiting};
pub use limits::MakespanLimits;
pub use milestones::{Milestone, Need, all_before};
use model::{Lit, Model};
use order::Order;
use sat::{Found, Fuel, Question, is_true};
use together::Together;
use work::Work;

/// An operator in a step makes at least so many literals in a formula.
const LITERALS_PER_OPERATOR: u64 = 8;

/// What may be spent on which facts exclude each other, in words of bits looked at: some hundredths of a second.
const PAIRS: u64 = 30_000_000;

/// Steps of a team; the actions of a step may happen in any order, each agent does at most one of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// The operators of each step.
    pub steps: Vec<Vec<OperatorId>>,
}

impl Schedule {
    /// The number of steps.
    pub fn makespan(&self) -> u32 {
        self.steps.len() as u32
    }

    /// The operators, step by step.
    pub fn operators(&self) -> impl Iterator<Item = OperatorId> + '_ {
        self.steps.iter().flatten().copied()
    }
}

/// What is known about the shortest schedule.
#[derive(Clone, Debug)]
pub struct Makespan {
    /// No schedule has fewer steps: proved. `None`: there is no schedule at all, of any length.
    pub lower_bound: Option<u32>,
    /// The shortest schedule found, if one shorter than asked for was found.
    pub schedule: Option<Schedule>,
}

/// The schedules of a task.
#[derive(Debug)]
pub struct Scheduler<'a> {
    task: &'a Task,
    model: Model,
    waiting: Waiting,
    reach: Reach,
    /// The first layer in which all of the goal may hold.
    depth: u32,
    /// Operators that a shortest schedule may need.
    relevant: Vec<bool>,
    together: Together,
    /// Parts of the goal come one after the other.
    ordered: bool,
}

/// Operators, step by step.
type Steps = Vec<Vec<OperatorId>>;

/// A formula in the solver, and where to read the schedule.
struct Asked<'f> {
    question: Question<'f>,
    /// For each step, the operators and their variables.
    operators: Vec<Vec<(u32, sat::Bool)>>,
}

impl Asked<'_> {
    fn ask(&mut self, fuel: &mut Fuel<'_>) -> (Found, Steps) {
        let (found, model) = self.question.ask(fuel);
        let chosen = |step: &Vec<(u32, sat::Bool)>| {
            let done = step.iter().filter(|(_, variable)| is_true(&model, *variable));
            done.map(|&(operator, _)| OperatorId(operator)).collect::<Vec<_>>()
        };
        let steps =
            if found == Found::Model { self.operators.iter().map(chosen).collect() } else { Steps::new() };
        (found, steps)
    }
}

/// What there is to say about schedules of some length.
enum Answer {
    Schedule(Schedule),
    None,
    Unknown,
}

impl<'a> Scheduler<'a> {
    /// Prepares the schedules of a task; `agent_of` says whose each operator is, by numbers from 0. `None` if
    /// its goal cannot be reached even without deletes.
    pub fn new(task: &'a Task, agent_of: &[u32]) -> Option<Self> {
        Self::in_order(task, agent_of, &[])
    }

    /// The same for schedules that reach parts of the goal one after the other.
    pub fn in_order(task: &'a Task, agent_of: &[u32], milestones: &[Milestone]) -> Option<Self> {
        if !task.impossible.is_empty() || agent_of.len() != task.operators.len() {
            return None;
        }
        let mut model = Model::new(task, agent_of);
        let ordered = milestones.iter().any(|milestone| !milestone.after.is_empty());
        if ordered {
            model.put_in_order(task, milestones);
        }
        let waiting = Waiting::new(&model);
        let mut reach = Reach::new(&model, &waiting, |lit| model.initially[lit.index()], u32::MAX);
        if reach.goal(&model.goal) == NEVER {
            return None;
        }
        let relevant = stand_in::needed(task, &model);
        let plain = model.events.is_empty() && model.derivations.is_empty() && !ordered;
        let mut depth = reach.goal(&model.goal);
        if plain && !task.has_numbers() {
            let raised = pairs::raise(&model, &relevant, &mut reach, PAIRS);
            depth = raised.depth;
            model.put_apart(&raised.apart);
        }
        // Without conditional effects, what an agent may do to a literal is one variable anyway.
        let together =
            if model.events.is_empty() { Together::default() } else { Together::new(task, &model) };
        Some(Scheduler { task, model, waiting, reach, depth, relevant, together, ordered })
    }

    /// The depth of the joint planning graph: no schedule is shorter.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// A lower bound from the work there is, by looking at no more than `sets` sets of agents.
    pub fn work(&self, sets: usize) -> u32 {
        Work::new(self.task, &self.model, &self.reach).bound(sets)
    }

    /// Looks for the shortest schedule among those of at least `from` and less than `below` steps; `from` must be
    /// a proved bound. First upwards, where every failure raises the bound and the first success is a shortest
    /// schedule; when three quarters of the conflicts are spent, downwards from `below`, where every success is better than
    /// what was known.
    pub fn shortest(
        &self,
        from: u32,
        below: Option<u32>,
        limits: &MakespanLimits,
        cancel: &AtomicBool,
    ) -> Makespan {
        let down = below.map_or(0, |_| limits.conflicts / 4);
        let mut fuel = Fuel::new(limits, cancel);
        fuel.conflicts -= down;
        fuel.work = u64::MAX;
        let mut bound = from.max(self.depth());
        let end = below.unwrap_or(u32::MAX);
        while bound < end {
            match self.of_length(bound, &mut fuel) {
                Answer::None => bound += 1,
                Answer::Schedule(schedule) => {
                    return Makespan { lower_bound: Some(bound), schedule: Some(schedule) };
                }
                Answer::Unknown => break,
            }
        }
        let mut best = None;
        fuel.conflicts += down;
        let mut length = end;
        while below.is_some() && length > bound + 1 {
            match self.of_length(length - 1, &mut fuel) {
                Answer::Schedule(schedule) => {
                    length = schedule.makespan();
                    best = Some(schedule);
                }
                Answer::None => bound = length,
                Answer::Unknown => break,
            }
        }
        Makespan { lower_bound: Some(bound), schedule: best }
    }

    fn of_length(&self, steps: u32, fuel: &mut Fuel<'_>) -> Answer {
        if self.depth > steps {
            return Answer::None;
        }
        if fuel.stopped() {
            return Answer::Unknown;
        }
        match self.span(&self.reach, &self.model.goal, &self.relevant, steps, fuel) {
            (Found::Contradiction, _) => Answer::None,
            (Found::Stopped, _) => Answer::Unknown,
            (Found::Model, steps) => self.checked(steps),
        }
    }

    /// The formula for a stretch of so many steps, from where `reach` begins to `goal`, with the operators that
    /// are `allowed`; `None` if it is too large or takes too long.
    fn formula<'f>(
        &self,
        reach: &Reach,
        goal: &[Lit],
        allowed: &[bool],
        steps: u32,
        fuel: &mut Fuel<'f>,
    ) -> Option<Asked<'f>> {
        let layers = reach.layers(&self.model, goal, allowed, steps);
        let operators: usize = layers.iter().map(|layer| layer.operators.len()).sum();
        if operators as u64 * LITERALS_PER_OPERATOR > fuel.size {
            return None;
        }
        let Some(formula) = formula::formula(&self.model, &self.together, &layers, goal, fuel) else {
            // It was built until it got too large.
            fuel.work = fuel.work.saturating_sub(fuel.size);
            return None;
        };
        Some(Asked { question: formula.clauses.question(fuel)?, operators: formula.operators })
    }

    /// A schedule of such a stretch.
    fn span(
        &self,
        reach: &Reach,
        goal: &[Lit],
        allowed: &[bool],
        steps: u32,
        fuel: &mut Fuel<'_>,
    ) -> (Found, Steps) {
        match self.formula(reach, goal, allowed, steps, fuel) {
            Some(mut asked) => asked.ask(fuel),
            None => (Found::Stopped, Steps::new()),
        }
    }

    /// The steps a linear plan takes if everybody acts as soon as the others' actions allow. Only for tasks
    /// without conditional effects, derived facts and numbers.
    pub fn makespan_of(&self, plan: &[OperatorId]) -> Option<u32> {
        self.is_plain().then(|| Order::new(self.task, &self.model.agent_of, plan.to_vec()).makespan)
    }

    /// Whether operators do the same wherever they apply.
    fn is_plain(&self) -> bool {
        let unconditional = self.model.events.is_empty() && self.model.derivations.is_empty();
        unconditional && !self.ordered && !self.task.has_numbers()
    }

    /// The schedule without its idle actions, if it leads to the goal: what the formula does not know about
    /// derived facts may make it wrong.
    fn checked(&self, steps: Vec<Vec<OperatorId>>) -> Answer {
        let plan: Vec<OperatorId> = steps.iter().flatten().copied().collect();
        if !self.task.leads_to(&self.task.init, &plan, &self.task.goal) {
            return Answer::Unknown;
        }
        let mut once: Vec<u32> = plan.iter().map(|o| o.0).collect();
        once.sort_unstable();
        once.dedup();
        // Which of two equal operators is idle cannot be told from what is kept.
        let kept = if once.len() == plan.len() { self.without_idle(plan) } else { plan };
        let mut kept = kept.into_iter().peekable();
        let mut steps: Vec<Vec<OperatorId>> = steps
            .into_iter()
            .map(|step| step.into_iter().filter(|o| kept.next_if_eq(o).is_some()).collect())
            .collect();
        while steps.last().is_some_and(Vec::is_empty) {
            steps.pop();
        }
        Answer::Schedule(Schedule { steps })
    }

    /// Leaves out what the plan does not need, the last first: of two actions that do the same, the formula may count
    /// on the earlier one, and whoever relies on the later one has to wait.
    fn without_idle(&self, mut plan: Vec<OperatorId>) -> Vec<OperatorId> {
        for at in (0..plan.len()).rev() {
            let operator = plan.remove(at);
            if !self.task.leads_to(&self.task.init, &plan, &self.task.goal) {
                plan.insert(at, operator);
            }
        }
        eliminate(self.task, plan)
    }
}
