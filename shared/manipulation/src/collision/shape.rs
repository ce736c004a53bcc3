//! Convex shapes and the signed distances between them, in metres.
//!
//! A distance is negative where shapes overlap: then it is minus the depth, the shortest way to
//! part them.

use nalgebra::Vector3;

#[cfg(test)]
mod tests;

/// All points within `radius` of the segment from `a` to `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of the axis, metres.
    pub a: Vector3<f64>,
    /// The other end, metres.
    pub b: Vector3<f64>,
    /// Metres.
    pub radius: f64,
}

/// A box that stands upright: turned about the vertical only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Centre in `base`, metres.
    pub centre: [f64; 3],
    /// Extents along its own x, y and z, metres.
    pub size: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw: f64,
}

impl Capsule {
    /// Signed distance to another capsule.
    pub fn to_capsule(&self, other: &Self) -> f64 {
        segment_to_segment(self, other) - self.radius - other.radius
    }

    /// Signed distance to an upright box.
    pub fn to_cuboid(&self, cuboid: &Cuboid) -> f64 {
        let half = Vector3::from(cuboid.size) * 0.5;
        let (a, b) = (cuboid.local(&self.a), cuboid.local(&self.b));
        segment_to_box(&a, &b, &half) - self.radius
    }
}

impl Cuboid {
    /// Returns a box along the axes of `base`.
    pub const fn aligned(centre: [f64; 3], size: [f64; 3]) -> Self {
        Self { centre, size, yaw: 0.0 }
    }

    /// Returns whether a point is straight above the box.
    pub(crate) fn is_below(&self, p: &Vector3<f64>) -> bool {
        let (p, [x, y, z]) = (self.local(p), self.size);
        2.0 * p.x.abs() < x && 2.0 * p.y.abs() < y && 2.0 * p.z > z
    }

    /// Returns a point of `base` in the box's own axes, from its centre.
    #[inline]
    fn local(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let p = p - Vector3::from(self.centre);
        if self.yaw == 0.0 {
            return p;
        }
        let (s, c) = self.yaw.sin_cos();
        Vector3::new(c * p.x + s * p.y, c * p.y - s * p.x, p.z)
    }
}

/// Distance between two segments: the nearest points of the lines, each clamped in turn (Ericson,
/// Real-Time Collision Detection, 5.1.9).
#[inline]
fn segment_to_segment(p: &Capsule, q: &Capsule) -> f64 {
    let (d1, d2, r) = (p.b - p.a, q.b - q.a, p.a - q.a);
    let (a, e) = (d1.norm_squared().max(1e-18), d2.norm_squared().max(1e-18));
    let (b, c, f) = (d1.dot(&d2), d1.dot(&r), d2.dot(&r));
    let across = a * e - b * b;
    let s = if across > 1e-12 * a * e { ((b * f - c * e) / across).clamp(0.0, 1.0) } else { 0.0 };
    let t = (b * s + f) / e;
    let (s, t) = if t < 0.0 {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else if t > 1.0 {
        (((b - c) / a).clamp(0.0, 1.0), 1.0)
    } else {
        (s, t)
    };
    (r + d1 * s - d2 * t).norm()
}

/// Signed distance from a segment to a box about the origin.
///
/// The squared distance along the segment is convex, and a parabola between the up to six points
/// where the segment crosses a face's plane. Its derivative is found zero by bisecting at those.
#[inline]
pub(crate) fn segment_to_box(a: &Vector3<f64>, b: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let d = b - a;
    let beyond = |t: f64| {
        let p = a + d * t;
        let beyond = |i: usize| p[i] - p[i].clamp(-half[i], half[i]);
        Vector3::new(beyond(0), beyond(1), beyond(2))
    };
    let slope = |t: f64| beyond(t).dot(&d);
    let (mut low, mut high) = (0.0, 1.0);
    let (mut at_low, mut at_high) = (slope(low), slope(high));
    let t = if at_low >= 0.0 {
        low
    } else if at_high <= 0.0 {
        high
    } else {
        for i in 0..3 {
            for face in [-half[i], half[i]] {
                let t = (face - a[i]) / d[i];
                if t > low && t < high {
                    let at = slope(t);
                    if at < 0.0 {
                        (low, at_low) = (t, at);
                    } else {
                        (high, at_high) = (t, at);
                    }
                }
            }
        }
        low + (high - low) * (at_low / (at_low - at_high).min(-1e-300))
    };
    let distance = beyond(t.clamp(0.0, 1.0)).norm();
    if distance > 0.0 { distance } else { -depth_in_box(a, b, half) }
}

/// Returns the shortest way out of a box for a segment that meets it: along a face's normal, or
/// along a normal to both the segment and an edge.
fn depth_in_box(a: &Vector3<f64>, b: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let (middle, reach) = ((a + b) * 0.5, (b - a) * 0.5);
    let mut depth = f64::INFINITY;
    for i in 0..3 {
        depth = depth.min(half[i] + reach[i].abs() - middle[i].abs());
        let mut edge = Vector3::zeros();
        edge[i] = 1.0;
        let normal = edge.cross(&reach);
        let length = normal.norm();
        if length > 1e-12 {
            let across = half.dot(&normal.abs()) - middle.dot(&normal).abs();
            depth = depth.min(across / length);
        }
    }
    depth.max(0.0)
}
