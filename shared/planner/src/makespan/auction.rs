//! A plan made goal by goal: each part of the goal goes to the agent, or to all together, with whom the team is done
//! soonest (a sequential single-item auction; Koenig et al., "The power of sequential auctions for coordinated
//! multirobot routing", AAMAS 2006, with plans for bids and the makespan of the whole for a price).
//!
//! Nobody knows in which order the goals are best given away. The first is the one in which a known plan reaches
//! them; others come from moving one goal at a time, and what is no worse is kept.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::order::Order;
use crate::search::{Errand, Limits, Meter, Spreader};
use crate::task::{FactId, OperatorId, Task};

/// States that may be looked at for one bid.
const LOOKS: u64 = 200;

/// How soon the team is done: the makespan, the ends of all agents together, and the number of actions.
type Price = (u32, u32, usize);

/// Goals given away one after the other.
pub(super) struct Auction<'a> {
    task: &'a Task,
    agent_of: &'a [u32],
    cancel: &'a AtomicBool,
    deadline: Option<Instant>,
    spreader: Spreader<'a>,
    best: Option<Given>,
    /// The order of the best, or the one to begin with.
    goals: Vec<FactId>,
    hopeless: bool,
    random: u64,
    /// Looks that may still be taken.
    looks: u64,
}

/// A plan for goals in an order.
struct Given {
    price: Price,
    plan: Vec<OperatorId>,
    /// How long the plan is when each goal is reached.
    ends: Vec<usize>,
}

impl<'a> Auction<'a> {
    /// Begins in the order in which a plan reaches the goals. `None` if there is nothing to give away.
    pub fn new(
        task: &'a Task,
        agent_of: &'a [u32],
        plan: &[OperatorId],
        time: Option<Duration>,
        cancel: &'a AtomicBool,
    ) -> Option<Self> {
        let deadline = time.and_then(|time| Instant::now().checked_add(time));
        let spreader = Spreader::new(task, agent_of)?;
        let goals = in_order_of(task, plan);
        let auction = Auction {
            task,
            agent_of,
            cancel,
            deadline,
            spreader,
            best: None,
            goals,
            hopeless: false,
            random: 0x9e37_79b9_7f4a_7c15,
            looks: 0,
        };
        (auction.goals.len() > 1 && auction.spreader.agents > 1).then_some(auction)
    }

    /// The best plan so far.
    pub fn plan(&self) -> Option<&[OperatorId]> {
        self.best.as_ref().map(|best| best.plan.as_slice())
    }

    /// Goes on for so many looks, or until there is a first plan; how many were taken.
    pub fn run(&mut self, looks: u64) -> u64 {
        self.looks = if self.hopeless { 0 } else { looks };
        let looks = self.looks;
        if self.best.is_none() {
            self.best = self.given(&self.goals.clone(), 0);
            // Not for want of looks: this order leads nowhere, and so will most others.
            self.hopeless = self.best.is_none() && self.looks > 0 && !self.stopped();
            return looks - self.looks;
        }
        while self.looks > 0 && !self.stopped() {
            // What needs no look is not free.
            self.looks -= 1;
            let mut goals = self.goals.clone();
            let (from, to) = (self.below(goals.len()), self.below(goals.len()));
            if from == to {
                continue;
            }
            let goal = goals.remove(from);
            goals.insert(to, goal);
            if let Some(given) = self.given(&goals, from.min(to)) {
                self.best = Some(given);
                self.goals = goals;
            }
        }
        looks - self.looks
    }

    fn stopped(&self) -> bool {
        let late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        late || self.cancel.load(std::sync::atomic::Ordering::Relaxed)
    }

    /// A number below `n`, from a generator that starts the same everywhere (xorshift; Marsaglia 2003).
    fn below(&mut self, n: usize) -> usize {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random % n as u64) as usize
    }

    /// Gives away the goals in this order, the first `kept` of them as in the best plan. `None` if that gets dearer than
    /// the best, or leads nowhere.
    fn given(&mut self, goals: &[FactId], kept: usize) -> Option<Given> {
        let most = self.best.as_ref().map(|best| best.price);
        let mut given = Given { price: (0, 0, 0), plan: Vec::new(), ends: Vec::new() };
        if let Some(best) = self.best.as_ref().filter(|_| kept > 0) {
            given.ends = best.ends[..kept].to_vec();
            given.plan = best.plan[..best.ends[kept - 1]].to_vec();
        }
        let mut state = self.task.after(&self.task.init, &given.plan);
        for at in kept..goals.len() {
            let (price, more) = self.cheapest(&state, &goals[..=at], &given.plan)?;
            if most.is_some_and(|most| price > most) {
                return None;
            }
            state = self.task.after(&state, &more);
            given.price = price;
            given.plan.extend(more);
            given.ends.push(given.plan.len());
        }
        Some(given)
    }

    /// The bid with which the team is done soonest: what comes after `plan`, which leads to `state`.
    fn cheapest(
        &mut self,
        state: &[u64],
        goals: &[FactId],
        plan: &[OperatorId],
    ) -> Option<(Price, Vec<OperatorId>)> {
        let (price, loads) = self.price(plan);
        if goals.iter().all(|&fact| self.task.holds(state, fact)) {
            return Some((price, Vec::new()));
        }
        let mut cheapest: Option<(Price, Vec<OperatorId>)> = None;
        let agents = self.spreader.agents as u32;
        for only in (0..agents).map(Some).chain([None]) {
            if self.looks == 0 || self.stopped() {
                return None;
            }
            let limits = Limits { expansions: Some(LOOKS.min(self.looks)), ..Limits::default() };
            let mut meter = Meter::new(&limits, self.cancel);
            let errand = Errand { start: state, goal: goals, loads: &loads, only };
            let bid = self.spreader.run(&errand, &mut meter);
            self.looks = self.looks.saturating_sub(meter.expanded + 1);
            let Some(bid) = bid else { continue };
            let (price, _) = self.price(&[plan, &bid].concat());
            if cheapest.as_ref().is_none_or(|(known, _)| price < *known) {
                cheapest = Some((price, bid));
            }
        }
        cheapest
    }

    /// The price of a plan, and when each agent is done.
    fn price(&self, plan: &[OperatorId]) -> (Price, Vec<u16>) {
        let order = Order::new(self.task, self.agent_of, plan.to_vec());
        let mut ends = vec![0u16; self.spreader.agents];
        for (operator, &step) in plan.iter().zip(&order.earliest) {
            let end = &mut ends[self.agent_of[operator.index()] as usize];
            *end = (*end).max(u16::try_from(step + 1).unwrap_or(u16::MAX));
        }
        let all = ends.iter().map(|&end| u32::from(end)).sum();
        ((order.makespan, all, plan.len()), ends)
    }
}

/// The goals in the order in which a plan reaches them for good.
fn in_order_of(task: &Task, plan: &[OperatorId]) -> Vec<FactId> {
    let mut since = vec![0usize; task.goal.len()];
    let (mut state, mut next) = (task.init.clone(), task.init.clone());
    for (at, &operator) in plan.iter().enumerate() {
        task.apply(&state, operator, &mut next);
        std::mem::swap(&mut state, &mut next);
        for (since, &goal) in since.iter_mut().zip(&task.goal) {
            if !task.holds(&state, goal) {
                *since = at + 2;
            }
        }
    }
    let mut goals: Vec<(usize, FactId)> = since.into_iter().zip(task.goal.iter().copied()).collect();
    goals.sort_unstable();
    goals.dedup();
    goals.into_iter().map(|(_, goal)| goal).collect()
}
