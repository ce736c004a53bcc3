//! Spoken requests, from WAV files made by the synthesisers that this machine has.

use std::path::Path;
use std::process::Command;
use whichone_tests::{Group, run, wait_for};

/// Synthesises `text` into a WAV file in `folder` and returns its path.
pub(crate) fn spoken(text: &str, folder: &Path) -> String {
    let path = folder.join(format!("{}.wav", text.replace(' ', "_"))).display().to_string();
    let mut command = Command::new("espeak-ng");
    command.args(["-v", "en-us", "-s", "150", "-w", &path, text]);
    assert_eq!(run(&mut command, "", 20.0).code, Some(0));
    path
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn a_spoken_request_is_understood_and_answered_by_voice() {
    let folder = tempfile::tempdir().unwrap();
    let group = Group::up(&[]);
    group.must(&["listen", &spoken("get me the small white bowl", folder.path())]);
    // Whoever wants the small white plastic bowl on the counter answers by voice, too.
    let mut asked = String::new();
    loop {
        let dialogue = wait_for("another decision", 20.0, || {
            Some(group.dialogue())
                .filter(|d| d["text"] != asked.as_str() && d["decision"] != "wait")
        });
        if dialogue["decision"] != "ask" {
            break;
        }
        asked = dialogue["text"].as_str().unwrap().to_owned();
        let wanted = ["small", "white", "plastic", "counter"];
        let answer = if wanted.iter().any(|word| asked.contains(word)) { "yes" } else { "no" };
        group.must(&["listen", &spoken(answer, folder.path())]);
    }
    let outcome = group.await_pick(None);
    assert_eq!((&outcome["outcome"], &outcome["object"]), (&"delivered".into(), &"white2".into()));
    group.verify_journals();
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn sounds_that_cannot_be_heard_are_refused_with_their_reason() {
    let folder = tempfile::tempdir().unwrap();
    let group = Group::up(&[]);
    let noise = folder.path().join("noise.wav");
    std::fs::write(&noise, b"this is not a WAV file").unwrap();
    for path in [noise.display().to_string(), "/no/such/file.wav".to_owned()] {
        let ended = group.call(&["listen", &path]);
        assert_ne!(ended.code, Some(0), "{path}");
        assert!(!ended.stderr.is_empty());
    }
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear", "and goes on");
    group.down();
}

#[test]
fn without_a_recogniser_typed_text_still_works() {
    let group = Group::up(&["speech.recogniser=none"]);
    let ended = group.call(&["listen", "/tmp/any.wav"]);
    assert_ne!(ended.code, Some(0));
    assert_eq!(group.fetch("get me the bowl", "white")["object"], "white");
    group.down();
}
