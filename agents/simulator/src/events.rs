//! What happens without the team: a thing is moved, a door closed, an action fails.
//!
//! An event is tied to a step of a robot and happens just before the arbiter judges that step. So that the same
//! script gives the same episode, the step is first held until the world has been still for a while: then
//! everything that does not wait for it has happened, whoever of the team was quicker.

use lamma_planner::GroundAct;
use lamma_protocol::{AgentId, Tick};

/// How long the world must have been still before an event happens, in milliseconds.
pub(crate) const STILL_MS: u64 = 300;

/// Something that happens without the team.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Whose step it comes before.
    pub agent: AgentId,
    /// Which of that robot's steps, counted from 1 over the whole run.
    pub step: u64,
    /// What happens.
    pub what: Happening,
}

/// What happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// An action of the domain that is nobody's skill. One that is not possible by then does not happen.
    Act(GroundAct),
    /// The robot's step fails: nothing changes and it is refused.
    Fail,
}

/// Events that have not happened yet, and what is needed to know when they do.
#[derive(Debug, Default)]
pub(crate) struct Events {
    pending: Vec<Event>,
    /// Steps of each agent that were judged for good.
    judged: Vec<u64>,
    changed_at: Tick,
}

impl Events {
    pub fn new(pending: Vec<Event>, agents: usize) -> Self {
        Events { pending, judged: vec![0; agents], changed_at: Tick(0) }
    }

    /// Whether something happens before the agent's next step.
    pub fn is_due(&self, agent: AgentId) -> bool {
        self.pending.iter().any(|e| self.is_now(e, agent))
    }

    fn is_now(&self, event: &Event, agent: AgentId) -> bool {
        event.agent == agent && self.judged.get(agent.index()).is_some_and(|done| done + 1 == event.step)
    }

    /// When the world will have been still for long enough, if nothing more changes.
    pub fn still_at(&self) -> Tick {
        self.changed_at.after_ms(STILL_MS)
    }

    /// Takes what happens before the agent's next step.
    pub fn take(&mut self, agent: AgentId) -> Vec<Happening> {
        let (now, later) = std::mem::take(&mut self.pending).into_iter().partition(|e| self.is_now(e, agent));
        self.pending = later;
        let now: Vec<Event> = now;
        now.into_iter().map(|e| e.what).collect()
    }

    /// A step of the agent was judged for good.
    pub fn judged(&mut self, agent: AgentId) {
        if let Some(count) = self.judged.get_mut(agent.index()) {
            *count += 1;
        }
    }

    /// The world has changed.
    pub fn changed(&mut self, now: Tick) {
        self.changed_at = now;
    }
}
