//! Measurements of a robot, and commands to it.

use manipulation::{Joints, Limb, Robot};
use serde::{Deserialize, Serialize};
use vocabulary::time::Time;

/// Joint positions of both limbs, left first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Posture {
    /// Joint positions, radians.
    pub joints: [Joints; 2],
    /// Width between the fingers, metres.
    pub width_m: [f64; 2],
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
    /// Measurements of a robot that has not reported yet: at rest, in the posture that the journal remembers.
    pub fn remembered(posture: Posture, accuracy_rad: f64) -> Self {
        let still = [[0.0; 7]; 2];
        let (velocity, effort, holding) = (still, still, [None; 2]);
        Self { posture, velocity, effort, holding, at: Source::Memory, accuracy_rad }
    }

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

/// Returns the joint of a limb at which two postures differ most, and by how much, radians.
pub fn furthest<'r>(robot: &'r Robot, limb: Limb, a: &Joints, b: &Joints) -> (&'r str, f64) {
    let distances = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let named = robot.arm(limb).joint_names.iter().map(String::as_str).zip(distances);
    named.max_by(|(_, x), (_, y)| x.total_cmp(y)).unwrap_or(("", 0.0))
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grip {
    /// Width of the object, metres.
    pub object_m: f64,
    /// Its offset from the middle between the fingers, metres.
    pub offset_m: f64,
}
