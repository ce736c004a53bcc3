//! Poses to reach, where the solvers begin, and validity of their answers.

use super::arm;
use dialogue::Rng;
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use robot_model::{Robot, SerialChain};

/// A pose of `<limb>_gripper` in `base`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) limb: Limb,
    pub(super) pose: Isometry3<f64>,
    /// A random posture to begin from, radians.
    pub(super) seed: Joints,
}

/// The middle of the limits: the other posture to begin from.
pub(super) fn middle(limb: Limb) -> Joints {
    arm(limb).limits.position.middle()
}

/// The limbs' chains by the description, left first.
fn chains() -> [SerialChain<'static>; 2] {
    Limb::BOTH.map(|limb| {
        let tip = format!("{limb}_gripper");
        Robot::baxter().chain(&tip).unwrap_or_else(|error| panic!("{error}"))
    })
}

/// Forward kinematics of random postures, so that there is an answer; left and right in turn.
pub(super) fn reachable(count: usize) -> Vec<Target> {
    let (mut rng, chains) = (Rng::new(2026), chains());
    (0..count)
        .map(|i| {
            let limb = Limb::BOTH[i % 2];
            let pose = chains[i % 2].forward(&posture(limb, &mut rng));
            Target { limb, pose, seed: posture(limb, &mut rng) }
        })
        .collect()
}

/// Postures of one limb.
pub(super) fn postures(limb: Limb, count: usize) -> Vec<Joints> {
    let mut rng = Rng::new(7);
    (0..count).map(|_| posture(limb, &mut rng)).collect()
}

/// A posture uniform within the limits.
pub(super) fn posture(limb: Limb, rng: &mut Rng) -> Joints {
    arm(limb).limits.position.0.map(|ends| rng.between(ends))
}

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
pub(super) struct Judge([SerialChain<'static>; 2]);

impl Judge {
    pub(super) fn new() -> Self {
        Self(chains())
    }

    pub(super) fn accepts(&self, target: &Target, q: &Joints, rule: Rule) -> bool {
        let Target { limb, pose, .. } = target;
        let reached = self.0[usize::from(*limb == Limb::Right)].forward(q);
        let distance = (reached.translation.vector - pose.translation.vector).norm();
        let angle = reached.rotation.angle_to(&pose.rotation);
        let limits = &arm(*limb).limits.position.0;
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
