//! The target pose as the solvers need it.

use nalgebra::{Isometry3, Vector3};

use crate::kinematics::chain::{Alternating, Chain, Frame};
use crate::kinematics::limb::Joints;

/// A target for `<limb>_gripper`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal<'a> {
    pub(crate) chain: &'a Chain,
    /// The target frame in `base`.
    pub(crate) tool: Frame,
}

/// The same for a chain of Baxter's family, with what does not depend on the joints worked out
/// once, in the axes of the chain's mount.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim<'a> {
    pub(crate) goal: Goal<'a>,
    pub(crate) arm: &'a Alternating,
    /// The wrist point that the target fixes, from the foot of the first axis, metres.
    pub(crate) wrist: Vector3<f64>,
    /// The z and x axes that the target asks of the last frame.
    pub(crate) z: Vector3<f64>,
    pub(crate) x: Vector3<f64>,
}

impl<'a> Goal<'a> {
    pub(crate) fn new(chain: &'a Chain, target: &Isometry3<f64>) -> Self {
        Self { chain, tool: Frame::from(target) }
    }

    /// Returns whether every number of the target is finite.
    pub(crate) fn is_finite(&self) -> bool {
        [self.tool.x, self.tool.y, self.tool.z, self.tool.origin]
            .iter()
            .all(|v| v.iter().all(|c| c.is_finite()))
    }

    /// Distance in metres and angle in radians from the pose at `q` to the target.
    #[inline]
    pub(crate) fn errors(&self, q: &Joints) -> (f64, f64) {
        let reached = self.chain.tool_frame(q);
        let turn = turn_between(&reached, &self.tool);
        ((self.tool.origin - reached.origin).norm(), turn.norm())
    }
}

impl<'a> Aim<'a> {
    pub(crate) fn new(goal: Goal<'a>, arm: &'a Alternating) -> Self {
        let tool = &goal.tool;
        // The last frame is the target with the tool taken off.
        let seen = Frame { origin: Vector3::zeros(), ..arm.tool };
        let axis = |e: Vector3<f64>| tool.direction(&seen.seen(&e));
        let (x, y, z) = (axis(Vector3::x()), axis(Vector3::y()), axis(Vector3::z()));
        let last = Frame { x, y, z, origin: Vector3::zeros() };
        let wrist = tool.origin - last.direction(&arm.tool.origin) - arm.mount.origin;
        let mount = &arm.mount;
        Self { goal, arm, wrist: mount.seen(&wrist), z: mount.seen(&z), x: mount.seen(&x) }
    }

    /// Position limits of a joint, radians.
    pub(crate) fn limits(&self, i: usize) -> (f64, f64) {
        self.goal.chain.limits().0[i]
    }
}

/// Returns the rotation vector (axis times angle, in `base`) that takes frame `from` to frame `to`.
#[inline]
pub(crate) fn turn_between(from: &Frame, to: &Frame) -> Vector3<f64> {
    let sine = (from.x.cross(&to.x) + from.y.cross(&to.y) + from.z.cross(&to.z)) * 0.5;
    let sine_norm = sine.norm();
    let cosine = 0.5 * (from.x.dot(&to.x) + from.y.dot(&to.y) + from.z.dot(&to.z) - 1.0);
    if cosine > 0.999_999 {
        // The angle equals its sine to 1e-9 of itself here, and the atan2 is not needed.
        return sine * (1.0 + sine_norm * sine_norm / 6.0);
    }
    if sine_norm < 1e-9 {
        // Half a turn: any axis that both frames agree on is the right one.
        return half_turn_axis(from, to) * std::f64::consts::PI;
    }
    sine * (sine_norm.atan2(cosine) / sine_norm)
}

/// Axis of a half turn: the column of `R + 1` of greatest length, where `R` takes `from` to `to`.
fn half_turn_axis(from: &Frame, to: &Frame) -> Vector3<f64> {
    [Vector3::x(), Vector3::y(), Vector3::z()]
        .map(|e| to.x * from.x.dot(&e) + to.y * from.y.dot(&e) + to.z * from.z.dot(&e) + e)
        .into_iter()
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .map_or_else(Vector3::x, |axis| axis.normalize())
}
