//! Both ends at once: a schedule that gets shorter, a bound that rises, until they meet.

use std::sync::atomic::AtomicBool;

use super::sat::{Found, Fuel};
use super::windows::{Windows, leads_to};
use super::{Answer, Asked, Makespan, MakespanLimits, Schedule, Scheduler};
use crate::search::{Limits, spread};
use crate::task::OperatorId;

/// Work of the first round; each round does twice as much.
const ROUND: u64 = 200_000;

/// The most work that a plan of another kind may take.
const SPREAD: u64 = 4_000_000;

/// Operators looked at that count as a unit of work.
const OPERATORS_A_UNIT: u64 = 4;

impl Scheduler<'_> {
    /// Shortens the schedule of the linear plan `plan` and raises the proved bound `from`, in turns, until they
    /// meet or the limits are reached (those of work, size and time). The windows are for tasks without conditional effects, derived facts and
    /// numbers; for others, and where `plan` is none, this is [`Scheduler::shortest`] below `makespan`.
    pub fn improve(
        &self,
        plan: &[OperatorId],
        makespan: u32,
        from: u32,
        limits: &MakespanLimits,
        cancel: &AtomicBool,
    ) -> Makespan {
        if !self.is_plain() || !leads_to(self.task, &self.task.init, plan, &self.task.goal) {
            return self.shortest(from, Some(makespan), limits, cancel);
        }
        let mut bound = from.max(self.depth());
        let mut windows = Windows::new(self, plan.to_vec(), bound);
        let before = windows.order.makespan;
        if before > bound
            && let Some(plan) = self.spread(limits, cancel)
        {
            let rival = Windows::new(self, plan, bound);
            if rival.order.makespan < before {
                windows = rival;
            }
        }
        let mut best = None;
        let mut all = Fuel::new(&MakespanLimits { conflicts: u64::MAX, ..limits.clone() }, cancel);
        let mut round = ROUND;
        let mut asked = None;
        while bound < windows.order.makespan && !all.is_empty() {
            best = all.slice(round, |fuel| self.raise(&mut bound, windows.order.makespan, &mut asked, fuel));
            if best.is_some() {
                break;
            }
            windows.bound = bound;
            all.slice(round, |fuel| windows.shorten(fuel));
            round = round.saturating_mul(2);
        }
        if best.is_none() && windows.order.makespan < before {
            best = Some(Schedule { steps: windows.order.steps() });
        }
        Makespan { lower_bound: Some(bound), schedule: best }
    }

    /// Raises the bound while that takes no more than the fuel; or a shortest schedule. `asked` is the formula for the
    /// bound, if it was asked before: the solver goes on where it stopped.
    fn raise<'f>(
        &self,
        bound: &mut u32,
        below: u32,
        asked: &mut Option<Asked<'f>>,
        fuel: &mut Fuel<'f>,
    ) -> Option<Schedule> {
        while *bound < below && !fuel.is_empty() {
            if asked.is_none() {
                *asked = self.formula(&self.reach, &self.model.goal, &self.relevant, *bound, fuel);
            }
            match asked.as_mut()?.ask(fuel) {
                (Found::Contradiction, _) => *bound += 1,
                (Found::Stopped, _) => return None,
                (Found::Model, steps) => {
                    *asked = None;
                    return match self.checked(steps) {
                        Answer::Schedule(schedule) => Some(schedule),
                        Answer::None | Answer::Unknown => None,
                    };
                }
            }
            *asked = None;
        }
        None
    }

    /// Another plan, one that gives all agents something to do.
    fn spread(&self, limits: &MakespanLimits, cancel: &AtomicBool) -> Option<Vec<OperatorId>> {
        if self.model.agents < 2 {
            return None;
        }
        let looks = limits.work.min(SPREAD) * OPERATORS_A_UNIT;
        let limits = Limits {
            expansions: Some(looks / self.task.operators.len().max(1) as u64),
            time: limits.time.map(|time| time / 4),
            ..Limits::default()
        };
        spread(self.task, &self.model.agent_of, &limits, cancel)
    }
}
