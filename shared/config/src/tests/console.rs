//! `console.toml`, right and wrong; and where the robot's sentences are kept.

use std::path::Path;
use std::time::Duration;

use super::Folder;

fn complains(text: &str, expected: &[&str]) {
    assert_eq!(Folder::new(&[("console.toml", text)]).complaints(None, &[]), expected, "{text}");
}

#[test]
fn by_itself_it_serves_its_own_machine() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let console = &settings.console;
    assert!(console.listen.ip().is_loopback() && console.token.is_none());
    assert_eq!((console.viewers_max, console.handover), (32, Duration::from_secs(10)));
    assert_eq!(console.language, "en");
}

#[test]
fn beyond_it_there_must_be_a_token() {
    let open = "listen = '0.0.0.0:80'";
    complains(
        open,
        &["console.toml: listen: 0.0.0.0 is beyond this machine, and there is no token (set \
           console.token, or listen at 127.0.0.1)"],
    );
    let guarded = format!("{open}\ntoken = 'correct-horse'");
    let settings = Folder::new(&[("console.toml", &guarded)]).load(None, &[]).unwrap();
    assert_eq!(settings.console.token.as_deref(), Some("correct-horse"));
}

#[test]
fn what_is_wrong_is_named_with_its_cure() {
    complains(
        "listen = 'localhost'",
        &["console.toml: listen: `localhost` is not an address with a port (write e.g. \
           \"127.0.0.1:8377\")"],
    );
    for token in ["short", "with a blank in it", "ümläuteüberall"] {
        complains(
            &format!("token = '{token}'"),
            &[
                "console.toml: token: is too short to keep anybody out, too long, or holds a blank or an accent (use 12 to \
               200 letters, digits and signs without blanks)",
            ],
        );
    }
    complains(
        "language = '../en'\nviewers_max = 0",
        &[
            "console.toml: viewers_max: 0 is out of range (use a number from 1 to 200)",
            "console.toml: language: `../en` is no name of a language (use e.g. \"en\")",
        ],
    );
}

#[test]
fn sentences_are_kept_where_the_operator_says_or_in_the_run_folder() {
    let run = Path::new("/run/lab");
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(settings.voice_dir(run).as_deref(), Some(Path::new("/run/lab/said")));
    let own = Folder::new(&[("speech.toml", "voice_dir = '/srv/voice'")]).load(None, &[]).unwrap();
    assert_eq!(own.voice_dir(run).as_deref(), Some(Path::new("/srv/voice")));
}
