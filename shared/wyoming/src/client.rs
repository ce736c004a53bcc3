//! A blocking client. Each request has a connection of its own, as in Home Assistant, so that no
//! answer can be that of another request.

use std::time::Duration;

use crate::connection::{Connection, Lookup};
use crate::{Address, AudioFormat, Event, Info, Program};

/// Error of a request.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClientError {
    /// The server accepts no connection.
    #[error("no connection: {0}")]
    Unreachable(String),
    /// No answer within the limit.
    #[error("no answer within {} ms", .0.as_millis())]
    Late(Duration),
    /// The connection ended before the answer.
    #[error("it ended the connection before its answer")]
    Ended,
    /// The server reports a failure.
    #[error("it reports: {0}")]
    Refused(String),
    /// The answer is invalid, or the connection failed.
    #[error("{0}")]
    Broken(String),
    /// The caller does not need the answer any more.
    #[error("cancelled")]
    Cancelled,
}

/// Synthesised sound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sound {
    /// Its format.
    pub format: AudioFormat,
    /// Its samples.
    pub audio: Vec<u8>,
}

/// A voice of a server; without names its default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Voice {
    /// The server's name of it.
    pub name: Option<String>,
    /// A speaker of it.
    pub speaker: Option<String>,
}

/// A kind of program that a server offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Recognisers.
    Recogniser,
    /// Voices.
    Voice,
}

/// A client of one server.
#[derive(Clone, Debug, PartialEq)]
pub struct Client {
    /// The server.
    pub address: Address,
    /// Longest time until the server accepts a connection.
    pub connect: Duration,
    /// Longest time of a request from then on.
    pub answer: Duration,
    lookup: Lookup,
}

/// Samples of a chunk of audio: a tenth of a second at 16 kHz.
const CHUNK: usize = 1_600;
/// Most bytes of synthesised sound: two minutes at 48 kHz in 16 bits and two channels.
const SOUND_MAX: usize = 120 * 48_000 * 4;
/// Characters of the names of a server's programs that are shown.
const NAMES_MAX: usize = 200;

impl Client {
    /// Returns a client with its time limits; see the fields.
    pub fn new(address: Address, connect: Duration, answer: Duration) -> Self {
        Self { address, connect, answer, lookup: Lookup::default() }
    }

    fn open<'c>(&self, is_cancelled: &'c dyn Fn() -> bool) -> Result<Connection<'c>, ClientError> {
        let (server, limits) = ((&self.address, &self.lookup), (self.connect, self.answer));
        Connection::open(server, limits, is_cancelled)
    }

    /// Returns the server's programs. `is_cancelled` is asked every few milliseconds.
    ///
    /// # Errors
    /// If the server is away, late or answers with something else, or the request was cancelled.
    pub fn describe(&self, is_cancelled: &dyn Fn() -> bool) -> Result<Info, ClientError> {
        let mut connection = self.open(is_cancelled)?;
        connection.send([&Event::Describe])?;
        loop {
            if let Event::Info(info) = connection.next()? {
                return Ok(info);
            }
        }
    }

    /// Returns the server's programs of a kind in words, e.g. `piper 1.6.0 at
    /// tcp://127.0.0.1:10200`.
    ///
    /// # Errors
    /// As for [`Self::describe`], or if the server has no program of this kind.
    pub fn examine(
        &self,
        kind: Kind,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<String, ClientError> {
        let info = self.describe(is_cancelled)?;
        let (programs, what) = match kind {
            Kind::Recogniser => (info.asr, "it offers no recogniser"),
            Kind::Voice => (info.tts, "it offers no voice"),
        };
        if programs.is_empty() {
            return broken(what);
        }
        let name = |Program { name, version }: Program| {
            [Some(name), version].into_iter().flatten().collect::<Vec<_>>().join(" ")
        };
        let names = programs.into_iter().map(name).collect::<Vec<_>>().join(", ");
        let names: String = names.chars().take(NAMES_MAX).collect();
        Ok(format!("{names} at {}", self.address))
    }

    /// Returns the words of an utterance, `samples` at `rate_hz`, one channel; empty if there are
    /// none. `terms` are words to expect. `is_cancelled` is asked every few milliseconds.
    ///
    /// # Errors
    /// If the server is away, late, reports a failure or answers with something else, or the
    /// request was cancelled.
    pub fn transcribe(
        &self,
        (samples, rate_hz): (&[i16], u32),
        (language, terms): (&str, &[String]),
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<String, ClientError> {
        let mut connection = self.open(is_cancelled)?;
        let format = AudioFormat { rate_hz, width: 2, channels: 1 };
        let (language, terms) = (Some(language.to_owned()), terms.to_vec());
        connection.send([&Event::Transcribe { language, terms }, &Event::AudioStart(format)])?;
        for chunk in samples.chunks(CHUNK) {
            let audio = chunk.iter().flat_map(|sample| sample.to_le_bytes()).collect();
            connection.send([&Event::AudioChunk(format, audio)])?;
        }
        connection.send([&Event::AudioStop])?;
        loop {
            if let Event::Transcript(text) = connection.next()? {
                return Ok(text);
            }
        }
    }

    /// Returns the sound of a text. `is_cancelled` is asked every few milliseconds.
    ///
    /// # Errors
    /// If the server is away, late, reports a failure or answers with something else or with too
    /// much sound, or the request was cancelled.
    pub fn synthesize(
        &self,
        text: &str,
        Voice { name, speaker }: &Voice,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Sound, ClientError> {
        let mut connection = self.open(is_cancelled)?;
        let (text, voice, speaker) = (text.to_owned(), name.clone(), speaker.clone());
        connection.send([&Event::Synthesize { text, voice, speaker }])?;
        let mut sound: Option<Sound> = None;
        loop {
            match connection.next()? {
                Event::AudioStart(format) if sound.is_none() => {
                    sound = Some(Sound { format, audio: Vec::new() });
                }
                Event::AudioStart(_) => return broken("its sound begins twice"),
                Event::AudioChunk(format, more) => {
                    let sound = sound.get_or_insert(Sound { format, audio: Vec::new() });
                    if sound.format != format {
                        return broken("its sound changes its format");
                    }
                    if sound.audio.len() + more.len() > SOUND_MAX {
                        return broken("its sound is longer than two minutes");
                    }
                    sound.audio.extend(more);
                }
                Event::AudioStop => {
                    let sound = sound.filter(|sound| !sound.audio.is_empty());
                    return sound.map_or_else(|| broken("its sound is empty"), Ok);
                }
                _ => {}
            }
        }
    }
}

fn broken<T>(what: &str) -> Result<T, ClientError> {
    Err(ClientError::Broken(what.to_owned()))
}

#[cfg(test)]
mod tests;
