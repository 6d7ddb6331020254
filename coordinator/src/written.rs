//! Plans that a language model has written step by step, carried out as they are.
//!
//! Nothing is planned anew here: a step that the simulator refuses is left out and the rest is tried, as in the
//! simulators of the methods that work so. Each such step closes an epoch, when everybody has come as far as can be
//! without it.

use std::collections::BTreeSet;
use std::sync::Arc;

use lamma_lm::{Allotted, Script};
use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_planner::GroundAct;
use lamma_planner::interpreter::{Interpreter, WorldState};
use lamma_protocol::message::{Act, Gate, Refusal, Step};
use lamma_protocol::{AgentId, StepIndex};

use crate::allocation::{Allocation, PackageSpec};
use crate::bound::makespan_lower_bound;
use crate::combine::{TeamPlan, TimedStep, ground_act, world_state};
use crate::job::CoordinatorJob;
use crate::machine::Coordinator;
use crate::method::Steps;
use crate::phase::{Following, Phase};
use crate::result::OutcomeKind;
use crate::team::Team;

/// What the model is asked to write.
#[derive(Clone, Debug)]
pub struct WriteInput {
    /// The team.
    pub team: Arc<Team>,
    /// Members that are alive, by index.
    pub available: Vec<usize>,
    /// What holds now.
    pub facts: BTreeSet<GroundAtom>,
    /// The sub-tasks and who does them, where that is known.
    pub parts: Vec<Allotted>,
    /// What shall hold at the end, if the plan is to be checked before it is carried out.
    pub check: Option<Condition>,
    /// What shall hold at the end, for the bound.
    pub goal: Condition,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotWritten {
    /// The model has answered, and nothing that could be used.
    Unusable(String),
    /// It could not be asked.
    Failed(String),
}

/// A plan and what is known about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenPlan {
    /// As the model wrote it.
    pub script: Script,
    /// No plan of the team is shorter, in steps.
    pub bound: u32,
}

impl WriteInput {
    /// Has `write` write the plan.
    pub fn run(
        &self,
        write: impl FnOnce(&WriteInput, &dyn Fn(&Script) -> Vec<String>) -> Result<Script, NotWritten>,
    ) -> Result<WrittenPlan, NotWritten> {
        let script = write(self, &|script: &Script| self.faults(script))?;
        let bound = makespan_lower_bound(&self.team, &self.available, &self.facts, &self.goal);
        Ok(WrittenPlan { script, bound: bound.unwrap_or(0) })
    }

    /// What is wrong with a plan, in words a model can act on; nothing where it is not to be checked.
    fn faults(&self, script: &Script) -> Vec<String> {
        let Some(goal) = &self.check else { return Vec::new() };
        let Ok(interpreter) = self.team.interpreter() else { return Vec::new() };
        let mut state = world_state(&self.facts);
        let mut faults = Vec::new();
        for (index, step) in in_order(script).enumerate() {
            let args = std::iter::once(&step.robot).chain(&step.args).map(String::as_str);
            let act = GroundAct::new(step.action.as_str(), args);
            let done = interpreter
                .instantiate(&act)
                .map_err(|e| e.to_string())
                .and_then(|a| interpreter.apply(&mut state, &a).map_err(|e| e.to_string()));
            if let Err(why) = done {
                faults.push(format!("step {} in order of time: {why}", index + 1));
            }
        }
        if let Ok(ground) = interpreter.ground_condition(goal) {
            let missing = interpreter.missing(&state, &ground);
            faults.extend(missing.iter().map(|what| format!("does not hold at the end: {what}")));
        }
        faults
    }
}

/// The steps by their time.
fn in_order(script: &Script) -> impl Iterator<Item = &lamma_lm::ScriptStep> {
    let mut steps: Vec<_> = script.steps.iter().collect();
    steps.sort_by_key(|step| step.at);
    steps.into_iter()
}

/// What of a written plan is still to be done.
#[derive(Debug)]
pub(crate) struct Written {
    /// Each member's steps with their time.
    steps: Vec<Vec<(u32, Act)>>,
    allocation: Allocation,
    /// Members whose next step is left out.
    skip: BTreeSet<usize>,
}

impl Written {
    fn new(team: &Team, script: &Script, allocation: Allocation) -> Written {
        let mut steps = vec![Vec::new(); team.members.len()];
        for step in in_order(script) {
            let member = team.members.iter().position(|m| m.name == step.robot.as_str());
            if let Some(member) = member {
                let args = std::iter::once(step.robot.as_str()).chain(step.args.iter().map(String::as_str));
                steps[member].push((step.at, Act::new(&step.action, args)));
            }
        }
        Written { steps, allocation, skip: BTreeSet::new() }
    }

    /// Leaves out what is done, and what was refused.
    pub(crate) fn advance(&mut self, done: &[StepIndex]) {
        for (member, steps) in self.steps.iter_mut().enumerate() {
            let done = done.get(member).map_or(0, |d| d.index()).min(steps.len());
            steps.drain(..done);
            if self.skip.remove(&member) && !steps.is_empty() {
                steps.remove(0);
            }
        }
    }

    /// The rest as a plan of those who are there, and where it leads as far as its steps are possible.
    fn plan(
        &self,
        interpreter: &Interpreter,
        available: &[usize],
        facts: &BTreeSet<GroundAtom>,
    ) -> (TeamPlan, WorldState) {
        let mut order: Vec<(u32, usize, usize)> = available
            .iter()
            .flat_map(|&m| self.steps[m].iter().enumerate().map(move |(index, (at, _))| (*at, m, index)))
            .collect();
        order.sort_unstable();
        let mut state = world_state(facts);
        let mut steps: Vec<Vec<Step>> = vec![Vec::new(); self.steps.len()];
        let mut timeline: Vec<TimedStep> = Vec::with_capacity(order.len());
        let mut free = vec![0.0f64; self.steps.len()];
        // When all steps with a smaller number are done, how many each member then has done, and that number.
        let (mut barrier, mut before, mut number) = (0.0f64, vec![0u32; self.steps.len()], None);
        for (at, member, index) in order {
            if number != Some(at) {
                barrier = free.iter().copied().fold(0.0, f64::max);
                before = steps.iter().map(|s| s.len() as u32).collect();
                number = Some(at);
            }
            let act = &self.steps[member][index].1;
            let duration = happen(interpreter, &mut state, act);
            let start = free[member].max(barrier);
            free[member] = start + duration;
            let others = (0..before.len()).filter(|&o| o != member && before[o] > 0);
            let gates =
                others.map(|o| Gate { agent: AgentId(o as u16), done: StepIndex(before[o]) }).collect();
            steps[member].push(Step { act: act.clone(), gates });
            let index = StepIndex(index as u32);
            timeline.push(TimedStep { start, duration, member, index, act: act.clone() });
        }
        timeline.sort_by(|a, b| a.start.total_cmp(&b.start).then(a.member.cmp(&b.member)));
        let makespan = free.into_iter().fold(0.0, f64::max);
        (TeamPlan { steps, timeline, ends: Vec::new(), makespan }, state)
    }
}

/// Does the act, if it is possible, and says how long it takes.
fn happen(interpreter: &Interpreter, state: &mut WorldState, act: &Act) -> f64 {
    let Ok(action) = interpreter.instantiate(&ground_act(act)) else { return 1.0 };
    let duration = interpreter.duration(state, &action).unwrap_or(1.0);
    // What is not possible is refused later, by the simulator.
    let _ = interpreter.apply(state, &action);
    duration
}

impl Coordinator {
    /// Asks the model for the plan: of these sub-tasks, or of the instruction as it is.
    pub(crate) fn write_plan(&mut self, parts: Vec<Allotted>, allocation: Option<Allocation>) {
        let Some(facts) = self.view.state() else { return };
        let understood = self.understanding.as_ref().map(|u| u.final_goal());
        let scored = self.config.score.as_ref().map(|s| s.joint());
        let input = WriteInput {
            team: self.config.team.clone(),
            available: self.roster.available(),
            facts,
            check: understood.clone().filter(|_| self.config.method.checked),
            goal: scored.or(understood).unwrap_or(Condition::TRUE),
            parts,
        };
        let job = self.spawn(CoordinatorJob::Write(Box::new(input)));
        self.enter(Phase::Writing(job, allocation));
    }

    /// The sub-tasks go to whom the model has named.
    pub(crate) fn write_as_advised(&mut self) {
        let Some(understanding) = &self.understanding else { return };
        let parts: Vec<Allotted> = understanding
            .subgoals
            .iter()
            .map(|s| Allotted { text: s.text.clone(), robots: s.advice.clone() })
            .collect();
        let team = &self.config.team;
        let member = |name: &String| team.members.iter().position(|m| m.name == name.as_str());
        let named = parts.iter().enumerate().flat_map(|(s, part)| {
            part.robots.iter().filter_map(member).map(move |m| PackageSpec {
                member: m,
                goal: Condition::TRUE,
                subgoals: vec![s],
                after: Vec::new(),
                asked_after: Vec::new(),
                fallback: None,
            })
        });
        let allocation = Allocation { packages: named.collect(), lower_bound: 0.0 };
        self.write_plan(parts, Some(allocation));
    }

    /// The sub-tasks go to whom the allocator has chosen.
    pub(crate) fn write_as_allocated(&mut self, allocation: Allocation) {
        let subgoals = self.understanding.as_ref().map_or(&[][..], |u| &u.subgoals);
        let robots = |s| allocation.members_of(s).into_iter().map(|m| self.name_of(AgentId(m as u16)));
        let part = |(s, subgoal): (usize, &crate::understand::Subgoal)| Allotted {
            text: subgoal.text.clone(),
            robots: robots(s).collect(),
        };
        let parts = subgoals.iter().enumerate().map(part).collect();
        self.write_plan(parts, Some(allocation));
    }

    /// Whether the steps are the model's.
    pub(crate) fn is_written(&self) -> bool {
        self.config.method.steps != Steps::Planned
    }

    /// The model has answered.
    pub(crate) fn plan_written(&mut self, plan: Result<WrittenPlan, NotWritten>) {
        let Phase::Writing(_, allocation) = self.take_phase() else { return };
        match plan {
            Ok(WrittenPlan { script, bound }) => {
                let mut allocation =
                    allocation.unwrap_or(Allocation { packages: Vec::new(), lower_bound: 0.0 });
                allocation.lower_bound = f64::from(bound);
                self.written = Some(Written::new(&self.config.team, &script, allocation));
                self.carry_on_written();
            }
            Err(NotWritten::Unusable(why)) => self.finish(OutcomeKind::GaveUp, Some(why)),
            Err(NotWritten::Failed(why)) => self.finish(OutcomeKind::Error, Some(why)),
        }
    }

    /// An epoch is open: on with what is left of the written plan.
    pub(crate) fn carry_on_written(&mut self) {
        let (Some(written), Some(facts)) = (&self.written, self.view.state()) else { return };
        let (plan, end) = written.plan(&self.interpreter, &self.roster.available(), &facts);
        let allocation = written.allocation.clone();
        let bound = allocation.lower_bound;
        if plan.timeline.is_empty() && self.first_plan.is_some() {
            // Everything was tried: the world as it is now is the outcome.
            return self.finish(OutcomeKind::Success, None);
        }
        self.carry_out(plan, allocation, end.facts, bound);
    }

    /// What was refused, once nobody can do more without it.
    pub(crate) fn skipped(&self, following: &Following) -> Vec<(AgentId, Refusal)> {
        let Some(frame) = self.view.frame().filter(|frame| frame.epoch() == self.epoch) else {
            return Vec::new();
        };
        let refused = |agent: AgentId| {
            let report = self.roster.report(agent).filter(|r| r.epoch == self.epoch);
            report.and_then(|r| r.refused.clone())
        };
        let rests = |agent: AgentId| {
            let next = following.plan.steps[agent.index()].get(frame.progress(agent).index());
            refused(agent).is_some() || next.is_none_or(|step| !step.gates.iter().all(|g| frame.open(*g)))
        };
        if !self.roster.alive().all(rests) {
            return Vec::new();
        }
        self.roster.alive().filter_map(|agent| Some((agent, refused(agent)?))).collect()
    }

    /// Leaves these steps out and goes on with the rest.
    pub(crate) fn skip(&mut self, refusals: Vec<(AgentId, Refusal)>) {
        if refusals.is_empty() {
            return;
        }
        for (agent, refusal) in refusals {
            let name = self.name_of(agent);
            self.fault(format!("{name}: {} was refused and is left out: {}", refusal.act, refusal.reason));
            if let Some(written) = &mut self.written {
                written.skip.insert(agent.index());
            }
        }
        self.begin_epoch();
    }
}
