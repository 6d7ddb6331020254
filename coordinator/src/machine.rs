//! The coordinator's state machine.
//!
//! Every input first changes what is known (roster, world view); then [`Coordinator::advance`] looks at
//! what is known and takes every transition that has become possible. Nothing depends on having seen a
//! message at the right moment, which is what makes lost and repeated messages harmless.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use lamma_planner::MakespanLimits;
use lamma_planner::interpreter::Interpreter;
use lamma_protocol::message::{Directive, Event, Message};
use lamma_protocol::{AgentId, Epoch, Input, Machine, Output, Revision, SaidToEach, Tick, Topic};

use crate::allocation::{Allocation, AllocationRule, Cut};
use crate::combine::TeamPlan;
use crate::deadline::Patience;
use crate::job::{CoordinatorDone, CoordinatorJob};
use crate::method::Method;
use crate::mission::Mission;
use crate::phase::Phase;
use crate::result::{ActionResult, FaultResult};
use crate::roster::Roster;
use crate::stopwatch::Stopwatch;
use crate::team::Team;
use crate::understand::{ScoreGoal, Understanding};
use crate::world_view::WorldView;
use crate::written::Written;

/// What a coordinator is born with.
#[derive(Clone, Debug)]
pub struct CoordinatorConfig {
    /// The team.
    pub team: Arc<Team>,
    /// What is wanted, and the way to a plan for it.
    pub mission: Mission,
    /// What the outcome is judged by, when it is not what was understood (a benchmark's own goal).
    pub score: Option<ScoreGoal>,
    /// The best makespan known for the task and the robot-steps it needs, for Eff and RU. Without it the
    /// first plan is the reference.
    pub reference: Option<(f64, f64)>,
    /// The way from the instruction to a plan.
    pub method: Method,
    /// Who decides which robot gets a sub-task.
    pub rule: AllocationRule,
    /// Stop when the plan is combined.
    pub solve_only: bool,
    /// Bound of each of the coordinator's searches, in expanded states.
    pub expansions: u64,
    /// What may be spent on a shorter plan and on the proof of how short it can be.
    pub makespan: MakespanLimits,
    /// When to give up.
    pub time_limit_ms: u64,
    /// How long the simulator takes for a time step, in milliseconds: nobody is late before that.
    pub step_ms: u64,
    /// How long the others are waited for.
    pub patience: Patience,
}

/// The coordinator.
pub struct Coordinator {
    pub(crate) config: CoordinatorConfig,
    pub(crate) interpreter: Interpreter,
    pub(crate) roster: Roster,
    pub(crate) view: WorldView,
    pub(crate) phase: Phase,
    pub(crate) understanding: Option<Understanding>,
    pub(crate) allocation: Option<Allocation>,
    pub(crate) lower_bound: Option<f64>,
    pub(crate) first_plan: Option<(f64, f64)>,
    pub(crate) history: Vec<ActionResult>,
    pub(crate) faults: Vec<FaultResult>,
    pub(crate) recoveries: Vec<FaultResult>,
    pub(crate) stopwatch: Stopwatch,
    /// Where the plan leads, when it is not carried out.
    pub(crate) planned_state: Option<BTreeSet<lamma_pddl::ast::GroundAtom>>,
    pub(crate) epoch: Epoch,
    pub(crate) granted_lost: Vec<AgentId>,
    /// The team's plan of the epoch that is being closed.
    pub(crate) closing: Option<TeamPlan>,
    pub(crate) reached_on_the_way: BTreeSet<usize>,
    pub(crate) excluded: BTreeSet<(usize, usize)>,
    pub(crate) cut: Cut,
    /// What a model has written and is still to be done.
    pub(crate) written: Option<Written>,
    pub(crate) replans: u32,
    pub(crate) next_job: u64,
    pub(crate) now: Tick,
    pub(crate) commanded: Option<Revision>,
    pub(crate) events: VecDeque<Event>,
    pub(crate) events_dropped: u64,
    pub(crate) result: Option<String>,
    pub(crate) directives: SaidToEach<Directive>,
    pub(crate) repeat_at: Tick,
    pub(crate) outputs: VecDeque<Output<CoordinatorJob>>,
    pub(crate) untold: bool,
}

impl CoordinatorConfig {
    /// What is known to be wanted from the start.
    fn understanding(&self) -> Option<Understanding> {
        let given = self.mission.understanding();
        if self.method.divide { given } else { given.map(Understanding::undivided) }
    }
}

impl Coordinator {
    /// A coordinator that waits for its team. Errors if the team's domain does not make sense.
    pub fn new(config: CoordinatorConfig) -> Result<Self, String> {
        let interpreter = config.team.interpreter().map_err(|e| e.to_string())?;
        let members = config.team.members.len();
        Ok(Coordinator {
            interpreter,
            roster: Roster::new(members),
            view: WorldView::default(),
            phase: Phase::Joining,
            understanding: config.understanding(),
            allocation: None,
            lower_bound: None,
            first_plan: None,
            history: Vec::new(),
            faults: Vec::new(),
            recoveries: Vec::new(),
            stopwatch: Stopwatch::default(),
            planned_state: None,
            epoch: Epoch(0),
            granted_lost: Vec::new(),
            closing: None,
            reached_on_the_way: BTreeSet::new(),
            excluded: BTreeSet::new(),
            cut: if config.method.divide { Cut::Parts } else { Cut::Whole },
            written: None,
            replans: 0,
            next_job: 0,
            now: Tick(0),
            commanded: None,
            events: VecDeque::new(),
            events_dropped: 0,
            result: None,
            directives: SaidToEach::nothing(members),
            repeat_at: Tick(0),
            outputs: VecDeque::new(),
            untold: true,
            config,
        })
    }

    /// The result as JSON, once the run is over.
    pub fn result(&self) -> Option<&str> {
        self.result.as_deref()
    }

    /// The phase, for people and tests.
    pub fn phase(&self) -> &'static str {
        self.phase.label()
    }

    pub(crate) fn name_of(&self, agent: AgentId) -> String {
        self.config
            .team
            .members
            .get(agent.index())
            .map_or_else(|| agent.0.to_string(), |m| m.name.to_string())
    }

    /// Takes the phase out to work on it; [`Coordinator::put_phase`] must follow.
    pub(crate) fn take_phase(&mut self) -> Phase {
        std::mem::replace(&mut self.phase, Phase::Finished)
    }

    pub(crate) fn put_phase(&mut self, phase: Phase) {
        self.phase = phase;
    }
}

impl Machine for Coordinator {
    type Job = CoordinatorJob;
    type Done = CoordinatorDone;

    fn handle(&mut self, now: Tick, input: Input<'_, CoordinatorDone>) {
        self.now = now;
        match input {
            Input::Message(topic, envelope) => match (topic, envelope.message) {
                (Topic::Command, Message::Command(command)) => self.command(envelope.revision, command),
                (Topic::Report(agent), Message::Report(report)) => {
                    self.report(agent, envelope.revision, report);
                }
                (Topic::Vocabulary, Message::Vocabulary(vocabulary)) => self.view.learn(&vocabulary.facts),
                (topic, _) => self.outputs.push_back(Output::Log(format!("nothing to do with {topic}"))),
            },
            Input::Frame(frame) => {
                self.view.see(&frame);
            }
            Input::Done(job, done) => self.done(job, done),
            Input::Timeout => self.timeout(),
            // Certainty comes from the supervisor and from progress.
            Input::PeerHint(_) => {}
        }
        self.advance();
        if self.untold {
            self.say_outcome();
        }
    }

    fn poll_output(&mut self) -> Option<Output<CoordinatorJob>> {
        self.outputs.pop_front()
    }

    fn poll_timeout(&self) -> Option<Tick> {
        let limit =
            (!matches!(self.phase, Phase::Finished)).then(|| Tick(0).after_ms(self.config.time_limit_ms));
        [Some(self.repeat_at), self.phase_deadline(), limit].into_iter().flatten().min()
    }
}
