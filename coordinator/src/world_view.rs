//! The world as the coordinator sees it: the arbiter's vocabulary and the newest frame.

use std::collections::BTreeSet;

use lamma_pddl::ast::GroundAtom;
use lamma_pddl::parse_ground_atom;
use lamma_protocol::{AgentId, Epoch, Frame, StepIndex};

/// What is known of the world.
#[derive(Debug, Default)]
pub(crate) struct WorldView {
    facts: Vec<Option<GroundAtom>>,
    words: Vec<u64>,
}

impl WorldView {
    /// Takes a vocabulary; the list only grows, so only its new part is read.
    pub fn learn(&mut self, facts: &[String]) {
        for text in facts.iter().skip(self.facts.len()) {
            self.facts.push(parse_ground_atom(text).ok());
        }
    }

    /// Takes a frame, unless it is older than the one known. True if it is newer.
    pub fn see(&mut self, frame: &Frame<'_>) -> bool {
        if self.frame().is_some_and(|known| frame.version() <= known.version()) {
            return false;
        }
        self.words.clear();
        self.words.extend_from_slice(frame.words());
        true
    }

    /// The newest frame.
    pub fn frame(&self) -> Option<Frame<'_>> {
        Frame::new(&self.words).ok()
    }

    /// What holds, once the vocabulary covers the frame.
    pub fn state(&self) -> Option<BTreeSet<GroundAtom>> {
        let frame = self.frame()?;
        if (frame.facts() as usize) > self.facts.len() {
            return None;
        }
        Some(frame.true_facts().filter_map(|bit| self.facts.get(bit as usize)?.clone()).collect())
    }

    /// The open epoch.
    pub fn epoch(&self) -> Epoch {
        self.frame().map_or(Epoch(0), |f| f.epoch())
    }

    /// Steps of the open epoch that `agent` has done.
    pub fn progress(&self, agent: AgentId) -> StepIndex {
        self.frame().map_or(StepIndex(0), |f| f.progress(agent))
    }
}
