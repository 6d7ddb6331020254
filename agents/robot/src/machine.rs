//! The robot's state machine: joins, plans what it is given, carries out its steps.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use lamma_pddl::ast::Domain;
use lamma_protocol::message::{Directive, Message, Order, Package, PackageReport, Report, Share, Step};
use lamma_protocol::{
    AgentId, Awaits, Epoch, Frame, Input, JobId, Machine, Output, PackageId, Repeat, Revision, StepIndex,
    Tick, Topic,
};

use crate::execute::Execution;
use crate::planning::{RobotDone, RobotJob};

/// What a robot is born with.
#[derive(Clone, Debug)]
pub struct RobotConfig {
    /// Its place in the roster.
    pub id: AgentId,
    /// Its process, for the record.
    pub pid: u32,
    /// Its own domain, or why it has none.
    pub domain: Result<Arc<Domain>, String>,
    /// Bound of one search, in expanded states.
    pub expansions: u64,
    /// What it tells the coordinator of its own task when it joins, if that does not come from elsewhere.
    pub share: Option<Share>,
}

/// What the robot is doing.
#[derive(Debug)]
enum Phase {
    /// It has said that it is here and waits for the first directive.
    Idle,
    /// It plans packages; those planned are in `plans`.
    Planning { jobs: BTreeMap<JobId, PackageId> },
    /// It carries out its steps.
    Executing(Execution),
    /// The run is over.
    Left,
}

/// A robot.
#[derive(Debug)]
pub struct Robot {
    config: RobotConfig,
    epoch: Epoch,
    phase: Phase,
    plans: Vec<PackageReport>,
    heard: Option<Revision>,
    answered: Option<Revision>,
    /// What the last frame said of the team, if there was nothing to do in it: steps that come after it begin there.
    seen: Vec<u64>,
    next_job: u64,
    /// When the last input came.
    now: Tick,
    /// Of the report and of a request that waits for its answer.
    repeat: Repeat,
    outputs: VecDeque<Output<RobotJob>>,
}

impl Robot {
    /// A robot that is about to join.
    pub fn new(config: RobotConfig) -> Self {
        Robot {
            config,
            epoch: Epoch(0),
            phase: Phase::Idle,
            plans: Vec::new(),
            heard: None,
            answered: None,
            seen: Vec::new(),
            next_job: 0,
            now: Tick(0),
            repeat: Repeat::default(),
            outputs: VecDeque::new(),
        }
    }

    fn directive(&mut self, revision: Revision, directive: Directive) {
        if self.heard.is_some_and(|heard| revision <= heard) || directive.epoch < self.epoch {
            return;
        }
        self.heard = Some(revision);
        let entered = directive.epoch > self.epoch;
        if entered {
            self.enter(directive.epoch);
        }
        let new = match directive.order {
            Order::Stand => false,
            Order::Plan(packages) => self.plan(packages),
            Order::Execute(steps) => self.execute(steps),
            Order::Leave => self.leave(),
        };
        // An order said again is no news: a large team that answered each would keep its coordinator busy for ever.
        if entered || new {
            self.report();
        }
    }

    fn leave(&mut self) -> bool {
        self.cancel_jobs();
        self.phase = Phase::Left;
        self.outputs.push_back(Output::Finish);
        true
    }

    /// A new epoch voids everything of the old.
    fn enter(&mut self, epoch: Epoch) {
        self.cancel_jobs();
        self.epoch = epoch;
        self.plans.clear();
        self.phase = Phase::Idle;
    }

    fn cancel_jobs(&mut self) {
        if let Phase::Planning { jobs } = &self.phase {
            self.outputs.extend(jobs.keys().map(|job| Output::Cancel(*job)));
        }
    }

    /// Begins with the packages that it does not know; true if there are any.
    fn plan(&mut self, packages: Vec<Package>) -> bool {
        let Ok(domain) = self.config.domain.clone() else { return false };
        if let Phase::Idle = self.phase {
            self.phase = Phase::Planning { jobs: BTreeMap::new() };
        }
        let Phase::Planning { jobs } = &mut self.phase else { return false };
        let first = self.next_job;
        for package in packages {
            let known =
                self.plans.iter().any(|p| p.id == package.id) || jobs.values().any(|id| *id == package.id);
            if known {
                continue;
            }
            let job = JobId(self.next_job);
            self.next_job += 1;
            jobs.insert(job, package.id);
            let work = RobotJob { package, domain: domain.clone(), expansions: self.config.expansions };
            self.outputs.push_back(Output::Spawn(job, work));
        }
        self.next_job > first
    }

    /// Begins to carry out the steps, if it has not begun; true if it begins now.
    fn execute(&mut self, steps: Vec<Step>) -> bool {
        let begins = !matches!(self.phase, Phase::Executing(_));
        if begins {
            self.cancel_jobs();
            // Who hands out steps has heard the plans: they need not be said again and again.
            self.plans.clear();
            self.phase = Phase::Executing(Execution::new(self.config.id, self.epoch, steps));
            let seen = std::mem::take(&mut self.seen);
            if let Ok(frame) = Frame::new(&seen) {
                self.frame(&frame);
            }
        }
        begins
    }

    fn planned(&mut self, job: JobId, done: RobotDone) {
        if let Phase::Planning { jobs } = &mut self.phase
            && jobs.remove(&job).is_some()
        {
            self.plans.push(done);
            self.report();
        }
    }

    fn frame(&mut self, frame: &Frame<'_>) {
        let execution = match &mut self.phase {
            Phase::Executing(execution) if execution.epoch() == frame.epoch() => execution,
            _ => {
                self.seen = frame.without_facts();
                return;
            }
        };
        let before = execution.done();
        let request = execution.look(frame);
        let changed = execution.done() != before;
        if let Some(request) = request {
            self.repeat.news(self.now);
            self.outputs
                .push_back(Output::Publish(Topic::Request(self.config.id), Message::Request(request)));
        }
        if changed && self.finished() {
            self.report();
        }
    }

    fn finished(&self) -> bool {
        matches!(&self.phase, Phase::Executing(execution) if execution.finished())
    }

    fn report(&mut self) {
        self.repeat.news(self.now);
        self.say_report();
    }

    fn say_report(&mut self) {
        let (done, refused) = match &self.phase {
            Phase::Executing(execution) => (execution.done(), execution.refused().cloned()),
            Phase::Idle | Phase::Planning { .. } | Phase::Left => (StepIndex(0), None),
        };
        let report = Report {
            epoch: self.epoch,
            pid: self.config.pid,
            plans: self.plans.clone(),
            done,
            refused,
            broken: self.config.domain.as_ref().err().cloned(),
            share: self.config.share.clone().filter(|_| self.epoch == Epoch(0)),
        };
        self.outputs.push_back(Output::Publish(Topic::Report(self.config.id), Message::Report(report)));
    }

    fn repeat(&mut self) {
        if !self.repeat.take(self.now) {
            return;
        }
        self.say_report();
        if let Phase::Executing(execution) = &self.phase
            && let Some(request) = execution.pending()
        {
            let topic = Topic::Request(self.config.id);
            self.outputs.push_back(Output::Publish(topic, Message::Request(request)));
        }
    }
}

impl Machine for Robot {
    type Job = RobotJob;
    type Done = RobotDone;

    fn handle(&mut self, now: Tick, input: Input<'_, RobotDone>) {
        if matches!(self.phase, Phase::Left) {
            return;
        }
        self.now = now;
        match input {
            Input::Message(_, envelope) => match envelope.message {
                Message::Directive(directive) => self.directive(envelope.revision, directive),
                Message::Ack(ack) => {
                    if self.answered.is_some_and(|seen| envelope.revision < seen) {
                        return;
                    }
                    self.answered = Some(envelope.revision);
                    if let Phase::Executing(execution) = &mut self.phase
                        && execution.answer(&ack)
                        && (execution.refused().is_some() || execution.finished())
                    {
                        self.report();
                    }
                }
                Message::Command(command) if command.stop => {
                    self.leave();
                }
                // Who is lost is the coordinator's affair.
                Message::Command(_) => {}
                Message::Outcome(_)
                | Message::Grant(_)
                | Message::Report(_)
                | Message::Request(_)
                | Message::Vocabulary(_) => {
                    self.outputs.push_back(Output::Log("a message that is not for a robot".into()));
                }
            },
            Input::Frame(frame) => self.frame(&frame),
            Input::Done(job, done) => self.planned(job, done),
            // Who is gone is the coordinator's affair.
            Input::PeerHint(_) => {}
            Input::Timeout => self.repeat(),
        }
    }

    fn poll_output(&mut self) -> Option<Output<RobotJob>> {
        self.outputs.pop_front()
    }

    fn poll_timeout(&self) -> Option<Tick> {
        (!matches!(self.phase, Phase::Left)).then_some(self.repeat.due())
    }

    fn awaits(&self) -> Awaits {
        match &self.phase {
            Phase::Executing(execution) => execution.awaits(),
            // Directives come first.
            Phase::Idle | Phase::Planning { .. } | Phase::Left => Awaits::NoFrame,
        }
    }
}
