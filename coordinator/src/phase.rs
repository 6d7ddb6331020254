//! The phases of the coordinator. Each owns its data; nothing of a phase outlives it.

use std::collections::{BTreeMap, BTreeSet};

use lamma_protocol::message::Package;
use lamma_protocol::{JobId, PackageId, StepIndex, Tick};

use crate::allocation::Allocation;
use crate::combine::TeamPlan;
use crate::merge::Merger;

/// Where the run is.
#[derive(Debug)]
pub(crate) enum Phase {
    /// Waiting for every robot's first report and the first frame.
    Joining,
    /// A new epoch is asked for; no directive goes out before a frame shows it.
    Granting,
    /// The language model is at work.
    Decomposing(JobId),
    /// The allocator is at work.
    Allocating(JobId),
    /// Robots plan their packages.
    Planning(Box<Round>),
    /// The combiner is at work.
    Combining(JobId, Box<Round>),
    /// The whole team is planned for at once.
    PlanningJointly(JobId),
    /// The language model writes the plan.
    Writing(JobId, Option<Allocation>),
    /// Robots act.
    Executing(Box<Following>),
    /// The outcome is out.
    Finished,
}

impl Phase {
    /// The phase's name for people.
    pub fn label(&self) -> &'static str {
        match self {
            Phase::Joining => "joining",
            Phase::Granting => "granting",
            Phase::Decomposing(_) => "decomposing",
            Phase::Allocating(_) => "allocating",
            Phase::Planning(_) => "planning",
            Phase::Combining(..) => "combining",
            Phase::PlanningJointly(_) | Phase::Writing(..) => "planning",
            Phase::Executing(_) => "executing",
            Phase::Finished => "finished",
        }
    }
}

/// Planning, package by package, in batches: a batch is what can be planned on the same state. Its plans
/// are merged in the order of the packages when all are there, so that the result does not depend on who
/// answers first.
#[derive(Debug)]
pub(crate) struct Round {
    pub allocation: Allocation,
    pub merger: Merger,
    /// Packages planned and merged.
    pub merged: BTreeSet<usize>,
    /// The batch: what each package was asked for as.
    pub asked: BTreeMap<usize, PackageId>,
    /// When the batch was asked for.
    pub asked_at: Tick,
    /// Everything asked for so far in this epoch, per member: a directive states all of it.
    pub directives: Vec<Vec<Package>>,
    pub next_id: u32,
    /// Packages that had to be planned again because they did not fit after the others.
    pub conflicts: u32,
}

impl Round {
    pub fn new(allocation: Allocation, merger: Merger, members: usize) -> Self {
        Round {
            allocation,
            merger,
            merged: BTreeSet::new(),
            asked: BTreeMap::new(),
            asked_at: Tick(0),
            directives: vec![Vec::new(); members],
            next_id: 0,
            conflicts: 0,
        }
    }

    /// Packages whose predecessors are all merged.
    pub fn ready(&self) -> Vec<usize> {
        let packages = &self.allocation.packages;
        (0..packages.len())
            .filter(|p| !self.merged.contains(p) && !self.asked.contains_key(p))
            .filter(|&p| packages[p].after.iter().all(|before| self.merged.contains(before)))
            .collect()
    }

    pub fn is_complete(&self) -> bool {
        self.merged.len() == self.allocation.packages.len()
    }
}

/// The team's plan and how far it is.
#[derive(Debug)]
pub(crate) struct Following {
    pub allocation: Allocation,
    pub plan: TeamPlan,
    /// Steps reported to the person so far, per member.
    pub told: Vec<StepIndex>,
    /// When the last step was applied.
    pub last_progress: Tick,
}
