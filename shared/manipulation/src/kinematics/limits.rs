//! Limits of the joints: positions, velocities, accelerations and jerks.

use crate::kinematics::limb::Joints;

/// The closed interval of positions of each joint, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionLimits(pub [(f64, f64); 7]);

impl PositionLimits {
    /// Returns whether every joint lies within its limits, to the last bit.
    pub fn within(&self, q: &Joints) -> bool {
        q.iter().zip(&self.0).all(|(q, &(lower, upper))| lower <= *q && *q <= upper)
    }

    /// `q` with every joint moved to the nearest position within its limits. A position that is not
    /// a number becomes the lower limit.
    pub fn clamp(&self, q: &Joints) -> Joints {
        std::array::from_fn(|i| {
            let (lower, upper) = self.0[i];
            q[i].max(lower).min(upper)
        })
    }

    /// Returns the middle of every joint's interval, radians.
    pub fn middle(&self) -> Joints {
        self.0.map(|(lower, upper)| 0.5 * (lower + upper))
    }

    /// Returns the posture at `share` (each 0 to 1) of every joint's interval, radians.
    pub fn at(&self, share: &[f64; 7]) -> Joints {
        std::array::from_fn(|i| {
            let (lower, upper) = self.0[i];
            (lower + (upper - lower) * share[i]).clamp(lower, upper)
        })
    }

    /// Distance from `q` to the nearest limit of any joint that can move, radians; negative outside.
    pub fn margin_rad(&self, q: &Joints) -> f64 {
        q.iter()
            .zip(&self.0)
            .filter(|(_, (lower, upper))| lower < upper)
            .map(|(q, (lower, upper))| (q - lower).min(upper - q))
            .fold(f64::INFINITY, f64::min)
    }

    /// Number (0 at the shoulder), position and limits of the first joint of `q` outside its limits.
    pub fn first_violation(&self, q: &Joints) -> Option<(usize, f64, (f64, f64))> {
        (0..7)
            .find(|&i| !(self.0[i].0 <= q[i] && q[i] <= self.0[i].1))
            .map(|i| (i, q[i], self.0[i]))
    }

    /// Returns the excess of joint `i` at `q` over its limits, radians; 0 within.
    #[inline(always)]
    pub(crate) fn outside(&self, i: usize, q: f64) -> f64 {
        let (lower, upper) = self.0[i];
        (lower - q).max(q - upper).max(0.0)
    }

    /// Returns the excess of the worst joint over its limits, radians.
    #[inline]
    pub(crate) fn violation(&self, q: &Joints) -> f64 {
        (0..7).fold(0.0, |worst, i| self.outside(i, q[i]).max(worst))
    }
}

/// Bounds of a motion, per joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionLimits {
    /// Positions, radians.
    pub position: PositionLimits,
    /// Greatest |velocity|, rad/s.
    pub velocity: Joints,
    /// Greatest |acceleration|, rad/s².
    pub acceleration: Joints,
    /// Greatest |jerk|, rad/s³.
    pub jerk: Joints,
    /// Deceleration of a motion stop, rad/s²: every joint from its greatest velocity to rest in
    /// 0.1 s.
    ///
    /// Above `acceleration` on purpose. Those are a planner's comfortable values; a stop that kept
    /// them would take Baxter 0.75 s from full speed, and a person who says "stop" is owed better.
    pub stop: Joints,
}

/// Duration of a motion stop from a joint's greatest velocity, seconds.
const STOP_S: f64 = 0.1;

impl MotionLimits {
    /// Returns the limits of joints with these bounds; the stop follows from the velocities.
    pub fn new(
        position: PositionLimits,
        velocity: Joints,
        acceleration: Joints,
        jerk: Joints,
    ) -> Self {
        Self { position, velocity, acceleration, jerk, stop: velocity.map(|v| v / STOP_S) }
    }

    /// Velocity, acceleration and jerk times `ratio`, which is taken into (0, 1]: the SDK's speed
    /// ratio. Positions and the stop stay.
    pub fn at_speed_ratio(&self, ratio: f64) -> Self {
        let ratio = if ratio.is_finite() { ratio.clamp(1e-3, 1.0) } else { 1.0 };
        Self {
            velocity: self.velocity.map(|v| v * ratio),
            acceleration: self.acceleration.map(|a| a * ratio),
            jerk: self.jerk.map(|j| j * ratio),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::samples::full;

    #[test]
    fn limits_themselves_are_within() {
        let limits = full().position;
        let lower = limits.at(&[0.0; 7]);
        let upper = limits.at(&[1.0; 7]);
        assert!(limits.within(&lower) && limits.within(&upper) && limits.within(&limits.middle()));
        assert_eq!(limits.margin_rad(&lower), 0.0);
        for j in 0..7 {
            let mut q = upper;
            q[j] = q[j].next_up();
            assert!(!limits.within(&q) && limits.margin_rad(&q) < 0.0);
            assert_eq!(limits.first_violation(&q).unwrap().0, j);
            assert_eq!(limits.clamp(&q), upper);
        }
        assert_eq!(limits.first_violation(&upper), None);
        assert!(!limits.within(&[f64::NAN; 7]) && limits.within(&limits.clamp(&[f64::NAN; 7])));
    }

    #[test]
    fn a_ratio_scales_what_moves_and_leaves_the_rest() {
        let full = full();
        let half = full.at_speed_ratio(0.5);
        assert_eq!(half.velocity[0], 0.5 * full.velocity[0]);
        assert_eq!(half.acceleration[6], 0.5 * full.acceleration[6]);
        assert_eq!(half.jerk[6], 0.5 * full.jerk[6]);
        assert_eq!((half.position, half.stop), (full.position, full.stop));
        assert_eq!(full.at_speed_ratio(f64::NAN), full);
        assert_eq!(full.at_speed_ratio(7.0), full);
        assert!(full.at_speed_ratio(-1.0).velocity[0] > 0.0);
    }
}
