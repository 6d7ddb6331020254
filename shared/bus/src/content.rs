//! What is said on a topic, as it travels.

use lamma_protocol::Topic;

use crate::{Bus, PublishError};

/// The bytes of a message, or the words of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// Of every topic but the frame.
    Bytes(Vec<u8>),
    /// Of the frame.
    Words(Vec<u64>),
}

impl Content {
    /// Publishes it.
    pub fn publish<B: Bus + ?Sized>(&self, bus: &mut B, topic: Topic) -> Result<(), PublishError> {
        match self {
            Content::Bytes(bytes) => bus.publish_bytes(topic, bytes),
            Content::Words(words) => bus.publish_frame(words),
        }
    }
}
