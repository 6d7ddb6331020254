//! The transitions from phase to phase.

use std::collections::BTreeSet;

use lamma_pddl::ast::GroundAtom;
use lamma_pddl::multi_agent::own_name;
use lamma_protocol::message::{Command, EventKind, Order, Report};
use lamma_protocol::{AgentId, Epoch, JobId, Output, Revision, StepIndex};

use crate::allocation::{AllocateInput, Allocation, NoAllocation};
use crate::bans::{Ban, as_planned};
use crate::combine::{TeamPlan, world_state};
use crate::job::{CoordinatorDone, CoordinatorJob};
use crate::machine::Coordinator;
use crate::merge::Merger;
use crate::method::Steps;
use crate::phase::{Following, Phase, Round};
use crate::result::{ActionResult, OutcomeKind};
use crate::shorten::Combined;
use crate::understand::Understood;

/// Plans that may follow the first.
const MAX_REPLANS: u32 = 24;

impl Coordinator {
    pub(crate) fn enter(&mut self, phase: Phase) {
        self.cancel_job();
        self.stopwatch.enter(self.now, &phase);
        self.phase = phase;
        if !matches!(self.phase, Phase::Granting) {
            self.event(EventKind::Phase, self.phase.label());
        }
    }

    pub(crate) fn cancel_job(&mut self) {
        if let Phase::Decomposing(job)
        | Phase::Allocating(job)
        | Phase::Combining(job, _)
        | Phase::PlanningJointly(job)
        | Phase::Writing(job, _) = &self.phase
        {
            self.outputs.push_back(Output::Cancel(*job));
        }
    }

    /// Opens a new epoch: the team is planned for anew, from the world as the arbiter then shows it.
    pub(crate) fn begin_epoch(&mut self) {
        if let Phase::Executing(following) = &self.phase {
            self.closing = Some(following.plan.clone());
        }
        self.epoch = Epoch(self.epoch.0.max(self.view.epoch().0)).next();
        self.granted_lost = self.roster.lost();
        self.enter(Phase::Granting);
        self.say_grant();
    }

    pub(crate) fn replan(&mut self, why: &str) {
        self.replans += 1;
        if self.replans > MAX_REPLANS {
            return self
                .finish(OutcomeKind::GaveUp, Some(format!("{MAX_REPLANS} plans have failed; last: {why}")));
        }
        self.recovery(format!("planning anew: {why}"));
        self.begin_epoch();
    }

    /// The cut has not led to a plan: the next coarser one may. Only what the coarsest finds is the outcome.
    pub(crate) fn coarsen(&mut self, kind: OutcomeKind, why: String) {
        match self.cut.coarser() {
            Some(coarser) => {
                self.cut = coarser;
                self.excluded.clear();
                self.event(EventKind::Note, format!("planning more coarsely: {why}"));
                self.begin_epoch();
            }
            None => self.finish(kind, Some(why)),
        }
    }

    pub(crate) fn finish(&mut self, kind: OutcomeKind, reason: Option<String>) {
        self.finish_with(kind, reason, None);
    }

    pub(crate) fn finish_with(
        &mut self,
        kind: OutcomeKind,
        reason: Option<String>,
        ask: Option<serde_json::Value>,
    ) {
        if let Phase::Executing(following) = &self.phase {
            let (plan, allocation) = (following.plan.clone(), following.allocation.clone());
            let done: Vec<StepIndex> = self.progress();
            self.record(&plan, &done);
            self.allocation = Some(allocation);
        }
        self.enter(Phase::Finished);
        let result = self.build_result(kind, reason, ask);
        self.result = serde_json::to_string(&result).ok();
        for agent in (0..self.directives.agents() as u16).map(AgentId) {
            self.direct(agent, Order::Leave);
        }
        self.untold = true;
    }

    pub(crate) fn progress(&self) -> Vec<StepIndex> {
        (0..self.directives.agents() as u16).map(|a| self.view.progress(AgentId(a))).collect()
    }

    /// Steps that were applied go into the history, later than everything there.
    pub(crate) fn record(&mut self, plan: &TeamPlan, done: &[StepIndex]) {
        self.note_reached_on_the_way(plan, done);
        let base = self.history.iter().map(ActionResult::end).fold(0.0, f64::max);
        for step in plan.timeline.iter().filter(|s| s.index < done[s.member]) {
            let robot = self.config.team.members[step.member].name.to_string();
            self.history.push(ActionResult {
                start: base + step.start,
                duration: step.duration,
                action: own_name(&step.act.action, &robot).to_string(),
                args: step.act.args.iter().skip(1).map(|a| own_name(a, &robot).to_string()).collect(),
                robot,
            });
        }
    }

    /// Sub-goals that need not last and whose packages are done are not planned for again.
    pub(crate) fn note_reached_on_the_way(&mut self, plan: &TeamPlan, done: &[StepIndex]) {
        let Some(understanding) = &self.understanding else { return };
        for (s, subgoal) in understanding.subgoals.iter().enumerate() {
            let mut ends = plan.ends.iter().filter(|e| e.subgoals.contains(&s)).peekable();
            if !subgoal.lasting && ends.peek().is_some() && ends.all(|e| done[e.member] >= e.done) {
                self.reached_on_the_way.insert(s);
            }
        }
    }

    /// Takes every transition that what is known allows.
    pub(crate) fn advance(&mut self) {
        loop {
            let before = std::mem::discriminant(&self.phase);
            let epoch = self.epoch;
            match &self.phase {
                Phase::Joining => self.try_leave_joining(),
                Phase::Granting => self.try_leave_granting(),
                Phase::Planning(_) => self.try_plan(),
                Phase::Executing(_) => self.follow(),
                Phase::Decomposing(_)
                | Phase::Allocating(_)
                | Phase::Combining(..)
                | Phase::PlanningJointly(_)
                | Phase::Writing(..)
                | Phase::Finished => return,
            }
            if before == std::mem::discriminant(&self.phase) && epoch == self.epoch {
                return;
            }
        }
    }

    pub(crate) fn try_leave_joining(&mut self) {
        for agent in self.roster.alive().collect::<Vec<_>>() {
            if let Some(why) = self.roster.report(agent).and_then(|r| r.broken.clone()) {
                self.lose(agent, format!("cannot work: {why}"));
            }
        }
        if self.nobody_left() {
            return;
        }
        if self.roster.all_joined() && self.view.state().is_some() {
            if let Err(why) = self.meet_team() {
                return self.finish(OutcomeKind::Error, Some(why));
            }
            self.event(EventKind::Note, crowd(self.roster.available().len()));
            self.begin_epoch();
        }
    }

    pub(crate) fn nobody_left(&mut self) -> bool {
        let nobody = self.roster.available().is_empty();
        if nobody {
            let why = (0..self.directives.agents() as u16)
                .map(AgentId)
                .find_map(|a| self.roster.lost_reason(a).map(|r| format!("{} {r}", self.name_of(a))))
                .unwrap_or_default();
            self.finish(OutcomeKind::Infeasible, Some(format!("no robot is left ({why})")));
        }
        nobody
    }

    pub(crate) fn try_leave_granting(&mut self) {
        if self.view.epoch() != self.epoch || self.view.state().is_none() {
            return;
        }
        if let Some(plan) = self.closing.take() {
            let done: Vec<StepIndex> = (0..self.directives.agents() as u16)
                .map(|a| self.view.frame().map_or(StepIndex(0), |f| f.closed(AgentId(a))))
                .collect();
            self.record(&plan, &done);
            if let Some(written) = &mut self.written {
                written.advance(&done);
            }
        }
        if self.roster.lost() != self.granted_lost {
            return self.begin_epoch();
        }
        if self.written.is_some() {
            return self.carry_on_written();
        }
        if self.config.method.steps == Steps::Written {
            return self.write_plan(Vec::new(), None);
        }
        if self.understanding.is_some() {
            return self.plan_for_team();
        }
        let facts = self.view.state().unwrap_or_default();
        let job = self.spawn(CoordinatorJob::Understand { facts });
        self.enter(Phase::Decomposing(job));
    }

    pub(crate) fn allocate(&mut self) {
        let (Some(understanding), Some(facts)) = (&self.understanding, self.planned_from()) else { return };
        let mut subgoals = understanding.subgoals.clone();
        for &s in &self.reached_on_the_way {
            // Reached and left behind before this plan: nothing to do, and nothing waits for it.
            subgoals[s].goal = lamma_pddl::ast::Condition::TRUE;
            subgoals[s].after.clear();
        }
        let input = AllocateInput {
            cut: self.cut,
            rule: self.config.rule,
            team: self.config.team.clone(),
            available: self.roster.available(),
            facts,
            subgoals,
            excluded: self.excluded.clone(),
            final_goal: understanding.final_goal(),
            expansions: self.config.expansions,
        };
        let job = self.spawn(CoordinatorJob::Allocate(Box::new(input)));
        self.enter(Phase::Allocating(job));
    }

    /// The world as plans are made from it: without what the person has forbidden.
    fn planned_from(&self) -> Option<BTreeSet<GroundAtom>> {
        Some(as_planned(self.view.state()?, self.bans()))
    }

    fn bans(&self) -> &[Ban] {
        self.understanding.as_ref().map_or(&[], |understanding| &understanding.bans)
    }

    pub(crate) fn understood(&mut self, understood: Understood) {
        match understood {
            Understood::Yes(understanding) => {
                for subgoal in &understanding.subgoals {
                    let after: Vec<&str> =
                        subgoal.after.iter().map(|&s| understanding.subgoals[s].id.as_str()).collect();
                    let after = if after.is_empty() {
                        String::new()
                    } else {
                        format!(" (after {})", after.join(", "))
                    };
                    self.event(EventKind::Note, format!("{}: {}{after}", subgoal.id, subgoal.text));
                }
                for assumption in &understanding.assumptions {
                    self.event(EventKind::Note, format!("assuming {assumption}"));
                }
                let divide = self.config.method.divide;
                self.understanding = Some(if divide { understanding } else { understanding.undivided() });
                if self.roster.lost() == self.granted_lost {
                    self.plan_for_team()
                } else {
                    self.begin_epoch()
                }
            }
            Understood::Ask(clarification) => {
                let question = clarification.question.clone();
                let ask = serde_json::to_value(&clarification).ok();
                self.finish_with(OutcomeKind::NeedsClarification, Some(question), ask);
            }
            Understood::NoAnswer(why) => self.finish(OutcomeKind::GaveUp, Some(why)),
            Understood::Failed(why) => self.finish(OutcomeKind::Error, Some(why)),
        }
    }

    pub(crate) fn allocated(&mut self, allocation: Result<Allocation, NoAllocation>) {
        let allocation = match allocation {
            Ok(allocation) => allocation,
            Err(NoAllocation::Infeasible(why)) => return self.infeasible(&why),
            Err(NoAllocation::NotThisWay(why)) => return self.coarsen(OutcomeKind::GaveUp, why),
            Err(NoAllocation::GaveUp(why)) => return self.coarsen(OutcomeKind::GaveUp, why),
        };
        let Some(facts) = self.planned_from() else { return };
        self.lower_bound.get_or_insert(allocation.lower_bound);
        let subgoals = self.understanding.as_ref().map_or(0, |u| u.subgoals.len());
        for s in 0..subgoals {
            let names: Vec<String> =
                allocation.members_of(s).into_iter().map(|m| self.name_of(AgentId(m as u16))).collect();
            if let (Some(u), false) = (&self.understanding, names.is_empty()) {
                let text = format!("{} goes to {}", u.subgoals[s].id, names.join(" and "));
                self.event(EventKind::Note, text);
            }
        }
        if self.is_written() {
            return self.write_as_allocated(allocation);
        }
        let merger = Merger::new(world_state(&facts));
        let round = Round::new(allocation, merger, self.directives.agents());
        self.enter(Phase::Planning(Box::new(round)));
    }

    /// Proved out of reach; who is gone may be why.
    pub(crate) fn infeasible(&mut self, why: &str) {
        let lost: Vec<String> = self
            .roster
            .lost()
            .into_iter()
            .filter_map(|a| self.roster.lost_reason(a).map(|r| format!("{} {r}", self.name_of(a))))
            .collect();
        let lost = if lost.is_empty() { String::new() } else { format!(" ({})", lost.join("; ")) };
        let forbidden: BTreeSet<String> = self.bans().iter().map(ToString::to_string).collect();
        let forbidden = if forbidden.is_empty() {
            String::new()
        } else {
            format!(" (forbidden: {})", forbidden.into_iter().collect::<Vec<_>>().join(", "))
        };
        self.finish(OutcomeKind::Infeasible, Some(format!("{why}{lost}{forbidden}")));
    }

    pub(crate) fn combined(&mut self, combined: Result<Box<Combined>, String>) {
        let Phase::Combining(_, mut round) = self.take_phase() else { return };
        let Combined { plan, end, packages, bound } = match combined {
            Ok(combined) => *combined,
            Err(why) => {
                return self.finish(OutcomeKind::Error, Some(format!("the combined plan fails: {why}")));
            }
        };
        if let Some(packages) = packages {
            round.allocation.packages = packages;
        }
        self.carry_out(plan, round.allocation, end.facts, bound);
    }

    /// Hands the plan out, or ends with it where that is all that is wanted. `end` holds when it is done; no plan
    /// from here is shorter than `bound`.
    pub(crate) fn carry_out(
        &mut self,
        plan: TeamPlan,
        allocation: Allocation,
        end: BTreeSet<GroundAtom>,
        bound: f64,
    ) {
        if self.first_plan.is_none() {
            // Later plans start where the first has led: what is proved of them is not about the whole.
            self.lower_bound = Some(bound);
            let busy = plan.timeline.iter().map(|step| step.duration).sum();
            self.first_plan = Some((plan.makespan, busy));
        }
        let mut steps = plan.steps.iter().flatten();
        if let Some(step) = steps.find(|step| self.bans().iter().any(|ban| ban.forbids(&step.act))) {
            let why = format!("the plan would do what is forbidden: {}", step.act);
            return self.finish(OutcomeKind::Error, Some(why));
        }
        self.event(
            EventKind::Note,
            format!(
                "{} steps, makespan {} (no plan is shorter than {bound})",
                plan.timeline.len(),
                plan.makespan
            ),
        );
        self.allocation = Some(allocation.clone());
        if self.config.solve_only {
            let everything: Vec<StepIndex> = plan.steps.iter().map(|s| StepIndex(s.len() as u32)).collect();
            self.record(&plan, &everything);
            self.planned_state = Some(end);
            return self.finish(OutcomeKind::Success, None);
        }
        for agent in self.roster.alive().collect::<Vec<_>>() {
            self.direct(agent, Order::Execute(plan.steps[agent.index()].clone()));
        }
        let following = Following {
            allocation,
            told: vec![StepIndex(0); plan.steps.len()],
            plan,
            last_progress: self.now,
        };
        self.enter(Phase::Executing(Box::new(following)));
    }

    pub(crate) fn lose(&mut self, agent: AgentId, reason: impl Into<String>) -> bool {
        let reason = reason.into();
        let new = self.roster.lose(agent, reason.clone());
        if new {
            self.fault(format!("{} {reason}", self.name_of(agent)));
        }
        new
    }

    pub(crate) fn command(&mut self, revision: Revision, command: Command) {
        if self.commanded.is_some_and(|seen| revision <= seen) {
            return;
        }
        self.commanded = Some(revision);
        if command.stop {
            if !matches!(self.phase, Phase::Finished) {
                self.finish(OutcomeKind::GaveUp, Some("interrupted".into()));
            }
            self.say_outcome();
            self.outputs.push_back(Output::Finish);
            return;
        }
        let mut news = false;
        for agent in command.lost {
            news |= self.lose(agent, "has died");
        }
        if news {
            self.after_loss();
        }
    }

    /// Somebody is gone: what was planned or allocated with it is void.
    pub(crate) fn after_loss(&mut self) {
        if matches!(self.phase, Phase::Finished) || self.nobody_left() {
            return;
        }
        match self.phase {
            Phase::Joining | Phase::Decomposing(_) | Phase::Finished => {}
            Phase::Granting
            | Phase::Allocating(_)
            | Phase::Planning(_)
            | Phase::Combining(..)
            | Phase::PlanningJointly(_)
            | Phase::Writing(..)
            | Phase::Executing(_) => self.replan("the team has changed"),
        }
    }

    pub(crate) fn report(&mut self, agent: AgentId, revision: Revision, report: Report) {
        self.roster.hear(agent, revision, report);
    }

    pub(crate) fn done(&mut self, job: JobId, done: CoordinatorDone) {
        match (&self.phase, done) {
            (Phase::Decomposing(id), CoordinatorDone::Understood(understood)) if *id == job => {
                self.understood(*understood);
            }
            (Phase::Allocating(id), CoordinatorDone::Allocated(allocation)) if *id == job => {
                self.allocated(allocation);
            }
            (Phase::Combining(id, _), CoordinatorDone::Combined(plan)) if *id == job => self.combined(plan),
            (Phase::PlanningJointly(id), CoordinatorDone::PlannedJointly(plan)) if *id == job => {
                self.planned_jointly(plan);
            }
            (Phase::Writing(id, _), CoordinatorDone::Written(plan)) if *id == job => {
                self.plan_written(plan.map(|plan| *plan));
            }
            // The answer to a question that is no longer asked.
            (
                _,
                CoordinatorDone::Understood(_)
                | CoordinatorDone::Allocated(_)
                | CoordinatorDone::Combined(_)
                | CoordinatorDone::PlannedJointly(_)
                | CoordinatorDone::Written(_),
            ) => {}
        }
    }
}

fn crowd(robots: usize) -> String {
    match robots {
        1 => "one robot is here".into(),
        n => format!("{n} robots are here"),
    }
}
