//! A box in any orientation, as something held is.

use nalgebra::{Isometry3, Vector3};

use crate::collision::shape::{Capsule, Cuboid, segment_to_box};

#[cfg(test)]
mod tests;

/// A box in any orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    /// Its own frame in `base`, the origin at its centre.
    pub(crate) pose: Isometry3<f64>,
    /// Half of its extents along its own axes, metres.
    pub(crate) half: Vector3<f64>,
}

impl Block {
    /// Signed distance to a capsule, metres.
    pub(crate) fn to_capsule(self, capsule: &Capsule) -> f64 {
        let local = |p: &Vector3<f64>| self.pose.inverse_transform_vector(&(p - self.centre()));
        segment_to_box(&local(&capsule.a), &local(&capsule.b), &self.half) - capsule.radius
    }

    /// Signed distance to an upright box, metres, by separating axes (Gottschalk, Lin and Manocha,
    /// 1996): negative exactly where they overlap, and then minus the depth. Where a corner is
    /// nearest to an edge or a corner it is less than the distance.
    pub(crate) fn to_cuboid(self, cuboid: &Cuboid) -> f64 {
        let between = Vector3::from(cuboid.centre) - self.centre();
        let half = Vector3::from(cuboid.size) * 0.5;
        let reach = self.half.norm() + half.norm();
        let centres = between.norm();
        if centres > 2.0 * reach {
            return centres - reach;
        }
        let (own, theirs) = (self.axes(), axes_of(cuboid));
        let mut gap = f64::NEG_INFINITY;
        let mut look = |axis: &Vector3<f64>| {
            let extent = |axes: &[Vector3<f64>; 3], half: &Vector3<f64>| -> f64 {
                (0..3).map(|i| (axes[i].dot(axis) * half[i]).abs()).sum()
            };
            let apart = between.dot(axis).abs() - extent(&own, &self.half) - extent(&theirs, &half);
            gap = gap.max(apart);
        };
        own.iter().chain(&theirs).for_each(&mut look);
        for a in &own {
            for b in &theirs {
                let axis = a.cross(b);
                let length = axis.norm();
                // Edges that are all but parallel have no axis of their own.
                if length > PARALLEL {
                    look(&(axis / length));
                }
            }
        }
        gap
    }

    /// Returns the eight corners in `base`.
    pub(crate) fn corners(self) -> [Vector3<f64>; 8] {
        let axes = self.axes();
        std::array::from_fn(|k| {
            let side = |i: usize| if k >> i & 1 == 1 { self.half[i] } else { -self.half[i] };
            self.centre() + axes[0] * side(0) + axes[1] * side(1) + axes[2] * side(2)
        })
    }

    pub(crate) fn centre(self) -> Vector3<f64> {
        self.pose.translation.vector
    }

    fn axes(self) -> [Vector3<f64>; 3] {
        let matrix = self.pose.rotation.to_rotation_matrix();
        std::array::from_fn(|i| matrix.matrix().column(i).into_owned())
    }
}

/// Sine of the angle below which edges count as parallel.
const PARALLEL: f64 = 1e-6;

fn axes_of(cuboid: &Cuboid) -> [Vector3<f64>; 3] {
    let (s, c) = cuboid.yaw.sin_cos();
    [Vector3::new(c, s, 0.0), Vector3::new(-s, c, 0.0), Vector3::z()]
}
