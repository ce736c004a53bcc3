//! Poses to reach, and where the solvers begin.

use super::arm;
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use robot_model::Robot;

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

/// Forward kinematics of random postures, so that there is an answer; left and right in turn.
pub(super) fn reachable(count: usize) -> Vec<Target> {
    let mut random = Random::new(2026);
    let chains = Limb::BOTH.map(|limb| Robot::baxter().chain(&format!("{limb}_gripper")));
    let [Ok(left), Ok(right)] = chains else { unreachable!("Baxter has two grippers") };
    (0..count)
        .map(|i| {
            let (limb, chain) =
                if i % 2 == 0 { (Limb::Left, &left) } else { (Limb::Right, &right) };
            let pose = chain.forward(&random.posture(limb));
            Target { limb, pose, seed: random.posture(limb) }
        })
        .collect()
}

/// Postures of one limb.
pub(super) fn postures(limb: Limb, count: usize) -> Vec<Joints> {
    let mut random = Random::new(7);
    (0..count).map(|_| random.posture(limb)).collect()
}

/// A small generator (xorshift).
#[derive(Debug)]
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform within the limits.
    pub(super) fn posture(&mut self, limb: Limb) -> Joints {
        arm(limb).limits.position.0.map(|(lower, upper)| lower + (upper - lower) * self.unit())
    }
}
