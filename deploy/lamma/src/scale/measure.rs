//! What is measured of a rally from outside: memory, times, and what is left behind.

use std::path::Path;
use std::time::Duration;

use serde::Serialize;

use super::coordinator::Outcomes;
use crate::error::Failure;

/// One size of a team, as measured.
#[derive(Clone, Debug, Serialize)]
pub struct Level {
    /// Robots.
    pub agents: u16,
    /// Processes that hosted them.
    pub processes: usize,
    /// From the first process to the last robot's report, in seconds.
    pub start_s: f64,
    /// Until all robots had planned, in seconds.
    pub plan_s: f64,
    /// Until all had acted, in seconds.
    pub act_s: f64,
    /// Memory that belongs to one process alone, in KiB, divided by the robots it hosts: of all robots.
    pub private_kib: Spread,
    /// From one meeting of all to the next, in microseconds.
    pub barrier_us: Spread,
    /// Meetings measured.
    pub barriers: usize,
    /// Steps of all robots.
    pub actions: u64,
    /// Steps applied in a second.
    pub actions_per_s: f64,
    /// From the call to the end of the teardown, in seconds.
    pub total_s: f64,
    /// Processor time of all processes of the run, in seconds.
    pub cpu_s: f64,
    /// Processes of the run that still live after it.
    pub processes_left: usize,
    /// Files of the run that are still in shared memory after it.
    pub files_left: usize,
}

/// The middle, the 99th of a hundred and the greatest of some figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The median.
    pub p50: f64,
    /// The 99th percentile; of fewer than a hundred figures the greatest.
    pub p99: f64,
    /// The greatest.
    pub max: f64,
}

impl Spread {
    /// Of these figures, in any order; all 0 if there are none.
    pub fn of(mut figures: Vec<f64>) -> Spread {
        figures.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * figures.len() as f64).ceil() as usize;
            figures.get(index.clamp(1, figures.len().max(1)) - 1).copied().unwrap_or(0.0)
        };
        Spread { p50: at(0.5), p99: at(0.99), max: at(1.0) }
    }
}

/// Private memory of a process (`Private_Clean` and `Private_Dirty` of all its mappings), in KiB.
pub fn private_kib(pid: u32) -> Result<f64, Failure> {
    let path = format!("/proc/{pid}/smaps_rollup");
    let text = std::fs::read_to_string(&path).map_err(|e| Failure::io("read", Path::new(&path), &e))?;
    let private = text.lines().filter(|l| l.starts_with("Private_Clean:") || l.starts_with("Private_Dirty:"));
    Ok(private.filter_map(|l| l.split_whitespace().nth(1)?.parse::<f64>().ok()).sum())
}

/// Processor time that this process's ended children have used, user and system: `proc_pid_stat(5)`, fields
/// 16 and 17, in ticks of which Linux shows a hundred a second.
pub fn cpu_of_children() -> Duration {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name before it, in parentheses, may hold anything.
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: u64 = fields.skip(13).take(2).filter_map(|f| f.parse::<u64>().ok()).sum();
    Duration::from_millis(ticks * 10)
}

/// How many of the processes live.
pub fn alive(pids: &[u32]) -> usize {
    pids.iter().filter(|pid| Path::new(&format!("/proc/{pid}")).exists()).count()
}

/// The times between the lead's entries into the corridor: each is one meeting of all.
pub fn barriers_us(asked: &[u64], outcomes: &Outcomes) -> Vec<f64> {
    let entries = asked.get(outcomes.lead_before as usize..).unwrap_or_default();
    entries.windows(2).map(|w| w[1].saturating_sub(w[0]) as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_figures_that_were_measured() {
        let spread = Spread::of((1..=200).rev().map(f64::from).collect());
        assert_eq!(spread, Spread { p50: 100.0, p99: 198.0, max: 200.0 });
        assert_eq!(Spread::of(vec![3.0]), Spread { p50: 3.0, p99: 3.0, max: 3.0 });
        assert_eq!(Spread::of(vec![]), Spread::default());
    }

    #[test]
    fn only_the_corridor_counts_for_the_meetings() {
        let outcomes = Outcomes { lead_before: 2, ..Outcomes::default() };
        assert_eq!(barriers_us(&[0, 5, 10, 14, 20], &outcomes), [4.0, 6.0]);
        assert_eq!(barriers_us(&[0], &outcomes), [0.0; 0]);
    }

    #[test]
    fn this_process_has_memory_of_its_own() {
        assert!(private_kib(std::process::id()).expect("/proc is there") > 0.0);
        assert_eq!(alive(&[std::process::id(), 0]), 1);
    }
}
