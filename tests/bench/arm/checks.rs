//! Cost of forward kinematics and of collision checks.

use super::python::Measured;
use super::subject::{BAXTER, Subject};
use super::{POSTURES, numbers, rows, seven, thread_s, timed};
use crate::report::Report;
use manipulation::{Clearance, Cuboid, Joints, Limb, Robot};

/// The solver beside whose forward kinematics ours stand.
const PEER: &str = "Pinocchio 4.1";
/// Samples of forward kinematics.
const SAMPLES: usize = 200;
/// The table of the reference.
const TABLE: Cuboid = Cuboid::aligned([0.9, 0.0, -0.2], [0.6, 1.4, 0.04]);

/// Forward kinematics and Jacobian of the first limb.
pub(super) fn forward(report: &mut Report, subject: &Subject, python: &Measured) {
    let limb = subject.limbs()[0];
    let postures = subject.postures(limb, POSTURES);
    let chain = &subject.arm(limb).chain;
    let pose_of = |q: &Joints| chain.tool_frame(q).origin.x;
    let jacobian = |q: &Joints| std::hint::black_box(chain.tool_and_jacobian(q)).0.origin.x;
    let pose = format!("forward kinematics of {}", subject.name);
    let both = format!("forward kinematics and Jacobian of {}", subject.name);
    let note = format!("base to gripper, {} joints", chain.joints());
    for theirs in &python.forward {
        let apart = postures.iter().zip(&theirs.places).map(|(q, theirs)| {
            (chain.tool_frame(q).origin - nalgebra::Vector3::from(*theirs)).norm()
        });
        let less = format!(
            "{note}, less the same calls from Python for no joints; grippers within {:.0e} m of ours",
            apart.fold(0.0, f64::max)
        );
        report.add(&format!("{PEER}: {pose}"), "ns", &theirs.pose_ns, &less);
        report.add(&format!("{PEER}: {both}"), "ns", &theirs.jacobian_ns, &less);
    }
    let (ours, beside) = (nanos(&postures, pose_of), format!("{PEER}: {pose}"));
    report.add_beside(&pose, "ns", &ours, &beside, &note);
    let (ours, beside) = (nanos(&postures, jacobian), format!("{PEER}: {both}"));
    report.add_beside(&both, "ns", &ours, &beside, &note);
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
pub(super) fn clearance(report: &mut Report) {
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
    let [left, right] = Limb::BOTH.map(|limb| BAXTER.postures(limb, 2000));
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
