//! Speech over the robot's own voice and right behind it, and the stop word under load.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use messages::{ArmStatus, PresentationState, Presented, Receipt, ReceiptStatus, Source, topics};
use serde_json::json;
use service::bus::Reader;
use service::client::Client;
use service::{Span, Time, clock};
use speech::devices::audio::{read_wav, seconds};
use speech::devices::voice::Synthesiser;
use whichone_tests::console::Page;
use whichone_tests::spoken::{Pink, Room, SPEECH_RMS, Speaker, levelled};
use whichone_tests::{Group, wait_for};

use crate::console_voice::{ALOUD, ECHO_FREE, Stream, listening, receipt, said};
use crate::speech::spoken;

/// Keeps every core busy until dropped.
struct Load(Arc<AtomicBool>);

impl Load {
    fn begin() -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        for _ in 0..std::thread::available_parallelism().unwrap().get() {
            let is_over = Arc::clone(&is_over);
            std::thread::spawn(move || while !is_over.load(Ordering::Relaxed) {});
        }
        Self(is_over)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Says "stop" to the page and waits until the arm has stopped. Returns the time in between, seconds.
fn stops_by_word(group: &Group, page: &mut Page) -> f64 {
    let client = Client::join(group.paths()).unwrap();
    let arm = client.bus().reader::<ArmStatus>(&topics::STATUS).unwrap();
    let sound = said("stop", 1.0);
    let end = sound.iter().rposition(|sample| sample.unsigned_abs() > 300).unwrap();
    let mut stream = Stream::begin(page, 9);
    stream.send(page, ECHO_FREE, &sound, |ms| ms);
    let ended = Time((stream.ms(end as u64) * 1e6) as u64);
    let stopped = wait_for("a stopped arm", 60.0, || {
        let mut stopped = None;
        arm.drain_stamped(|status, stamp| {
            if status.stopped == 1 {
                stopped = stopped.or(Some(Time(stamp.sent_ns)));
            }
        })
        .unwrap();
        stopped
    });
    stream.end(page, ECHO_FREE);
    stopped.since(ended).s()
}

/// It waited for the whole recording.
#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn stop_is_obeyed_while_a_long_recording_is_decoded_on_busy_cores() {
    let folder = tempfile::tempdir().unwrap();
    let (group, mut page) = listening(&["speech.recording_s_max=600"]);
    let sentence = "get me the small white plastic bowl from the counter in the kitchen please";
    let words = read_wav(Path::new(&spoken(sentence, folder.path())), 20.0).unwrap();
    let long = [words, vec![0; 16_000]].concat().repeat(20);
    let file = folder.path().join("long.wav");
    write_wav(&file, &long);
    let load = Load::begin();
    std::thread::scope(|scope| {
        let listen = scope.spawn(|| group.call(&["listen", &file.display().to_string()]));
        page.until_part("hearing", |hearing| hearing["pending"] == 1);
        let seconds = stops_by_word(&group, &mut page);
        eprintln!("stop while a recording is decoded: {seconds:.2} s");
        assert!(!listen.is_finished(), "it was decoded before the stop");
        listen.join().unwrap();
    });
    drop(load);
    drop(page);
    group.down();
}

/// Samples at 16 kHz as a WAV file.
fn write_wav(path: &Path, samples: &[i16]) {
    let length = samples.len() as u32 * 2;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((length + 36).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    bytes.extend(16_000_u32.to_le_bytes());
    bytes.extend(32_000_u32.to_le_bytes());
    bytes.extend(b"\x02\0\x10\0data");
    bytes.extend(length.to_le_bytes());
    samples.iter().for_each(|sample| bytes.extend(sample.to_le_bytes()));
    std::fs::write(path, bytes).unwrap();
}

/// Settings by which every line of the robot lasts a quarter of a minute.
fn slow_voice() -> String {
    let words = "Take as long as you like to think about it. ".repeat(3);
    let script = format!("espeak-ng -s 80 -w $1 \\\"$0 {words}\\\"");
    format!("speech.voice_command=[\"sh\", \"-c\", \"{script}\", \"{{text}}\", \"{{wav}}\"]")
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn stop_is_obeyed_while_the_robot_speaks_where_it_can_be_interrupted() {
    let (group, mut page) = listening(&["speech.voice=command", &slow_voice(), ALOUD[1]]);
    page.ask("say", &json!({ "text": "get me the bowl" }));
    let speaking = page.until_part("speaking", |speaking| speaking["state"] == "speaking");
    let load = Load::begin();
    let seconds = stops_by_word(&group, &mut page);
    eprintln!("stop while the robot speaks: {seconds:.2} s");
    receipt(&mut page, 9, "accepted");
    page.until_part("speaking", |now| *now != speaking);
    drop(load);
    drop(page);
    group.down();
}

/// A kitchen with a robot that hears itself: an open microphone without echo cancellation.
struct Kitchen {
    folder: tempfile::TempDir,
    room: Room,
    group: Group,
    presented: Reader<Presented>,
    receipts: Reader<Receipt>,
    user: Synthesiser,
    _client: Client,
}

/// A line of the robot.
#[derive(Clone, Copy, PartialEq)]
struct Line {
    prompt: u64,
    began: Time,
    /// When its sound ends.
    ends: Time,
}

impl Kitchen {
    fn new(settings: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("microphone");
        let room = Room::open(&pipe, Pink::new(SPEECH_RMS / 300.0, 1));
        let voice = format!("speech.voice_dir={}", folder.path().join("lines").display());
        let command = format!("speech.microphone.command=[\"cat\", \"{}\"]", pipe.display());
        let mut all = vec!["speech.microphone.mode=hands-free", &command, &voice, ALOUD[1]];
        all.extend(settings);
        let group = Group::up(&all);
        let client = Client::join(group.paths()).unwrap();
        let presented = client.bus().reader(&topics::PRESENTED).unwrap();
        let receipts = client.bus().reader(&topics::RECEIPT).unwrap();
        let user = Speaker::flite("slt").synthesiser(&folder.path().join("user"));
        wait_for("an open microphone", 60.0, || {
            let hearing = group.status()["hearing"].take();
            (hearing["microphone"] == "listening" && hearing["recogniser"] == "ready").then_some(())
        });
        Self { folder, room, group, presented, receipts, user, _client: client }
    }

    /// Waits until the robot begins a line after `since`, and has it sound in the room.
    fn line_after(&self, since: Time) -> Line {
        let presented = wait_for("a line", 40.0, || {
            let latest = self.presented.latest().unwrap()?;
            let is_new = latest.started_ns > since.ns();
            (latest.state == PresentationState::Speaking && is_new).then_some(latest)
        });
        let name = format!("lines/line-{}-{}.wav", presented.prompt, presented.presentation);
        let sound = read_wav(&self.folder.path().join(name), 60.0).unwrap();
        let began = Time(presented.started_ns);
        let ends = began + Span::from_s(seconds(sound.len()));
        self.room.play(began, levelled(&sound));
        Line { prompt: presented.prompt, began, ends }
    }

    /// Has the user speak at `at`. Returns when the voice ends.
    fn says(&mut self, at: Time, text: &str) -> Time {
        let samples = self.user.samples(text).unwrap();
        self.room.say(at, levelled(&samples)).1
    }

    fn receipt(&self) -> Receipt {
        wait_for("what is heard at the microphone", 20.0, || {
            let mut found = None;
            self.receipts
                .drain(|receipt| {
                    if receipt.source == Source::Microphone {
                        found = found.or(Some(*receipt));
                    }
                })
                .unwrap();
            found
        })
    }

    fn down(self) {
        let Self { group, room, presented, receipts, _client, .. } = self;
        drop((presented, receipts, _client));
        group.verify_journals();
        group.down();
        drop(room);
    }
}

/// The first third of a second after a question was lost, and what began in it.
#[test]
#[ignore = "needs espeak-ng, flite and pocketsphinx"]
fn answer_in_the_echo_of_the_question_is_heard_from_its_beginning() {
    let mut kitchen = Kitchen::new(&[ALOUD[0]]);
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    let begins = line.ends + Span::from_ms(170);
    kitchen.says(begins, "no");
    let receipt = kitchen.receipt();
    assert_eq!(receipt.status, ReceiptStatus::Accepted, "{receipt:?}");
    assert_eq!(receipt.note.as_str().unwrap(), "no");
    let late_s = Time(receipt.onset_ns).since(begins).s();
    assert!(late_s < 0.1, "{late_s} s of it are missing");
    kitchen.line_after(line.ends);
    kitchen.down();
}

/// "No, it is not the small white bowl" was understood as "the small white bowl".
#[test]
#[ignore = "needs espeak-ng, flite and pocketsphinx"]
fn words_whose_beginning_the_robot_covers_are_asked_for_again() {
    let mut kitchen = Kitchen::new(&[ALOUD[0]]);
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    kitchen.says(line.ends - Span::from_ms(500), "no it is not the small white plastic bowl");
    let receipt = kitchen.receipt();
    assert_eq!(receipt.status, ReceiptStatus::NotForMe, "{receipt:?}");
    let heard = receipt.note.as_str().unwrap();
    assert!(heard.starts_with('…') && heard.contains("white"), "{heard}");
    let again = kitchen.line_after(line.ends);
    assert_eq!(again.prompt, line.prompt, "the same question");
    kitchen.says(again.ends + Span::from_ms(700), "no");
    let receipt = kitchen.receipt();
    assert_eq!(receipt.status, ReceiptStatus::Accepted, "{receipt:?}");
    kitchen.down();
}

/// The limit without echo cancellation: `docs/speech.md` names what to use instead.
#[test]
#[ignore = "needs espeak-ng, flite and pocketsphinx"]
fn stop_is_not_heard_over_the_robots_own_voice_by_a_microphone_that_records_it() {
    let mut kitchen = Kitchen::new(&["speech.voice=command", &slow_voice()]);
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    let said = kitchen.says(clock::now() + Span::from_ms(500), "stop");
    assert!(said < line.ends, "it was said while the robot spoke");
    std::thread::sleep(Duration::from_secs_f64(said.since(clock::now()).s() + 2.0));
    assert_eq!(kitchen.group.arm()["stopped"], false);
    kitchen.group.must(&["stop-motion"]);
    assert_eq!(kitchen.group.arm()["stopped"], true);
    kitchen.down();
}
