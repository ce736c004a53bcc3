//! Whether the arm can fetch what the scene holds.

use manipulation::{ObjectPose, PlanError, PlanSettings, check_reachable, gripper};
use scene::{Placement, Problem, Scene};

use crate::Arm;
use crate::layer::Table;
use crate::problems::Report;
use crate::text_file::TextFile;

/// Reports every object without a place, and every one that the arm cannot bring.
pub(crate) fn check(scene: &Scene, file: &TextFile, arm: &Arm, tree: &Table, report: &mut Report) {
    let placed = placed(scene, file, report);
    check_widths(&placed, scene, file, arm, report);
    let poses: Vec<ObjectPose> = placed.iter().map(|(_, pose)| *pose).collect();
    let found = check_reachable(&arm.robot, &poses, arm.limb, &arm.plan);
    if found.iter().all(Result::is_ok) {
        return;
    }
    let mut hand_over = None;
    for (((n, _), found), elsewhere) in
        placed.iter().zip(found).zip(reachable_elsewhere(&poses, arm))
    {
        let Err(error) = found else { continue };
        if elsewhere {
            hand_over.get_or_insert(error);
            continue;
        }
        let key = if matches!(error, PlanError::Grasp(_)) { "grasp_width" } else { "xyz" };
        let what = format!("`{}` {}", scene.objects()[*n].name, reason(&error, arm));
        let cure = "move it, or change limb, hover_m or table_z_m of the arm";
        report.add(Problem::new(&*file.label, format!("objects[{n}].{key}"), what, cure));
    }
    if let Some(error) = hand_over {
        report.add(hand_over_problem(tree, &error));
    }
}

/// Reports every object that the gripper could hold but not as it is told to: the fingers do not open
/// that wide, or do not feel it.
fn check_widths(
    placed: &[(usize, ObjectPose)],
    scene: &Scene,
    file: &TextFile,
    arm: &Arm,
    report: &mut Report,
) {
    let open_m = arm.plan.open_width_m;
    for (n, pose) in placed {
        let width_m = pose.grasp_width_m;
        let (what, cure) = if width_m > open_m && width_m <= gripper::STROKE_M {
            let what = format!("is wider than the fingers open: {:.1} mm", open_m * 1e3);
            (what, "raise grip_open_percent of the arm")
        } else if width_m > 0.0 && !gripper::is_felt(width_m) {
            let least_m = gripper::DEAD_ZONE * gripper::STROKE_M;
            let what = format!("is too thin to be told from nothing: {:.1} mm", least_m * 1e3);
            (what, "have it gripped where it is thicker")
        } else {
            continue;
        };
        let what = format!("`{}` {what}", scene.objects()[*n].name);
        report.add(Problem::new(&*file.label, format!("objects[{n}].grasp_width"), what, cure));
    }
}

/// The objects that have a place, with their positions in the scene.
fn placed(scene: &Scene, file: &TextFile, report: &mut Report) -> Vec<(usize, ObjectPose)> {
    let mut placed = Vec::new();
    for (n, object) in scene.objects().iter().enumerate() {
        match object.placement {
            Some(placement) => placed.push((n, pose(&placement))),
            None => {
                let what = format!("`{}` has no place, so it cannot be fetched", object.name);
                let cure = "add `xyz`, `size` and `grasp_width`";
                report.add(Problem::new(&*file.label, format!("objects[{n}].xyz"), what, cure));
            }
        }
    }
    placed
}

fn reason(error: &PlanError, arm: &Arm) -> String {
    let limbs = arm.limb.map_or_else(|| "both limbs".to_owned(), |limb| format!("the {limb} limb"));
    match error {
        PlanError::Unreachable { at, distance_m, .. } => {
            let mm = distance_m * 1e3;
            format!("is out of reach of {limbs}: {mm:.0} mm are missing to {at}")
        }
        PlanError::Grasp(error) => format!("cannot be grasped: {error}"),
        error => format!("cannot be fetched with {limbs}: {error}"),
    }
}

/// Which objects the arm could fetch if it handed over where it does by default: those that it
/// cannot fetch now are not to blame themselves.
fn reachable_elsewhere(poses: &[ObjectPose], arm: &Arm) -> Vec<bool> {
    let hand_over_xyz_m = PlanSettings::default().hand_over_xyz_m;
    if arm.plan.hand_over_xyz_m == hand_over_xyz_m {
        return vec![false; poses.len()];
    }
    let plan = PlanSettings { hand_over_xyz_m, ..arm.plan };
    check_reachable(&arm.robot, poses, arm.limb, &plan).iter().map(Result::is_ok).collect()
}

fn hand_over_problem(tree: &Table, error: &PlanError) -> Problem {
    let path = ["arm", "hand_over_xyz"];
    let source = tree.source_of(&path);
    let [x, y, z] = PlanSettings::default().hand_over_xyz_m;
    let cure = format!("use a place in front of the robot, e.g. [{x}, {y}, {z}]");
    source.problem(&path.map(str::to_owned), format!("objects cannot be brought: {error}"), cure)
}

fn pose(placement: &Placement) -> ObjectPose {
    ObjectPose {
        xyz_m: placement.xyz,
        yaw_rad: placement.yaw,
        size_m: placement.size,
        grasp_width_m: placement.grasp_width,
    }
}
