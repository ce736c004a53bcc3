//! Solvers that cannot be measured here.

use crate::report::{Report, Table};

/// Solver, budget in ms, solved in %, mean, median and p99 in µs.
const MEASURED: [(&str, &str, f64, &str); 6] = [
    ("KDL with limits, random restarts", "5", 92.5, "835 / 218 / 5010"),
    ("KDL Levenberg-Marquardt, restarts, limit test", "5", 99.39, "257 / 85 / 3503"),
    ("TRAC-IK Speed, two threads (C++)", "5", 99.61, "534 / 292 / 3380"),
    ("OptIK 0.5, one thread (Rust)", "5", 99.95, "213 / 131 / 1118"),
    ("IKFast with w1 in steps of 0.1", "5", 99.04, "419 / 313 / 1431"),
    ("TRAC-IK's own README, v1.4.6", "5", 99.62, "430 / – / –"),
];

pub(super) fn add(report: &mut Report) {
    let rows = MEASURED
        .iter()
        .map(|(solver, budget, solved, micros)| {
            vec![
                (*solver).to_owned(),
                (*budget).to_owned(),
                format!("{solved:.2} %"),
                (*micros).to_owned(),
            ]
        })
        .collect();
    report.tables.push(Table {
        title: "Inverse kinematics measured elsewhere".to_owned(),
        note: "Not of this run: Baxter's left arm, 10,000 such targets at 1e-5 from the middle of \
               the limits, called from their own languages on a like machine; the last row is \
               published."
            .to_owned(),
        heads: ["solver", "budget, ms", "solved", "mean / median / p99, µs"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
}
