//! Carrying out the robot's part of the team's plan: one step after the other, each behind its gates.

use lamma_protocol::message::{Ack, Refusal, RefusalKind, Request, Step, Verdict};
use lamma_protocol::{AgentId, Epoch, Frame, StepIndex};

/// The steps of one epoch and how far they are.
#[derive(Clone, Debug)]
pub(crate) struct Execution {
    agent: AgentId,
    epoch: Epoch,
    steps: Vec<Step>,
    done: StepIndex,
    asked: Option<StepIndex>,
    refused: Option<Refusal>,
}

impl Execution {
    pub fn new(agent: AgentId, epoch: Epoch, steps: Vec<Step>) -> Self {
        Execution { agent, epoch, steps, done: StepIndex(0), asked: None, refused: None }
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
        if self.asked == Some(self.done) || !step.gates.iter().all(|gate| frame.open(*gate)) {
            return None;
        }
        self.asked = Some(self.done);
        Some(self.request(step))
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
                self.asked = None;
                return false;
            }
            Verdict::Refused(refusal) => self.refused = Some(refusal.clone()),
        }
        true
    }
}
