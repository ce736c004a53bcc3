//! Coordinate frames as the inner loops need them.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// A coordinate frame: columns of its rotation, and its origin in metres.
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

impl Frame {
    /// Returns the frame as an isometry; the quaternion has w ≥ 0.
    pub fn isometry(&self) -> Isometry3<f64> {
        let matrix = Matrix3::from_columns(&[self.x, self.y, self.z]);
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Isometry3::from_parts(Translation3::from(self.origin), positive(rotation))
    }

    /// Returns the point at `p` of this frame, in the frame's parent, metres.
    #[inline(always)]
    pub fn point(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.origin + self.direction(p)
    }

    /// Returns the direction `d` of this frame, in the frame's parent.
    #[inline(always)]
    pub(crate) fn direction(&self, d: &Vector3<f64>) -> Vector3<f64> {
        self.x * d.x + self.y * d.y + self.z * d.z
    }

    /// Returns a direction of the parent, in this frame's axes.
    #[inline(always)]
    pub(crate) fn seen(&self, d: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(self.x.dot(d), self.y.dot(d), self.z.dot(d))
    }

    /// Returns a frame of this one, in this one's parent.
    #[inline(always)]
    pub(crate) fn compose(&self, inner: &Self) -> Self {
        Self {
            x: self.direction(&inner.x),
            y: self.direction(&inner.y),
            z: self.direction(&inner.z),
            origin: self.point(&inner.origin),
        }
    }

    /// Returns a frame of the parent, in this one.
    pub(crate) fn relative(&self, other: &Self) -> Self {
        Self {
            x: self.seen(&other.x),
            y: self.seen(&other.y),
            z: self.seen(&other.z),
            origin: self.seen(&(other.origin - self.origin)),
        }
    }

    /// Moved along its own x and z, metres.
    #[inline(always)]
    pub(crate) fn shifted(self, [x, z]: [f64; 2]) -> Self {
        Self { origin: self.origin + self.x * x + self.z * z, ..self }
    }

    /// Turned about its own z by the angle of this sine and cosine.
    #[inline(always)]
    pub(crate) fn turned_z(self, (s, c): (f64, f64)) -> Self {
        Self { x: self.x * c + self.y * s, y: self.y * c - self.x * s, ..self }
    }

    /// Turned about its own y by the angle of this sine and cosine.
    #[inline(always)]
    pub(crate) fn turned_y(self, (s, c): (f64, f64)) -> Self {
        Self { x: self.x * c - self.z * s, z: self.x * s + self.z * c, ..self }
    }
}

impl From<&Isometry3<f64>> for Frame {
    fn from(pose: &Isometry3<f64>) -> Self {
        let rotation = pose.rotation.to_rotation_matrix();
        let column = |i: usize| rotation.matrix().column(i).into_owned();
        Self { x: column(0), y: column(1), z: column(2), origin: pose.translation.vector }
    }
}

/// Returns the same rotation with a quaternion of w ≥ 0.
pub(crate) fn positive(rotation: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    if rotation.w < 0.0 { UnitQuaternion::new_unchecked(-rotation.into_inner()) } else { rotation }
}
