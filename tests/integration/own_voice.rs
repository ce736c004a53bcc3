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
use speech_engines::audio::{read_wav, seconds, write_wav};
use speech_engines::recogniser::{PocketSphinx, PocketSphinxOptions, Recogniser};
use speech_engines::voice::Synthesiser;
use whichone_tests::console::Page;
use whichone_tests::spoken::{Pink, Room, SPEAKERS, SPEECH_RMS, Speaker, levelled};
use whichone_tests::{Group, YES_NO, wait_for, wait_for_or_none};

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
    // Minutes of speech, so that no machine is done before the stop.
    let long = [words, vec![0; 16_000]].concat().repeat(80);
    let file = folder.path().join("long.wav");
    write_wav(&file, &long).unwrap();
    let load = Load::begin();
    let mut listen = group.command(&["listen", &file.display().to_string()]).spawn().unwrap();
    page.until_part("hearing", |hearing| hearing["pending"] == 1);
    let seconds = stops_by_word(&group, &mut page);
    eprintln!("stop while a recording is decoded: {seconds:.2} s");
    assert!(listen.try_wait().unwrap().is_none(), "it was decoded before the stop");
    drop(load);
    listen.kill().unwrap();
    listen.wait().unwrap();
    drop(page);
    group.down();
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

    /// What the user will say: a synthesiser takes its time.
    fn words(&mut self, text: &str) -> Vec<i16> {
        levelled(&self.user.samples(text).unwrap())
    }

    /// Waits for the receipt of what ends at `end`. Where the machine is busy some of the robot's own voice
    /// arrives late, and is heard before it.
    fn receipt(&self, end: Time) -> Receipt {
        let is_it = |receipt: &Receipt| {
            receipt.source == Source::Microphone && Time(receipt.end_ns) + Span::from_ms(300) > end
        };
        let found = wait_for_or_none(40.0, || {
            let mut found = None;
            self.receipts
                .drain(|receipt| {
                    if is_it(receipt) {
                        found = found.or(Some(*receipt));
                    }
                })
                .unwrap();
            found
        });
        found
            .unwrap_or_else(|| panic!("nothing was heard at the microphone\n{}", self.group.logs()))
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
    let no = kitchen.words("no");
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    let (begins, ends) = kitchen.room.say(line.ends + Span::from_ms(170), no);
    let receipt = kitchen.receipt(ends);
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
    let mut kitchen = Kitchen::new(&[ALOUD[0], YES_NO]);
    let words = kitchen.words("no it is not the small white plastic bowl");
    let no = kitchen.words("no");
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    let (begins, ends) = kitchen.room.say(line.ends - Span::from_ms(500), words);
    assert!(begins < line.ends, "the machine is too slow");
    let receipt = kitchen.receipt(ends);
    assert_eq!(receipt.status, ReceiptStatus::NotForMe, "{receipt:?}");
    let heard = receipt.note.as_str().unwrap();
    assert!(heard.starts_with('…') && heard.contains("white"), "{heard}");
    let again = kitchen.line_after(line.ends);
    assert_eq!(again.prompt, line.prompt, "the same question");
    let (_, ends) = kitchen.room.say(again.ends + Span::from_ms(700), no);
    let receipt = kitchen.receipt(ends);
    assert_eq!(receipt.status, ReceiptStatus::Accepted, "{receipt:?}");
    kitchen.down();
}

/// How often a stop is recognised, cut out of the sound perfectly; `robot_db` is the level of the robot's
/// voice beside the user's.
fn recognised_stops(robot_db: Option<f64>) -> (usize, usize) {
    const STOPS: [&str; 8] =
        ["stop", "stop stop", "halt", "stop it", "stop now", "freeze", "no stop", "wait stop"];
    const LEAD: usize = 8_000;
    let folder = tempfile::tempdir().unwrap();
    let scene = whichone_tests::settings(&[]).scene;
    let options = PocketSphinxOptions::debian(folder.path().join("recogniser"));
    let mut recogniser = PocketSphinx::open(&scene, &options).unwrap();
    let mut robot = Speaker::espeak("en-us", 165).synthesiser(&folder.path().join("robot"));
    let line = "I will get the white plastic bowl on the counter, and bring it to you now.";
    let line = levelled(&robot.samples(line).unwrap());
    let gain = robot_db.map_or(0.0, |db| 10_f64.powf(db / 20.0));
    let (mut found, mut all) = (0, 0);
    for speaker in SPEAKERS {
        let mut voice = speaker.synthesiser(&folder.path().join(speaker.name));
        for text in STOPS {
            let said = levelled(&voice.samples(text).unwrap());
            let noise = Pink::new(SPEECH_RMS / 10_f64.powf(25.0 / 20.0), all as u64);
            let sample = |(n, noise): (usize, f64)| {
                let user = n.checked_sub(LEAD).and_then(|n| said.get(n)).map_or(0, |s| *s);
                let robot = line.get(n + LEAD).map_or(0, |s| *s);
                (f64::from(user) + gain * f64::from(robot) + noise) as i16
            };
            let pcm: Vec<i16> = (0..LEAD + said.len() + 3_200).zip(noise).map(sample).collect();
            let heard = recogniser.recognise(&pcm, LEAD..LEAD + said.len()).unwrap();
            found += usize::from(
                heard.hypotheses.first().is_some_and(|best| language::is_stop(&best.text)),
            );
            all += 1;
        }
    }
    (found, all)
}

/// The reason why nothing listens for a stop while a microphone records the robot itself.
#[test]
#[ignore = "needs espeak-ng, flite and pocketsphinx"]
fn stop_is_recognised_but_not_over_the_robots_own_voice() {
    let (found, all) = recognised_stops(None);
    eprintln!("recognised: {found} of {all}");
    assert!(found * 10 > all * 7, "{found} of {all}");
    let (found, all) = recognised_stops(Some(-12.0));
    eprintln!("recognised with the robot 12 dB below the user: {found} of {all}");
    assert!(found * 10 < all * 3, "{found} of {all}");
}

/// The limit without echo cancellation: `docs/speech.md` names what to use instead.
#[test]
#[ignore = "needs espeak-ng, flite and pocketsphinx"]
fn stop_is_not_heard_over_the_robots_own_voice_by_a_microphone_that_records_it() {
    let mut kitchen = Kitchen::new(&["speech.voice=command", &slow_voice()]);
    kitchen.group.say("get me the bowl");
    let line = kitchen.line_after(Time(0));
    let stop = kitchen.words("stop");
    let (_, said) = kitchen.room.say(clock::now() + Span::from_ms(500), stop);
    assert!(said < line.ends, "it was said while the robot spoke");
    std::thread::sleep(Duration::from_secs_f64(said.since(clock::now()).s() + 2.0));
    assert_eq!(kitchen.group.arm()["stopped"], false);
    kitchen.group.must(&["stop-motion"]);
    kitchen.group.wait_shown(true);
    kitchen.down();
}
