//! The receiving half that all transports share: what is decoded, what is refused, and the counts.

use lamma_protocol::{Envelope, Frame, Topic, codec};

use crate::Received;

/// What an endpoint has seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Statements published.
    pub published: u64,
    /// Messages and frames handed over.
    pub received: u64,
    /// Bytes that were not a message of this version, or could not be fetched; dropped.
    pub refused: u64,
    /// The most recent of these: where, and why.
    pub last_refusal: Option<(Topic, String)>,
}

/// Decodes what arrives and keeps the counts.
#[derive(Debug, Default)]
pub struct Inbox {
    /// The counts so far.
    pub stats: Stats,
}

impl Inbox {
    /// Hands on the message in `bytes`, or drops it. Returns whether it was handed on.
    pub fn message(&mut self, topic: Topic, bytes: &[u8], sink: &mut dyn FnMut(Received<'_>)) -> bool {
        match codec::decode(bytes) {
            Ok(envelope) => self.envelope(topic, envelope, sink),
            Err(error) => self.refuse(topic, &error),
        }
    }

    /// Hands on a decoded message.
    pub fn envelope(&mut self, topic: Topic, envelope: Envelope, sink: &mut dyn FnMut(Received<'_>)) -> bool {
        self.stats.received += 1;
        sink(Received::Message(topic, envelope));
        true
    }

    /// Hands on the frame in `words`, or drops it. Returns whether it was handed on.
    pub fn frame(&mut self, words: &[u64], sink: &mut dyn FnMut(Received<'_>)) -> bool {
        match Frame::new(words) {
            Ok(frame) => {
                self.stats.received += 1;
                sink(Received::Frame(frame));
                true
            }
            Err(error) => self.refuse(Topic::Frame, &error),
        }
    }

    /// Counts and logs something that cannot be handed on.
    pub fn refuse(&mut self, topic: Topic, reason: &dyn std::fmt::Display) -> bool {
        self.stats.refused += 1;
        let reason = reason.to_string();
        // A peer that repeats itself must not fill the disk: the first and then every power of two.
        if self.stats.refused.is_power_of_two() {
            tracing::warn!(%topic, refused = self.stats.refused, "dropped what arrived: {reason}");
        }
        self.stats.last_refusal = Some((topic, reason));
        false
    }
}
