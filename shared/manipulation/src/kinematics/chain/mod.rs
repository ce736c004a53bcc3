//! One limb's kinematic chain: forward kinematics and the geometric Jacobian.

mod alternating;
mod five;
mod frame;
mod general;
mod line;
mod six;
pub(crate) mod trig;
mod zero;

use nalgebra::{Isometry3, SMatrix, Vector3};

pub(crate) use alternating::Alternating;
pub(crate) use five::Five;
pub use frame::Frame;
pub(crate) use frame::positive;
pub(crate) use general::Closed;
use general::General;
pub use line::LineError;
pub(crate) use six::Found;
pub(crate) use zero::{Axis, ZeroPosture};

use crate::kinematics::limb::Joints;
use crate::kinematics::limits::PositionLimits;

#[cfg(test)]
mod tests;

/// Rows v_x v_y v_z w_x w_y w_z (velocity of the tool point in m/s and angular velocity in rad/s
/// per rad/s of a joint, axes of `base`), columns `s0..w2`.
pub type Jacobian = SMatrix<f64, 6, 7>;

/// One limb from frame `base` to its tool frame, `<limb>_gripper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    geometry: Geometry,
    limits: PositionLimits,
}

/// Geometry of the limb.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "both are large, and there are two limbs")]
pub(crate) enum Geometry {
    /// Like Baxter's: solved in closed form.
    Alternating(Alternating),
    /// Any other: solved by numbers.
    General(General),
}

impl Chain {
    /// Returns the chain of a limb with these axes, tool and position limits.
    pub(crate) fn new(posture: &ZeroPosture, limits: PositionLimits) -> Self {
        let alternating = (posture.joints == 7).then(|| Alternating::of(posture)).flatten();
        let geometry = match alternating {
            Some(alternating) => Geometry::Alternating(alternating),
            None => Geometry::General(General::of(posture)),
        };
        Self { geometry, limits }
    }

    /// Number of joints that move, five to seven; the others stand at zero.
    pub fn joints(&self) -> usize {
        match &self.geometry {
            Geometry::Alternating(_) => 7,
            Geometry::General(chain) => chain.joints(),
        }
    }

    /// Position limits of the joints.
    pub fn limits(&self) -> &PositionLimits {
        &self.limits
    }

    /// Returns the foot of the first axis beside the shoulder, in `base`, metres.
    pub(crate) fn shoulder(&self) -> Vector3<f64> {
        match &self.geometry {
            Geometry::Alternating(chain) => chain.mount.origin,
            Geometry::General(chain) => chain.shoulder(),
        }
    }

    pub(crate) fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Returns a frame for each joint `s0..w2` that moves with it, in `base`. Where it sits and how
    /// it is turned on its link is the chain's own choice: put what is to move with a link into its
    /// frame at zero ([`Frame::point`]), and it will be right everywhere.
    #[inline(always)]
    pub fn frames(&self, q: &Joints) -> [Frame; 7] {
        match &self.geometry {
            Geometry::Alternating(chain) => chain.frames(q),
            Geometry::General(chain) => chain.frames(q),
        }
    }

    /// Returns the tool frame in `base`, as axes and origin.
    #[inline]
    pub fn tool_frame(&self, q: &Joints) -> Frame {
        match &self.geometry {
            Geometry::Alternating(chain) => chain.tool_on(&chain.frames(q)[6]),
            Geometry::General(chain) => chain.tool_on(&chain.frames(q)[6]),
        }
    }

    /// Pose of `<limb>_gripper` in `base`; the quaternion has w ≥ 0.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        self.tool_frame(q).isometry()
    }

    /// Tool frame and geometric Jacobian together, for the price of little more than one.
    #[inline]
    pub fn tool_and_jacobian(&self, q: &Joints) -> (Frame, Jacobian) {
        match &self.geometry {
            Geometry::Alternating(chain) => {
                let frames = chain.frames(q);
                let tool = chain.tool_on(&frames[6]);
                (tool, jacobian(&frames, &tool, Alternating::axis))
            }
            Geometry::General(chain) => {
                let frames = chain.frames(q);
                let tool = chain.tool_on(&frames[6]);
                let moves = |i: usize| if i < chain.joints() { 1.0 } else { 0.0 };
                (tool, jacobian(&frames, &tool, |i, frame| frame.z * moves(i)))
            }
        }
    }
}

#[inline(always)]
fn jacobian(
    frames: &[Frame; 7],
    tool: &Frame,
    axis: impl Fn(usize, &Frame) -> Vector3<f64>,
) -> Jacobian {
    let mut jacobian = Jacobian::zeros();
    for (i, frame) in frames.iter().enumerate() {
        let axis = axis(i, frame);
        let linear = axis.cross(&(tool.origin - frame.origin));
        jacobian.fixed_view_mut::<3, 1>(0, i).copy_from(&linear);
        jacobian.fixed_view_mut::<3, 1>(3, i).copy_from(&axis);
    }
    jacobian
}
