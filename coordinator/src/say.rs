//! What the coordinator says: events for the person, grants, directives, the outcome.

use lamma_protocol::message::{Directive, Event, EventKind, Grant, Message, Order, Outcome};
use lamma_protocol::{AgentId, Epoch, JobId, Output, Topic};

use crate::job::CoordinatorJob;
use crate::machine::Coordinator;
use crate::result::FaultResult;

/// How often the coordinator looks whether something is to be said again, in milliseconds; grant and outcome are
/// each time.
const REPEAT_MS: u64 = 100;
/// Events kept for the supervisor.
const EVENT_WINDOW: usize = 400;

impl Coordinator {
    pub(crate) fn event(&mut self, kind: EventKind, text: impl Into<String>) {
        let event = Event { tick_us: self.now.0, kind, text: text.into() };
        self.events.push_back(event);
        if self.events.len() > EVENT_WINDOW {
            self.events.pop_front();
            self.events_dropped += 1;
        }
        self.untold = true;
    }

    pub(crate) fn fault(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.faults.push(FaultResult { at_ms: self.now.0 as f64 / 1e3, text: text.clone() });
        self.event(EventKind::Fault, text);
    }

    pub(crate) fn recovery(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.recoveries.push(FaultResult { at_ms: self.now.0 as f64 / 1e3, text: text.clone() });
        self.event(EventKind::Fault, text);
    }

    pub(crate) fn say_outcome(&mut self) {
        self.untold = false;
        let outcome = Outcome {
            phase: self.phase.label().into(),
            first_event: self.events_dropped,
            events: self.events.iter().cloned().collect(),
            result: self.result.clone(),
        };
        self.outputs.push_back(Output::Publish(Topic::Outcome, Message::Outcome(outcome)));
    }

    pub(crate) fn say_grant(&mut self) {
        let grant = Grant { epoch: self.epoch, lost: self.granted_lost.clone() };
        self.outputs.push_back(Output::Publish(Topic::Grant, Message::Grant(grant)));
    }

    pub(crate) fn direct(&mut self, agent: AgentId, order: Order) {
        let directive = Directive { epoch: self.epoch, order };
        if self.directives.last(agent) == Some(&directive) {
            return;
        }
        self.directives.news(agent, directive.clone(), self.now);
        self.outputs.push_back(Output::Publish(Topic::Directive(agent), Message::Directive(directive)));
    }

    pub(crate) fn spawn(&mut self, job: CoordinatorJob) -> JobId {
        let id = JobId(self.next_job);
        self.next_job += 1;
        self.outputs.push_back(Output::Spawn(id, job));
        id
    }

    pub(crate) fn repeat(&mut self) {
        self.repeat_at = self.now.after_ms(REPEAT_MS);
        if self.epoch > Epoch(0) {
            self.say_grant();
        }
        let due = self.directives.due(self.now);
        self.outputs
            .extend(due.map(|(agent, d)| Output::Publish(Topic::Directive(agent), Message::Directive(d))));
        self.say_outcome();
    }
}
