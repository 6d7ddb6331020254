//! A language model behind a chat-completions interface: the structured-output ladder, strict decoding with
//! bounded repair, and the account of tokens. How a request travels is the [`Transport`]'s business.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use thiserror::Error;

use crate::{
    Answer, LanguageModel, LmError, Request, Script, ScriptRequest, Wording, decode, prompt, script,
};

/// Tokens and requests used so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Usage {
    /// Answers received.
    pub requests: u64,
    /// Tokens sent.
    pub prompt_tokens: u64,
    /// Tokens received.
    pub completion_tokens: u64,
    /// Whether any of the numbers is an estimate (a token per four characters), because the server sent none.
    pub estimated: bool,
}

/// What a transport brings back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reply {
    /// The answer's text.
    pub content: String,
    /// Tokens sent and received, if the server said.
    pub usage: Option<(u64, u64)>,
}

/// Why a transport brings nothing back.
#[derive(Clone, Debug, Error, PartialEq, Serialize, Deserialize)]
pub enum TransportError {
    /// The server answered with a status that no further try would change.
    #[error("HTTP {status}: {body}")]
    Status {
        /// The HTTP status.
        status: u16,
        /// The start of the body.
        body: String,
    },
    /// The server could not be reached or did not answer in the protocol.
    #[error("{0}")]
    Connection(String),
    /// Out of time.
    #[error("out of time")]
    Deadline,
    /// The run is over.
    #[error("cancelled")]
    Cancelled,
    /// A cassette has no answer to this request, or cannot be read or written.
    #[error("{0}")]
    Cassette(String),
}

/// Sends one chat-completions request body and brings back the answer. Retries are its own business; the
/// deadline and the cancellation are not to be overrun.
pub trait Transport: Send {
    /// Sends a request.
    fn send(&mut self, body: &Value, deadline: Instant, cancel: &AtomicBool)
    -> Result<Reply, TransportError>;
}

/// The name and the JSON schema of an answer.
type Schema = (&'static str, Value);

/// How firmly the answer's form is asked for; the ladder goes down when a server refuses a rung.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Schema,
    JsonObject,
    Plain,
}

/// A chat model.
pub struct ChatModel<T> {
    transport: T,
    model: String,
    form: Form,
    /// Parameters the server has refused.
    refused: Vec<&'static str>,
    repairs: u32,
    wording: Wording,
    seed: u64,
    usage: Usage,
}

impl<T: Transport> ChatModel<T> {
    /// A model of that name over a transport, with at most `repairs` answers sent back for repair.
    pub fn new(transport: T, model: String, repairs: u32, seed: u64) -> Self {
        Self {
            transport,
            model,
            form: Form::Schema,
            refused: Vec::new(),
            repairs,
            wording: Wording::default(),
            seed,
            usage: Usage::default(),
        }
    }

    /// The same model, told and asked otherwise.
    pub fn worded(mut self, wording: Wording) -> Self {
        self.wording = wording;
        self
    }

    /// One answer in the firmest form the server takes.
    fn ask(
        &mut self,
        messages: &[Value],
        schema: &Schema,
        deadline: Instant,
        cancel: &AtomicBool,
    ) -> Result<Reply, TransportError> {
        loop {
            let body = self.body(messages, schema);
            let refusal = match self.transport.send(&body, deadline, cancel) {
                Ok(reply) => return Ok(reply),
                Err(TransportError::Status { status, body }) => (status, body),
                Err(other) => return Err(other),
            };
            if !self.give_way(refusal.0, &refusal.1) {
                return Err(TransportError::Status { status: refusal.0, body: refusal.1 });
            }
        }
    }

    fn body(&self, messages: &[Value], schema: &Schema) -> Value {
        let mut body = json!({"model": self.model, "messages": messages});
        for (name, value) in
            [("temperature", json!(0)), ("seed", json!(self.seed % (1 << 31))), ("max_tokens", json!(4096))]
        {
            if !self.refused.contains(&name) {
                body[name] = value;
            }
        }
        match self.form {
            Form::Schema => {
                let schema = json!({"name": schema.0, "strict": false, "schema": schema.1});
                body["response_format"] = json!({"type": "json_schema", "json_schema": schema});
            }
            Form::JsonObject => body["response_format"] = json!({"type": "json_object"}),
            Form::Plain => {}
        }
        body
    }

    /// Asks for less after a refusal, and remembers it; false when there is nothing less to ask for.
    fn give_way(&mut self, status: u16, body: &str) -> bool {
        if !matches!(status, 400 | 415 | 422 | 500 | 501) {
            return false;
        }
        let named = ["temperature", "seed", "max_tokens"]
            .into_iter()
            .find(|name| body.contains(name) && !self.refused.contains(name));
        if let Some(name) = named {
            self.refused.push(name);
            return true;
        }
        self.form = match self.form {
            Form::Schema => Form::JsonObject,
            Form::JsonObject => Form::Plain,
            Form::Plain => return false,
        };
        true
    }

    fn account(&mut self, messages: &[Value], reply: &Reply) {
        self.usage.requests += 1;
        let (sent, received) = reply.usage.unwrap_or_else(|| {
            self.usage.estimated = true;
            let sent: usize = messages.iter().filter_map(|m| m["content"].as_str()).map(str::len).sum();
            (sent as u64 / 4, reply.content.len() as u64 / 4)
        });
        self.usage.prompt_tokens += sent;
        self.usage.completion_tokens += received;
    }

    /// Asks until an answer can be read, and sends those that cannot back with what is wrong with them.
    fn insist<A>(
        &mut self,
        first: &[Value],
        schema: &Schema,
        request: &Request,
        cancel: &AtomicBool,
        read: &dyn Fn(&str) -> Result<A, Vec<String>>,
    ) -> Result<A, LmError> {
        let deadline = Instant::now() + request.deadline.min(Duration::from_secs(24 * 3600));
        let mut messages = first.to_vec();
        let mut last = String::new();
        for tries in 1..=self.repairs + 1 {
            if cancel.load(Ordering::Relaxed) {
                return Err(LmError::Cancelled);
            }
            let reply =
                self.ask(&messages, schema, deadline, cancel).map_err(|error| public(error, request))?;
            self.account(&messages, &reply);
            let errors = match read(&reply.content) {
                Ok(answer) => return Ok(answer),
                Err(errors) => errors,
            };
            last = errors.join("; ");
            if tries <= self.repairs {
                // Only the last answer goes back: earlier ones add length and no information.
                messages = first.to_vec();
                messages.extend(prompt::repair(&reply.content, &errors));
            }
        }
        Err(LmError::Unusable { tries: self.repairs + 1, last })
    }

    /// The transport, for tests and records.
    pub fn transport(&self) -> &T {
        &self.transport
    }
}

impl<T: Transport> LanguageModel for ChatModel<T> {
    fn name(&self) -> String {
        format!("openai {}", self.model)
    }

    fn decompose(&mut self, request: &Request, cancel: &AtomicBool) -> Result<Answer, LmError> {
        let first = prompt::messages(request, &self.wording);
        let schema = ("decomposition", prompt::schema());
        self.insist(&first, &schema, request, cancel, &|text: &str| decode::decode(text, request))
    }

    fn write(
        &mut self,
        asked: &ScriptRequest,
        check: &dyn Fn(&Script) -> Vec<String>,
        cancel: &AtomicBool,
    ) -> Result<Script, LmError> {
        let first = script::messages(asked, &self.wording);
        let read = |text: &str| {
            let script = script::decode(text, &asked.request)?;
            let errors = check(&script);
            if errors.is_empty() { Ok(script) } else { Err(errors) }
        };
        self.insist(&first, &("plan", script::schema()), &asked.request, cancel, &read)
    }

    fn usage(&self) -> Usage {
        self.usage
    }
}

fn public(error: TransportError, request: &Request) -> LmError {
    match error {
        TransportError::Deadline => LmError::Deadline(request.deadline.as_secs()),
        TransportError::Cancelled => LmError::Cancelled,
        TransportError::Cassette(text) => LmError::Configuration(text),
        TransportError::Status { status: status @ (401 | 403), body } => LmError::Endpoint(format!(
            "HTTP {status}: the key is missing or not accepted; set it in the environment variable named for it ({body})"
        )),
        other => LmError::Endpoint(other.to_string()),
    }
}
