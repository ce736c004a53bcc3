//! Forward kinematics of the whole tree.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use crate::model::{Joint, JointKind, Robot};

impl Robot {
    /// The pose of every link in the root's frame, in the order of [`Robot::links`]; quaternions
    /// have w ≥ 0.
    ///
    /// `positions` is called for the driven joints, in radians or metres; limits are ignored. Mimic
    /// joints follow.
    pub fn poses(&self, positions: impl Fn(&Joint) -> f64) -> Vec<Isometry3<f64>> {
        let mut poses = Vec::with_capacity(self.links.len());
        poses.push(Isometry3::identity());
        for joint in &self.joints {
            let position = self.position(joint, &positions);
            poses.push(positive(poses[joint.parent] * joint.child_pose(position)));
        }
        poses
    }

    /// Returns the position of any joint, given those of the driven joints; 0 for a fixed one.
    pub fn position(&self, joint: &Joint, positions: impl Fn(&Joint) -> f64) -> f64 {
        match (joint.kind, joint.mimic) {
            (JointKind::Fixed, _) => 0.0,
            (_, None) => positions(joint),
            (_, Some(rule)) => rule.multiplier * positions(&self.joints[rule.joint]) + rule.offset,
        }
    }
}

impl Joint {
    /// The child's frame in the parent's at a position (radians or metres).
    pub fn child_pose(&self, position: f64) -> Isometry3<f64> {
        match self.kind {
            JointKind::Fixed => self.origin,
            JointKind::Revolute | JointKind::Continuous => {
                self.origin * UnitQuaternion::from_axis_angle(&self.axis, position)
            }
            JointKind::Prismatic => {
                self.origin * Translation3::from(self.axis.into_inner() * position)
            }
        }
    }
}

/// The same pose with a quaternion of w ≥ 0.
pub(crate) fn positive(mut pose: Isometry3<f64>) -> Isometry3<f64> {
    if pose.rotation.w < 0.0 {
        pose.rotation = UnitQuaternion::new_unchecked(-pose.rotation.into_inner());
    }
    pose
}
