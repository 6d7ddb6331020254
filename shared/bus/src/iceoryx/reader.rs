//! The receiving half: what one party reads from one service.

use std::collections::BTreeMap;

use iceoryx2::identifiers::UniquePublisherId;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::*;
use lamma_protocol::{Envelope, Frame, Topic, codec};

use super::OpenError;
use super::layout::{Layout, Line, Party};
use super::services::{Handle, depth};
use super::writer::Head;
use crate::{Inbox, Received};

/// How often a look at one service may find something newer before the others have their turn, beside what
/// its buffers hold.
const PATIENCE: usize = 16;

/// What a party reads from one service.
pub(super) struct Reader {
    pub(super) line: Line,
    port: ReaderPort,
    /// Whether there may be news.
    pub(super) news: bool,
    layout: Layout,
    /// How much one look takes at most.
    patience: usize,
    /// The last number of each publisher, where its buffer may overflow.
    numbers: Option<Vec<(UniquePublisherId, u64)>>,
}

enum ReaderPort {
    Bytes(Subscriber<ipc::Service, [u8], Head>),
    Words(Subscriber<ipc::Service, [u64], Head>),
}

impl Reader {
    pub(super) fn open(handle: &Handle, layout: Layout, line: Line) -> Result<Reader, OpenError> {
        let fail = |e| handle.error(line, e);
        let port = match line {
            Line::Frame => {
                ReaderPort::Words(handle.line(line, false)?.subscriber_builder().create().map_err(fail)?)
            }
            _ => ReaderPort::Bytes(handle.line(line, false)?.subscriber_builder().create().map_err(fail)?),
        };
        let numbers = (layout.topics_per_publisher(line) > 1).then(Vec::new);
        let patience = PATIENCE + layout.publishers(line) * depth(layout, line);
        Ok(Reader { line, port, news: true, layout, patience, numbers })
    }

    /// Hands over the newest of each topic that has something new, and gives how many those were. Who has
    /// said something that is lost goes into `lost`.
    pub(super) fn receive(
        &mut self,
        inbox: &mut Inbox,
        sink: &mut dyn FnMut(Received<'_>),
        lost: &mut Vec<Party>,
    ) -> usize {
        self.news = false;
        if let ReaderPort::Words(port) = &self.port {
            return usize::from(receive_frame(port, inbox, sink));
        }
        let newest = self.newest_messages(inbox, lost).into_iter();
        newest.map(|(topic, envelope)| usize::from(inbox.envelope(topic, envelope, sink))).sum()
    }

    /// The newest message of each topic. There is more than one only where a publisher has been followed by
    /// another, or speaks for many: the revision tells which is newer.
    fn newest_messages(&mut self, inbox: &mut Inbox, lost: &mut Vec<Party>) -> BTreeMap<Topic, Envelope> {
        let mut newest: BTreeMap<Topic, Envelope> = BTreeMap::new();
        let ReaderPort::Bytes(port) = &self.port else { return newest };
        let blame = self.line.any_topic();
        for taken in 0.. {
            if taken == self.patience {
                self.news = true;
                break;
            }
            let sample = match port.receive() {
                Ok(None) => break,
                Ok(Some(sample)) => sample,
                Err(error) => {
                    inbox.refuse(blame, &error);
                    continue;
                }
            };
            let head = sample.user_header();
            let Some(topic) = head.topic(self.layout, self.line) else {
                inbox.refuse(blame, &"a statement on a topic that this service does not carry");
                continue;
            };
            if let Some(numbers) = &mut self.numbers
                && is_gap(numbers, sample.origin(), head.number)
            {
                lost.extend(self.layout.party(topic.publisher()));
            }
            match codec::decode(sample.payload()) {
                Ok(envelope) if newest.get(&topic).is_none_or(|n| n.revision <= envelope.revision) => {
                    newest.insert(topic, envelope);
                }
                Ok(_) => {}
                Err(error) => {
                    inbox.refuse(topic, &error);
                }
            }
        }
        newest
    }
}

/// Whether statements of this publisher are missing before this number. Takes note of it.
fn is_gap(numbers: &mut Vec<(UniquePublisherId, u64)>, publisher: UniquePublisherId, number: u64) -> bool {
    match numbers.iter_mut().find(|(known, _)| *known == publisher) {
        Some((_, last)) => number != std::mem::replace(last, number) + 1,
        None => {
            // Publishers come again only when their process does.
            numbers.push((publisher, number));
            number != 1
        }
    }
}

/// Hands over the newest frame where it lies.
fn receive_frame(
    port: &Subscriber<ipc::Service, [u64], Head>,
    inbox: &mut Inbox,
    sink: &mut dyn FnMut(Received<'_>),
) -> bool {
    let mut newest = None;
    for _ in 0..PATIENCE {
        let sample = match port.receive() {
            Ok(None) => break,
            Ok(Some(sample)) => sample,
            Err(error) => {
                inbox.refuse(Topic::Frame, &error);
                continue;
            }
        };
        match Frame::new(sample.payload()).map(|f| f.version()) {
            Ok(version) if newest.as_ref().is_none_or(|(v, _)| *v <= version) => {
                newest = Some((version, sample));
            }
            Ok(_) => {}
            Err(error) => {
                inbox.refuse(Topic::Frame, &error);
            }
        }
    }
    newest.is_some_and(|(_, sample)| inbox.frame(sample.payload(), sink))
}
