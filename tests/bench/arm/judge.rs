//! Validity of an answer.

use super::arm;
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use robot_model::{Robot, SerialChain};

/// Tolerances of an answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// Greatest distance in metres and angle in radians.
    tolerance: f64,
    /// Tolerance of the joint limits, radians.
    beyond: f64,
}

impl Rule {
    /// For this project's solver: 1e-6 (and what two ways to compute a pose differ by), the limits
    /// to the last bit.
    pub(super) const OWN: Self = Self { tolerance: 1e-6 + 1e-12, beyond: 0.0 };
    /// For peers, which are configured to stop at 1e-5: twice that, and limits to 1e-6, for some keep
    /// them in single precision.
    pub(super) const PEER: Self = Self { tolerance: 2e-5, beyond: 1e-6 };
}

/// Judges by the description's own chains.
#[derive(Debug)]
pub(super) struct Judge {
    left: SerialChain<'static>,
    right: SerialChain<'static>,
}

impl Judge {
    pub(super) fn new() -> Self {
        let chain = |limb| {
            let tip = format!("{limb}_gripper");
            Robot::baxter().chain(&tip).unwrap_or_else(|error| panic!("{error}"))
        };
        Self { left: chain(Limb::Left), right: chain(Limb::Right) }
    }

    pub(super) fn accepts(
        &self,
        limb: Limb,
        pose: &Isometry3<f64>,
        q: &Joints,
        rule: Rule,
    ) -> bool {
        let chain = match limb {
            Limb::Left => &self.left,
            Limb::Right => &self.right,
        };
        let reached = chain.forward(q);
        let distance = (reached.translation.vector - pose.translation.vector).norm();
        let angle = reached.rotation.angle_to(&pose.rotation);
        let limits = &arm(limb).limits.position.0;
        let kept = q
            .iter()
            .zip(limits)
            .all(|(q, (lower, upper))| (lower - rule.beyond..=upper + rule.beyond).contains(q));
        kept && distance <= rule.tolerance && angle <= rule.tolerance
    }
}

/// Euclidean distance of two postures, radians.
pub(super) fn apart(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
