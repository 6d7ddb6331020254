//! Logical time: when each step would have run if every action took exactly its duration.
//!
//! Processes run as fast as they can, so wall-clock time says nothing about a plan. The makespan that
//! counts is the one of the applied steps under their own order: a step starts when its agent's previous
//! step and all steps behind its gates have ended. A new epoch starts when everything before it has ended.

use lamma_protocol::AgentId;
use lamma_protocol::message::Gate;

/// End times of the applied steps, in steps of duration 1.
#[derive(Debug)]
pub(crate) struct LogicalClock {
    base: f64,
    ends: Vec<Vec<f64>>,
    last: f64,
}

impl LogicalClock {
    pub fn new(agents: usize) -> Self {
        LogicalClock { base: 0.0, ends: vec![Vec::new(); agents], last: 0.0 }
    }

    /// A step of `agent` was applied. Its gates were open, so the steps behind them have end times.
    pub fn applied(&mut self, agent: AgentId, gates: &[Gate], duration: f64) {
        let own = self.ends[agent.index()].last().copied();
        let others = gates.iter().filter_map(|gate| {
            let done = gate.done.index().checked_sub(1)?;
            self.ends.get(gate.agent.index())?.get(done).copied()
        });
        let start = others.chain(own).fold(self.base, f64::max);
        let end = start + duration;
        self.ends[agent.index()].push(end);
        self.last = self.last.max(end);
    }

    pub fn new_epoch(&mut self) {
        self.base = self.last;
        self.ends.iter_mut().for_each(Vec::clear);
    }

    /// The makespan so far, in whole steps.
    pub fn makespan(&self) -> u64 {
        self.last.ceil() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamma_protocol::StepIndex;

    #[test]
    fn steps_behind_gates_start_after_them_and_others_run_beside_them() {
        let (a, b) = (AgentId(0), AgentId(1));
        let mut clock = LogicalClock::new(2);
        clock.applied(a, &[], 1.0);
        clock.applied(a, &[], 1.0);
        clock.applied(b, &[], 1.0);
        assert_eq!(clock.makespan(), 2);
        clock.applied(b, &[Gate { agent: a, done: StepIndex(2) }], 1.0);
        assert_eq!(clock.makespan(), 3);
        clock.new_epoch();
        clock.applied(b, &[], 1.0);
        assert_eq!(clock.makespan(), 4);
    }
}
