//! Who has an endpoint, which services connect them, and how large those are: in closed form, so that a
//! team of thousands costs no more thought than one of two.
//!
//! Topics are many, services few. What goes *to* robots has one service per seat; what comes *from* them
//! shares a service with [`SHARD`] seats, so that nothing has many publishers and many subscribers at once
//! (iceoryx2 makes a segment of memory for each pair).

use std::fmt;
use std::ops::Range;

use lamma_protocol::{AgentId, Node, Topic};

/// Seats that share a service towards the coordinator or the simulator. The reader looks at every
/// connection of a service for each sample, and keeps the last words of at most 128 that have left.
pub(super) const SHARD: u16 = 64;

/// Who has an endpoint of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Party {
    /// The supervisor.
    Supervisor,
    /// The coordinator.
    Coordinator,
    /// The simulator.
    Simulator,
    /// A process that hosts robots: one, or as many as [`Layout::per_seat`] says.
    Seat(u16),
}

impl fmt::Display for Party {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Party::Supervisor => f.write_str("supervisor"),
            Party::Coordinator => f.write_str("coordinator"),
            Party::Simulator => f.write_str("simulator"),
            Party::Seat(s) => write!(f, "seat-{s}"),
        }
    }
}

/// A data service.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Line {
    /// [`Topic::Command`].
    Command,
    /// [`Topic::Outcome`].
    Outcome,
    /// [`Topic::Grant`].
    Grant,
    /// [`Topic::Vocabulary`].
    Vocabulary,
    /// [`Topic::Frame`].
    Frame,
    /// Directives and acknowledgements for the robots of one seat.
    Orders(u16),
    /// Reports from the seats of one shard.
    Reports(u16),
    /// Requests from the seats of one shard.
    Requests(u16),
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Line::Command => Topic::Command.fmt(f),
            Line::Outcome => Topic::Outcome.fmt(f),
            Line::Grant => Topic::Grant.fmt(f),
            Line::Vocabulary => Topic::Vocabulary.fmt(f),
            Line::Frame => Topic::Frame.fmt(f),
            Line::Orders(s) => write!(f, "seat/{s}/orders"),
            Line::Reports(k) => write!(f, "shard/{k}/reports"),
            Line::Requests(k) => write!(f, "shard/{k}/requests"),
        }
    }
}

impl Line {
    /// A topic that the service carries, to speak of it.
    pub(super) fn any_topic(self) -> Topic {
        match self {
            Line::Command => Topic::Command,
            Line::Outcome => Topic::Outcome,
            Line::Grant => Topic::Grant,
            Line::Vocabulary => Topic::Vocabulary,
            Line::Frame => Topic::Frame,
            Line::Orders(seat) => Topic::Directive(AgentId(seat)),
            Line::Reports(shard) => Topic::Report(AgentId(shard * SHARD)),
            Line::Requests(shard) => Topic::Request(AgentId(shard * SHARD)),
        }
    }
}

/// The shape of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) agents: u16,
    /// Robots that share an endpoint; at least 1.
    pub(super) per_seat: u16,
}

impl Layout {
    pub(super) fn seats(self) -> u16 {
        self.agents.div_ceil(self.per_seat)
    }

    pub(super) fn shards(self) -> u16 {
        self.seats().div_ceil(SHARD)
    }

    /// The robots of a seat.
    pub(super) fn agents_of(self, seat: u16) -> Range<u16> {
        let first = seat.saturating_mul(self.per_seat).min(self.agents);
        first..first.saturating_add(self.per_seat).min(self.agents)
    }

    /// Whose endpoint speaks for `node`; None if the team has no such member.
    pub(super) fn party(self, node: Node) -> Option<Party> {
        match node {
            Node::Supervisor => Some(Party::Supervisor),
            Node::Coordinator => Some(Party::Coordinator),
            Node::Simulator => Some(Party::Simulator),
            Node::Robot(AgentId(a)) => (a < self.agents).then_some(Party::Seat(a / self.per_seat)),
        }
    }

    /// The service that carries a topic. The topic must be one of the team's.
    pub(super) fn line(self, topic: Topic) -> Line {
        let seat = |a: AgentId| a.0 / self.per_seat;
        match topic {
            Topic::Command => Line::Command,
            Topic::Outcome => Line::Outcome,
            Topic::Grant => Line::Grant,
            Topic::Vocabulary => Line::Vocabulary,
            Topic::Frame => Line::Frame,
            Topic::Directive(a) | Topic::Ack(a) => Line::Orders(seat(a)),
            Topic::Report(a) => Line::Reports(seat(a) / SHARD),
            Topic::Request(a) => Line::Requests(seat(a) / SHARD),
        }
    }

    /// All services, in a fixed order.
    pub(super) fn lines(self) -> impl Iterator<Item = Line> {
        let fixed = [Line::Command, Line::Outcome, Line::Grant, Line::Vocabulary, Line::Frame];
        let orders = (0..self.seats()).map(Line::Orders);
        let shards = (0..self.shards()).flat_map(|k| [Line::Reports(k), Line::Requests(k)]);
        fixed.into_iter().chain(orders).chain(shards)
    }

    /// All parties, in a fixed order.
    #[cfg(test)]
    pub(super) fn parties(self) -> impl Iterator<Item = Party> {
        let fixed = [Party::Supervisor, Party::Coordinator, Party::Simulator];
        fixed.into_iter().chain((0..self.seats()).map(Party::Seat))
    }

    /// The services that `party` reads, in a fixed order.
    pub(super) fn read_by(self, party: Party) -> Vec<Line> {
        match party {
            Party::Supervisor => vec![Line::Outcome],
            Party::Coordinator => [Line::Command, Line::Vocabulary, Line::Frame]
                .into_iter()
                .chain((0..self.shards()).map(Line::Reports))
                .collect(),
            Party::Simulator => [Line::Command, Line::Grant]
                .into_iter()
                .chain((0..self.shards()).map(Line::Requests))
                .collect(),
            Party::Seat(s) => vec![Line::Command, Line::Frame, Line::Orders(s)],
        }
    }

    /// The services that `party` publishes on, in a fixed order.
    pub(super) fn published_by(self, party: Party) -> Vec<Line> {
        let orders = (0..self.seats()).map(Line::Orders);
        match party {
            Party::Supervisor => vec![Line::Command],
            Party::Coordinator => [Line::Outcome, Line::Grant].into_iter().chain(orders).collect(),
            Party::Simulator => [Line::Vocabulary, Line::Frame].into_iter().chain(orders).collect(),
            Party::Seat(s) => vec![Line::Reports(s / SHARD), Line::Requests(s / SHARD)],
        }
    }

    /// Who reads a service.
    pub(super) fn readers(self, line: Line) -> Vec<Party> {
        let seats = (0..self.seats()).map(Party::Seat);
        match line {
            Line::Command => [Party::Coordinator, Party::Simulator].into_iter().chain(seats).collect(),
            Line::Outcome => vec![Party::Supervisor],
            Line::Grant => vec![Party::Simulator],
            Line::Vocabulary => vec![Party::Coordinator],
            Line::Frame => std::iter::once(Party::Coordinator).chain(seats).collect(),
            Line::Orders(s) => vec![Party::Seat(s)],
            Line::Reports(_) => vec![Party::Coordinator],
            Line::Requests(_) => vec![Party::Simulator],
        }
    }

    /// How many parties publish on a service.
    pub(super) fn publishers(self, line: Line) -> usize {
        match line {
            Line::Command | Line::Outcome | Line::Grant | Line::Vocabulary | Line::Frame => 1,
            Line::Orders(_) => 2,
            Line::Reports(k) | Line::Requests(k) => {
                usize::from(self.seats().saturating_sub(k.saturating_mul(SHARD)).min(SHARD))
            }
        }
    }

    /// How many topics one publisher has on a service. With one, a buffer of one keeps the newest; with
    /// more, the buffer must hold some statements of each, and losses must be noticed.
    pub(super) fn topics_per_publisher(self, line: Line) -> usize {
        match line {
            Line::Command | Line::Outcome | Line::Grant | Line::Vocabulary | Line::Frame => 1,
            Line::Orders(s) => self.agents_of(s).len(),
            Line::Reports(_) | Line::Requests(_) => usize::from(self.per_seat.min(self.agents).max(1)),
        }
    }

    /// Whether `party` publishes on the service.
    pub(super) fn publishes(self, party: Party, line: Line) -> bool {
        match line {
            Line::Command => party == Party::Supervisor,
            Line::Outcome | Line::Grant => party == Party::Coordinator,
            Line::Vocabulary | Line::Frame => party == Party::Simulator,
            Line::Orders(_) => matches!(party, Party::Coordinator | Party::Simulator),
            Line::Reports(k) | Line::Requests(k) => matches!(party, Party::Seat(s) if s / SHARD == k),
        }
    }

    /// What an event on the bell of `owner` means when `line` has something new: the index of the service
    /// among those it reads. None if it does not read it.
    pub(super) fn news(self, owner: Party, line: Line) -> Option<usize> {
        match (owner, line) {
            (Party::Supervisor, Line::Outcome) => Some(0),
            (Party::Coordinator | Party::Simulator | Party::Seat(_), Line::Command) => Some(0),
            (Party::Coordinator, Line::Vocabulary) | (Party::Simulator, Line::Grant) => Some(1),
            (Party::Seat(_), Line::Frame) => Some(1),
            (Party::Coordinator, Line::Frame) => Some(2),
            (Party::Coordinator, Line::Reports(k)) => Some(3 + usize::from(k)),
            (Party::Simulator, Line::Requests(k)) => Some(2 + usize::from(k)),
            (Party::Seat(s), Line::Orders(o)) if s == o => Some(2),
            _ => None,
        }
    }

    /// The event on the bell of `owner` that says that `peer` has joined. None if they are no peers.
    pub(super) fn joined(self, owner: Party, peer: Party) -> Option<usize> {
        let lines = self.lines_read_by(owner);
        let place = match (owner, peer) {
            (Party::Seat(_), Party::Seat(_)) => return None,
            (_, Party::Seat(s)) => 3 + usize::from(s),
            (_, Party::Supervisor) => 0,
            (_, Party::Coordinator) => 1,
            (_, Party::Simulator) => 2,
        };
        (owner != peer).then_some(lines + place)
    }

    /// How many services `owner` reads.
    fn lines_read_by(self, owner: Party) -> usize {
        match owner {
            Party::Supervisor => 1,
            Party::Coordinator => 3 + usize::from(self.shards()),
            Party::Simulator => 2 + usize::from(self.shards()),
            Party::Seat(_) => 3,
        }
    }

    /// How many events the bell of `owner` has.
    pub(super) fn events(self, owner: Party) -> usize {
        self.lines_read_by(owner) + 3 + if matches!(owner, Party::Seat(_)) { 0 } else { self.seats().into() }
    }

    /// Whom `party` exchanges something with, in a fixed order.
    pub(super) fn peers(self, party: Party) -> Vec<Party> {
        let seats = (0..self.seats()).map(Party::Seat);
        match party {
            Party::Seat(_) => vec![Party::Supervisor, Party::Coordinator, Party::Simulator],
            Party::Supervisor | Party::Coordinator | Party::Simulator => {
                let others = [Party::Supervisor, Party::Coordinator, Party::Simulator];
                others.into_iter().filter(|p| *p != party).chain(seats).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed forms say what [`Topic`] says, for teams around the edges of seats and shards.
    #[test]
    fn the_layout_agrees_with_the_topics() {
        for (agents, per_seat) in [(0, 1), (1, 1), (3, 1), (64, 1), (65, 1), (7, 3), (130, 2)] {
            let layout = Layout { agents, per_seat };
            for topic in Topic::all(agents) {
                let line = layout.line(topic);
                let publisher = layout.party(topic.publisher()).expect("a member");
                assert!(layout.published_by(publisher).contains(&line), "{publisher} publishes {line}");
                for node in Topic::nodes(agents).into_iter().filter(|n| topic.read_by(*n)) {
                    let reader = layout.party(node).expect("a member");
                    assert!(layout.readers(line).contains(&reader), "{reader} reads {line}");
                    assert!(layout.read_by(reader).contains(&line), "{reader} reads {line}");
                    assert!(layout.peers(reader).contains(&publisher), "{reader} and {publisher} are peers");
                    assert!(layout.peers(publisher).contains(&reader), "{publisher} and {reader} are peers");
                }
            }
            for line in layout.lines() {
                let publishers = layout.parties().filter(|p| layout.published_by(*p).contains(&line));
                assert_eq!(publishers.count(), layout.publishers(line), "{line} of {layout:?}");
                let readers = layout.parties().filter(|p| layout.read_by(*p).contains(&line));
                assert_eq!(readers.collect::<Vec<_>>(), layout.readers(line), "{line} of {layout:?}");
            }
            for party in layout.parties() {
                assert_eq!(layout.lines_read_by(party), layout.read_by(party).len(), "{party} of {layout:?}");
                let news = layout.read_by(party).into_iter().map(|l| layout.news(party, l));
                let joined = layout.peers(party).into_iter().map(|p| layout.joined(party, p));
                let events: Vec<usize> = news.chain(joined).map(|e| e.expect("an event")).collect();
                let distinct: std::collections::BTreeSet<usize> = events.iter().copied().collect();
                assert_eq!(distinct.len(), events.len(), "each event of {party} has one meaning");
                assert!(events.iter().all(|e| *e < layout.events(party)), "{party} has room for its events");
                for (at, line) in layout.read_by(party).into_iter().enumerate() {
                    assert_eq!(layout.news(party, line), Some(at), "{line} of {party}");
                }
                for line in layout.lines() {
                    let publishes = layout.published_by(party).contains(&line);
                    assert_eq!(layout.publishes(party, line), publishes, "{party}, {line}");
                }
            }
            let all: Vec<u16> = (0..layout.seats()).flat_map(|s| layout.agents_of(s)).collect();
            assert_eq!(all, (0..agents).collect::<Vec<_>>(), "every robot has one seat");
        }
    }

    #[test]
    fn the_service_that_fans_in_is_bounded_whatever_the_team() {
        let layout = Layout { agents: 10_000, per_seat: 1 };
        assert!(layout.lines().all(|l| layout.publishers(l) <= usize::from(SHARD)));
    }
}
