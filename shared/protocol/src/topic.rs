//! Topics: who says what to whom. One topic has one publisher.

use std::fmt;
use std::str::FromStr;

use crate::id::{AgentId, Node};

/// A topic of a run. How topics become shared-memory services or Zenoh keys is the bus's business alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Topic {
    /// Supervisor to all: who is lost, and that the run is over.
    Command,
    /// Coordinator: phase, events and in the end the outcome.
    Outcome,
    /// Coordinator: the epoch it asks the arbiter to open.
    Grant,
    /// Coordinator to one robot: what to plan or to carry out.
    Directive(AgentId),
    /// One robot to the coordinator: how far it is.
    Report(AgentId),
    /// One robot to the simulator: the step it wants to take.
    Request(AgentId),
    /// Simulator to one robot: what became of the request.
    Ack(AgentId),
    /// Simulator: the facts behind the bits of the frame.
    Vocabulary,
    /// Simulator: the world, as words in shared memory. The one topic that carries no message.
    Frame,
}

impl Topic {
    /// The only node that may publish it.
    pub fn publisher(self) -> Node {
        match self {
            Topic::Command => Node::Supervisor,
            Topic::Outcome | Topic::Grant | Topic::Directive(_) => Node::Coordinator,
            Topic::Report(a) | Topic::Request(a) => Node::Robot(a),
            Topic::Ack(_) | Topic::Vocabulary | Topic::Frame => Node::Simulator,
        }
    }

    /// Whether `node` listens to it.
    pub fn read_by(self, node: Node) -> bool {
        match self {
            Topic::Command => node != Node::Supervisor,
            Topic::Report(_) => node == Node::Coordinator,
            Topic::Outcome => node == Node::Supervisor,
            Topic::Grant | Topic::Request(_) => node == Node::Simulator,
            Topic::Directive(a) | Topic::Ack(a) => node == Node::Robot(a),
            Topic::Vocabulary => node == Node::Coordinator,
            Topic::Frame => matches!(node, Node::Coordinator | Node::Robot(_)),
        }
    }

    /// All topics of a team of `agents`, in a fixed order.
    pub fn all(agents: u16) -> Vec<Topic> {
        let mut topics = vec![Topic::Command, Topic::Outcome, Topic::Grant, Topic::Vocabulary, Topic::Frame];
        for a in (0..agents).map(AgentId) {
            topics.extend([Topic::Directive(a), Topic::Report(a), Topic::Request(a), Topic::Ack(a)]);
        }
        topics
    }

    /// All nodes of a team of `agents`, in a fixed order.
    pub fn nodes(agents: u16) -> Vec<Node> {
        let mut nodes = vec![Node::Supervisor, Node::Coordinator, Node::Simulator];
        nodes.extend((0..agents).map(|a| Node::Robot(AgentId(a))));
        nodes
    }
}

impl fmt::Display for Topic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Topic::Command => f.write_str("command"),
            Topic::Outcome => f.write_str("outcome"),
            Topic::Grant => f.write_str("grant"),
            Topic::Directive(a) => write!(f, "agent/{}/directive", a.0),
            Topic::Report(a) => write!(f, "agent/{}/report", a.0),
            Topic::Request(a) => write!(f, "agent/{}/request", a.0),
            Topic::Ack(a) => write!(f, "agent/{}/ack", a.0),
            Topic::Vocabulary => f.write_str("world/vocabulary"),
            Topic::Frame => f.write_str("world/frame"),
        }
    }
}

/// Text that names no [`Topic`].
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("`{0}` is no topic: `command`, `world/frame`, `agent/3/report` and such are")]
pub struct TopicParseError(String);

impl FromStr for Topic {
    type Err = TopicParseError;

    fn from_str(text: &str) -> Result<Topic, TopicParseError> {
        let agent = || {
            let (agent, kind) = text.strip_prefix("agent/")?.split_once('/')?;
            let agent = AgentId(agent.parse().ok()?);
            Some(match kind {
                "directive" => Topic::Directive(agent),
                "report" => Topic::Report(agent),
                "request" => Topic::Request(agent),
                "ack" => Topic::Ack(agent),
                _ => return None,
            })
        };
        Ok(match text {
            "command" => Topic::Command,
            "outcome" => Topic::Outcome,
            "grant" => Topic::Grant,
            "world/vocabulary" => Topic::Vocabulary,
            "world/frame" => Topic::Frame,
            _ => return agent().ok_or_else(|| TopicParseError(text.into())),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_is_read_as_it_is_written() {
        for topic in Topic::all(300) {
            assert_eq!(topic.to_string().parse(), Ok(topic));
        }
        for foreign in ["", "commands", "agent/1", "agent/1/x", "agent/70000/ack", "agent//ack"] {
            assert!(foreign.parse::<Topic>().is_err(), "{foreign}");
        }
    }

    #[test]
    fn every_topic_has_a_publisher_that_does_not_read_it_and_at_least_one_reader() {
        for topic in Topic::all(3) {
            let nodes = Topic::nodes(3);
            assert!(!topic.read_by(topic.publisher()), "{topic} is read by its own publisher");
            assert!(nodes.iter().any(|n| topic.read_by(*n)), "{topic} has no reader");
        }
    }
}
