//! The client against servers that are dead, slow, late, silent, and send anything.

use std::cell::Cell;
use std::time::Instant;

use super::*;
use crate::stand_in::{FORMAT, Manner, Request, StandIn};
use crate::{Frame, PART_MAX};

const ANSWER: Duration = Duration::from_millis(300);
/// A limit for the tests that do not wait for it.
const PATIENCE: Duration = Duration::from_secs(20);

fn client(server: &StandIn, answer: Duration) -> Client {
    Client::new(server.address.clone(), PATIENCE, answer)
}

fn transcribe(client: &Client) -> Result<String, ClientError> {
    client.transcribe((&[7; 8_000], 16_000), ("en", &["white".to_owned()]), &|| false)
}

fn synthesize(client: &Client) -> Result<Sound, ClientError> {
    client.synthesize("Is it white?", &Voice::default(), &|| false)
}

#[test]
fn client_transcribes_synthesises_and_describes() {
    let server = StandIn::start(Manner::Answer("the white one".to_owned()));
    let client = client(&server, PATIENCE);
    assert_eq!(transcribe(&client).as_deref(), Ok("the white one"));
    let sound = synthesize(&client).unwrap();
    assert_eq!((sound.format, sound.audio.len()), (FORMAT, 48_000));
    assert_eq!(client.describe(&|| false).unwrap().asr[0].name, "stand-in");
    let expected = Ok(format!("stand-in 1 at {}", server.address));
    for kind in [Kind::Recogniser, Kind::Voice] {
        assert_eq!(client.examine(kind, &|| false), expected);
    }
    let terms = vec!["white".to_owned()];
    let text = "Is it white?".to_owned();
    assert_eq!(server.requests(), [Request::Transcribe(terms, 16_000), Request::Synthesize(text)]);
    let local = Address { host: "localhost".to_owned(), ..server.address };
    assert!(transcribe(&Client { address: local, ..client }).is_ok());
}

#[test]
fn client_reports_a_server_that_is_dead() {
    for host in ["127.0.0.1", "no-such-host.invalid"] {
        // No server of a test has this port.
        let address = Address { host: host.to_owned(), port: 1 };
        let client = Client::new(address, PATIENCE, ANSWER);
        assert!(matches!(transcribe(&client), Err(ClientError::Unreachable(_))), "{host}");
    }
}

#[test]
fn client_waits_no_longer_than_its_limit() {
    let server = StandIn::start(Manner::Deaf);
    let late = Err(ClientError::Late(ANSWER));
    for manner in [
        Manner::Deaf,
        Manner::Drip,
        Manner::Bytes(Vec::new()),
        Manner::Bytes(b"{\"type\": \"transcript\", \"data_length\": 20}\n{\"te".to_vec()),
        Manner::Slow("the white one".to_owned(), PATIENCE),
    ] {
        server.behave(manner.clone());
        let began = Instant::now();
        assert_eq!(transcribe(&client(&server, ANSWER)), late, "{manner:?}");
        assert!(began.elapsed() >= ANSWER, "{manner:?}");
        // Far less than the slow server takes.
        assert!(began.elapsed() < PATIENCE / 2, "{manner:?}: {:?}", began.elapsed());
    }
    // More than the sockets hold, to a server that reads nothing.
    server.behave(Manner::Deaf);
    let client = client(&server, ANSWER);
    let long = client.transcribe((&vec![7; 16_000_000], 16_000), ("en", &[]), &|| false);
    assert_eq!(long, late);
}

#[test]
fn client_ends_when_it_is_cancelled() {
    let server = StandIn::start(Manner::Bytes(Vec::new()));
    let asked = Cell::new(0);
    let is_cancelled = || asked.replace(asked.get() + 1) > 8;
    let client = client(&server, PATIENCE);
    let ended = client.transcribe((&[7; 1_000], 16_000), ("en", &[]), &is_cancelled);
    assert_eq!(ended, Err(ClientError::Cancelled));
}

#[test]
fn client_reports_garbage_failures_and_cut_answers() {
    let server = StandIn::start(Manner::Deaf);
    let client = client(&server, PATIENCE);
    let long = format!("{{\"type\": \"transcript\", \"data_length\": {}}}\n", PART_MAX + 1);
    for (manner, expected) in [
        (Manner::Error("no model".to_owned()), "it reports: no model"),
        (Manner::Bytes(b"HTTP/1.1 400 Bad Request\r\n".to_vec()), "header is not JSON"),
        (Manner::Bytes(vec![0xFF; 2 << 20]), "header has"),
        (Manner::Bytes(long.into_bytes()), "its data has 1048577 bytes"),
        (Manner::Bytes(b"{\"type\": \"transcript\"}\n".to_vec()), "`text` is missing"),
        (Manner::Cut(Vec::new()), "ended the connection"),
        (Manner::Cut(b"{\"type\": \"transcript\", \"data_length\": 20}\n{\"te".to_vec()), "ended"),
    ] {
        server.behave(manner.clone());
        let error = transcribe(&client).unwrap_err().to_string();
        assert!(error.contains(expected), "{manner:?}: {error}");
    }
}

#[test]
fn client_examines_a_server_for_its_own_kind_of_program() {
    let program = Program { name: "piper".to_owned(), version: None };
    let server = StandIn::start(Manner::Offers(Info { asr: Vec::new(), tts: vec![program] }));
    let client = client(&server, PATIENCE);
    let found = client.examine(Kind::Voice, &|| false);
    assert_eq!(found, Ok(format!("piper at {}", server.address)));
    let missing = client.examine(Kind::Recogniser, &|| false).unwrap_err();
    assert_eq!(missing.to_string(), "it offers no recogniser");
}

#[test]
fn client_refuses_sound_that_does_not_hold_together() {
    let server = StandIn::start(Manner::Deaf);
    let client = client(&server, PATIENCE);
    let other = AudioFormat { rate_hz: 8_000, ..FORMAT };
    let start = || Event::AudioStart(FORMAT);
    let chunk = || Event::AudioChunk(FORMAT, vec![1; 100]);
    let endless: Vec<Event> =
        (0..=SOUND_MAX / PART_MAX).map(|_| Event::AudioChunk(FORMAT, vec![1; PART_MAX])).collect();
    for (events, expected) in [
        (vec![start(), Event::AudioStop], "empty"),
        (vec![Event::AudioStop], "empty"),
        (vec![start(), start()], "begins twice"),
        (vec![start(), Event::AudioChunk(other, vec![1; 100])], "changes its format"),
        (vec![start(), chunk()], "ended the connection"),
        (endless, "longer than two minutes"),
    ] {
        let mut bytes = Vec::new();
        events.iter().for_each(|event| Frame::from(event).write(&mut bytes).unwrap());
        server.behave(Manner::Cut(bytes));
        let error = synthesize(&client).unwrap_err().to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}
