//! Duration of motions against the shortest known, and the cost of planning them.

use super::{fixture, mean, numbers, rows, seven, timed};
use crate::report::Report;
use manipulation::{Joints, Limb, MotionLimits, Path, PositionLimits, Robot, State, Trajectory};

/// Grid intervals: as the services time a path, and finer.
const INTERVALS: [usize; 2] = [manipulation::INTERVALS_MIN, 4000];

pub(super) fn measure(report: &mut Report) {
    let mut rows = splines();
    rows.push(moves());
    let note = "Spline paths of 3 to 7 waypoints with limited acceleration beside toppra 0.6 (1,000 \
                intervals), and moves between states with limited jerk beside ruckig 0.19: duration \
                over the reference's, and what planning takes.";
    let heads = ["motion", "motions", "mean ratio", "worst ratio", "mean µs"];
    report.table("Durations of motions", note, heads, rows);
}

fn row(what: String, ratios: &[f64], micros: &[f64]) -> Vec<String> {
    let worst = ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    vec![
        what,
        ratios.len().to_string(),
        format!("{:.6}", mean(ratios)),
        format!("{worst:.6}"),
        format!("{:.0}", mean(micros)),
    ]
}

fn splines() -> Vec<Vec<String>> {
    let full = Robot::baxter().arm(Limb::Left).limits;
    let limits = MotionLimits { jerk: [f64::INFINITY; 7], ..full };
    let reference: serde_json::Value =
        serde_json::from_str(&fixture("topp_reference.json")).unwrap_or_default();
    let paths: Vec<(Vec<Joints>, f64)> = reference["paths"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|path| {
            let waypoints = serde_json::from_value(path["waypoints"].clone()).ok()?;
            Some((waypoints, path["duration_grid_1000"].as_f64()?))
        })
        .collect();
    INTERVALS
        .map(|intervals| {
            let (ratios, micros): (Vec<f64>, Vec<f64>) = paths
                .iter()
                .map(|(waypoints, shortest)| {
                    let plan = || Trajectory::along(Path::spline(waypoints), &limits, intervals);
                    let (trajectory, micros) = timed(plan);
                    (trajectory.duration_s() / shortest, micros)
                })
                .unzip();
            row(format!("spline, {intervals} intervals"), &ratios, &micros)
        })
        .to_vec()
}

/// Moves from any state to rest, position limits aside as in the reference.
fn moves() -> Vec<String> {
    let full = Robot::baxter().arm(Limb::Left).limits;
    let limits = MotionLimits { position: PositionLimits([(-9.0, 9.0); 7]), ..full };
    let (ratios, micros): (Vec<f64>, Vec<f64>) = rows("jerk_limited_reference.csv")
        .iter()
        .filter_map(|row| {
            let n = numbers(row);
            let from = State { q: seven(&n[..7]), qd: seven(&n[7..14]), qdd: seven(&n[14..21]) };
            let to = State::at_rest(&seven(&n[21..28]));
            let (trajectory, micros) = timed(|| Trajectory::between(&from, &to, &limits));
            Some((trajectory.ok()?.duration_s() / n[28], micros))
        })
        .unzip();
    row("state to state, jerk 20 rad/s³".to_owned(), &ratios, &micros)
}
