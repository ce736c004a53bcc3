//! Damped least squares within the joint limits: the last stage, for the poses that the closed
//! form only comes near to (a stretched elbow, a straight wrist, a feasible s0 between samples).

use nalgebra::{Matrix6, SVector, Vector6};

use super::goal::{Goal, turn_between};
use crate::kinematics::chain::{Frame, Jacobian};
use crate::kinematics::limb::{Joints, distance};
use crate::kinematics::limits::PositionLimits;

/// A posture within the limits and how far from the target it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Refined {
    pub(crate) q: Joints,
    pub(crate) position_error_m: f64,
    pub(crate) rotation_error_rad: f64,
}

impl Refined {
    pub(crate) fn at(goal: &Goal<'_>, q: Joints) -> Self {
        let (position_error_m, rotation_error_rad) = goal.errors(&q);
        Self { q, position_error_m, rotation_error_rad }
    }

    /// Length of the error twist, metres and radians alike.
    pub(crate) fn error(&self) -> f64 {
        self.position_error_m.hypot(self.rotation_error_rad)
    }
}

/// Error at which a pose counts as exact and the steps end, metres and radians.
const EXACT: f64 = 1e-10;

/// Steps from `q`, clamped into the limits, towards the goal until it is exact, no step helps, or
/// `steps_max` are spent. Never worse than where it began, never outside the limits.
///
/// Each step is the shortest one, `Δq = Jᵀ (J Jᵀ + λ)⁻¹ e`, over the joints that are free: a joint
/// at a limit that the step would push beyond it is left out and the step taken again.
pub(crate) fn refine(goal: &Goal<'_>, q: &Joints, steps_max: usize) -> Refined {
    let limits = goal.chain.limits();
    let mut q = limits.clamp(q);
    let (mut twist, mut jacobian) = linearise(goal, &q);
    let mut damping = 1e-3;
    for _ in 0..steps_max {
        let error = twist.norm();
        if error < EXACT {
            break;
        }
        let Some(step) = free_step(limits, &q, &jacobian, &twist, damping * error.min(1.0)) else {
            break;
        };
        let next = limits.clamp(&std::array::from_fn(|i| q[i] + step[i]));
        let (next_twist, next_jacobian) = linearise(goal, &next);
        if next_twist.norm() < error {
            (q, twist, jacobian) = (next, next_twist, next_jacobian);
            damping = (damping * 0.1).max(1e-9);
        } else if damping > 1e3 {
            break;
        } else {
            damping *= 8.0;
        }
    }
    Refined::at(goal, q)
}

/// From a posture that reaches the goal to one that still does and is nearer to `seed`: along the
/// joint motion that leaves the gripper where it is, then back onto the goal. The distance only
/// ever falls.
pub(crate) fn drift(goal: &Goal<'_>, from: Refined, seed: &Joints, rounds: usize) -> Refined {
    let mut best = from;
    for _ in 0..rounds {
        let (_, jacobian) = linearise(goal, &best.q);
        let normal = jacobian * jacobian.transpose() + Matrix6::identity() * 1e-9;
        let Some(factor) = normal.cholesky() else { break };
        let away = SVector::<f64, 7>::from_fn(|j, _| seed[j] - best.q[j]);
        let free = away - jacobian.transpose() * factor.solve(&(jacobian * away));
        let moved = refine(goal, &std::array::from_fn(|j| best.q[j] + free[j]), DRIFT_STEPS);
        let nearer = distance(&moved.q, seed) < distance(&best.q, seed) - DRIFT_RAD;
        if !nearer || moved.error() > 1e-8 {
            break;
        }
        best = moved;
    }
    best
}

/// Steps that bring a posture back onto the goal after a drift.
const DRIFT_STEPS: usize = 6;

/// A drift that gains less than this has arrived, radians.
const DRIFT_RAD: f64 = 1e-5;

fn linearise(goal: &Goal<'_>, q: &Joints) -> (Vector6<f64>, Jacobian) {
    let (tool, jacobian) = goal.chain.tool_and_jacobian(q);
    (error_twist(&tool, &goal.tool), jacobian)
}

fn error_twist(from: &Frame, to: &Frame) -> Vector6<f64> {
    let p = to.origin - from.origin;
    let r = turn_between(from, to);
    Vector6::new(p.x, p.y, p.z, r.x, r.y, r.z)
}

/// Returns the damped step over the joints that may move; none where the normal equations cannot be
/// solved.
fn free_step(
    limits: &PositionLimits,
    q: &Joints,
    jacobian: &Jacobian,
    twist: &Vector6<f64>,
    damping: f64,
) -> Option<Joints> {
    let mut free = *jacobian;
    for _ in 0..7 {
        let normal = free * free.transpose() + Matrix6::identity() * (damping + 1e-14);
        let step = free.transpose() * normal.cholesky()?.solve(twist);
        let mut blocked = false;
        for i in 0..7 {
            let (lower, upper) = limits.0[i];
            if (q[i] <= lower && step[i] < 0.0) || (q[i] >= upper && step[i] > 0.0) {
                free.column_mut(i).fill(0.0);
                blocked = true;
            }
        }
        if !blocked {
            return Some(step.into());
        }
    }
    None
}
