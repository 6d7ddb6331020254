//! Who is there, who is gone, and what each said last.

use std::collections::BTreeMap;

use lamma_protocol::message::Report;
use lamma_protocol::{AgentId, Revision};

/// The members of the team as processes.
#[derive(Debug)]
pub(crate) struct Roster {
    reports: Vec<Option<(Revision, Report)>>,
    lost: BTreeMap<AgentId, String>,
}

impl Roster {
    pub fn new(members: usize) -> Self {
        Roster { reports: vec![None; members], lost: BTreeMap::new() }
    }

    /// Keeps the newest report. True if it is newer than the one known.
    pub fn hear(&mut self, agent: AgentId, revision: Revision, report: Report) -> bool {
        let Some(slot) = self.reports.get_mut(agent.index()) else { return false };
        if slot.as_ref().is_some_and(|(seen, _)| revision <= *seen) {
            return false;
        }
        *slot = Some((revision, report));
        true
    }

    /// Counts a member as lost, with the reason. True if it was not before.
    pub fn lose(&mut self, agent: AgentId, reason: impl Into<String>) -> bool {
        if agent.index() >= self.reports.len() || self.lost.contains_key(&agent) {
            return false;
        }
        self.lost.insert(agent, reason.into());
        true
    }

    pub fn lost(&self) -> Vec<AgentId> {
        self.lost.keys().copied().collect()
    }

    pub fn lost_reason(&self, agent: AgentId) -> Option<&str> {
        self.lost.get(&agent).map(String::as_str)
    }

    /// Members that are alive, by index.
    pub fn available(&self) -> Vec<usize> {
        self.alive().map(AgentId::index).collect()
    }

    pub fn alive(&self) -> impl Iterator<Item = AgentId> + '_ {
        (0..self.reports.len() as u16).map(AgentId).filter(|a| !self.lost.contains_key(a))
    }

    pub fn report(&self, agent: AgentId) -> Option<&Report> {
        self.reports.get(agent.index())?.as_ref().map(|(_, report)| report)
    }

    /// Whether everybody who is alive has said that it is here.
    pub fn all_joined(&self) -> bool {
        self.alive().all(|a| self.report(a).is_some())
    }
}
