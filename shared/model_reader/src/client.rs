//! The HTTP client: posts a request and takes the text out of the completion.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::LanguageModel;
use scene::Scene;
use serde_json::Value as Json;

use crate::Prompt;

/// Largest body of an answer, bytes.
const BODY_BYTES_MAX: u64 = 256 << 10;
/// Longest key, bytes.
const KEY_BYTES_MAX: usize = 8 << 10;
/// Characters of a refused answer that a message shows.
const SHOWN_CHARS: usize = 160;

/// A model that cannot be asked as it is configured.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The build has no TLS.
    #[error(
        "dialogue.model.url: this build has no TLS; help: use a url with http, or build with \
         `--features grounding/tls,whichone/tls`"
    )]
    NoTls,
    /// The file of the key cannot be used.
    #[error("dialogue.model.key_file: {}: {what}; help: write the key alone into it, one line", path.display())]
    Key {
        /// The file.
        path: PathBuf,
        /// Fault of the file.
        what: String,
    },
}

/// A client of one service, about one scene.
#[derive(Debug)]
pub struct Client {
    agent: ureq::Agent,
    url: String,
    authorization: Option<String>,
    prompt: Prompt,
}

impl Client {
    /// Prepares requests; sends none.
    ///
    /// # Errors
    /// The URL needs TLS and the build has none, or the key cannot be read.
    pub fn new(model: &LanguageModel, scene: &Scene) -> Result<Self, ClientError> {
        if model.url.starts_with("https:") && !crate::TLS {
            return Err(ClientError::NoTls);
        }
        let authorization = model.key_file.as_deref().map(bearer).transpose()?;
        let config = ureq::Agent::config_builder()
            .http_status_as_error(false)
            // The service is the one that is configured, and no other.
            .proxy(None)
            .max_redirects(0)
            .user_agent(format!("whichone/{}", build_info::VERSION));
        Ok(Self {
            agent: config.build().into(),
            url: model.url.clone(),
            authorization,
            prompt: Prompt::new(model, scene),
        })
    }

    /// Sends an utterance, as [`utterance`](crate::utterance) writes it, and returns the text of
    /// the answer. Returns or fails within `within`.
    ///
    /// # Errors
    /// In a sentence: the time is up, the service is not reached, refuses, or answers with
    /// something else than a completion.
    pub fn ask(&self, utterance: &str, within: Duration) -> Result<String, String> {
        let request = self.agent.post(&self.url).config().timeout_global(Some(within)).build();
        let request = match &self.authorization {
            Some(value) => request.header("authorization", value),
            None => request,
        };
        let failed = |error: ureq::Error| match error {
            ureq::Error::Timeout(_) => format!("no answer within {} ms", within.as_millis()),
            other => format!("not reached: {other}"),
        };
        let sent = request.content_type("application/json").send(self.prompt.request(utterance));
        let mut response = sent.map_err(failed)?;
        let status = response.status().as_u16();
        let body = response.body_mut().with_config().limit(BODY_BYTES_MAX).lossy_utf8(true);
        let body = body.read_to_string().map_err(failed)?;
        match status {
            200 => content(&body),
            _ => Err(format!("HTTP status {status}: {}", shown(&body))),
        }
    }
}

/// The text of a completion.
fn content(body: &str) -> Result<String, String> {
    let json: Json = serde_json::from_str(body)
        .map_err(|error| format!("not JSON ({error}): {}", shown(body)))?;
    let choice = &json["choices"][0];
    let message = &choice["message"];
    if let Some(refusal) = message["refusal"].as_str().filter(|text| !text.is_empty()) {
        return Err(format!("the model refuses: {}", shown(refusal)));
    }
    if choice["finish_reason"] == "length" {
        return Err("the answer was cut off at the service's limit of tokens".to_owned());
    }
    let content = message["content"].as_str().map(str::to_owned);
    content.ok_or_else(|| {
        let expected = "expected `choices[0].message.content`";
        format!("not a completion, {expected}: {}", shown(body))
    })
}

/// The beginning of a text of the service, printable.
fn shown(text: &str) -> String {
    let text: String = text.trim().chars().take(SHOWN_CHARS).collect();
    text.escape_debug().to_string()
}

/// The header that carries the key.
fn bearer(path: &Path) -> Result<String, ClientError> {
    let failed = |what: String| ClientError::Key { path: path.to_owned(), what };
    let text = config::read_file(path).map_err(|e| failed(e.to_string()))?;
    let key = text.trim();
    if !(1..=KEY_BYTES_MAX).contains(&key.len()) || !key.bytes().all(|byte| byte.is_ascii_graphic())
    {
        let what = "expected one line of at most 8192 printable ASCII characters without blanks";
        return Err(failed(what.to_owned()));
    }
    Ok(format!("Bearer {key}"))
}
