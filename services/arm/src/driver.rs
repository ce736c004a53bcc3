//! Interface to the hardware: a robot, or the kinematic model of one.

mod baxter;
mod kinematic;

pub use baxter::BaxterDriver;
pub use kinematic::KinematicArm;

use crate::Config;
use crate::state::{ArmState, Posture};
use manipulation::{Joints, Limb, Robot};
use messages::MotionInhibit;
use messages::robot::{Order, Report};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

/// A robot or its model. The executor commands it a hundred times a second and trusts its sensors, so
/// a driver of a real robot has the same two tasks: forward the set point, and report what
/// the robot's sensors measure. Methods for real robots have defaults for a model.
///
/// A motion that belongs to a phase of a pick is commanded only in a pass after the one that made
/// the phase durable, so a driver may act on a command at once.
pub trait ArmDriver {
    /// Returns the present measurements.
    fn measured(&self) -> Measured;

    /// Commands one limb. It is called for every step of a motion and not while nothing
    /// moves: a limb without a command stays where it is. `seconds` have passed since the
    /// limb's last command, or since its motion began.
    fn command(&mut self, command: &Command, seconds: f64);

    /// Handles a report of the robot.
    fn on_report(&mut self, _report: &Report<'_>, _now: Time) {}

    /// Begins a pass; `may_calibrate` marks the grippers, left first, that hold nothing a
    /// calibration would drop.
    fn begin_pass(&mut self, _now: Time, _may_calibrate: [bool; 2]) {}

    /// Ends a pass: limbs without a command are held where they are. Returns the
    /// orders to the robot.
    fn end_pass(&mut self, _now: Time) -> Vec<Order<'static>> {
        Vec::new()
    }

    /// Returns the reason why the robot cannot move at all.
    fn inhibit(&self) -> MotionInhibit {
        MotionInhibit::None
    }

    /// Returns the fault of a limb that does not follow its commands.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// Returns whether a motion that ended with `command`, `late_s` seconds ago, has ended for the robot
    /// too.
    ///
    /// # Errors
    /// It has not ended in time.
    fn has_arrived(&mut self, _command: &Command, _late_s: f64) -> Result<bool, Fault> {
        Ok(true)
    }

    /// Returns whether joints and fingers stand still, so that a plan can start there.
    fn is_still(&self) -> bool {
        true
    }

    /// Drops the commands and holds the limbs where they are.
    fn hold_here(&mut self) {}

    /// Returns whether a new report should trigger a step at once.
    fn is_fresh(&self) -> bool {
        false
    }

    /// Returns the longest time between two passes, also at rest; `None` if standing needs no
    /// commands.
    fn beat(&self) -> Option<Span> {
        None
    }

    /// Returns the driver's state, for [`ArmDriver::resume`]; `None` where it has no description.
    fn checkpoint(&self) -> Option<Vec<u8>> {
        None
    }

    /// Takes over the state of another driver. Returns `None` if it is none of this driver.
    fn resume(&mut self, _checkpoint: &[u8]) -> Option<()> {
        None
    }
}

/// Returns the configured driver of an arm in this state.
pub(crate) fn configured(config: &Config, state: &ArmState) -> Box<dyn ArmDriver> {
    match config.arm.driver {
        config::Driver::Kinematic => Box::new(KinematicArm::at(state, &config.setup.robot)),
        config::Driver::Baxter => Box::new(BaxterDriver::new(config, state)),
    }
}

/// Measurements of both limbs, left first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Joints and fingers.
    pub posture: Posture,
    /// Joint velocities, rad/s.
    pub velocity: [Joints; 2],
    /// Joint torques, newton metres.
    pub effort: [Joints; 2],
    /// True if an object is between the fingers; `None` if the robot cannot sense it.
    pub holding: [Option<bool>; 2],
    /// Time and source of the measurement.
    pub at: Source,
    /// Largest deviation of a joint at its goal, radians.
    pub accuracy_rad: f64,
}

/// Source of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// A model: always up to date.
    Model,
    /// Sensors, at that time.
    Sensors(Time),
    /// The journal: no report yet.
    Memory,
}

impl Measured {
    /// Returns whether the limb is in its neutral posture.
    pub fn is_at_rest(&self, robot: &Robot, limb: Limb) -> bool {
        let rest = self.posture.joints[limb].iter().zip(&robot.arm(limb).neutral);
        rest.into_iter().all(|(q, neutral)| (q - neutral).abs() < self.accuracy_rad)
    }

    /// Returns whether the limb's fingers hold something, if known.
    pub fn holds(&self, limb: Limb) -> Option<bool> {
        self.holding[limb]
    }
}

/// Set point of a limb.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// The limb.
    pub limb: Limb,
    /// Joint positions, radians.
    pub q: Joints,
    /// Joint velocities, rad/s.
    pub qd: Joints,
    /// Joint accelerations, rad/s².
    pub qdd: Joints,
    /// Seconds since the motion began.
    pub t_s: f64,
    /// Command to the fingers.
    pub fingers: Fingers,
}

/// Command to the fingers, which move at their own speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fingers {
    /// Stay as they are.
    Stay,
    /// Open to a width, metres, releasing what they hold.
    Open(f64),
    /// Close on an object.
    Grip(Grip),
}

/// The object that a model of the fingers closes on; real fingers sense it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Grip {
    /// Width of the object, metres.
    pub object_m: f64,
    /// Its offset from the middle between the fingers, metres.
    pub offset_m: f64,
}

/// A motion that the robot did not carry out as commanded.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A joint left the path: an obstacle, or the robot is slower than it should be.
    #[error(
        "{limb}_{joint} is {error_rad:.3} rad from its path, {tolerance_rad:.3} at most \
         (arm.baxter.path_tolerance_rad)"
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
    },
    /// A joint did not reach its goal.
    #[error(
        "{limb}_{joint} is {error_rad:.4} rad from its goal {late_s:.1} s after it should be \
         there, {tolerance_rad:.4} at most (arm.baxter.goal_tolerance_rad, goal_time_s)"
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
