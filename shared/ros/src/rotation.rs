//! Rotations of messages: quaternions, their order, and covariances.

use perception::Rotation;

/// Returns the rotation of a quaternion x, y, z, w of any length; no rotation for length 0, as in
/// messages without one.
pub fn of_quaternion(quaternion: [f64; 4]) -> Rotation {
    let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
    if length == 0.0 {
        return Rotation::from_rpy([0.0; 3]);
    }
    let [x, y, z, w] = quaternion.map(|part| part / length);
    Rotation([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ])
}

/// Returns the rotation `first` followed by `then`.
pub(crate) fn followed(first: &Rotation, then: &Rotation) -> Rotation {
    let (Rotation(a), Rotation(b)) = (then, first);
    Rotation(a.map(|row| {
        std::array::from_fn(|column| (0..3).map(|k| row[k] * b[k][column]).sum::<f64>())
    }))
}

/// Returns the rotation of the x axis about the vertical, radians.
pub(crate) fn yaw_of(rotation: &Rotation) -> f64 {
    rotation.0[1][0].atan2(rotation.0[0][0])
}

/// Returns the variances along the axes, given the covariance before the rotation.
pub(crate) fn variances(rotation: &Rotation, covariance: &[[f64; 3]; 3]) -> [f64; 3] {
    rotation.0.map(|row| {
        let terms = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        terms.map(|(i, j)| row[i] * covariance[i][j] * row[j]).sum()
    })
}
