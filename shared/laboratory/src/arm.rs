//! `arm`: planned motions of the arm, without a group.

use std::path::Path;

use command_line::Outcome;
use command_line::configuration;
use command_line::output::Output;
use manipulation::{Cuboid, Limb, ObjectPose, Phase, PlanSettings, Robot, Timeline, plan_pick};
use preflight::ArmSetup;
use scene::Scene;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};

use crate::args::ArmPlotArgs;
use crate::scene_file;

mod figure;

/// A planned pick with everything it was planned from.
struct Pick<'a> {
    scene: &'a Scene,
    robot: &'a Robot,
    settings: &'a PlanSettings,
    /// Places of all objects.
    places: Vec<ObjectPose>,
    /// Number of the object to fetch.
    object: usize,
    plan: Timeline,
}

/// Draws the motion that fetches an object.
pub(super) fn plot(args: &ArmPlotArgs, out: &mut Output<'_>) -> Outcome {
    if args.samples_hz.is_some() && !out.is_json() {
        let what = "--samples-hz: samples are printed as JSON; help: add --json";
        return Err(Failure::new(Exit::Usage, what));
    }
    if args.out.extension().is_none_or(|ending| ending != "svg") {
        let help = "end its name with .svg";
        let what = format!("{}: not a picture format; help: {help}", args.out.display());
        return Err(Failure::new(Exit::Usage, what));
    }
    let settings = configuration::settings(&args.config)?;
    let scene = match &args.scene {
        None => settings.scene.clone(),
        Some(named) => scene_file::load_named(named, &args.config)?,
    };
    let setup = ArmSetup::new(&settings)?;
    let robot = &setup.robot;
    let limb = match args.limb.as_deref() {
        None => setup.limb,
        Some("auto") => None,
        Some(name) => Some(limb_named(robot, name)?),
    };
    let pick = planned(&scene, args.object.as_deref(), limb, robot, &setup.plan)?;
    if out.is_json() {
        out.json(&to_json(&pick, args.samples_hz))?;
        return Ok(Exit::Ok);
    }
    let chart = figure::chart(&pick, args.width);
    let picture = user_study::charts::svg(&chart)
        .map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
    write(&args.out, picture.as_bytes())?;
    let name = &pick.scene.object(pick.object.into()).name;
    let seconds = pick.plan.duration_s();
    let limb = &robot.arm(pick.plan.limb()).name;
    let file = args.out.display();
    out.line(format_args!("{file}: the {limb} limb fetches {name} in {seconds:.2} s"))?;
    Ok(Exit::Ok)
}

fn limb_named(robot: &Robot, name: &str) -> Result<Limb, Failure> {
    robot.limb_named(name).ok_or_else(|| {
        let known = robot.limbs().iter().map(|limb| robot.arm(*limb).name.as_str());
        let known = known.chain(["auto"]).collect::<Vec<_>>().join(", ");
        Failure::new(Exit::Usage, format!("--limb: expected one of {known}, found `{name}`"))
    })
}

/// Plans the pick as the arm's service does, from rest.
fn planned<'a>(
    scene: &'a Scene,
    object: Option<&str>,
    limb: Option<Limb>,
    robot: &'a Robot,
    settings: &'a PlanSettings,
) -> Result<Pick<'a>, Failure> {
    let refuse =
        |what: String| Failure::new(Exit::Config, format!("scene {}: {what}", scene.name()));
    let names = || scene.objects().iter().map(|object| object.name.as_str()).collect::<Vec<_>>();
    let object = object.map_or(Some(0), |name| scene.objects().iter().position(|o| o.name == name));
    let object = object.ok_or_else(|| {
        refuse(format!("unknown object; help: --object is one of {}", names().join(", ")))
    })?;
    let placed = scene.objects().iter().map(|object| {
        let at = object.placement.ok_or_else(|| {
            let help = "add `xyz`, `size` and `grasp_width`";
            refuse(format!("object `{}` has no place; help: {help}", object.name))
        })?;
        Ok(preflight::pose(&at))
    });
    let places: Vec<ObjectPose> = placed.collect::<Result<_, Failure>>()?;
    let others = places.iter().enumerate().filter(|(i, _)| *i != object);
    let others: Vec<Cuboid> = others.map(|(_, place)| place.cuboid()).collect();
    let rest = robot.neutral();
    let plan = plan_pick(robot, &places[object], limb, &rest, &others, settings);
    let plan = plan.map_err(|error| {
        let name = &scene.objects()[object].name;
        let help = "move it, or let the other limb fetch it: --limb auto";
        refuse(format!("object `{name}` cannot be fetched: {error}; help: {help}"))
    })?;
    Ok(Pick { scene, robot, settings, places, object, plan })
}

fn to_json(pick: &Pick<'_>, samples_hz: Option<f64>) -> Json {
    let plan = &pick.plan;
    let stage = |phase: Phase| {
        let (begin_s, end_s) = plan.span_s(phase)?;
        Some(
            json!({ "phase": phase, "begin_s": begin_s, "end_s": end_s, "seconds": end_s - begin_s }),
        )
    };
    let mut json = json!({
        "scene": pick.scene.name(),
        "object": pick.scene.object(pick.object.into()).name,
        "limb": pick.robot.arm(plan.limb()).name,
        "seconds": plan.duration_s(),
        "stages": figure::PHASES.iter().filter_map(|(phase, _)| stage(*phase)).collect::<Vec<_>>(),
    });
    if let Some(hz) = samples_hz {
        json["joints"] = json!(pick.robot.arm(plan.limb()).joint_names);
        json["object_in_gripper"] = json!(object_in_gripper(pick));
        json["samples"] = samples(pick, hz);
    }
    json
}

/// Returns the pose of the object in frame `<limb>_gripper` while it is held: x, y, z in metres,
/// and a quaternion x, y, z, w.
fn object_in_gripper(pick: &Pick<'_>) -> Option<[f64; 7]> {
    let (_, closed_s) = pick.plan.span_s(Phase::Close)?;
    let arm = pick.robot.arm(pick.plan.limb());
    let gripper = arm.chain.forward(&pick.plan.at(closed_s).q);
    let pose = pick.places[pick.object].in_gripper(&gripper, &arm.gripper);
    let (p, r) = (pose.translation, pose.rotation);
    Some([p.x, p.y, p.z, r.i, r.j, r.k, r.w])
}

/// Returns the plan at equal intervals and at its end: positions in radians, velocities in rad/s,
/// and the width between the fingers in metres.
fn samples(pick: &Pick<'_>, hz: f64) -> Json {
    let plan = &pick.plan;
    let held = |t_s: f64| {
        let (_, from_s) = plan.span_s(Phase::Close)?;
        let (until_s, _) = plan.span_s(Phase::Release)?;
        let name = &pick.scene.object(pick.object.into()).name;
        (from_s..until_s).contains(&t_s).then_some(name)
    };
    let count = (plan.duration_s() * hz).ceil() as usize;
    let sample = |n: usize| {
        let t_s = (n as f64 / hz).min(plan.duration_s());
        let now = plan.at(t_s);
        let joints = ..pick.robot.arm(plan.limb()).chain.joints();
        let (q, qd) = (&now.q[joints], &now.qd[joints]);
        json!({ "t_s": t_s, "q": q, "qd": qd, "width_m": now.width_m, "held": held(t_s) })
    };
    (0..=count).map(sample).collect()
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    safe_files::write_output(path, bytes).map_err(|error| Failure::file(path, &error))
}
