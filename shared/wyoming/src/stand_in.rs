//! A server for tests, with every kind of misbehaviour.

use std::io::{self, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crate::{Address, AudioFormat, Event, Frame, Info, Program};

/// Behaviour of a [`StandIn`].
#[derive(Clone, Debug, PartialEq)]
pub enum Manner {
    /// Transcribes every utterance as this text, and synthesises half a second of a wave.
    Answer(String),
    /// Does so after this time.
    Slow(String, Duration),
    /// Reports a failure.
    Error(String),
    /// Offers these programs, and answers nothing else.
    Offers(Info),
    /// Answers with these bytes, and stays connected.
    Bytes(Vec<u8>),
    /// Answers with these bytes, and ends the connection.
    Cut(Vec<u8>),
    /// Answers with a byte every few milliseconds.
    Drip,
    /// Reads nothing and answers nothing.
    Deaf,
}

/// A running server. Its threads end with the process.
#[derive(Clone, Debug)]
pub struct StandIn {
    /// Its address, at 127.0.0.1.
    pub address: Address,
    manner: Arc<Mutex<Manner>>,
    requests: Arc<Mutex<Vec<Request>>>,
}

/// A request that a [`StandIn`] has read to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Terms and bytes of audio of an utterance.
    Transcribe(Vec<String>, usize),
    /// A text.
    Synthesize(String),
}

/// Format of the stand-in's sound.
pub const FORMAT: AudioFormat = AudioFormat { rate_hz: 24_000, width: 2, channels: 1 };

impl StandIn {
    /// Starts a server at a free port.
    ///
    /// # Panics
    /// If there is none.
    pub fn start(manner: Manner) -> Self {
        Self::start_at(0, manner)
    }

    /// Starts a server at a port.
    ///
    /// # Panics
    /// If the port is taken.
    pub fn start_at(port: u16, manner: Manner) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", port)).expect("a free port");
        let port = listener.local_addr().expect("an address").port();
        let address = Address { host: "127.0.0.1".to_owned(), port };
        let (manner, requests) = (Arc::new(Mutex::new(manner)), Arc::default());
        let server = Self { address, manner, requests };
        let own = server.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let own = own.clone();
                thread::spawn(move || own.serve(&stream));
            }
        });
        server
    }

    /// Changes the behaviour.
    pub fn behave(&self, manner: Manner) {
        *self.manner.lock().unwrap_or_else(PoisonError::into_inner) = manner;
    }

    /// Returns the requests so far.
    pub fn requests(&self) -> Vec<Request> {
        self.requests.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn serve(&self, stream: &TcpStream) -> Option<()> {
        let manner = self.manner.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if manner == Manner::Deaf {
            thread::sleep(Duration::from_secs(3_600));
            return None;
        }
        let mut reader = BufReader::new(stream);
        let (mut words, mut bytes) = (Vec::new(), 0);
        loop {
            match Event::try_from(Frame::read(&mut reader).ok()??).ok()? {
                Event::Describe => match &manner {
                    Manner::Offers(info) => send(stream, &[Event::Info(info.clone())])?,
                    _ => send(stream, &[info()])?,
                },
                Event::Transcribe { terms, .. } => words = terms,
                Event::AudioChunk(_, audio) => bytes += audio.len(),
                Event::AudioStop => {
                    self.note(Request::Transcribe(words, bytes));
                    let answer = |text: String| vec![Event::Ping(None), Event::Transcript(text)];
                    return reply(stream, manner, answer);
                }
                Event::Synthesize { text, .. } => {
                    self.note(Request::Synthesize(text));
                    return reply(stream, manner, |_| sound());
                }
                _ => {}
            }
        }
    }

    fn note(&self, request: Request) {
        self.requests.lock().unwrap_or_else(PoisonError::into_inner).push(request);
    }
}

fn reply(
    mut stream: &TcpStream,
    manner: Manner,
    answer: impl FnOnce(String) -> Vec<Event>,
) -> Option<()> {
    match manner {
        Manner::Answer(text) => answer_all(stream, &answer(text)),
        Manner::Slow(text, after) => {
            thread::sleep(after);
            answer_all(stream, &answer(text))
        }
        Manner::Error(text) => send(stream, &[Event::Error(text)]),
        Manner::Bytes(bytes) => {
            stream.write_all(&bytes).ok()?;
            // Until the client has gone.
            drop(stream.read(&mut [0]));
            Some(())
        }
        Manner::Cut(bytes) => stream.write_all(&bytes).ok(),
        Manner::Drip => loop {
            stream.write_all(b" ").ok()?;
            thread::sleep(Duration::from_millis(5));
        },
        Manner::Deaf | Manner::Offers(_) => None,
    }
}

fn send(mut stream: &TcpStream, events: &[Event]) -> Option<()> {
    events.iter().try_for_each(|event| Frame::from(event).write(&mut stream)).ok()
}

/// Sends an answer, and waits until the client has gone: what it sends to a closed connection would
/// take away what it has not read yet.
fn answer_all(mut stream: &TcpStream, events: &[Event]) -> Option<()> {
    send(stream, events)?;
    io::copy(&mut stream, &mut io::sink()).ok().map(drop)
}

fn info() -> Event {
    let program = Program { name: "stand-in".to_owned(), version: Some("1".to_owned()) };
    Event::Info(Info { asr: vec![program.clone()], tts: vec![program] })
}

/// Returns half a second of a square wave between silences.
fn sound() -> Vec<Event> {
    let wave = |n: usize| if (n / 60).is_multiple_of(2) { 9_000_i16 } else { -9_000 };
    let samples = (0..24_000).map(|n| if (6_000..18_000).contains(&n) { wave(n) } else { 0 });
    let audio: Vec<u8> = samples.flat_map(i16::to_le_bytes).collect();
    let chunks = audio.chunks(4_096).map(|chunk| Event::AudioChunk(FORMAT, chunk.to_vec()));
    [Event::AudioStart(FORMAT)].into_iter().chain(chunks).chain([Event::AudioStop]).collect()
}
