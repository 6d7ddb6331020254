//! Which faults, and how often, as a person writes them: `loss=0.1,delay=20ms,partition=robot-1@2s+5s`.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use lamma_protocol::{AgentId, Node};
use thiserror::Error;

/// What a [`FaultyBus`](super::FaultyBus) does to what passes through it. Shares are of 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Share of statements that never leave.
    pub loss: f64,
    /// Share of statements that are sent twice.
    pub dup: f64,
    /// Share of statements that are held back until the next one of their topic has passed.
    pub reorder: f64,
    /// Share of statements in which one bit is turned over.
    pub corrupt: f64,
    /// Every statement is held back for a time drawn evenly from zero to this.
    pub delay: Duration,
    /// Times in which nothing passes, in either direction.
    pub partitions: Vec<Partition>,
}

/// A time in which a node is cut off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// Who; None: everybody.
    pub node: Option<Node>,
    /// When it begins, after the endpoint was opened.
    pub start: Duration,
    /// How long it lasts.
    pub length: Duration,
}

/// Text that is not a [`Plan`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{part}` is no fault of a bus ({reason}): write loss=0.1, dup=0.1, reorder=0.1, corrupt=0.01 (shares), \
     delay=20ms, partition=2s+5s or partition=robot-1@2s+5s, separated by commas"
)]
pub struct PlanError {
    part: String,
    reason: String,
}

impl FromStr for Plan {
    type Err = PlanError;

    fn from_str(text: &str) -> Result<Plan, PlanError> {
        let mut plan = Plan::default();
        for part in text.split(',').map(str::trim) {
            let fail = |reason: &str| PlanError { part: part.into(), reason: reason.into() };
            let (key, value) = part.split_once('=').ok_or_else(|| fail("no `=`"))?;
            let share = || {
                let share = value.parse::<f64>().ok().filter(|s| (0.0..=1.0).contains(s));
                share.ok_or_else(|| fail("a share from 0 to 1 is expected"))
            };
            match key {
                "loss" => plan.loss = share()?,
                "dup" => plan.dup = share()?,
                "reorder" => plan.reorder = share()?,
                "corrupt" => plan.corrupt = share()?,
                "delay" => plan.delay = duration(value).ok_or_else(|| fail("no time"))?,
                "partition" => plan.partitions.push(partition(value).map_err(&fail)?),
                _ => return Err(fail("no such fault")),
            }
        }
        Ok(plan)
    }
}

/// `250us`, `20ms`, `1.5s`; at most a day.
fn duration(text: &str) -> Option<Duration> {
    let (number, unit) = text.split_at(text.find(|c: char| c.is_ascii_alphabetic())?);
    let scale = match unit {
        "us" => 1e-6,
        "ms" => 1e-3,
        "s" => 1.0,
        _ => return None,
    };
    let seconds = number.parse::<f64>().ok()? * scale;
    (0.0..=86_400.0).contains(&seconds).then(|| Duration::from_secs_f64(seconds))
}

fn partition(text: &str) -> Result<Partition, &'static str> {
    let (node, times) = match text.split_once('@') {
        None => (None, text),
        Some((name, times)) => (Some(node(name).ok_or("no such node")?), times),
    };
    let (start, length) = times.split_once('+').ok_or("START+LENGTH is expected")?;
    let time = |text| duration(text).ok_or("no time");
    Ok(Partition { node, start: time(start)?, length: time(length)? })
}

fn node(name: &str) -> Option<Node> {
    match name {
        "coordinator" => Some(Node::Coordinator),
        "simulator" => Some(Node::Simulator),
        robot => Some(Node::Robot(AgentId(robot.strip_prefix("robot-")?.parse().ok()?))),
    }
}

impl Plan {
    /// Whether `node` is cut off at that time after it was opened.
    pub fn cuts(&self, node: Node, at: Duration) -> bool {
        let hit =
            |p: &&Partition| p.node.is_none_or(|n| n == node) && p.start <= at && at - p.start < p.length;
        self.partitions.iter().any(|p| hit(&p))
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micros = |d: Duration| format!("{}us", d.as_micros());
        let shares =
            [("loss", self.loss), ("dup", self.dup), ("reorder", self.reorder), ("corrupt", self.corrupt)];
        let shares = shares.into_iter().map(|(key, share)| format!("{key}={share}"));
        let delay = format!("delay={}", micros(self.delay));
        let partitions = self.partitions.iter().map(|p| {
            let node = p.node.map(|n| format!("{n}@")).unwrap_or_default();
            format!("partition={node}{}+{}", micros(p.start), micros(p.length))
        });
        f.write_str(&shares.chain([delay]).chain(partitions).collect::<Vec<_>>().join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_is_read_as_it_is_written() {
        let text = "loss=0.1,dup=0.25,reorder=0.5,corrupt=0.01,delay=20ms,partition=1s+500ms,partition=robot-1@2s+5s";
        let plan: Plan = text.parse().unwrap();
        assert_eq!((plan.loss, plan.delay), (0.1, Duration::from_millis(20)));
        assert_eq!(plan.to_string().parse::<Plan>().unwrap(), plan);
    }

    #[test]
    fn what_is_no_fault_is_named() {
        let bad = ["", "loss", "loss=2", "loss=NaN", "los=0.1", "delay=20", "delay=-1s", "delay=1e99s"];
        let bad =
            bad.into_iter().chain(["partition=1s", "partition=robot@1s+1s", "partition=ä@1s+1s", "delay=1ä"]);
        for bad in bad {
            let error = bad.parse::<Plan>().unwrap_err().to_string();
            assert!(error.contains(&format!("`{bad}`")) && error.contains("loss=0.1"), "{error}");
        }
    }

    #[test]
    fn a_partition_has_a_beginning_and_an_end() {
        let plan: Plan = "partition=robot-1@2s+5s".parse().unwrap();
        let (r0, r1) = (Node::Robot(AgentId(0)), Node::Robot(AgentId(1)));
        let cut = |node, ms| plan.cuts(node, Duration::from_millis(ms));
        assert_eq!([1999, 2000, 6999, 7000].map(|ms| cut(r1, ms)), [false, true, true, false]);
        assert!(!cut(r0, 3000));
    }
}
