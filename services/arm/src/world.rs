//! Places of the objects: where they stood, in a gripper, or taken.

use crate::driver::Measured;
use crate::state::{ArmState, Held};
use manipulation::{Cuboid, Limb, ObjectPose, Robot};
use messages::WorldView;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use scene::{ObjectId, Scene};
use service::Time;

/// The objects' places in the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct World {
    robot: Robot,
    places: Vec<Option<ObjectPose>>,
}

impl World {
    pub(crate) fn new(robot: &Robot, scene: &Scene) -> Self {
        let places =
            scene.objects().iter().map(|object| object.placement.as_ref().map(preflight::pose));
        Self { robot: robot.clone(), places: places.collect() }
    }

    /// Returns the object's place, if the scene has the object and a place for it.
    pub(crate) fn place(&self, object: ObjectId) -> Option<&ObjectPose> {
        self.places.get(object.index()).and_then(Option::as_ref)
    }

    /// Returns the objects that stand in their places, except one.
    pub(crate) fn standing(
        &self,
        state: &ArmState,
        except: Option<ObjectId>,
    ) -> impl Iterator<Item = &ObjectPose> {
        let held = state.held.map(|held| held.object);
        self.places.iter().enumerate().filter_map(move |(i, place)| {
            let object = ObjectId::from(i);
            let away = state.gone.contains(&object) || held == Some(object);
            place.as_ref().filter(|_| !away && except != Some(object))
        })
    }

    /// Returns the boxes around the objects that stand in their places, except one.
    pub(crate) fn obstacles(&self, state: &ArmState, except: Option<ObjectId>) -> Vec<Cuboid> {
        self.standing(state, except).map(ObjectPose::cuboid).collect()
    }

    /// Returns `object` as held by the gripper that has closed on it.
    pub(crate) fn grasped(
        &self,
        object: ObjectId,
        limb: Limb,
        measured: &Measured,
    ) -> Option<Held> {
        let gripper = self.robot.arm(limb).chain.forward(&measured.posture.joints[limb]);
        let in_gripper = gripper.inverse() * self.place(object)?.isometry();
        Some(Held { object, limb, in_gripper: to_array(&in_gripper) })
    }

    /// Returns the world view for clients.
    pub(crate) fn view(&self, state: &ArmState, measured: &Measured, now: Time) -> WorldView {
        let joints = &measured.posture.joints;
        let grippers = Limb::BOTH.map(|limb| self.robot.arm(limb).chain.forward(&joints[limb]));
        let mut objects: Vec<Option<[f64; 7]>> =
            self.places.iter().map(|p| p.as_ref().map(|p| to_array(&p.isometry()))).collect();
        let mut put = |object: ObjectId, pose| {
            if let Some(entry) = objects.get_mut(object.index()) {
                *entry = pose;
            }
        };
        state.gone.iter().for_each(|object| put(*object, None));
        if let Some(held) = &state.held {
            let pose = grippers[held.limb] * from_array(&held.in_gripper);
            put(held.object, Some(to_array(&pose)));
        }
        WorldView {
            at_ns: now.ns(),
            objects,
            held: state.held.map(|held| held.object.0),
            grippers: grippers.map(|gripper| to_array(&gripper)),
        }
    }
}

/// Position in metres and quaternion: x, y, z, x, y, z, w.
fn to_array(pose: &Isometry3<f64>) -> [f64; 7] {
    let (p, r) = (pose.translation.vector, pose.rotation.coords);
    [p.x, p.y, p.z, r.x, r.y, r.z, r.w]
}

/// Returns the pose stored in [`Held::in_gripper`].
pub(crate) fn from_array([x, y, z, i, j, k, w]: &[f64; 7]) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(*w, *i, *j, *k));
    Isometry3::from_parts(Translation3::new(*x, *y, *z), rotation)
}
