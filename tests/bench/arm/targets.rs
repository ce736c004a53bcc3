//! Poses to reach, where the solvers begin, and validity of their answers.

use super::subject::Subject;
use manipulation::{Joints, Limb};
use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use robot_model::SerialChain;
use vocabulary::Rng;

/// A pose of a limb's gripper in `base`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) limb: Limb,
    pub(super) pose: Isometry3<f64>,
    /// A random posture to begin from, radians.
    pub(super) seed: Joints,
}

/// Forward kinematics of random postures, so that there is an answer; the limbs in turn.
pub(super) fn reachable(subject: &Subject, count: usize) -> Vec<Target> {
    let mut rng = Rng::new(2026);
    let chains: Vec<_> = subject.limbs().iter().map(|limb| subject.chain(*limb)).collect();
    let limbs = subject.limbs().iter().zip(&chains).cycle().take(count);
    limbs
        .map(|(&limb, chain)| {
            let q = subject.posture(limb, &mut rng);
            let pose = chain.forward(subject.moving(limb, &q));
            Target { limb, pose, seed: subject.posture(limb, &mut rng) }
        })
        .collect()
}

/// Poses uniform in the box round the reachable ones, turned anyhow: some are out of reach.
pub(super) fn anywhere(reachable: &[Target], count: usize) -> Vec<Target> {
    let mut rng = Rng::new(404);
    let boxes = [Limb::Left, Limb::Right, Limb::Only].map(|limb| bounds(reachable, limb));
    let pose = |target: &Target| {
        let (low, high) = boxes[target.limb as usize];
        let place = Vector3::from_fn(|i, _| rng.between((low[i], high[i])));
        let turn = Quaternion::new(rng.normal(), rng.normal(), rng.normal(), rng.normal());
        let pose = Isometry3::from_parts(place.into(), UnitQuaternion::new_normalize(turn));
        Target { pose, ..*target }
    };
    reachable[..count].iter().map(pose).collect()
}

/// The least and the greatest coordinates of a limb's targets, metres.
fn bounds(targets: &[Target], limb: Limb) -> (Vector3<f64>, Vector3<f64>) {
    let places = targets.iter().filter(|target| target.limb == limb);
    let places = places.map(|target| target.pose.translation.vector);
    let none = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    places.fold(none, |(low, high), place| (low.inf(&place), high.sup(&place)))
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
pub(super) struct Judge<'a> {
    subject: &'a Subject,
    chains: Vec<(Limb, SerialChain<'a>)>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(subject: &'a Subject) -> Self {
        let chains = subject.limbs().iter().map(|limb| (*limb, subject.chain(*limb))).collect();
        Self { subject, chains }
    }

    pub(super) fn accepts(&self, target: &Target, q: &Joints, rule: Rule) -> bool {
        let Target { limb, pose, .. } = target;
        let Some((_, chain)) = self.chains.iter().find(|(of, _)| of == limb) else { return false };
        let reached = chain.forward(self.subject.moving(*limb, q));
        let distance = (reached.translation.vector - pose.translation.vector).norm();
        let angle = reached.rotation.angle_to(&pose.rotation);
        let limits = &self.subject.arm(*limb).limits.position.0;
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
