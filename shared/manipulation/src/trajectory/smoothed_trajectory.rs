//! Joint positions as a function of time: a timed path, its corners in time rounded off.
//!
//! The fastest timing of a path jumps from one acceleration to another. Its moving average over `T`
//! seconds, `q̄(t) = 1/T ∫ q(u) du` for `u` from `t − T` to `t`, does not: its jerk is the change of
//! acceleration over the window divided by `T`. An average lies in the convex hull of what it
//! averages, so positions, velocities and accelerations keep the limits that the timed path keeps.
//! It lasts `T` longer, ends where the path ends, and passes each of its points at most about
//! `a T²/24` away, half a window late.

use crate::kinematics::limb::Joints;
use crate::kinematics::limits::MotionLimits;
use crate::trajectory::path::Path;
use crate::trajectory::timing::{Knot, motion_at};

/// A motion of one limb in time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SmoothedTrajectory {
    path: Path,
    knots: Vec<Knot>,
    /// Integral of `q` minus the start, from time 0 to each knot, rad s.
    sums: Vec<Joints>,
    start: Joints,
    end: Joints,
    /// Seconds over which positions are averaged; 0 for a path that is smooth in time already.
    window_s: f64,
    limits: MotionLimits,
}

/// Nodes and weights of Gauss and Legendre's rule on [0, 1], exact to the seventh degree: a cubic
/// in `s` with `s` quadratic in time has the sixth.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Windows that are tried, as shares of the one that suits every path.
const SHARES: [f64; 5] = [0.5, 0.625, 0.75, 0.875, 1.0];

/// Used share of a jerk limit: accelerations between two knots are not checked.
const JERK_USED: f64 = 0.998;

/// The same when it is compared with: a little more, for rounding.
const JERK_KEPT: f64 = JERK_USED + 1e-6;

impl SmoothedTrajectory {
    /// Returns a path that `knots` time within the velocity and acceleration limits, averaged over
    /// the shortest window that keeps the jerk limits as well.
    pub(crate) fn smoothed(path: Path, knots: Vec<Knot>, limits: &MotionLimits) -> Self {
        let mut smoothed = Self::exact(path, knots, limits);
        let longest = (0..7)
            .map(|j| 2.0 * limits.acceleration[j] / (JERK_USED * limits.jerk[j]))
            .fold(0.0, f64::max);
        if longest > 0.0 && smoothed.path.length() > 0.0 {
            let shortest = SHARES.map(|share| share * longest).into_iter();
            let enough = shortest.clone().find(|window_s| smoothed.jerk_kept(*window_s));
            smoothed.window_s = enough.unwrap_or(longest);
        }
        smoothed
    }

    /// Returns a timed path as it is.
    pub(crate) fn exact(path: Path, knots: Vec<Knot>, limits: &MotionLimits) -> Self {
        let (start, end) = (path.position(0, 0.0), path.end());
        let mut smoothed =
            Self { path, knots, sums: Vec::new(), start, end, window_s: 0.0, limits: *limits };
        let mut sum = [0.0; 7];
        for i in 0..smoothed.knots.len() {
            smoothed.sums.push(sum);
            if let Some(next) = smoothed.knots.get(i + 1) {
                smoothed.add_integral(&mut sum, i, next.time - smoothed.knots[i].time);
            }
        }
        smoothed
    }

    pub(crate) fn limits(&self) -> &MotionLimits {
        &self.limits
    }

    /// Seconds from start to end.
    pub(crate) fn duration_s(&self) -> f64 {
        self.timed_s() + self.window_s
    }

    /// `q`, `q̇` and `q̈` at `t_s`, which is not negative; after the end, those of the end.
    pub(crate) fn at(&self, t_s: f64) -> [Joints; 3] {
        let [q, qd, qdd] = if self.window_s > 0.0 { self.averaged(t_s) } else { self.timed(t_s) };
        // Rounding may carry a joint that rests on its limit past it by a last bit.
        [self.limits.position.clamp(&q), qd, qdd]
    }

    /// Returns the times at which the path's grid points are passed.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        self.knots.iter().map(|knot| knot.time + 0.5 * self.window_s)
    }

    /// Duration of the path without averaging.
    fn timed_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.time)
    }

    fn averaged(&self, t_s: f64) -> [Joints; 3] {
        if t_s <= 0.0 {
            return [self.start, [0.0; 7], [0.0; 7]];
        }
        if t_s >= self.duration_s() {
            return [self.end, [0.0; 7], [0.0; 7]];
        }
        let window_s = self.window_s;
        let (now, before) = (self.timed(t_s), self.timed(t_s - window_s));
        let (sum_now, sum_before) = (self.integral(t_s), self.integral(t_s - window_s));
        let mean = |now: &Joints, before: &Joints, j: usize| (now[j] - before[j]) / window_s;
        [
            std::array::from_fn(|j| self.start[j] + mean(&sum_now, &sum_before, j)),
            std::array::from_fn(|j| mean(&now[0], &before[0], j)),
            std::array::from_fn(|j| mean(&now[1], &before[1], j)),
        ]
    }

    /// Returns the path without averaging; before its start, at rest there.
    fn timed(&self, t_s: f64) -> [Joints; 3] {
        if t_s < 0.0 {
            return [self.start, [0.0; 7], [0.0; 7]];
        }
        let t_s = t_s.min(self.timed_s());
        let i = self.knot_at(t_s);
        let (knot, dt) = (&self.knots[i], t_s - self.knots[i].time);
        let (s, speed) = self.passed(knot, dt);
        motion_at(&self.path, (knot.piece, s), speed, knot.acceleration)
    }

    /// Returns the last knot at or before `t_s`.
    fn knot_at(&self, t_s: f64) -> usize {
        self.knots.partition_point(|knot| knot.time <= t_s).saturating_sub(1)
    }

    /// Path length past the piece's start and path speed `dt` after a knot.
    fn passed(&self, knot: &Knot, dt: f64) -> (f64, f64) {
        let s = knot.s + dt * (knot.speed + 0.5 * knot.acceleration * dt);
        let speed = (knot.speed + knot.acceleration * dt).max(0.0);
        (s.min(self.path.pieces()[knot.piece].length), speed)
    }

    /// Integral of the path minus its start from time 0, rad s.
    fn integral(&self, t_s: f64) -> Joints {
        if t_s <= 0.0 {
            return [0.0; 7];
        }
        let i = self.knot_at(t_s);
        let mut sum = self.sums[i];
        if t_s >= self.timed_s() {
            let rest_s = t_s - self.timed_s();
            return std::array::from_fn(|j| sum[j] + rest_s * (self.end[j] - self.start[j]));
        }
        self.add_integral(&mut sum, i, t_s - self.knots[i].time);
        sum
    }

    /// Adds the integral over the first `dt` seconds after knot `i`.
    fn add_integral(&self, sum: &mut Joints, i: usize, dt: f64) {
        let knot = &self.knots[i];
        for (node, weight) in GAUSS {
            let (s, _) = self.passed(knot, node * dt);
            let q = self.path.pieces()[knot.piece].position(s);
            for j in 0..7 {
                sum[j] += weight * dt * (q[j] - self.start[j]);
            }
        }
    }

    /// Returns whether averaging over `window_s` keeps the jerk limits: whether no joint's
    /// acceleration changes by more than jerk times window within a window. Accelerations jump at
    /// knots and hardly change between them, so both sides of every knot are compared with what is
    /// a window earlier and later.
    fn jerk_kept(&self, window_s: f64) -> bool {
        let keeps = |a: &Joints, b: &Joints| {
            (0..7).all(|j| (a[j] - b[j]).abs() <= JERK_KEPT * self.limits.jerk[j] * window_s)
        };
        self.knots.iter().enumerate().all(|(i, knot)| {
            let time = knot.time;
            let (earlier, later) = (self.timed(time - window_s)[2], self.timed(time + window_s)[2]);
            let sides = [self.acceleration_before(i), self.timed(time)[2]];
            sides.iter().all(|side| keeps(side, &earlier) && keeps(side, &later))
        })
    }

    /// Acceleration just before knot `i`; 0 before the first.
    fn acceleration_before(&self, i: usize) -> Joints {
        let Some(before) = i.checked_sub(1).map(|i| &self.knots[i]) else { return [0.0; 7] };
        let (s, speed) = self.passed(before, self.knots[i].time - before.time);
        motion_at(&self.path, (before.piece, s), speed, before.acceleration)[2]
    }
}
