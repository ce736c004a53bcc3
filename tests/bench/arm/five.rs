//! An arm of five joints, whose closed form no other solver here has.

use super::subject::{SO101, Subject};
use super::{Effort, mean, timed};
use crate::report::{Report, percentile};
use manipulation::Limb;

/// Targets of postures within the limits: a pose without a seed, and by position, elevation and roll.
pub(super) fn measure(report: &mut Report, effort: Effort) {
    let subject: &Subject = &SO101;
    let chain = &subject.arm(Limb::Only).chain;
    let (mut poses, mut approaches, mut missed) = (Vec::new(), Vec::new(), 0);
    for q in subject.postures(Limb::Only, effort.own) {
        let pose = chain.forward(&q);
        let (found, micros) = timed(|| chain.inverse(&pose, None));
        poses.push(micros);
        let elevation = (pose.rotation * nalgebra::Vector3::z()).z.clamp(-1.0, 1.0).asin();
        let (all, micros) = timed(|| chain.reach(pose.translation.vector.into(), elevation, q[4]));
        approaches.push(micros);
        missed += usize::from(found.is_err() || all.is_empty());
    }
    let row = |what: &str, micros: &[f64]| {
        let number = |value: f64| format!("{value:.2}");
        let share = |share: f64| number(percentile(micros, share));
        vec![what.to_owned(), missed.to_string(), number(mean(micros)), share(0.5), share(0.99)]
    };
    let rows = vec![
        row("pose: all branches, one answer", &poses),
        row("position, elevation and roll: every answer", &approaches),
    ];
    let note =
        format!("{} targets of random postures within the limits; closed form.", poses.len());
    let heads = ["target", "missed", "mean µs", "median", "p99"];
    report.table(format!("Five joints: {}", subject.name), note, heads, rows);
}
