//! Closed-form joint positions for a given s0.
//!
//! The target fixes the wrist point W. The first joint fixes the shoulder point S. Then |W − S|
//! gives e1 (two roots), the direction from S to W gives e0 (two roots) and s1 (one), and what is
//! left of the rotation is z-y-z in w0, w1, w2 (two roots): at most eight branches per s0. The
//! 10 mm by which the w0 axis misses W enters only as `(.010 cos w0, .010 sin w0)` in the forearm,
//! so w0 is found as a fixed point, a contraction of about 0.03 a round.

use nalgebra::Vector3;

use super::goal::Goal;
use super::posture::{Branch, Posture, outside, violation};
use super::secant::Secant;
use crate::baxter::{ELBOW_TO_WRIST_M, S0_TO_S1_M, SHOULDER_TO_ELBOW_M};

const UPPER_X: f64 = SHOULDER_TO_ELBOW_M[0];
const UPPER_Z: f64 = SHOULDER_TO_ELBOW_M[1];
const FORE_X: f64 = ELBOW_TO_WRIST_M[0];
const FORE_Z: f64 = ELBOW_TO_WRIST_M[1];
const UPPER_SQUARED: f64 = UPPER_X * UPPER_X + UPPER_Z * UPPER_Z;
const FORE_SQUARED: f64 = FORE_X * FORE_X + FORE_Z * FORE_Z;

/// How far outside its limits a joint may be before a branch is dropped while looking for
/// solutions, radians: above what the rounds after the first still change.
pub(crate) const NARROW_RAD: f64 = 0.1;

/// The same while looking for what lies between two samples of s0: above half a cell times the
/// most that a joint turns per radian of s0 (s1, with the wrist near the first axis).
pub(crate) const WIDE_RAD: f64 = 0.45;

/// The most that a square may lack for its root to be still looked at.
const LACK_MAX: f64 = 0.3;

/// A wrist offset that moves less than this between two rounds has settled, metres; the tool is
/// then thirty times nearer still.
const SETTLED_M: f64 = 1e-11;

/// The same where postures are only compared: fewer rounds.
const ROUGHLY_M: f64 = 1e-5;

/// The same where it only counts how nearly a posture fits.
const GLIMPSE_M: f64 = 2e-3;

/// Rounds before a branch counts as one that does not settle.
const ROUNDS: usize = 20;

/// Rounds that take w0 as it comes. Where the wrist is nearly straight w0 changes so much with the
/// offset that this creeps or circles; the rounds after them follow a secant.
const PLAIN: usize = 6;

/// The goal seen from the shoulder turned to one s0.
pub(crate) struct Slice {
    s0: f64,
    /// When a wrist offset has settled, metres.
    settled_m: f64,
    /// Shoulder point to wrist point.
    v: Vector3<f64>,
    v_squared: f64,
    /// The target's z axis, and its x axis.
    z: Vector3<f64>,
    x: Vector3<f64>,
}

/// The elbow's sine and cosine, and what the square of its root lacks.
#[derive(Clone, Copy)]
struct Elbow {
    e1: (f64, f64),
    lack: f64,
}

/// The elbow and shoulder as sines and cosines, and what the squares of their roots lack; `a` is
/// s1 + π/2.
#[derive(Clone, Copy)]
struct ArmAngles {
    e1: (f64, f64),
    e0: (f64, f64),
    a: (f64, f64),
    lack: f64,
}

impl Slice {
    #[inline]
    pub(crate) fn new(goal: &Goal, s0: f64) -> Self {
        let (s, c) = (s0 + goal.chain.mount_yaw()).sin_cos();
        let turned = |p: &Vector3<f64>| Vector3::new(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
        let v = turned(&goal.wrist) - Vector3::new(S0_TO_S1_M[0], 0.0, S0_TO_S1_M[1]);
        Self {
            s0,
            settled_m: SETTLED_M,
            v,
            v_squared: v.norm_squared(),
            z: turned(&goal.tool.z),
            x: turned(&goal.tool.x),
        }
    }

    /// The same slice for comparing postures; they miss the goal by up to 1e-6 m.
    pub(crate) fn roughly(goal: &Goal, s0: f64) -> Self {
        Self { settled_m: ROUGHLY_M, ..Self::new(goal, s0) }
    }

    /// The same slice for telling how nearly postures fit, to a hundredth of a radian.
    pub(crate) fn glimpse(goal: &Goal, s0: f64) -> Self {
        Self { settled_m: GLIMPSE_M, ..Self::new(goal, s0) }
    }

    /// Calls `found` with every posture whose joints lie within `margin_rad` of their limits,
    /// until it says to stop by returning true. Returns whether it did.
    #[inline]
    pub(crate) fn postures(
        &self,
        margin_rad: f64,
        mut found: impl FnMut(Branch, Posture) -> bool,
    ) -> bool {
        for elbow_up in [true, false] {
            let Some(e1) = self.elbow((0.0, 0.0), elbow_up) else { return false };
            // Without a root both signs are one posture.
            if outside(3, angle(e1.e1)) > margin_rad || (e1.lack > 0.0 && !elbow_up) {
                continue;
            }
            for roll_up in [true, false] {
                let Some(arm) = self.shoulder((0.0, 0.0), e1, roll_up) else { continue };
                let same = arm.lack > e1.lack && !roll_up;
                if outside(1, shoulder_angle(arm.a)) > margin_rad || same {
                    continue;
                }
                for wrist_up in [true, false] {
                    let branch = Branch { elbow_up, roll_up, wrist_up };
                    let Some(posture) =
                        self.settle(branch, self.offset(&arm, wrist_up), margin_rad)
                    else {
                        continue;
                    };
                    if posture.violation <= margin_rad && found(branch, posture) {
                        return true;
                    }
                }
            }
        }
        false
    }

    /// The posture of one branch, however far outside the limits; none where a root is missing.
    pub(crate) fn posture(&self, branch: Branch) -> Option<Posture> {
        let e1 = self.elbow((0.0, 0.0), branch.elbow_up)?;
        let arm = self.shoulder((0.0, 0.0), e1, branch.roll_up)?;
        self.settle(branch, self.offset(&arm, branch.wrist_up), WIDE_RAD)
    }

    /// The same with the wrist's fixed point sought from `w0`: a nearly straight wrist has several.
    pub(crate) fn posture_from(&self, branch: Branch, w0: f64) -> Option<Posture> {
        let (s, c) = w0.sin_cos();
        self.settle(branch, (FORE_X * c, FORE_X * s), WIDE_RAD)
    }

    /// Repeats the closed form until the wrist offset agrees with the w0 that it leads to.
    #[inline]
    fn settle(&self, branch: Branch, mut offset: (f64, f64), margin_rad: f64) -> Option<Posture> {
        let mut secant = Secant::default();
        for round in 0..ROUNDS {
            let e1 = self.elbow(offset, branch.elbow_up)?;
            let arm = self.shoulder(offset, e1, branch.roll_up)?;
            let next = self.offset(&arm, branch.wrist_up);
            let change = (next.0 - offset.0).abs() + (next.1 - offset.1).abs();
            if change < self.settled_m {
                return Some(self.finish(&arm, next, branch, true));
            }
            if round == 1 {
                let rough = self.finish(&arm, next, branch, false);
                if rough.violation > margin_rad {
                    return Some(rough);
                }
            }
            offset = if round < PLAIN { next } else { secant.improve(offset, next) };
        }
        let e1 = self.elbow(offset, branch.elbow_up)?;
        let arm = self.shoulder(offset, e1, branch.roll_up)?;
        Some(self.finish(&arm, offset, branch, false))
    }

    /// Sine and cosine of e1 from |W − S|: `A cos e1 + B sin e1 = K`.
    #[inline(always)]
    fn elbow(&self, (x, _): (f64, f64), up: bool) -> Option<Elbow> {
        let a = UPPER_X * x + UPPER_Z * FORE_Z;
        let b = UPPER_X * FORE_Z - UPPER_Z * x;
        let k = 0.5 * (self.v_squared - UPPER_SQUARED - FORE_SQUARED);
        let n = a * a + b * b;
        let (root, lack) = root((n - k * k) / n)?;
        // Beyond the stretched or folded arm the cosine stops at ±1.
        let k = if lack > 0.0 { n.sqrt().copysign(k) } else { k };
        let d = if up { root } else { -root } * n.sqrt();
        Some(Elbow { e1: ((b * k + a * d) / n, (a * k - b * d) / n), lack })
    }

    /// Sines and cosines of e0 and s1 + π/2 from the direction of W − S.
    #[inline(always)]
    fn shoulder(&self, (x, y): (f64, f64), elbow: Elbow, up: bool) -> Option<ArmAngles> {
        let (s, c) = elbow.e1;
        let g = [UPPER_X + c * x + s * FORE_Z, y, UPPER_Z - s * x + c * FORE_Z];
        let rho = g[0] * g[0] + g[1] * g[1];
        let m = self.v.x * self.v.x + self.v.z * self.v.z;
        if rho < 1e-12 || m < 1e-12 {
            return None;
        }
        let (root, lack) = root((rho - self.v.y * self.v.y) / rho)?;
        let h = if up { root } else { -root } * rho.sqrt();
        let y = if lack > 0.0 { rho.sqrt().copysign(self.v.y) } else { self.v.y };
        let e0 = ((g[0] * y - g[1] * h) / rho, (g[0] * h + g[1] * y) / rho);
        // Scaled by |W − S| in the plane; only the ratio counts where a root is missing.
        let a = ((self.v.x * g[2] - self.v.z * h) / m, (self.v.x * h + self.v.z * g[2]) / m);
        Some(ArmAngles { e1: elbow.e1, e0, a, lack: elbow.lack + lack })
    }

    /// The wrist offset `.010 (cos w0, sin w0)` that the target's z axis asks for.
    #[inline(always)]
    fn offset(&self, arm: &ArmAngles, wrist_up: bool) -> (f64, f64) {
        let n = arm.unturned(&self.z);
        let sine = (n.x * n.x + n.y * n.y).sqrt();
        if sine < 1e-12 {
            return (FORE_X, 0.0);
        }
        let scale = if wrist_up { FORE_X / sine } else { -FORE_X / sine };
        (n.x * scale, n.y * scale)
    }

    /// All seven angles of a branch.
    #[inline]
    fn finish(
        &self,
        arm: &ArmAngles,
        offset: (f64, f64),
        branch: Branch,
        settled: bool,
    ) -> Posture {
        let z = arm.unturned(&self.z);
        let x = arm.unturned(&self.x);
        let (s, c) = (offset.1 / FORE_X, offset.0 / FORE_X);
        let sine = (z.x * z.x + z.y * z.y).sqrt();
        let w1 = (if branch.wrist_up { sine } else { -sine }, z.z);
        // Against the axes of the frame before w2, not by the third row of z-y-z: this way w2 is
        // right even where w1 is 0 and the row vanishes.
        let w2 = (c * x.y - s * x.x, w1.1 * (c * x.x + s * x.y) - w1.0 * x.z);
        let q = [
            self.s0,
            shoulder_angle(arm.a),
            angle(arm.e0),
            angle(arm.e1),
            angle((s, c)),
            angle(w1),
            angle(w2),
        ];
        Posture { q, violation: violation(&q) + arm.lack, settled }
    }
}

impl ArmAngles {
    /// A direction in the turned shoulder's axes, seen from the frame before w0.
    #[inline(always)]
    fn unturned(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let (s, c) = self.a;
        let (x, z) = (c * p.x - s * p.z, s * p.x + c * p.z);
        let (s, c) = self.e0;
        let (x, y) = (c * x + s * p.y, c * p.y - s * x);
        let (s, c) = self.e1;
        Vector3::new(c * x - s * z, y, s * x + c * z)
    }
}

#[inline(always)]
fn angle((s, c): (f64, f64)) -> f64 {
    s.atan2(c)
}

/// s1 from the sine and cosine of s1 + π/2.
#[inline(always)]
fn shoulder_angle((s, c): (f64, f64)) -> f64 {
    (-c).atan2(s)
}

/// The square root of a number in units of the arm, and how much the number lacks where it has
/// none; nothing far below 0.
///
/// A root that is nearly there is kept so that a feasible s0 between two samples can be found from
/// them: near the stretched arm it is a narrow range.
#[inline(always)]
fn root(square: f64) -> Option<(f64, f64)> {
    if square >= 0.0 {
        Some((square.sqrt(), 0.0))
    } else if square > -LACK_MAX {
        Some((0.0, -square))
    } else {
        None
    }
}
