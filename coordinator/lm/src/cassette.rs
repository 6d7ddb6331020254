//! Records a model's answers and plays them back, keyed by what was asked.
//!
//! A cassette is JSON Lines: `{"key", "request", "reply" | "error"}`. The key is a hash of the request's body
//! and the prompt's version; neither the endpoint nor any key of an account is part of it. Answers are found
//! by what was asked, not by their order, so a replay may ask in parallel or in part.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::chat::{Reply, Transport, TransportError};
use crate::prompt;

#[derive(Serialize, Deserialize)]
struct Line {
    key: String,
    request: Value,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reply: Option<Reply>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    error: Option<TransportError>,
}

/// FNV-1a with 128 bits over the canonical body (serde_json orders keys) and the prompt's version.
fn key(body: &Value) -> String {
    let text = format!("{}\n{body}", prompt::VERSION);
    let hash = text.bytes().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
        (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
    });
    format!("{hash:032x}")
}

/// Passes requests on and writes down what came back.
pub struct Record<T> {
    inner: T,
    path: PathBuf,
    file: File,
}

impl<T> Record<T> {
    /// Appends to the file, which is made if need be.
    pub fn new(inner: T, path: &Path) -> Result<Self, std::io::Error> {
        let file = OpenOptions::new().create(true).append(true).open(path)?;
        Ok(Self { inner, path: path.to_owned(), file })
    }
}

impl<T: Transport> Transport for Record<T> {
    fn send(
        &mut self,
        body: &Value,
        deadline: Instant,
        cancel: &AtomicBool,
    ) -> Result<Reply, TransportError> {
        let result = self.inner.send(body, deadline, cancel);
        if result == Err(TransportError::Cancelled) {
            return result;
        }
        let (reply, error) = (result.as_ref().ok().cloned(), result.as_ref().err().cloned());
        let line = Line { key: key(body), request: body.clone(), reply, error };
        let failed = |error: String| TransportError::Cassette(format!("{}: {error}", self.path.display()));
        let mut text = serde_json::to_string(&line).map_err(|error| failed(error.to_string()))?;
        text.push('\n');
        self.file.write_all(text.as_bytes()).map_err(|error| failed(error.to_string()))?;
        result
    }
}

/// Answers from a cassette alone.
pub struct Replay {
    path: PathBuf,
    lines: BTreeMap<String, Result<Reply, TransportError>>,
    model: Option<String>,
}

impl Replay {
    /// Reads a cassette; of two answers to one question the later counts.
    pub fn read(path: &Path) -> Result<Self, TransportError> {
        let at = |line: usize, error: String| {
            TransportError::Cassette(format!(
                "{}:{line}: {error}; record it anew with --lm record:FILE",
                path.display()
            ))
        };
        let text = std::fs::read_to_string(path).map_err(|error| at(0, error.to_string()))?;
        let mut lines = BTreeMap::new();
        let mut model = None;
        for (number, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
            let line: Line = serde_json::from_str(text).map_err(|error| at(number + 1, error.to_string()))?;
            let result = match (line.reply, line.error) {
                (Some(reply), None) => Ok(reply),
                (None, Some(error)) => Err(error),
                _ => return Err(at(number + 1, "needs either \"reply\" or \"error\"".to_owned())),
            };
            model = line.request["model"].as_str().map(str::to_owned).or(model);
            lines.insert(line.key, result);
        }
        Ok(Self { path: path.to_owned(), lines, model })
    }

    /// The model that was recorded.
    pub fn model(&self) -> Option<&str> {
        self.model.as_deref()
    }
}

impl Transport for Replay {
    fn send(&mut self, body: &Value, _: Instant, _: &AtomicBool) -> Result<Reply, TransportError> {
        let key = key(body);
        self.lines.get(&key).cloned().unwrap_or_else(|| {
            Err(TransportError::Cassette(format!(
                "{}: none of its {} answers is to this question ({key}): the instruction, the scene, the team, the \
                 model or the prompt has changed; record it anew with --lm record:FILE",
                self.path.display(),
                self.lines.len()
            )))
        })
    }
}
