//! The world frame: a header, the team's progress and the bits of the state, as 64-bit words.
//!
//! The words lie in shared memory and are read in place. Layout, in words:
//!
//! | words | content |
//! |---|---|
//! | 0 | magic and layout version |
//! | 1 | epoch |
//! | 2 | version: how many times the world has changed |
//! | 3 | requested: steps asked for so far, whole run, repeats not counted |
//! | 4 | applied: steps applied so far, whole run |
//! | 5 | number of agents (low half), number of facts (high half) |
//! | 6 | logical time: the makespan, in steps, of what was applied so far |
//! | 7 .. | progress: steps applied in this epoch, one word per agent |
//! | then | closed: steps applied in the epoch before this one, one word per agent |
//! | rest | one bit per fact of the vocabulary, lowest bit first |

use thiserror::Error;

use crate::id::{AgentId, Epoch, StepIndex};
use crate::message::Gate;

/// "LAMMAF" and the layout version.
const MAGIC: u64 = 0x4c41_4d4d_4146_0001;
const FIXED: usize = 7;

/// Bytes that are not a frame of this layout.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum FrameError {
    /// The first word is wrong: foreign bytes, or another version of this software.
    #[error("not a world frame of this version (first word {found:#018x}, expected {MAGIC:#018x})")]
    Foreign {
        /// The word found.
        found: u64,
    },
    /// The header promises more words than there are.
    #[error("world frame cut short: {have} words, header promises {need}")]
    Truncated {
        /// Words present.
        have: usize,
        /// Words promised.
        need: usize,
    },
}

/// What the arbiter writes into the header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameHeader {
    /// The open epoch.
    pub epoch: Epoch,
    /// How many times the world or the epoch has changed; orders frames.
    pub version: u64,
    /// Steps asked for so far.
    pub requested: u64,
    /// Steps applied so far.
    pub applied: u64,
    /// The makespan of what was applied so far, in steps.
    pub makespan: u64,
    /// Steps applied in this epoch, per agent.
    pub progress: Vec<StepIndex>,
    /// Steps applied in the last epoch that had any before this one, per agent: what a new plan follows.
    pub closed: Vec<StepIndex>,
    /// Facts in the vocabulary that this frame needs.
    pub facts: u32,
}

/// Writes a frame: the header and `bits`, where bit `i` of the slice's words is fact `i`.
pub fn write_frame(header: &FrameHeader, bits: &[u64]) -> Vec<u64> {
    let words = bit_words(header.facts);
    let mut out = Vec::with_capacity(FIXED + 2 * header.progress.len() + words);
    let agents = header.progress.len() as u64;
    out.extend([
        MAGIC,
        header.epoch.0,
        header.version,
        header.requested,
        header.applied,
        agents | u64::from(header.facts) << 32,
        header.makespan,
    ]);
    out.extend(header.progress.iter().map(|p| u64::from(p.0)));
    out.extend((0..header.progress.len()).map(|a| header.closed.get(a).map_or(0, |p| u64::from(p.0))));
    out.extend((0..words).map(|i| bits.get(i).copied().unwrap_or(0)));
    out
}

fn bit_words(facts: u32) -> usize {
    facts.div_ceil(64) as usize
}

/// A frame read in place.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    words: &'a [u64],
    agents: usize,
    facts: u32,
}

impl<'a> Frame<'a> {
    /// Checks the header; nothing is copied.
    pub fn new(words: &'a [u64]) -> Result<Self, FrameError> {
        let found = words.first().copied().unwrap_or(0);
        if found != MAGIC {
            return Err(FrameError::Foreign { found });
        }
        let counts = *words.get(5).ok_or(FrameError::Truncated { have: words.len(), need: FIXED })?;
        let (agents, facts) = ((counts & 0xffff_ffff) as usize, (counts >> 32) as u32);
        let need = FIXED + 2 * agents + bit_words(facts);
        if words.len() < need {
            return Err(FrameError::Truncated { have: words.len(), need });
        }
        Ok(Frame { words, agents, facts })
    }

    /// The open epoch.
    pub fn epoch(&self) -> Epoch {
        Epoch(self.words[1])
    }

    /// Orders frames; see [`FrameHeader::version`].
    pub fn version(&self) -> u64 {
        self.words[2]
    }

    /// Steps asked for so far, in the whole run.
    pub fn requested(&self) -> u64 {
        self.words[3]
    }

    /// Steps applied so far, in the whole run.
    pub fn applied(&self) -> u64 {
        self.words[4]
    }

    /// The makespan of what was applied so far, in steps.
    pub fn makespan(&self) -> u64 {
        self.words[6]
    }

    /// How many agents the frame speaks of.
    pub fn agents(&self) -> usize {
        self.agents
    }

    /// How long the vocabulary must be to read all bits.
    pub fn facts(&self) -> u32 {
        self.facts
    }

    /// Steps of this epoch that `agent` has done.
    pub fn progress(&self, agent: AgentId) -> StepIndex {
        self.count(FIXED, agent)
    }

    /// Steps that `agent` had done when the epoch before this one closed.
    pub fn closed(&self, agent: AgentId) -> StepIndex {
        self.count(FIXED + self.agents, agent)
    }

    fn count(&self, start: usize, agent: AgentId) -> StepIndex {
        if agent.index() >= self.agents {
            return StepIndex(0);
        }
        StepIndex(u32::try_from(self.words[start + agent.index()]).unwrap_or(u32::MAX))
    }

    /// Whether fact `i` of the vocabulary holds.
    pub fn holds(&self, i: u32) -> bool {
        i < self.facts && self.bits()[(i / 64) as usize] >> (i % 64) & 1 == 1
    }

    /// The facts that hold, by index, in order.
    pub fn true_facts(&self) -> impl Iterator<Item = u32> + '_ {
        self.bits().iter().enumerate().flat_map(|(w, word)| {
            let mut rest = *word;
            std::iter::from_fn(move || {
                let bit = rest.trailing_zeros();
                rest &= rest.wrapping_sub(1);
                (bit < 64).then_some(w as u32 * 64 + bit)
            })
        })
    }

    /// Whether the gate is open.
    pub fn open(&self, gate: Gate) -> bool {
        self.progress(gate.agent) >= gate.done
    }

    /// The words of a frame that says the same but knows no facts: what to keep of one that is to be looked at later.
    pub fn without_facts(&self) -> Vec<u64> {
        let mut words = self.words[..FIXED + 2 * self.agents].to_vec();
        words[5] = self.agents as u64;
        words
    }

    /// All words, to record or to send on.
    pub fn words(&self) -> &'a [u64] {
        self.words
    }

    fn bits(&self) -> &'a [u64] {
        let start = FIXED + 2 * self.agents;
        &self.words[start..start + bit_words(self.facts)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Vec<u64> {
        let header = FrameHeader {
            epoch: Epoch(3),
            version: 17,
            requested: 5,
            applied: 4,
            makespan: 2,
            progress: vec![StepIndex(2), StepIndex(0)],
            closed: vec![StepIndex(1), StepIndex(9)],
            facts: 70,
        };
        write_frame(&header, &[0b101, 0b10_0000])
    }

    #[test]
    fn what_is_written_is_read_in_place() {
        let words = sample();
        let frame = Frame::new(&words).unwrap();
        assert_eq!((frame.epoch(), frame.version(), frame.agents()), (Epoch(3), 17, 2));
        assert_eq!((frame.requested(), frame.applied(), frame.makespan()), (5, 4, 2));
        assert_eq!(frame.true_facts().collect::<Vec<_>>(), [0, 2, 69]);
        assert_eq!(frame.closed(AgentId(1)), StepIndex(9));
        assert!(frame.holds(69) && !frame.holds(1) && !frame.holds(70));
        assert!(frame.open(Gate { agent: AgentId(0), done: StepIndex(2) }));
        assert!(!frame.open(Gate { agent: AgentId(1), done: StepIndex(1) }));
    }

    #[test]
    fn what_is_kept_of_a_frame_says_the_same_of_the_team() {
        let words = sample();
        let kept = Frame::new(&words).unwrap().without_facts();
        let kept = Frame::new(&kept).unwrap();
        assert_eq!((kept.epoch(), kept.version(), kept.agents(), kept.facts()), (Epoch(3), 17, 2, 0));
        assert_eq!(kept.progress(AgentId(0)), StepIndex(2));
        assert_eq!(kept.closed(AgentId(1)), StepIndex(9));
        assert_eq!(kept.true_facts().count(), 0);
    }

    #[test]
    fn foreign_and_short_bytes_are_refused() {
        assert_eq!(Frame::new(&[]).unwrap_err(), FrameError::Foreign { found: 0 });
        let words = sample();
        for cut in 1..words.len() {
            assert!(matches!(Frame::new(&words[..cut]), Err(FrameError::Truncated { .. })), "{cut}");
        }
    }
}
