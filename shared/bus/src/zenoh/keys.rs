//! The key expressions of a run, for programs of any make that want to listen in.
//!
//! | key | what |
//! |---|---|
//! | `lamma/<run>/<topic>` | the topic's newest statement; topics as [`Topic`] prints them |
//! | `lamma/<run>/live/<node>/<session>` | a liveliness token: this node is there and hears |
//! | `lamma/<run>/sync/<node>` | asked by a node to learn that all it sent before has arrived; the router answers |
//!
//! Every publication has an attachment of 16 bytes, a [`Stamp`].

use lamma_protocol::{AgentId, Node, Topic};

use super::RunId;

/// Which publication it is, among all of its topic: a later session's is newer, and in one session the one with
/// the greater number. Two numbers of 64 bits, little endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stamp {
    /// When the session began, in microseconds since 1970 (UTC) of the publisher's clock.
    pub session: u64,
    /// Counts the publications of the session, from 1.
    pub number: u64,
}

impl Stamp {
    /// As bytes of an attachment.
    pub fn to_bytes(self) -> [u8; 16] {
        let mut bytes = [0; 16];
        bytes[..8].copy_from_slice(&self.session.to_le_bytes());
        bytes[8..].copy_from_slice(&self.number.to_le_bytes());
        bytes
    }

    /// From the bytes of an attachment; None if it is none of ours.
    pub fn from_bytes(bytes: &[u8]) -> Option<Stamp> {
        let (session, number) = bytes.split_first_chunk::<8>()?;
        Some(Stamp {
            session: u64::from_le_bytes(*session),
            number: u64::from_le_bytes(number.try_into().ok()?),
        })
    }
}

/// The keys of one run.
#[derive(Clone, Debug)]
pub struct Keys {
    prefix: String,
}

impl Keys {
    /// The keys of `run`.
    pub fn new(run: &RunId) -> Keys {
        Keys { prefix: format!("lamma/{run}/") }
    }

    /// The keys of all runs at once, for rules.
    pub fn of_any_run() -> Keys {
        Keys { prefix: "lamma/*/".into() }
    }

    /// Any key of the run.
    pub fn key(&self, rest: &str) -> String {
        self.prefix.clone() + rest
    }

    /// Where `topic` is published.
    pub fn topic(&self, topic: Topic) -> String {
        format!("{}{topic}", self.prefix)
    }

    /// The topic published at `key`.
    pub fn topic_of(&self, key: &str) -> Option<Topic> {
        key.strip_prefix(&self.prefix)?.parse().ok()
    }

    /// What `node` subscribes to: as few expressions as say it.
    pub fn read_by(&self, node: Node) -> Vec<String> {
        let texts: Vec<String> = match node {
            Node::Supervisor => vec!["outcome".into()],
            Node::Coordinator => ["command", "agent/*/report", "world/**"].map(String::from).into(),
            Node::Simulator => ["command", "grant", "agent/*/request"].map(String::from).into(),
            Node::Robot(a) => vec![
                "command".into(),
                format!("agent/{}/directive", a.0),
                format!("agent/{}/ack", a.0),
                "world/frame".into(),
            ],
        };
        texts.into_iter().map(|text| self.key(&text)).collect()
    }

    /// The token of a session of `node`.
    pub fn live(&self, node: Node, session: u64) -> String {
        format!("{}live/{node}/{session}", self.prefix)
    }

    /// The tokens of all sessions of `node`.
    pub fn live_of(&self, node: Node) -> String {
        format!("{}live/{node}/*", self.prefix)
    }

    /// The tokens of those who read what `node` publishes.
    pub fn live_readers_of(&self, node: Node) -> Vec<String> {
        let all = match node {
            // Both are few; a watch over all would tell every robot of every other.
            Node::Robot(_) => vec!["live/coordinator/*", "live/simulator/*"],
            Node::Supervisor | Node::Coordinator | Node::Simulator => vec!["live/**"],
        };
        all.into_iter().map(|text| self.key(text)).collect()
    }

    /// The node, and its session, whose token has this key.
    pub fn node_of_token(&self, key: &str) -> Option<(Node, u64)> {
        let (node, session) = key.strip_prefix(&self.prefix)?.strip_prefix("live/")?.split_once('/')?;
        let node = match node {
            "supervisor" => Node::Supervisor,
            "coordinator" => Node::Coordinator,
            "simulator" => Node::Simulator,
            robot => Node::Robot(AgentId(robot.strip_prefix("robot-")?.parse().ok()?)),
        };
        Some((node, session.parse().ok()?))
    }

    /// What `node` asks to learn that what it sent before has arrived.
    pub fn sync(&self, node: Node) -> String {
        format!("{}sync/{node}", self.prefix)
    }

    /// What any node asks.
    pub fn sync_of_any(&self) -> String {
        self.key("sync/*")
    }
}

/// Whether all keys of `inner` are keys of `outer`; false where one of them is no key expression.
pub fn includes(outer: &str, inner: &str) -> bool {
    use zenoh::key_expr::KeyExpr;
    let parse = |text: &str| KeyExpr::try_from(text.to_owned());
    parse(outer).is_ok_and(|o| parse(inner).is_ok_and(|i| o.includes(&i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys() -> Keys {
        Keys::new(&"run-1".parse().expect("a run's id"))
    }

    #[test]
    fn every_topic_and_every_node_is_told_by_its_key() {
        let keys = keys();
        for topic in Topic::all(300) {
            assert_eq!(keys.topic_of(&keys.topic(topic)), Some(topic));
        }
        for node in Topic::nodes(300) {
            assert_eq!(keys.node_of_token(&keys.live(node, 7)), Some((node, 7)));
        }
        for foreign in
            ["lamma/run-2/command", "lamma/run-1/agent/70000/ack", "lamma/run-1/agent/1/x", "x", ""]
        {
            assert_eq!(keys.topic_of(foreign), None, "{foreign}");
            assert_eq!(keys.node_of_token(foreign), None, "{foreign}");
        }
    }

    #[test]
    fn a_node_subscribes_to_what_it_reads_and_to_nothing_else() {
        use zenoh::key_expr::KeyExpr;
        let keys = keys();
        for node in Topic::nodes(12) {
            let subscribed: Vec<KeyExpr> =
                keys.read_by(node).into_iter().map(|k| k.try_into().expect("a key expression")).collect();
            for topic in Topic::all(12) {
                let key: KeyExpr = keys.topic(topic).try_into().expect("a key expression");
                let times = subscribed.iter().filter(|s| s.intersects(&key)).count();
                assert_eq!(times, usize::from(topic.read_by(node)), "{topic} at {node}");
            }
        }
    }

    #[test]
    fn a_stamp_survives_and_orders_sessions_first() {
        let (old, new) = (Stamp { session: 1, number: 9 }, Stamp { session: 2, number: 1 });
        assert!(old < new);
        assert_eq!(Stamp::from_bytes(&old.to_bytes()), Some(old));
        assert_eq!(Stamp::from_bytes(&[0; 15]), None);
        assert_eq!(Stamp::from_bytes(&[0; 17]), None);
    }
}
