use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use wyoming::stand_in::{Manner, StandIn};
use wyoming::{Client, Info};

use super::PlaybackState::{Ended, Interrupted, Started};
use super::*;
use crate::audio::write_wav;

const PATIENCE: Duration = Duration::from_secs(20);
/// A fifth of a second.
const SOUND_SAMPLES: usize = 3_200;
/// The same.
const SOUND: Duration = Duration::from_millis(200);

/// An arbitrary file of a prompt.
const FILE: SoundFile = SoundFile { prompt: 1, presentation: 1 };

/// Programs that stand in for espeak-ng and a player.
struct Stage {
    folder: TempDir,
    options: VoiceOptions,
}

impl Stage {
    /// The stand-in for espeak-ng copies a fifth of a second of audio to its output file; the
    /// player is the given script.
    fn new(mode: VoiceMode, player: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        write_wav(&path("sound.wav"), &[900; SOUND_SAMPLES]).unwrap();
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

    /// Starts the voice. Returns it after its first event.
    fn start(&self) -> (Voice, Events, VoiceOutput) {
        let (voice, events) = Voice::start(self.options.clone());
        match events.recv_timeout(PATIENCE) {
            Ok(VoiceEvent::Output(output)) => (voice, Events(events), output),
            other => panic!("expected the output, found {other:?}"),
        }
    }
}

#[test]
fn voice_synthesises_foreseen_prompts_while_it_is_silent_and_only_once() {
    let mut stage = Stage::new(VoiceMode::Aloud, "exit 0");
    let log = stage.folder.path().join("spoken");
    let Program::EspeakNg(program) = &stage.options.program else { panic!() };
    let logged = format!(
        "for last; do :; done; echo \"$last\" >> {}\n{} \"$@\"",
        log.display(),
        program.display()
    );
    stage.options.program = Program::EspeakNg(script(&stage.folder.path().join("logs"), &logged));
    let foreseen = ["Is it white?", "Is it big?"].map(str::to_owned);
    stage.options.foreseen = foreseen.to_vec();
    let (voice, events, _) = stage.start();
    let spoken = || fs::read_to_string(&log).unwrap_or_default();
    let begun = Instant::now();
    while spoken().lines().count() < 3 {
        assert!(begun.elapsed() < PATIENCE, "{}", spoken());
        thread::sleep(Duration::from_millis(5));
    }
    // The third was begun, so the second exists.
    voice.speak(1, FILE, "Is it white?").unwrap();
    assert_eq!([events.next(), events.next()], [(1, Started), (1, Ended)]);
    assert_eq!(spoken().lines().filter(|words| *words == "Is it white?").count(), 1);
}

struct Events(Receiver<VoiceEvent>);

impl Events {
    fn next(&self) -> (u64, PlaybackState) {
        loop {
            match self.0.recv_timeout(PATIENCE) {
                Ok(VoiceEvent::Playback(PlaybackEvent { playback, state })) => {
                    return (playback, state);
                }
                Ok(VoiceEvent::Server(_)) => {}
                other => panic!("expected a playback event, found {other:?}"),
            }
        }
    }

    fn failure(&self) -> String {
        match self.next().1 {
            PlaybackState::Failed(error) => error,
            other => panic!("expected a failure, found {other:?}"),
        }
    }
}

fn none() -> Vec<Player> {
    vec![Player { program: "none".into(), arguments: Vec::new() }]
}

fn script(path: &Path, text: &str) -> PathBuf {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    path.to_owned()
}

/// Plays silence at once and prompts for longer than any test waits.
const ENDLESS: &str = "case \"$1\" in *silence.wav) ;; *) exec sleep 60 ;; esac";

#[test]
fn voice_prints_prompts_or_shows_them_without_a_sound_card() {
    for (mode, player, expected) in [
        (VoiceMode::Print, "exit 1", "print"),
        (VoiceMode::Auto, "echo no soundcards found >&2; exit 1", "no soundcards found"),
    ] {
        let stage = Stage::new(mode, player);
        let (voice, events, output) = stage.start();
        let VoiceOutput::Text { reason } = output else { panic!("{output:?}") };
        assert!(reason.contains(expected), "{reason}");
        for playback in [7, 8] {
            voice.speak(playback, FILE, "Which bowl would you like?").unwrap();
            assert_eq!(events.next(), (playback, Started));
            assert_eq!(events.next(), (playback, Ended));
        }
    }
}

#[test]
fn voice_plays_a_prompt_to_its_end() {
    let stage = Stage::new(VoiceMode::Auto, "echo \"$1\" >> \"$(dirname \"$0\")/played\"");
    let (voice, events, output) = stage.start();
    assert!(matches!(output, VoiceOutput::Aloud(_)));
    voice.speak(1, FILE, "Is it white?").unwrap();
    assert_eq!((events.next(), events.next()), ((1, Started), (1, Ended)));
    let played = fs::read_to_string(stage.folder.path().join("played")).unwrap();
    assert!(played.ends_with("work/sentence-001.wav\n"), "{played}");
}

#[test]
fn voice_interruption_ends_the_current_prompt_and_cancels_the_next() {
    let stage = Stage::new(VoiceMode::Auto, ENDLESS);
    let (voice, events, _) = stage.start();
    voice.speak(1, FILE, "Is it white?").unwrap();
    voice.speak(2, FILE, "Is it small?").unwrap();
    assert_eq!(events.next(), (1, Started));
    let start = Instant::now();
    voice.interrupt();
    assert_eq!((events.next(), events.next()), ((1, Interrupted), (2, Interrupted)));
    voice.speak(3, FILE, "Is it big?").unwrap();
    assert_eq!(events.next(), (3, Started));
    drop(voice);
    assert_eq!(events.next(), (3, Interrupted), "dropped");
    assert!(start.elapsed() < PATIENCE);
    assert!(events.0.recv_timeout(PATIENCE).is_err(), "the thread is gone");
}

#[test]
fn voice_reports_failures_of_synthesis_and_player() {
    let mut stage = Stage::new(VoiceMode::Aloud, "exit 0");
    stage.options.program = Program::EspeakNg("/nonexistent/espeak-ng".into());
    let (voice, events, _) = stage.start();
    voice.speak(1, FILE, "Is it white?").unwrap();
    let error = events.failure();
    assert!(error.contains("install the package espeak-ng"), "{error}");
    let breaking = "case \"$1\" in *silence.wav) ;; *) echo unplugged >&2; exit 1 ;; esac";
    let stage = Stage::new(VoiceMode::Auto, breaking);
    let (voice, events, _) = stage.start();
    for playback in [1, 2] {
        voice.speak(playback, FILE, "Is it white?").unwrap();
        assert_eq!(events.next(), (playback, Started));
        assert!(events.failure().contains("unplugged"));
    }
}

/// A player that returns early, such as one on a null device, does not shorten the prompt.
#[test]
fn voice_prompt_lasts_as_long_as_its_audio() {
    for players in [None, Some(none())] {
        let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
        stage.options.players = players.unwrap_or(stage.options.players);
        let (voice, events, output) = stage.start();
        assert!(matches!(output, VoiceOutput::Aloud(_)));
        voice.speak(1, FILE, "Is it white?").unwrap();
        assert_eq!(events.next(), (1, Started));
        let began = Instant::now();
        assert_eq!(events.next(), (1, Ended));
        // `Started` was sent a moment before it was received.
        assert!(began.elapsed() > SOUND / 2, "{:?}", began.elapsed());
    }
}

#[test]
fn voice_caches_audio_under_its_name() {
    let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
    let cache = stage.folder.path().join("cache");
    stage.options.audio_dir = Some(cache.clone());
    let (voice, events, _) = stage.start();
    let prompts = [(1, (1, 1), "Is it white?"), (2, (1, 2), "Is it white?"), (3, (2, 1), "No")];
    for (playback, (prompt, presentation), text) in prompts {
        let file = SoundFile { prompt, presentation };
        voice.speak(playback, file, text).unwrap();
        assert_eq!(events.next(), (playback, Started));
        assert!(cache.join(file.to_string()).is_file(), "cached before playback");
        assert_eq!(events.next(), (playback, Ended));
    }
    let work = fs::read_dir(stage.folder.path().join("work")).unwrap();
    let is_prompt =
        |entry: &fs::DirEntry| entry.file_name().to_string_lossy().starts_with("sentence");
    let made = work.filter(|entry| is_prompt(entry.as_ref().unwrap()));
    assert_eq!(made.count(), 3, "the trial and two prompts");
}

#[test]
fn voice_cancels_synthesis_and_silent_playback() {
    let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
    stage.options.players = none();
    let (voice, events, _) = stage.start();
    voice.speak(1, FILE, "Is it white?").unwrap();
    assert_eq!(events.next(), (1, Started));
    voice.interrupt();
    assert_eq!(events.next(), (1, Interrupted));
    let sound = stage.folder.path().join("sound.wav");
    let slow = format!("[ \"$2\" = hello ] || exec sleep 60; cp {} \"$1\"", sound.display());
    let program = script(&stage.folder.path().join("slow"), &slow).display().to_string();
    stage.options.program = Program::Command(vec![program, "{wav}".into(), "{text}".into()]);
    let (voice, events, _) = stage.start();
    voice.speak(1, FILE, "Is it white?").unwrap();
    voice.interrupt();
    assert_eq!(events.next(), (1, Interrupted));
}

fn by_server(server: &StandIn) -> Option<ServerOptions> {
    let client = Client::new(server.address.clone(), PATIENCE, PATIENCE);
    Some(ServerOptions { client, voice: wyoming::Voice::default() })
}

#[test]
fn voice_ends_though_its_server_is_silent() {
    let mut stage = Stage::new(VoiceMode::Auto, "exit 0");
    let server = StandIn::start(Manner::Deaf);
    stage.options.server = by_server(&server);
    let began = Instant::now();
    let (voice, _events) = Voice::start(stage.options.clone());
    thread::sleep(Duration::from_millis(100));
    drop(voice);
    assert!(began.elapsed() < PATIENCE / 2, "on trial: {:?}", began.elapsed());
    // It falls silent while it synthesises in advance.
    server.behave(Manner::Slow(String::new(), Duration::from_millis(50)));
    stage.options.foreseen = (0..FORESEEN_MAX).map(|n| format!("Is it number {n}?")).collect();
    let (voice, _events, _) = stage.start();
    server.behave(Manner::Deaf);
    thread::sleep(Duration::from_millis(200));
    let began = Instant::now();
    drop(voice);
    assert!(began.elapsed() < PATIENCE / 2, "in advance: {:?}", began.elapsed());
}

#[test]
fn voice_of_a_server_needs_no_program_and_returns_with_the_server() {
    let server = StandIn::start(Manner::Offers(Info::default()));
    let mut stage = Stage::new(VoiceMode::Aloud, "exit 0");
    stage.options.program = Program::EspeakNg("/nonexistent/espeak-ng".into());
    stage.options.server = by_server(&server);
    let error = Voice::try_out(stage.options.clone()).unwrap_err();
    assert!(error.contains("it offers no voice; nothing takes its place: "), "{error}");
    let (voice, events, output) = stage.start();
    assert!(matches!(output, VoiceOutput::Aloud(_)), "{output:?}");
    voice.speak(1, FILE, "Is it white?").unwrap();
    assert!(events.failure().contains("install the package espeak-ng"));
    server.behave(Manner::Answer(String::new()));
    voice.speak(2, FILE, "Is it white?").unwrap();
    assert_eq!([events.next(), events.next()], [(2, Started), (2, Ended)]);
}
