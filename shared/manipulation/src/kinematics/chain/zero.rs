//! A limb in its zero posture: all that its kinematics depend on.

use nalgebra::{Isometry3, Vector3};

/// The seven joint axes and the tool at zero joint positions, in `base`. Any limb
/// of seven turning joints is described by this, whatever frames its description gives its links
/// (the product of exponentials, Brockett 1984).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ZeroPosture {
    /// The axes, from the shoulder to the wrist. Where there are fewer, the last is repeated.
    pub(crate) axes: [Axis; 7],
    /// Number of joints: five to seven.
    pub(crate) joints: usize,
    /// Pose of the tool frame, `<limb>_gripper`.
    pub(crate) tool: Isometry3<f64>,
}

/// The axis of a turning joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    /// Any point on it, metres.
    pub(crate) point: Vector3<f64>,
    /// Its direction, of unit length: the joint turns about it by the right hand's rule.
    pub(crate) direction: Vector3<f64>,
}

impl Axis {
    /// Returns the point of the axis that is nearest to `p`.
    pub(crate) fn foot(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.point + self.direction * self.direction.dot(&(p - self.point))
    }

    /// Returns the point where two axes at right angles meet, if they do so to within `within_m`.
    pub(crate) fn meets(&self, other: &Self, within_m: f64) -> Option<Vector3<f64>> {
        // At right angles the other's foot on this one is found along this direction alone.
        let here = self.foot(&other.point);
        let there = other.foot(&here);
        ((here - there).norm() < within_m).then_some((here + there) * 0.5)
    }
}
