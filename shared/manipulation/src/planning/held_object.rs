//! Collision shape of the held object.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::collision::block::Block;
use crate::collision::{ArmShape, Gap};
use crate::robot::Arm;

use super::Obstacle;
use super::grasp::ObjectPose;

/// A box that is fixed in the gripper, from where it stood.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    half: Vector3<f64>,
    in_gripper: Isometry3<f64>,
    /// Its place before the grasp, metres.
    stood: Vector3<f64>,
    /// Obstacles with their distances from that place, metres: 0 for its support.
    surroundings: Vec<(Obstacle, f64)>,
}

/// Its name in errors.
const NAME: &str = "held object";

/// Distance that it keeps from the surroundings, metres.
const APART_M: f64 = 0.003;

/// Largest approach, while lifted, to an obstacle within the margin of its place, metres.
const SLACK_M: f64 = 5e-4;

/// Largest horizontal distance of its centre from its place that counts as over it, metres.
const BESIDE_M: f64 = 0.005;

impl Held {
    /// `object` as it stands among `surroundings`, held at `in_gripper`.
    pub(crate) fn new(
        object: &ObjectPose,
        in_gripper: &Isometry3<f64>,
        surroundings: Vec<Obstacle>,
    ) -> Self {
        let half = Vector3::from(object.size_m) * 0.5;
        let stands = Block { pose: object.isometry(), half };
        let apart = |obstacle: Obstacle| (obstacle, stands.to_cuboid(&obstacle.1));
        let surroundings = surroundings.into_iter().map(apart).collect();
        Self { half, in_gripper: *in_gripper, stood: stands.centre(), surroundings }
    }

    /// Returns the box with the gripper at `gripper`.
    pub(crate) fn block(&self, gripper: &Isometry3<f64>) -> Block {
        Block { pose: gripper * self.in_gripper, half: self.half }
    }

    /// Returns the gripper's rotation at which the box stands upright, turned as with the gripper
    /// at `pose`.
    pub(crate) fn upright(&self, pose: &Isometry3<f64>) -> UnitQuaternion<f64> {
        let along = pose.rotation * self.in_gripper.rotation * Vector3::x();
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), along.y.atan2(along.x));
        yaw * self.in_gripper.rotation.inverse()
    }

    /// Returns the first of the surroundings that the box comes too near to; `moved_m` is how far
    /// it moves until the next check.
    pub(crate) fn near_surroundings(&self, block: &Block, moved_m: f64) -> Option<Gap> {
        let beside = (block.centre() - self.stood).xy().norm();
        let margin_m = APART_M + 0.5 * moved_m;
        self.surroundings.iter().find_map(|((name, cuboid), apart)| {
            // Straight up from where it stood it may leave what it touched there.
            let least = if beside < BESIDE_M { margin_m.min(apart - SLACK_M) } else { margin_m };
            let distance_m = block.to_cuboid(cuboid);
            (distance_m < least).then_some(Gap { distance_m, link: NAME, other: name })
        })
    }

    /// Returns the first part of the robot that the box comes nearer to than `margin_m`: its body,
    /// the other arm, and the links of the arm that holds it before the wrist, which may touch it.
    pub(crate) fn near_robot(
        &self,
        block: &Block,
        (arm, own): (&Arm, &ArmShape<'_>),
        other: Option<(&Arm, &ArmShape<'_>)>,
        margin_m: f64,
    ) -> Option<Gap> {
        let near = |distance_m: f64, name: &'static str| {
            (distance_m < margin_m).then_some(Gap { distance_m, link: NAME, other: name })
        };
        let body = &arm.body;
        let links = |arm: &Arm, shape: &ArmShape<'_>, last: usize| {
            let capsules = arm.enclosures.iter().zip(shape.capsules());
            let moved = capsules.filter(|(enclosure, _)| enclosure.joint < last);
            moved.map(|(e, capsule)| (e.link, *capsule)).collect::<Vec<_>>()
        };
        let own = links(arm, own, arm.wrist());
        let theirs =
            other.map_or_else(Vec::new, |(other, theirs)| links(other, theirs, usize::MAX));
        let cuboids = body.cuboids.iter();
        cuboids
            .map(|(name, cuboid)| (block.to_cuboid(cuboid), *name))
            .chain(
                body.capsules
                    .iter()
                    .chain(&own)
                    .chain(&theirs)
                    .map(|(name, capsule)| (block.to_capsule(capsule), *name)),
            )
            .find_map(|(distance_m, name)| near(distance_m, name))
    }
}
