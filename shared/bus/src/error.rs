//! What can go wrong with an endpoint, one enum per operation, each with what to do.

use lamma_protocol::{Node, Topic, codec::CodecError};
use thiserror::Error;

/// Why something was not published. Nothing was sent.
#[derive(Debug, Error)]
pub enum PublishError {
    /// The topic has another publisher.
    #[error("{node} may not publish `{topic}`: only {publisher} does; send it to {publisher} instead")]
    NotPublisher {
        /// Who tried.
        node: Node,
        /// Where.
        topic: Topic,
        /// Whose topic it is.
        publisher: Node,
    },
    /// The team has no such member.
    #[error("no topic `{topic}` in a team of {agents}: check the agent's index against the roster")]
    NoSuchTopic {
        /// Where.
        topic: Topic,
        /// The size of the team.
        agents: u16,
    },
    /// The frame's topic carries words, not messages.
    #[error("`{}` carries words, not messages: use `publish_frame`", Topic::Frame)]
    BytesOnFrame,
    /// The message does not encode, or is too large.
    #[error("`{topic}`: {source}; split the message or shorten its texts")]
    Encode {
        /// Where.
        topic: Topic,
        /// Why.
        source: CodecError,
    },
    /// The shared memory for it could not be had.
    #[error(
        "no shared memory for {bytes} bytes on `{topic}` ({reason}): is /dev/shm full? See `lamma doctor`"
    )]
    Memory {
        /// Where.
        topic: Topic,
        /// How much was wanted.
        bytes: usize,
        /// What the transport said.
        reason: String,
    },
    /// The transport refused.
    #[error("`{topic}` could not be sent ({reason}): the next statement on the topic will try again")]
    Transport {
        /// Where.
        topic: Topic,
        /// What the transport said.
        reason: String,
    },
}

/// Why waiting failed. The endpoint is of no more use.
#[derive(Debug, Error)]
#[error("cannot wait for messages ({reason}): close this endpoint and start the process again")]
pub struct WaitError {
    /// What the operating system said.
    pub reason: String,
}
