use std::path::Path;
use std::time::Instant;

use crossbeam_channel::{Receiver, unbounded};
use runtime::clock;
use vocabulary::time::{Span, Time};

use super::*;
use crate::live_events::{LiveEvent, MicrophoneStatus};
use crate::stream::{Began, SpeechSegment, StreamEvent};
use crate::testing::voice;

const PATIENCE: Duration = Duration::from_secs(20);

struct Listening {
    microphone: Microphone,
    events: Receiver<LiveEvent>,
    mask: Arc<PlaybackMask>,
}

fn listen(options: MicrophoneOptions) -> Listening {
    listen_behind(options, |_| {})
}

/// Starts the microphone after a change of the mask.
fn listen_behind(options: MicrophoneOptions, prepare: impl Fn(&PlaybackMask)) -> Listening {
    let (send, events) = unbounded();
    let sink = move |event| {
        let _ = send.send(event);
        Ok(())
    };
    let mask = Arc::new(PlaybackMask::new(Span::from_ms(300)));
    prepare(&mask);
    let microphone = Microphone::start(options, Arc::clone(&mask), Arc::default(), Box::new(sink));
    Listening { microphone, events, mask }
}

/// Returns options with these shell scripts as programs, and short delays.
fn options(scripts: &[String]) -> MicrophoneOptions {
    let shell = |script: &String| vec!["sh".to_owned(), "-c".to_owned(), script.clone()];
    MicrophoneOptions {
        programs: scripts.iter().map(shell).collect(),
        pause: Duration::from_millis(200),
        retry: (Duration::from_millis(10), Duration::from_millis(40)),
        ..MicrophoneOptions::hands_free()
    }
}

/// Writes a file of raw audio: half a second of quiet, a voice, and the quiet after it.
fn raw(folder: &Path, quiet_after_s: f64) -> String {
    let quiet = |s: f64| vec![0_i16; (s * 16_000.0) as usize];
    let samples = [quiet(0.5), voice(0.8), quiet(quiet_after_s)].concat();
    let path = folder.join(format!("{quiet_after_s}.raw"));
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    std::fs::write(&path, bytes).unwrap();
    path.display().to_string()
}

impl Listening {
    fn next<T>(&self, what: &str, mut wanted: impl FnMut(LiveEvent) -> Option<T>) -> T {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            let event = self.events.recv_timeout(PATIENCE).expect("an event in time");
            if let Some(found) = wanted(event) {
                return found;
            }
        }
        panic!("{what}: not within {PATIENCE:?}")
    }

    fn event(&self) -> StreamEvent {
        self.next("an utterance", |event| match event {
            LiveEvent::Stream(event) if !event.is_optional() => Some(event),
            _ => None,
        })
    }

    fn utterance(&self) -> (Began, SpeechSegment) {
        let StreamEvent::Began(began) = self.event() else { panic!("expected a beginning") };
        match self.event() {
            StreamEvent::Ended { sound, segment } if sound == began.sound => (began, segment),
            other => panic!("{other:?}"),
        }
    }

    fn status(&self, wanted: impl Fn(&MicrophoneStatus) -> bool) -> MicrophoneStatus {
        self.next("the status", |event| match event {
            LiveEvent::Microphone(status) if wanted(&status) => Some(status),
            _ => None,
        })
    }
}

#[test]
fn microphone_reports_utterances_with_times_and_level() {
    let folder = tempfile::tempdir().unwrap();
    let before = clock::now();
    let heard = listen(options(&[format!("cat {}; exec sleep 30", raw(folder.path(), 1.0))]));
    let (began, segment) = heard.utterance();
    assert!(!began.interrupts && began.at == segment.onset);
    let length = segment.end.since(segment.onset).s();
    assert!((0.6..1.1).contains(&length), "{length} s");
    assert!(began.at > before - Span::from_s(3.0) && segment.end < clock::now());
    let status = heard.status(|status| status.state == MicrophoneState::Listening);
    assert_eq!(status.note, "sh");
    assert!(status.level_db > -60.0, "{status:?}");
}

#[test]
fn microphone_ends_the_utterance_when_the_source_pauses_or_dies() {
    let folder = tempfile::tempdir().unwrap();
    // No quiet after the voice: first the source pauses, then it exits.
    let file = raw(folder.path(), 0.0);
    let heard = listen(options(&[format!("cat {file}; sleep 0.4; cat {file}")]));
    let (first, _) = heard.utterance();
    let (second, _) = heard.utterance();
    assert_ne!(first.sound, second.sound);
    assert_ne!(first.stream, second.stream);
    heard.status(|status| status.state == MicrophoneState::Broken && status.restarts == 1);
    let (third, _) = heard.utterance();
    assert!(third.sound > second.sound);
}

#[test]
fn microphone_uses_the_first_program_that_works() {
    let folder = tempfile::tempdir().unwrap();
    let works = format!("cat {}; exec sleep 30", raw(folder.path(), 1.0));
    let heard = listen(options(&["echo no card >&2; exit 1".to_owned(), works]));
    heard.status(|status| status.state == MicrophoneState::Broken && status.note.contains("sh"));
    heard.utterance();
    let none =
        MicrophoneOptions { programs: vec![vec!["no-such-recorder".to_owned()]], ..options(&[]) };
    let heard = listen(none);
    let status = heard.status(|status| status.restarts == 3);
    assert!(status.note.contains("no-such-recorder is not installed"), "{status:?}");
}

#[test]
fn microphone_that_fails_reports_what_the_installed_program_said() {
    let failing = ["sh", "-c", "echo no such card >&2; exit 1"].map(str::to_owned).to_vec();
    let programs = vec![failing, vec!["no-such-recorder".to_owned()]];
    let heard = listen(MicrophoneOptions { programs, ..options(&[]) });
    for restarts in [2, 4] {
        let status = heard.status(|status| status.restarts == restarts);
        assert!(status.note.contains("no such card"), "{status:?}");
    }
}

#[test]
fn microphone_mutes_the_robots_own_voice() {
    let folder = tempfile::tempdir().unwrap();
    let go = folder.path().join("go");
    let file = raw(folder.path(), 1.0);
    let script = format!(
        "cat {file}; while [ ! -e {} ]; do sleep 0.02; done; cat {file}; exec sleep 30",
        go.display()
    );
    let heard = listen_behind(options(&[script]), |mask| mask.begins(Time(0)));
    heard.next("the first sound", |event| match event {
        LiveEvent::Microphone(status) => (status.state == MicrophoneState::Muted).then_some(()),
        event => panic!("the robot heard itself: {event:?}"),
    });
    heard.mask.ends(Time(1));
    std::fs::write(go, "").unwrap();
    let (began, _) = heard.utterance();
    assert!(!began.interrupts);
}

#[test]
fn microphone_opens_for_one_utterance_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let script = format!("cat {}; exec sleep 30", raw(folder.path(), 1.0));
    let heard = listen(MicrophoneOptions { hands_free: false, ..options(&[script]) });
    heard.status(|status| status.state == MicrophoneState::Closed);
    heard.mask.begins(Time(0));
    for sound in [7, 8] {
        heard.microphone.talk(sound, PATIENCE).unwrap();
        let (began, _) = heard.utterance();
        assert_eq!(began.sound, sound);
        assert!(began.interrupts, "push-to-talk interrupts the robot");
        heard.status(|status| status.state == MicrophoneState::Closed);
    }
}

#[test]
fn microphone_answers_a_request_without_speech_or_program() {
    let silent = MicrophoneOptions {
        hands_free: false,
        ..options(&["cat /dev/zero | head -c 64000; exec sleep 30".to_owned()])
    };
    let heard = listen(silent);
    heard.microphone.talk(7, Duration::from_millis(300)).unwrap();
    match heard.event() {
        StreamEvent::Silent { sound: 7, reason } => {
            assert!(reason.contains("no speech heard"), "{reason}")
        }
        other => panic!("{other:?}"),
    }
    let broken = MicrophoneOptions { hands_free: false, ..options(&["exit 1".to_owned()]) };
    let heard = listen(broken);
    heard.microphone.talk(7, PATIENCE).unwrap();
    match heard.event() {
        StreamEvent::Silent { sound: 7, reason } => {
            assert!(reason.contains("microphone") && reason.contains("speech.toml"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}
