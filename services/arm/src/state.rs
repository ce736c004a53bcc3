//! Everything that the arm must not forget. It is small, so each journal record holds it whole, and
//! recovery reads one record.

use manipulation::{Joints, Limb, Robot};
use messages::pick::Pick;
use messages::{MotionOrder, PickPhase};
use scene::ObjectId;
use serde::{Deserialize, Serialize};
use service::Time;

/// The arm's state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmState {
    /// Key of the scene that the objects below belong to.
    pub scene_key: u64,
    /// Where both limbs are.
    pub posture: Posture,
    /// The latest pick.
    pub pick: Option<Pick>,
    /// The limb that the latest pick moves; none before it moves.
    pub limb: Option<Limb>,
    /// How often the fingers have closed on nothing in the latest pick.
    pub misses: u32,
    /// What the gripper holds. Only while the pick is `Holding`, or was interrupted then.
    pub held: Option<Held>,
    /// Objects that a person has taken and nobody has put back, in order.
    pub gone: Vec<ObjectId>,
    /// Whether the motion stop is latched.
    pub stopped: bool,
    /// When the motion order was given that was obeyed last.
    pub obeyed: Time,
    /// Whether the arm waits where a pick was interrupted until a person has looked: until the next
    /// order, or the release of a motion stop.
    pub waits_for_person: bool,
}

/// Where both limbs are, left first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Posture {
    /// Joint positions, radians.
    pub joints: [Joints; 2],
    /// Width between the fingers, metres.
    pub width_m: [f64; 2],
}

/// An object in a gripper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// The object.
    pub object: ObjectId,
    /// Whose gripper.
    pub limb: Limb,
    /// Pose of the object in frame `<limb>_gripper`: x, y, z in metres, quaternion x, y, z, w.
    pub in_gripper: [f64; 7],
}

/// Why a record was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// The journal begins anew here; the state is to be taken as it is.
    Snapshot,
    /// The group was started with another scene: the objects are other ones.
    SceneChanged,
    /// A pick was ordered, or given up before it was known.
    Ordered,
    /// The pick has come to its next phase; the motion of that phase follows.
    Phase,
    /// The fingers have closed on nothing, and the grasp is tried again.
    Missed,
    /// The pick is over.
    Ended,
    /// The motion stop was latched or released, by order or because the robot's own emergency stop
    /// holds.
    Motion(MotionOrder),
    /// A hint: how far a motion has come.
    Moved,
    /// Both limbs are at rest, and people have put back what they put back.
    Rested,
    /// The robot did not move as it was commanded to; a person must look.
    Blocked,
    /// The service was told to end.
    Shutdown,
}

/// A journal record: why the state changed, when, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Why.
    pub cause: Cause,
    /// When.
    pub at: Time,
    /// The state after it.
    pub state: ArmState,
}

impl ArmState {
    /// The state before anything was ordered: both limbs at rest, fingers `open_width_m` apart.
    pub fn first(robot: &Robot, scene_key: u64, open_width_m: f64) -> Self {
        let joints = Limb::BOTH.map(|limb| robot.arm(limb).neutral);
        Self {
            scene_key,
            posture: Posture { joints, width_m: [open_width_m; 2] },
            pick: None,
            limb: None,
            misses: 0,
            held: None,
            gone: Vec::new(),
            stopped: false,
            obeyed: Time(0),
            waits_for_person: false,
        }
    }

    /// The pick that is not over yet.
    pub fn open_pick(&self) -> Option<&Pick> {
        self.pick.as_ref().filter(|pick| pick.phase != PickPhase::Done)
    }
}

impl Posture {
    /// Whether the limb is in the neutral posture, where it rests, each joint to `accuracy_rad`.
    pub fn is_at_rest(&self, robot: &Robot, limb: Limb, accuracy_rad: f64) -> bool {
        let (joints, neutral) = (&self.joints[side(limb)], &robot.arm(limb).neutral);
        joints.iter().zip(neutral).all(|(q, rest)| (q - rest).abs() < accuracy_rad)
    }
}

/// Index of a limb where both are listed.
pub(crate) fn side(limb: Limb) -> usize {
    match limb {
        Limb::Left => 0,
        Limb::Right => 1,
    }
}
