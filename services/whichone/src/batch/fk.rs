//! `whichone fk`: where every link is.

use std::io::Read;

use kinematics::{Joints, Limb};
use nalgebra::Isometry3;
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};

use super::{parse, run};
use crate::output::Output;
use crate::trouble::Outcome;

#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    q: Joints,
}

/// Answers each posture with `{"id","links":{name:{"xyz","xyzw"}}}`: metres in frame `base`, and
/// unit quaternions with w ≥ 0. Postures beyond the joint limits are answered, too.
///
/// # Errors
/// See [`run`].
pub fn fk(limb: Limb, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| {
        let line: Line = parse(line)?;
        if let Some(q) = line.q.iter().find(|q| q.abs() > POSITION_MAX_RAD) {
            return Err(format!("q: {q} rad is no position of a joint"));
        }
        let links = kinematics::links::links(limb, &line.q, 0.0)
            .into_iter()
            .map(|(name, pose)| (name, pose_to_json(&pose)));
        Ok(json!({ "id": line.id, "links": links.collect::<Map<_, _>>() }))
    })
}

/// Beyond this an angle says nothing about a direction any more.
const POSITION_MAX_RAD: f64 = 1e6;

fn pose_to_json(pose: &Isometry3<f64>) -> Json {
    let (xyz, xyzw): ([f64; 3], [f64; 4]) =
        (pose.translation.vector.into(), pose.rotation.coords.into());
    json!({ "xyz": xyz, "xyzw": xyzw })
}
