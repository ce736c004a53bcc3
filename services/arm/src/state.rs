//! Durable state of the arm. It is small, so each journal record holds all of it, and
//! recovery reads one record.

use arm_driver::Posture;
use manipulation::{Limb, Robot};
use messages::pick::Pick;
use messages::{MotionOrder, PickOutcome, PickPhase, StopId, Task};
use scene::ObjectId;
use serde::{Deserialize, Serialize};
use service::Time;

/// Objects of which is remembered how they were handed over.
const HANDED_OVER_MAX: usize = 4;

/// The arm's state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmState {
    /// Key of the scene that the objects below belong to.
    pub scene_key: u64,
    /// Joint positions of both limbs.
    pub posture: Posture,
    /// The latest pick.
    pub pick: Option<Pick>,
    /// The limb that the latest pick moves; none before it moves.
    pub limb: Option<Limb>,
    /// Missed grasps in the latest pick.
    pub misses: u32,
    /// Object in the gripper. Only while the pick is `Holding` or `Returning`, was interrupted then, or
    /// is kept.
    pub held: Option<Held>,
    /// Objects that a person has taken and not put back, in order.
    pub gone: Vec<ObjectId>,
    /// The objects handed over last as they were held, the latest last: so they are taken again to be
    /// put back.
    pub handed_over: Vec<Held>,
    /// What a user may hold where the gripper lets go of it, from before the fingers begin to open, or
    /// where it came for it, until that limb is at rest.
    pub offered: Option<Offered>,
    /// True if the motion stop is latched.
    pub stopped: bool,
    /// Time at which the latest applied motion order was given.
    pub obeyed: Time,
    /// True if the arm waits after an interrupted pick until a person has checked it: until the next
    /// order, or the release of a motion stop.
    pub waits_for_person: bool,
}

/// An object in a gripper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// The object.
    pub object: ObjectId,
    /// Limb of the gripper.
    pub limb: Limb,
    /// Pose of the object in frame `<limb>_gripper`: x, y, z in metres, quaternion x, y, z, w.
    pub in_gripper: [f64; 7],
}

/// An object that a user may hold out, with open fingers around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Offered {
    /// The object.
    pub object: ObjectId,
    /// Limb of the gripper.
    pub limb: Limb,
    /// Pose of the object in frame `base`: x, y, z in metres, quaternion x, y, z, w.
    pub pose: [f64; 7],
}

/// Reason for a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// The journal starts here; the state is complete.
    Snapshot,
    /// The group was started with another scene, so with other objects.
    SceneChanged,
    /// A pick was ordered, or cancelled before its order arrived.
    Ordered,
    /// The pick has reached its next phase; the motion of that phase follows.
    Phase,
    /// A missed grasp, to be retried.
    Missed,
    /// The pick is over.
    Ended,
    /// The motion stop was latched or released, by order or because the robot's own emergency stop
    /// holds.
    Motion(MotionOrder),
    /// Progress of a motion.
    Moved,
    /// Both limbs are at rest, and objects were restocked if configured.
    Rested,
    /// The robot did not move as commanded; an operator must check it.
    Blocked,
    /// Shutdown on request.
    Shutdown,
}

impl Cause {
    /// Returns whether the record begins or ends a phase of a pick, so that the next step waits for it.
    pub(crate) fn is_of_phase(self) -> bool {
        match self {
            Self::Ordered | Self::Phase | Self::Missed | Self::Ended | Self::Rested => true,
            Self::Snapshot | Self::SceneChanged | Self::Blocked => true,
            Self::Motion(_) | Self::Moved | Self::Shutdown => false,
        }
    }
}

/// A journal record: why the state changed, when, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Reason for the record.
    pub cause: Cause,
    /// When.
    pub at: Time,
    /// The state after it.
    pub state: ArmState,
}

impl ArmState {
    /// Returns the state before anything was ordered: both limbs at rest, fingers open to
    /// `open_percent` of their range.
    pub fn first(robot: &Robot, scene_key: u64, open_percent: f64) -> Self {
        let joints = Limb::BOTH.map(|limb| robot.arm(limb).neutral);
        let width_m = Limb::BOTH.map(|limb| robot.arm(limb).gripper.width_m(open_percent));
        Self {
            scene_key,
            posture: Posture { joints, width_m },
            pick: None,
            limb: None,
            misses: 0,
            held: None,
            gone: Vec::new(),
            handed_over: Vec::new(),
            offered: None,
            stopped: false,
            obeyed: Time(0),
            waits_for_person: false,
        }
    }

    /// Returns the stop in force: its time in microseconds, which JSON's numbers hold exactly; 1 if it is of an earlier
    /// boot.
    pub(crate) fn stop(&self) -> StopId {
        StopId(if self.stopped { (self.obeyed.ns() / 1_000).max(1) } else { 0 })
    }

    /// Returns how an object was held when it was handed over, if that is remembered.
    pub fn handed_over(&self, object: ObjectId) -> Option<&Held> {
        self.handed_over.iter().find(|held| held.object == object)
    }

    /// Remembers how an object was held when it was handed over.
    pub(crate) fn remember(&mut self, held: Held) {
        self.handed_over.retain(|other| other.object != held.object);
        if self.handed_over.len() == HANDED_OVER_MAX {
            self.handed_over.remove(0);
        }
        self.handed_over.push(held);
    }

    /// Returns whether the gripper has begun to let go of the object that it holds where it hands it
    /// over: the user may have it already.
    pub(crate) fn is_letting_go(&self) -> bool {
        self.held.is_some_and(|held| self.offered.is_some_and(|it| it.object == held.object))
    }

    /// Returns the object that was called off, with no way back to its place: the gripper keeps hold of
    /// it until the next order for it.
    pub(crate) fn kept(&self) -> Option<&Held> {
        let is_kept = self.pick.is_some_and(|pick| pick.outcome == PickOutcome::Kept);
        self.held.as_ref().filter(|_| is_kept)
    }

    /// Returns whether that is this object.
    pub(crate) fn keeps(&self, object: ObjectId) -> bool {
        self.kept().is_some_and(|held| held.object == object)
    }

    /// Returns whether the arm stands until a person has looked, or has said what becomes of what it
    /// keeps.
    pub(crate) fn waits(&self) -> bool {
        self.waits_for_person || self.kept().is_some()
    }

    /// Returns the object that is to be put back, while that is in progress.
    pub(crate) fn to_put_back(&self) -> Option<ObjectId> {
        let pick = self.open_pick().filter(|pick| pick.task == Task::PutBack);
        pick.map(|pick| pick.object)
    }

    /// Returns whether every object is where it is in `other`, and is grasped in the same attempt.
    pub(crate) fn has_same_objects(&self, other: &Self) -> bool {
        (self.held, self.misses) == (other.held, other.misses)
            && self.gone == other.gone
            && self.handed_over == other.handed_over
            && self.offered == other.offered
    }

    /// Returns the pick in progress.
    pub fn open_pick(&self) -> Option<&Pick> {
        self.pick.as_ref().filter(|pick| pick.phase != PickPhase::Done)
    }
}
