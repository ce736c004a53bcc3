//! The chain of Baxter's family: a turn along the arm, a turn across it, and so on, seven times.
//!
//! Each axis is at right angles to the next; the second and third, the fourth and fifth, and the
//! sixth and seventh meet, in the shoulder, elbow and wrist points. Elbow and wrist may lie aside of
//! the line along the arm, but only in the plane that the turn across leaves alone. KUKA's iiwa is
//! such an arm, with all offsets 0.

use nalgebra::Vector3;

use super::frame::Frame;
use super::zero::ZeroPosture;
use crate::kinematics::chain::trig::sin_cos;
use crate::kinematics::limb::Joints;

/// Tolerance of right angles and of meeting axes, radians and metres. Descriptions
/// round π/2 to twelve digits.
const EXACT: f64 = 1e-9;

/// The chain's dimensions.
///
/// Frame `i` moves with joint `i`. Even ones have z along their own axis and y along the next, odd
/// ones y along their own and z along the next, so that each is the one before it turned about a
/// coordinate axis. The first sits on its axis beside the shoulder, then two each in the shoulder,
/// elbow and wrist points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Alternating {
    /// The first frame at zero, in `base`.
    pub(crate) mount: Frame,
    /// The turn of every frame against the one before at zero, radians.
    pub(crate) zero: Joints,
    /// To the shoulder point along the first frame's x and z, metres.
    pub(crate) shoulder: [f64; 2],
    /// From the shoulder point to the elbow point along the third frame's x and z, metres.
    pub(crate) upper: [f64; 2],
    /// From the elbow point to the wrist point along the fifth frame's x and z, metres.
    pub(crate) fore: [f64; 2],
    /// The tool in the last frame.
    pub(crate) tool: Frame,
    /// `true` if the tool has the last frame's axes.
    pub(crate) plain_tool: bool,
}

impl Alternating {
    /// Returns the dimensions of a limb, if it is of this family.
    pub(crate) fn of(posture: &ZeroPosture) -> Option<Self> {
        let axes = &posture.axes;
        let along = |i: usize| axes[i].direction;
        if (0..6).any(|i| along(i).dot(&along(i + 1)).abs() > EXACT) {
            return None;
        }
        let shoulder = axes[1].meets(&axes[2], EXACT)?;
        let elbow = axes[3].meets(&axes[4], EXACT)?;
        let wrist = axes[5].meets(&axes[6], EXACT)?;
        let foot = axes[0].foot(&shoulder);
        let tool = Frame::from(&posture.tool);
        // The last frame has no next axis. The tool's own y serves where it can.
        let plain_tool = (tool.z - along(6)).norm() < EXACT;
        let last = if plain_tool { tool.y } else { along(5) };
        let origins = [foot, shoulder, shoulder, elbow, elbow, wrist, wrist];
        let frames: [Frame; 7] = std::array::from_fn(|i| {
            let next = if i < 6 { along(i + 1) } else { last };
            let (y, z) = if i % 2 == 0 { (next, along(i)) } else { (along(i), next) };
            Frame { x: y.cross(&z), y, z, origin: origins[i] }
        });
        let offset = |i: usize| frames[i].seen(&(origins[i + 1] - origins[i]));
        let offsets = [offset(0), offset(2), offset(4)];
        if offsets.iter().any(|offset| offset.y.abs() > EXACT) {
            return None;
        }
        let [shoulder, upper, fore] = offsets.map(|offset| [offset.x, offset.z]);
        Some(Self {
            mount: frames[0],
            zero: zeros(&frames),
            shoulder,
            upper,
            fore,
            tool: frames[6].relative(&tool),
            plain_tool,
        })
    }

    /// Returns the frames at `q`, in `base`.
    #[inline(always)]
    pub(crate) fn frames(&self, q: &Joints) -> [Frame; 7] {
        let angles: Joints = std::array::from_fn(|i| q[i] + self.zero[i]);
        let turns = sin_cos(&angles);
        let first = self.mount.turned_z(turns[0]);
        let s1 = first.shifted(self.shoulder).turned_y(turns[1]);
        let e0 = s1.turned_z(turns[2]);
        let e1 = e0.shifted(self.upper).turned_y(turns[3]);
        let w0 = e1.turned_z(turns[4]);
        let w1 = w0.shifted(self.fore).turned_y(turns[5]);
        let w2 = w1.turned_z(turns[6]);
        [first, s1, e0, e1, w0, w1, w2]
    }

    #[inline(always)]
    pub(crate) fn tool_on(&self, last: &Frame) -> Frame {
        if self.plain_tool {
            Frame { origin: last.point(&self.tool.origin), ..*last }
        } else {
            last.compose(&self.tool)
        }
    }

    /// Direction of joint `i`'s axis, given its frame.
    #[inline(always)]
    pub(crate) fn axis(i: usize, frame: &Frame) -> Vector3<f64> {
        if i % 2 == 1 { frame.y } else { frame.z }
    }
}

/// Returns the turn of every frame against the one before, radians.
fn zeros(frames: &[Frame; 7]) -> Joints {
    std::array::from_fn(|i| {
        if i == 0 {
            return 0.0;
        }
        let turned = frames[i - 1].relative(&frames[i]);
        let angle =
            if i % 2 == 1 { turned.z.x.atan2(turned.z.z) } else { turned.x.y.atan2(turned.x.x) };
        tidy(angle)
    })
}

/// An angle that is a multiple of a quarter turn but for the description's rounding is one.
fn tidy(angle: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    let nearest = (angle / quarter).round() * quarter;
    if (angle - nearest).abs() < EXACT { nearest } else { angle }
}
