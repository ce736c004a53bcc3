//! Chart of a planned pick: joints over time, and the path of the gripper.

use manipulation::{ObjectPose, Phase};
use nalgebra::Vector3;
use user_study::charts::{Axis, Chart, Panel, Point, Shape};

use super::Pick;

/// Phases with their names.
pub(super) const PHASES: [(Phase, &str); 7] = [
    (Phase::Approach, "approach"),
    (Phase::Close, "close"),
    (Phase::Lift, "lift"),
    (Phase::HandOver, "hand over"),
    (Phase::Release, "release"),
    (Phase::Raise, "withdraw"),
    (Phase::Return, "return"),
];

/// Moments that curves are drawn through.
const MOMENTS: usize = 240;
/// Series of everything grey.
const GREY: usize = 6;
/// Width of margins and legend, pixels.
const AROUND_PANELS: u32 = 205;

/// Returns the chart, about that many pixels wide.
pub(super) fn chart(pick: &Pick<'_>, width: u32) -> Chart {
    let name = &pick.scene.object(pick.object.into()).name;
    let (arm, seconds) = (pick.robot.arm(pick.plan.limb()), pick.plan.duration_s());
    let (limb, limits) = (&arm.name, arm.limits);
    let ratio = pick.settings.speed_ratio;
    let share = |t_s: f64, joint: usize| {
        100.0 * pick.plan.at(t_s).qd[joint].abs() / (ratio * limits.velocity[joint])
    };
    let degrees = |t_s: f64, joint: usize| pick.plan.at(t_s).q[joint].to_degrees();
    let panels = vec![
        over_time(pick, "joint position, degrees", degrees),
        path(pick, "gripper's path, from the side", "z, m", 2),
        over_time(pick, "joint speed, % of the limit", share),
        path(pick, "gripper's path, from above", "y, m", 1),
    ];
    let names = arm.joint_names.iter();
    let prefix = format!("{limb}_");
    let legend = names.map(|name| name.strip_prefix(&prefix).unwrap_or(name).to_owned());
    let panel = width.saturating_sub(AROUND_PANELS) / 2;
    Chart {
        title: format!("{limb} limb fetches {name}: {seconds:.2} s"),
        note: String::new(),
        panels,
        columns: 2,
        panel_size: (panel, panel * 3 / 4),
        legend: legend.chain(["gripper".to_owned()]).collect(),
    }
}

/// Returns the number of the series of the gripper's path: it follows those of the joints.
fn gripper_series(pick: &Pick<'_>) -> usize {
    pick.robot.arm(pick.plan.limb()).chain.joints()
}

fn times(pick: &Pick<'_>) -> impl Iterator<Item = f64> {
    let whole_s = pick.plan.duration_s();
    (0..=MOMENTS).map(move |n| whole_s * n as f64 / MOMENTS as f64)
}

/// A curve for each joint, on a background of the phases.
fn over_time(pick: &Pick<'_>, heading: &str, value: impl Fn(f64, usize) -> f64) -> Panel {
    let curve = |joint| times(pick).map(|t_s| (t_s, value(t_s, joint))).collect::<Vec<Point>>();
    let curves: Vec<Vec<Point>> = (0..gripper_series(pick)).map(curve).collect();
    let y = holding("", curves.iter().flatten().map(|point| point.1).chain([0.0]));
    let (low, high) = y.ends();
    let mut shapes = Vec::new();
    for (n, (phase, name)) in PHASES.into_iter().enumerate() {
        let Some((begin_s, end_s)) = pick.plan.span_s(phase) else { continue };
        if n % 2 == 0 {
            shapes.push((GREY, Shape::Band(begin_s, end_s)));
        }
        let level = high - (high - low) * (0.05 + 0.07 * n as f64);
        shapes.push((GREY, Shape::Text((end_s, level), name.to_owned())));
    }
    shapes.extend(curves.into_iter().map(Shape::Line).enumerate());
    let x = Axis::up_to("seconds", pick.plan.duration_s());
    Panel { heading: heading.to_owned(), x, y, shapes }
}

/// The gripper's path and the objects' outlines, along x and another axis of frame `base`. Marks
/// are at the ends of phases.
fn path(pick: &Pick<'_>, heading: &str, label: &str, axis: usize) -> Panel {
    let flat = |at: Vector3<f64>| (at.x, at[axis]);
    let at = |t_s: f64| flat(gripper(pick, t_s));
    let path: Vec<Point> = times(pick).map(at).collect();
    let ends = PHASES.iter().filter_map(|(phase, _)| pick.plan.span_s(*phase));
    let marks = ends.map(|(_, end_s)| at(end_s)).collect();
    let outlines: Vec<Vec<Point>> =
        pick.places.iter().map(|place| corners(place).map(flat).collect()).collect();
    let points = || path.iter().chain(outlines.iter().flatten());
    let (x, y) = (holding("x, m", points().map(|p| p.0)), holding(label, points().map(|p| p.1)));
    let mut shapes = Vec::new();
    for (index, corners) in outlines.iter().enumerate() {
        let series = if index == pick.object { 1 } else { GREY };
        let fold = |of: fn(f64, f64) -> f64| {
            corners.iter().copied().reduce(|a, b| (of(a.0, b.0), of(a.1, b.1))).unwrap_or_default()
        };
        let (low, high) = (fold(f64::min), fold(f64::max));
        let outline = vec![low, (high.0, low.1), high, (low.0, high.1), low];
        shapes.push((series, Shape::Line(outline)));
        let name = pick.scene.object(index.into()).name.clone();
        shapes.push((series, Shape::Text((high.0, 0.5 * (low.1 + high.1)), name)));
    }
    shapes.push((gripper_series(pick), Shape::Line(path)));
    shapes.push((gripper_series(pick), Shape::Marks(marks)));
    Panel { heading: heading.to_owned(), x, y, shapes }
}

/// Returns the position of the point between the finger tips in frame `base`, metres.
fn gripper(pick: &Pick<'_>, t_s: f64) -> Vector3<f64> {
    let arm = pick.robot.arm(pick.plan.limb());
    arm.chain.forward(&pick.plan.at(t_s).q).translation.vector
}

/// Returns the corners of an object in frame `base`, metres.
fn corners(place: &ObjectPose) -> impl Iterator<Item = Vector3<f64>> {
    let (pose, half) = (place.isometry(), Vector3::from(place.size_m) * 0.5);
    let side = move |n: usize, bit: usize| if n >> bit & 1 == 0 { -half[bit] } else { half[bit] };
    (0..8).map(move |n| {
        let corner = Vector3::new(side(n, 0), side(n, 1), side(n, 2));
        (pose * nalgebra::Point3::from(corner)).coords
    })
}

fn holding(label: &str, values: impl Iterator<Item = f64> + Clone) -> Axis {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
    Axis::between(label, least, largest)
}
