//! Time-parameterised joint motion: a path and when each of its points is passed.

use std::sync::Arc;

use crate::limb::Joints;
use crate::limits::{MotionLimits, PositionLimits};
use crate::path::Path;
use crate::timing::{self, Knot, motion_at};

#[cfg(test)]
mod tests;

/// A motion of one limb in time, continuous in position and velocity. Copies share their points.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    path: Arc<Path>,
    knots: Arc<[Knot]>,
    limits: Arc<MotionLimits>,
    /// The part of the knots' time that this trajectory covers, seconds.
    begin_s: f64,
    end_s: f64,
}

/// Why no trajectory was made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// A waypoint, or the spline between two, leaves a joint's limits.
    #[error(
        "joint {joint} would be at {position_rad:.4} rad, outside its limits {lower_rad:.4} to \
         {upper_rad:.4} rad"
    )]
    OutsideLimits {
        /// The joint without its limb, e.g. `s0`.
        joint: &'static str,
        /// Where it would be, radians.
        position_rad: f64,
        /// Its lower limit, radians.
        lower_rad: f64,
        /// Its upper limit, radians.
        upper_rad: f64,
    },
}

/// Fewest grid intervals of a timed path. The limits hold with any number; more come nearer to
/// the shortest duration.
pub const INTERVALS_MIN: usize = 200;

impl Trajectory {
    /// From rest to rest through `waypoints` in the shortest time within `limits`: straight in
    /// joint space, corners rounded from `blend_rad` before a waypoint to `blend_rad` after it,
    /// with no stop between. Joint positions stay in the waypoints' convex hull.
    ///
    /// # Errors
    /// [`TrajectoryError::OutsideLimits`] for a waypoint outside the joint limits.
    pub fn through(
        waypoints: &[Joints],
        blend_rad: f64,
        limits: &MotionLimits,
    ) -> Result<Self, TrajectoryError> {
        for q in waypoints {
            refuse_outside(&limits.position, q)?;
        }
        Ok(Self::along(Path::rounded(waypoints, blend_rad), limits, INTERVALS_MIN))
    }

    /// From rest to rest along `path` in the shortest time within velocity and acceleration
    /// `limits`, on a grid of at least `intervals_min` intervals. Positions are the path's.
    pub fn along(path: Path, limits: &MotionLimits, intervals_min: usize) -> Self {
        let knots = timing::fastest(&path, limits, intervals_min);
        Self::from_knots(Arc::new(path), knots, Arc::new(*limits))
    }

    /// Standing still at `q` for `seconds`.
    pub fn hold(q: &Joints, seconds: f64, limits: &MotionLimits) -> Self {
        let still = Knot { time: 0.0, s: 0.0, speed: 0.0, acceleration: 0.0, piece: 0 };
        let knots = vec![still, Knot { time: seconds.max(0.0), ..still }];
        Self::from_knots(Arc::new(Path::rounded(&[*q], 0.0)), knots, Arc::new(*limits))
    }

    /// The motion stop: from `q` at velocity `qd` to rest on a straight line in joint space.
    ///
    /// Decelerates at [`MotionLimits::stop`], so within 0.1 s from any velocity that the limits
    /// allow. A joint too near to its limit for that brakes harder: the position limit is
    /// the one that is kept.
    pub fn halt(q: &Joints, qd: &Joints, limits: &MotionLimits) -> Self {
        let q = limits.position.clamp(q);
        let qd: Joints = std::array::from_fn(|j| if qd[j].is_finite() { qd[j] } else { 0.0 });
        let speed = qd.iter().map(|v| v * v).sum::<f64>().sqrt();
        let seconds = (0..7).map(|j| qd[j].abs() / limits.stop[j]).fold(0.0, f64::max);
        let room = (0..7)
            .map(|j| seconds_to_limit(limits.position.0[j], q[j], qd[j]))
            .fold(f64::INFINITY, f64::min);
        // At a constant deceleration the way is half of speed times time.
        let seconds = seconds.min(2.0 * room);
        if speed < 1e-9 || seconds < 1e-6 {
            return Self::hold(&q, 0.0, limits);
        }
        let braked = std::array::from_fn(|j| q[j] + 0.5 * qd[j] * seconds);
        let rest = limits.position.clamp(&braked);
        let path = Path::rounded(&[q, rest], 0.0);
        let start = Knot { time: 0.0, s: 0.0, speed, acceleration: -speed / seconds, piece: 0 };
        let end = Knot { time: seconds, s: path.length(), speed: 0.0, acceleration: 0.0, piece: 0 };
        Self::from_knots(Arc::new(path), vec![start, end], Arc::new(*limits))
    }

    /// The motion stop that keeps to the path: from this trajectory's state at `t_s` to rest as
    /// soon as [`MotionLimits::stop`] allows. Where the path was clear, so is the stop.
    pub fn halted_at(&self, t_s: f64) -> Self {
        let (knot, dt) = self.knot_at(t_s);
        let s = knot.s + dt * (knot.speed + 0.5 * knot.acceleration * dt);
        let speed = (knot.speed + knot.acceleration * dt).max(0.0);
        let length = self.path.pieces()[knot.piece].length;
        if speed < 1e-9 || self.path.length() == 0.0 || s >= length && self.is_last(knot.piece) {
            return Self::hold(&self.sample(t_s).0, 0.0, &self.limits);
        }
        let limits = MotionLimits { acceleration: self.limits.stop, ..*self.limits };
        let knots = timing::brake(&self.path, &limits, (knot.piece, s.min(length)), speed);
        Self::from_knots(Arc::clone(&self.path), knots, Arc::clone(&self.limits))
    }

    /// How long it takes, seconds.
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.begin_s
    }

    /// Positions (rad) and velocities (rad/s) at `t_s` seconds from the start; before it and after
    /// the end, those of the start and the end.
    pub fn sample(&self, t_s: f64) -> (Joints, Joints) {
        let [q, qd, _] = self.motion(t_s);
        (q, qd)
    }

    /// Accelerations at `t_s`, rad/s². They jump between the grid's intervals.
    pub fn acceleration(&self, t_s: f64) -> Joints {
        self.motion(t_s)[2]
    }

    /// Where it begins.
    pub fn start(&self) -> Joints {
        self.sample(0.0).0
    }

    /// Where it ends.
    pub fn end(&self) -> Joints {
        self.sample(self.duration_s()).0
    }

    /// The two parts before and after `t_s`. The velocity at the cut is that of the whole.
    pub fn split(&self, t_s: f64) -> (Self, Self) {
        let cut = (self.begin_s + t_s).clamp(self.begin_s, self.end_s);
        (Self { end_s: cut, ..self.clone() }, Self { begin_s: cut, ..self.clone() })
    }

    /// When the motion passes nearest to `q`, to one grid interval, seconds from the start.
    pub fn time_nearest(&self, q: &Joints) -> f64 {
        let distance = |knot: &Knot| {
            let at = self.path.pieces()[knot.piece].position(knot.s);
            at.iter().zip(q).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
        };
        let nearest = self.knots.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(0.0, |knot| (knot.time - self.begin_s).clamp(0.0, self.duration_s()))
    }

    fn from_knots(path: Arc<Path>, knots: Vec<Knot>, limits: Arc<MotionLimits>) -> Self {
        let end_s = knots.last().map_or(0.0, |knot| knot.time);
        Self { path, knots: knots.into(), limits, begin_s: 0.0, end_s }
    }

    fn is_last(&self, piece: usize) -> bool {
        piece + 1 == self.path.pieces().len()
    }

    /// The knot at or before `t_s`, and the seconds since.
    fn knot_at(&self, t_s: f64) -> (Knot, f64) {
        let t_s = if t_s.is_nan() { 0.0 } else { t_s };
        let time = (self.begin_s + t_s).clamp(self.begin_s, self.end_s);
        let after = self.knots.partition_point(|knot| knot.time <= time);
        let knot = self.knots[after.saturating_sub(1)];
        (knot, time - knot.time)
    }

    fn motion(&self, t_s: f64) -> [Joints; 3] {
        let (knot, dt) = self.knot_at(t_s);
        let length = self.path.pieces()[knot.piece].length;
        let s = (knot.s + dt * (knot.speed + 0.5 * knot.acceleration * dt)).min(length);
        let speed = (knot.speed + knot.acceleration * dt).max(0.0);
        let [q, qd, qdd] = motion_at(&self.path, (knot.piece, s), speed, knot.acceleration);
        // Rounding may carry a joint that rests on its limit past it by a last bit.
        [self.limits.position.clamp(&q), qd, qdd]
    }
}

/// Seconds until a joint, at `q` and moving on at `qd`, is at its limit.
fn seconds_to_limit((lower, upper): (f64, f64), q: f64, qd: f64) -> f64 {
    if qd > 0.0 {
        (upper - q) / qd
    } else if qd < 0.0 {
        (lower - q) / qd
    } else {
        f64::INFINITY
    }
}

pub(crate) fn refuse_outside(limits: &PositionLimits, q: &Joints) -> Result<(), TrajectoryError> {
    match limits.first_violation(q) {
        None => Ok(()),
        Some((joint, position_rad, (lower_rad, upper_rad))) => {
            Err(TrajectoryError::OutsideLimits { joint, position_rad, lower_rad, upper_rad })
        }
    }
}
