//! How short a team's plan can be: the joint task, and bounds of its makespan.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::heuristic::{Costs, Estimate, Heuristic, LandmarkCut};
use lamma_planner::{Makespan, MakespanLimits, Milestone, OperatorId, Plan, Scheduler, Task};

use crate::problem::joint_problem;
use crate::team::Team;
use crate::travel_bound::travel_floor;

/// Sets of agents whose work is looked at for a bound: so many, and fewer where there are many operators.
const SETS: usize = 32;
const OPERATORS_IN_ALL_SETS: usize = 50_000;

/// The task of the whole team as one actor, grounded.
#[derive(Debug)]
pub struct JointTask {
    /// The task.
    pub task: Task,
    /// Whose each operator is: an index into the team.
    pub member_of: Vec<u32>,
    members: u32,
}

impl JointTask {
    /// Grounds the task of the `available` members. Errors in words if it cannot be grounded or some operator
    /// is nobody's.
    pub fn new(
        team: &Team,
        available: &[usize],
        facts: &BTreeSet<GroundAtom>,
        goal: &Condition,
    ) -> Result<Self, String> {
        let (domain, skills) = team.joint(available);
        let problem = joint_problem(team, facts, &skills, goal);
        let task = lamma_planner::ground::ground(&domain, &problem, &Default::default())
            .map_err(|e| e.to_string())?;
        let operators = (0..task.operators.len() as u32).map(OperatorId);
        let member_of = operators
            .map(|operator| {
                let act = task.act(operator);
                let member = act.args.first().and_then(|name| team.member(name));
                member.map(|m| m as u32).ok_or_else(|| format!("nobody of the team does {act}"))
            })
            .collect::<Result<_, _>>()?;
        Ok(JointTask { task, member_of, members: available.len() as u32 })
    }

    /// The cheap lower bound: the larger of two admissible ones.
    ///
    /// - The depth of the relaxed plan of the whole team (h_max with unit costs, Bonet & Geffner, "Planning as
    ///   heuristic search", AIJ 129, 2001): in every time step each robot does at most one action, and without
    ///   deletes nothing gets in the way.
    /// - The work, shared out: the landmark cut (Helmert & Domshlak, ICAPS 2009) bounds the number of actions of
    ///   any plan, and so many robots do at most so many actions in a time step.
    ///
    /// `None` if the goal is out of reach.
    pub fn floor(&self) -> Option<u32> {
        let depth = lamma_planner::hmax_unit(&self.task)?;
        let work = match LandmarkCut::new(&self.task, Costs::Unit).estimate(&self.task.init, &mut Vec::new())
        {
            Estimate::Cost(actions) => actions,
            Estimate::DeadEnd => 0,
        };
        Some(depth.max(work.div_ceil(self.members.max(1))))
    }

    /// A shorter schedule than the plan's, which takes `makespan` steps, and a bound of at least `floor` (a proved
    /// one). `None` if the goal is out of reach.
    pub fn improve(
        &self,
        plan: &Plan,
        makespan: u32,
        floor: u32,
        limits: &MakespanLimits,
        cancel: &AtomicBool,
    ) -> Option<Makespan> {
        let scheduler = Scheduler::new(&self.task, &self.member_of)?;
        // A bound above a plan that is known would be a fault of the proof; never print one.
        let floor = floor.max(self.work(&scheduler)).min(makespan);
        if floor == makespan {
            return Some(Makespan { lower_bound: Some(floor), schedule: None });
        }
        let operators = self.task.trace(plan).unwrap_or_default();
        Some(scheduler.improve(&operators, makespan, floor, limits, cancel))
    }

    /// The bound from the work of some of the team.
    fn work(&self, scheduler: &Scheduler<'_>) -> u32 {
        scheduler.work((OPERATORS_IN_ALL_SETS / self.task.operators.len().max(1)).clamp(1, SETS))
    }

    /// [`JointTask::floor`], or [`travel_floor`] if that says more.
    pub fn floor_of(&self, team: &Team, facts: &BTreeSet<GroundAtom>) -> Option<u32> {
        let travelled = team.travel.as_ref().and_then(|travel| travel_floor(&self.task, travel, team, facts));
        Some(self.floor()?.max(travelled.unwrap_or(0)))
    }

    /// The shortest schedule of at least `from` (a proved bound) and less than `below` steps that keeps the order
    /// of `milestones`, or how far the bound could be raised within the limits. `None` if the goal is out of reach.
    pub fn shortest(
        &self,
        milestones: &[Milestone],
        from: u32,
        below: Option<u32>,
        limits: &MakespanLimits,
        cancel: &AtomicBool,
    ) -> Option<Makespan> {
        let scheduler = Scheduler::in_order(&self.task, &self.member_of, milestones)?;
        let from = from.max(self.work(&scheduler)).min(below.unwrap_or(u32::MAX));
        Some(scheduler.shortest(from, below, limits, cancel))
    }
}

/// [`JointTask::floor_of`] a team in a state; `None` if the goal is out of reach.
pub fn makespan_lower_bound(
    team: &Team,
    available: &[usize],
    facts: &BTreeSet<GroundAtom>,
    goal: &Condition,
) -> Option<u32> {
    JointTask::new(team, available, facts, goal).ok()?.floor_of(team, facts)
}
