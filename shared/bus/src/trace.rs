//! Inputs as JSON lines: machines are pure, so what a machine was fed is its whole history.
//!
//! One line is `{"tick": 17, "node": "robot-0", "input": {...}}`, where the input is one of
//! `{"message": {"topic": "...", "envelope": ...}}`, `{"frame": [words]}`,
//! `{"done": {"job": 3, "answer": ...}}`, `{"peer_hint": 2}` and `"timeout"`.

use std::io::{self, Write};

use lamma_protocol::{AgentId, Envelope, Input, JobId, Node, Tick};
use serde::Serialize;

/// Writes a trace. The first failure ends it and is kept: a full disk must not end a run.
#[derive(Debug)]
pub struct Writer<W> {
    to: W,
    failed: Option<io::Error>,
}

#[derive(Serialize)]
struct Line<'a, Done> {
    tick: Tick,
    node: String,
    input: Entry<'a, Done>,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Entry<'a, Done> {
    Message { topic: String, envelope: &'a Envelope },
    Frame(&'a [u64]),
    Done { job: JobId, answer: &'a Done },
    PeerHint(AgentId),
    Timeout,
}

impl<W: Write> Writer<W> {
    /// A trace that goes to `to`, which should be buffered.
    pub fn new(to: W) -> Self {
        Writer { to, failed: None }
    }

    /// Writes one input.
    pub fn record<Done: Serialize>(&mut self, tick: Tick, node: Node, input: &Input<'_, Done>) {
        if self.failed.is_some() {
            return;
        }
        let input = match input {
            Input::Message(topic, envelope) => Entry::Message { topic: topic.to_string(), envelope },
            Input::Frame(frame) => Entry::Frame(frame.words()),
            Input::Done(job, answer) => Entry::Done { job: *job, answer },
            Input::PeerHint(agent) => Entry::PeerHint(*agent),
            Input::Timeout => Entry::Timeout,
        };
        let line = Line { tick, node: node.to_string(), input };
        let written = serde_json::to_writer(&mut self.to, &line).map_err(io::Error::from);
        if let Err(error) = written.and_then(|()| self.to.write_all(b"\n")) {
            tracing::warn!(%node, "the trace ends here: {error}");
            self.failed = Some(error);
        }
    }

    /// Flushes, and says whether all was written.
    pub fn finish(mut self) -> io::Result<W> {
        match self.failed.take() {
            Some(error) => Err(error),
            None => self.to.flush().map(|()| self.to),
        }
    }
}
