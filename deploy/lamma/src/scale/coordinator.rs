//! The coordinator of a rally. Nothing is to be understood or allocated, so what remains of a coordinator's
//! work is what grows with the team: joining, opening the epoch, handing out problems, collecting plans,
//! gates, and following. Robots and arbiter are the ones of every run.

use std::collections::VecDeque;

use lamma_protocol::message::{
    Act, Command, Directive, Event, EventKind, Gate, Grant, Message, Order, Outcome, Package, PlanResult,
    Report, Step,
};
use lamma_protocol::{
    AgentId, Epoch, Frame, Input, Machine, Output, PackageId, SaidToEach, StepIndex, Tick, Topic,
};
use serde::{Deserialize, Serialize};

use super::task::Rally;

/// The only epoch of a rally.
const EPOCH: Epoch = Epoch(1);

/// How often it looks whether something is to be said again, in milliseconds.
const REPEAT_MS: u64 = 100;

/// What came of a rally, as the coordinator saw it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcomes {
    /// Why it failed, if it did.
    pub failure: Option<String>,
    /// From the first directive to the last plan, in microseconds.
    pub plan_us: u64,
    /// From the last plan to the last step, in microseconds.
    pub act_us: u64,
    /// Steps of all robots.
    pub actions: u64,
    /// Steps of the lead before it enters the corridor.
    pub lead_before: u32,
}

enum Phase {
    /// Until all have reported and the first frame has come.
    Joining { left: usize },
    /// Until a frame shows the epoch.
    Granting,
    /// Until all have planned.
    Planning { since: Tick, left: usize },
    /// Until all steps are done.
    Acting { since: Tick, plan_us: u64 },
    /// The outcome is out.
    Over(Outcomes),
}

/// See the module.
pub struct RallyCoordinator {
    rally: Rally,
    phase: Phase,
    joined: Vec<bool>,
    plans: Vec<Option<Vec<Act>>>,
    directives: SaidToEach<Directive>,
    world_seen: bool,
    now: Tick,
    limit: Tick,
    repeat_at: Tick,
    outputs: VecDeque<Output<()>>,
}

impl RallyCoordinator {
    /// A coordinator that waits for the team and gives up after `limit_ms`.
    pub fn new(rally: Rally, limit_ms: u64) -> Self {
        let agents = usize::from(rally.agents);
        RallyCoordinator {
            rally,
            phase: Phase::Joining { left: agents },
            joined: vec![false; agents],
            plans: vec![None; agents],
            directives: SaidToEach::nothing(agents),
            world_seen: false,
            now: Tick(0),
            limit: Tick(0).after_ms(limit_ms),
            repeat_at: Tick(0),
            outputs: VecDeque::new(),
        }
    }

    fn agents(&self) -> impl Iterator<Item = AgentId> + use<> {
        (0..self.rally.agents).map(AgentId)
    }

    fn report(&mut self, agent: AgentId, report: Report) {
        let Some(joined) = self.joined.get_mut(agent.index()) else { return };
        let new = !std::mem::replace(joined, true);
        if let Some(why) = report.broken {
            return self.over(Err(format!("{} cannot work: {why}", Rally::name(agent))));
        }
        if let Some(refusal) = report.refused {
            return self.over(Err(format!(
                "{}: {} was refused: {}",
                Rally::name(agent),
                refusal.act,
                refusal.reason
            )));
        }
        match &mut self.phase {
            Phase::Joining { left } => {
                *left -= usize::from(new);
                self.try_grant();
            }
            Phase::Planning { .. } if report.epoch == EPOCH => self.planned(agent, report),
            Phase::Planning { .. } | Phase::Granting | Phase::Acting { .. } | Phase::Over(_) => {}
        }
    }

    fn try_grant(&mut self) {
        if matches!(self.phase, Phase::Joining { left: 0 }) && self.world_seen {
            self.phase = Phase::Granting;
            self.say_grant();
            self.say_outcome();
        }
    }

    fn begin_planning(&mut self) {
        self.phase = Phase::Planning { since: self.now, left: usize::from(self.rally.agents) };
        for agent in self.agents() {
            let package = Package { id: PackageId(0), problem: self.rally.problem(agent) };
            self.direct(agent, Order::Plan(vec![package]));
        }
        self.say_outcome();
    }

    fn planned(&mut self, agent: AgentId, mut report: Report) {
        let Some(answer) = report.plans.pop() else { return };
        if self.plans[agent.index()].is_some() {
            return;
        }
        match answer.result {
            PlanResult::Found(plan) if self.rally.ends_in_the_corridor(&plan) => {
                self.plans[agent.index()] = Some(plan);
            }
            PlanResult::Found(_) => {
                return self.over(Err(format!("the plan of {} goes elsewhere", Rally::name(agent))));
            }
            PlanResult::Infeasible(why) | PlanResult::GaveUp(why) | PlanResult::Malformed(why) => {
                return self.over(Err(format!("{} has no plan: {why}", Rally::name(agent))));
            }
        }
        if let Phase::Planning { left, .. } = &mut self.phase {
            *left -= 1;
            if *left == 0 {
                self.begin_acting();
            }
        }
    }

    /// How many steps a robot has before it enters the corridor.
    fn before(&self, agent: AgentId) -> u32 {
        let steps = self.plans[agent.index()].as_ref().map_or(0, Vec::len) as u32;
        steps.saturating_sub(self.rally.rounds)
    }

    fn begin_acting(&mut self) {
        let Phase::Planning { since, .. } = self.phase else { return };
        let plan_us = self.now.since_us(since);
        for agent in self.agents() {
            let before = self.before(agent);
            let acts = self.plans[agent.index()].iter().flatten().cloned();
            let step = |(at, act)| Step { act, gates: self.gates(agent, before, at) };
            let steps = (0u32..).zip(acts).map(step).collect();
            self.direct(agent, Order::Execute(steps));
        }
        self.phase = Phase::Acting { since: self.now, plan_us };
        self.say_outcome();
    }

    /// What the step waits for. The lead enters a place of the corridor when all have come to the one before;
    /// the others, when the lead is there.
    fn gates(&self, agent: AgentId, before: u32, at: u32) -> Vec<Gate> {
        let Some(round) = at.checked_sub(before) else { return Vec::new() };
        if agent == Rally::LEAD {
            let others = self.agents().filter(|a| *a != Rally::LEAD);
            return others.map(|a| Gate { agent: a, done: StepIndex(self.before(a) + round) }).collect();
        }
        vec![Gate { agent: Rally::LEAD, done: StepIndex(self.before(Rally::LEAD) + round + 1) }]
    }

    fn frame(&mut self, frame: &Frame<'_>) {
        match &self.phase {
            Phase::Joining { .. } => {
                self.world_seen = true;
                self.try_grant();
            }
            Phase::Granting if frame.epoch() == EPOCH => self.begin_planning(),
            Phase::Acting { since, plan_us } => {
                let steps = |a: AgentId| self.plans[a.index()].as_ref().map_or(0, Vec::len);
                let actions: usize = self.agents().map(steps).sum();
                if frame.epoch() == EPOCH && frame.applied() >= actions as u64 {
                    let outcomes = Outcomes {
                        failure: None,
                        plan_us: *plan_us,
                        act_us: self.now.since_us(*since),
                        actions: frame.applied(),
                        lead_before: self.before(Rally::LEAD),
                    };
                    self.over(Ok(outcomes));
                }
            }
            Phase::Granting | Phase::Planning { .. } | Phase::Over(_) => {}
        }
    }

    fn over(&mut self, result: Result<Outcomes, String>) {
        if !matches!(self.phase, Phase::Over(_)) {
            let failed = |why| Outcomes { failure: Some(why), ..Outcomes::default() };
            self.phase = Phase::Over(result.unwrap_or_else(failed));
            self.say_outcome();
        }
    }

    fn command(&mut self, command: Command) {
        if command.stop {
            self.outputs.push_back(Output::Finish);
        } else if let Some(agent) = command.lost.first() {
            self.over(Err(format!("{} has died", Rally::name(*agent))));
        }
    }

    fn direct(&mut self, agent: AgentId, order: Order) {
        let directive = Directive { epoch: EPOCH, order };
        self.directives.news(agent, directive.clone(), self.now);
        self.outputs.push_back(Output::Publish(Topic::Directive(agent), Message::Directive(directive)));
    }

    fn say_grant(&mut self) {
        let grant = Grant { epoch: EPOCH, lost: Vec::new() };
        self.outputs.push_back(Output::Publish(Topic::Grant, Message::Grant(grant)));
    }

    fn say_outcome(&mut self) {
        let (phase, result) = match &self.phase {
            Phase::Joining { .. } => ("joining", None),
            Phase::Granting => ("granting", None),
            Phase::Planning { .. } => ("planning", None),
            Phase::Acting { .. } => ("acting", None),
            Phase::Over(outcomes) => ("over", serde_json::to_string(outcomes).ok()),
        };
        let event = Event { tick_us: self.now.0, kind: EventKind::Phase, text: phase.into() };
        let outcome = Outcome { phase: phase.into(), first_event: 0, events: vec![event], result };
        self.outputs.push_back(Output::Publish(Topic::Outcome, Message::Outcome(outcome)));
    }

    fn timeout(&mut self) {
        if self.now >= self.limit {
            let missing = self.joined.iter().filter(|j| !**j).count();
            let planned = self.plans.iter().flatten().count();
            let all = self.rally.agents;
            let why = format!("out of time: {missing} of {all} have not joined, {planned} have a plan");
            self.over(Err(why));
        }
        if self.now < self.repeat_at {
            return;
        }
        self.repeat_at = self.now.after_ms(REPEAT_MS);
        if matches!(self.phase, Phase::Granting) {
            self.say_grant();
        }
        let due = self.directives.due(self.now);
        self.outputs
            .extend(due.map(|(agent, d)| Output::Publish(Topic::Directive(agent), Message::Directive(d))));
        self.say_outcome();
    }
}

impl Machine for RallyCoordinator {
    type Job = ();
    type Done = ();

    fn handle(&mut self, now: Tick, input: Input<'_, ()>) {
        self.now = now;
        match input {
            Input::Message(topic, envelope) => match (topic, envelope.message) {
                (Topic::Command, Message::Command(command)) => self.command(command),
                (Topic::Report(agent), Message::Report(report)) => self.report(agent, report),
                // The vocabulary: what holds is the arbiter's affair in a rally.
                _ => {}
            },
            Input::Frame(frame) => self.frame(&frame),
            Input::Timeout => self.timeout(),
            Input::Done(..) | Input::PeerHint(_) => {}
        }
    }

    fn poll_output(&mut self) -> Option<Output<()>> {
        self.outputs.pop_front()
    }

    fn poll_timeout(&self) -> Option<Tick> {
        match self.phase {
            Phase::Over(_) => Some(self.repeat_at),
            _ => Some(self.repeat_at.min(self.limit)),
        }
    }
}
