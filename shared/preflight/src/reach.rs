//! Reachability of the objects of a scene.

use std::num::NonZero;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use std::{iter, panic, thread};

use config::{CostsFrom, Settings};
use diagnostics::{Diagnostic, Report};
use manipulation::{GraspError, Limb, ObjectPose, PlanError, PlanSettings, check_reachable};
use scene::{Form, Placement};

use crate::{ArmSetup, Arrangement, Watch};

/// Niceness of threads that help to check the reach.
const NICENESS: i32 = 10;

/// Most objects with a place. The plans that are tried grow with the square of their number: this
/// many take seconds. Objects without a place are not planned, so that their number is not limited.
const PLACED_MAX: usize = 256;

/// Time for which the other objects are looked at, and better places searched, after the first
/// object that cannot be fetched: if robot and scene do not fit, each look takes long.
const PATIENCE: Duration = Duration::from_secs(10);

/// Reports every object with a place that the arm cannot bring, and settings that need the places
/// of all objects if some have none. `plan` plans every pick, if the durations are needed, and
/// returns whether it has: then all objects can be fetched.
pub(crate) fn check(
    settings: &Settings,
    setup: &ArmSetup,
    report: &mut Report,
    watch: Watch<'_>,
    plan: impl FnOnce() -> bool,
) {
    let placed = placed(settings);
    // An object whose place is wrong has none here.
    if report.count() == 0 {
        check_unplaced(settings, placed.len(), report);
    }
    if placed.len() > PLACED_MAX {
        let what =
            format!("expected at most {PLACED_MAX} objects with a place, found {}", placed.len());
        let help = "leave out the places of objects that need not be fetched, or divide them between scenes";
        return report.add(settings.scene_diagnostic("objects", what, help));
    }
    if !check_apart(&placed, settings, report) {
        return;
    }
    check_widths(&placed, settings, setup, report);
    let poses: Vec<ObjectPose> = placed.iter().map(|(_, pose)| *pose).collect();
    let has_planned = plan() && placed.len() == settings.scene.objects().len();
    if has_planned {
        return;
    }
    let found = reachable(setup, &poses, &setup.plan, watch);
    if found.iter().all(|found| matches!(found, Some(Ok(_)))) {
        return;
    }
    let until = Instant::now() + PATIENCE;
    let at_rest = found.iter().flatten().filter_map(|found| found.as_ref().err());
    if let Some(error) = at_rest.copied().find(PlanError::is_at_rest) {
        let help = "change its group_state in the SRDF, table_z_m of the arm, or what stands there";
        return report.add(settings.diagnostic(&["arm", "robot"], error.to_string(), help));
    }
    let mut hand_over = None;
    let elsewhere = reachable_elsewhere(&poses, setup, watch);
    let names: Vec<&str> =
        placed.iter().map(|(n, _)| settings.scene.objects()[*n].name.as_str()).collect();
    let (arrangement, mut searched) = (Arrangement::new(setup, poses).until(until), 0);
    let unknown = found.iter().filter(|found| found.is_none()).count();
    for (i, (((n, _), found), elsewhere)) in placed.iter().zip(found).zip(elsewhere).enumerate() {
        let Some(Err(error)) = found else { continue };
        if elsewhere {
            hand_over.get_or_insert(error);
            continue;
        }
        if let PlanError::Grasp(grasp) = &error {
            let (key, help) = grasp_help(grasp);
            report.add(of_object(settings, *n, key, &reason(&error, setup), help));
            continue;
        }
        let is_searched = searched < SEARCHED_MAX && Instant::now() < until;
        searched += usize::from(is_searched);
        watch(format!("looking for a better place of `{}`", settings.scene.objects()[*n].name));
        let (what, help) = move_help(i, &error, is_searched, &names, &arrangement);
        report.add(of_object(settings, *n, "xyz", &what, &help));
    }
    if let Some(error) = hand_over {
        report.add(hand_over_problem(settings, &error));
    }
    if unknown > 0 {
        let seconds = PATIENCE.as_secs();
        let what = format!(
            "whether the arm can fetch {unknown} more of {} objects is not known after another {seconds} s",
            placed.len()
        );
        let help = "mend the others first; fewer collision shapes of the robot are checked faster";
        report.add(settings.scene_diagnostic("objects", what, help));
    }
}

/// Returns for each object the limb that can fetch it among the others; `None` for those not
/// examined within [`PATIENCE`] after the first failure. The objects are divided among all
/// processors; all but this thread give way to others, also to an arm that moves during a reload.
fn reachable(
    setup: &ArmSetup,
    poses: &[ObjectPose],
    plan: &PlanSettings,
    watch: Watch<'_>,
) -> Vec<Option<Result<Limb, PlanError>>> {
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let look_at = |done| watch(format!("checking reach: {done} of {} places", poses.len()));
    look_at(0);
    let failed = OnceLock::<Instant>::new();
    let look = || -> Vec<_> {
        let mine = iter::from_fn(|| {
            let is_late = failed.get().is_some_and(|since| since.elapsed() > PATIENCE);
            Some(next.fetch_add(1, Ordering::Relaxed)).filter(|i| *i < poses.len() && !is_late)
        });
        let check = |i| {
            let found = check_reachable(&setup.robot, poses, i, setup.limb, plan);
            if found.is_err() {
                failed.get_or_init(Instant::now);
            }
            look_at(done.fetch_add(1, Ordering::Relaxed) + 1);
            (i, found)
        };
        mine.map(check).collect()
    };
    let help = || {
        let _ = rustix::process::nice(NICENESS);
        look()
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(poses.len());
    let found: Vec<_> = thread::scope(|scope| {
        // Without a thread it takes longer.
        let start = |_| thread::Builder::new().spawn_scoped(scope, help).ok();
        let helpers: Vec<_> = (1..threads).filter_map(start).collect();
        let own = look();
        let joined = helpers.into_iter().map(|helper| helper.join());
        let theirs = joined.flat_map(|it| it.unwrap_or_else(|cause| panic::resume_unwind(cause)));
        own.into_iter().chain(theirs).collect()
    });
    let mut all: Vec<_> = poses.iter().map(|_| None).collect();
    for (i, found) in found {
        all[i] = Some(found);
    }
    all
}

/// Most objects for which a better place is searched: each takes a second or so.
const SEARCHED_MAX: usize = 8;

/// Returns why object `i` cannot be fetched, with the other object that is in the way, and a move
/// that helps, both if `is_searched`.
fn move_help(
    i: usize,
    error: &PlanError,
    is_searched: bool,
    names: &[&str],
    arrangement: &Arrangement<'_>,
) -> (String, String) {
    const OTHERWISE: &str = "leave out its place, or change limb, hover_m or table_z_m of the arm";
    let mut what = reason(error, arrangement.setup());
    if !is_searched {
        return (what, format!("move it, {OTHERWISE}"));
    }
    if let Some(other) = arrangement.in_the_way(i) {
        what += &format!(" (`{}` is in the way)", names[other]);
    }
    let help = match arrangement.nearest(i) {
        None if arrangement.is_late() => format!("move it, {OTHERWISE}"),
        None => format!("no place at this height helps: {OTHERWISE}"),
        Some(to) => {
            let [x, y, z] = to;
            let moved = directions(arrangement.poses()[i].xyz_m, to);
            format!("move it {moved}: xyz = [{x}, {y}, {z}]")
        }
    };
    (what, help)
}

/// A horizontal move in words, as the robot sees it: `40 mm to the left and 10 mm forward`.
fn directions(from: [f64; 3], to: [f64; 3]) -> String {
    let part = |axis: usize, plus: &str, minus: &str| {
        let mm = (to[axis] - from[axis]) * 1e3;
        let way = if mm > 0.0 { plus } else { minus };
        (mm.abs() >= 0.5).then(|| format!("{:.0} mm {way}", mm.abs()))
    };
    let parts = [part(1, "to the left", "to the right"), part(0, "forward", "back")];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

/// Returns the key that keeps an object from being held, and how it can be held after all.
fn grasp_help(error: &GraspError) -> (&'static str, &'static str) {
    match error {
        GraspError::TooWide { .. } => {
            ("grasp_width", "choose a thinner part to grip, or leave out its place")
        }
        GraspError::TooThin { .. } => (
            "grasp_width",
            "choose a thicker part to grip, or mount the fingers further in (docs/baxter.md)",
        ),
        GraspError::NoRim { .. } => (
            "form",
            "write `form = \"hollow\"` if it is gripped at its rim, else leave out its place",
        ),
        GraspError::TooHeavy { .. } => {
            ("mass_kg", "use a lighter or smaller object, stronger fingers, or leave out its place")
        }
        GraspError::Malformed { .. } => ("grasp_width", "correct the number"),
    }
}

/// A problem with the object at `n`.
fn of_object(settings: &Settings, n: usize, key: &str, what: &str, help: &str) -> Diagnostic {
    let what = format!("`{}` {what}", settings.scene.objects()[n].name);
    settings.scene_diagnostic(format!("objects[{n}].{key}"), what, help)
}

/// Reports every object at the place of an earlier one, which no plan can solve: their centres are
/// nearer in each direction than a quarter of the smaller one. Returns whether there are none.
fn check_apart(placed: &[(usize, ObjectPose)], settings: &Settings, report: &mut Report) -> bool {
    let is_at = |a: &ObjectPose, b: &ObjectPose| {
        (0..3).all(|axis| {
            let least_m = a.size_m[axis].min(b.size_m[axis]) / 4.0;
            (a.xyz_m[axis] - b.xyz_m[axis]).abs() < least_m
        })
    };
    let mut all_apart = true;
    for (i, (n, pose)) in placed.iter().enumerate() {
        let earlier = placed[..i].iter().find(|(_, earlier)| is_at(pose, earlier));
        let Some((earlier, _)) = earlier else { continue };
        let what = format!("stands where `{}` does", settings.scene.objects()[*earlier].name);
        report.add(of_object(settings, *n, "xyz", &what, "move one of them"));
        all_apart = false;
    }
    all_apart
}

/// Reports every object that a limb's gripper could hold if `grip_open_percent` were 100: one that
/// is wider than the fingers open. Planning finds objects too wide for any gripper.
fn check_widths(
    placed: &[(usize, ObjectPose)],
    settings: &Settings,
    setup: &ArmSetup,
    report: &mut Report,
) {
    let widest = |percent: f64| {
        let limbs =
            setup.robot.limbs().iter().filter(|limb| setup.limb.is_none_or(|own| own == **limb));
        let widths = limbs.map(|limb| setup.robot.arm(*limb).gripper.width_m(percent));
        widths.fold(0.0, f64::max)
    };
    let (open_m, whole_m) = (widest(setup.plan.open_percent), widest(100.0));
    for (n, pose) in placed {
        if pose.grasp_width_m > open_m && pose.grasp_width_m <= whole_m {
            let (width_mm, open_mm) = (pose.grasp_width_m * 1e3, open_m * 1e3);
            let what =
                format!("is gripped at {width_mm:.1} mm, and the fingers open {open_mm:.1} mm");
            let help = format!(
                "raise grip_open_percent of the arm: at 100 they open {:.1} mm",
                whole_m * 1e3
            );
            report.add(of_object(settings, *n, "grasp_width", &what, &help));
        }
    }
}

/// The objects that have a place, with their positions in the scene.
fn placed(settings: &Settings) -> Vec<(usize, ObjectPose)> {
    let objects = settings.scene.objects().iter().enumerate();
    objects.filter_map(|(n, object)| Some((n, pose(&object.placement?)))).collect()
}

/// Reports impossible settings for objects without a place: fetching nothing at all, pointing at
/// them, and the seconds of fetching them as costs.
fn check_unplaced(settings: &Settings, placed: usize, report: &mut Report) {
    let objects = settings.scene.objects();
    let Some(first) = objects.iter().position(|object| object.placement.is_none()) else { return };
    if placed == 0 {
        let what = "no object has a place, so none can be fetched";
        let help = "add `xyz`, `size` and `grasp_width` to those within reach";
        return report.add(settings.scene_diagnostic("objects", what, help));
    }
    let name = &objects[first].name;
    if settings.dialogue.actions.point() {
        let what = format!("the robot cannot point at `{name}`, which has no place");
        let help = "use \"remote\", or give every object a place";
        report.add(settings.diagnostic(&["dialogue", "mode"], what, help));
    }
    if settings.dialogue.costs_from == CostsFrom::Robot {
        let what = format!("fetching `{name}` takes no known time: it has no place");
        let help = "use \"config\", or give every object a place";
        report.add(settings.diagnostic(&["dialogue", "costs", "from"], what, help));
    }
}

fn reason(error: &PlanError, setup: &ArmSetup) -> String {
    let limbs = match (setup.limb, setup.robot.limbs()) {
        (Some(limb), _) => format!("the {limb} limb"),
        (None, [_]) => "the limb".to_owned(),
        (None, _) => "both limbs".to_owned(),
    };
    match error {
        PlanError::Unreachable { at, distance_m, .. } => {
            let mm = distance_m * 1e3;
            format!("is out of reach of {limbs}: {mm:.0} mm are missing to {at}")
        }
        PlanError::Grasp(error) => format!("cannot be grasped: {error}"),
        error => format!("cannot be fetched with {limbs}: {error}"),
    }
}

/// Returns for each object whether the arm could fetch it with the default hand-over: if so, the
/// configured hand-over is at fault, not the object.
fn reachable_elsewhere(poses: &[ObjectPose], setup: &ArmSetup, watch: Watch<'_>) -> Vec<bool> {
    let hand_over_xyz_m = PlanSettings::default().hand_over_xyz_m;
    if setup.plan.hand_over_xyz_m == hand_over_xyz_m {
        return vec![false; poses.len()];
    }
    let plan = PlanSettings { hand_over_xyz_m, ..setup.plan };
    let found = reachable(setup, poses, &plan, watch);
    found.iter().map(|found| matches!(found, Some(Ok(_)))).collect()
}

fn hand_over_problem(settings: &Settings, error: &PlanError) -> Diagnostic {
    let [x, y, z] = PlanSettings::default().hand_over_xyz_m;
    let help = format!("use a place in front of the robot, e.g. [{x}, {y}, {z}]");
    let what = format!("objects cannot be brought: {error}");
    settings.diagnostic(&["arm", "hand_over_xyz"], what, help)
}

/// Converts the placement of a scene's object.
pub fn pose(placement: &Placement) -> ObjectPose {
    ObjectPose {
        xyz_m: placement.xyz,
        yaw_rad: placement.yaw,
        size_m: placement.size,
        grasp_width_m: placement.grasp_width,
        mass_kg: placement.mass_kg,
        wall_rad: placement.wall_deg.to_radians(),
        hollow: placement.form == Form::Hollow,
    }
}
