//! The sending half: what one party publishes on one service.

use std::collections::BTreeMap;

use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::*;
use lamma_protocol::{AgentId, Topic, codec};

use super::OpenError;
use super::layout::{Layout, Line, Party};
use super::services::{Handle, LineService};
use crate::PublishError;

/// Bytes that a publisher has room for before its memory has to grow.
const ROOM: usize = 4 << 10;

/// The same where many statements wait at once.
const ROOM_OF_MANY: usize = 256;

/// Room for the one message that may grow at the very end: memory that grows when its owner leaves is
/// gone before the reader has mapped it. Untouched room costs nothing.
const ROOM_FOR_LAST_WORDS: usize = codec::MAX_MESSAGE_BYTES;

/// Words that the frame has room for before its memory has to grow.
const ROOM_FOR_FRAME: usize = 1 << 10;

type Port<T> = Publisher<ipc::Service, [T], Head>;

/// What lies beside every statement in shared memory.
#[derive(Clone, Copy, Debug, Default, ZeroCopySend)]
#[repr(C)]
pub(super) struct Head {
    /// Counts what one publisher says on one service, from 1.
    pub(super) number: u64,
    kind: u32,
    agent: u32,
}

impl Head {
    fn new(topic: Topic, number: u64) -> Head {
        let (kind, agent) = match topic {
            Topic::Command => (0, AgentId(0)),
            Topic::Outcome => (1, AgentId(0)),
            Topic::Grant => (2, AgentId(0)),
            Topic::Vocabulary => (3, AgentId(0)),
            Topic::Frame => (4, AgentId(0)),
            Topic::Directive(a) => (5, a),
            Topic::Report(a) => (6, a),
            Topic::Request(a) => (7, a),
            Topic::Ack(a) => (8, a),
        };
        Head { number, kind, agent: agent.0.into() }
    }

    /// The topic, if it is one of the team's and belongs on `line`.
    pub(super) fn topic(&self, layout: Layout, line: Line) -> Option<Topic> {
        let agent = AgentId(u16::try_from(self.agent).ok().filter(|a| *a < layout.agents.max(1))?);
        let topic = match self.kind {
            0 => Topic::Command,
            1 => Topic::Outcome,
            2 => Topic::Grant,
            3 => Topic::Vocabulary,
            4 => Topic::Frame,
            5 => Topic::Directive(agent),
            6 => Topic::Report(agent),
            7 => Topic::Request(agent),
            8 => Topic::Ack(agent),
            _ => return None,
        };
        (layout.line(topic) == line).then_some(topic)
    }
}

/// What a party publishes on one service.
pub(super) struct Writer {
    port: WriterPort,
    /// Whose bells to ring, and how.
    readers: Vec<(Party, usize)>,
    /// Statements so far.
    sent: u64,
    /// What was said last on each topic, where the transport's own history of one statement is too short.
    kept: Option<BTreeMap<Topic, Vec<u8>>>,
}

enum WriterPort {
    Bytes(Port<u8>),
    Words(Port<u64>),
}

/// What is published.
#[derive(Clone, Copy)]
pub(super) enum Content<'a> {
    /// A message.
    Bytes(&'a [u8]),
    /// A frame.
    Words(&'a [u64]),
}

impl Writer {
    pub(super) fn open(handle: &Handle, layout: Layout, line: Line) -> Result<Writer, OpenError> {
        let many = layout.topics_per_publisher(line) > 1;
        let port = match line {
            Line::Frame => WriterPort::Words(port(handle, line, ROOM_FOR_FRAME)?),
            Line::Outcome => WriterPort::Bytes(port(handle, line, ROOM_FOR_LAST_WORDS)?),
            _ => WriterPort::Bytes(port(handle, line, if many { ROOM_OF_MANY } else { ROOM })?),
        };
        let ring = |reader: Party| Some((reader, layout.news(reader, line)?));
        let readers = layout.readers(line).into_iter().filter_map(ring).collect();
        Ok(Writer { port, readers, sent: 0, kept: many.then(BTreeMap::new) })
    }

    /// Sends, and gives whose bells to ring, and how.
    pub(super) fn send(
        &mut self,
        topic: Topic,
        content: Content<'_>,
    ) -> Result<&[(Party, usize)], PublishError> {
        self.put(topic, content)?;
        if let (Some(kept), Content::Bytes(bytes)) = (&mut self.kept, content) {
            let last = kept.entry(topic).or_default();
            last.clear();
            last.extend_from_slice(bytes);
        }
        Ok(&self.readers)
    }

    fn put(&mut self, topic: Topic, content: Content<'_>) -> Result<(), PublishError> {
        let head = Head::new(topic, self.sent + 1);
        match (&self.port, content) {
            (WriterPort::Bytes(port), Content::Bytes(bytes)) => put(port, topic, head, bytes)?,
            (WriterPort::Words(port), Content::Words(words)) => put(port, topic, head, words)?,
            _ => return Err(PublishError::BytesOnFrame),
        }
        self.sent += 1;
        Ok(())
    }

    /// Connects to readers that have come since, and hands them what was said last. True if there was
    /// something.
    pub(super) fn welcome(&mut self) -> Result<bool, String> {
        let connected = match &self.port {
            WriterPort::Bytes(port) => port.update_connections(),
            WriterPort::Words(port) => port.update_connections(),
        };
        connected.map_err(|e| e.to_string())?;
        if let Some(kept) = self.kept.take() {
            let said = kept.iter().try_for_each(|(topic, bytes)| self.put(*topic, Content::Bytes(bytes)));
            self.kept = Some(kept);
            said.map_err(|e| e.to_string())?;
        }
        Ok(self.sent > 0)
    }
}

/// Fills a loan of shared memory and sends it.
fn put<T>(port: &Port<T>, topic: Topic, head: Head, content: &[T]) -> Result<(), PublishError>
where
    T: Copy + std::fmt::Debug + ZeroCopySend + 'static,
{
    let bytes = size_of_val(content);
    let loan = port.loan_slice_uninit(content.len());
    let mut loan = loan.map_err(|e| PublishError::Memory { topic, bytes, reason: e.to_string() })?;
    *loan.user_header_mut() = head;
    let sent = loan.write_from_slice(content).send();
    sent.map(|_| ()).map_err(|e| PublishError::Transport { topic, reason: e.to_string() })
}

fn port<T>(handle: &Handle, line: Line, room: usize) -> Result<Port<T>, OpenError>
where
    T: std::fmt::Debug + ZeroCopySend + 'static,
{
    let service: LineService<T> = handle.line(line, false)?;
    let builder = service.publisher_builder().initial_max_slice_len(room).max_loaned_samples(1);
    let builder = builder.allocation_strategy(AllocationStrategy::PowerOfTwo);
    // Overflow makes it needless; it says that sending never waits whatever the service is set to.
    let builder = builder.backpressure_strategy(BackpressureStrategy::DiscardData);
    builder.create().map_err(|e| handle.error(line, e))
}
