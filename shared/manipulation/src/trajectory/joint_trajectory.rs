//! Time-parameterised joint motion: where a limb is at every instant, smooth in acceleration.

use std::sync::Arc;

use crate::kinematics::limb::{Joints, distance};
use crate::kinematics::limits::{MotionLimits, PositionLimits};
use crate::trajectory::path::Path;
use crate::trajectory::profile::{self, State};
use crate::trajectory::smoothed_trajectory::SmoothedTrajectory;
use crate::trajectory::time_scaling::TimeScaling;
use crate::trajectory::timing::{self, Knot};

#[cfg(test)]
mod tests;

/// A motion of one limb in time, continuous in position, velocity and (but for a motion stop)
/// acceleration. Copies share their points.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    smoothed: Arc<SmoothedTrajectory>,
    /// Time scaling of a trajectory that is being stopped.
    time_scaling: Option<Arc<TimeScaling>>,
    /// The part of the time that this trajectory covers, seconds.
    begin_s: f64,
    end_s: f64,
}

/// A trajectory that cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// A posture leaves a joint's limits.
    #[error(
        "joint {} from the shoulder would be at {position_rad:.4} rad, outside its limits \
         {lower_rad:.4} to {upper_rad:.4} rad",
        joint + 1
    )]
    OutsideLimits {
        /// Number of the joint, 0 at the shoulder.
        joint: usize,
        /// Its position, radians.
        position_rad: f64,
        /// Its lower limit, radians.
        lower_rad: f64,
        /// Its upper limit, radians.
        upper_rad: f64,
    },
    /// A state to begin or end with moves faster than allowed.
    #[error(
        "joint {} from the shoulder would have {what} {value:.3}, and its limit is {limit:.3}",
        joint + 1
    )]
    TooFast {
        /// Number of the joint, 0 at the shoulder.
        joint: usize,
        /// `velocity` (rad/s) or `acceleration` (rad/s²).
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// No motion within the limits leads from one state to the other.
    #[error("no motion within the joint limits leads there")]
    NoMotion,
}

/// Fewest grid intervals of a timed path. The limits hold with any number; more come nearer to
/// the shortest duration.
pub const INTERVALS_MIN: usize = 200;

impl Trajectory {
    /// From rest to rest through `waypoints` as fast as `limits` allow: straight in joint space,
    /// corners rounded from `blend_rad` before a waypoint to `blend_rad` after it, with no stop
    /// between. Joint positions stay in the waypoints' convex hull.
    ///
    /// A single line has the shortest duration there is; see [`Trajectory::along`] for others.
    ///
    /// # Errors
    /// [`TrajectoryError::OutsideLimits`] for a waypoint outside the joint limits, or
    /// [`TrajectoryError::NoMotion`] if the limits allow no motion at all.
    pub fn through(
        waypoints: &[Joints],
        blend_rad: f64,
        limits: &MotionLimits,
    ) -> Result<Self, TrajectoryError> {
        for q in waypoints {
            refuse_outside(&limits.position, q)?;
        }
        let path = Path::rounded(waypoints, blend_rad);
        if path.is_straight() {
            let (path, knots) = profile::straight(&path.start(), &path.end(), limits)?;
            return Ok(Self::of(SmoothedTrajectory::exact(path, knots, limits)));
        }
        Ok(Self::along(path, limits, INTERVALS_MIN))
    }

    /// From rest to rest along `path` within `limits`, on a grid of at least `intervals_min`
    /// intervals.
    ///
    /// The path is timed in the shortest time within the velocity and acceleration limits (with
    /// jerk limits that are infinite, that is the motion), and then averaged over a window of
    /// `a/j` to `2 a/j` seconds, as the path asks for: so much longer it takes, and by about
    /// `a (a/j)²/6` at most it leaves the path between its ends.
    pub fn along(path: Path, limits: &MotionLimits, intervals_min: usize) -> Self {
        let knots = timing::fastest(&path, limits, intervals_min);
        Self::of(SmoothedTrajectory::smoothed(path, knots, limits))
    }

    /// From one state to another in the shortest time within the velocity, acceleration, jerk and
    /// position `limits`. Every joint has a profile of its own, all as long as the slowest's.
    ///
    /// # Errors
    /// [`TrajectoryError`] for a state outside the limits, or a moving one that no motion within
    /// the position limits leads from or to.
    pub fn between(
        from: &State,
        to: &State,
        limits: &MotionLimits,
    ) -> Result<Self, TrajectoryError> {
        let (path, knots) = profile::between(from, to, limits)?;
        Ok(Self::of(SmoothedTrajectory::exact(path, knots, limits)))
    }

    /// Standing still at `q` for `seconds`.
    pub fn hold(q: &Joints, seconds: f64, limits: &MotionLimits) -> Self {
        let still = Knot { time: 0.0, s: 0.0, speed: 0.0, acceleration: 0.0, piece: 0 };
        let knots = vec![still, Knot { time: seconds.max(0.0), ..still }];
        Self::of(SmoothedTrajectory::exact(Path::rounded(&[*q], 0.0), knots, limits))
    }

    /// Returns the motion stop: on the curve, from this trajectory's state at `t_s` to
    /// rest as soon as [`MotionLimits::stop`] allows. Where the motion was clear, so is the stop.
    pub fn halted_at(&self, t_s: f64) -> Self {
        let at_s = self.time(t_s);
        if self.time_scaling.is_some() {
            // It stops as soon as it can already.
            return Self { begin_s: at_s, ..self.clone() };
        }
        let time_scaling =
            if at_s < self.end_s { TimeScaling::stopping(&self.smoothed, at_s) } else { None };
        match time_scaling {
            None => Self::hold(&self.sample(t_s).0, 0.0, self.smoothed.limits()),
            Some(time_scaling) => Self {
                smoothed: Arc::clone(&self.smoothed),
                begin_s: 0.0,
                end_s: time_scaling.duration_s(),
                time_scaling: Some(Arc::new(time_scaling)),
            },
        }
    }

    /// Returns its duration, seconds.
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.begin_s
    }

    /// Positions (rad) and velocities (rad/s) at `t_s` seconds from the start; before it and after
    /// the end, those of the start and the end.
    pub fn sample(&self, t_s: f64) -> (Joints, Joints) {
        let State { q, qd, .. } = self.state(t_s);
        (q, qd)
    }

    /// Positions, velocities and accelerations at `t_s`; accelerations of a motion stop jump.
    pub fn state(&self, t_s: f64) -> State {
        let time = self.time(t_s);
        let [q, qd, qdd] = match &self.time_scaling {
            None => self.smoothed.at(time),
            Some(time_scaling) => time_scaling.at(&self.smoothed, time),
        };
        State { q, qd, qdd }
    }

    /// Returns its first posture.
    pub fn start(&self) -> Joints {
        self.sample(0.0).0
    }

    /// Returns the end position.
    pub fn end(&self) -> Joints {
        self.sample(self.duration_s()).0
    }

    /// Returns the two parts before and after `t_s`. The velocity at the cut is that of the whole.
    pub fn split(&self, t_s: f64) -> (Self, Self) {
        let cut = self.time(t_s);
        (Self { end_s: cut, ..self.clone() }, Self { begin_s: cut, ..self.clone() })
    }

    /// Returns the time at which the motion is nearest to `q`, to one grid interval, seconds from the start.
    pub fn time_nearest(&self, q: &Joints) -> f64 {
        let off = |time: &f64| distance(&self.state(*time).q, q);
        let passed = self.smoothed.times().map(|time| time - self.begin_s);
        let times = passed.chain([0.0, self.duration_s()]);
        let within = times.filter(|time| (0.0..=self.duration_s()).contains(time));
        within.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0.0)
    }

    fn of(smoothed: SmoothedTrajectory) -> Self {
        let end_s = smoothed.duration_s();
        Self { smoothed: Arc::new(smoothed), time_scaling: None, begin_s: 0.0, end_s }
    }

    /// Returns the smoothed trajectory's or the time scaling's time at `t_s` from the start, within
    /// what is covered.
    fn time(&self, t_s: f64) -> f64 {
        let t_s = if t_s.is_nan() { 0.0 } else { t_s };
        (self.begin_s + t_s).clamp(self.begin_s, self.end_s)
    }
}

/// Refuses a posture outside the position limits.
pub(crate) fn refuse_outside(limits: &PositionLimits, q: &Joints) -> Result<(), TrajectoryError> {
    match limits.first_violation(q) {
        None => Ok(()),
        Some((joint, position_rad, (lower_rad, upper_rad))) => {
            Err(TrajectoryError::OutsideLimits { joint, position_rad, lower_rad, upper_rad })
        }
    }
}
