//! What the joints may do: positions, velocities and accelerations.

use crate::baxter;
use crate::limb::{JOINTS, Joints};

/// Closed interval of positions per joint, radians.
pub const POSITION_LIMITS: [(f64, f64); 7] = baxter::POSITION_LIMITS_RAD;

/// Whether every joint lies within its limits, to the last bit.
pub fn within(q: &Joints) -> bool {
    q.iter().zip(&POSITION_LIMITS).all(|(q, &(lower, upper))| lower <= *q && *q <= upper)
}

/// `q` with every joint moved to the nearest position within its limits. A position that is not a
/// number becomes the lower limit.
pub fn clamp(q: &Joints) -> Joints {
    std::array::from_fn(|i| {
        let (lower, upper) = POSITION_LIMITS[i];
        q[i].max(lower).min(upper)
    })
}

/// The middle of every joint's interval, radians.
pub fn middle() -> Joints {
    POSITION_LIMITS.map(|(lower, upper)| 0.5 * (lower + upper))
}

/// Distance from `q` to the nearest limit of any joint, radians; negative outside.
pub fn margin_rad(q: &Joints) -> f64 {
    q.iter()
        .zip(&POSITION_LIMITS)
        .map(|(q, (lower, upper))| (q - lower).min(upper - q))
        .fold(f64::INFINITY, f64::min)
}

/// Name, position and limits of the first joint of `q` outside its limits.
pub fn first_violation(q: &Joints) -> Option<(&'static str, f64, (f64, f64))> {
    (0..7)
        .find(|&i| !(POSITION_LIMITS[i].0 <= q[i] && q[i] <= POSITION_LIMITS[i].1))
        .map(|i| (JOINTS[i], q[i], POSITION_LIMITS[i]))
}

/// Velocity and acceleration bounds of a motion, per joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionLimits {
    /// Greatest |velocity|, rad/s.
    pub velocity: Joints,
    /// Greatest |acceleration|, rad/s².
    pub acceleration: Joints,
}

impl MotionLimits {
    /// The robot description's velocities and MoveIt's accelerations: the fastest planned motion.
    pub const FULL: Self = Self {
        velocity: baxter::VELOCITY_LIMITS_RAD_S,
        acceleration: baxter::ACCELERATION_LIMITS_RAD_S2,
    };

    /// Both bounds times `ratio`, which is taken into (0, 1]: the SDK's speed ratio.
    pub fn at_speed_ratio(ratio: f64) -> Self {
        let ratio = if ratio.is_finite() { ratio.clamp(1e-3, 1.0) } else { 1.0 };
        Self {
            velocity: Self::FULL.velocity.map(|v| v * ratio),
            acceleration: Self::FULL.acceleration.map(|a| a * ratio),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_themselves_are_within() {
        let lower = POSITION_LIMITS.map(|(lower, _)| lower);
        let upper = POSITION_LIMITS.map(|(_, upper)| upper);
        assert!(within(&lower) && within(&upper) && within(&middle()));
        assert_eq!(margin_rad(&lower), 0.0);
        for j in 0..7 {
            let mut q = upper;
            q[j] = q[j].next_up();
            assert!(!within(&q) && margin_rad(&q) < 0.0);
            assert_eq!(first_violation(&q).unwrap().0, JOINTS[j]);
            assert_eq!(clamp(&q), upper);
        }
        assert_eq!(first_violation(&upper), None);
    }

    #[test]
    fn not_a_number_is_outside_and_clamped() {
        let mut q = middle();
        q[3] = f64::NAN;
        assert!(!within(&q));
        assert_eq!(first_violation(&q).unwrap().0, "e1");
        assert!(within(&clamp(&q)));
    }

    #[test]
    fn speed_ratio_scales_both_bounds() {
        let half = MotionLimits::at_speed_ratio(0.5);
        assert_eq!(half.velocity[0], 0.75);
        assert_eq!(half.acceleration[6], 1.0);
        assert_eq!(MotionLimits::at_speed_ratio(7.0), MotionLimits::FULL);
        assert_eq!(MotionLimits::at_speed_ratio(f64::NAN), MotionLimits::FULL);
        assert!(MotionLimits::at_speed_ratio(-1.0).velocity[0] > 0.0);
    }
}
