//! Forward kinematics of the whole tree, and of the way from the root to one link.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use crate::model::{Joint, JointKind, Link, Robot};

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

    /// The limbs: what stands before `_gripper` in the names of links. A finger slides, and is the end of no limb,
    /// whatever its name.
    pub fn limb_ends(&self) -> impl Iterator<Item = &str> {
        let links = self.links().iter().enumerate();
        let slides = |link| self.carrier(link).is_some_and(|it| it.kind == JointKind::Prismatic);
        links.filter_map(move |(i, link)| link.name.strip_suffix("_gripper").filter(|_| !slides(i)))
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

    /// Pose of the tip in the root's frame; the quaternion has w ≥ 0.
    ///
    /// # Panics
    /// If `q` has not one position (radians or metres) per movable joint.
    pub fn forward(&self, q: &[f64]) -> Isometry3<f64> {
        let steps = self.joints().map(|joint| joint.child_pose(self.position(joint, q)));
        positive(steps.fold(Isometry3::identity(), |pose, step| pose * step))
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
    fn position(&self, joint: &Joint, positions: impl Fn(&Joint) -> f64) -> f64 {
        match (joint.kind, joint.mimic) {
            (JointKind::Fixed, _) => 0.0,
            (_, None) => positions(joint),
            (_, Some(rule)) => rule.multiplier * positions(&self.joints[rule.joint]) + rule.offset,
        }
    }
}

impl Joint {
    /// The child's frame in the parent's at a position (radians or metres).
    fn child_pose(&self, position: f64) -> Isometry3<f64> {
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
fn positive(mut pose: Isometry3<f64>) -> Isometry3<f64> {
    if pose.rotation.w < 0.0 {
        pose.rotation = UnitQuaternion::new_unchecked(-pose.rotation.into_inner());
    }
    pose
}
