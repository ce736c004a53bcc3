//! A plain baseline: damped least squares from the seed, then from random postures until time is
//! up. Its forward kinematics are this project's own, so what differs is the method.

use super::inverse::Solver;
use super::subject::Subject;
use super::{BUDGET_S, thread_s};
use manipulation::{Arm, Joints, Limb};
use nalgebra::{Isometry3, Matrix6, Vector6};
use vocabulary::Rng;

/// Distance and angle at which it stops.
const TOLERANCE: f64 = 1e-5;
/// Steps from one posture.
const STEPS: usize = 60;

pub(super) struct Damped<'a> {
    pub(super) subject: &'a Subject,
    /// Of its restarts.
    pub(super) rng: Rng,
}

impl Solver for Damped<'_> {
    fn name(&self) -> String {
        "damped least squares with restarts, 5 ms (baseline)".to_owned()
    }

    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints> {
        let started = thread_s();
        let mut q = *seed;
        loop {
            if let Some(found) = descend(self.subject.arm(limb), pose, q) {
                return Some(found);
            }
            if thread_s() - started > BUDGET_S {
                return None;
            }
            q = self.subject.posture(limb, &mut self.rng);
        }
    }
}

/// Steps `Jᵀ (J Jᵀ + λ² I)⁻¹ e` with λ² in proportion to |e|² (Sugihara 2011), held within the
/// limits.
fn descend(arm: &Arm, pose: &Isometry3<f64>, mut q: Joints) -> Option<Joints> {
    for _ in 0..STEPS {
        let (tool, jacobian) = arm.chain.tool_and_jacobian(&q);
        let linear = pose.translation.vector - tool.origin;
        let turn = (pose.rotation * tool.isometry().rotation.inverse()).scaled_axis();
        if linear.norm() <= TOLERANCE && turn.norm() <= TOLERANCE {
            return Some(q);
        }
        let error = Vector6::new(linear.x, linear.y, linear.z, turn.x, turn.y, turn.z);
        let damping = 0.1 * error.norm_squared() + 1e-9;
        let gram = jacobian * jacobian.transpose() + Matrix6::identity() * damping;
        let step = jacobian.transpose() * gram.cholesky()?.solve(&error);
        q = arm.limits.position.clamp(&std::array::from_fn(|i| q[i] + step[i]));
    }
    None
}
