//! The check of both arms against themselves, each other, the trunk and a table.

use super::targets::postures;
use super::{numbers, rows, seven, timed};
use crate::report::Report;
use manipulation::{Clearance, Cuboid, Limb, Robot};

/// The table of the reference.
const TABLE: Cuboid = Cuboid::aligned([0.9, 0.0, -0.2], [0.6, 1.4, 0.04]);

pub(super) fn measure(report: &mut Report) {
    let robot = Robot::baxter();
    let (mut worst, mut verdicts, mut count) = (0.0_f64, 0, 0);
    for row in rows("clearance_reference.csv") {
        let n = numbers(&row[..23]);
        let found = Clearance::of(robot, &seven(&n[..7]), &seven(&n[7..14]), &[TABLE]);
        let groups = [found.left_right, found.left_body, found.right_body, found.left_self];
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
        .map(|(left, right)| timed(|| Clearance::of(robot, left, right, &[TABLE])).1)
        .collect();
    let note = format!(
        "all distances of both arms, 603 pairs; {verdicts} of {count} reference verdicts, \
         distances to {worst:.0e} m"
    );
    report.add("clearance of both arms", "µs", &micros, &note);
}
