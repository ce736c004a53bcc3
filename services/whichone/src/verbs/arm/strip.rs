//! The pick in time: how fast the joints move and how high the gripper is.

use evaluation::charts::{Align, BLACK, Canvas, FAINT, GREY, Ink, Linear, Size};

use super::pick::{PHASES, Pick, ink};

/// A box on the canvas: left, top, width, height.
pub(super) type Frame = (f64, f64, f64, f64);

/// Moments that curves are drawn through.
const MOMENTS: usize = 240;

/// Draws both curves side by side under a bar of the phases.
pub(super) fn draw(canvas: &mut Canvas, pick: &Pick<'_>, (left, top, width, height): Frame) {
    let (bar, gap, margin) = (24.0, 26.0, 44.0);
    let half = 0.5 * (width - gap);
    let limits = pick.robot.arm(pick.plan.limb()).limits;
    let ratio = pick.settings.speed_ratio;
    let frame = |n: usize| {
        let x = left + n as f64 * (half + gap) + margin;
        (x, top + bar, half - margin, height - bar - 34.0)
    };
    let share = |t_s: f64, joint: usize| {
        100.0 * pick.plan.at(t_s).qd[joint].abs() / (ratio * limits.velocity[joint])
    };
    let speeds: Vec<(Ink, Vec<(f64, f64)>)> = (0..7)
        .map(|joint| {
            (evaluation::charts::colour(joint), times(pick).map(|t| (t, share(t, joint))).collect())
        })
        .collect();
    curves(canvas, pick, frame(0), "joint speed, % of what is allowed", &speeds, 100.0);
    joint_names(canvas, pick, frame(0));
    let boards = pick.places.iter().map(|place| place.bottom_z_m());
    let lowest_m = boards.fold(pick.settings.table_z_m, f64::min);
    let height_at = |t: f64| pick.tip(&pick.links(t)).translation.z - lowest_m;
    let heights: Vec<(f64, f64)> = times(pick).map(|t| (t, 100.0 * height_at(t))).collect();
    let most = heights.iter().map(|(_, z)| *z).fold(10.0, f64::max);
    curves(canvas, pick, frame(1), "gripper above the lowest board, cm", &[(BLACK, heights)], most);
}

fn times(pick: &Pick<'_>) -> impl Iterator<Item = f64> {
    let whole_s = pick.plan.duration_s();
    (0..=MOMENTS).map(move |n| whole_s * n as f64 / MOMENTS as f64)
}

/// Curves over time on the phases' ground.
fn curves(
    canvas: &mut Canvas,
    pick: &Pick<'_>,
    (left, top, width, height): Frame,
    title: &str,
    lines: &[(Ink, Vec<(f64, f64)>)],
    most: f64,
) {
    let whole_s = pick.plan.duration_s();
    let axis = Linear::up_to(most);
    let x = |t_s: f64| left + width * t_s / whole_s;
    let y = |value: f64| top + height * (1.0 - axis.place(value));
    for (phase, ..) in PHASES {
        let Some((begin_s, end_s)) = pick.plan.timeline.span_s(phase) else { continue };
        let pale = ink(phase).map(|part| 255 - (255 - part) / 6);
        canvas.area((x(begin_s), top), (x(end_s) - x(begin_s), height), pale);
        canvas.area((x(begin_s), top - 5.0), (x(end_s) - x(begin_s), 5.0), ink(phase));
    }
    for mark in axis.marks() {
        canvas.line((left, y(mark)), (left + width, y(mark)), 0.6, FAINT);
        canvas.words((left - 5.0, y(mark)), &format!("{mark}"), Align::Right, Size::Small, GREY);
    }
    for (ink, points) in lines {
        for pair in points.windows(2) {
            let [from, to] =
                [pair[0], pair[1]].map(|(t, value)| (x(t), y(value.min(axis_end(most)))));
            canvas.line(from, to, 1.3, *ink);
        }
    }
    for second in (0..=whole_s as usize).step_by(if whole_s > 9.0 { 2 } else { 1 }) {
        let at = x(second as f64);
        canvas.line((at, top + height), (at, top + height + 4.0), 1.0, GREY);
        let text = format!("{second} s");
        canvas.words((at, top + height + 12.0), &text, Align::Middle, Size::Small, GREY);
    }
    canvas.line((left, top + height), (left + width, top + height), 1.0, GREY);
    canvas.words((left, top - 15.0), title, Align::Left, Size::Small, BLACK);
}

/// Numbers above the axis's greatest are drawn at its edge.
fn axis_end(most: f64) -> f64 {
    1.02 * most
}

/// The joints' names in the colours of their curves.
fn joint_names(canvas: &mut Canvas, pick: &Pick<'_>, (left, top, width, height): Frame) {
    let names = &pick.robot.arm(pick.plan.limb()).joint_names;
    let prefix = format!("{}_", pick.plan.limb());
    for (joint, name) in names.iter().enumerate() {
        let short = name.strip_prefix(&prefix).unwrap_or(name);
        let at = (left + width * (joint as f64 + 0.5) / 7.0, top + height + 27.0);
        canvas.words(at, short, Align::Middle, Size::Small, evaluation::charts::colour(joint));
    }
}
