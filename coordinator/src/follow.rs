//! Following the robots: collecting their plans, and watching the team's plan being carried out.

use lamma_pddl::ast::Condition;
use lamma_planner::{GroundAct, WorldState};
use lamma_protocol::message::{EventKind, Order, Package, PlanResult};
use lamma_protocol::{AgentId, PackageId, StepIndex};

use crate::allocation::Cut;
use crate::combine::{ground_act, world_state};
use crate::job::{CombineInput, CoordinatorJob};
use crate::machine::Coordinator;
use crate::phase::{Following, Phase, Round};
use crate::problem::member_problem;
use crate::result::OutcomeKind;
use crate::shorten::{Shorten, Wanted};
use crate::understand::Subgoal;

/// Packages that may be planned again because they did not fit after the others.
const MAX_CONFLICTS: u32 = 12;

impl Coordinator {
    /// Asks for the packages that are ready, and merges a batch once all of it is planned.
    pub(crate) fn try_plan(&mut self) {
        let Phase::Planning(mut round) = self.take_phase() else { return };
        loop {
            if round.asked.is_empty() {
                if round.is_complete() {
                    return self.start_combining(round);
                }
                let ready = round.ready();
                if ready.is_empty() {
                    self.put_phase(Phase::Planning(round));
                    return self.planning_failed(Stop::Broken("packages wait for each other".into()));
                }
                round.asked_at = self.now;
                for package in ready {
                    self.ask(&mut round, package);
                }
            }
            let Some(answers) = self.answers(&round) else {
                self.put_phase(Phase::Planning(round));
                return;
            };
            if let Err(stop) = self.merge_batch(&mut round, answers) {
                self.put_phase(Phase::Planning(round));
                return self.planning_failed(stop);
            }
        }
    }

    fn ask(&mut self, round: &mut Round, package: usize) {
        let spec = &round.allocation.packages[package];
        let id = PackageId(round.next_id);
        round.next_id += 1;
        round.asked.insert(package, id);
        let problem = member_problem(&self.config.team, spec.member, &round.merger.state.facts, &spec.goal);
        let list = &mut round.directives[spec.member];
        list.push(Package { id, problem: problem.to_string() });
        let order = Order::Plan(list.clone());
        self.direct(AgentId(spec.member as u16), order);
    }

    /// The answers to the whole batch, in the order of the packages; `None` while some are missing.
    fn answers(&self, round: &Round) -> Option<Vec<(usize, PlanResult)>> {
        let answer = |(&package, id): (&usize, &PackageId)| {
            let member = AgentId(round.allocation.packages[package].member as u16);
            let report = self.roster.report(member).filter(|r| r.epoch == self.epoch)?;
            let plan = report.plans.iter().find(|p| p.id == *id)?;
            Some((package, plan.result.clone()))
        };
        round.asked.iter().map(answer).collect()
    }

    fn merge_batch(&mut self, round: &mut Round, answers: Vec<(usize, PlanResult)>) -> Result<(), Stop> {
        round.asked.clear();
        for (package, result) in answers {
            let spec = round.allocation.packages[package].clone();
            let acts: Vec<GroundAct> = match (result, &spec.fallback) {
                // Each robot has planned its part; the team's own plan is what is known to fit together.
                (_, Some(whole)) if self.cut == Cut::Team => whole.clone(),
                (PlanResult::Found(acts), _) => acts.iter().map(ground_act).collect(),
                (_, Some(fallback)) => fallback.clone(),
                (
                    PlanResult::Infeasible(why) | PlanResult::GaveUp(why) | PlanResult::Malformed(why),
                    None,
                ) => {
                    return Err(Stop::Reallocate { package, why });
                }
            };
            let goal =
                self.interpreter.ground_condition(&spec.goal).map_err(|e| Stop::Broken(e.to_string()))?;
            match round.merger.merge(&self.interpreter, package, spec.member, &acts, &goal) {
                Ok(()) => {
                    round.merged.insert(package);
                }
                Err(conflict) => {
                    round.conflicts += 1;
                    if round.conflicts > MAX_CONFLICTS {
                        return Err(Stop::Broken(format!(
                            "{} cannot follow the others' plans: {}",
                            conflict.act, conflict.reason
                        )));
                    }
                }
            }
        }
        Ok(())
    }

    fn planning_failed(&mut self, stop: Stop) {
        match stop {
            Stop::Broken(why) => self.coarsen(OutcomeKind::GaveUp, why),
            Stop::Reallocate { package, why } => {
                let Phase::Planning(round) = &self.phase else { return };
                let spec = round.allocation.packages[package].clone();
                let name = self.name_of(AgentId(spec.member as u16));
                self.excluded.extend(spec.subgoals.iter().map(|&s| (s, spec.member)));
                self.replan(&format!("{name} found no plan: {why}"));
            }
        }
    }

    fn start_combining(&mut self, round: Box<Round>) {
        let goal = self.final_goal();
        if !self.reaches(&round.merger.state, &goal) {
            self.put_phase(Phase::Planning(round));
            return self.coarsen(OutcomeKind::GaveUp, "the sub-tasks undo each other's goals".into());
        }
        let input = CombineInput {
            team: self.config.team.clone(),
            merger: round.merger.clone(),
            packages: round.allocation.packages.clone(),
            goal,
            shorten: self.shorten(&round),
        };
        let job = self.spawn(CoordinatorJob::Combine(Box::new(input)));
        self.enter(Phase::Combining(job, round));
    }

    /// Steps may be chosen anew where nothing was asked for that is over before the end.
    fn shorten(&self, round: &Round) -> Shorten {
        let subgoals = self.understanding.as_ref().map_or(&[][..], |u| &u.subgoals);
        let lasting = self.config.method.divide && subgoals.iter().all(|s| s.lasting);
        let wanted = |s: &Subgoal| Wanted { goal: s.goal.clone(), after: s.after.clone() };
        Shorten {
            available: self.roster.available(),
            bound: round.allocation.lower_bound,
            wanted: lasting.then(|| subgoals.iter().map(wanted).collect()),
            limits: self.config.makespan.clone(),
        }
    }

    /// Everything that shall hold at the end.
    fn final_goal(&self) -> Condition {
        self.understanding.as_ref().map_or(Condition::TRUE, |u| u.final_goal())
    }

    fn reaches(&self, state: &WorldState, goal: &Condition) -> bool {
        let ground = self.interpreter.ground_condition(goal);
        ground.is_ok_and(|ground| self.interpreter.holds(state, &ground))
    }

    /// Members that have not answered for some package of the batch.
    pub(crate) fn unanswered(&self, round: &Round) -> Vec<AgentId> {
        let answered = |member: AgentId, id: &PackageId| {
            self.roster
                .report(member)
                .is_some_and(|r| r.epoch == self.epoch && r.plans.iter().any(|p| p.id == *id))
        };
        let mut late: Vec<AgentId> = round
            .asked
            .iter()
            .map(|(&package, id)| (AgentId(round.allocation.packages[package].member as u16), id))
            .filter(|(member, id)| !answered(*member, id))
            .map(|(member, _)| member)
            .collect();
        late.sort_unstable();
        late.dedup();
        late
    }

    /// Tells what was applied, and notices the end and refusals.
    pub(crate) fn follow(&mut self) {
        let Phase::Executing(mut following) = self.take_phase() else { return };
        let moved = self.tell_steps(&mut following);
        if moved {
            following.last_progress = self.now;
        }
        let done = following.told.iter().zip(&following.plan.steps).all(|(t, s)| t.index() >= s.len());
        let refusal = self
            .roster
            .alive()
            .filter_map(|a| self.roster.report(a).map(|r| (a, r)))
            .filter(|(_, r)| r.epoch == self.epoch)
            .find_map(|(a, r)| r.refused.clone().map(|refusal| (a, refusal)));
        if self.is_written() && !done {
            let skipped = self.skipped(&following);
            self.put_phase(Phase::Executing(following));
            return self.skip(skipped);
        }
        self.put_phase(Phase::Executing(following));
        if done {
            return self.executed();
        }
        if let Some((agent, refusal)) = refusal {
            let name = self.name_of(agent);
            self.fault(format!("{name}: {} was refused: {}", refusal.act, refusal.reason));
            self.replan("a step was refused");
        }
    }

    fn tell_steps(&mut self, following: &mut Following) -> bool {
        if self.view.epoch() != self.epoch {
            return false;
        }
        let total: usize = following.plan.steps.iter().map(Vec::len).sum();
        let mut moved = false;
        for member in 0..following.told.len() {
            let agent = AgentId(member as u16);
            let done = self.view.progress(agent);
            while following.told[member] < done {
                let Some(step) = following.plan.steps[member].get(following.told[member].index()) else {
                    break;
                };
                following.told[member] = following.told[member].next();
                moved = true;
                let told: u32 = following.told.iter().map(|t| t.0).sum();
                let args: Vec<&str> = step.act.args.iter().skip(1).map(String::as_str).collect();
                let text = format!("{} {} {}", self.name_of(agent), step.act.action, args.join(" "));
                self.event(EventKind::Step { done: told, total: total as u32 }, text);
            }
        }
        moved
    }

    /// Every step is applied: is the goal reached?
    fn executed(&mut self) {
        let Some(facts) = self.view.state() else { return };
        let reached = self.reaches(&world_state(&facts), &self.final_goal());
        if reached || self.is_written() {
            return self.finish(OutcomeKind::Success, None);
        }
        self.fault("all steps are done and the goal does not hold: the world has changed meanwhile");
        self.replan("the goal is not reached");
    }

    /// Members whose next step has open gates and does not come.
    pub(crate) fn stuck(&self, following: &Following) -> Vec<AgentId> {
        let Some(frame) = self.view.frame() else { return Vec::new() };
        self.roster
            .alive()
            .filter(|agent| {
                let done: StepIndex = frame.progress(*agent);
                following.plan.steps[agent.index()]
                    .get(done.index())
                    .is_some_and(|step| step.gates.iter().all(|gate| frame.open(*gate)))
            })
            .collect()
    }
}

/// Why planning stops here.
enum Stop {
    /// A robot has no plan for its package.
    Reallocate { package: usize, why: String },
    /// It makes no sense to go on.
    Broken(String),
}
