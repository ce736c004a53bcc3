//! `console.toml`, and the folder of the robot's sentences.

use std::path::Path;
use std::time::Duration;

use super::Folder;

#[test]
fn console_default_serves_this_machine_only() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let console = &settings.console;
    assert!(console.listen.ip().is_loopback() && console.token.is_none());
    assert_eq!((console.viewers_max, console.handover), (32, Duration::from_secs(10)));
    assert_eq!(console.language, "en");
}

#[test]
fn console_requires_a_token_for_other_machines() {
    let open = "listen = '0.0.0.0:80'";
    let guarded = format!("{open}\ntoken = 'correct-horse'");
    let settings = Folder::new(&[("console.toml", &guarded)]).load(None, &[]).unwrap();
    assert_eq!(settings.console.token.as_deref(), Some("correct-horse"));
}

#[test]
fn console_stores_sentences_in_the_configured_folder_or_the_run_folder() {
    let run = Path::new("/run/lab");
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(settings.voice_dir(run).as_deref(), Some(Path::new("/run/lab/said")));
    let own = Folder::new(&[("speech.toml", "voice_dir = '/srv/voice'")]).load(None, &[]).unwrap();
    assert_eq!(own.voice_dir(run).as_deref(), Some(Path::new("/srv/voice")));
}
