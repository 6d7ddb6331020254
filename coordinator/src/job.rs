//! Long work of the coordinator.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::interpreter::Interpreter;

use crate::allocate::allocate;
use crate::allocation::{AllocateInput, Allocation, NoAllocation, PackageSpec};
use crate::combine::combine;
use crate::joint::{JointInput, JointPlan, plan_jointly};
use crate::merge::Merger;
use crate::shorten::{Combined, Shorten, shorten};
use crate::team::Team;
use crate::understand::Understood;

/// What the coordinator hands out.
#[derive(Clone, Debug)]
pub enum CoordinatorJob {
    /// Ask the language model. Done by whoever owns the model: it may wait for a network.
    Understand {
        /// What holds now, for the scene description.
        facts: BTreeSet<GroundAtom>,
    },
    /// See [`allocate`].
    Allocate(Box<AllocateInput>),
    /// See [`combine`].
    Combine(Box<CombineInput>),
    /// See [`plan_jointly`].
    PlanJointly(Box<JointInput>),
}

/// Input of [`CoordinatorJob::Combine`].
#[derive(Clone, Debug)]
pub struct CombineInput {
    /// The team.
    pub team: Arc<Team>,
    /// The merged plan.
    pub merger: Merger,
    /// The packages in it.
    pub packages: Vec<PackageSpec>,
    /// What shall hold at the end.
    pub goal: Condition,
    /// What may be done to make it shorter.
    pub shorten: Shorten,
}

/// What comes back.
#[derive(Debug)]
pub enum CoordinatorDone {
    /// Of [`CoordinatorJob::Understand`].
    Understood(Box<Understood>),
    /// Of [`CoordinatorJob::Allocate`].
    Allocated(Result<Allocation, NoAllocation>),
    /// Of [`CoordinatorJob::Combine`].
    Combined(Result<Box<Combined>, String>),
    /// Of [`CoordinatorJob::PlanJointly`].
    PlannedJointly(Result<Box<JointPlan>, NoAllocation>),
}

impl CoordinatorJob {
    /// Does the job; `understand` answers for the language model.
    pub fn run(
        self,
        understand: impl FnOnce(BTreeSet<GroundAtom>, &AtomicBool) -> Understood,
        cancel: &AtomicBool,
    ) -> CoordinatorDone {
        match self {
            CoordinatorJob::Understand { facts } => {
                CoordinatorDone::Understood(Box::new(understand(facts, cancel)))
            }
            CoordinatorJob::Allocate(input) => CoordinatorDone::Allocated(allocate(&input, cancel)),
            CoordinatorJob::Combine(input) => CoordinatorDone::Combined(input.run(cancel)),
            CoordinatorJob::PlanJointly(input) => {
                CoordinatorDone::PlannedJointly(plan_jointly(&input, cancel).map(Box::new))
            }
        }
    }
}

impl CombineInput {
    fn run(&self, cancel: &AtomicBool) -> Result<Box<Combined>, String> {
        let interpreter =
            Interpreter::new(&self.team.domain, &self.team.objects).map_err(|e| e.to_string())?;
        let plan = combine(&self.team, &interpreter, &self.merger, &self.packages, &self.goal, cancel)?;
        let (team, merger, how) = (&self.team, &self.merger, &self.shorten);
        Ok(Box::new(shorten(team, &interpreter, merger, plan, &self.goal, how, cancel)))
    }
}
