//! `whichone fk` and `whichone ik`: forward and inverse kinematics.

use std::io::Read;
use std::time::Instant;

use command_line::Outcome;
use command_line::output::Output;
use manipulation::{Chain, Joints};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};

use super::{parse, run};
use crate::described_arm::DescribedArm;

#[derive(Deserialize)]
struct Posture {
    #[serde(default)]
    id: Json,
    q: Vec<f64>,
}

/// Answers each posture with `{"id","links":{name:{"xyz","xyzw"}}}`: metres in the frame of the
/// robot's root, and unit quaternions with w ≥ 0. Postures beyond the joint limits are answered,
/// too.
///
/// # Errors
/// See [`run`].
pub fn fk(arm: &DescribedArm, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| {
        let line: Posture = parse(line)?;
        expect_joints("q", &line.q, arm.joints())?;
        if let Some(q) = line.q.iter().find(|q| q.abs() > POSITION_MAX) {
            return Err(format!("q: {q} rad is no position of a joint"));
        }
        let links: Map<_, _> =
            arm.links(&line.q).map(|(name, pose)| (name.to_owned(), pose_to_json(&pose))).collect();
        Ok(json!({ "id": line.id, "links": links }))
    })
}

/// Largest angle whose direction a floating-point number still resolves, radians.
const POSITION_MAX: f64 = 1e6;

fn pose_to_json(pose: &Isometry3<f64>) -> Json {
    let (xyz, xyzw): ([f64; 3], [f64; 4]) =
        (pose.translation.vector.into(), pose.rotation.coords.into());
    json!({ "xyz": xyz, "xyzw": xyzw })
}

#[derive(Deserialize)]
struct Pose {
    #[serde(default)]
    id: Json,
    xyz: [f64; 3],
    xyzw: [f64; 4],
    #[serde(default)]
    q_seed: Option<Vec<f64>>,
}

/// Answers each pose of the chain's tip with
/// `{"id","ok","q","position_error_m","rotation_error_rad","micros"}`: the posture nearest to
/// `q_seed` if given, else the first found; without a solution, the one nearest to the pose.
///
/// # Errors
/// See [`run`].
pub fn ik(chain: &Chain, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| answer(chain, &parse(line)?))
}

fn answer(chain: &Chain, line: &Pose) -> Result<Json, String> {
    let target = pose(line)?;
    let seed = line.q_seed.as_ref().map(|q| posture(q, chain.joints())).transpose()?;
    let started = Instant::now();
    let solved = chain.inverse(&target, seed.as_ref());
    let micros = started.elapsed().as_secs_f64() * 1e6;
    let (ok, q, position_error_m, rotation_error_rad) = match solved {
        Ok(found) => (true, found.q, found.position_error_m, found.rotation_error_rad),
        Err(near) => (false, near.nearest, near.position_error_m, near.rotation_error_rad),
    };
    Ok(json!({
        "id": line.id,
        "ok": ok,
        "q": q[..chain.joints()],
        "position_error_m": position_error_m,
        "rotation_error_rad": rotation_error_rad,
        "micros": micros,
    }))
}

fn expect_joints(key: &str, q: &[f64], joints: usize) -> Result<(), String> {
    let found = q.len();
    (found == joints)
        .then_some(())
        .ok_or_else(|| format!("{key}: expected {joints} joint positions, found {found}"))
}

fn posture(q: &[f64], joints: usize) -> Result<Joints, String> {
    expect_joints("q_seed", q, joints)?;
    Ok(std::array::from_fn(|j| q.get(j).copied().unwrap_or(0.0)))
}

fn pose(line: &Pose) -> Result<Isometry3<f64>, String> {
    let [x, y, z, w] = line.xyzw;
    let quaternion = Quaternion::new(w, x, y, z);
    let length = quaternion.norm();
    // Beyond these a square of a component would under- or overflow and the direction be lost.
    if !(1e-100..=1e100).contains(&length) {
        return Err("xyzw: is not a rotation".to_owned());
    }
    let rotation = UnitQuaternion::new_normalize(quaternion);
    Ok(Isometry3::from_parts(Translation3::from(line.xyz), rotation))
}
