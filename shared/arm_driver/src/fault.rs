//! Faults of a robot that does not follow.

use manipulation::Limb;

/// A motion that the robot did not carry out as commanded, or a part of it that protects itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A joint left the path: an obstacle, or the robot is slower than it should be.
    #[error("{joint} is {error_rad:.3} rad from its path, {tolerance_rad:.3} at most ({setting})")]
    Path {
        /// Its name in the robot's description.
        joint: String,
        /// Deviation, radians.
        error_rad: f64,
        /// The bound, radians.
        tolerance_rad: f64,
        /// Key of the bound in the configuration.
        setting: &'static str,
    },
    /// A joint did not reach its goal.
    #[error(
        "{joint} is {error_rad:.4} rad from its goal {late_s:.1} s after it should be there, {tolerance_rad:.4} at \
         most ({settings})"
    )]
    Goal {
        /// Its name in the robot's description.
        joint: String,
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
    /// A part of the robot protects itself or is lost. It latches the motion stop.
    #[error("{part}: {reason}")]
    Part {
        /// The joint, or another part.
        part: String,
        /// Its condition.
        reason: String,
    },
}
