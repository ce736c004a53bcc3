//! The robot that the arm names.

use manipulation::Limb;
use robot_model::{BAXTER_SRDF, BAXTER_URDF};

use super::Folder;
use crate::{Section, Settings};

/// Baxter with another velocity limit of its first joints.
fn slower() -> String {
    let slower = BAXTER_URDF.replacen("velocity=\"1.5\"", "velocity=\"0.5\"", 20);
    assert_ne!(slower, BAXTER_URDF, "the description has changed");
    slower
}

#[test]
fn the_built_in_robot_needs_no_file() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(&settings.arm.robot, manipulation::Robot::baxter());
}

#[test]
fn a_description_in_the_folder_is_the_robot() {
    let folder = Folder::new(&[
        ("robots/slow.urdf", &slower()),
        ("robots/slow.srdf", BAXTER_SRDF),
        ("arm.toml", "robot = 'slow'"),
    ]);
    let settings = folder.load(None, &[]).unwrap();
    assert_eq!(settings.arm.robot.arm(Limb::Left).limits.velocity[0], 0.5);
    settings.write_snapshot(folder.path()).unwrap();
    let read = Settings::load_snapshot(folder.path()).unwrap();
    assert_eq!((&read.arm.robot, &read), (&settings.arm.robot, &settings));
    let usual = Folder::new(&[]).load(None, &[]).unwrap();
    assert_ne!(usual.section_text(Section::Arm), settings.section_text(Section::Arm));
    assert_eq!(usual.section_text(Section::Speech), settings.section_text(Section::Speech));
}

#[test]
fn a_robot_that_is_not_there_is_asked_for_by_its_name() {
    let folder =
        Folder::new(&[("robots/sawyer.urdf", BAXTER_URDF), ("arm.toml", "robot = 'sawer'")]);
    let complaints = folder.complaints(None, &[]);
    assert_eq!(complaints.len(), 1);
    assert!(
        complaints[0].starts_with("arm.toml: robot: there is no robot `sawer`"),
        "{complaints:?}"
    );
    assert!(complaints[0].ends_with("(did you mean `sawyer`?)"), "{complaints:?}");
}

#[test]
fn faults_of_a_description_are_told_with_their_lines() {
    let broken = BAXTER_URDF.replacen("velocity=\"1.5\"", "velocity=\"fast\"", 1);
    let folder = Folder::new(&[
        ("robots/baxter.urdf", &broken),
        ("robots/baxter.srdf", BAXTER_SRDF),
        ("arm.toml", "speed_ratio = 7"),
    ]);
    let complaints = folder.complaints(None, &[]);
    assert_eq!(complaints.len(), 2, "{complaints:?}");
    assert!(complaints[0].starts_with("arm.toml: speed_ratio"), "{complaints:?}");
    assert!(complaints[1].starts_with("robots/baxter.urdf: line "), "{complaints:?}");
    assert!(
        complaints[1].contains("joint \"left_s0\": <limit> has velocity=\"fast\""),
        "{complaints:?}"
    );
}

#[test]
fn a_description_without_a_resting_posture_is_refused() {
    let folder = Folder::new(&[("robots/bare.urdf", BAXTER_URDF), ("arm.toml", "robot = 'bare'")]);
    let complaints = folder.complaints(None, &[]);
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    assert!(complaints[0].starts_with("robots/bare.urdf: "), "{complaints:?}");
    assert!(complaints[0].contains("no posture \"neutral\""), "{complaints:?}");
}
