//! Configurations whose scene, robot or durations need the arm to be checked.

use std::fs;
use std::path::{Path, PathBuf};

use config::{SNAPSHOT_FILE, Settings};
use manipulation::{Limb, PlanSettings, Robot};
use robot_model::{BAXTER_SRDF, BAXTER_URDF};
use tempfile::TempDir;

use crate::{ArmSetup, durations, load};

const ONE_BOWL: &str = include_str!("../../../tests/fixtures/scenes/one_bowl.toml");

/// Returns the shipped configuration folder.
fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

/// A configuration folder with one bowl and the given files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("scenes/bowls.toml", ONE_BOWL)].iter().chain(files) {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn owned(overrides: &[(&str, &str)]) -> Vec<(String, String)> {
    overrides.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

/// Every problem of a configuration with such files, one per line, with file names from there.
fn complaints(files: &[(&str, &str)], overrides: &[(&str, &str)]) -> Vec<String> {
    let folder = folder(files);
    let found = load(folder.path(), None, &owned(overrides)).err();
    let problems = found.expect("there are problems").to_string();
    let prefix = format!("{}/", folder.path().display());
    problems.lines().map(|line| line.replace(&prefix, "")).collect()
}

#[test]
fn shipped_scenes_are_within_reach() {
    for scene in ["bowls", "markers", "tools"] {
        let settings = load(&shipped(), None, &owned(&[("group.scene", scene)]));
        assert_eq!(settings.unwrap_or_else(|e| panic!("{scene}: {e}")).scene.name(), scene);
    }
}

#[test]
fn shipped_single_arm_reaches_its_scene() {
    let settings = load(&shipped(), Some("ur5e"), &[]).unwrap_or_else(|e| panic!("{e}"));
    let setup = ArmSetup::new(&settings).unwrap();
    assert_eq!((settings.scene.name(), setup.robot.limbs()), ("blocks", &[Limb::Only][..]));
    for (limb, expected) in [("auto", None), ("arm", Some(Limb::Only))] {
        let over = owned(&[("arm.limb", limb)]);
        let settings = Settings::load(&shipped(), Some("ur5e"), &over).unwrap();
        assert_eq!(ArmSetup::new(&settings).unwrap().limb, expected);
    }
}

#[test]
fn limb_that_the_robot_lacks_is_reported() {
    for (profile, limb, expected) in [
        (
            None,
            "lefft",
            "arm.limb: expected one of auto, left, right, found `lefft`; help: did you mean `left`?",
        ),
        (Some("ur5e"), "left", "arm.limb: expected one of auto, arm, found `left`; help: "),
    ] {
        let error = load(&shipped(), profile, &owned(&[("arm.limb", limb)])).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
}

#[test]
fn default_settings_plan_as_the_planner_does_by_default() {
    let setup = ArmSetup::new(&Settings::load(&shipped(), None, &[]).unwrap()).unwrap();
    assert_eq!((setup.limb, &setup.robot), (None, Robot::baxter()));
    assert_eq!(setup.plan, PlanSettings { speed_ratio: 0.6, ..PlanSettings::default() });
}

#[test]
fn durations_are_measured_once_and_survive_the_snapshot_bit_for_bit() {
    let over = owned(&[("dialogue.costs.from", "robot"), ("dialogue.mode", "present")]);
    let settings = load(&shipped(), None, &over).unwrap();
    let measured = settings.durations.clone().unwrap();
    assert_eq!((measured.point.len(), measured.pick.len()), (6, 6));
    let setup = ArmSetup::new(&settings).unwrap();
    assert_eq!(durations(&settings, &setup, &settings.scene, true).unwrap(), measured);
    let run = tempfile::tempdir().unwrap();
    settings.write_snapshot(run.path()).unwrap();
    let read = Settings::load_snapshot(run.path()).unwrap();
    assert_eq!((&read, read.durations.as_ref()), (&settings, Some(&measured)));
    assert_eq!(read.durations_text(), settings.durations_text());
    let path = run.path().join(SNAPSHOT_FILE);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("pick = [", "pick = [1.0, ")).unwrap();
    let error = Settings::load_snapshot(run.path()).unwrap_err().to_string();
    assert!(error.contains("the durations of this scene are missing"), "{error}");
    let plain = load(&shipped(), None, &[]).unwrap();
    assert_eq!((plain.durations.as_ref(), plain.durations_text()), (None, String::new()));
}

/// `ONE_BOWL` with another line in place of the one that starts with `key`.
fn bowl_with(key: &str, line: &str) -> String {
    let lines = ONE_BOWL.lines().map(|old| if old.starts_with(key) { line } else { old });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn preflight_reports_an_object_out_of_reach() {
    let complaints = |scene: &str, overrides: &[(&str, &str)]| {
        let found = complaints(&[("scenes/bowls.toml", scene)], overrides);
        assert_eq!(found.len(), 1, "{found:?}");
        found.into_iter().next().unwrap()
    };
    let far = complaints(&bowl_with("xyz", "xyz = [2.0, 0.2, -0.125]"), &[]);
    let expected =
        "scenes/bowls.toml:11:1: objects[0].xyz: `red_one` is out of reach of both limbs: ";
    assert!(far.starts_with(expected), "{far}");
    let left = complaints(&bowl_with("xyz", "xyz = [0.7, -0.8, -0.125]"), &[("arm.limb", "left")]);
    assert!(left.contains("`red_one` is out of reach of the left limb: "), "{left}");
    let wide = complaints(&bowl_with("grasp_width", "grasp_width = 0.09"), &[]);
    let expected = "scenes/bowls.toml:13:1: objects[0].grasp_width: `red_one` cannot be grasped: ";
    assert!(wide.starts_with(expected), "{wide}");
    let thin = complaints(&bowl_with("grasp_width", "grasp_width = 0.0015"), &[]);
    assert!(thin.contains("would close on 1.5 mm but holds 1.9 mm at least; help: "), "{thin}");
    let heavy = complaints(&bowl_with("grasp_width", "grasp_width = 0.006\nmass_kg = 2.0"), &[]);
    let expected = "objects[0].mass_kg: `red_one` cannot be grasped: it weighs 2.00 kg";
    assert!(heavy.contains(expected) && heavy.contains("help: use a lighter"), "{heavy}");
    let solid = complaints(&bowl_with("form", "form = \"solid\""), &[]);
    let expected = "`red_one` cannot be grasped: it is solid and 100 mm wide between the fingers, \
                    which open 38 mm at most; help: write `form = \"hollow\"` if";
    assert!(solid.contains("objects[0].form: ") && solid.contains(expected), "{solid}");
    let narrow = [("arm.grip_open_percent", "30.0")];
    let narrow = complaints(&bowl_with("grasp_width", "grasp_width = 0.02"), &narrow);
    assert!(
        narrow
            .contains("`red_one` is gripped at 20.0 mm, and the fingers open 11.4 mm; help: raise"),
        "{narrow}"
    );
}

/// A scene with the bowl and `more` others at its place.
fn crowd(more: usize) -> String {
    let (_, bowl) = ONE_BOWL.split_once("[[objects]]").unwrap();
    let others =
        (0..more).map(|n| format!("[[objects]]{}", bowl.replace("red_one", &format!("red_{n}"))));
    others.fold(ONE_BOWL.to_owned(), |text, object| text + &object)
}

#[test]
fn preflight_refuses_objects_at_one_place_and_too_many_before_it_plans() {
    let two = complaints(&[("scenes/bowls.toml", &crowd(1))], &[]);
    assert!(two[0].contains("`red_0` stands where `red_one` does; help: move one"), "{two:?}");
    let many = complaints(&[("scenes/bowls.toml", &crowd(599))], &[]);
    let expected = "expected at most 256 objects with a place, found 600; help: leave out";
    assert!(many[0].contains(expected), "{many:?}");
    let full = complaints(&[("scenes/bowls.toml", &crowd(255))], &[]);
    assert_eq!(full.iter().filter(|line| line.contains("stands where")).count(), 255);
}

#[test]
fn preflight_reports_a_hand_over_out_of_reach() {
    let second = ONE_BOWL.split("[[objects]]").nth(1).unwrap();
    let second = second.replace("red_one", "other").replace("0.2,", "-0.2,");
    let two = format!("{ONE_BOWL}\n[[objects]]{second}");
    let over = [("arm.hand_over_xyz", "[3.0, 0.0, 0.2]")];
    let complaints = complaints(&[("scenes/bowls.toml", &two)], &over);
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    let expected = "--set: arm.hand_over_xyz: objects cannot be brought: ";
    assert!(complaints[0].starts_with(expected), "{complaints:?}");
}

#[test]
fn preflight_rejects_a_scene_without_poses() {
    let text = "name = 's'\nnoun = 'cup'\n[[attributes]]\nname = 'color'\nvalues = ['red']\n\
                [[objects]]\nname = 'one'\nattributes = { color = 'red' }\n";
    let complaints = complaints(&[("scenes/bowls.toml", text)], &[]);
    assert_eq!(
        complaints,
        [
            "scenes/bowls.toml:6:3: objects: no object has a place, so none can be fetched; help: add `xyz`, `size` and `grasp_width` to those within reach"
        ]
    );
}

#[test]
fn preflight_accepts_thousands_of_objects_without_a_place_but_neither_pointing_nor_measured_costs()
{
    let far = |n: usize| {
        format!("\n[[objects]]\nname = \"far_{n}\"\nattributes = {{ color = \"red\" }}\n")
    };
    let text: String = std::iter::once(ONE_BOWL.to_owned()).chain((0..3_000).map(far)).collect();
    let folder = folder(&[("scenes/bowls.toml", &text)]);
    let settings = load(folder.path(), None, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(settings.scene.objects().len(), 3_001);
    let over = [("dialogue.mode", "present"), ("dialogue.costs.from", "robot")];
    let complaints = complaints(&[("scenes/bowls.toml", &text)], &over);
    let expected = [
        "--set: dialogue.mode: the robot cannot point at `far_0`, which has no place; help: use \"remote\", or give every object a place",
        "--set: dialogue.costs.from: fetching `far_0` takes no known time: it has no place; help: use \"config\", or give every object a place",
    ];
    assert_eq!(complaints, expected);
}

/// A bowl between two boxes that are so near that the gripper does not fit between.
fn narrow() -> String {
    let boxes = [("one", 0.265), ("other", 0.135)].map(|(name, y)| {
        format!(
            "\n[[objects]]\nname = \"{name}\"\nattributes = {{ color = \"red\" }}\nxyz = [0.7, {y}, -0.055]\n\
             size = [0.2, 0.02, 0.2]\ngrasp_width = 0.02\n"
        )
    });
    format!("{ONE_BOWL}{}", boxes.concat())
}

/// The place that a help proposes.
fn proposed(line: &str) -> &str {
    let (_, place) = line.split_once(": xyz = ").unwrap_or_else(|| panic!("{line}"));
    place
}

#[test]
fn clearance_problem_names_the_other_object_and_a_move_that_helps() {
    let text = narrow();
    let found = complaints(&[("scenes/bowls.toml", &text)], &[]);
    assert!(found[0].contains("objects[0].xyz: `red_one` cannot be fetched"), "{found:?}");
    assert!(found[0].contains("(`one` is in the way); help: move it "), "{found:?}");
    let moved = text.replacen("[0.7, 0.2, -0.125]", proposed(&found[0]), 1);
    assert_ne!(moved, text);
    let left = load(folder(&[("scenes/bowls.toml", &moved)]).path(), None, &[]).err();
    let left = left.map_or_else(String::new, |left| left.to_string());
    assert!(!left.contains("`red_one`"), "{left}");
}

#[test]
fn object_out_of_reach_gets_the_nearest_place_within() {
    let far = bowl_with("xyz", "xyz = [0.7, 1.3, -0.125]");
    let found = complaints(&[("scenes/bowls.toml", &far)], &[]);
    assert!(found[0].contains("help: move it ") && found[0].contains("to the right"), "{found:?}");
    let near = bowl_with("xyz", &format!("xyz = {}", proposed(&found[0])));
    load(folder(&[("scenes/bowls.toml", &near)]).path(), None, &[]).unwrap();
}

#[test]
fn places_are_checked_in_the_same_round_as_everything_else() {
    let scene =
        bowl_with("xyz", "xyz = [2.0, 0.2, -0.125]").replace("name = \"color\"", "nmae = 3");
    let files = [("scenes/bowls.toml", scene.as_str()), ("console.toml", "viewers_max = 0")];
    let found = complaints(&files, &[]).join("\n");
    for part in ["console.toml:1:1: viewers_max", "nmae: unknown key", "`red_one` is out of reach"]
    {
        assert!(found.contains(part), "{part}: {found}");
    }
    // With the arm's own settings wrong its reach is not known.
    let files = [("scenes/bowls.toml", scene.as_str()), ("arm.toml", "hover_m = 0")];
    let found = complaints(&files, &[]).join("\n");
    assert!(found.contains("hover_m") && !found.contains("out of reach"), "{found}");
}

/// Baxter with another velocity limit of its first joints.
fn slower() -> String {
    let slower = BAXTER_URDF.replacen("velocity=\"1.5\"", "velocity=\"0.5\"", 20);
    assert_ne!(slower, BAXTER_URDF, "the description has changed");
    slower
}

#[test]
fn preflight_uses_the_configured_robot_description() {
    let folder = folder(&[
        ("robots/slow.urdf", &slower()),
        ("robots/slow.srdf", BAXTER_SRDF),
        ("arm.toml", "robot = 'slow'"),
    ]);
    let setup = ArmSetup::new(&load(folder.path(), None, &[]).unwrap()).unwrap();
    assert_eq!(setup.robot.arm(Limb::Left).limits.velocity[0], 0.5);
}

#[test]
fn preflight_locates_errors_of_a_description() {
    let broken = BAXTER_URDF.replacen("velocity=\"1.5\"", "velocity=\"fast\"", 1);
    let found =
        complaints(&[("robots/baxter.urdf", &broken), ("robots/baxter.srdf", BAXTER_SRDF)], &[]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("robots/baxter.urdf:157: "), "{found:?}");
    assert!(found[0].contains("joint \"left_s0\": <limit> has velocity=\"fast\""), "{found:?}");
}

#[test]
fn preflight_rejects_a_description_without_a_rest_posture() {
    let files = [("robots/bare.urdf", BAXTER_URDF), ("arm.toml", "robot = 'bare'")];
    let found = complaints(&files, &[]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("robots/bare.urdf: "), "{found:?}");
    assert!(found[0].contains("no posture \"neutral\""), "{found:?}");
}

/// The single arm that is shipped, under another name, with a change of its files.
fn other_arm(urdf: impl Fn(&str) -> String, srdf: impl Fn(&str) -> String) -> Vec<String> {
    let read = |file: &str| fs::read_to_string(shipped().join(file)).unwrap();
    let files = [
        ("robots/my.urdf", urdf(&read("robots/ur5e.urdf"))),
        ("robots/my.srdf", srdf(&read("robots/ur5e.srdf"))),
        ("profiles/ur5e.toml", read("profiles/ur5e.toml")),
        ("scenes/blocks.toml", read("scenes/blocks.toml")),
    ];
    let files: Vec<(&str, &str)> =
        files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let folder = folder(&files);
    let over = owned(&[("arm.robot", "my")]);
    let found = load(folder.path(), Some("ur5e"), &over).err();
    let problems = found.map_or_else(String::new, |found| found.to_string());
    problems.lines().map(str::to_owned).collect()
}

#[test]
fn posture_of_rest_in_the_table_is_reported_once() {
    let same = |text: &str| text.to_owned();
    assert_eq!(other_arm(same, same), [""; 0]);
    let low = |text: &str| {
        text.replacen(
            "shoulder_lift_joint\" value=\"-2.0\"",
            "shoulder_lift_joint\" value=\"0.5\"",
            1,
        )
        .replacen("elbow_joint\" value=\"2.0\"", "elbow_joint\" value=\"0.1\"", 1)
    };
    let found = other_arm(same, low);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("arm.robot: at the neutral posture the only arm's"), "{found:?}");
    assert!(found[0].contains("help: change its group_state in the SRDF"), "{found:?}");
}
