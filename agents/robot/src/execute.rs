//! Carrying out the robot's part of the team's plan: one step after the other, each behind its gates.

use lamma_protocol::message::{Ack, Gate, Refusal, RefusalKind, Request, Step, Verdict};
use lamma_protocol::{AgentId, Awaits, Epoch, Frame, StepIndex};

/// The steps of one epoch and how far they are.
#[derive(Clone, Debug)]
pub(crate) struct Execution {
    agent: AgentId,
    epoch: Epoch,
    steps: Vec<Step>,
    done: StepIndex,
    asked: Option<StepIndex>,
    /// Of the first step that was not asked for: a gate that was closed in the last frame.
    closed: Option<Gate>,
    refused: Option<Refusal>,
}

impl Execution {
    pub fn new(agent: AgentId, epoch: Epoch, steps: Vec<Step>) -> Self {
        Execution { agent, epoch, steps, done: StepIndex(0), asked: None, closed: None, refused: None }
    }

    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    pub fn done(&self) -> StepIndex {
        self.done
    }

    pub fn refused(&self) -> Option<&Refusal> {
        self.refused.as_ref()
    }

    pub fn finished(&self) -> bool {
        self.done.index() >= self.steps.len()
    }

    /// Looks at the world: the frame shows both what was applied of ours and which gates are open. Gives
    /// the request to make, if a step has become possible.
    pub fn look(&mut self, frame: &Frame<'_>) -> Option<Request> {
        if frame.epoch() != self.epoch || self.refused.is_some() {
            return None;
        }
        self.done = self.done.max(frame.progress(self.agent));
        let step = self.steps.get(self.done.index())?;
        let closed = |step: &Step| step.gates.iter().find(|gate| !frame.open(**gate)).copied();
        if self.asked != Some(self.done) {
            self.closed = closed(step);
            if self.closed.is_some() {
                return None;
            }
        }
        let next = self.steps.get(self.done.next().index());
        self.closed = next.and_then(closed);
        (self.asked.replace(self.done) != Some(self.done)).then(|| self.request(step))
    }

    /// Which frame there is something to do in. While an answer is awaited, that is the frame which opens the next
    /// step's gate, if it has one that is closed: it comes no sooner than the answer is of use.
    pub fn awaits(&self) -> Awaits {
        match self.closed {
            _ if self.finished() || self.refused.is_some() => Awaits::NoFrame,
            Some(gate) => Awaits::Opening(gate),
            None if self.asked == Some(self.done) => {
                Awaits::Opening(Gate { agent: self.agent, done: self.done.next() })
            }
            None => Awaits::AnyFrame,
        }
    }

    /// The request that is waiting for an answer, to be said again.
    pub fn pending(&self) -> Option<Request> {
        let asked = self.asked.filter(|asked| *asked == self.done && self.refused.is_none())?;
        self.steps.get(asked.index()).map(|step| self.request(step))
    }

    fn request(&self, step: &Step) -> Request {
        Request { epoch: self.epoch, step: self.done, act: step.act.clone(), gates: step.gates.clone() }
    }

    /// Takes the arbiter's answer. True if something has changed.
    pub fn answer(&mut self, ack: &Ack) -> bool {
        if ack.epoch != self.epoch || ack.step != self.done {
            return false;
        }
        match &ack.verdict {
            Verdict::Applied { .. } => self.done = self.done.next(),
            // Both pass by themselves: a frame opens the gate, or a directive brings the new epoch.
            Verdict::Refused(Refusal { kind: RefusalKind::TooEarly | RefusalKind::StaleEpoch, .. }) => {
                (self.asked, self.closed) = (None, None);
                return false;
            }
            Verdict::Refused(refusal) => self.refused = Some(refusal.clone()),
        }
        true
    }
}
