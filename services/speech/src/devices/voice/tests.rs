use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::*;

const PATIENCE: Duration = Duration::from_secs(20);
/// A fifth of a second at 22,050 Hz.
const SOUND_SAMPLES: usize = 4_410;
/// The same.
const SOUND: Duration = Duration::from_millis(200);

/// A folder with programs that stand in for espeak-ng and a player.
struct Stage {
    folder: TempDir,
    options: VoiceOptions,
}

impl Stage {
    /// The stand-in for espeak-ng copies a fifth of a second of sound to where it is told to write; the
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
        let mut wav = hound::WavWriter::create(path("sound.wav"), spec).unwrap();
        (0..SOUND_SAMPLES).for_each(|_| wav.write_sample(900_i16).unwrap());
        wav.finalize().unwrap();
        let copy = format!(
            "while [ $# -gt 0 ]; do [ \"$1\" = -w ] && cp {} \"$2\"; shift; done",
            path("sound.wav").display()
        );
        let espeak_ng = script(&path("espeak"), &copy);
        let player = script(&path("player"), player).to_string_lossy().into_owned();
        let players = vec![Player { program: player, arguments: Vec::new() }];
        let program = Program::EspeakNg(espeak_ng);
        let options = VoiceOptions { mode, program, players, ..VoiceOptions::new(path("work")) };
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
        voice.speak(id, "a", "Which bowl would you like?").unwrap();
        assert_eq!(next(&events), VoiceEvent::Started { id });
        assert_eq!(next(&events), VoiceEvent::Ended { id });
    }
}

#[test]
fn a_sentence_is_played_to_its_end() {
    let stage = Stage::new(VoiceMode::Auto, "echo \"$1\" >> \"$(dirname \"$0\")/played\"");
    let (voice, events) = stage.start();
    assert!(matches!(next(&events), VoiceEvent::Output(VoiceOutput::Aloud(_))));
    voice.speak(1, "a", "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Ended { id: 1 });
    let played = fs::read_to_string(stage.folder.path().join("played")).unwrap();
    assert!(played.ends_with("work/sentence-01.wav\n"), "{played}");
}

#[test]
fn an_interruption_ends_the_current_sentence_and_calls_off_the_next() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "a", "Is it white?").unwrap();
    voice.speak(2, "a", "Is it small?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    let start = Instant::now();
    voice.interrupt();
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 2 });
    assert!(start.elapsed() < PATIENCE);
    voice.speak(3, "a", "Is it big?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 3 });
}

#[test]
fn dropping_the_voice_ends_what_it_says() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "a", "Is it white?").unwrap();
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
    voice.speak(1, "a", "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    assert_eq!(next(&events), VoiceEvent::Ended { id: 1 });
}

#[test]
fn a_voice_that_must_be_heard_fails_without_its_programs() {
    let mut stage = Stage::new(VoiceMode::Aloud, "exit 0");
    stage.options.program = Program::EspeakNg("/nonexistent/espeak-ng".into());
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "a", "Is it white?").unwrap();
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
        voice.speak(id, "a", "Is it white?").unwrap();
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
    let taken = (0..100).take_while(|&id| voice.speak(id, "a", "Is it white?").is_ok()).count();
    // One more than may wait is being spoken, if the thread has been that quick.
    assert!((SENTENCES_MAX..=SENTENCES_MAX + 1).contains(&taken), "{taken}");
}

/// A player that returns early, as one on a null device does, does not shorten what is said.
#[test]
fn a_sentence_lasts_as_long_as_its_sound_whatever_the_player_does() {
    for player in ["exit 0", "none"] {
        let mut stage = Stage::new(VoiceMode::Auto, player);
        if player == "none" {
            stage.options.players = vec![Player { program: "none".into(), arguments: Vec::new() }];
        }
        let (voice, events) = stage.start();
        assert!(matches!(next(&events), VoiceEvent::Output(VoiceOutput::Aloud(_))));
        voice.speak(1, "a", "Is it white?").unwrap();
        assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
        let began = Instant::now();
        assert_eq!(next(&events), VoiceEvent::Ended { id: 1 });
        // `Started` came a moment before it was taken.
        assert!(began.elapsed() > SOUND / 2, "{player}: {:?}", began.elapsed());
    }
}

#[test]
fn an_unheard_sentence_can_be_cut_short_too() {
    let mut stage = Stage::new(VoiceMode::Auto, "");
    stage.options.players = vec![Player { program: "none".into(), arguments: Vec::new() }];
    let (voice, events) = stage.start();
    next(&events);
    voice.speak(1, "a", "Is it white?").unwrap();
    assert_eq!(next(&events), VoiceEvent::Started { id: 1 });
    voice.interrupt();
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 1 });
}

#[test]
fn a_sentence_is_made_once_and_kept_under_its_name() {
    let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
    let kept = stage.folder.path().join("kept");
    stage.options.kept = Some(kept.clone());
    let (voice, events) = stage.start();
    next(&events);
    for (id, name, text) in
        [(1, "1-1", "Is it white?"), (2, "1-2", "Is it white?"), (3, "2-1", "No")]
    {
        voice.speak(id, name, text).unwrap();
        assert_eq!(next(&events), VoiceEvent::Started { id });
        assert!(kept.join(format!("line-{name}.wav")).is_file(), "kept before it is heard");
        assert_eq!(next(&events), VoiceEvent::Ended { id });
    }
    let made = fs::read_dir(stage.folder.path().join("work")).unwrap();
    let made = made.filter(|entry| {
        entry.as_ref().unwrap().file_name().to_string_lossy().starts_with("sentence")
    });
    assert_eq!(made.count(), 3, "the trial and two sentences");
}

#[test]
fn making_a_sound_can_be_called_off() {
    let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
    let sound = stage.folder.path().join("sound.wav");
    let slow = format!("[ \"$2\" = hello ] || exec sleep 60; cp {} \"$1\"", sound.display());
    let program = script(&stage.folder.path().join("slow"), &slow).display().to_string();
    stage.options.program = Program::Command(vec![program, "{wav}".into(), "{text}".into()]);
    let (voice, events) = stage.start();
    assert!(matches!(next(&events), VoiceEvent::Output(VoiceOutput::Aloud(_))));
    voice.speak(1, "a", "Is it white?").unwrap();
    voice.interrupt();
    assert_eq!(next(&events), VoiceEvent::Interrupted { id: 1 });
}
