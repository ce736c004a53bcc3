//! `whichone fk`: where every link is.

use std::io::Read;

use manipulation::Joints;
use nalgebra::Isometry3;
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};

use super::{parse, run};
use crate::Outcome;
use crate::described_arm::DescribedArm;
use crate::output::Output;

#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    q: Joints,
}

/// Answers each posture with `{"id","links":{name:{"xyz","xyzw"}}}`: metres in the frame of the
/// robot's root, and unit quaternions with w ≥ 0. Postures beyond the joint limits are answered,
/// too.
///
/// # Errors
/// See [`run`].
pub fn fk(arm: &DescribedArm, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| {
        let line: Line = parse(line)?;
        if let Some(q) = line.q.iter().find(|q| q.abs() > POSITION_MAX) {
            return Err(format!("q: {q} rad is no position of a joint"));
        }
        let links: Map<_, _> =
            arm.links(&line.q).map(|(name, pose)| (name.to_owned(), pose_to_json(&pose))).collect();
        Ok(json!({ "id": line.id, "links": links }))
    })
}

/// Beyond this an angle says nothing about a direction any more.
const POSITION_MAX: f64 = 1e6;

fn pose_to_json(pose: &Isometry3<f64>) -> Json {
    let (xyz, xyzw): ([f64; 3], [f64; 4]) =
        (pose.translation.vector.into(), pose.rotation.coords.into());
    json!({ "xyz": xyz, "xyzw": xyzw })
}
