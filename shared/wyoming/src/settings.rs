//! `[wyoming]` of `speech.toml`: the servers and their time limits.

use std::time::Duration;

use diagnostics::Fields;
use serde_json::json;

use crate::{Address, AddressError, Client, Voice};

/// Servers of speech.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Server of the recogniser.
    pub recogniser: Option<Address>,
    /// Server of the voice.
    pub voice: Option<Address>,
    /// The server's name of a voice; its default if absent.
    pub voice_name: Option<String>,
    /// A speaker of this voice; its default if absent.
    pub speaker: Option<String>,
    /// Longest time until a server accepts a connection.
    pub connect: Duration,
    /// Longest time from then on until the words of an utterance.
    pub answer: Duration,
    /// Longest time from then on until the sound of a line.
    pub synthesis: Duration,
}

impl Settings {
    /// Returns a client of the recogniser's server, if there is one.
    pub fn recogniser_client(&self) -> Option<Client> {
        let address = self.recogniser.clone()?;
        Some(Client::new(address, self.connect, self.answer))
    }

    /// Returns a client of the voice's server with its voice, if there is one.
    pub fn voice_client(&self) -> Option<(Client, Voice)> {
        let address = self.voice.clone()?;
        let voice = Voice { name: self.voice_name.clone(), speaker: self.speaker.clone() };
        Some((Client::new(address, self.connect, self.synthesis), voice))
    }
}

/// Reads the table.
pub fn read_settings(f: &mut Fields<'_>) -> Settings {
    let settings = Settings {
        recogniser: address(f, "recogniser"),
        voice: address(f, "voice"),
        voice_name: f.optional_text("voice_name"),
        speaker: f.optional_text("speaker"),
        connect: Duration::from_millis(f.whole("connect_ms", 10..=2_000)),
        answer: Duration::from_millis(f.whole("answer_ms", 50..=20_000)),
        synthesis: Duration::from_millis(f.whole("synthesis_ms", 50..=20_000)),
    };
    if settings.speaker.is_some() && settings.voice_name.is_none() {
        f.problem("speaker", "a speaker belongs to a voice", "set voice_name as well");
    }
    settings
}

fn address<'a>(f: &mut Fields<'a>, key: &'a str) -> Option<Address> {
    let text = f.optional_text(key);
    f.note(key, || json!({ "pattern": "^(tcp://[^/\\s]+:[0-9]+)?$" }));
    let text = text?;
    Some(text.parse().unwrap_or_else(|error: AddressError| {
        let help = "write the server's address, e.g. `tcp://127.0.0.1:10300`";
        f.problem(key, error.to_string(), help);
        // A placeholder, so that its absence is not reported as well.
        Address { host: text, port: 0 }
    }))
}
