//! Poses of which some are out of reach: what is rejected, at what cost, and whether rightly.

use super::inverse::{Outcome, Own, Seed, Verdict, run};
use super::python::{Kind, Measured};
use super::subject::{BAXTER, Subject};
use super::targets::{Rule, Target};
use super::{mean, numbers, rows, timed};
use crate::report::{Report, percentile};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// Times that each pose of the reference is asked for; the fastest counts.
const REPEATS: usize = 5;

/// Poses anywhere, beside the peers: what one of them reaches must not be rejected.
pub(super) fn measure(
    report: &mut Report,
    subject: &Subject,
    targets: &[Target],
    python: &Measured,
) {
    let own = run(&mut Own { subject, nearest: false }, subject, targets, Seed::Middle, Rule::OWN);
    let peers = python.outcomes(subject, targets, Kind::Anywhere, false, Seed::Middle);
    let all: Vec<&Outcome> = std::iter::once(&own).chain(&peers).collect();
    let row = |outcome: &&Outcome| {
        let others = || all.iter().filter(|other| other.name != outcome.name);
        let reached = |i: usize| others().any(|other| other.verdicts[i] == Verdict::Reached);
        let rejected = || (0..targets.len()).filter(|i| outcome.verdicts[*i] == Verdict::Rejected);
        let micros: Vec<f64> = rejected().map(|i| outcome.micros[i]).collect();
        let time = |value: f64| format!("{value:.1}");
        vec![
            outcome.name.clone(),
            outcome.count(Verdict::Reached).to_string(),
            outcome.count(Verdict::Wrong).to_string(),
            micros.len().to_string(),
            rejected().filter(|i| reached(*i)).count().to_string(),
            time(mean(&micros)),
            time(percentile(&micros, 0.5)),
            time(percentile(&micros, 0.99)),
        ]
    };
    let heads = [
        "solver",
        "reached",
        "wrong answers",
        "rejected",
        "of which another reached",
        "mean µs of a rejection",
        "median",
        "p99",
    ];
    let note = format!(
        "{} poses, uniform in the box round the reachable ones and turned anyhow. Peers cannot tell that \
         a pose is out of reach: they look until their time is up.",
        targets.len()
    );
    let rows = all.iter().map(row).collect();
    report.table(format!("Poses out of reach: {}", subject.name), note, heads, rows);
}

/// Baxter's reference, in which a long search decided what can be reached.
pub(super) fn reference(report: &mut Report) {
    let (mut refused, mut solvable, mut found) = (Vec::new(), 0, 0);
    for &limb in BAXTER.limbs() {
        let chain = &BAXTER.arm(limb).chain;
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
