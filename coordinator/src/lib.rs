//! The coordinator: understands, allocates, combines and follows through.
//!
//! The paper's modules (LaMMA-P, section III) map to rooms: Precondition Identifier to [`understand`], Task
//! Allocator to [`allocate`] and [`split`], Problem Generator to [`problem`], Sub-Plan Combiner to
//! [`combine`]. The state machine that calls on them is [`machine`].

pub mod allocate;
pub mod allocation;
pub mod assign;
pub mod bans;
pub mod bound;
pub mod combine;
mod costs;
mod deadline;
pub mod decompose;
mod follow;
pub mod house;
mod hurry;
pub mod job;
pub mod joint;
pub mod machine;
pub mod merge;
pub mod method;
pub mod mission;
pub mod parts;
mod phase;
pub mod problem;
mod reason;
mod report;
pub mod result;
mod roster;
mod say;
mod sequence;
pub mod shorten;
pub mod split;
mod stopwatch;
pub mod team;
mod transition;
mod travel_bound;
pub mod understand;
mod world_view;
pub mod written;

pub use allocation::AllocationRule;
pub use deadline::Patience;
pub use job::{Author, CoordinatorDone, CoordinatorJob};
pub use machine::{Coordinator, CoordinatorConfig};
pub use method::{Method, Steps};
pub use mission::Mission;
pub use team::{Member, Relaxation, Team};
pub use understand::{GoalGroup, GoalItem, ScoreGoal, Subgoal, Understanding, Understood};
