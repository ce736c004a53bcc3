//! The way from the root to one link: its joints, forward kinematics and Jacobian.

use nalgebra::{DMatrix, Isometry3, Matrix6xX, Vector3};

use crate::model::{Joint, JointKind, Link, Robot};
use crate::poses::positive;

/// Rows v_x v_y v_z w_x w_y w_z: velocity of the tip's origin in m/s and angular velocity in rad/s
/// per unit of a joint's velocity, axes of the root. One column per movable joint.
pub type Jacobian = Matrix6xX<f64>;

/// A link that the robot does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("robot {robot:?} has no link {link:?}")]
pub struct UnknownLink {
    /// The robot's name.
    pub robot: String,
    /// The name that was asked for.
    pub link: String,
}

/// The joints from the root to a link.
#[derive(Clone, Debug)]
pub struct SerialChain<'a> {
    robot: &'a Robot,
    /// Every joint, root first.
    joints: Vec<usize>,
    /// The joints that determine the tip's pose: the driven ones on the way, and those that drive a
    /// joint on the way; in the order of the way.
    movable: Vec<usize>,
}

impl Robot {
    /// The chain from the root to the link `tip`.
    ///
    /// # Errors
    /// [`UnknownLink`] if the robot has no such link.
    pub fn chain(&self, tip: &str) -> Result<SerialChain<'_>, UnknownLink> {
        let mut at = self
            .link_index(tip)
            .ok_or_else(|| UnknownLink { robot: self.name.clone(), link: tip.to_owned() })?;
        let mut joints = Vec::new();
        while let Some(joint) = at.checked_sub(1) {
            joints.push(joint);
            at = self.joints[joint].parent;
        }
        joints.reverse();
        let mut movable = Vec::new();
        for &joint in &joints {
            let found = &self.joints[joint];
            let by = found.mimic.map_or(joint, |rule| rule.joint);
            if found.kind != JointKind::Fixed && !movable.contains(&by) {
                movable.push(by);
            }
        }
        Ok(SerialChain { robot: self, joints, movable })
    }
}

impl<'a> SerialChain<'a> {
    /// Every joint, fixed ones too, from the root to the tip.
    pub fn joints(&self) -> impl DoubleEndedIterator<Item = &'a Joint> + ExactSizeIterator {
        let robot = self.robot;
        self.joints.clone().into_iter().map(move |joint| &robot.joints[joint])
    }

    /// The joints that decide where the tip is, from the root to the tip: the order of all joint
    /// positions below.
    pub fn movable(&self) -> impl DoubleEndedIterator<Item = &'a Joint> + ExactSizeIterator {
        let robot = self.robot;
        self.movable.clone().into_iter().map(move |joint| &robot.joints[joint])
    }

    /// Every link on the way, the root first and the tip last.
    pub fn links(&self) -> impl Iterator<Item = &'a Link> {
        let robot = self.robot;
        std::iter::once(robot.root()).chain(self.joints().map(|joint| &robot.links[joint.child]))
    }

    /// The last link.
    pub fn tip(&self) -> &'a Link {
        self.joints.last().map_or(self.robot.root(), |&joint| &self.robot.links[joint + 1])
    }

    /// Pose in the root's frame of every link of [`SerialChain::links`]; quaternions have w ≥ 0.
    ///
    /// # Panics
    /// If `q` has not one position (radians or metres) per movable joint.
    pub fn poses(&self, q: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses = Vec::with_capacity(self.joints.len() + 1);
        let mut pose = Isometry3::identity();
        poses.push(pose);
        for joint in self.joints() {
            pose = positive(pose * joint.child_pose(self.position(joint, q)));
            poses.push(pose);
        }
        poses
    }

    /// Pose of the tip in the root's frame; the quaternion has w ≥ 0.
    ///
    /// # Panics
    /// As [`SerialChain::poses`].
    pub fn forward(&self, q: &[f64]) -> Isometry3<f64> {
        let steps = self.joints().map(|joint| joint.child_pose(self.position(joint, q)));
        positive(steps.fold(Isometry3::identity(), |pose, step| pose * step))
    }

    /// Geometric Jacobian of the tip at `q`.
    ///
    /// # Panics
    /// As [`SerialChain::poses`].
    pub fn jacobian(&self, q: &[f64]) -> Jacobian {
        let poses = self.poses(q);
        let tip = poses[self.joints.len()].translation.vector;
        let mut jacobian = Jacobian::zeros(self.movable.len());
        for ((&index, joint), pose) in self.joints.iter().zip(self.joints()).zip(&poses[1..]) {
            let (by, factor) = joint.mimic.map_or((index, 1.0), |m| (m.joint, m.multiplier));
            // A fixed joint has no column.
            let Some(column) = self.movable.iter().position(|&movable| movable == by) else {
                continue;
            };
            let axis = pose.rotation * joint.axis.into_inner() * factor;
            let (linear, angular) = match joint.kind {
                JointKind::Fixed => continue,
                JointKind::Prismatic => (axis, Vector3::zeros()),
                JointKind::Revolute | JointKind::Continuous => {
                    (axis.cross(&(tip - pose.translation.vector)), axis)
                }
            };
            let mut linear_part = jacobian.fixed_view_mut::<3, 1>(0, column);
            linear_part += linear;
            let mut angular_part = jacobian.fixed_view_mut::<3, 1>(3, column);
            angular_part += angular;
        }
        jacobian
    }

    /// Manipulability `√det(J Jᵀ)` at `q` (Yoshikawa 1985); 0 where the chain loses a direction.
    /// With fewer than six movable joints it is `√det(Jᵀ J)`, the volume that they span.
    ///
    /// # Panics
    /// As [`SerialChain::poses`].
    pub fn manipulability(&self, q: &[f64]) -> f64 {
        let jacobian = self.jacobian(q);
        let gram: DMatrix<f64> = if jacobian.ncols() < 6 {
            let j = DMatrix::from_column_slice(6, jacobian.ncols(), jacobian.as_slice());
            j.transpose() * j
        } else {
            let square = &jacobian * jacobian.transpose();
            DMatrix::from_column_slice(6, 6, square.as_slice())
        };
        gram.determinant().max(0.0).sqrt()
    }

    fn position(&self, joint: &Joint, q: &[f64]) -> f64 {
        assert_eq!(q.len(), self.movable.len(), "one position per movable joint");
        self.robot.position(joint, |asked| {
            // Only joints in `movable` are asked for; a joint carries the link after it.
            let place = self.movable.iter().position(|&m| m + 1 == asked.child);
            place.map_or(0.0, |place| q[place])
        })
    }
}
