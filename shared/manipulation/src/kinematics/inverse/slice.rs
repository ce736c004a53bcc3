//! Closed-form joint positions for a given s0.
//!
//! The target fixes the wrist point W. The first joint fixes the shoulder point S. Then |W − S|
//! gives e1 (two roots), the direction from S to W gives e0 (two roots) and s1 (one), and what is
//! left of the rotation is z-y-z in w0, w1, w2 (two roots): at most eight branches per s0. The
//! offset by which the w0 axis misses W (10 mm on Baxter) enters only as `(x cos w0, x sin w0)` in
//! the forearm, so w0 is found as a fixed point, a contraction of about 0.03 a round.
//!
//! Angles are those between the frames of [`Alternating`]; joint positions are less by its zeros.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::goal::Aim;
use super::line_search::Secant;
use super::posture::{ArmAngles, Branch, Elbow, Posture, root};
use crate::kinematics::chain::Alternating;
use crate::kinematics::limits::PositionLimits;

/// Excess over a joint's limits at which a branch is dropped while looking for
/// solutions, radians: above what the rounds after the first still change.
pub(crate) const NARROW_RAD: f64 = 0.1;

/// The same while looking for what lies between two samples of s0: above half a cell times the
/// most that a joint turns per radian of s0 (s1, with the wrist near the first axis).
pub(crate) const WIDE_RAD: f64 = 0.45;

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
pub(crate) struct Slice<'a> {
    arm: &'a Alternating,
    limits: &'a PositionLimits,
    s0: f64,
    /// Change at which a wrist offset has settled, metres.
    settled_m: f64,
    /// Shoulder point to wrist point.
    v: Vector3<f64>,
    /// Equation of the elbow, from |W − S|: `A cos e1 + B sin e1 = K`.
    k: f64,
    /// The target's z axis, and its x axis.
    z: Vector3<f64>,
    x: Vector3<f64>,
}

impl<'a> Slice<'a> {
    #[inline]
    pub(crate) fn new(aim: &'a Aim<'a>, s0: f64) -> Self {
        let arm = aim.arm;
        let (s, c) = s0.sin_cos();
        let turned = |p: &Vector3<f64>| Vector3::new(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
        let v = turned(&aim.wrist) - Vector3::new(arm.shoulder[0], 0.0, arm.shoulder[1]);
        Self {
            arm,
            limits: aim.goal.chain.limits(),
            s0,
            settled_m: SETTLED_M,
            v,
            k: 0.5 * (v.norm_squared() - squared(arm.upper) - squared(arm.fore)),
            z: turned(&aim.z),
            x: turned(&aim.x),
        }
    }

    /// Returns the same slice for comparing postures; they miss the goal by up to 1e-6 m.
    pub(crate) fn roughly(aim: &'a Aim<'a>, s0: f64) -> Self {
        Self { settled_m: ROUGHLY_M, ..Self::new(aim, s0) }
    }

    /// Returns the same slice for measuring how nearly postures fit, to a hundredth of a radian.
    pub(crate) fn glimpse(aim: &'a Aim<'a>, s0: f64) -> Self {
        Self { settled_m: GLIMPSE_M, ..Self::new(aim, s0) }
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
            if self.outside(3, e1.e1) > margin_rad || (e1.lack > 0.0 && !elbow_up) {
                continue;
            }
            for roll_up in [true, false] {
                let Some(arm) = self.shoulder((0.0, 0.0), e1, roll_up) else { continue };
                let same = arm.lack > e1.lack && !roll_up;
                if self.outside(1, arm.a) > margin_rad || same {
                    continue;
                }
                for wrist_up in [true, false] {
                    let branch = Branch { elbow_up, roll_up, wrist_up };
                    let Some(posture) =
                        self.settle(branch, self.forearm(&arm, wrist_up), margin_rad)
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

    /// Returns the posture of one branch, however far outside the limits; none where a root is
    /// missing.
    pub(crate) fn posture(&self, branch: Branch) -> Option<Posture> {
        let e1 = self.elbow((0.0, 0.0), branch.elbow_up)?;
        let arm = self.shoulder((0.0, 0.0), e1, branch.roll_up)?;
        self.settle(branch, self.forearm(&arm, branch.wrist_up), WIDE_RAD)
    }

    /// Returns the same with the wrist's fixed point sought from `w0`: a nearly straight wrist has
    /// several.
    pub(crate) fn posture_from(&self, branch: Branch, w0: f64) -> Option<Posture> {
        let (s, c) = (w0 + self.arm.zero[4]).sin_cos();
        self.settle(branch, (c, s), WIDE_RAD)
    }

    /// Repeats the closed form until the direction of the wrist offset (cosine and sine of w0's
    /// angle) agrees with the w0 that it leads to.
    #[inline]
    fn settle(&self, branch: Branch, mut w0: (f64, f64), margin_rad: f64) -> Option<Posture> {
        let mut secant = Secant::default();
        for round in 0..ROUNDS {
            let e1 = self.elbow(w0, branch.elbow_up)?;
            let arm = self.shoulder(w0, e1, branch.roll_up)?;
            let next = self.forearm(&arm, branch.wrist_up);
            let change = (next.0 - w0.0).abs() + (next.1 - w0.1).abs();
            if change * self.arm.fore[0].abs() < self.settled_m {
                return Some(self.finish(&arm, next, branch, true));
            }
            if round == 1 {
                if let Some(far) = self.beyond(&arm, branch, margin_rad) {
                    return Some(far);
                }
                let rough = self.finish(&arm, next, branch, false);
                if rough.violation > margin_rad {
                    return Some(rough);
                }
            }
            w0 = if round < PLAIN { next } else { secant.improve(w0, next) };
        }
        let e1 = self.elbow(w0, branch.elbow_up)?;
        let arm = self.shoulder(w0, e1, branch.roll_up)?;
        Some(self.finish(&arm, w0, branch, false))
    }

    /// Sine and cosine of e1 from |W − S|: `A cos e1 + B sin e1 = K`.
    #[inline(always)]
    fn elbow(&self, (cosine, _): (f64, f64), up: bool) -> Option<Elbow> {
        let ([upper_x, upper_z], [fore_x, fore_z]) = (self.arm.upper, self.arm.fore);
        let (x, k) = (fore_x * cosine, self.k);
        let a = upper_x * x + upper_z * fore_z;
        let b = upper_x * fore_z - upper_z * x;
        let n = a * a + b * b;
        let (root, lack) = root((n - k * k) / n)?;
        // Beyond the stretched or folded arm the cosine stops at ±1.
        let k = if lack > 0.0 { n.sqrt().copysign(k) } else { k };
        let d = if up { root } else { -root } * n.sqrt();
        Some(Elbow { e1: ((b * k + a * d) / n, (a * k - b * d) / n), lack })
    }

    /// Sines and cosines of e0's and s1's angles from the direction of W − S.
    #[inline(always)]
    fn shoulder(&self, w0: (f64, f64), elbow: Elbow, up: bool) -> Option<ArmAngles> {
        let ([upper_x, upper_z], [fore_x, fore_z]) = (self.arm.upper, self.arm.fore);
        let (x, y) = (fore_x * w0.0, fore_x * w0.1);
        let (s, c) = elbow.e1;
        let g = [upper_x + c * x + s * fore_z, y, upper_z - s * x + c * fore_z];
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

    /// Cosine and sine of w0's angle, as the target's z axis asks for them.
    #[inline(always)]
    fn forearm(&self, arm: &ArmAngles, wrist_up: bool) -> (f64, f64) {
        let n = arm.unturned(&self.z);
        let sine = (n.x * n.x + n.y * n.y).sqrt();
        if sine < 1e-12 {
            return (1.0, 0.0);
        }
        let scale = if wrist_up { 1.0 / sine } else { -1.0 / sine };
        (n.x * scale, n.y * scale)
    }

    /// Returns the excess over its limits of joint `i` whose angle has this sine and cosine, radians.
    #[inline(always)]
    fn outside(&self, i: usize, turn: (f64, f64)) -> f64 {
        self.limits.outside(i, self.position(i, turn))
    }

    /// Returns the position of joint `i` whose angle has this sine and cosine, radians: of those a
    /// whole turn apart the one nearest to the middle of its limits.
    #[inline(always)]
    fn position(&self, i: usize, (s, c): (f64, f64)) -> f64 {
        let (lower, upper) = self.limits.0[i];
        let q = s.atan2(c) - self.arm.zero[i];
        let off = q - 0.5 * (lower + upper);
        if off > PI {
            q - TAU
        } else if off < -PI {
            q + TAU
        } else {
            q
        }
    }

    /// A branch that can be dropped by w1 alone, the joint that most often forbids it: the other
    /// angles need not be worked out. Its violation is then a lower bound.
    #[inline]
    fn beyond(&self, arm: &ArmAngles, branch: Branch, margin_rad: f64) -> Option<Posture> {
        let w1 = self.position(5, Self::wrist(&arm.unturned(&self.z), branch));
        let violation = self.limits.outside(5, w1) + arm.lack;
        let q = [self.s0, 0.0, 0.0, 0.0, 0.0, w1, 0.0];
        (violation > margin_rad).then_some(Posture { q, violation, lack: arm.lack, settled: false })
    }

    /// Sine and cosine of w1's angle, given the target's z axis before w0.
    #[inline(always)]
    fn wrist(z: &Vector3<f64>, branch: Branch) -> (f64, f64) {
        let sine = (z.x * z.x + z.y * z.y).sqrt();
        (if branch.wrist_up { sine } else { -sine }, z.z)
    }

    /// All seven angles of a branch.
    #[inline]
    fn finish(
        &self,
        arm: &ArmAngles,
        (c, s): (f64, f64),
        branch: Branch,
        settled: bool,
    ) -> Posture {
        let z = arm.unturned(&self.z);
        let x = arm.unturned(&self.x);
        let w1 = Self::wrist(&z, branch);
        // Against the axes of the frame before w2, not by the third row of z-y-z: this way w2 is
        // right even where w1 is 0 and the row vanishes.
        let w2 = (c * x.y - s * x.x, w1.1 * (c * x.x + s * x.y) - w1.0 * x.z);
        let q = [
            self.s0,
            self.position(1, arm.a),
            self.position(2, arm.e0),
            self.position(3, arm.e1),
            self.position(4, (s, c)),
            self.position(5, w1),
            self.position(6, w2),
        ];
        let violation = self.limits.violation(&q) + arm.lack;
        Posture { q, violation, lack: arm.lack, settled }
    }
}

#[inline(always)]
fn squared([x, z]: [f64; 2]) -> f64 {
    x * x + z * z
}
