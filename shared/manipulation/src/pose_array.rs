//! Poses as they stand in messages and journals: x, y, z in metres, and the quaternion x, y, z, w.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// Returns the seven numbers of a pose.
pub fn to_array(pose: &Isometry3<f64>) -> [f64; 7] {
    let (p, r) = (pose.translation, pose.rotation);
    [p.x, p.y, p.z, r.i, r.j, r.k, r.w]
}

/// Returns the pose of seven numbers.
pub fn from_array([x, y, z, i, j, k, w]: &[f64; 7]) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(*w, *i, *j, *k));
    Isometry3::from_parts(Translation3::new(*x, *y, *z), rotation)
}
