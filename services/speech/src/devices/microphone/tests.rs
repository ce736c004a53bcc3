use std::path::Path;
use std::time::Instant;

use crossbeam_channel::{Receiver, unbounded};
use service::clock;
use service::{Span, Time};

use super::*;
use crate::devices::stream::Cut;
use crate::devices::testing::voice;
use crate::live::Began;

const PATIENCE: Duration = Duration::from_secs(20);

struct Heard {
    microphone: Microphone,
    events: Receiver<MicrophoneEvent>,
    own_voice: Arc<OwnVoice>,
}

fn listen(options: MicrophoneOptions) -> Heard {
    let (send, events) = unbounded();
    let sink = move |event| {
        let _ = send.send(event);
        Ok(())
    };
    let own_voice = Arc::new(OwnVoice::new(Span::from_ms(300)));
    let microphone = Microphone::start(options, Arc::clone(&own_voice), Box::new(sink));
    Heard { microphone, events, own_voice }
}

/// Options with these shell scripts as programs, and short pauses.
fn options(scripts: &[String]) -> MicrophoneOptions {
    let shell = |script: &String| vec!["sh".to_owned(), "-c".to_owned(), script.clone()];
    MicrophoneOptions {
        programs: scripts.iter().map(shell).collect(),
        pause: Duration::from_millis(200),
        retry: (Duration::from_millis(10), Duration::from_millis(40)),
        ..MicrophoneOptions::hands_free()
    }
}

/// A file of raw sound: half a second of quiet, a voice, and the quiet behind it.
fn raw(folder: &Path, quiet_behind_s: f64) -> String {
    let quiet = |s: f64| vec![0_i16; (s * 16_000.0) as usize];
    let sound = [quiet(0.5), voice(0.8), quiet(quiet_behind_s)].concat();
    let path = folder.join(format!("{quiet_behind_s}.raw"));
    let bytes: Vec<u8> = sound.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    std::fs::write(&path, bytes).unwrap();
    path.display().to_string()
}

impl Heard {
    fn next<T>(&self, what: &str, mut wanted: impl FnMut(MicrophoneEvent) -> Option<T>) -> T {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            let event = self.events.recv_timeout(PATIENCE).expect("an event in time");
            if let Some(found) = wanted(event) {
                return found;
            }
        }
        panic!("{what}: not within {PATIENCE:?}")
    }

    fn live(&self) -> Live {
        self.next("an utterance", |event| match event {
            MicrophoneEvent::Live(live) if !live.is_hint() => Some(live),
            MicrophoneEvent::Live(_) | MicrophoneEvent::Status(_) => None,
        })
    }

    fn utterance(&self) -> (Began, Cut) {
        let Live::Began(began) = self.live() else { panic!("a beginning first") };
        match self.live() {
            Live::Ended { sound, cut } if sound == began.sound => (began, cut),
            other => panic!("{other:?}"),
        }
    }

    fn status(&self, wanted: impl Fn(&MicrophoneStatus) -> bool) -> MicrophoneStatus {
        self.next("the status", |event| match event {
            MicrophoneEvent::Status(status) if wanted(&status) => Some(status),
            _ => None,
        })
    }
}

#[test]
fn a_person_is_heard_with_times_on_the_clock_of_all() {
    let folder = tempfile::tempdir().unwrap();
    let before = clock::now();
    let heard = listen(options(&[format!("cat {}; exec sleep 30", raw(folder.path(), 1.0))]));
    let (began, cut) = heard.utterance();
    assert!(!began.interrupts && began.at == cut.onset);
    let length = cut.end.since(cut.onset).s();
    assert!((0.6..1.1).contains(&length), "{length} s");
    assert!(began.at > before - Span::from_s(3.0) && cut.end < clock::now());
    let status = heard.status(|status| status.state == MicrophoneState::Listening);
    assert_eq!(status.note, "sh");
    assert!(status.level_db > -60.0, "{status:?}");
}

#[test]
fn a_source_that_pauses_or_dies_ends_the_utterance_and_is_started_again() {
    let folder = tempfile::tempdir().unwrap();
    // No quiet behind the voice: first the source is silent, then it is gone.
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
fn the_first_program_that_works_is_used_and_none_is_told() {
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
fn the_robots_own_voice_is_not_heard() {
    let folder = tempfile::tempdir().unwrap();
    let go = folder.path().join("go");
    let file = raw(folder.path(), 1.0);
    let script = format!(
        "cat {file}; while [ ! -e {} ]; do sleep 0.02; done; cat {file}; exec sleep 30",
        go.display()
    );
    let ready = options(&[script]);
    let (send, events) = unbounded();
    let own_voice = Arc::new(OwnVoice::new(Span::from_ms(300)));
    own_voice.begins(Time(0));
    let sink = Box::new(move |event| {
        let _ = send.send(event);
        Ok(())
    });
    let microphone = Microphone::start(ready, Arc::clone(&own_voice), sink);
    let heard = Heard { microphone, events, own_voice };
    heard.next("the first sound", |event| match event {
        MicrophoneEvent::Status(status) => (status.state == MicrophoneState::Muted).then_some(()),
        MicrophoneEvent::Live(live) => panic!("the robot heard itself: {live:?}"),
    });
    heard.own_voice.ends(Time(1));
    std::fs::write(go, "").unwrap();
    let (began, _) = heard.utterance();
    assert!(!began.interrupts);
}

#[test]
fn a_request_to_talk_opens_the_microphone_for_one_utterance() {
    let folder = tempfile::tempdir().unwrap();
    let script = format!("cat {}; exec sleep 30", raw(folder.path(), 1.0));
    let heard = listen(MicrophoneOptions { hands_free: false, ..options(&[script]) });
    heard.status(|status| status.state == MicrophoneState::Closed);
    heard.own_voice.begins(Time(0));
    for sound in [7, 8] {
        heard.microphone.talk(sound, PATIENCE).unwrap();
        let (began, _) = heard.utterance();
        assert_eq!(began.sound, sound);
        assert!(began.interrupts, "whoever talks makes the robot fall silent");
        heard.status(|status| status.state == MicrophoneState::Closed);
    }
}

#[test]
fn a_request_to_talk_is_answered_although_nobody_speaks_or_nothing_records() {
    let silent = MicrophoneOptions {
        hands_free: false,
        ..options(&["cat /dev/zero | head -c 64000; exec sleep 30".to_owned()])
    };
    let heard = listen(silent);
    heard.microphone.talk(7, Duration::from_millis(300)).unwrap();
    match heard.live() {
        Live::Silent { sound: 7, reason } => {
            assert!(reason.contains("nobody was heard"), "{reason}")
        }
        other => panic!("{other:?}"),
    }
    let broken = MicrophoneOptions { hands_free: false, ..options(&["exit 1".to_owned()]) };
    let heard = listen(broken);
    heard.microphone.talk(7, PATIENCE).unwrap();
    match heard.live() {
        Live::Silent { sound: 7, reason } => {
            assert!(reason.contains("microphone") && reason.contains("speech.toml"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}
