//! Poses that no posture reaches, and whether none is called so that can be reached.

use super::{arm, numbers, rows, timed};
use crate::report::Report;
use manipulation::Limb;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// Times that each pose is asked for; the fastest counts.
const REPEATS: usize = 5;

pub(super) fn measure(report: &mut Report) {
    let (mut refused, mut solvable, mut found) = (Vec::new(), 0, 0);
    for limb in Limb::BOTH {
        let chain = &arm(limb).chain;
        for row in rows(&format!("ik_targets_{limb}.csv")) {
            let n = numbers(&row[1..]);
            let rotation = UnitQuaternion::new_normalize(Quaternion::new(n[6], n[3], n[4], n[5]));
            let pose = Isometry3::from_parts(Translation3::new(n[0], n[1], n[2]), rotation);
            let answers: Vec<(bool, f64)> =
                (0..REPEATS).map(|_| timed(|| chain.inverse(&pose, None).is_ok())).collect();
            let fastest = answers.iter().map(|(_, micros)| *micros).fold(f64::INFINITY, f64::min);
            let ok = answers.iter().all(|(ok, _)| *ok);
            if n[7] == 1.0 {
                solvable += 1;
                found += usize::from(ok);
            }
            if !ok {
                refused.push(fastest);
            }
        }
    }
    let note = format!(
        "uniform poses and poses over a table; of {solvable} that a long search reached, {found} \
         are reached"
    );
    report.add("refusal of a pose out of reach", "µs", &refused, &note);
}
