use messages::MotionOrder;
use serde::{Deserialize, Serialize};
use vocabulary::{PickOutcome, PickPhase, Task};

/// A record of the arm: why its state changed, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmRecord {
    /// Cause of the change.
    pub cause: ArmCause,
    /// The latest pick.
    pub pick: Option<PickRecord>,
    /// The moving limb; `None` before it moves.
    pub limb: Option<String>,
    /// Number of missed grasps in the pick.
    pub misses: u32,
    /// The object in the gripper.
    pub held: Option<HeldRecord>,
    /// Names of the objects that a person has taken and not put back, in order.
    pub gone: Vec<String>,
    /// Name of the object that a user may hold out, with open fingers around it.
    pub offered: Option<String>,
    /// Whether the motion stop is latched.
    pub stopped: bool,
    /// When the latest applied order to the motion stop was given.
    pub obeyed_ns: u64,
    /// Whether the arm waits until a person has checked it.
    pub waits_for_person: bool,
    /// Joint positions and widths between the fingers, of the left limb and the right one.
    pub posture: [PostureRecord; 2],
}

/// Why the arm's state changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ArmCause {
    /// The file starts here; the state is complete.
    Snapshot,
    /// The group was started with another scene.
    SceneChanged,
    /// A pick was ordered, or cancelled before its order arrived.
    Ordered,
    /// The pick has reached its next phase.
    Phase,
    /// A missed grasp, to be retried.
    Missed,
    /// The pick is over.
    Ended,
    /// The motion stop was latched or released.
    Motion {
        /// Kind of order.
        order: MotionOrder,
    },
    /// Progress of a motion.
    Moved,
    /// Both limbs are at rest.
    Rested,
    /// The robot did not move as commanded.
    Blocked,
    /// Shutdown on request.
    Shutdown,
}

/// A pick of the arm.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PickRecord {
    /// Interaction of the order.
    pub interaction: u64,
    /// Attempt within the interaction, from 1.
    pub attempt: u32,
    /// Name of the ordered object.
    pub object: String,
    /// Task with the object.
    pub task: Task,
    /// Progress of the pick.
    pub phase: PickPhase,
    /// Outcome of the pick.
    pub outcome: PickOutcome,
}

/// An object in a gripper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldRecord {
    /// Name of the object.
    pub object: String,
    /// Limb of the gripper.
    pub limb: String,
    /// Position of the object in frame `<limb>_gripper`, metres.
    pub position_m: [f64; 3],
    /// Rotation of the object there, quaternion x, y, z, w.
    pub rotation_xyzw: [f64; 4],
}

/// Joints of one limb.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PostureRecord {
    /// Joint positions from the shoulder to the wrist, radians.
    pub joints_rad: [f64; 7],
    /// Width between the fingers, metres.
    pub width_m: f64,
}
