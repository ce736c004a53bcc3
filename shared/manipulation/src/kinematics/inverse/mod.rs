//! Inverse kinematics: a semi-analytic sweep over s0, then refinement within the limits. Limbs that
//! are not of Baxter's family are refined from many postures instead; those with five or six joints
//! are solved in closed form where they belong to a family that has one.
//!
//! Every result has passed forward kinematics and the limits: an answer is
//! within [`TOLERANCE_M`] and [`TOLERANCE_RAD`] (of five joints 1e-4) of the target and inside every joint limit to the
//! last bit, or it is an [`Unreachable`].

mod closed;
mod closer;
mod five;
mod goal;
mod hidden;
mod line_search;
mod nearest;
mod posture;
mod refine;
mod restarts;
mod slice;
mod solve;
#[cfg(test)]
mod tests;

use nalgebra::Isometry3;

use crate::kinematics::chain::{Chain, Closed, Geometry};
use crate::kinematics::limb::Joints;
use goal::{Aim, Goal};
use refine::Refined;

/// Greatest distance of an answer from the target position, metres.
pub const TOLERANCE_M: f64 = 1e-6;

/// Greatest angle between an answer's and the target's orientation, radians.
pub const TOLERANCE_RAD: f64 = 1e-6;

/// Joint positions that reach a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IkSolution {
    /// Radians, within every limit.
    pub q: Joints,
    /// Distance from the target, metres; at most [`TOLERANCE_M`].
    pub position_error_m: f64,
    /// Angle from the target, radians; at most [`TOLERANCE_RAD`].
    pub rotation_error_rad: f64,
}

/// No posture within the limits reaches the pose.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "out of reach: the nearest posture found misses by {:.1} mm and {:.1} degrees",
    position_error_m * 1e3,
    rotation_error_rad.to_degrees()
)]
pub struct Unreachable {
    /// The posture within the limits that came nearest, radians.
    pub nearest: Joints,
    /// Its distance from the target, metres.
    pub position_error_m: f64,
    /// Its angle from the target, radians.
    pub rotation_error_rad: f64,
}

impl Chain {
    /// Joint positions that bring `<limb>_gripper` to `target` (frame `base`).
    ///
    /// Without a seed the first posture found, in a few microseconds; the same target always
    /// gives the same answer. With one, the posture nearest to it ([`Chain::nearest`]).
    ///
    /// # Errors
    /// [`Unreachable`] with the nearest posture, also for a target that is not finite.
    pub fn inverse(
        &self,
        target: &Isometry3<f64>,
        seed: Option<&Joints>,
    ) -> Result<IkSolution, Unreachable> {
        match seed {
            Some(seed) => self.nearest(target, seed),
            None => {
                let goal = Goal::new(self, target);
                match self.geometry() {
                    Geometry::Alternating(arm) => solve::first(&Aim::new(goal, arm)),
                    Geometry::General(arm) => match arm.closed() {
                        Some(arm) => closed::first(&goal, arm),
                        None => restarts::first(&goal),
                    },
                }
                .map_err(Unreachable::from)
            }
        }
    }

    /// Returns the posture that reaches `target` at the least Euclidean joint distance from `seed`:
    /// every branch at samples of s0, the best of them followed along s0.
    ///
    /// # Errors
    /// [`Unreachable`] with the nearest pose's posture.
    pub fn nearest(
        &self,
        target: &Isometry3<f64>,
        seed: &Joints,
    ) -> Result<IkSolution, Unreachable> {
        let goal = Goal::new(self, target);
        match self.geometry() {
            Geometry::Alternating(arm) => nearest::nearest(&Aim::new(goal, arm), seed),
            Geometry::General(arm) => match arm.closed() {
                Some(arm) => closed::nearest(&goal, arm, seed),
                None => restarts::nearest(&goal, seed),
            },
        }
    }

    /// Returns the posture that reaches `target` with the shortest steps from `q`: the same branch,
    /// as long as the target is near; of five joints, the nearest posture. For following a motion;
    /// [`Chain::inverse`] is for finding
    /// one.
    ///
    /// # Errors
    /// [`Unreachable`] if the steps end at the limits or at a singularity short of the target.
    pub fn track(&self, target: &Isometry3<f64>, q: &Joints) -> Result<IkSolution, Unreachable> {
        let goal = Goal::new(self, target);
        if let Geometry::General(chain) = self.geometry()
            && let Some(arm @ Closed::Five(_)) = chain.closed()
        {
            return closed::nearest(&goal, arm, q);
        }
        let refined = refine::refine(&goal, q, TRACK_STEPS);
        IkSolution::accept(&goal, &refined).ok_or_else(|| refined.into())
    }

    /// Postures that reach `target`, of every branch at samples of s0 (an arm of seven joints has one
    /// more than a pose has dimensions, so each branch is a curve); all of them where there are six.
    /// Empty if there is none.
    pub fn solutions(&self, target: &Isometry3<f64>) -> Vec<Joints> {
        let goal = Goal::new(self, target);
        match self.geometry() {
            Geometry::Alternating(arm) => solve::all(&Aim::new(goal, arm)),
            Geometry::General(arm) => match arm.closed() {
                Some(arm) => closed::all(&goal, arm),
                None => restarts::all(&goal),
            },
        }
    }
}

/// Refinement steps of [`Chain::track`].
const TRACK_STEPS: usize = 20;

impl IkSolution {
    /// Returns the answer if `refined` is one.
    fn accept(goal: &Goal<'_>, refined: &Refined) -> Option<Self> {
        let is_five = goal.chain.joints() == 5;
        let exact = refined.position_error_m <= TOLERANCE_M
            && refined.rotation_error_rad
                <= if is_five { five::TOLERANCE_RAD } else { TOLERANCE_RAD }
            && goal.chain.limits().within(&refined.q);
        exact.then_some(Self {
            q: refined.q,
            position_error_m: refined.position_error_m,
            rotation_error_rad: refined.rotation_error_rad,
        })
    }
}

impl From<Refined> for Unreachable {
    fn from(nearest: Refined) -> Self {
        Self {
            nearest: nearest.q,
            position_error_m: nearest.position_error_m,
            rotation_error_rad: nearest.rotation_error_rad,
        }
    }
}
