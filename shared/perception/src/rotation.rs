//! Rotations as matrices, for poses that are converted between frames. Without nalgebra: every
//! service reads settings of this crate, and grounding links no kinematics (`tests/layers`).

/// A rotation; the columns are the axes of the rotated frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation([[f64; 3]; 3]);

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

    /// Returns the rotation of a quaternion x, y, z, w of any length; no rotation for length 0, as
    /// in messages without one.
    pub fn from_quaternion(quaternion: [f64; 4]) -> Self {
        let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length == 0.0 {
            return Self::from_rpy([0.0; 3]);
        }
        let [x, y, z, w] = quaternion.map(|part| part / length);
        Self([
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ])
    }

    /// Returns the rotation `first` followed by this one.
    pub fn after(&self, first: &Self) -> Self {
        let Self(b) = first;
        Self(self.0.map(|row| {
            std::array::from_fn(|column| (0..3).map(|k| row[k] * b[k][column]).sum::<f64>())
        }))
    }

    /// Rotates a vector.
    pub fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>())
    }

    /// Returns the rotation of the x axis about the vertical, radians.
    pub fn yaw(&self) -> f64 {
        self.0[1][0].atan2(self.0[0][0])
    }

    /// Returns the variances along the axes, given the covariance before the rotation.
    pub fn variances(&self, covariance: &[[f64; 3]; 3]) -> [f64; 3] {
        self.0.map(|row| {
            let terms = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
            terms.map(|(i, j)| row[i] * covariance[i][j] * row[j]).sum()
        })
    }
}
