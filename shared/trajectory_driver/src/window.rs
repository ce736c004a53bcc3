//! Windows of a motion: its next part, and a ramp to rest on the same path.

use manipulation::{State, Trajectory};

use crate::WindowPoint;

/// Interval at which a window is replaced by the next one, seconds.
pub const EVERY_S: f64 = 0.1;
/// Time from a window's begin to its first point, seconds: more than a message takes, so that the controller
/// interpolates to where the motion will be and does not run after where it was.
pub const LEAD_S: f64 = 0.05;
/// Part of the motion in a window, seconds, if its ramp is short.
pub const PATH_S: f64 = 0.4;
/// The same in the first window of a motion, which is replaced once the controller has accepted it: if it comes late,
/// there is little to catch up.
pub const FIRST_PATH_S: f64 = 0.2;
/// The least of a later one: two windows may be lost.
const PATH_MIN_S: f64 = 0.25;
/// Time from a window's begin to rest at most, seconds, where the ramp allows: so long the arm moves on when nobody
/// sends the next window.
const REST_S: f64 = 0.55;
/// Interval between two points, seconds. Controllers interpolate cubically between positions and velocities.
const STEP_S: f64 = 0.05;
/// Least interval before the last point, seconds.
const STEP_MIN_S: f64 = 0.01;
/// Most points of a window: more than two seconds.
pub const POINTS_MAX: usize = 64;

/// A window, and the part of the motion that it has.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its points.
    pub points: Vec<WindowPoint>,
    /// Length of the motion before the ramp, seconds.
    pub path_s: f64,
    /// Whether the motion ends within it, at rest.
    pub is_last: bool,
}

/// Returns the window that begins `from_s` seconds into the motion of an arm with so many joints, with `path_s` of the
/// motion at most.
pub fn part(motion: &Trajectory, (from_s, path_s): (f64, f64), joints: usize) -> Part {
    let end_s = motion.duration_s();
    let from_s = from_s.min(end_s);
    let ends_at_rest = is_still(&motion.state(end_s));
    let mut path_s = path_s;
    loop {
        if ends_at_rest && from_s + path_s >= end_s {
            let path_s = end_s - from_s;
            let points = points(joints, path_s, |t_s| motion.state(from_s + t_s));
            return Part { points, path_s, is_last: true };
        }
        // A motion that flows into the next one is stopped on the curve of the whole.
        let to_s = (from_s + path_s).min(end_s - 1e-6).max(0.0);
        let ramp = motion.halted_at(to_s);
        let (own_s, ramp_s) = ((to_s - from_s).max(0.0), ramp.duration_s());
        if LEAD_S + own_s + ramp_s > REST_S && path_s > PATH_MIN_S {
            path_s -= STEP_S;
            continue;
        }
        let state = |t_s: f64| match t_s <= own_s {
            true => motion.state(from_s + t_s),
            false => ramp.state(t_s - own_s),
        };
        return Part {
            points: points(joints, own_s + ramp_s, state),
            path_s: own_s,
            is_last: false,
        };
    }
}

/// Returns whether the joints of a state stand.
pub fn is_still(state: &State) -> bool {
    state.qd.iter().all(|v| v.abs() < 1e-4)
}

/// The states from 0 to `end_s`, the last one at rest.
fn points(joints: usize, end_s: f64, state: impl Fn(f64) -> State) -> Vec<WindowPoint> {
    let whole = (end_s / STEP_S).floor().max(0.0) as usize;
    let times = (0..=whole).map(|n| n as f64 * STEP_S).filter(|t_s| *t_s < end_s - STEP_MIN_S);
    let point = |t_s: f64| {
        let State { q, qd, .. } = state(t_s);
        let [q, qd] = [q, qd].map(|all| all[..joints].to_vec());
        WindowPoint { t_s: LEAD_S + t_s, q, qd }
    };
    let mut points: Vec<_> = times.take(POINTS_MAX - 1).map(point).collect();
    let last = point(end_s);
    points.push(WindowPoint { qd: vec![0.0; joints], ..last });
    points
}
