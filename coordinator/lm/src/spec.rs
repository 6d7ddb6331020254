//! `--lm offline|openai|record:FILE|replay:FILE`: which model a run uses.

use std::path::{Path, PathBuf};

use crate::cassette::{Record, Replay};
use crate::chat::ChatModel;
use crate::http::Http;
use crate::{Fallback, LanguageModel, LmError, Offline, Wording};

/// Settings from flags; what is missing is looked up in the environment.
#[derive(Clone, Debug)]
pub struct Options {
    /// The endpoint (`https://host/v1`); else `OPENAI_BASE_URL`, else OpenAI's own.
    pub base_url: Option<String>,
    /// The model's name; else `LAMMA_LM_MODEL`.
    pub model: Option<String>,
    /// The environment variable that holds the key. Local servers need none.
    pub key_variable: String,
    /// How often a try that may succeed later is made again.
    pub retries: u32,
    /// How many answers are sent back for repair.
    pub repairs: u32,
    /// Draws the pauses between tries, and is sent to the model.
    pub seed: u64,
    /// A file that adds to the embedded lexicon.
    pub lexicon: Option<PathBuf>,
    /// What a chat model is told and asked for.
    pub wording: Wording,
    /// Whether the embedded default steps in when a model fails.
    pub fallback: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            base_url: None,
            model: None,
            key_variable: "OPENAI_API_KEY".to_owned(),
            retries: 2,
            repairs: 2,
            seed: 0,
            lexicon: None,
            wording: Wording::default(),
            fallback: true,
        }
    }
}

const OPENAI: &str = "https://api.openai.com/v1";

/// The model that `--lm` names.
pub fn from_spec(spec: &str, options: &Options) -> Result<Box<dyn LanguageModel>, LmError> {
    let offline = offline(options)?;
    match spec.split_once(':') {
        None if spec == "offline" => Ok(Box::new(offline)),
        None if spec == "openai" => Ok(backed(chat(http(options)?, options)?, offline, options)),
        Some(("record", file)) if !file.is_empty() => {
            let record = Record::new(http(options)?, Path::new(file)).map_err(|error| {
                LmError::Configuration(format!("--lm record: cannot write {file}: {error}"))
            })?;
            Ok(backed(chat(record, options)?, offline, options))
        }
        Some(("replay", file)) if !file.is_empty() => {
            let replay = Replay::read(Path::new(file))
                .map_err(|error| LmError::Configuration(format!("--lm replay: {error}")))?;

            let recorded = replay.model().map(str::to_owned);
            let options = Options { model: options.model.clone().or(recorded), ..options.clone() };
            Ok(backed(chat(replay, &options)?, offline, &options))
        }
        _ => Err(LmError::Configuration(format!(
            "--lm {spec:?} is not known; give offline, openai, record:FILE or replay:FILE"
        ))),
    }
}

/// The model, with the embedded default behind it where that is wished.
fn backed<T: crate::chat::Transport + 'static>(
    model: ChatModel<T>,
    offline: Offline,
    options: &Options,
) -> Box<dyn LanguageModel> {
    if options.fallback { Box::new(Fallback::new(model, offline)) } else { Box::new(model) }
}

fn offline(options: &Options) -> Result<Offline, LmError> {
    let mut offline = Offline::new()?;
    if let Some(path) = &options.lexicon {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| LmError::Configuration(format!("cannot read the lexicon {name}: {error}")))?;
        offline.extend(&name, &text)?;
    }
    Ok(offline)
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.trim().is_empty())
}

fn http(options: &Options) -> Result<Http, LmError> {
    let base =
        options.base_url.clone().or_else(|| variable("OPENAI_BASE_URL")).unwrap_or_else(|| OPENAI.to_owned());
    if !base.starts_with("http://") && !base.starts_with("https://") {
        return Err(LmError::Configuration(format!(
            "the language model's base URL {base:?} is none; give one like http://127.0.0.1:8080/v1"
        )));
    }
    let key = variable(&options.key_variable);
    if key.is_none() && base == OPENAI {
        return Err(LmError::Configuration(format!(
            "{OPENAI} needs a key: set {}, or name another endpoint by OPENAI_BASE_URL, or use --lm offline",
            options.key_variable
        )));
    }
    Ok(Http::new(&base, key, options.retries, options.seed))
}

fn chat<T: crate::chat::Transport>(transport: T, options: &Options) -> Result<ChatModel<T>, LmError> {
    let model = options.model.clone().or_else(|| variable("LAMMA_LM_MODEL")).ok_or_else(|| {
        LmError::Configuration("no model is named: set LAMMA_LM_MODEL or give the model's name".to_owned())
    })?;
    Ok(ChatModel::new(transport, model, options.repairs, options.seed).worded(options.wording))
}
