//! `console.toml` and `study.toml`, and the robot's files that `arm.toml` names.

use std::path::Path;
use std::time::Duration;

use super::Folder;
use crate::study::{Design, Kind, Objects};
use crate::{Access, Settings};

#[test]
fn console_default_serves_this_machine_only() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let console = &settings.console;
    assert!(console.listen.ip().is_loopback() && console.access == Access::Token);
    assert_eq!((console.viewers_max, console.handover), (32, Duration::from_secs(10)));
    assert_eq!(console.language, "en");
}

#[test]
fn console_camera_is_a_stream_or_single_pictures_of_one_origin() {
    let camera =
        |text: &str| Folder::new(&[("console.toml", text)]).load(None, &[]).unwrap().console.camera;
    assert_eq!(camera(""), None);
    let stream = camera("camera = 'https://cam.local:8080/stream?size=2'").unwrap();
    assert_eq!((stream.origin.as_str(), stream.every), ("https://cam.local:8080", None));
    let still = camera("camera = 'http://10.0.0.7/now.jpg'\ncamera_every_s = 0.5").unwrap();
    assert_eq!(still.origin, "http://10.0.0.7");
    assert_eq!(still.every, Some(Duration::from_millis(500)));
}

#[test]
fn console_serves_other_machines_by_token() {
    let settings =
        Folder::new(&[("console.toml", "listen = '0.0.0.0:80'")]).load(None, &[]).unwrap();
    assert_eq!(settings.console.access, Access::Token);
}

#[test]
fn console_stores_sentences_in_the_configured_folder_or_the_run_folder() {
    let run = Path::new("/run/lab");
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(settings.voice_dir(run).as_deref(), Some(Path::new("/run/lab/said")));
    let own = Folder::new(&[("speech.toml", "voice_dir = '/srv/voice'")]).load(None, &[]).unwrap();
    assert_eq!(own.voice_dir(run).as_deref(), Some(Path::new("/srv/voice")));
}

const URDF: &str = "<robot name='other'/>";

#[test]
fn the_built_in_robot_needs_no_file() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(settings.robot_files().urdf.label, "built-in baxter.urdf");
    assert!(settings.robot_files().srdf.is_some());
}

#[test]
fn the_files_of_a_named_robot_are_part_of_the_snapshot() {
    let folder = Folder::new(&[("robots/other.urdf", URDF), ("arm.toml", "robot = 'other'")]);
    let settings = folder.load(None, &[]).unwrap();
    assert_eq!((&*settings.robot_files().urdf.text, &settings.robot_files().srdf), (URDF, &None));
    settings.write_snapshot(folder.path()).unwrap();
    let read = Settings::load_snapshot(folder.path()).unwrap();
    assert_eq!((read.robot_files(), &read), (settings.robot_files(), &settings));
    let usual = Folder::new(&[]).load(None, &[]).unwrap();
    assert_ne!(usual.section_text("arm"), settings.section_text("arm"));
    assert_eq!(usual.section_text("speech"), settings.section_text("speech"));
}

#[test]
fn study_default_is_the_published_protocol_with_a_questionnaire() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let study = &settings.study;
    assert!(!study.enabled, "a study starts on request only");
    let protocol = &study.protocol;
    assert_eq!((protocol.interactions, protocol.warmup), (3, 0));
    assert_eq!((protocol.objects, protocol.instructions.len()), (Objects::Uniform, 4));
    assert_eq!(protocol.policies, ["lookahead"], "the one that is configured");
    let kinds: Vec<Kind> = protocol.questionnaire.iter().map(|item| item.kind).collect();
    assert_eq!(kinds, [Kind::Likert, Kind::Likert, Kind::Likert, Kind::Likert, Kind::Text]);
    assert_eq!(protocol.questionnaire[0].points, 5);
    let none = Folder::new(&[("study.toml", "questionnaire = []")]).load(None, &[]).unwrap();
    assert!(none.study.protocol.questionnaire.is_empty());
}

#[test]
fn a_configured_questionnaire_survives_the_snapshot() {
    let text = r#"
design = "between"
policies = ["lookahead", "entropy"]
questionnaire = [
  { id = "hand", text = "Which hand do you write with?", kind = "choice", options = ["left", "right"] },
  { id = "age_group", text = "How old are you?", kind = "number", required = false },
]
"#;
    let folder = Folder::new(&[("study.toml", text)]);
    let settings = folder.load(None, &[("dialogue.planner", "optimal")]).unwrap();
    let protocol = &settings.study.protocol;
    assert_eq!((protocol.design, protocol.policies.len()), (Design::Between, 2));
    assert_eq!(protocol.questionnaire.len(), 2);
    assert!(protocol.questionnaire[0].required && !protocol.questionnaire[1].required);
    settings.write_snapshot(folder.path()).unwrap();
    assert_eq!(Settings::load_snapshot(folder.path()).unwrap().study, settings.study);
}
