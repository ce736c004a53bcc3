//! The objects around the robot: their locations, and grasps.

use manipulation::gripper::{self, Gripper};
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

/// Location of one object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Whereabouts {
    /// It stands: centre in `base`, metres.
    Stands([f64; 3]),
    /// In a gripper, left 0 or right 1.
    Held(u8),
    /// A person has it.
    Gone,
}

/// The objects.
#[derive(Clone, Debug)]
pub struct ObjectWorld {
    /// Initial positions; none for an object without one.
    places: Vec<Option<ObjectPose>>,
    /// Locations of the objects.
    pub now: Vec<Whereabouts>,
    /// Where the object that was handed over last was let go, metres: a person gives it back there.
    /// None for the others.
    pub handed_over: Vec<Option<[f64; 3]>>,
}

impl ObjectWorld {
    /// Returns the scene's objects in their places.
    pub fn new(scene: &Scene) -> Self {
        let places: Vec<_> =
            scene.objects().iter().map(|o| o.placement.as_ref().map(preflight::pose)).collect();
        let stands = |place: &Option<ObjectPose>| match place {
            Some(place) => Whereabouts::Stands(place.xyz_m),
            None => Whereabouts::Gone,
        };
        let handed_over = vec![None; places.len()];
        Self { now: places.iter().map(stands).collect(), handed_over, places }
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
        let standing = self.places.iter().zip(&self.now).enumerate();
        let stands = standing.into_iter().find_map(|(i, (place, now))| {
            let Whereabouts::Stands(xyz_m) = *now else { return None };
            let object = ObjectPose { xyz_m, ..(*place)? };
            let at = object.grasps(fingers).ok()?.into_iter().any(|grasp| {
                let beside = (grasp.gripper.inverse() * tip).translation.vector;
                let along = beside.x.abs() < BESIDE_M[0] && beside.z.abs() < BESIDE_M[1];
                along && gripper::catches(opening_m, object.grasp_width_m, beside.y + offset_m)
            });
            at.then_some((i, object.grasp_width_m))
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
        let is_there = |place: &[f64; 3]| {
            (tip.translation.vector - nalgebra::Vector3::from(*place)).norm() < GIVEN_BACK_M
        };
        let i = self.handed_over.iter().position(|place| place.as_ref().is_some_and(is_there))?;
        let width_m = self.places[i]?.grasp_width_m;
        let is_held = matches!(self.now[i], Whereabouts::Held(_));
        (!is_held && gripper::catches(opening_m, width_m, offset_m)).then_some((i, width_m))
    }

    /// A limb has taken hold of the object.
    pub fn take(&mut self, object: usize, limb: Limb) {
        self.now[object] = Whereabouts::Held(limb as u8);
    }

    /// A limb with its gripper at `tip` lets go: a person takes what is held up, and what is not
    /// stands below the gripper.
    pub fn let_go(&mut self, limb: Limb, tip: &Isometry3<f64>) {
        let Some(object) = self.held(limb) else { return };
        let Some(place) = self.places[object] else { return };
        let is_held_up = tip.translation.z > place.top_z_m() + HANDED_OVER_M;
        self.now[object] =
            if is_held_up { Whereabouts::Gone } else { Whereabouts::Stands(place.xyz_m) };
        if is_held_up {
            // A person holds out what was handed over last.
            self.handed_over.fill(None);
        }
        self.handed_over[object] = is_held_up.then(|| tip.translation.vector.into());
    }

    /// Users put back the objects that they were handed.
    pub fn restock(&mut self) {
        for (now, place) in self.now.iter_mut().zip(&self.places) {
            if let (Whereabouts::Gone, Some(place)) = (*now, place) {
                *now = Whereabouts::Stands(place.xyz_m);
            }
        }
    }

    /// Returns the object that a limb holds.
    pub fn held(&self, limb: Limb) -> Option<usize> {
        self.now.iter().position(|now| *now == Whereabouts::Held(limb as u8))
    }
}

/// Position and quaternion of a pose: x, y, z, x, y, z, w.
pub fn to_array(pose: &Isometry3<f64>) -> [f64; 7] {
    let (p, r) = (pose.translation, pose.rotation);
    [p.x, p.y, p.z, r.i, r.j, r.k, r.w]
}
