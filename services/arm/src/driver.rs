//! The seam to what really moves: a robot, or the kinematic model of one.

use crate::state::{ArmState, Posture, side};
use kinematics::{Joints, Limb, gripper};

/// What moves. The executor commands it a few dozen to a hundred times a second and believes what
/// it measures, so a driver of a real robot has the same two things to do: pass the set point on,
/// and report what the robot's own sensors say.
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
}

/// What a robot feels: both limbs, left first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Joints and fingers.
    pub posture: Posture,
    /// Joint velocities, rad/s.
    pub velocity: [Joints; 2],
    /// Whether something is between the fingers; none where the robot cannot tell.
    pub holding: [Option<bool>; 2],
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
    /// Close on an object of this width, metres.
    Grip(f64),
}

/// The kinematic model: the joints are where they were commanded to be, the fingers move at their
/// speed, and a grip never misses.
#[derive(Clone, Debug)]
pub struct KinematicArm {
    measured: Measured,
    /// Width of the object on which each limb's fingers close.
    grip: [Option<f64>; 2],
}

impl KinematicArm {
    /// The arm as the journal left it.
    pub fn at(state: &ArmState) -> Self {
        let posture = state.posture;
        let mut grip = [None; 2];
        if let Some(held) = &state.held {
            grip[side(held.limb)] = Some(posture.width_m[side(held.limb)]);
        }
        let holding = grip.map(|grip| Some(grip.is_some()));
        Self { measured: Measured { posture, velocity: [[0.0; 7]; 2], holding }, grip }
    }
}

impl ArmDriver for KinematicArm {
    fn measured(&self) -> Measured {
        self.measured
    }

    fn command(&mut self, command: &Command, seconds: f64) {
        let Self { measured, grip } = self;
        let i = side(command.limb);
        measured.posture.joints[i] = command.q;
        measured.velocity[i] = command.qd;
        let width_m = &mut measured.posture.width_m[i];
        let target_m = match command.fingers {
            Fingers::Stay => *width_m,
            Fingers::Open(target_m) => {
                grip[i] = None;
                target_m
            }
            Fingers::Grip(object_m) => {
                grip[i] = Some(gripper::closed_on(object_m));
                gripper::closed_on(object_m)
            }
        };
        let travel_m = gripper::STROKE_M / gripper::STROKE_S * seconds;
        *width_m += (target_m - *width_m).clamp(-travel_m, travel_m);
        let closed = grip[i].is_some_and(|object_m| *width_m <= object_m + 1e-9);
        measured.holding[i] = Some(closed && gripper::holds(*width_m));
    }
}
