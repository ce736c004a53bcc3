use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::time::Instant;

use tempfile::TempDir;

use super::*;

const PATIENCE: Duration = Duration::from_secs(20);

/// A folder with programs that stand in for espeak-ng and a player.
struct Stage {
    folder: TempDir,
    options: VoiceOptions,
}

impl Stage {
    /// The stand-in for espeak-ng copies a second of silence to where it is told to write; the
    /// player is the given script.
    fn new(mode: VoiceMode, player: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: 22_050,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut wav = hound::WavWriter::create(path("second.wav"), spec).unwrap();
        (0..22_050).for_each(|_| wav.write_sample(0_i16).unwrap());
        wav.finalize().unwrap();
        let copy = format!(
            "while [ $# -gt 0 ]; do [ \"$1\" = -w ] && cp {} \"$2\"; shift; done",
            path("second.wav").display()
        );
        let espeak_ng = script(&path("espeak"), &copy);
        let program = script(&path("player"), player).to_string_lossy().into_owned();
        let players = vec![Player { program, arguments: Vec::new() }];
        let options = VoiceOptions { mode, espeak_ng, players, ..VoiceOptions::new(path("work")) };
        Self { folder, options }
    }

    fn start(&self) -> (Voice, Receiver<VoiceEvent>) {
        Voice::start(self.options.clone())
    }
}

fn script(path: &Path, text: &str) -> PathBuf {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    path.to_owned()
}

fn next(events: &Receiver<VoiceEvent>) -> VoiceEvent {
    events.recv_timeout(PATIENCE).expect("an event in time")
}

/// Plays silence at once and sentences for as long as a test would ever wait.
const ENDLESS: &str = "case \"$1\" in *silence.wav) ;; *) exec sleep 60 ;; esac";

#[test]
fn print_starts_and_ends_at_once() {
    let stage = Stage::new(VoiceMode::Print, "exit 1");
    let (voice, events) = stage.start();
    assert!(matches!(next(&events), VoiceEvent::Output(VoiceOutput::Text { .. })));
    for id in [7, 8] {
        voice.speak(id, "Which bowl would you like?").unwrap();
        assert_eq!(next(&events), VoiceEvent::Started { id });
        assert_eq!(next(&events), VoiceEvent::Ended { id });
    }
}

#[test]
fn a_sentence_is_played_to_its_end() {
    let stage = Stage::new(VoiceMode::Auto, "echo \"$1\" >> \"$(dirname \"$0\")/played\"");
    let (voice, events) = stage.start();
    assert!(matches!(next(&events), VoiceEvent::Output(VoiceOutput::Aloud(_))));
    voice.speak(1, "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Ended { id: 1 });
    let played = fs::read_to_string(stage.folder.path().join("played")).unwrap();
    assert!(played.ends_with("work/sentence.wav\n"), "{played}");
}

#[test]
fn an_interruption_ends_the_current_sentence_and_calls_off_the_next() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "Is it white?").unwrap();
    voice.speak(2, "Is it small?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    let start = Instant::now();
    voice.interrupt();
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 2 });
    assert!(start.elapsed() < PATIENCE);
    voice.speak(3, "Is it big?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 3 });
}

#[test]
fn dropping_the_voice_ends_what_it_says() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    let start = Instant::now();
    drop(voice);
    assert!(start.elapsed() < PATIENCE);
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 1 });
    assert!(events.recv_timeout(PATIENCE).is_err(), "the thread is gone");
}

#[test]
fn without_a_sound_card_sentences_are_text_and_the_reason_is_told() {
    let stage = Stage::new(VoiceMode::Auto, "echo no soundcards found >&2; exit 1");
    let (voice, events) = stage.start();
    match next(&events) {
        VoiceEvent::Output(VoiceOutput::Text { reason }) => {
            assert!(reason.contains("no soundcards found"), "{reason}");
        }
        event => panic!("{event:?}"),
    }
    voice.speak(1, "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Ended { id: 1 });
}

#[test]
fn a_voice_that_must_be_heard_fails_without_its_programs() {
    let mut stage = Stage::new(VoiceMode::EspeakNg, "exit 0");
    stage.options.espeak_ng = "/nonexistent/espeak-ng".into();
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "Is it white?").unwrap();
    match next(&events) {
        VoiceEvent::Failed { id: 1, error } => {
            assert!(error.contains("install the package espeak-ng"), "{error}");
        }
        event => panic!("{event:?}"),
    }
}

#[test]
fn a_player_that_breaks_fails_the_sentence_only() {
    let breaking = "case \"$1\" in *silence.wav) ;; *) echo unplugged >&2; exit 1 ;; esac";
    let stage = Stage::new(VoiceMode::Auto, breaking);
    let (voice, events) = stage.start();
    next(&events);
    for id in [1, 2] {
        voice.speak(id, "Is it white?").unwrap();
        assert_eq!(next(&events), VoiceEvent::Started { id });
        match next(&events) {
            VoiceEvent::Failed { id: failed, error } => {
                assert_eq!(failed, id);
                assert!(error.contains("unplugged"), "{error}");
            }
            event => panic!("{event:?}"),
        }
    }
}

#[test]
fn waiting_sentences_are_bounded() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events) = stage.start();
    next(&events);
    let taken = (0..100).take_while(|&id| voice.speak(id, "Is it white?").is_ok()).count();
    // One more than may wait is being spoken, if the thread has been that quick.
    assert!((SENTENCES_MAX..=SENTENCES_MAX + 1).contains(&taken), "{taken}");
}
