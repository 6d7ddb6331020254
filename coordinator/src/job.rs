//! Long work of the coordinator.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_lm::Script;
use lamma_pddl::ast::{Condition, GroundAtom};

use crate::allocate::allocate;
use crate::allocation::{AllocateInput, Allocation, NoAllocation, PackageSpec};
use crate::combine::combine;
use crate::joint::{JointInput, JointPlan, plan_jointly};
use crate::merge::Merger;
use crate::shorten::{Combined, Shorten, shorten};
use crate::team::Team;
use crate::understand::Understood;
use crate::written::{NotWritten, WriteInput, WrittenPlan};

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
    /// Have the language model write the plan. Done by whoever owns the model, too.
    Write(Box<WriteInput>),
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
    /// Of [`CoordinatorJob::Write`].
    Written(Result<Box<WrittenPlan>, NotWritten>),
}

/// Who owns the language model.
pub trait Author {
    /// What the instruction means in a world where these facts hold.
    fn understand(&mut self, facts: BTreeSet<GroundAtom>, cancel: &AtomicBool) -> Understood;

    /// A plan of the model's own. What `check` finds wrong goes back to the model.
    fn write(
        &mut self,
        input: &WriteInput,
        check: &dyn Fn(&Script) -> Vec<String>,
        cancel: &AtomicBool,
    ) -> Result<Script, NotWritten>;
}

impl CoordinatorJob {
    /// Does the job; `author` answers for the language model.
    pub fn run(self, author: &mut dyn Author, cancel: &AtomicBool) -> CoordinatorDone {
        match self {
            CoordinatorJob::Understand { facts } => {
                CoordinatorDone::Understood(Box::new(author.understand(facts, cancel)))
            }
            CoordinatorJob::Allocate(input) => CoordinatorDone::Allocated(allocate(&input, cancel)),
            CoordinatorJob::Combine(input) => CoordinatorDone::Combined(input.run(cancel)),
            CoordinatorJob::PlanJointly(input) => {
                CoordinatorDone::PlannedJointly(plan_jointly(&input, cancel).map(Box::new))
            }
            CoordinatorJob::Write(input) => {
                let plan = input.run(|input, check| author.write(input, check, cancel));
                CoordinatorDone::Written(plan.map(Box::new))
            }
        }
    }
}

impl CombineInput {
    fn run(&self, cancel: &AtomicBool) -> Result<Box<Combined>, String> {
        let interpreter = self.team.interpreter().map_err(|e| e.to_string())?;
        let plan = combine(&self.team, &interpreter, &self.merger, &self.packages, &self.goal, cancel)?;
        let (team, merger, how) = (&self.team, &self.merger, &self.shorten);
        Ok(Box::new(shorten(team, &interpreter, merger, plan, &self.goal, how, cancel)))
    }
}
