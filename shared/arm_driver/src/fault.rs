//! Faults of a robot that does not follow.

use manipulation::Limb;

/// A motion that the robot did not carry out as commanded.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A joint left the path: an obstacle, or the robot is slower than it should be.
    #[error(
        "{limb}_{joint} is {error_rad:.3} rad from its path, {tolerance_rad:.3} at most \
         ({setting})"
    )]
    Path {
        /// The limb.
        limb: Limb,
        /// The joint without its limb, e.g. `s0`.
        joint: &'static str,
        /// Deviation, radians.
        error_rad: f64,
        /// The bound, radians.
        tolerance_rad: f64,
        /// Key of the bound in the configuration.
        setting: &'static str,
    },
    /// A joint did not reach its goal.
    #[error(
        "{limb}_{joint} is {error_rad:.4} rad from its goal {late_s:.1} s after it should be \
         there, {tolerance_rad:.4} at most ({settings})"
    )]
    Goal {
        /// The limb.
        limb: Limb,
        /// The joint without its limb.
        joint: &'static str,
        /// Deviation, radians.
        error_rad: f64,
        /// The bound, radians.
        tolerance_rad: f64,
        /// Its delay, seconds.
        late_s: f64,
        /// Keys of the bound and of the time allowed in the configuration.
        settings: &'static str,
    },
    /// The robot's own controller did not carry out a motion.
    #[error("the controller of the {limb} arm {why}")]
    Controller {
        /// The limb.
        limb: Limb,
        /// Its answer, and a likely cause.
        why: &'static str,
    },
    /// The fingers did not complete their command.
    #[error("the {limb} gripper did not complete its command within {late_s:.1} s")]
    Fingers {
        /// The limb.
        limb: Limb,
        /// Their delay, seconds.
        late_s: f64,
    },
}
