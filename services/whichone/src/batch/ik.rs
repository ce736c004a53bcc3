//! `whichone ik`: how to reach a pose.

use std::io::Read;
use std::time::Instant;

use manipulation::{Chain, Joints};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use serde::Deserialize;
use serde_json::{Value as Json, json};

use super::{parse, run};
use crate::Outcome;
use crate::output::Output;

#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    xyz: [f64; 3],
    xyzw: [f64; 4],
    #[serde(default)]
    q_seed: Option<Joints>,
}

/// Answers each pose of the chain's tip with
/// `{"id","ok","q","position_error_m","rotation_error_rad","micros"}`: the posture nearest to
/// `q_seed` where there is one, else the first found; where there is none, the one that comes
/// nearest to the pose.
///
/// # Errors
/// See [`run`].
pub fn ik(chain: &Chain, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| answer(chain, &parse(line)?))
}

fn answer(chain: &Chain, line: &Line) -> Result<Json, String> {
    let target = pose(line)?;
    let started = Instant::now();
    let solved = chain.inverse(&target, line.q_seed.as_ref());
    let micros = started.elapsed().as_secs_f64() * 1e6;
    let (ok, q, position_error_m, rotation_error_rad) = match solved {
        Ok(found) => (true, found.q, found.position_error_m, found.rotation_error_rad),
        Err(near) => (false, near.nearest, near.position_error_m, near.rotation_error_rad),
    };
    Ok(json!({
        "id": line.id,
        "ok": ok,
        "q": q,
        "position_error_m": position_error_m,
        "rotation_error_rad": rotation_error_rad,
        "micros": micros,
    }))
}

fn pose(line: &Line) -> Result<Isometry3<f64>, String> {
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
