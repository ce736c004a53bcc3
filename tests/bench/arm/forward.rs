//! Forward kinematics and Jacobian.

use super::targets::postures;
use super::{arm, thread_s};
use crate::report::Report;
use manipulation::{Joints, Limb};

/// Postures of one sample, and samples.
const POSTURES: usize = 1000;
const SAMPLES: usize = 200;

pub(super) fn measure(report: &mut Report) {
    let postures = postures(Limb::Left, POSTURES);
    let chain = &arm(Limb::Left).chain;
    let forward = |q: &Joints| chain.tool_frame(q).origin.x;
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
    report.add_beside(
        pose,
        "ns",
        &nanos(&postures, forward),
        &format!("k 0.32: {pose}"),
        "base to gripper, left arm",
    );
    let peer = format!("k 0.32: {both}");
    report.add_beside(both, "ns", &nanos(&postures, jacobian), &peer, "left arm");
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
