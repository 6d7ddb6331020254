//! Chat completions over HTTP, for any OpenAI-compatible endpoint: retries, back-off, deadline.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::chat::{Reply, Transport, TransportError};

/// Longer response bodies are not read, in bytes.
const LONGEST_BODY: u64 = 1024 * 1024;
/// How often a waiting request looks for cancellation.
const POLL: Duration = Duration::from_millis(20);
/// The first and the longest pause between tries.
const PAUSE: (Duration, Duration) = (Duration::from_millis(500), Duration::from_secs(8));

/// An endpoint.
pub struct Http {
    url: String,
    key: Option<String>,
    retries: u32,
    random: u64,
    pause: (Duration, Duration),
    agent: ureq::Agent,
}

/// One try's failure: what it was, whether another may help, and how long the server asks to wait.
struct Failure {
    error: TransportError,
    again: bool,
    wait: Option<Duration>,
}

impl Http {
    /// An endpoint by its base URL (`https://host/v1`); `seed` draws the pauses between tries.
    pub fn new(base_url: &str, key: Option<String>, retries: u32, seed: u64) -> Self {
        let config = ureq::Agent::config_builder().http_status_as_error(false).max_redirects(0).build();
        Self {
            url: format!("{}/chat/completions", base_url.trim_end_matches('/')),
            key,
            retries,
            random: seed,
            pause: PAUSE,
            agent: config.into(),
        }
    }

    /// Other pauses between tries than the usual ones: the first, and the longest.
    pub fn with_pauses(mut self, first: Duration, longest: Duration) -> Self {
        self.pause = (first, longest);
        self
    }

    /// One try in a thread of its own, so that cancellation and deadline end the wait at once.
    fn once(&self, body: &str, deadline: Instant, cancel: &AtomicBool) -> Result<Reply, Failure> {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(last(TransportError::Deadline));
        }
        let (agent, url, key, body) =
            (self.agent.clone(), self.url.clone(), self.key.clone(), body.to_owned());
        let (sender, receiver) = mpsc::channel();
        std::thread::Builder::new()
            .name("lm-request".to_owned())
            .spawn(move || {
                // The receiver may be gone by then; the answer is of no use to anyone.
                let _ = sender.send(exchange(&agent, &url, key.as_deref(), &body, left));
            })
            .map_err(|error| {
                last(TransportError::Connection(format!("no thread for the request: {error}")))
            })?;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match receiver.recv_timeout(POLL.min(left.max(Duration::from_millis(1)))) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(last(TransportError::Connection("the request's thread ended".to_owned())));
                }
                Err(RecvTimeoutError::Timeout) if cancel.load(Ordering::Relaxed) => {
                    return Err(last(TransportError::Cancelled));
                }
                Err(RecvTimeoutError::Timeout) if left.is_zero() => {
                    return Err(last(TransportError::Deadline));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// Full jitter: anything up to the doubled pause, but no less than the server asks for.
    fn pause(&mut self, tries: u32, asked: Option<Duration>) -> Duration {
        let (first, longest) = self.pause;
        let ceiling = first.saturating_mul(1 << tries.min(16)).min(longest);
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut drawn = self.random;
        drawn = (drawn ^ (drawn >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        drawn = (drawn ^ (drawn >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let share = ((drawn ^ (drawn >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        asked.unwrap_or_else(|| ceiling.mul_f64(share))
    }
}

fn last(error: TransportError) -> Failure {
    Failure { error, again: false, wait: None }
}

impl Transport for Http {
    fn send(
        &mut self,
        body: &Value,
        deadline: Instant,
        cancel: &AtomicBool,
    ) -> Result<Reply, TransportError> {
        let body = body.to_string();
        let mut tries = 0;
        loop {
            let failure = match self.once(&body, deadline, cancel) {
                Ok(reply) => return Ok(reply),
                Err(failure) => failure,
            };
            if !failure.again || tries >= self.retries {
                return Err(failure.error);
            }
            let until = Instant::now() + self.pause(tries, failure.wait);
            if until >= deadline {
                return Err(failure.error);
            }
            while Instant::now() < until {
                if cancel.load(Ordering::Relaxed) {
                    return Err(TransportError::Cancelled);
                }
                std::thread::sleep(POLL.min(until.saturating_duration_since(Instant::now())));
            }
            tries += 1;
        }
    }
}

fn exchange(
    agent: &ureq::Agent,
    url: &str,
    key: Option<&str>,
    body: &str,
    left: Duration,
) -> Result<Reply, Failure> {
    let mut request = agent.post(url).header("content-type", "application/json");
    if let Some(key) = key {
        request = request.header("authorization", format!("Bearer {key}"));
    }
    let sent = request.config().timeout_global(Some(left)).build().send(body);
    let mut response = sent.map_err(|error| connection(&error))?;
    let status = response.status().as_u16();
    let header = |name: &str| {
        response
            .headers()
            .get(name)
            .and_then(|value| value.to_str().ok())
            .and_then(|v| v.trim().parse::<f64>().ok())
    };
    let wait = header("retry-after-ms").map(|ms| ms / 1000.0).or_else(|| header("retry-after"));
    let wait = wait.filter(|seconds| (0.0..86_400.0).contains(seconds)).map(Duration::from_secs_f64);
    let read = response.body_mut().with_config().limit(LONGEST_BODY).read_to_vec();
    if !(200..300).contains(&status) {
        let text = String::from_utf8_lossy(read.as_deref().unwrap_or_default()).into_owned();
        let again = matches!(status, 408 | 409 | 425 | 429) || status >= 500 && status != 501;
        let error = TransportError::Status { status, body: text.chars().take(500).collect() };
        return Err(Failure { error, again, wait });
    }
    let bytes = read.map_err(|error| connection(&error))?;
    reply(&bytes).map_err(|error| Failure { error, again: true, wait: None })
}

fn connection(error: &ureq::Error) -> Failure {
    match error {
        ureq::Error::Timeout(_) => last(TransportError::Deadline),
        ureq::Error::BodyExceedsLimit(limit) => {
            last(TransportError::Connection(format!("the response is longer than {limit} bytes")))
        }
        other => Failure { error: TransportError::Connection(other.to_string()), again: true, wait: None },
    }
}

/// The answer's text in a chat-completions response.
fn reply(bytes: &[u8]) -> Result<Reply, TransportError> {
    let wrong = |what: &str| TransportError::Connection(format!("not a chat-completions response: {what}"));
    let value: Value = serde_json::from_slice(bytes).map_err(|error| wrong(&error.to_string()))?;
    let message = &value["choices"][0]["message"];
    let content = message["content"].as_str().ok_or_else(|| match message["refusal"].as_str() {
        Some(refusal) => wrong(&format!("the model refused: {refusal}")),
        None => wrong("no choices[0].message.content"),
    })?;
    let usage = value["usage"]["prompt_tokens"].as_u64().zip(value["usage"]["completion_tokens"].as_u64());
    Ok(Reply { content: content.to_owned(), usage })
}
