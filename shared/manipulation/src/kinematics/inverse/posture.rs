//! Branches of the closed form, its angles as sines and cosines with the roots that they come from,
//! and how nearly a posture fits the limits.

use nalgebra::Vector3;

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

/// Most that a square may lack for its root to be still considered.
const LACK_MAX: f64 = 0.3;

/// The elbow's sine and cosine, and what the square of its root lacks.
#[derive(Clone, Copy)]
pub(crate) struct Elbow {
    pub(crate) e1: (f64, f64),
    pub(crate) lack: f64,
}

/// The elbow and shoulder as sines and cosines, and what the squares of their roots lack; `a` is
/// s1's angle.
#[derive(Clone, Copy)]
pub(crate) struct ArmAngles {
    pub(crate) e1: (f64, f64),
    pub(crate) e0: (f64, f64),
    pub(crate) a: (f64, f64),
    pub(crate) lack: f64,
}

impl ArmAngles {
    /// Returns a direction in the turned shoulder's axes, seen from the frame before w0.
    #[inline(always)]
    pub(crate) fn unturned(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let (s, c) = self.a;
        let (x, z) = (c * p.x - s * p.z, s * p.x + c * p.z);
        let (s, c) = self.e0;
        let (x, y) = (c * x + s * p.y, c * p.y - s * x);
        let (s, c) = self.e1;
        Vector3::new(c * x - s * z, y, s * x + c * z)
    }
}

/// Returns the square root of a number in units of the arm, and how much the number lacks where it
/// has none; nothing far below 0.
///
/// A root that is nearly there is kept so that a feasible s0 between two samples can be found from
/// them: near the stretched arm it is a narrow range.
#[inline(always)]
pub(crate) fn root(square: f64) -> Option<(f64, f64)> {
    if square >= 0.0 {
        Some((square.sqrt(), 0.0))
    } else if square > -LACK_MAX {
        Some((0.0, -square))
    } else {
        None
    }
}
