//! Both ends at once: a schedule that gets shorter, a bound that rises, until they meet.

use std::sync::atomic::AtomicBool;

use super::auction::Auction;
use super::limits::WORK_PER_LITERAL;
use super::sat::{Found, Fuel};
use super::windows::Windows;
use super::{Answer, Asked, Makespan, MakespanLimits, Schedule, Scheduler};
use crate::search::{Limits, eliminate, spread};
use crate::task::OperatorId;

/// The most work on the bound before anything else: a small task is solved by that, schedule and proof in one. A
/// fifth is kept for the rest.
const FIRST_RAISE: u64 = 4_000_000;

/// Work of the first round; each round does twice as much.
const ROUND: u64 = 200_000;

/// The most work that a plan of another kind may take.
const SPREAD: u64 = 4_000_000;

/// The most work that a first plan goal by goal may take.
const FIRST_AUCTION: u64 = 10_000_000;

/// Operators looked at that count as a unit of work, where all of the goal is wanted, and where a part of it is.
const OPERATORS_A_UNIT: u64 = 4;
const OPERATORS_A_UNIT_OF_BIDS: u64 = 12;

/// Operators that a look for a bid counts for at least: the schedule is worked out anew for each.
const A_BID_AT_LEAST: usize = 1_000;

/// A schedule is much longer than the bound from this ratio on: 7 to 5.
const WIDE: (u64, u64) = (7, 5);

/// How far the proof is that no schedule is shorter.
struct Proof<'f> {
    bound: u32,
    /// The formula for the bound, if it was asked before: the solver goes on where it stopped.
    asked: Option<Asked<'f>>,
    /// There cannot be a formula.
    too_large: bool,
}

impl Proof<'_> {
    /// Where the schedule is still much longer than the bound when the fuel is used up, there is `more`, once.
    fn where_wide(&mut self, makespan: u32, more: &mut u64, fuel: &mut Fuel<'_>) {
        if fuel.work > 0 || u64::from(makespan) * WIDE.1 < u64::from(self.bound) * WIDE.0 {
            return;
        }
        fuel.size = fuel.size.max(*more / WORK_PER_LITERAL);
        fuel.work = std::mem::take(more);
        self.too_large = false;
    }
}

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
        if !self.is_plain() || !self.task.leads_to(&self.task.init, plan, &self.task.goal) {
            return self.shortest(from, Some(makespan), limits, cancel);
        }
        let mut proof = Proof { bound: from.max(self.depth()), asked: None, too_large: false };
        let mut windows = Windows::new(self, plan.to_vec(), proof.bound);
        let before = windows.order.makespan;
        let mut all = Fuel::new(&MakespanLimits { conflicts: u64::MAX, ..limits.clone() }, cancel);
        let first = FIRST_RAISE.min(all.work / 5 * 4);
        let mut best = all.slice(first, |fuel| self.raise(&mut proof, before, fuel));
        if best.is_some() {
            return Makespan { lower_bound: Some(proof.bound), schedule: best };
        }
        windows.bound = proof.bound;
        let mut auction = None;
        if before > proof.bound {
            self.rival(self.spread(limits, cancel), &mut windows);
            auction = Auction::new(self.task, &self.model.agent_of, plan, limits.time, cancel);
        }
        if let Some(auction) = &mut auction {
            self.auction(auction, FIRST_AUCTION, &mut windows, &mut all);
        }
        let mut round = ROUND;
        let mut more = limits.wide_work.saturating_sub(limits.work);
        while proof.bound < windows.order.makespan {
            proof.where_wide(windows.order.makespan, &mut more, &mut all);
            if all.is_empty() {
                break;
            }
            if let Some(auction) = &mut auction {
                self.auction(auction, round / 2, &mut windows, &mut all);
            }
            best = all.slice(round, |fuel| self.raise(&mut proof, windows.order.makespan, fuel));
            if best.is_some() {
                break;
            }
            windows.bound = proof.bound;
            all.slice(round, |fuel| windows.shorten(fuel));
            round = round.saturating_mul(2);
        }
        if best.is_none() && windows.order.makespan < before {
            best = Some(Schedule { steps: windows.order.steps() });
        }
        Makespan { lower_bound: Some(proof.bound), schedule: best }
    }

    /// Goes on from another plan, if its schedule is shorter.
    fn rival<'a>(&'a self, plan: Option<Vec<OperatorId>>, windows: &mut Windows<'a>) {
        let Some(plan) = plan else { return };
        let rival = Windows::new(self, eliminate(self.task, plan), windows.bound);
        if rival.order.makespan < windows.order.makespan {
            *windows = rival;
        }
    }

    /// Looks for a better way to give away the goals, with no more than so much work.
    fn auction<'a>(
        &'a self,
        auction: &mut Auction<'_>,
        work: u64,
        windows: &mut Windows<'a>,
        fuel: &mut Fuel<'_>,
    ) {
        let operators = self.task.operators.len().max(A_BID_AT_LEAST) as u64;
        let looks = work.min(fuel.work) * OPERATORS_A_UNIT_OF_BIDS / operators;
        let spent = auction.run(looks);
        self.rival(auction.plan().map(<[_]>::to_vec), windows);
        fuel.work = fuel.work.saturating_sub(spent * operators / OPERATORS_A_UNIT_OF_BIDS);
    }

    /// Raises the bound below `below` while that takes no more than the fuel; or a shortest schedule.
    fn raise<'f>(&self, proof: &mut Proof<'f>, below: u32, fuel: &mut Fuel<'f>) -> Option<Schedule> {
        while proof.bound < below && !proof.too_large && !fuel.is_empty() {
            if proof.asked.is_none() {
                proof.asked = self.formula(&self.reach, &self.model.goal, &self.relevant, proof.bound, fuel);
            }
            let Some(question) = &mut proof.asked else {
                // Too large now is too large later.
                proof.too_large = true;
                return None;
            };
            match question.ask(fuel) {
                (Found::Contradiction, _) => proof.bound += 1,
                // A question goes on as long as there is fuel for more than a few conflicts.
                (Found::Stopped, _) if fuel.is_for_a_few_conflicts() => return None,
                (Found::Stopped, _) => continue,
                (Found::Model, steps) => {
                    proof.asked = None;
                    return match self.checked(steps) {
                        Answer::Schedule(schedule) => Some(schedule),
                        Answer::None | Answer::Unknown => None,
                    };
                }
            }
            proof.asked = None;
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
