//! What the allocator is asked and what it answers: the terms that allocation, combination and the reasons
//! for failure share.

use std::collections::BTreeSet;
use std::sync::Arc;

use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::GroundAct;

use crate::team::Team;
use crate::understand::Subgoal;

/// How finely sub-tasks are cut before they are given out. The coarser cuts are what remains when a finer one
/// did not lead to a plan: they lose parallelism and gain certainty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cut {
    /// Independent parts of a sub-task may go to different robots.
    #[default]
    Parts,
    /// A sub-task stays whole.
    Whole,
    /// The team plans as one actor, sub-task after sub-task, keeping what is reached; what it finds out of
    /// reach is out of reach.
    Team,
}

impl Cut {
    /// The next coarser one.
    pub fn coarser(self) -> Option<Cut> {
        match self {
            Cut::Parts => Some(Cut::Whole),
            Cut::Whole => Some(Cut::Team),
            Cut::Team => None,
        }
    }
}

/// Who decides which robot gets a sub-task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AllocationRule {
    /// The shortest makespan, over everybody's bids.
    #[default]
    Shortest,
    /// The language model, where it named robots: nobody else is asked, whether they can do it or not. To
    /// compare with.
    AsAdvised,
}

/// What there is to allocate.
#[derive(Clone, Debug)]
pub struct AllocateInput {
    /// How finely to cut.
    pub cut: Cut,
    /// Who decides.
    pub rule: AllocationRule,
    /// The team.
    pub team: Arc<Team>,
    /// Members that are alive, by index.
    pub available: Vec<usize>,
    /// What holds now.
    pub facts: BTreeSet<GroundAtom>,
    /// The sub-tasks.
    pub subgoals: Vec<Subgoal>,
    /// (sub-task, member) pairs that were tried and failed.
    pub excluded: BTreeSet<(usize, usize)>,
    /// What shall hold at the end, for the bound.
    pub final_goal: Condition,
    /// Bound of each search, in expanded states.
    pub expansions: u64,
}

/// What one robot plans for at once.
#[derive(Clone, Debug, PartialEq)]
pub struct PackageSpec {
    /// Whose.
    pub member: usize,
    /// Its goal.
    pub goal: Condition,
    /// The sub-tasks it serves, by index.
    pub subgoals: Vec<usize>,
    /// Packages it is planned after: by order asked for, by hand-over, or because they are the same
    /// robot's earlier work.
    pub after: Vec<usize>,
    /// Those among them whose order the instruction asks for.
    pub asked_after: Vec<usize>,
    /// A plan to fall back on when the robot's own planning fails.
    pub fallback: Option<Vec<GroundAct>>,
}

/// The result.
#[derive(Clone, Debug, PartialEq)]
pub struct Allocation {
    /// The packages; every `after` points backwards.
    pub packages: Vec<PackageSpec>,
    /// A lower bound of the makespan, in steps.
    pub lower_bound: f64,
}

impl Allocation {
    /// The members that serve a sub-task.
    pub fn members_of(&self, subgoal: usize) -> Vec<usize> {
        let mut members: Vec<usize> =
            self.packages.iter().filter(|p| p.subgoals.contains(&subgoal)).map(|p| p.member).collect();
        members.sort_unstable();
        members.dedup();
        members
    }
}

/// Why there is no allocation.
#[derive(Clone, Debug, PartialEq)]
pub enum NoAllocation {
    /// Proved: from the world as it is, neither a member nor all together can do it.
    Infeasible(String),
    /// Not the way it was tried; another cut may lead there.
    NotThisWay(String),
    /// Not found within the limits.
    GaveUp(String),
}
