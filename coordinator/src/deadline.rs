//! What happens when something takes too long. No phase waits without a deadline.

use lamma_protocol::{AgentId, Tick};
use serde::{Deserialize, Serialize};

use crate::machine::Coordinator;
use crate::phase::Phase;
use crate::result::OutcomeKind;

/// How long the others are waited for, in milliseconds. Across a network both are a matter of the place: how long
/// people take to start the hosts, and how long a link may be down before those behind it count as lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Patience {
    /// How long everybody has to join.
    pub join_ms: u64,
    /// How long nobody may move before those who could are given up.
    pub stall_ms: u64,
}

impl Default for Patience {
    fn default() -> Self {
        Patience { join_ms: 15_000, stall_ms: 4_000 }
    }
}

/// How long the arbiter may take to open an epoch. One whose process has died is told of by the supervisor, at once:
/// this is for one that hangs, and a host that is busy with something else must not look like that.
const GRANT_MS: u64 = 30_000;
/// How long a robot may plan one batch.
const PLAN_MS: u64 = 60_000;

impl Coordinator {
    pub(crate) fn phase_deadline(&self) -> Option<Tick> {
        let after = |ms| Some(self.stopwatch.since().after_ms(ms));
        match &self.phase {
            Phase::Joining => after(self.config.patience.join_ms),
            Phase::Granting => after(GRANT_MS),
            Phase::Planning(round) => Some(round.asked_at.after_ms(PLAN_MS)),
            Phase::Executing(following) => {
                let stall = self.config.patience.stall_ms + 2 * self.config.step_ms;
                Some(following.last_progress.after_ms(stall))
            }
            Phase::Decomposing(_)
            | Phase::Allocating(_)
            | Phase::Combining(..)
            | Phase::PlanningJointly(_)
            | Phase::Writing(..)
            | Phase::Finished => None,
        }
    }

    pub(crate) fn timeout(&mut self) {
        if self.now >= self.repeat_at {
            self.repeat();
        }
        if matches!(self.phase, Phase::Finished) {
            return;
        }
        if self.now >= Tick(0).after_ms(self.config.time_limit_ms) {
            let reason = format!("out of time while {}", self.phase.label());
            return self.finish(OutcomeKind::GaveUp, Some(reason));
        }
        if self.phase_deadline().is_some_and(|deadline| self.now >= deadline) {
            self.overdue();
        }
    }

    pub(crate) fn overdue(&mut self) {
        let late: Vec<AgentId> = match &self.phase {
            Phase::Granting => {
                let reason = "the simulator does not answer".into();
                return self.finish(OutcomeKind::Error, Some(reason));
            }
            Phase::Joining => {
                if self.view.state().is_none() {
                    let reason = "no world: the simulator has not joined".into();
                    return self.finish(OutcomeKind::Error, Some(reason));
                }
                self.roster.alive().filter(|a| self.roster.report(*a).is_none()).collect()
            }
            Phase::Planning(round) => self.unanswered(round),
            Phase::Executing(following) => self.stuck(following),
            Phase::Decomposing(_)
            | Phase::Allocating(_)
            | Phase::Combining(..)
            | Phase::PlanningJointly(_)
            | Phase::Writing(..)
            | Phase::Finished => return,
        };
        if late.is_empty() {
            let reason = format!("nothing moves and nobody is late while {}", self.phase.label());
            return self.finish(OutcomeKind::Error, Some(reason));
        }
        for agent in late {
            self.lose(agent, format!("does not answer while {}", self.phase.label()));
        }
        self.after_loss();
    }
}
