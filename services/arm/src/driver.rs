//! The seam to what really moves: a robot, or the kinematic model of one.

mod baxter;
mod kinematic;

pub use baxter::BaxterDriver;
pub use kinematic::KinematicArm;

use crate::state::{Posture, side};
use manipulation::{Joints, Limb, Robot};
use messages::Hindrance;
use messages::robot::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, JointCommand,
    JointState, JointTrajectoryPoint, SpeedRatio,
};
use service::{Span, Time};

/// What moves. The executor commands it a hundred times a second and believes what it measures, so
/// a driver of a real robot has the same two things to do: pass the set point on, and report what
/// the robot's own sensors say. What only a real robot has, a model leaves at its default.
///
/// A motion that belongs to a phase of a pick is commanded only in a pass after the one that made
/// the phase durable, so a driver may act on a command at once.
pub trait ArmDriver {
    /// What the robot feels now.
    fn measured(&self) -> Measured;

    /// Has one limb be somewhere now. It is called for every step of a motion and not while nothing
    /// moves: a limb that is commanded nothing stays where it is. `seconds` have passed since the
    /// limb's last command, or since its motion began.
    fn command(&mut self, command: &Command, seconds: f64);

    /// Takes what the robot told.
    fn hear(&mut self, _told: &Told, _now: Time) {}

    /// A pass begins; `may_calibrate` says which grippers, left first, hold nothing that a
    /// calibration would drop.
    fn begin_pass(&mut self, _now: Time, _may_calibrate: [bool; 2]) {}

    /// A pass ends: limbs that were commanded nothing in it are held where they are. Everything
    /// that the robot is to be told.
    fn end_pass(&mut self, _now: Time) -> Vec<Order> {
        Vec::new()
    }

    /// What keeps the robot from moving at all.
    fn hindrance(&self) -> Hindrance {
        Hindrance::None
    }

    /// Why the limb that moves does not move as it was commanded to.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// Whether a motion that ended with `command`, `late_s` seconds ago, has ended for the robot
    /// too.
    ///
    /// # Errors
    /// It has not within the time that it may take.
    fn has_arrived(&mut self, _command: &Command, _late_s: f64) -> Result<bool, Fault> {
        Ok(true)
    }

    /// Whether joints and fingers stand still, so that a plan can begin where they are.
    fn is_still(&self) -> bool {
        true
    }

    /// Gives up what was commanded: the limbs are held where they are.
    fn hold_here(&mut self) {}

    /// Something was heard that the next step of a motion should not wait for.
    fn is_fresh(&self) -> bool {
        false
    }

    /// Longest time between two passes, also while nothing moves; none where standing needs no
    /// commands.
    fn beat(&self) -> Option<Span> {
        None
    }
}

/// What a robot feels: both limbs, left first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Joints and fingers.
    pub posture: Posture,
    /// Joint velocities, rad/s.
    pub velocity: [Joints; 2],
    /// Joint torques, newton metres.
    pub effort: [Joints; 2],
    /// Whether something is between the fingers; none where the robot cannot tell.
    pub holding: [Option<bool>; 2],
    /// When it was so, where the robot's sensors say; none before they were heard.
    pub at: Source,
    /// How far a joint that stands where it should may be from there, radians.
    pub accuracy_rad: f64,
}

/// Where a measurement comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From a model: it is so whenever it is looked at.
    Model,
    /// From sensors, at that time.
    Sensors(Time),
    /// From nowhere yet: the posture is what the journal remembers.
    Memory,
}

impl Measured {
    /// Whether the limb is in the neutral posture, where it rests.
    pub fn is_at_rest(&self, robot: &Robot, limb: Limb) -> bool {
        self.posture.is_at_rest(robot, limb, self.accuracy_rad)
    }

    /// Whether any limb's fingers hold something for certain.
    pub fn holds(&self, limb: Limb) -> Option<bool> {
        self.holding[side(limb)]
    }
}

/// Where a limb is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// What the fingers are to do.
    pub fingers: Fingers,
}

/// What the fingers are to do; they move at their own speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fingers {
    /// Stay as they are.
    Stay,
    /// Go to a width, metres, letting go of what they hold.
    Open(f64),
    /// Close on an object.
    Grip(Grip),
}

/// What a model of the fingers closes on. A real robot's fingers find out by themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Width of the object, metres.
    pub object_m: f64,
    /// How far beside the middle of the fingers it stands, metres.
    pub offset_m: f64,
}

/// What a robot tells.
#[derive(Clone, Debug, PartialEq)]
pub enum Told {
    /// Its joints, or some of them.
    Joints(Box<JointState>),
    /// How it is as a whole.
    Assembly(AssemblyState),
    /// How a gripper is.
    Gripper(Limb, Box<EndEffectorState>),
    /// What is mounted.
    Properties(Limb, Box<EndEffectorProperties>),
}

/// What a robot is told.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// Where the joints of a limb are to be.
    Joints(Limb, Box<JointCommand>),
    /// Where the limb's motion is, how fast, and how it accelerates.
    FeedForward(Limb, Box<JointTrajectoryPoint>),
    /// The share of its velocity that a limb may use.
    SpeedRatio(Limb, SpeedRatio),
    /// What a gripper is to do.
    Gripper(Limb, Box<EndEffectorCommand>),
}

/// A motion was not carried out as it was commanded.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A joint left the path: something is in the way, or the robot is slower than it should be.
    #[error(
        "{limb}_{joint} is {error_rad:.3} rad from its path, {tolerance_rad:.3} at most \
         (arm.baxter.path_tolerance_rad)"
    )]
    Path {
        /// The limb.
        limb: Limb,
        /// The joint without its limb, e.g. `s0`.
        joint: &'static str,
        /// How far, radians.
        error_rad: f64,
        /// The bound, radians.
        tolerance_rad: f64,
    },
    /// A joint did not come to where its motion ends.
    #[error(
        "{limb}_{joint} is {error_rad:.4} rad from its goal {late_s:.1} s after it should be \
         there, {tolerance_rad:.4} at most (arm.baxter.goal_tolerance_rad, goal_time_s)"
    )]
    Goal {
        /// The limb.
        limb: Limb,
        /// The joint without its limb.
        joint: &'static str,
        /// How far, radians.
        error_rad: f64,
        /// The bound, radians.
        tolerance_rad: f64,
        /// How late it was, seconds.
        late_s: f64,
    },
    /// The fingers did not do what they were told.
    #[error("the {limb} gripper has not done what it was told within {late_s:.1} s")]
    Fingers {
        /// The limb.
        limb: Limb,
        /// How late they were, seconds.
        late_s: f64,
    },
}
