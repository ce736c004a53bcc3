//! Rotations as matrices, for poses that are converted between frames. Without nalgebra: every
//! service reads settings of this crate, and grounding links no kinematics (`tests/layers`).

/// A rotation, by rows; the columns are the axes of the rotated frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation(pub [[f64; 3]; 3]);

impl Rotation {
    /// Returns the rotation by roll, pitch and yaw about fixed axes, radians.
    pub fn from_rpy(rpy: [f64; 3]) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = rpy.map(f64::sin_cos);
        Self([
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ])
    }

    /// Rotates a vector.
    pub fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>())
    }
}
