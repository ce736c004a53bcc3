//! Places of the objects: where they stood, in a gripper, or taken.

use crate::state::{ArmState, Held, Offered};
use arm_driver::Measured;
use manipulation::pose_array::{from_array, to_array};
use manipulation::{Cuboid, Limb, ObjectPose, Robot};
use messages::{TableView, WorldView};
use nalgebra::Isometry3;
use scene::{ObjectId, Placement, Scene};
use service::Time;

/// The objects' places: those of the scene, or those that are perceived.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct World {
    robot: Robot,
    places: Vec<Place>,
    /// Version of the table that they are from; none for those of the scene.
    table: Option<u64>,
}

/// An object and where it is.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    number: ObjectId,
    pose: Option<ObjectPose>,
    /// Whether a person has it.
    taken: bool,
    /// Whether it was looked for in vain.
    gone: bool,
}

/// Error of an object's place that a grasp forgives, metres and radians.
const FORGIVEN: (f64, f64) = (0.01, 0.17);
/// Change of an estimated place while a motion is planned that the plan need not know of, metres.
const PLANNED_M: f64 = 0.004;

impl World {
    pub(crate) fn new(robot: &Robot, scene: &Scene) -> Self {
        let place = |(number, object): (u16, &scene::Object)| Place {
            number: ObjectId(number),
            pose: object.placement.as_ref().map(preflight::pose),
            taken: false,
            gone: false,
        };
        let places = (0..).zip(scene.objects()).map(place).collect();
        Self { robot: robot.clone(), places, table: None }
    }

    /// Returns the world without any object, before the first table is known.
    pub(crate) fn unknown(robot: &Robot) -> Self {
        Self { robot: robot.clone(), places: Vec::new(), table: Some(0) }
    }

    /// Returns the objects of a table, each where it is estimated to be at this moment. `file` is the
    /// scene file, which has sizes and grasps.
    pub(crate) fn of_table(robot: &Robot, file: &Scene, table: &TableView) -> Self {
        let known: Vec<_> = table.objects.iter().map(|object| object.known.clone()).collect();
        let scene = file.with_objects(&known);
        let place = |(object, seen): (&scene::Object, &messages::TableObject)| {
            let [x, y, z, yaw] = seen.place;
            let is_sound = seen.place.iter().all(|it| it.is_finite());
            let here = |it| Placement { xyz: [x, y, z], yaw, ..it };
            Place {
                number: seen.known.number,
                pose: object.placement.filter(|_| is_sound).map(|it| preflight::pose(&here(it))),
                taken: seen.known.taken,
                gone: seen.gone,
            }
        };
        let places = scene.objects().iter().zip(&table.objects).map(place).collect();
        Self { robot: robot.clone(), places, table: Some(table.version) }
    }

    fn entry(&self, object: ObjectId) -> Option<&Place> {
        match self.table {
            None => self.places.get(object.index()),
            Some(_) => self.places.iter().find(|place| place.number == object),
        }
    }

    /// Returns the object's place, if it is there and has one.
    pub(crate) fn place(&self, object: ObjectId) -> Option<&ObjectPose> {
        self.entry(object).and_then(|place| place.pose.as_ref())
    }

    /// Returns whether there is an object of that number, with or without a place.
    pub(crate) fn has(&self, object: ObjectId) -> bool {
        self.entry(object).is_some()
    }

    /// Returns whether the object was looked for in vain.
    pub(crate) fn is_gone(&self, object: ObjectId) -> bool {
        self.entry(object).is_some_and(|place| place.gone)
    }

    /// Returns whether the object is farther from where it is in `other` than a grasp forgives.
    pub(crate) fn has_moved(&self, object: ObjectId, other: &Self) -> bool {
        let (Some(here), Some(there)) = (self.place(object), other.place(object)) else {
            return false;
        };
        let turned = (here.isometry().rotation.inverse() * there.isometry().rotation).angle();
        distance(here, there) > FORGIVEN.0 || turned > FORGIVEN.1
    }

    /// Returns whether a plan made in `other` holds here: the same objects, each where it was.
    pub(crate) fn fits(&self, other: &Self) -> bool {
        let same = |(a, b): (&Place, &Place)| match (&a.pose, &b.pose) {
            (Some(here), Some(there)) => distance(here, there) <= PLANNED_M,
            (None, None) => true,
            _ => false,
        };
        self.table == other.table
            && self.places.len() == other.places.len()
            && self.places.iter().zip(&other.places).all(same)
    }

    /// Returns the objects that stand in their places, except one.
    pub(crate) fn standing(
        &self,
        state: &ArmState,
        except: Option<ObjectId>,
    ) -> impl Iterator<Item = &ObjectPose> {
        let held = state.held.map(|held| held.object);
        self.places.iter().filter_map(move |place| {
            let object = place.number;
            let away = place.taken || state.gone.contains(&object) || held == Some(object);
            place.pose.as_ref().filter(|_| !away && except != Some(object))
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
        let fingers = &self.robot.arm(limb).gripper;
        let in_gripper = self.place(object)?.in_gripper(&self.gripper(limb, measured), fingers);
        Some(Held { object, limb, in_gripper: to_array(&in_gripper) })
    }

    /// Returns `held` where its gripper is now, as what a user may hold there.
    pub(crate) fn offered(&self, held: &Held, measured: &Measured) -> Offered {
        let Held { object, limb, in_gripper } = *held;
        let pose = self.gripper(limb, measured) * from_array(&in_gripper);
        Offered { object, limb, pose: to_array(&pose) }
    }

    /// Returns the pose of a gripper's tip in frame `base`.
    pub(crate) fn gripper(&self, limb: Limb, measured: &Measured) -> Isometry3<f64> {
        self.robot.arm(limb).chain.forward(&measured.posture.joints[limb])
    }

    /// Returns the world view for clients.
    pub(crate) fn view(&self, state: &ArmState, measured: &Measured, now: Time) -> WorldView {
        let grippers = Limb::BOTH.map(|limb| self.gripper(limb, measured));
        let pose = |place: &Place| {
            let pose = place.pose.as_ref().filter(|_| !place.taken);
            pose.map(|pose| to_array(&pose.isometry()))
        };
        let mut objects: Vec<Option<[f64; 7]>> = self.places.iter().map(pose).collect();
        let mut put = |object: ObjectId, pose| {
            let entry = self.places.iter().position(|place| place.number == object);
            if let Some(entry) = entry {
                objects[entry] = pose;
            }
        };
        state.gone.iter().for_each(|object| put(*object, None));
        if let Some(held) = &state.held {
            let pose = grippers[held.limb] * from_array(&held.in_gripper);
            put(held.object, Some(to_array(&pose)));
        }
        let numbers = self.places.iter().map(|place| place.number);
        WorldView {
            at_ns: now.ns(),
            objects,
            numbers: self.table.map_or_else(Vec::new, |_| numbers.collect()),
            held: state.held.map(|held| held.object.0),
            grippers: grippers.map(|gripper| to_array(&gripper)),
        }
    }
}

fn distance(a: &ObjectPose, b: &ObjectPose) -> f64 {
    let axes = a.xyz_m.iter().zip(b.xyz_m);
    axes.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
