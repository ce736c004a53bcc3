//! `console.toml`, and the robot's files that `arm.toml` names.

use std::path::Path;
use std::time::Duration;

use super::Folder;
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
    assert_eq!((&*still.origin, still.every.unwrap().as_millis()), ("http://10.0.0.7", 500));
}

#[test]
fn console_serves_other_machines_by_token_and_is_announced_to_them() {
    let read = |text| Folder::new(&[("console.toml", text)]).load(None, &[]).unwrap();
    let settings = read("listen = '0.0.0.0:80'\ndiscovery = true");
    assert_eq!((settings.console.access, settings.warnings()), (Access::Token, &[][..]));
    let warned = read("listen = '127.0.0.1:80'\ndiscovery = true").warnings()[0].to_string();
    let why = "discovery: nothing is announced, as the console listens at 127.0.0.1; help: set console.listen = \
        \"0.0.0.0:80\", or console.discovery = false";
    assert!(warned.contains(why), "{warned}");
    assert_eq!(read("discovery = false").warnings(), []);
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
