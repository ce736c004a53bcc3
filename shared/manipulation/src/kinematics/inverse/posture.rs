//! Branches of the closed form, and how nearly a posture fits the limits.

use crate::kinematics::limb::Joints;

/// One of the eight families of solutions: the sign of each square root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Branch {
    pub(crate) elbow_up: bool,
    pub(crate) roll_up: bool,
    pub(crate) wrist_up: bool,
}

impl Branch {
    /// All eight.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        [true, false].into_iter().flat_map(|elbow_up| {
            [true, false].into_iter().flat_map(move |roll_up| {
                [true, false].map(|wrist_up| Self { elbow_up, roll_up, wrist_up })
            })
        })
    }

    /// Returns a number below 8.
    pub(crate) fn index(self) -> usize {
        usize::from(self.elbow_up)
            | usize::from(self.roll_up) << 1
            | usize::from(self.wrist_up) << 2
    }
}

/// A posture in closed form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Posture {
    pub(crate) q: Joints,
    /// Distance from a solution: excess of the worst joint over its limits, radians, plus what
    /// the squares of the elbow's and the roll's root lack. 0 only where every joint is within its
    /// limits and both roots exist.
    pub(crate) violation: f64,
    /// Deficit of the squares under the roots alone.
    pub(crate) lack: f64,
    pub(crate) settled: bool,
}

impl Posture {
    /// Returns whether the closed form claims that this reaches the goal.
    #[inline(always)]
    pub(crate) fn is_solution(&self) -> bool {
        self.settled && self.violation == 0.0
    }
}
