//! Live speech: the microphone is a pipe into which the tests speak with espeak-ng.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;
use speech_engines::audio::read_wav;
use whichone_tests::{EARS, Group, wait_for};

use crate::speech::{answer_by_voice, spoken};

/// A simulated user's voice, in a pipe that the microphone's program reads.
struct Speaker {
    folder: tempfile::TempDir,
    pipe: File,
    path: PathBuf,
}

impl Speaker {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("microphone");
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        // Opened for both directions, so that opening does not block.
        let pipe = OpenOptions::new().read(true).write(true).open(&path).unwrap();
        Self { folder, pipe, path }
    }

    fn command(&self) -> String {
        format!("speech.microphone.command=[\"cat\", \"{}\"]", self.path.display())
    }

    /// Speaks as fast as people do, with the pause behind it that ends an utterance: what comes at
    /// once was said before it came.
    fn says(&mut self, text: &str) {
        let samples = read_wav(Path::new(&spoken(text, self.folder.path())), 20.0).unwrap();
        let quiet = vec![0_i16; 12_000];
        let sound = quiet.iter().chain(&samples).chain(&quiet);
        let bytes: Vec<u8> = sound.flat_map(|sample| sample.to_le_bytes()).collect();
        for tenth in bytes.chunks(3_200) {
            self.pipe.write_all(tenth).unwrap();
            std::thread::sleep(Duration::from_millis(100));
        }
    }
}

fn up(speaker: &Speaker, mode: &str, more: &[&str]) -> Group {
    let mode = format!("speech.microphone.mode={mode}");
    let command = speaker.command();
    let mut settings = vec![mode.as_str(), command.as_str()];
    settings.extend(more);
    Group::up(&settings)
}

fn hearing(group: &Group) -> Value {
    group.status()["hearing"].take()
}

fn wait_for_microphone(group: &Group, state: &str) -> Value {
    wait_for(&format!("a microphone that is {state}"), 20.0, || {
        Some(hearing(group)).filter(|hearing| hearing["microphone"] == state)
    })
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn hands_free_microphone_understands_a_dialogue() {
    let mut speaker = Speaker::new();
    let group = up(&speaker, "hands-free", &[]);
    speaker.says("get me the small white bowl");
    answer_by_voice(&group, |answer| speaker.says(answer));
    let outcome = group.await_pick(None);
    assert_eq!((&outcome["outcome"], &outcome["object"]), (&"delivered".into(), &"white2".into()));
    let hearing = wait_for_microphone(&group, "listening");
    assert!(hearing["snr_db"].as_f64().unwrap() > 15.0, "{hearing}");
    assert_eq!((&hearing["dropped"], &hearing["note"]), (&0.into(), &"cat".into()));
    group.verify_journals();
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn talk_opens_the_microphone_for_one_utterance() {
    let mut speaker = Speaker::new();
    let group = up(&speaker, "push-to-talk", &[]);
    wait_for_microphone(&group, "closed");
    let heard = std::thread::scope(|scope| {
        let talk = scope.spawn(|| group.call(&["talk", "--json", "--seconds", "30"]));
        speaker.says("get me the small white bowl");
        talk.join().unwrap()
    });
    let receipt = heard.json();
    assert_eq!(
        (&receipt["status"], &receipt["source"]),
        (&"accepted".into(), &"microphone".into())
    );
    assert!(receipt["note"].as_str().unwrap().contains("small white bowl"), "{receipt}");
    assert!(receipt["end_ns"].as_u64() > receipt["onset_ns"].as_u64(), "{receipt}");
    assert_eq!(heard.code, Some(0));
    wait_for_microphone(&group, "closed");
    let silent = group.call(&["talk", "--seconds", "1"]);
    assert_eq!(silent.code, Some(1));
    assert!(silent.stderr.contains("microphone"), "{silent:?}");
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn microphone_is_muted_while_the_robot_speaks() {
    let speaker = Speaker::new();
    let silence = "while :; do head -c 3200 /dev/zero; sleep 0.1; done";
    let silence = format!("speech.microphone.command=[\"sh\", \"-c\", \"{silence}\"]");
    // Nothing plays, but every sentence takes as long as it would sound.
    let aloud = ["speech.voice=espeak-ng", "speech.player=[\"none\"]"];
    let group = up(&speaker, "hands-free", &[silence.as_str(), aloud[0], aloud[1]]);
    wait_for_microphone(&group, "listening");
    group.say("get me the bowl");
    wait_for_microphone(&group, "muted");
    wait_for_microphone(&group, "listening");
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn listen_streams_standard_input_and_live_files() {
    let folder = tempfile::tempdir().unwrap();
    let group = Group::up(&[EARS]);
    let file = spoken("get me the small white bowl", folder.path());
    let live = group.must(&["listen", &file, "--live", "--json"]).stdout;
    let raw = folder.path().join("raw");
    let quiet = vec![0_i16; 16_000];
    let samples = [quiet.clone(), read_wav(Path::new(&file), 20.0).unwrap(), quiet].concat();
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    std::fs::write(&raw, bytes).unwrap();
    let mut command = group.command(&["listen", "-", "--json"]);
    let piped = command.stdin(File::open(&raw).unwrap()).output().unwrap();
    assert_eq!(piped.status.code(), Some(0), "{piped:?}");
    for output in [live, String::from_utf8(piped.stdout).unwrap()] {
        let lines: Vec<Value> =
            output.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let [heard, over] = lines.as_slice() else { panic!("{output}") };
        assert_eq!((&heard["status"], &over["status"]), (&"accepted".into(), &"over".into()));
        assert!(heard["note"].as_str().unwrap().contains("small white bowl"), "{output}");
        assert_eq!(over["note"], "", "nothing was lost");
    }
    let silent = group.call(&["listen", "-"]);
    assert_eq!(silent.code, Some(1), "{silent:?}");
    group.down();
}

#[test]
fn transcript_keeps_its_times_and_alternatives() {
    let group = Group::up(&[]);
    let words = [
        "say",
        "the clear bowl",
        "--began-ago",
        "2",
        "--ended-ago",
        "0.5",
        "--or",
        "the cleared bowl=0.25",
        "--confidence",
        "1,0.5,1",
        "--json",
    ];
    let receipt = group.must(&words).json();
    assert_eq!((&receipt["status"], &receipt["source"]), (&"accepted".into(), &"browser".into()));
    assert_eq!(receipt["confidence"], 0.75);
    let spoken_ns = receipt["end_ns"].as_u64().unwrap() - receipt["onset_ns"].as_u64().unwrap();
    assert_eq!(spoken_ns, 1_500_000_000);
    assert_eq!(group.await_pick(Some("clear"))["object"], "clear");
    for (more, why) in [
        (["--confidence", "1,1,1,1"], "found 4"),
        (["--or", "x=1.5"], "TEXT=WEIGHT"),
        (["--began-ago", "soon"], "expected seconds"),
    ] {
        let wrong = group.call(&["say", "the clear bowl", more[0], more[1]]);
        assert_ne!(wrong.code, Some(0));
        assert!(wrong.stderr.contains(why), "{wrong:?}");
    }
    group.down();
}

#[test]
fn microphone_is_restarted_and_reports_when_it_is_off() {
    let speaker = Speaker::new();
    let dies = "speech.microphone.command=[\"sh\", \"-c\", \"echo no card >&2; exit 3\"]";
    let group = up(&speaker, "hands-free", &[dies]);
    let hearing = wait_for("the second start", 20.0, || {
        Some(hearing(&group)).filter(|hearing| hearing["restarts"].as_u64() >= Some(2))
    });
    assert_eq!(hearing["microphone"], "broken");
    assert!(hearing["note"].as_str().unwrap().contains("sh"), "{hearing}");
    let log = group.must(&["logs", "speech"]).stdout;
    assert!(log.contains("no card"), "{log}");
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear", "typed words do");
    group.down();
    let group = up(&speaker, "off", &[]);
    let refused = group.call(&["talk"]);
    assert_eq!(refused.code, Some(1));
    assert!(refused.stderr.contains("speech.toml"), "{refused:?}");
    group.down();
}
