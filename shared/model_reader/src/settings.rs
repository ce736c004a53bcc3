//! `[model]` of `dialogue.toml`: a language model that reads utterances.

use std::path::PathBuf;
use std::time::Duration;

use config::Section;
use diagnostics::Fields;
use serde_json::json;

/// A language model behind HTTP, in the chat-completions form, that reads utterances.
#[derive(Clone, Debug, PartialEq)]
pub struct LanguageModel {
    /// Address for requests, `http://HOST[:PORT]/PATH` or `https://…`.
    pub url: String,
    /// Name of the model, as the service knows it.
    pub name: String,
    /// Longest time from an utterance to its answer; then the built-in reader's reading counts.
    pub timeout: Duration,
    /// Sampling temperature of the model; 0 is the most repeatable.
    pub temperature: f64,
    /// File that holds the bearer token.
    pub key_file: Option<PathBuf>,
    /// How the model's weights become probabilities.
    pub calibration: Calibration,
}

/// Mapping of the model's weights to probabilities: `p ∝ (1 − built_in) w^power + built_in b`,
/// where `b` is the built-in reader's probability of the same reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// Exponent of the model's weights: above 1 sharpens them, below 1 flattens them.
    pub power: f64,
    /// Share of the built-in reader.
    pub built_in: f64,
}

impl Calibration {
    /// Bounds of `power`.
    pub const POWER: std::ops::RangeInclusive<f64> = 0.05..=20.0;
    /// The model's unchanged weights.
    pub const NONE: Self = Self { power: 1.0, built_in: 0.0 };
}

/// Schemes of a URL.
const SCHEMES: [&str; 2] = ["http://", "https://"];

/// The language model that reads utterances in place of the built-in reader, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Configured(pub Option<LanguageModel>);

impl Section for Configured {
    const KEY: &'static [&'static str] = &["dialogue", "model"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self(read(f))
    }
}

fn read(f: &mut Fields<'_>) -> Option<LanguageModel> {
    let url = f.optional_text("url");
    f.note("url", || json!({ "pattern": "^(https?://[^/\\s]\\S*)?$" }));
    let name = f.optional_text("model");
    // Milliseconds: the policy waits for an observation for at most 10 s.
    let timeout_ms: u64 = f.whole("timeout_ms", 50..=8000);
    let temperature = f.number("temperature", 0.0..=2.0);
    let key_file = f.absolute("key_file");
    let calibration = f.table("calibration", |f| Calibration {
        power: f.number("power", Calibration::POWER),
        built_in: f.number("built_in", 0.0..=1.0),
    });
    let url = url?;
    if !is_url(&url) {
        let help = "write the whole address, e.g. `http://127.0.0.1:8080/v1/chat/completions`";
        f.problem("url", format!("expected a URL of http or https, found `{url}`"), help);
    }
    let Some(name) = name else {
        if !f.is_wrong("model") {
            let help = "write `model = \"NAME\"` as the service at `url` knows it";
            f.problem("url", "the name of the model is missing", help);
        }
        return None;
    };
    let timeout = Duration::from_millis(timeout_ms);
    Some(LanguageModel { url, name, timeout, temperature, key_file, calibration })
}

fn is_url(url: &str) -> bool {
    let rest = SCHEMES.iter().find_map(|scheme| url.strip_prefix(scheme));
    rest.is_some_and(|rest| !rest.starts_with('/') && !rest.is_empty())
        && !url.contains(char::is_whitespace)
}
