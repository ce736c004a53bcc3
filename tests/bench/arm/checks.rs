//! Cost of rejecting poses, of forward kinematics, and of collision checks.

use super::targets::postures;
use super::{arm, numbers, rows, seven, thread_s, timed};
use crate::report::Report;
use manipulation::{Clearance, Cuboid, Joints, Limb, Robot};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// Times that each pose is asked for; the fastest counts.
const REPEATS: usize = 5;
/// Postures of one sample, and samples.
const POSTURES: usize = 1000;
const SAMPLES: usize = 200;
/// The table of the reference.
const TABLE: Cuboid = Cuboid::aligned([0.9, 0.0, -0.2], [0.6, 1.4, 0.04]);

pub(super) fn measure(report: &mut Report, python: &super::python::Measured) {
    refusal(report);
    forward(report, python);
    clearance(report);
}

/// Poses that no posture reaches, and whether none is called so that can be reached.
fn refusal(report: &mut Report) {
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

/// Forward kinematics and Jacobian.
fn forward(report: &mut Report, python: &super::python::Measured) {
    let postures = postures(Limb::Left, POSTURES);
    let chain = &arm(Limb::Left).chain;
    let pose_of = |q: &Joints| chain.tool_frame(q).origin.x;
    let jacobian = |q: &Joints| std::hint::black_box(chain.tool_and_jacobian(q)).0.origin.x;
    let (pose, both) = ("forward kinematics", "forward kinematics and Jacobian");
    #[cfg(feature = "peers")]
    {
        let peer = super::k_crate::chain(Limb::Left);
        let theirs = nanos(&postures, |q| super::k_crate::forward(&peer, q));
        report.add(&format!("k 0.32: {pose}"), "ns", &theirs, "left arm");
        let theirs = nanos(&postures, |q| super::k_crate::jacobian(&peer, q));
        report.add(&format!("k 0.32: {both}"), "ns", &theirs, "left arm");
    }
    let mut peer = "k 0.32";
    for theirs in &python.forward {
        peer = "Pinocchio 4.1";
        let place = |q: &Joints| chain.tool_frame(q).origin;
        let apart = postures.iter().zip(&theirs.places).map(|(q, theirs)| {
            let [x, y, z] = *theirs;
            (place(q) - nalgebra::vector![x, y, z]).norm()
        });
        let note = format!(
            "all frames of the left arm, less the same call from Python for no joints; \
             grippers within {:.0e} m of ours",
            apart.fold(0.0, f64::max)
        );
        report.add(&format!("{peer}: {pose}"), "ns", &theirs.pose_ns, &note);
        report.add(&format!("{peer}: {both}"), "ns", &theirs.jacobian_ns, "gripper, left arm");
    }
    let (ours, beside) = (nanos(&postures, pose_of), format!("{peer}: {pose}"));
    report.add_beside(pose, "ns", &ours, &beside, "base to gripper, left arm");
    let (ours, beside) = (nanos(&postures, jacobian), format!("{peer}: {both}"));
    report.add_beside(both, "ns", &ours, &beside, "left arm");
}

/// Nanoseconds of one call, a sample for each pass over the postures.
fn nanos(postures: &[Joints], mut call: impl FnMut(&Joints) -> f64) -> Vec<f64> {
    (0..SAMPLES)
        .map(|_| {
            let started = thread_s();
            for q in postures {
                std::hint::black_box(call(std::hint::black_box(q)));
            }
            (thread_s() - started) * 1e9 / postures.len() as f64
        })
        .collect()
}

/// The check of both arms against themselves, each other, the trunk and a table.
fn clearance(report: &mut Report) {
    let robot = Robot::baxter();
    let (mut worst, mut verdicts, mut count) = (0.0_f64, 0, 0);
    for row in rows("clearance_reference.csv") {
        let n = numbers(&row[..23]);
        let found = Clearance::of(robot, &[seven(&n[..7]), seven(&n[7..14])], &[TABLE]);
        let groups = [found.arms, found.body[0], found.body[1], found.own[0]];
        for (group, expected) in groups.iter().zip(&n[14..18]) {
            worst = worst.max((group.distance_m - expected).abs());
        }
        verdicts += usize::from((found.robot().distance_m < 0.0) == (n[21] == 1.0));
        count += 1;
    }
    let [left, right] = [Limb::Left, Limb::Right].map(|limb| postures(limb, 2000));
    let micros: Vec<f64> = left
        .iter()
        .zip(right.iter().rev())
        .map(|(left, right)| timed(|| Clearance::of(robot, &[*left, *right], &[TABLE])).1)
        .collect();
    let note = format!(
        "all distances of both arms, 603 pairs; {verdicts} of {count} reference verdicts, \
         distances to {worst:.0e} m"
    );
    report.add("clearance of both arms", "µs", &micros, &note);
}
