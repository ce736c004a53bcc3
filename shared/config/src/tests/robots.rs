//! Files of the robot that the arm section names.

use super::Folder;
use crate::{Section, Settings};

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
    assert_ne!(usual.section_text(Section::Arm), settings.section_text(Section::Arm));
    assert_eq!(usual.section_text(Section::Speech), settings.section_text(Section::Speech));
}
