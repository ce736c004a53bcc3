//! One arm's kinematic chain in closed form: forward kinematics and the geometric Jacobian.

use nalgebra::{Isometry3, Matrix3, Rotation3, SMatrix, Translation3, UnitQuaternion, Vector3};

use crate::baxter::{
    E1_TO_W0_M, ELBOW_TO_WRIST_M, MOUNT_TO_S0_M, MOUNT_XYZ_M, MOUNT_YAW_RAD, S0_TO_S1_M,
    S1_TO_E0_M, SHOULDER_TO_ELBOW_M, W1_TO_W2_M, WRIST_TO_HAND_M, tool,
};
use crate::limb::{Joints, Limb};
use crate::trig::sin_cos;

#[cfg(test)]
mod tests;

/// Rows v_x v_y v_z w_x w_y w_z (velocity of the tool point in m/s and angular velocity in rad/s
/// per rad/s of a joint, axes of `base`), columns `s0..w2`.
pub type Jacobian = SMatrix<f64, 6, 7>;

/// One arm from frame `base` to `<limb>_gripper`. Copying it is cheap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    limb: Limb,
    tool_m: f64,
}

/// A coordinate frame in `base`: columns of its rotation, and its origin in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The x axis.
    pub x: Vector3<f64>,
    /// The y axis.
    pub y: Vector3<f64>,
    /// The z axis.
    pub z: Vector3<f64>,
    /// The origin, metres.
    pub origin: Vector3<f64>,
}

impl Chain {
    /// The chain with the default tool, the electric gripper with extended fingers.
    pub const fn new(limb: Limb) -> Self {
        Self { limb, tool_m: tool::ELECTRIC_EXTENDED_M }
    }

    /// The same arm with `<limb>_gripper` at `tool_m` metres past the hand along its z axis; see
    /// [`crate::baxter::tool`].
    pub const fn with_tool(self, tool_m: f64) -> Self {
        Self { tool_m, ..self }
    }

    /// Which arm this is.
    pub fn limb(&self) -> Limb {
        self.limb
    }

    /// Distance from `<limb>_hand` to `<limb>_gripper`, metres.
    pub fn tool_m(&self) -> f64 {
        self.tool_m
    }

    /// Distance from the wrist point to the tool point along the tool's z axis, metres.
    pub(crate) fn wrist_to_tool_m(&self) -> f64 {
        WRIST_TO_HAND_M + self.tool_m
    }

    /// The foot of the first axis in `base`, metres.
    pub(crate) fn origin(&self) -> Vector3<f64> {
        let side = self.limb.side();
        Vector3::new(
            MOUNT_XYZ_M[0] + MOUNT_TO_S0_M[0] * COS_MOUNT_YAW,
            side * (MOUNT_XYZ_M[1] + MOUNT_TO_S0_M[0] * SIN_MOUNT_YAW),
            MOUNT_XYZ_M[2] + MOUNT_TO_S0_M[1],
        )
    }

    /// Yaw of the mount in `base`, radians.
    pub(crate) fn mount_yaw(&self) -> f64 {
        self.limb.side() * MOUNT_YAW_RAD
    }

    /// The frame after each joint's rotation, `s0..w2`, in `base`.
    ///
    /// Each frame sits where the description's link frame of that joint sits. The odd joints
    /// (s1, e1, w1) turn about y here; the description turns them about z of a frame whose axes
    /// are permuted (its x y z are z x y here).
    #[inline(always)]
    pub fn frames(&self, q: &Joints) -> [Frame; 7] {
        let mut angles = *q;
        angles[0] += self.mount_yaw();
        let turns = sin_cos(&angles);
        let s0 = Frame::upright(self.origin(), turns[0]);
        // s1 is measured from a quarter turn: sine and cosine change places, π/2 is not rounded.
        let s1 = s0.shifted(S0_TO_S1_M).turned_y((turns[1].1, -turns[1].0));
        let e0 = s1.advanced(S1_TO_E0_M).turned_z(turns[2]);
        let elbow = [SHOULDER_TO_ELBOW_M[0], SHOULDER_TO_ELBOW_M[1] - S1_TO_E0_M];
        let e1 = e0.shifted(elbow).turned_y(turns[3]);
        let w0 = e1.advanced(E1_TO_W0_M).turned_z(turns[4]);
        let wrist = [ELBOW_TO_WRIST_M[0], ELBOW_TO_WRIST_M[1] - E1_TO_W0_M];
        let w1 = w0.shifted(wrist).turned_y(turns[5]);
        let w2 = w1.advanced(W1_TO_W2_M).turned_z(turns[6]);
        [s0, s1, e0, e1, w0, w1, w2]
    }

    /// The tool frame in `base`, as axes and origin.
    #[inline]
    pub fn tool_frame(&self, q: &Joints) -> Frame {
        self.tool_past(&self.frames(q)[6])
    }

    /// Pose of `<limb>_gripper` in `base`; the quaternion has w ≥ 0.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        self.tool_frame(q).isometry()
    }

    /// Geometric Jacobian of `<limb>_gripper` at `q`.
    pub fn jacobian(&self, q: &Joints) -> Jacobian {
        self.tool_and_jacobian(q).1
    }

    /// Tool frame and Jacobian together, for the price of little more than one.
    #[inline]
    pub fn tool_and_jacobian(&self, q: &Joints) -> (Frame, Jacobian) {
        let frames = self.frames(q);
        let tool = self.tool_past(&frames[6]);
        let mut jacobian = Jacobian::zeros();
        for (i, frame) in frames.iter().enumerate() {
            let axis = if i % 2 == 1 { frame.y } else { frame.z };
            let linear = axis.cross(&(tool.origin - frame.origin));
            jacobian.fixed_view_mut::<3, 1>(0, i).copy_from(&linear);
            jacobian.fixed_view_mut::<3, 1>(3, i).copy_from(&axis);
        }
        (tool, jacobian)
    }

    /// Manipulability `√det(J Jᵀ)` at `q` (Yoshikawa 1985); 0 where the arm loses a direction.
    pub fn manipulability(&self, q: &Joints) -> f64 {
        let j = self.jacobian(q);
        (j * j.transpose()).determinant().max(0.0).sqrt()
    }

    fn tool_past(&self, w2: &Frame) -> Frame {
        Frame { origin: w2.origin + w2.z * (WRIST_TO_HAND_M - W1_TO_W2_M + self.tool_m), ..*w2 }
    }
}

/// Cosine of [`MOUNT_YAW_RAD`].
const COS_MOUNT_YAW: f64 = 0.7071054825112363;
/// Sine of [`MOUNT_YAW_RAD`].
const SIN_MOUNT_YAW: f64 = 0.7071080798594735;

impl Frame {
    /// The frame as an isometry; the quaternion has w ≥ 0.
    pub fn isometry(&self) -> Isometry3<f64> {
        let matrix = Matrix3::from_columns(&[self.x, self.y, self.z]);
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Isometry3::from_parts(Translation3::from(self.origin), positive(rotation))
    }

    /// The point at `p` of this frame, in `base`, metres.
    #[inline(always)]
    pub fn point(&self, p: [f64; 3]) -> Vector3<f64> {
        self.origin + self.x * p[0] + self.y * p[1] + self.z * p[2]
    }

    #[inline(always)]
    fn upright(origin: Vector3<f64>, (s, c): (f64, f64)) -> Self {
        Self {
            x: Vector3::new(c, s, 0.0),
            y: Vector3::new(-s, c, 0.0),
            z: Vector3::new(0.0, 0.0, 1.0),
            origin,
        }
    }

    #[inline(always)]
    fn shifted(self, [x, z]: [f64; 2]) -> Self {
        Self { origin: self.origin + self.x * x + self.z * z, ..self }
    }

    #[inline(always)]
    fn advanced(self, z: f64) -> Self {
        Self { origin: self.origin + self.z * z, ..self }
    }

    #[inline(always)]
    fn turned_z(self, (s, c): (f64, f64)) -> Self {
        Self { x: self.x * c + self.y * s, y: self.y * c - self.x * s, ..self }
    }

    #[inline(always)]
    fn turned_y(self, (s, c): (f64, f64)) -> Self {
        Self { x: self.x * c - self.z * s, z: self.x * s + self.z * c, ..self }
    }
}

/// The same rotation with a quaternion of w ≥ 0.
pub(crate) fn positive(rotation: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    if rotation.w < 0.0 { UnitQuaternion::new_unchecked(-rotation.into_inner()) } else { rotation }
}
