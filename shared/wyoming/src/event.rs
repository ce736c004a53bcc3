//! Events: the frames that speech servers and their clients exchange.

use serde_json::{Map, Value as Json, json};

use crate::frame::Frame;

/// Format of audio: signed little-endian integers, channels interleaved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AudioFormat {
    /// Samples per second and channel, 8,000 to 192,000.
    pub rate_hz: u32,
    /// Bytes of a sample, 1 to 4.
    pub width: u16,
    /// Channels, 1 to 8.
    pub channels: u16,
}

/// A program that a server offers, e.g. `faster-whisper`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// Its name.
    pub name: String,
    /// Its version, if known.
    pub version: Option<String>,
}

/// The programs of a server.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Info {
    /// Recognisers.
    pub asr: Vec<Program>,
    /// Voices.
    pub tts: Vec<Program>,
}

/// An event.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Asks for [`Event::Info`].
    Describe,
    /// The programs of the server.
    Info(Info),
    /// Announces audio to be transcribed.
    Transcribe {
        /// Language of the speech, e.g. `en`.
        language: Option<String>,
        /// Words that the recogniser should expect. Servers that do not know them ignore them.
        terms: Vec<String>,
    },
    /// Start of audio.
    AudioStart(AudioFormat),
    /// Audio.
    AudioChunk(AudioFormat, Vec<u8>),
    /// End of audio.
    AudioStop,
    /// The words of audio.
    Transcript(String),
    /// Asks for the sound of a text.
    Synthesize {
        /// The text.
        text: String,
        /// The server's name of a voice.
        voice: Option<String>,
        /// A speaker of this voice.
        speaker: Option<String>,
    },
    /// A failure of the server.
    Error(String),
    /// Asks for [`Event::Pong`] with the same text.
    Ping(Option<String>),
    /// Answer to [`Event::Ping`].
    Pong(Option<String>),
    /// An event that is not used here, by its type.
    Other(String),
}

/// Error of a frame whose values do not fit its type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("invalid event `{kind}`: {problem}")]
pub struct EventError {
    kind: String,
    problem: String,
}

impl TryFrom<Frame> for Event {
    type Error = EventError;

    fn try_from(frame: Frame) -> Result<Self, EventError> {
        let Frame { kind, data, payload } = frame;
        let read = || -> Result<Self, String> {
            Ok(match kind.as_str() {
                "describe" => Self::Describe,
                "info" => {
                    Self::Info(Info { asr: programs(&data, "asr")?, tts: programs(&data, "tts")? })
                }
                "transcribe" => Self::Transcribe {
                    language: optional(&data, "language")?,
                    terms: terms(&data)?,
                },
                "audio-start" => Self::AudioStart(format(&data)?),
                "audio-chunk" => Self::AudioChunk(format(&data)?, payload),
                "audio-stop" => Self::AudioStop,
                "transcript" => Self::Transcript(text(&data, "text")?),
                "synthesize" => {
                    let none = Map::new();
                    let named = data.get("voice").and_then(Json::as_object).unwrap_or(&none);
                    let voice = optional(named, "name")?;
                    // A speaker belongs to a voice: without its name it means nothing.
                    let speaker = optional(named, "speaker")?.filter(|_| voice.is_some());
                    Self::Synthesize { text: text(&data, "text")?, voice, speaker }
                }
                "error" => Self::Error(text(&data, "text")?),
                "ping" => Self::Ping(optional(&data, "text")?),
                "pong" => Self::Pong(optional(&data, "text")?),
                other => Self::Other(other.to_owned()),
            })
        };
        read().map_err(|problem| EventError { kind: kind.chars().take(40).collect(), problem })
    }
}

impl From<&Event> for Frame {
    fn from(event: &Event) -> Self {
        let plain = |kind| Self::new(kind, json!({}));
        match event {
            Event::Describe => plain("describe"),
            Event::Info(Info { asr, tts }) => {
                let listed = |programs: &[Program]| {
                    let listed = programs.iter().map(|program| {
                        json!({ "name": program.name, "version": program.version, "installed": true })
                    });
                    Json::Array(listed.collect())
                };
                Self::new("info", json!({ "asr": listed(asr), "tts": listed(tts) }))
            }
            Event::Transcribe { language, terms } => {
                let mut data = Map::new();
                data.extend(language.iter().map(|it| ("language".to_owned(), it.as_str().into())));
                if !terms.is_empty() {
                    data.insert("transcript_terms".to_owned(), terms.clone().into());
                }
                Self::new("transcribe", Json::Object(data))
            }
            Event::AudioStart(format) => Self::new("audio-start", format.data()),
            Event::AudioChunk(format, audio) => {
                Self { payload: audio.clone(), ..Self::new("audio-chunk", format.data()) }
            }
            Event::AudioStop => plain("audio-stop"),
            Event::Transcript(text) => Self::new("transcript", json!({ "text": text })),
            Event::Synthesize { text, voice, speaker } => {
                let mut data = json!({ "text": text });
                if let Some(name) = voice {
                    data["voice"] = json!({ "name": name });
                    if let Some(speaker) = speaker {
                        data["voice"]["speaker"] = speaker.as_str().into();
                    }
                }
                Self::new("synthesize", data)
            }
            Event::Error(text) => Self::new("error", json!({ "text": text })),
            Event::Ping(text) => Self::new("ping", json!({ "text": text })),
            Event::Pong(text) => Self::new("pong", json!({ "text": text })),
            Event::Other(kind) => plain(kind),
        }
    }
}

impl AudioFormat {
    fn data(self) -> Json {
        json!({ "rate": self.rate_hz, "width": self.width, "channels": self.channels })
    }
}

fn text(data: &Map<String, Json>, key: &str) -> Result<String, String> {
    optional(data, key)?.ok_or_else(|| format!("`{key}` is missing"))
}

fn optional(data: &Map<String, Json>, key: &str) -> Result<Option<String>, String> {
    match data.get(key) {
        None | Some(Json::Null) => Ok(None),
        Some(Json::String(text)) => Ok(Some(text.clone())),
        Some(_) => Err(format!("`{key}` is not a text")),
    }
}

fn terms(data: &Map<String, Json>) -> Result<Vec<String>, String> {
    const KEY: &str = "transcript_terms";
    let terms = match data.get(KEY) {
        None | Some(Json::Null) => return Ok(Vec::new()),
        Some(Json::Array(terms)) => terms,
        Some(_) => return Err(format!("`{KEY}` is not a list")),
    };
    let texts = terms.iter().map(|term| term.as_str().map(str::to_owned));
    texts.collect::<Option<_>>().ok_or_else(|| format!("`{KEY}` is not a list of texts"))
}

fn format(data: &Map<String, Json>) -> Result<AudioFormat, String> {
    let number = |key: &str, least: u64, most: u64| {
        let found = data.get(key).and_then(Json::as_u64).filter(|n| (least..=most).contains(n));
        found.ok_or_else(|| format!("expected `{key}` from {least} to {most}"))
    };
    Ok(AudioFormat {
        rate_hz: number("rate", 8_000, 192_000)? as u32,
        width: number("width", 1, 4)? as u16,
        channels: number("channels", 1, 8)? as u16,
    })
}

/// Reads the programs of a kind; those without a name are left out.
fn programs(data: &Map<String, Json>, key: &str) -> Result<Vec<Program>, String> {
    let listed = match data.get(key) {
        None | Some(Json::Null) => return Ok(Vec::new()),
        Some(Json::Array(listed)) => listed,
        Some(_) => return Err(format!("`{key}` is not a list")),
    };
    let program = |it: &Json| {
        let of = |key| it.get(key).and_then(Json::as_str).map(str::to_owned);
        Some(Program { name: of("name")?, version: of("version") })
    };
    Ok(listed.iter().filter_map(program).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FORMAT: AudioFormat = AudioFormat { rate_hz: 22_050, width: 2, channels: 1 };

    fn events() -> Vec<Event> {
        let some = |text: &str| Some(text.to_owned());
        let program = Program { name: "piper".to_owned(), version: some("1.6.0") };
        vec![
            Event::Describe,
            Event::Info(Info { asr: Vec::new(), tts: vec![program] }),
            Event::Transcribe { language: some("en"), terms: vec!["white".to_owned()] },
            Event::Transcribe { language: None, terms: Vec::new() },
            Event::AudioStart(FORMAT),
            Event::AudioChunk(FORMAT, vec![1, 2, 3, 4]),
            Event::AudioStop,
            Event::Transcript("the white one".to_owned()),
            Event::Synthesize { text: "Hello.".to_owned(), voice: some("amy"), speaker: some("3") },
            Event::Synthesize { text: "Hello.".to_owned(), voice: None, speaker: None },
            Event::Error("no model".to_owned()),
            Event::Ping(some("x")),
            Event::Pong(None),
            Event::Other("played".to_owned()),
        ]
    }

    #[test]
    fn event_survives_a_round_trip() {
        for event in events() {
            assert_eq!(Event::try_from(Frame::from(&event)), Ok(event));
        }
    }

    #[test]
    fn event_with_values_that_do_not_fit_is_refused() {
        for (kind, data, expected) in [
            ("transcript", json!({}), "invalid event `transcript`: `text` is missing"),
            ("transcript", json!({ "text": 5 }), "`text` is not a text"),
            ("audio-start", json!({ "rate": 22050, "width": 2 }), "`channels` from 1 to 8"),
            ("audio-chunk", json!({ "rate": 1, "width": 2, "channels": 1 }), "`rate` from 8000"),
            (
                "audio-chunk",
                json!({ "rate": 9000, "width": 0, "channels": 1 }),
                "`width` from 1 to 4",
            ),
            ("audio-chunk", json!({ "rate": -1, "width": 2, "channels": 1 }), "`rate`"),
            ("info", json!({ "asr": {} }), "`asr` is not a list"),
            ("transcribe", json!({ "transcript_terms": [5] }), "list of texts"),
            ("transcribe", json!({ "transcript_terms": "white" }), "is not a list"),
        ] {
            let error = Event::try_from(Frame::new(kind, data)).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let odd = Frame::new("info", json!({ "asr": [{ "name": "vosk" }, 5, { "version": "1" }] }));
        let Ok(Event::Info(info)) = Event::try_from(odd) else { panic!("expected info") };
        assert_eq!(info.asr, [Program { name: "vosk".to_owned(), version: None }]);
    }

    proptest! {
        #[test]
        fn any_frame_is_an_event_or_an_error(
            kind in prop::sample::select(vec!["info", "transcript", "audio-chunk", "synthesize", "error", "?"]),
            key in prop::sample::select(vec!["asr", "text", "rate", "voice", "width"]), number: i64, text in ".{0,20}",
        ) {
            for value in [json!(number), json!(text), json!([number]), json!({ "name": number }), json!(null)] {
                // Any outcome but a panic.
                drop(Event::try_from(Frame::new(kind, json!({ key: value }))));
            }
        }
    }
}
