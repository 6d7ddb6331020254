//! The arbiter: the only linearisation point of the world.
//!
//! It interprets the lifted domain directly (the plain semantics), so a grounding bug of a planner shows
//! up here as a refusal, not as a wrong world.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use lamma_pddl::Name;
use lamma_pddl::ast::{Domain, Init, TypedName};
use lamma_planner::interpreter::{Change, Interpreter, WorldState};
use lamma_planner::{GroundAct, Travel};
use lamma_protocol::frame::write_frame;
use lamma_protocol::message::{Ack, Act, Grant, Message, Refusal, RefusalKind, Request, Verdict, Vocabulary};
use lamma_protocol::{
    AgentId, Epoch, FrameHeader, Input, Machine, Output, Repeat, Revision, SaidToEach, StepIndex, Tick, Topic,
};
use thiserror::Error;

use crate::clock::LogicalClock;
use crate::events::{Event, Events, Happening};
use crate::vocabulary::FactTable;

/// How often the arbiter looks whether something is to be said again, in milliseconds.
const REPEAT_MS: u64 = 100;

/// Rest between two vocabularies, in microseconds for each fact in it: several times what it takes to send one.
const VOCABULARY_PAUSE_US: u64 = 5;

/// A member of the team as the arbiter knows it.
#[derive(Clone, Debug)]
pub struct AgentSpec {
    /// The object that stands for it in the world.
    pub name: Name,
    /// The actions it may ask for: its skills.
    pub skills: BTreeSet<Name>,
}

/// The world at the start of a run.
#[derive(Clone, Debug)]
pub struct WorldConfig {
    /// The domain of all skills of all agents.
    pub domain: Domain,
    /// All objects, agents among them.
    pub objects: Vec<TypedName>,
    /// What holds at the start.
    pub init: Vec<Init>,
    /// The team, in roster order.
    pub agents: Vec<AgentSpec>,
    /// An action of one argument that happens to an agent whose process is gone (it lets go of things).
    pub on_lost: Option<Name>,
    /// How long a time step takes, in milliseconds: an action is applied that long after it was asked for.
    /// 0 applies it at once.
    pub step_ms: u64,
    /// What happens without the team.
    pub events: Vec<Event>,
    /// How long going takes, where it takes its time.
    pub travel: Option<Arc<Travel>>,
}

/// A world that cannot be.
#[derive(Debug, Error)]
#[error("the world cannot be set up: {0}")]
pub struct ArbiterError(String);

/// The arbiter.
pub struct Arbiter {
    interpreter: Interpreter,
    state: WorldState,
    facts: FactTable,
    agents: Vec<AgentSpec>,
    on_lost: Option<Name>,
    lost: BTreeSet<AgentId>,
    epoch: Epoch,
    version: u64,
    progress: Vec<StepIndex>,
    closed: Vec<StepIndex>,
    acks: SaidToEach<Ack>,
    heard: Vec<Option<Revision>>,
    granted: Option<Revision>,
    requested: u64,
    applied: u64,
    clock: LogicalClock,
    step_ms: u64,
    /// Requests that are being carried out, and when they are done.
    under_way: BTreeMap<AgentId, (Tick, Request)>,
    /// When the last input came.
    now: Tick,
    repeat_at: Tick,
    events: Events,
    frame_repeat: Repeat,
    vocabulary_repeat: Repeat,
    /// When the vocabulary may be said the next time, and whether it has grown since it was said.
    vocabulary_free: Tick,
    vocabulary_owed: bool,
    outputs: VecDeque<Output<()>>,
}

impl Arbiter {
    /// Sets the world up and makes its first frame ready.
    pub fn new(config: WorldConfig) -> Result<Self, ArbiterError> {
        let interpreter =
            Interpreter::new(&config.domain, &config.objects).map_err(|e| ArbiterError(e.to_string()))?;
        let interpreter = interpreter.with_travel(config.travel);
        let state = interpreter.initial(&config.init).map_err(|e| ArbiterError(e.to_string()))?;
        let agents = config.agents.len();
        let mut arbiter = Arbiter {
            interpreter,
            facts: FactTable::of(&state),
            state,
            agents: config.agents,
            on_lost: config.on_lost,
            lost: BTreeSet::new(),
            epoch: Epoch(0),
            version: 0,
            progress: vec![StepIndex(0); agents],
            closed: vec![StepIndex(0); agents],
            acks: SaidToEach::nothing(agents),
            heard: vec![None; agents],
            granted: None,
            requested: 0,
            applied: 0,
            clock: LogicalClock::new(agents),
            step_ms: config.step_ms,
            under_way: BTreeMap::new(),
            now: Tick(0),
            repeat_at: Tick(0),
            events: Events::new(config.events, agents),
            frame_repeat: Repeat::default(),
            vocabulary_repeat: Repeat::default(),
            vocabulary_free: Tick(0),
            vocabulary_owed: false,
            outputs: VecDeque::new(),
        };
        arbiter.say_vocabulary();
        arbiter.changed();
        Ok(arbiter)
    }

    /// The world as it is, for checkers.
    pub fn state(&self) -> &WorldState {
        &self.state
    }

    /// The open epoch.
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Steps of the open epoch applied so far, per agent.
    pub fn progress(&self) -> &[StepIndex] {
        &self.progress
    }

    fn grant(&mut self, revision: Revision, grant: Grant) {
        if self.granted.is_some_and(|seen| revision <= seen) {
            return;
        }
        self.granted = Some(revision);
        let newly_lost: Vec<AgentId> = grant.lost.iter().copied().filter(|a| self.lost.insert(*a)).collect();
        for agent in newly_lost {
            self.let_go(agent);
        }
        if grant.epoch > self.epoch {
            self.epoch = grant.epoch;
            self.closed = std::mem::replace(&mut self.progress, vec![StepIndex(0); self.agents.len()]);
            self.acks.forget();
            self.under_way.clear();
            self.clock.new_epoch();
            self.changed();
        }
    }

    /// Settles the requests whose time has come.
    fn settle_due(&mut self, now: Tick) {
        let due = self.under_way.iter().filter(|(_, (at, _))| *at <= now);
        let due: Vec<AgentId> = due.map(|(agent, _)| *agent).collect();
        for agent in due {
            let Some((_, request)) = self.under_way.remove(&agent) else { continue };
            let still = self.events.still_at();
            if self.events.is_due(agent) && still > now {
                // Others have acted meanwhile: it is held on.
                self.under_way.insert(agent, (still, request));
            } else {
                self.settle(agent, &request);
            }
        }
    }

    fn repeat(&mut self) {
        if self.vocabulary_repeat.take(self.now) {
            self.say_vocabulary();
        }
        if self.frame_repeat.take(self.now) {
            self.say_frame();
        }
        let acks = self.acks.due(self.now);
        self.outputs.extend(acks.map(|(agent, ack)| Output::Publish(Topic::Ack(agent), Message::Ack(ack))));
    }

    /// What a lost robot held is put down, if the domain says how.
    fn let_go(&mut self, agent: AgentId) {
        let (Some(action), Some(spec)) = (&self.on_lost, self.agents.get(agent.index())) else { return };
        let act = GroundAct::new(action.clone(), [spec.name.clone()]);
        self.befall(&act);
    }

    fn request(&mut self, now: Tick, agent: AgentId, revision: Revision, request: Request) {
        let Some(heard) = self.heard.get_mut(agent.index()) else { return };
        if heard.is_some_and(|seen| revision < seen) {
            return;
        }
        *heard = Some(revision);
        let held = self.events.is_due(agent);
        if self.step_ms == 0 && !held {
            return self.settle(agent, &request);
        }
        if self.under_way.get(&agent).is_none_or(|(_, known)| *known != request) {
            let still = if held { self.events.still_at() } else { now };
            self.under_way.insert(agent, (now.after_ms(self.step_ms).max(still), request));
        }
    }

    /// Judges a request and answers it.
    fn settle(&mut self, agent: AgentId, request: &Request) {
        let verdict = match self.judge(agent, request) {
            Judgement::Repeat => self.acks.last(agent).cloned(),
            Judgement::Answer(verdict) => Some(Ack { epoch: request.epoch, step: request.step, verdict }),
        };
        if let Some(ack) = verdict {
            self.acks.news(agent, ack.clone(), self.now);
            self.outputs.push_back(Output::Publish(Topic::Ack(agent), Message::Ack(ack)));
        }
    }

    fn judge(&mut self, agent: AgentId, request: &Request) -> Judgement {
        let refuse = |kind, reason: String| {
            let act = request.act.clone();
            Judgement::Answer(Verdict::Refused(Refusal { step: request.step, act, kind, reason }))
        };
        if request.epoch != self.epoch {
            let reason = format!("epoch {} is over, {} is open", request.epoch.0, self.epoch.0);
            return refuse(RefusalKind::StaleEpoch, reason);
        }
        let next = self.progress[agent.index()];
        if request.step < next || self.is_answered(agent, request) {
            return Judgement::Repeat;
        }
        if request.step > next || !request.gates.iter().all(|g| self.is_open(*g)) {
            let reason = format!("step {} before its time", request.step.0);
            return refuse(RefusalKind::TooEarly, reason);
        }
        self.requested += 1;
        let failed = self.happen(agent);
        self.events.judged(agent);
        let done = match failed {
            true => {
                Err((RefusalKind::Precondition, "the action has failed, by no fault of the plan".to_string()))
            }
            false => self.act(agent, &request.act),
        };
        match done {
            Ok((duration, change)) => {
                self.applied += 1;
                self.progress[agent.index()] = next.next();
                self.clock.applied(agent, &request.gates, duration);
                self.world_changed(&change);
                Judgement::Answer(Verdict::Applied { version: self.version })
            }
            Err((kind, reason)) => {
                // The frame's counters have changed, the world has not.
                self.changed();
                refuse(kind, reason)
            }
        }
    }

    /// Lets happen what happens before the agent's next step; true if that step fails.
    fn happen(&mut self, agent: AgentId) -> bool {
        let mut failed = false;
        for happening in self.events.take(agent) {
            match happening {
                Happening::Fail => failed = true,
                Happening::Act(act) => self.befall(&act),
            }
        }
        failed
    }

    /// An action that is nobody's, if it is possible.
    fn befall(&mut self, act: &GroundAct) {
        let done = self
            .interpreter
            .instantiate(act)
            .map_err(|e| e.to_string())
            .and_then(|a| self.interpreter.apply(&mut self.state, &a).map_err(|e| e.to_string()));
        match done {
            Ok(change) => self.world_changed(&change),
            Err(why) => self.outputs.push_back(Output::Log(format!("{act} did not happen: {why}"))),
        }
    }

    /// Whether this very request got its final answer before.
    fn is_answered(&self, agent: AgentId, request: &Request) -> bool {
        self.acks.last(agent).is_some_and(|ack| {
            let final_answer = match &ack.verdict {
                Verdict::Applied { .. } => true,
                Verdict::Refused(r) => {
                    matches!(r.kind, RefusalKind::Precondition | RefusalKind::NotAllowed)
                }
            };
            final_answer && (ack.epoch, ack.step) == (request.epoch, request.step)
        })
    }

    fn is_open(&self, gate: lamma_protocol::message::Gate) -> bool {
        self.progress.get(gate.agent.index()).is_some_and(|done| *done >= gate.done)
    }

    fn act(&mut self, agent: AgentId, act: &Act) -> Result<(f64, Change), (RefusalKind, String)> {
        let spec = &self.agents[agent.index()];
        let ground = GroundAct::new(act.action.as_str(), act.args.iter().map(String::as_str));
        if self.lost.contains(&agent) {
            return Err((RefusalKind::NotAllowed, format!("{} is counted as lost", spec.name)));
        }
        if !spec.skills.contains(&ground.action) {
            return Err((RefusalKind::NotAllowed, format!("{} has no skill {}", spec.name, act.action)));
        }
        if ground.args.first() != Some(&spec.name) {
            return Err((RefusalKind::NotAllowed, format!("{} cannot act for somebody else", spec.name)));
        }
        let action =
            self.interpreter.instantiate(&ground).map_err(|e| (RefusalKind::Precondition, e.to_string()))?;
        let duration = self
            .interpreter
            .duration(&self.state, &action)
            .map_err(|e| (RefusalKind::Precondition, e.to_string()))?;
        let change = self
            .interpreter
            .apply(&mut self.state, &action)
            .map_err(|e| (RefusalKind::Precondition, e.to_string()))?;
        Ok((duration, change))
    }

    /// The world has changed, and so have its counters.
    fn world_changed(&mut self, change: &Change) {
        if self.facts.change(change) {
            self.vocabulary_owed = true;
            self.tell_new_words();
        }
        self.changed();
    }

    /// The world or its counters have changed: a new version, and a frame that shows it.
    fn changed(&mut self) {
        self.version += 1;
        self.events.changed(self.now);
        self.frame_repeat.news(self.now);
        self.say_frame();
    }

    /// Says a vocabulary that has grown, but not again and again while it grows: the message is the whole list.
    fn tell_new_words(&mut self) {
        if self.vocabulary_owed && self.now >= self.vocabulary_free {
            self.vocabulary_repeat.news(self.now);
            self.say_vocabulary();
        }
    }

    fn say_vocabulary(&mut self) {
        self.vocabulary_owed = false;
        self.vocabulary_free = self.now.after_us(VOCABULARY_PAUSE_US * self.facts.facts().len() as u64);
        let facts = self.facts.facts().to_vec();
        self.outputs.push_back(Output::Publish(Topic::Vocabulary, Message::Vocabulary(Vocabulary { facts })));
    }

    fn say_frame(&mut self) {
        let header = FrameHeader {
            epoch: self.epoch,
            version: self.version,
            requested: self.requested,
            applied: self.applied,
            makespan: self.clock.makespan(),
            progress: self.progress.clone(),
            closed: self.closed.clone(),
            facts: self.facts.facts().len() as u32,
        };
        let words = write_frame(&header, self.facts.words());
        self.outputs.push_back(Output::PublishFrame(words));
    }
}

enum Judgement {
    /// Say the last answer again.
    Repeat,
    /// A new answer.
    Answer(Verdict),
}

impl Machine for Arbiter {
    type Job = ();
    type Done = ();

    fn handle(&mut self, now: Tick, input: Input<'_, ()>) {
        self.now = now;
        match input {
            Input::Message(topic, envelope) => match (topic, envelope.message) {
                (Topic::Grant, Message::Grant(grant)) => self.grant(envelope.revision, grant),
                (Topic::Request(agent), Message::Request(request)) => {
                    self.request(now, agent, envelope.revision, request);
                }
                (Topic::Command, Message::Command(command)) => {
                    if command.stop {
                        self.outputs.push_back(Output::Finish);
                    }
                }
                (topic, _) => self.outputs.push_back(Output::Log(format!("nothing to do with {topic}"))),
            },
            Input::Timeout => {
                self.settle_due(now);
                self.tell_new_words();
                if now >= self.repeat_at {
                    self.repeat_at = now.after_ms(REPEAT_MS);
                    self.repeat();
                }
            }
            // It has no jobs, reads no frame and watches nobody.
            Input::Done(..) | Input::Frame(_) | Input::PeerHint(_) => {}
        }
    }

    fn poll_output(&mut self) -> Option<Output<()>> {
        self.outputs.pop_front()
    }

    fn poll_timeout(&self) -> Option<Tick> {
        let due = self.under_way.values().map(|(at, _)| *at).min();
        let owed = self.vocabulary_owed.then_some(self.vocabulary_free);
        [Some(self.repeat_at), due, owed].into_iter().flatten().min()
    }
}
