//! A joint that would leave its position limits on the fastest way: it stops first, and goes then.
//! From rest to rest a joint stays between the two.

use rsruckig::prelude::{ControlInterface, DataArrayOrVec, InputParameter};

use super::calculated;
use super::curve::Curve;
use crate::kinematics::limits::MotionLimits;
use crate::trajectory::joint_trajectory::TrajectoryError;

/// One joint's limits.
pub(super) struct Bounds {
    position: (f64, f64),
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl Bounds {
    pub(super) fn of(limits: &MotionLimits, j: usize) -> Self {
        Self {
            position: limits.position.0[j],
            velocity: limits.velocity[j],
            acceleration: limits.acceleration[j],
            jerk: limits.jerk[j],
        }
    }

    fn input(&self) -> InputParameter<1> {
        let mut input = InputParameter::<1>::new(None);
        input.max_velocity = one(self.velocity);
        input.max_acceleration = one(self.acceleration);
        input.max_jerk = one(self.jerk);
        input
    }

    /// To rest as soon as possible from a position, velocity and acceleration.
    fn stop(&self, [q, qd, qdd]: [f64; 3]) -> Result<Curve, TrajectoryError> {
        let mut input = self.input();
        input.control_interface = ControlInterface::Velocity;
        input.current_position = one(q);
        (input.current_velocity, input.target_velocity) = (one(qd), one(0.0));
        (input.current_acceleration, input.target_acceleration) = (one(qdd), one(0.0));
        let curve = Curve::of(&calculated(&input)?, 0);
        if curve.stays_within(self.position) { Ok(curve) } else { Err(TrajectoryError::NoMotion) }
    }

    /// From rest to rest in no less than `least_s`.
    fn rest_to_rest(&self, from: f64, to: f64, least_s: f64) -> Result<Curve, TrajectoryError> {
        let mut input = self.input();
        (input.current_position, input.target_position) = (one(from), one(to));
        input.minimum_duration = (least_s > 0.0).then_some(least_s);
        Ok(Curve::of(&calculated(&input)?, 0))
    }
}

/// From one state (position, velocity, acceleration) to another in `seconds`, or as much longer as
/// it takes: to rest, from rest to rest, and up to the target's speed.
///
/// # Errors
/// [`TrajectoryError::NoMotion`] if the joint cannot stop within its position limits, or cannot
/// gain the target's speed within them.
pub(super) fn by_stopping(
    from: [f64; 3],
    [q, qd, qdd]: [f64; 3],
    bounds: &Bounds,
    seconds: f64,
) -> Result<Curve, TrajectoryError> {
    let stop = bounds.stop(from)?;
    // Stopping backwards in time is setting out.
    let start = bounds.stop([q, -qd, qdd])?.reversed();
    let left_s = seconds - stop.duration_s - start.duration_s;
    let between = bounds.rest_to_rest(stop.end(), start.cubic(0.0, 0.0)[0], left_s)?;
    Ok(stop.then(&between).then(&start))
}

fn one(value: f64) -> DataArrayOrVec<f64, 1> {
    DataArrayOrVec::Stack([value])
}
