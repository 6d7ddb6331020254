//! The result of the run, put together.

use lamma_planner::interpreter::WorldState;
use lamma_protocol::AgentId;

use crate::machine::Coordinator;
use crate::result::{
    ActionResult, GoalResult, Metrics, OutcomeKind, PlanResult, RunResult, SubtaskResult, UnderstoodResult,
};
use crate::understand::ScoreGoal;

impl Coordinator {
    pub(crate) fn build_result(
        &self,
        kind: OutcomeKind,
        reason: Option<String>,
        clarification: Option<serde_json::Value>,
    ) -> RunResult {
        let state = self.final_state();
        let score = self.config.score.as_ref().or(self.understanding.as_ref().map(|u| &u.goal));
        let (goal, reached) = score.map_or((GoalResult::default(), false), |s| self.judge(s, &state));
        let (kind, reason) = match kind {
            // The simulator's state has the last word.
            OutcomeKind::Success if !reached => {
                let missing = goal.missing.join(", ");
                (OutcomeKind::GoalNotReached, Some(format!("does not hold at the end: {missing}")))
            }
            kind => (kind, reason),
        };
        RunResult {
            outcome: kind,
            reason,
            metrics: self.metrics(kind, &goal),
            goal,
            understood: self.understood_result(),
            plan: self.plan_result(),
            time_ms: self.stopwatch.read(self.now),
            faults: self.faults.clone(),
            recoveries: self.recoveries.clone(),
            clarification,
        }
    }

    fn final_state(&self) -> WorldState {
        let facts = self.planned_state.clone().or_else(|| self.view.state()).unwrap_or_default();
        WorldState { facts, values: Default::default() }
    }

    fn judge(&self, score: &ScoreGoal, state: &WorldState) -> (GoalResult, bool) {
        let result = score.judge(|condition| {
            let ground = self.interpreter.ground_condition(condition);
            ground.is_ok_and(|g| self.interpreter.holds(state, &g))
        });
        let reached = result.missing.is_empty();
        (result, reached)
    }

    fn metrics(&self, kind: OutcomeKind, goal: &GoalResult) -> Metrics {
        let success = kind == OutcomeKind::Success;
        let (requested, applied, makespan) =
            self.view.frame().map_or((0, 0, 0), |f| (f.requested(), f.applied(), f.makespan()));
        let makespan = if self.config.solve_only { self.plan_makespan() } else { makespan as f64 };
        let timed = self.config.team.travel.is_some();
        let used = match self.config.solve_only || timed {
            true => self.history.iter().map(|action| action.duration).sum(),
            false => applied as f64,
        };
        let reference = self.config.reference.or(self.first_plan);
        let share = |best: f64, used: f64| if used > 0.0 { best / used } else { 1.0 };
        Metrics {
            sr: f64::from(u8::from(success)),
            gcr: if goal.total == 0 {
                f64::from(u8::from(success))
            } else {
                goal.reached as f64 / goal.total as f64
            },
            exe: if requested == 0 { 1.0 } else { applied as f64 / requested as f64 },
            ru: reference.filter(|_| success).map(|(_, busy)| share(busy, used)),
            eff: reference.filter(|_| success).map(|(best, _)| share(best, makespan)),
        }
    }

    fn plan_makespan(&self) -> f64 {
        self.history.iter().map(ActionResult::end).fold(0.0, f64::max)
    }

    fn plan_result(&self) -> PlanResult {
        let mut actions = self.history.clone();
        actions.sort_by(|a, b| a.start.total_cmp(&b.start).then_with(|| a.robot.cmp(&b.robot)));
        let executed = self.view.frame().map_or(0, |f| f.makespan()) as f64;
        PlanResult {
            length: actions.len(),
            makespan: if self.config.solve_only { self.plan_makespan() } else { executed },
            makespan_lower_bound: self.lower_bound.unwrap_or(0.0),
            actions,
        }
    }

    fn understood_result(&self) -> UnderstoodResult {
        let Some(understanding) = &self.understanding else { return UnderstoodResult::default() };
        let id = |s: usize| understanding.subgoals[s].id.clone();
        let robots = |s: usize| {
            let members = self.allocation.as_ref().map(|a| a.members_of(s)).unwrap_or_default();
            members.into_iter().map(|m| self.name_of(AgentId(m as u16))).collect()
        };
        let subtasks = understanding.subgoals.iter().enumerate().map(|(s, subgoal)| SubtaskResult {
            id: subgoal.id.clone(),
            text: subgoal.text.clone(),
            goal: vec![subgoal.goal.to_string()],
            after: subgoal.after.iter().map(|&p| id(p)).collect(),
            robots: robots(s),
        });
        UnderstoodResult { subtasks: subtasks.collect(), assumptions: understanding.assumptions.clone() }
    }
}
