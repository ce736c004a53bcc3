//! Published descriptions become robots that fetch.

#![allow(clippy::unwrap_used, reason = "tests")]

mod five_joints;
#[path = "../../../manipulation/src/random.rs"]
#[allow(dead_code, reason = "a part is needed")]
mod random;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

use manipulation::{Cuboid, ObjectPose, PlanSettings, Robot, fetching_limb, plan_pick};
use robot_import::{Gripper, Imported, Kind, Options, Refused, import};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/robots").join(name)
}

fn options() -> Options {
    Options { name: "own".to_owned(), ..Options::default() }
}

/// What becomes of a file, which is imported once: the same file gives the same robot.
fn imported(name: &'static str) -> Arc<Imported> {
    static IMPORTED: Mutex<BTreeMap<&str, Arc<OnceLock<Arc<Imported>>>>> =
        Mutex::new(BTreeMap::new());
    let once = Arc::clone(IMPORTED.lock().unwrap().entry(name).or_default());
    let first = || import(&file(name), &options()).unwrap_or_else(|it| panic!("{name}: {it:#?}"));
    Arc::clone(once.get_or_init(|| Arc::new(first())))
}

fn refused(name: &str, options: &Options) -> Box<Refused> {
    import(&file(name), options).map(|it| it.profile).unwrap_err()
}

fn robot(imported: &Imported) -> Robot {
    let description = robot_model::Robot::parse(&imported.urdf, Some(&imported.srdf)).unwrap();
    Robot::from_description(&description).unwrap()
}

/// Numbers of a line `KEY = [A, B, C]` or `KEY = A`.
fn numbers(text: &str, key: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
    lines
        .map(|line| {
            line.trim_matches(['[', ']']).split(", ").map(|it| it.parse().unwrap()).collect()
        })
        .collect()
}

fn three(numbers: &[f64]) -> [f64; 3] {
    numbers.try_into().unwrap()
}

/// The blocks of the scene, and the settings of the profile.
fn blocks(imported: &Imported) -> (Vec<ObjectPose>, PlanSettings) {
    let of = |key: &str| numbers(&imported.scene, key);
    let rows = of("xyz").into_iter().zip(of("size")).zip(of("grasp_width")).zip(of("mass_kg"));
    let blocks = rows.map(|(((xyz, size), width), mass)| ObjectPose {
        xyz_m: three(&xyz),
        yaw_rad: 0.0,
        size_m: three(&size),
        grasp_width_m: width[0],
        mass_kg: Some(mass[0]),
        wall_rad: 0.0,
        hollow: false,
    });
    let plan = PlanSettings {
        speed_ratio: 0.6,
        hand_over_xyz_m: three(&numbers(&imported.profile, "hand_over_xyz")[0]),
        table_z_m: numbers(&imported.profile, "table_z_m")[0][0],
        ..PlanSettings::default()
    };
    let of = |key: &str, or: f64| numbers(&imported.profile, key).first().map_or(or, |it| it[0]);
    let plan = PlanSettings {
        table_near_m: of("table_near_m", plan.table_near_m),
        hover_m: of("hover_m", plan.hover_m),
        standoff_m: of("standoff_m", plan.standoff_m),
        ..plan
    };
    (blocks.collect(), plan)
}

/// Every block can be fetched among the others, and a whole motion is planned for each.
fn fetches_every_block(name: &'static str) {
    let imported = imported(name);
    let robot = robot(&imported);
    let (blocks, plan) = blocks(&imported);
    assert_eq!(blocks.len(), 6, "{name}");
    for (i, block) in blocks.iter().enumerate() {
        let others = blocks.iter().enumerate().filter(|(j, _)| *j != i);
        let others: Vec<Cuboid> = others.map(|(_, other)| other.cuboid()).collect();
        fetching_limb(&robot, block, None, &others, &plan)
            .unwrap_or_else(|error| panic!("{name}, block {i}: {error}"));
        plan_pick(&robot, block, None, &robot.neutral(), &others, &plan)
            .unwrap_or_else(|error| panic!("{name}, block {i}: {error}"));
    }
}

macro_rules! fetches {
    ($($test:ident: $file:literal,)*) => {
        $(#[test]
        fn $test() {
            fetches_every_block($file);
        })*
    };
}

fetches! {
    panda_fetches_every_block: "panda/panda.urdf",
    xarm7_fetches_every_block: "xarm7/xarm7.urdf",
    xarm6_with_a_linkage_fetches_every_block: "xarm6_with_gripper.urdf",
    z1_with_one_jaw_fetches_every_block: "z1.urdf",
    ur5_without_meshes_fetches_every_block: "ur5.urdf",
    iiwa7_without_meshes_fetches_every_block: "iiwa7.urdf",
    jaco_with_continuous_joints_fetches_every_block: "jaco.urdf",
    fetch_on_its_lift_fetches_every_block: "fetch.urdf",
    so101_with_one_jaw_fetches_every_block: "so101/so101.urdf",
    so100_without_meshes_fetches_every_block: "so100.urdf",
    widowx_without_meshes_fetches_every_block: "widowx.urdf",
}

/// Published files disable the pairs that sampling finds; the comparison counts those that stay checked, too.
#[test]
fn sampled_pairs_are_those_of_published_files() {
    for (name, srdf) in
        [("panda/panda.urdf", "panda/panda.srdf"), ("xarm7/xarm7.urdf", "xarm7/xarm7.srdf")]
    {
        let options = Options { srdf: Some(file(srdf)), ..options() };
        let imported = import(&file(name), &options).unwrap_or_else(|it| panic!("{name}: {it:#?}"));
        let pairs = &imported.findings.pairs;
        eprintln!("{name}: {pairs:?}");
        assert!(pairs.precision.unwrap() >= 0.94, "{name}: {pairs:?}");
        assert!(pairs.recall.unwrap() >= 0.94, "{name}: {pairs:?}");
        assert_eq!(pairs.postures, 10_000);
    }
}

/// Names are those of nothing in particular, and one is that of Baxter's left hand.
#[test]
fn structure_decides_and_no_name() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(file("panda/panda.urdf")).unwrap();
    let text = text
        .replace("panda_leftfinger", "left_gripper")
        .replace("panda_rightfinger", "right_gripper")
        .replace("panda_hand", "box_a")
        .replace("panda_finger_joint", "j_")
        .replace("panda_link", "l");
    let own = folder.path().join("nameless.urdf");
    std::fs::write(&own, format!("\u{feff}{text}")).unwrap();
    let imported = import(&own, &options()).unwrap_or_else(|it| panic!("{it:#?}"));
    let robot = robot(&imported);
    let arm = robot.arm(robot.limbs()[0]);
    assert_eq!(robot.limbs().len(), 1);
    assert_eq!(arm.joint_names.first().unwrap(), "panda_joint1");
    assert_eq!(arm.joint_names.len(), 7);
    assert!((arm.gripper.open_m - 0.08).abs() < 1e-3, "{:?}", arm.gripper);
    let chosen: Vec<&str> = imported.findings.of(Kind::Chosen).collect();
    assert!(
        chosen.iter().any(|it| it.contains("2 sliding fingers, 1 coupled on box_a")),
        "{chosen:?}"
    );
}

#[test]
fn grippers_are_found_by_their_joints() {
    for (name, expected) in [
        ("xarm6_with_gripper.urdf", "a linkage of 6 joints, 5 coupled"),
        ("fetch.urdf", "2 sliding fingers, 0 coupled"),
        ("z1.urdf", "one turning jaw"),
    ] {
        let findings = &imported(name).findings;
        assert!(findings.of(Kind::Chosen).any(|it| it.contains(expected)), "{name}: {findings:#?}");
    }
    let findings = &imported("jaco.urdf").findings;
    let assumed: Vec<&str> = findings.of(Kind::Assumed).collect();
    for expected in ["no joint moves a finger", "turns without end", "spacing of their joints"] {
        assert!(assumed.iter().any(|it| it.contains(expected)), "{expected}: {assumed:#?}");
    }
    let ignored: Vec<&str> = findings.of(Kind::Ignored).collect();
    assert!(!ignored.is_empty(), "the SRDF of Jaco has faults that are named: {findings:#?}");
    assert!(findings.of(Kind::Missing).any(|it| it.contains("mesh files")), "{findings:#?}");
}

#[test]
fn lift_stands_still_and_is_named() {
    let findings = &imported("fetch.urdf").findings;
    assert!(findings.of(Kind::Assumed).any(|it| it.contains("torso_lift_joint")), "{findings:#?}");
    assert!(findings.of(Kind::Chosen).any(|it| it.contains("torso_lift_link")), "{findings:#?}");
}

#[test]
fn arms_of_four_joints_are_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(file("widowx.urdf")).unwrap();
    let stiff =
        text.replacen("name=\"joint_5\" type=\"revolute\"", "name=\"joint_5\" type=\"fixed\"", 1);
    assert_ne!(stiff, text);
    let own = folder.path().join("four.urdf");
    std::fs::write(&own, stiff).unwrap();
    let text = import(&own, &options()).map(|it| it.profile).unwrap_err().faults.to_string();
    assert!(text.contains("found 4: ") && text.contains("fewer joints cannot grasp"), "{text}");
    let options = Options { tip: Some("link_ee".to_owned()), ..options() };
    let text = refused("xarm7/xarm7.urdf", &options).faults.to_string();
    assert!(text.contains("link_eef"), "{text}");
}

/// Limits that are missing are assumed, named as such, and listed as missing.
#[test]
fn missing_limits_are_assumed_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(file("xarm7/xarm7.urdf")).unwrap();
    let mut lines: Vec<String> = Vec::new();
    let mut joint = String::new();
    for line in text.lines() {
        if let Some(at) = line.find("<joint name=\"") {
            joint = line[at + 13..].split('"').next().unwrap().to_owned();
        }
        if !(line.contains("<limit") && joint == "joint3") {
            lines.push(line.to_owned());
        }
    }
    let own = folder.path().join("no_limits.urdf");
    std::fs::write(&own, lines.join("\n")).unwrap();
    let options = Options { gripper: Gripper::None, ..options() };
    let imported = import(&own, &options).unwrap_or_else(|it| panic!("{it:#?}"));
    let missing: Vec<&str> = imported.findings.of(Kind::Missing).collect();
    assert!(
        missing.iter().any(|it| it.contains("lower and upper of joint joint3")),
        "{missing:#?}"
    );
    assert!(missing.iter().any(|it| it.contains("velocity of joint joint3")), "{missing:#?}");
}

#[test]
fn same_file_gives_the_same_robot() {
    let again = import(&file("iiwa7.urdf"), &options()).unwrap();
    assert_eq!(*imported("iiwa7.urdf"), again);
}
