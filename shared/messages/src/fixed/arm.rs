//! The arm's state and the motion stop.

use crate::schema::wire_struct;
use crate::wire::{Code, wire_codes, wire_enum};
use crate::{ActId, InteractionId, PickId, PickOutcome, PickPhase, StopId, Task};
use iceoryx2::prelude::ZeroCopySend;

/// Joints of a joint state: 7 a limb, head pan and nod, torso.
pub const JOINT_STATE_LEN: usize = 17;

/// Baxter's own joint names in the order of `/robot/joint_states`.
pub const JOINT_STATE_NAMES: [&str; JOINT_STATE_LEN] = [
    "head_nod", "head_pan", "left_e0", "left_e1", "left_s0", "left_s1", "left_w0", "left_w1",
    "left_w2", "right_e0", "right_e1", "right_s0", "right_s1", "right_w0", "right_w1", "right_w2",
    "torso_t0",
];

wire_codes!(PickPhase { Idle = 0, Accepted = 1, Moving = 2, Closing = 3, Holding = 4, Done = 5, Returning = 6, });
wire_codes!(PickOutcome {
    Pending = 0,
    Delivered = 1,
    Unreachable = 2,
    Interrupted = 3,
    Cancelled = 4,
    Missed = 5,
    Blocked = 6,
    PutBack = 7,
    Vanished = 8,
    Kept = 9,
});
wire_codes!(Task { Fetch = 0, PutBack = 1, });

wire_enum! {
    /// Reason why the robot cannot move at all, the gravest of several.
    MotionInhibit {
        /// Nothing.
        None = 0,
        /// An emergency stop holds.
        Stopped = 1,
        /// A part of the robot has a fault.
        Error = 2,
        /// The motors are off.
        Disabled = 3,
        /// The robot has not been heard yet, or not all of it.
        Unheard = 4,
        /// The measurements are too old to rely on.
        Stale = 5,
        /// A gripper has a fault, or is not the electric one.
        Gripper = 6,
        /// A gripper is being calibrated.
        Calibrating = 7,
    }
}

wire_struct! {
    /// State of the arm executor. Arm to policy and speech.
    ArmStatus = "ArmStatus" {
        /// [`InteractionId`] of the latest pick.
        interaction: u64,
        /// [`ActId`] of the pointing question that the gripper aims at, 0 for none.
        aimed_act: u64,
        /// Attempt of the latest pick.
        attempt: u32,
        /// `ObjectId` of the latest pick.
        object: u32,
        /// [`PickPhase`] of the latest pick.
        phase: Code<PickPhase>,
        /// [`PickOutcome`] of the latest pick.
        outcome: Code<PickOutcome>,
        /// 1 while the motion stop is latched.
        stopped: u8,
        /// 1 while any joint moves.
        moving: u8,
        /// [`MotionInhibit`].
        hindrance: Code<MotionInhibit>,
        /// [`Task`] of the latest pick.
        task: Code<Task>,
        /// Zero.
        reserved: [u8; 2],
        /// Expected seconds until the pick is done, 0 where none runs.
        remaining_s: f64,
        /// [`StopId`] of the motion stop in force, 0 for none: a release names it.
        stop: u64,
    }
}

impl ArmStatus {
    /// The latest pick.
    pub fn pick(&self) -> PickId {
        PickId { interaction: InteractionId(self.interaction), attempt: self.attempt }
    }

    /// The motion stop in force.
    pub fn stop(&self) -> StopId {
        StopId(self.stop)
    }

    /// The pointing question that the gripper aims at.
    pub fn aimed_at(&self) -> Option<ActId> {
        (self.aimed_act > 0).then_some(ActId(self.aimed_act))
    }
}

wire_struct! {
    /// Joint states, at 100 Hz while the arm is busy, in the order of [`JOINT_STATE_NAMES`]. Arm to clients.
    JointStates = "JointStates" {
        /// When the joints were so.
        at_ns: u64,
        /// Position, radians.
        position: [f64; JOINT_STATE_LEN],
        /// Velocity, radians a second.
        velocity: [f64; JOINT_STATE_LEN],
        /// Effort, newton metres; the kinematic arm has none.
        effort: [f64; JOINT_STATE_LEN],
        /// Opening of the left and right gripper, percent of its range.
        gripper_percent: [f64; 2],
    }
}

wire_enum! {
    /// Commands to the motion stop.
    MotionOrder {
        /// Halt and latch.
        Stop = 0,
        /// Release the latch.
        Resume = 1,
    }
}
