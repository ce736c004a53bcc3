//! Voice through the console: sound over a socket.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value as Json, json};
use speech_engines::audio::read_wav;
use tungstenite::Message;
use whichone_tests::console::{Page, Visitor};
use whichone_tests::{EARS, Group};

use crate::speech::spoken;

const END: u8 = 1;
const HELD: u8 = 2;
pub(crate) const ECHO_FREE: u8 = 4;
/// Samples of a frame: 50 ms.
const PIECE: usize = 800;
/// Every sentence takes as long as it would sound.
pub(crate) const ALOUD: [&str; 2] = ["speech.voice=espeak-ng", "speech.player=[\"none\"]"];

/// A stream of a page that sends it in real time.
pub(crate) struct Stream {
    number: u32,
    sent: u64,
    began: Instant,
    /// The server's time at which it began, milliseconds.
    began_ms: f64,
}

impl Stream {
    pub(crate) fn begin(page: &mut Page, number: u32) -> Self {
        page.send(&json!({ "t": "ping", "at": number }));
        let pong = page.until("a pong", |page| {
            page.messages
                .iter()
                .find(|message| message["t"] == "pong" && message["at"] == number)
                .cloned()
        });
        let began_ms = pong["server_ms"].as_f64().unwrap();
        Self { number, sent: 0, began: Instant::now(), began_ms }
    }

    /// When a sample is taken.
    pub(crate) fn at(&self, sample: usize) -> Instant {
        self.began + Duration::from_secs_f64(sample as f64 / 16_000.0)
    }

    pub(crate) fn ms(&self, sample: u64) -> f64 {
        self.began_ms + sample as f64 / 16.0
    }

    /// Sends samples as they are taken, with the times that `clock` makes of the right ones.
    pub(crate) fn send(
        &mut self,
        page: &mut Page,
        flags: u8,
        samples: &[i16],
        clock: impl Fn(f64) -> f64,
    ) {
        for piece in samples.chunks(PIECE) {
            let taken_ms = clock(self.ms(self.sent));
            page.send_raw(frame(self.number, flags, taken_ms, self.sent, piece));
            self.sent += piece.len() as u64;
            let until = self.at(self.sent as usize);
            std::thread::sleep(until.saturating_duration_since(Instant::now()));
        }
    }

    pub(crate) fn end(&self, page: &mut Page, flags: u8) {
        page.send_raw(frame(self.number, flags | END, self.ms(self.sent), self.sent, &[]));
    }
}

fn frame(stream: u32, flags: u8, taken_ms: f64, before: u64, samples: &[i16]) -> Message {
    let mut bytes = vec![1, flags, 0, 0];
    bytes.extend(stream.to_le_bytes());
    bytes.extend(taken_ms.to_le_bytes());
    bytes.extend(before.to_le_bytes());
    samples.iter().for_each(|sample| bytes.extend(sample.to_le_bytes()));
    Message::Binary(bytes.into())
}

/// The words with a fifth of a second of quiet before them and `behind_s` behind.
pub(crate) fn said(text: &str, behind_s: f64) -> Vec<i16> {
    let folder = tempfile::tempdir().unwrap();
    let words = read_wav(Path::new(&spoken(text, folder.path())), 20.0).unwrap();
    [vec![0; 3_200], words, vec![0; (behind_s * 16_000.0) as usize]].concat()
}

/// A group that hears, and a page that is in control of it.
pub(crate) fn listening(settings: &[&str]) -> (Group, Page) {
    let group = Group::up(&[settings, &[EARS]].concat());
    let mut page = group.page(&Visitor::operator(1));
    page.until_part("hearing", |hearing| hearing["recogniser"] == "ready");
    page.until_part("turn", |turn| turn["state"] != "down");
    (group, page)
}

pub(crate) fn receipt(page: &mut Page, stream: u32, status: &str) -> Json {
    let is = |message: &&Json| {
        message["t"] == "receipt" && message["stream"] == stream && message["status"] == status
    };
    page.until(status, |page| page.messages.iter().find(is).cloned())
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn held_stream_is_one_utterance_with_times_and_interim_results() {
    let (group, mut page) = listening(&[]);
    let mut stream = Stream::begin(&mut page, 7);
    stream.send(&mut page, HELD, &said("get me the small white bowl", 0.3), |ms| ms);
    stream.end(&mut page, HELD);
    let accepted = receipt(&mut page, 7, "accepted");
    assert!(accepted["text"].as_str().unwrap().contains("white bowl"), "{accepted}");
    let onset = accepted["onset_ms"].as_f64().unwrap() - stream.began_ms;
    let ended = accepted["ended_ms"].as_f64().unwrap() - stream.began_ms;
    assert!((100.0..400.0).contains(&onset), "{onset} ms behind the beginning");
    assert!(ended > onset + 1_000.0 && ended <= stream.ms(stream.sent) - stream.began_ms + 1.0);
    let over = receipt(&mut page, 7, "over");
    assert_eq!((&over["utterances"], &over["text"]), (&json!(1), &json!("")));
    page.until("an interim result", |page| {
        let partial = |message: &&Json| message["t"] == "partial" && message["text"] != "";
        page.messages.iter().find(partial).map(|_| ())
    });
    page.until_line("what was understood", |line| {
        line["source"] == "stream" && line["understood"].is_array()
    });
    drop(page);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn answer_is_credited_to_the_question_that_was_heard() {
    let (group, mut page) = listening(&ALOUD);
    page.ask("say", &json!({ "text": "get me the bowl" }));
    let asked = page.until("a question said to its end", |page| {
        let (dialogue, turn) = (page.parts.get("dialogue")?, page.parts.get("turn")?);
        (turn["state"] == "asked" && dialogue["decision"] == "ask").then(|| dialogue.clone())
    });
    let mut stream = Stream::begin(&mut page, 1);
    stream.send(&mut page, ECHO_FREE, &said("no", 0.8), |ms| ms);
    stream.end(&mut page, ECHO_FREE);
    receipt(&mut page, 1, "accepted");
    let line = page.until_line("the answer", |line| line["answers"].is_array());
    assert_eq!(line["source"], "stream");
    let answers = line["answers"].as_array().unwrap();
    let share = answers.iter().find(|answer| answer["question"] == asked["text"]);
    assert!(share.is_some_and(|answer| answer["share"].as_f64() > Some(0.9)), "{line}");
    page.until_part("dialogue", |dialogue| {
        dialogue["decision"] == "ask" && dialogue["text"] != asked["text"]
    });
    drop(page);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn barge_in_with_the_key_held_interrupts_the_prompt() {
    let words = "Take as long as you like to think about it. ".repeat(6);
    let script = format!("espeak-ng -s 80 -w $1 \\\"$0 {words}\\\"");
    let command =
        format!("speech.voice_command=[\"sh\", \"-c\", \"{script}\", \"{{text}}\", \"{{wav}}\"]");
    let slow = ["speech.voice=command", command.as_str(), ALOUD[1]];
    let (group, mut page) = listening(&slow);
    page.ask("say", &json!({ "text": "get me the bowl" }));
    let speaking = page.until_part("speaking", |speaking| speaking["state"] == "speaking");
    let prompt = speaking["prompt"].clone();
    let mut stream = Stream::begin(&mut page, 1);
    stream.send(&mut page, HELD, &said("the small white bowl on the counter", 0.3), |ms| ms);
    // Its sound would last more than half a minute.
    page.until_part("speaking", |speaking| {
        let presentation = speaking["presentation"].as_u64();
        speaking["prompt"] != prompt || presentation > Some(1) || speaking["ended_ms"].is_number()
    });
    stream.end(&mut page, HELD);
    receipt(&mut page, 1, "accepted");
    drop(page);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn lost_connection_ends_the_utterance() {
    let (group, mut page) = listening(&[]);
    let mut watcher = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    let mut stream = Stream::begin(&mut page, 3);
    let words = said("get me the small white bowl", 0.0);
    stream.send(&mut page, HELD, &words[..words.len() - 8_000], |ms| ms);
    watcher.until_part("turn", |turn| turn["state"] == "hearing");
    drop(page);
    let line = watcher.until_line("what was said", |line| line["source"] == "stream");
    assert!(["person", "unmeant"].contains(&line["who"].as_str().unwrap()), "{line}");
    watcher.until_part("turn", |turn| turn["state"] != "hearing");
    watcher.until_part("control", |control| control["operator"].is_null());
    drop(watcher);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn only_the_operator_may_stream_sound() {
    let (group, mut page) = listening(&[]);
    let mut other = group.page(&Visitor::operator(2));
    other.send_raw(frame(1, HELD, 0.0, 0, &[0; PIECE]));
    let refused = other.until("a refusal", |page| {
        page.messages.iter().find(|message| message["t"] == "error").cloned()
    });
    assert!(refused["error"].as_str().unwrap().contains("control"), "{refused}");
    let mut stream = Stream::begin(&mut page, 1);
    stream.send(&mut page, HELD, &said("the clear bowl", 0.3), |ms| ms);
    stream.end(&mut page, HELD);
    receipt(&mut page, 1, "accepted");
    other.until_line("what the operator said", |line| line["who"] == "person");
    assert!(
        !other.messages.iter().any(|message| message["t"] == "receipt"),
        "it is the operator's"
    );
    drop((page, other));
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn frames_with_invalid_counts_and_times_are_harmless() {
    let (group, mut page) = listening(&[]);
    // Hours ago, of the future, no time at all, of a length that cannot be.
    page.send_raw(frame(1, HELD, f64::NAN, 0, &[0; PIECE]));
    page.send_raw(frame(1, HELD, 5.0, u64::MAX, &[0; PIECE]));
    page.send_raw(frame(2, HELD, 1e300, u64::MAX - 10_000, &[0; PIECE]));
    page.send_raw(frame(2, HELD, 1e300, u64::MAX - 9_000, &[0; PIECE]));
    page.send_raw(Message::Binary(vec![1, 2, 3].into()));
    page.send_raw(frame(3, HELD, 5.0, 0, &[0; 1_601]));
    let errors =
        |page: &Page| page.messages.iter().filter(|message| message["t"] == "error").count();
    page.until("four refusals", |page| (errors(page) >= 4).then_some(()));
    page.send_raw(frame(2, END, 0.0, 0, &[]));
    for (number, clock) in [(4, -3_600_000.0), (5, 3_600_000.0)] {
        let mut stream = Stream::begin(&mut page, number);
        let words = said("get me the small white bowl", 0.3);
        stream.send(&mut page, HELD, &words, |ms| (ms + clock).max(0.0));
        stream.end(&mut page, HELD);
        let accepted = receipt(&mut page, number, "accepted");
        let onset = accepted["onset_ms"].as_f64().unwrap() - stream.began_ms;
        assert!((0.0..3_000.0).contains(&onset), "{onset} ms behind the beginning");
    }
    drop(page);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn streams_end_and_resume_across_a_restart_of_speech() {
    let (group, mut page) = listening(&[]);
    let mut stream = Stream::begin(&mut page, 1);
    stream.send(&mut page, HELD, &[0; 8_000], |ms| ms);
    let before = group.incarnation("speech");
    group.signal("speech", rustix::process::Signal::KILL);
    group.wait_for_restart("speech", before);
    page.until_part("hearing", |hearing| hearing["recogniser"] == "ready");
    let mut stream = Stream::begin(&mut page, 2);
    stream.send(&mut page, HELD, &said("get me the small white bowl", 0.3), |ms| ms);
    stream.end(&mut page, HELD);
    receipt(&mut page, 1, "over");
    receipt(&mut page, 2, "accepted");
    receipt(&mut page, 2, "over");
    drop(page);
    group.down();
}
