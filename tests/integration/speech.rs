//! Spoken requests in WAV files.

use serde_json::Value;
use std::path::Path;
use std::process::Command;
use whichone_tests::{EARS, Group, run, wait_for};

/// Synthesises `text` into a WAV file in `folder` and returns its path.
pub(crate) fn spoken(text: &str, folder: &Path) -> String {
    let path = folder.join(format!("{}.wav", text.replace(' ', "_"))).display().to_string();
    let mut command = Command::new("espeak-ng");
    command.args(["-v", "en-us", "-s", "150", "-w", &path, text]);
    assert_eq!(run(&mut command, "", 20.0).code, Some(0));
    path
}

/// Answers with `say` as a user who wants the small white plastic bowl on the counter, until the
/// robot has decided.
pub(crate) fn answer_by_voice(group: &Group, mut say: impl FnMut(&str)) {
    let mut asked = String::new();
    loop {
        let dialogue = wait_for("another decision", 20.0, || {
            let is_new = |d: &Value| d["text"] != asked.as_str() && d["decision"] != "wait";
            Some(group.dialogue()).filter(is_new)
        });
        if dialogue["decision"] != "ask" {
            return;
        }
        asked = dialogue["text"].as_str().unwrap().to_owned();
        let is_wanted = |words: &str| {
            ["small", "white", "plastic", "counter"].iter().any(|wanted| words.contains(wanted))
        };
        let options = dialogue["question"]["values"].as_array();
        let chosen = options.map(|options| {
            let mut options = options.iter().filter_map(Value::as_str);
            options.find(|option| is_wanted(option)).unwrap_or("none of them")
        });
        say(chosen.unwrap_or(if is_wanted(&asked) { "yes" } else { "no" }));
    }
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn listen_conducts_a_dialogue_by_files() {
    let folder = tempfile::tempdir().unwrap();
    let group = Group::up(&[EARS]);
    group.must(&["listen", &spoken("get me the small white bowl", folder.path())]);
    answer_by_voice(&group, |answer| {
        group.must(&["listen", &spoken(answer, folder.path())]);
    });
    let outcome = group.await_pick(None);
    assert_eq!((&outcome["outcome"], &outcome["object"]), (&"delivered".into(), &"white2".into()));
    group.verify_journals();
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn unreadable_sound_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let group = Group::up(&[EARS]);
    let noise = folder.path().join("noise.wav");
    std::fs::write(&noise, b"this is not a WAV file").unwrap();
    for path in [noise.display().to_string(), "/no/such/file.wav".to_owned()] {
        let ended = group.call(&["listen", &path]);
        assert_ne!(ended.code, Some(0), "{path}");
        assert!(!ended.stderr.is_empty());
    }
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear", "it still serves");
    group.down();
}

#[test]
fn typed_text_works_without_a_recogniser() {
    let group = Group::up(&["speech.recogniser=none"]);
    let ended = group.call(&["listen", "/tmp/any.wav"]);
    assert_ne!(ended.code, Some(0));
    assert_eq!(group.fetch("get me the bowl", "white")["object"], "white");
    group.down();
}
