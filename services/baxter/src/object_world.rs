//! The objects around the robot: their locations, and grasps.

use crate::camera::Standing;
use manipulation::gripper::{self, Gripper};
use manipulation::pose_array::{from_array, to_array};
use manipulation::{Limb, ObjectPose};
use nalgebra::Isometry3;
use scene::Scene;
use serde::{Deserialize, Serialize};

/// Tolerance of the fingertips' position along the fingers' width and length,
/// metres, and still be at the object.
const BESIDE_M: [f64; 2] = [0.012, 0.02];
/// An object released higher than this above its place is taken by a person, metres.
const HANDED_OVER_M: f64 = 0.05;
/// Distance from where it was handed over within which a person gives an object back, metres.
const GIVEN_BACK_M: f64 = 0.05;

/// A place on the table: centre in `base`, metres, and rotation about the vertical, radians.
pub type Place = [f64; 4];

/// Location of one object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Whereabouts {
    /// It stands there.
    Stands(Place),
    /// In a gripper.
    Held {
        /// Left 0 or right 1.
        limb: u8,
        /// Where it was grasped.
        from: Place,
        /// Its pose in the frame of the gripper's tip, see [`to_array`].
        in_gripper: [f64; 7],
    },
    /// A person was handed it; it stood there before.
    Handed(Place),
    /// It is not on the table.
    Away,
}

/// The objects.
#[derive(Clone, Debug)]
pub struct ObjectWorld {
    /// Shapes and initial positions; none for an object without one, which is never there.
    shapes: Vec<Option<ObjectPose>>,
    /// Locations of the objects.
    pub now: Vec<Whereabouts>,
    /// The object that was handed over last; none for the others.
    pub handed_over: Vec<Option<HandedOver>>,
}

/// How an object was handed over: a person gives it back in the same way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HandedOver {
    /// Where the gripper's tip was, metres.
    xyz: [f64; 3],
    /// Pose of the object in the frame of the tip, see [`to_array`].
    in_gripper: [f64; 7],
}

impl HandedOver {
    fn is_at(&self, tip: &Isometry3<f64>) -> bool {
        (tip.translation.vector - nalgebra::Vector3::from(self.xyz)).norm() < GIVEN_BACK_M
    }
}

impl ObjectWorld {
    /// Returns the scene's objects in their places.
    pub fn new(scene: &Scene) -> Self {
        let shapes: Vec<_> =
            scene.objects().iter().map(|o| o.placement.as_ref().map(preflight::pose)).collect();
        let stands = |shape: &Option<ObjectPose>| match shape {
            Some(ObjectPose { xyz_m: [x, y, z], yaw_rad, .. }) => {
                Whereabouts::Stands([*x, *y, *z, *yaw_rad])
            }
            None => Whereabouts::Away,
        };
        let handed_over = vec![None; shapes.len()];
        Self { now: shapes.iter().map(stands).collect(), handed_over, shapes }
    }

    /// Returns the objects on the table.
    pub fn standing(&self) -> Vec<Standing> {
        let stands = |(object, now): (usize, &Whereabouts)| match *now {
            Whereabouts::Stands([x, y, z, yaw]) => Some(Standing { object, xyz: [x, y, z], yaw }),
            _ => None,
        };
        self.now.iter().enumerate().filter_map(stands).collect()
    }

    /// Returns the object between the `fingers` of a gripper that are `opening_m` apart at `tip`, with its width: one
    /// that stands `offset_m` beside its place across the fingers, or one that a person gives back.
    pub fn between(
        &self,
        tip: &Isometry3<f64>,
        fingers: &Gripper,
        opening_m: f64,
        offset_m: f64,
    ) -> Option<(usize, f64)> {
        let stands = self.standing().into_iter().find_map(|Standing { object, xyz, yaw }| {
            let shape = at(&self.shapes[object]?, [xyz[0], xyz[1], xyz[2], yaw]);
            let caught = shape.grasps(fingers).ok()?.into_iter().any(|grasp| {
                let beside = (grasp.gripper.inverse() * tip).translation.vector;
                let along = beside.x.abs() < BESIDE_M[0] && beside.z.abs() < BESIDE_M[1];
                along && gripper::catches(opening_m, shape.grasp_width_m, beside.y + offset_m)
            });
            caught.then_some((object, shape.grasp_width_m))
        });
        stands.or_else(|| self.given_back(tip, opening_m, offset_m))
    }

    /// Returns the object that was handed over last at `tip`: the person holds it there as it was.
    fn given_back(
        &self,
        tip: &Isometry3<f64>,
        opening_m: f64,
        offset_m: f64,
    ) -> Option<(usize, f64)> {
        let is_there = |it: &Option<HandedOver>| it.is_some_and(|it| it.is_at(tip));
        let i = self.handed_over.iter().position(is_there)?;
        let width_m = self.shapes[i]?.grasp_width_m;
        let is_held = matches!(self.now[i], Whereabouts::Held { .. });
        (!is_held && gripper::catches(opening_m, width_m, offset_m)).then_some((i, width_m))
    }

    /// A limb with its gripper at `tip` has taken hold of the object.
    pub fn take(&mut self, object: usize, limb: Limb, tip: &Isometry3<f64>) {
        let (Some(shape), Some(from)) = (self.shapes[object], self.place(object)) else { return };
        let in_gripper = match self.handed_over[object].filter(|it| it.is_at(tip)) {
            Some(given_back) => given_back.in_gripper,
            None => to_array(&(tip.inverse() * at(&shape, from).isometry())),
        };
        self.now[object] = Whereabouts::Held { limb: limb as u8, from, in_gripper };
    }

    /// A limb with its gripper at `tip` lets go: a person takes what is held up, and what is not
    /// stands where the gripper has brought it.
    pub fn let_go(&mut self, limb: Limb, tip: &Isometry3<f64>) {
        let Some(object) = self.held(limb) else { return };
        let Whereabouts::Held { from, in_gripper, .. } = self.now[object] else { return };
        let Some(shape) = self.shapes[object] else { return };
        let is_held_up = tip.translation.z > at(&shape, from).top_z_m() + HANDED_OVER_M;
        self.handed_over[object] = None;
        if is_held_up {
            // A person holds out what was handed over last.
            self.handed_over.fill(None);
            let xyz = tip.translation.vector.into();
            self.handed_over[object] = Some(HandedOver { xyz, in_gripper });
            self.now[object] = Whereabouts::Handed(from);
        } else {
            let here = tip * from_array(&in_gripper);
            let (place, yaw) = (here.translation, here.rotation.euler_angles().2);
            self.now[object] = Whereabouts::Stands([place.x, place.y, from[2], yaw]);
        }
    }

    /// Users put back the objects that they were handed.
    pub fn restock(&mut self) {
        for now in &mut self.now {
            if let Whereabouts::Handed(place) = *now {
                *now = Whereabouts::Stands(place);
            }
        }
    }

    /// A person puts the object there.
    ///
    /// # Errors
    /// Why it cannot be put there.
    pub fn put(&mut self, object: usize, place: Place) -> Result<(), &'static str> {
        self.move_by_hand(object, Whereabouts::Stands(place))
    }

    /// A person takes the object off the table.
    ///
    /// # Errors
    /// Why it cannot be taken.
    pub fn remove(&mut self, object: usize) -> Result<(), &'static str> {
        self.move_by_hand(object, Whereabouts::Away)
    }

    fn move_by_hand(&mut self, object: usize, to: Whereabouts) -> Result<(), &'static str> {
        match self.now.get(object) {
            None => return Err("the scene has no such object"),
            Some(Whereabouts::Held { .. }) => return Err("it is in a gripper"),
            Some(_) if self.shapes[object].is_none() => return Err("it has no size and place"),
            Some(_) => {}
        }
        self.now[object] = to;
        self.handed_over[object] = None;
        Ok(())
    }

    /// Returns the object that a limb holds.
    pub fn held(&self, limb: Limb) -> Option<usize> {
        let holds = |now: &Whereabouts| matches!(now, Whereabouts::Held { limb: by, .. } if *by == limb as u8);
        self.now.iter().position(holds)
    }

    /// Returns where an object stands, or stood before it was grasped.
    fn place(&self, object: usize) -> Option<Place> {
        match self.now[object] {
            Whereabouts::Stands(place) | Whereabouts::Handed(place) => Some(place),
            Whereabouts::Held { from, .. } => Some(from),
            Whereabouts::Away => None,
        }
    }
}

/// The object in another place.
fn at(shape: &ObjectPose, [x, y, z, yaw_rad]: Place) -> ObjectPose {
    ObjectPose { xyz_m: [x, y, z], yaw_rad, ..*shape }
}
