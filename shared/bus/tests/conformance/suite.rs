//! The promises of [`lamma_bus::Bus`], for any transport.
//!
//! No test asserts how long something takes: waits have a generous end only so that a broken transport
//! fails instead of hanging.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::time::{Duration, Instant};

use lamma_bus::{Bus, PublishError, Received};
use lamma_protocol::message::{Ack, Act, Command, Directive, Grant, Order, Outcome, Report, Request};
use lamma_protocol::message::{Verdict, Vocabulary};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, codec, frame,
};

use super::Fixture;

pub(super) const R0: AgentId = AgentId(0);
pub(super) const R1: AgentId = AgentId(1);
pub(super) const PATIENCE: Duration = Duration::from_secs(20);

fn envelope(number: u64, message: Message) -> Envelope {
    Envelope { revision: Revision { incarnation: 0, number }, message }
}

/// A message that fits `topic`, told apart by its revision.
pub(super) fn sample(topic: Topic, number: u64) -> Envelope {
    let epoch = Epoch(number);
    let step = StepIndex(0);
    envelope(
        number,
        match topic {
            Topic::Command => Message::Command(Command::default()),
            Topic::Outcome => Message::Outcome(Outcome {
                phase: "Planning".into(),
                first_event: 0,
                events: vec![],
                result: None,
            }),
            Topic::Grant => Message::Grant(Grant { epoch, lost: vec![] }),
            Topic::Directive(_) => Message::Directive(Directive { epoch, order: Order::Stand }),
            Topic::Report(_) => Message::Report(Report {
                epoch,
                pid: 1,
                plans: vec![],
                done: step,
                refused: None,
                broken: None,
                share: None,
            }),
            Topic::Request(_) => Message::Request(Request {
                epoch,
                step,
                act: Act { action: "a".into(), args: vec![] },
                gates: vec![],
            }),
            Topic::Ack(_) => Message::Ack(Ack { epoch, step, verdict: Verdict::Applied { version: number } }),
            Topic::Vocabulary | Topic::Frame => Message::Vocabulary(Vocabulary { facts: vec![] }),
        },
    )
}

/// A frame of this version with so many facts.
pub(super) fn words(version: u64, facts: u32) -> Vec<u64> {
    let header = FrameHeader { version, facts, progress: vec![StepIndex(0); 2], ..FrameHeader::default() };
    frame::write_frame(&header, &vec![version; facts.div_ceil(64) as usize])
}

/// What was received, as plain data.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Got {
    Message(Topic, Envelope),
    Frame(Vec<u64>),
    Hint(AgentId),
}

impl Got {
    pub(super) fn topic(&self) -> Option<Topic> {
        match self {
            Got::Message(topic, _) => Some(*topic),
            Got::Frame(_) => Some(Topic::Frame),
            Got::Hint(_) => None,
        }
    }

    pub(super) fn number(&self) -> u64 {
        match self {
            Got::Message(_, envelope) => envelope.revision.number,
            Got::Frame(words) => words[2],
            Got::Hint(_) => 0,
        }
    }
}

pub(super) fn receive<B: Bus>(bus: &mut B) -> Vec<Got> {
    let mut got = Vec::new();
    let count = bus.receive(&mut |received| {
        got.push(match received {
            Received::Message(topic, envelope) => Got::Message(topic, envelope),
            Received::Frame(frame) => Got::Frame(frame.words().to_vec()),
            Received::PeerHint(agent) => Got::Hint(agent),
        });
    });
    assert_eq!(count, got.len(), "the count returned is what was handed over");
    got
}

/// Lets `reader` wait and read until it has statement `number` of `topic`, while `others` live on.
pub(super) fn until<B: Bus>(reader: &mut B, topic: Topic, number: u64, others: &mut [&mut B]) -> Vec<Got> {
    let mut all = Vec::new();
    let end = Instant::now() + PATIENCE;
    loop {
        for other in &mut *others {
            other.wait(Some(Duration::ZERO)).unwrap();
            receive(*other);
        }
        all.extend(receive(reader));
        if all.iter().any(|g| g.topic() == Some(topic) && g.number() == number) {
            return all;
        }
        assert!(Instant::now() < end, "statement {number} of {topic} did not arrive; got {all:?}");
        reader.wait(Some(Duration::from_millis(20))).unwrap();
    }
}

/// Lets all live for a moment, so that they know of each other.
pub(super) fn settle<B: Bus>(all: &mut [&mut B]) {
    for _ in 0..5 {
        for bus in &mut *all {
            bus.wait(Some(Duration::from_millis(2))).unwrap();
            receive(*bus);
        }
    }
}

/// Of many statements the newest is handed over, and nothing after it; before it at most what was the newest at
/// some time.
fn assert_newest<F: Fixture>(got: &[Got], newest: &Got) {
    assert_eq!(got.last(), Some(newest), "the newest is handed over");
    assert!(got.windows(2).all(|w| w[0].number() < w[1].number()), "something is handed over late: {got:?}");
    assert!(!F::IMMEDIATE || got.len() == 1, "only the newest is handed over: {got:?}");
}

pub fn newest_wins<F: Fixture>() {
    let bus = F::new(2);
    let (mut robot, mut coordinator) = (bus.open(Node::Robot(R0)), bus.open(Node::Coordinator));
    settle(&mut [&mut robot, &mut coordinator]);
    let topic = Topic::Directive(R0);
    for number in 1..=50 {
        coordinator.publish(topic, &sample(topic, number)).unwrap();
    }
    let got = until(&mut robot, topic, 50, &mut [&mut coordinator]);
    assert_newest::<F>(&got, &Got::Message(topic, sample(topic, 50)));
}

pub fn newest_wins_for_frames<F: Fixture>() {
    let bus = F::new(2);
    let (mut robot, mut simulator) = (bus.open(Node::Robot(R0)), bus.open(Node::Simulator));
    settle(&mut [&mut robot, &mut simulator]);
    for version in 1..=50 {
        simulator.publish_frame(&words(version, 100)).unwrap();
    }
    let got = until(&mut robot, Topic::Frame, 50, &mut [&mut simulator]);
    assert_newest::<F>(&got, &Got::Frame(words(50, 100)));
}

pub fn every_topic_reaches_exactly_its_readers<F: Fixture>() {
    let bus = F::new(2);
    let nodes = Topic::nodes(2);
    let mut ends: Vec<F::Endpoint> = nodes.iter().map(|n| bus.open(*n)).collect();
    settle(&mut ends.iter_mut().collect::<Vec<_>>());
    for (topic, number) in Topic::all(2).into_iter().zip(1..) {
        let publisher = nodes.iter().position(|n| *n == topic.publisher()).unwrap();
        match topic {
            Topic::Frame => ends[publisher].publish_frame(&words(number, 3)).unwrap(),
            _ => ends[publisher].publish(topic, &sample(topic, number)).unwrap(),
        }
        for (node, end) in nodes.iter().zip(&mut ends) {
            let got = if topic.read_by(*node) { until(end, topic, number, &mut []) } else { receive(end) };
            let expected = usize::from(topic.read_by(*node));
            assert_eq!(got.len(), expected, "{topic} at {node}: {got:?}");
        }
    }
}

pub fn statements_come_in_order_or_not_at_all<F: Fixture>() {
    let bus = F::new(1);
    let (mut robot, mut coordinator) = (bus.open(Node::Robot(R0)), bus.open(Node::Coordinator));
    settle(&mut [&mut robot, &mut coordinator]);
    let topic = Topic::Directive(R0);
    let mut seen = Vec::new();
    for number in 1..=300 {
        coordinator.publish(topic, &sample(topic, number)).unwrap();
        if number % 3 == 0 {
            seen.extend(receive(&mut robot).iter().map(Got::number));
        }
    }
    if !F::IMMEDIATE {
        seen.extend(until(&mut robot, topic, 300, &mut [&mut coordinator]).iter().map(Got::number));
    }
    assert!(seen.windows(2).all(|w| w[0] < w[1]), "out of order: {seen:?}");
    assert!(!seen.is_empty(), "a polling reader sees something without waiting");
}

pub fn nothing_new_is_nothing_received<F: Fixture>() {
    let bus = F::new(1);
    let (mut robot, mut simulator) = (bus.open(Node::Robot(R0)), bus.open(Node::Simulator));
    assert_eq!(receive(&mut robot), []);
    simulator.publish_frame(&words(1, 3)).unwrap();
    until(&mut robot, Topic::Frame, 1, &mut [&mut simulator]);
    settle(&mut [&mut simulator]);
    assert_eq!(receive(&mut robot), [], "a statement is handed over once");
    assert_eq!(robot.stats().received, 1);
    assert_eq!(simulator.stats().published, 1);
}

pub fn a_late_joiner_gets_the_newest<F: Fixture>() {
    let bus = F::new(2);
    let mut simulator = bus.open(Node::Simulator);
    let ack = Topic::Ack(R1);
    for number in 1..=3 {
        simulator.publish_frame(&words(number, 100)).unwrap();
        simulator.publish(ack, &sample(ack, number)).unwrap();
    }
    let mut robot = bus.open(Node::Robot(R1));
    let mut got = until(&mut robot, Topic::Frame, 3, &mut [&mut simulator]);
    if !got.iter().any(|g| g.topic() == Some(ack)) {
        got.extend(until(&mut robot, ack, 3, &mut [&mut simulator]));
    }
    assert_eq!(got.len(), 2, "{got:?}");
}

pub fn a_reader_may_be_there_before_the_publisher<F: Fixture>() {
    let bus = F::new(1);
    let mut robot = bus.open(Node::Robot(R0));
    assert_eq!(receive(&mut robot), []);
    let mut simulator = bus.open(Node::Simulator);
    simulator.publish_frame(&words(1, 3)).unwrap();
    until(&mut robot, Topic::Frame, 1, &mut [&mut simulator]);
}

pub fn a_restarted_reader_gets_the_newest<F: Fixture>() {
    let bus = F::new(1);
    let mut coordinator = bus.open(Node::Coordinator);
    let topic = Topic::Directive(R0);
    for number in 1..=20 {
        let mut robot = bus.open(Node::Robot(R0));
        coordinator.publish(topic, &sample(topic, number)).unwrap();
        until(&mut robot, topic, number, &mut [&mut coordinator]);
        drop(robot);
        let mut robot = bus.open(Node::Robot(R0));
        until(&mut robot, topic, number, &mut [&mut coordinator]);
    }
}

pub fn a_restarted_publisher_is_heard<F: Fixture>() {
    let bus = F::new(1);
    let mut robot = bus.open(Node::Robot(R0));
    for number in 1..=20 {
        let mut simulator = bus.open(Node::Simulator);
        simulator.publish_frame(&words(number, 3)).unwrap();
        until(&mut robot, Topic::Frame, number, &mut [&mut simulator]);
    }
}

pub fn last_words_are_heard_after_a_publisher_has_left<F: Fixture>() {
    let bus = F::new(1);
    let (mut supervisor, mut coordinator) = (bus.open(Node::Supervisor), bus.open(Node::Coordinator));
    coordinator.publish(Topic::Outcome, &sample(Topic::Outcome, 1)).unwrap();
    until(&mut supervisor, Topic::Outcome, 1, &mut [&mut coordinator]);
    // The outcome is small all through the run and large at its end.
    let mut last = sample(Topic::Outcome, 2);
    let Message::Outcome(outcome) = &mut last.message else { unreachable!() };
    outcome.result = Some("x".repeat(1 << 20));
    coordinator.publish(Topic::Outcome, &last).unwrap();
    drop(coordinator);
    until(&mut supervisor, Topic::Outcome, 2, &mut []);
}

pub fn only_the_publisher_publishes<F: Fixture>() {
    let bus = F::new(2);
    for node in Topic::nodes(2) {
        let mut end = bus.open(node);
        for topic in Topic::all(2).into_iter().filter(|t| t.publisher() != node) {
            let result = match topic {
                Topic::Frame => end.publish_frame(&words(1, 1)),
                _ => end.publish(topic, &sample(topic, 1)),
            };
            assert!(
                matches!(result, Err(PublishError::NotPublisher { .. })),
                "{node} on {topic}: {result:?}"
            );
        }
    }
    let mut coordinator = bus.open(Node::Coordinator);
    let absent = Topic::Directive(AgentId(2));
    let result = coordinator.publish(absent, &sample(absent, 1));
    assert!(matches!(result, Err(PublishError::NoSuchTopic { .. })), "{result:?}");
    let result = bus.open(Node::Simulator).publish_bytes(Topic::Frame, b"bytes");
    assert!(matches!(result, Err(PublishError::BytesOnFrame)), "{result:?}");
}

/// Publishes bad bytes, then a good message; returns the endpoint that refused the first.
fn refusal<F: Fixture>(bytes: &[u8]) -> F::Endpoint {
    let bus = F::new(1);
    let (mut robot, mut coordinator) = (bus.open(Node::Robot(R0)), bus.open(Node::Coordinator));
    settle(&mut [&mut robot, &mut coordinator]);
    let topic = Topic::Directive(R0);
    coordinator.publish_bytes(topic, bytes).unwrap();
    let end = Instant::now() + PATIENCE;
    while robot.stats().refused == 0 {
        assert!(Instant::now() < end, "bad bytes were not noticed");
        robot.wait(Some(Duration::from_millis(20))).unwrap();
        assert_eq!(receive(&mut robot), []);
    }
    assert_eq!(robot.stats().refused, 1);
    coordinator.publish(topic, &sample(topic, 7)).unwrap();
    until(&mut robot, topic, 7, &mut [&mut coordinator]);
    robot
}

pub fn foreign_bytes_are_dropped_and_counted<F: Fixture>() {
    let mut corrupt = codec::encode(&sample(Topic::Grant, 1)).unwrap();
    corrupt[12] ^= 1;
    for bytes in [&b""[..], b"x", b"LAMM", &[0; 5000], &corrupt] {
        let robot = refusal::<F>(bytes);
        let (topic, _) = robot.stats().last_refusal.clone().unwrap();
        assert_eq!(topic, Topic::Directive(R0));
    }
}

pub fn another_version_is_refused_by_name<F: Fixture>() {
    let mut bytes = codec::encode(&sample(Topic::Grant, 1)).unwrap();
    bytes[4..6].copy_from_slice(&(codec::WIRE_VERSION + 1).to_le_bytes());
    let robot = refusal::<F>(&bytes);
    let (_, reason) = robot.stats().last_refusal.clone().unwrap();
    assert!(reason.contains(&format!("wire version {}", codec::WIRE_VERSION + 1)), "{reason}");
}

pub fn a_message_too_large_is_refused_at_the_sender<F: Fixture>() {
    let bus = F::new(1);
    let mut coordinator = bus.open(Node::Coordinator);
    let result = coordinator.publish_bytes(Topic::Grant, &vec![0; codec::MAX_MESSAGE_BYTES + 1]);
    assert!(matches!(result, Err(PublishError::Encode { .. })), "{result:?}");
}

pub fn foreign_words_are_no_frame<F: Fixture>() {
    let bus = F::new(1);
    let (mut robot, mut simulator) = (bus.open(Node::Robot(R0)), bus.open(Node::Simulator));
    settle(&mut [&mut robot, &mut simulator]);
    simulator.publish_frame(&words(1, 1000)[..9]).unwrap();
    let end = Instant::now() + PATIENCE;
    while robot.stats().refused == 0 {
        assert!(Instant::now() < end, "a frame cut short was not noticed");
        robot.wait(Some(Duration::from_millis(20))).unwrap();
        assert_eq!(receive(&mut robot), []);
    }
    simulator.publish_frame(&words(2, 1000)).unwrap();
    until(&mut robot, Topic::Frame, 2, &mut [&mut simulator]);
}

pub fn a_large_message_and_a_large_frame_arrive<F: Fixture>() {
    let bus = F::new(1);
    let (mut coordinator, mut simulator) = (bus.open(Node::Coordinator), bus.open(Node::Simulator));
    settle(&mut [&mut coordinator, &mut simulator]);
    for (number, facts) in (1..).zip([1u32, 1_000, 10_000, 100_000, 30]) {
        let facts_text = (0..facts).map(|i| format!("(at-location Object_{i} Place_{i})")).collect();
        let message = Message::Vocabulary(Vocabulary { facts: facts_text });
        simulator.publish(Topic::Vocabulary, &envelope(number, message.clone())).unwrap();
        simulator.publish_frame(&words(number, facts)).unwrap();
        let mut got = until(&mut coordinator, Topic::Vocabulary, number, &mut [&mut simulator]);
        if !got.contains(&Got::Frame(words(number, facts))) {
            got.extend(until(&mut coordinator, Topic::Frame, number, &mut [&mut simulator]));
        }
        assert!(got.contains(&Got::Message(Topic::Vocabulary, envelope(number, message))), "{facts} facts");
        assert!(got.contains(&Got::Frame(words(number, facts))), "{facts} facts");
    }
}

pub fn a_reader_that_never_reads_blocks_nobody<F: Fixture>() {
    let bus = F::new(2);
    let (deaf, mut robot) = (bus.open(Node::Robot(R0)), bus.open(Node::Robot(R1)));
    let mut simulator = bus.open(Node::Simulator);
    settle(&mut [&mut robot, &mut simulator]);
    for number in 1..=2_000 {
        simulator.publish_frame(&words(number, 64)).unwrap();
        for agent in [R0, R1] {
            simulator.publish(Topic::Ack(agent), &sample(Topic::Ack(agent), number)).unwrap();
        }
    }
    until(&mut robot, Topic::Frame, 2_000, &mut [&mut simulator]);
    drop(deaf);
}
