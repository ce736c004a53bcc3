//! The smallest capsules round a hull.

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::points::{Hull, directions};

/// Directions of the axis that are tried, and then turns about the best, radians.
const AXES: usize = 160;
const TURNS: [f64; 4] = [0.12, 0.05, 0.02, 0.008];

/// A hull is cut where its parts have capsules of less than this share of its own capsule's volume.
const WORTH_CUTTING: f64 = 0.93;

/// Places of a cut, as shares of the length.
const CUTS: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];

/// A cylinder with half balls at its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Capsule {
    pub(crate) a: Vector3<f64>,
    pub(crate) b: Vector3<f64>,
    pub(crate) radius: f64,
}

impl Capsule {
    pub(crate) fn volume(&self) -> f64 {
        let (r, length) = (self.radius, (self.b - self.a).norm());
        std::f64::consts::PI * r * r * (length + 4.0 / 3.0 * r)
    }

    /// Distance of a point from the surface, negative inside.
    pub(crate) fn distance(&self, point: &Vector3<f64>) -> f64 {
        let axis = self.b - self.a;
        let along = axis.norm_squared();
        let t =
            if along > 0.0 { ((point - self.a).dot(&axis) / along).clamp(0.0, 1.0) } else { 0.0 };
        (point - self.a - axis * t).norm() - self.radius
    }

    /// Returns points on the surface.
    pub(crate) fn surface(&self, count: usize) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let axis = self.b - self.a;
        directions(count).flat_map(move |direction| {
            let end = if direction.dot(&axis) > 0.0 { self.b } else { self.a };
            let middle = (self.a + self.b) * 0.5;
            let aside = direction - axis * (direction.dot(&axis) / axis.norm_squared().max(1e-12));
            let aside = aside.try_normalize(1e-9).unwrap_or(direction);
            [end + direction * self.radius, middle + aside * self.radius]
        })
    }

    /// Its frame, z along the axis, and the distance between the centres of its ends.
    pub(crate) fn frame(&self) -> (Isometry3<f64>, f64) {
        let axis = self.b - self.a;
        let turn = Rotation3::rotation_between(&Vector3::z(), &axis).unwrap_or_else(|| {
            Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        });
        let middle = Translation3::from((self.a + self.b) * 0.5);
        (Isometry3::from_parts(middle, UnitQuaternion::from_rotation_matrix(&turn)), axis.norm())
    }

    pub(crate) fn at(&self, pose: &Isometry3<f64>) -> Self {
        let moved = |at: &Vector3<f64>| pose.rotation * at + pose.translation.vector;
        Self { a: moved(&self.a), b: moved(&self.b), radius: self.radius }
    }

    /// Distance from another one, negative where they overlap.
    pub(crate) fn to(&self, other: &Self) -> f64 {
        let own = manipulation::Capsule { a: self.a, b: self.b, radius: self.radius };
        let theirs = manipulation::Capsule { a: other.a, b: other.b, radius: other.radius };
        own.to_capsule(&theirs)
    }
}

/// Returns capsules that together enclose a hull: one, or, down to `cuts` times, two for each where they are smaller.
pub(crate) fn enclosing(hull: &Hull, cuts: usize) -> Vec<Capsule> {
    let one = smallest(hull);
    if cuts == 0 {
        return vec![one];
    }
    let axis = (one.b - one.a).try_normalize(1e-9).unwrap_or_else(Vector3::z);
    let mut best = (vec![one], WORTH_CUTTING * one.volume());
    for normal in principal(&axis) {
        let (low, high) = hull.extent(&normal);
        for share in CUTS {
            let parts = hull.cut(&normal, low + (high - low) * share);
            let [Some(a), Some(b)] = parts else { continue };
            let pair = [smallest(&a), smallest(&b)];
            let volume = pair.iter().map(Capsule::volume).sum();
            if volume < best.1 {
                let [mut all, more] = [a, b].map(|part| enclosing(&part, cuts - 1));
                all.extend(more);
                best = (all, volume);
            }
        }
    }
    best.0
}

/// An axis and two directions at right angles to it.
fn principal(axis: &Vector3<f64>) -> [Vector3<f64>; 3] {
    let aside = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    [*axis, aside, axis.cross(&aside)]
}

/// Returns the smallest capsule of many axes.
fn smallest(hull: &Hull) -> Capsule {
    let upper = directions(AXES).filter(|axis| axis.z >= 0.0);
    let tried = upper.map(|axis| (along(hull, &axis), axis));
    let less = |a: &(Capsule, Vector3<f64>), b: &(Capsule, Vector3<f64>)| {
        a.0.volume().total_cmp(&b.0.volume())
    };
    let start = (along(hull, &Vector3::z()), Vector3::z());
    let mut best = tried.chain([start]).min_by(less).unwrap_or(start);
    for turn in TURNS {
        let [_, u, v] = principal(&best.1);
        let around = (0..8).map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            (best.1 + (u * cos + v * sin) * turn).normalize()
        });
        let around: Vec<_> = around.map(|axis| (along(hull, &axis), axis)).collect();
        best = around.into_iter().chain([best]).min_by(less).unwrap_or(best);
    }
    best.0
}

/// Returns the capsule round a hull with an axis of this direction.
fn along(hull: &Hull, axis: &Vector3<f64>) -> Capsule {
    let [_, u, v] = principal(axis);
    let flat: Vec<(f64, f64)> = hull.points.iter().map(|at| (at.dot(&u), at.dot(&v))).collect();
    let (x, y, radius) = circle(&flat);
    let (mut a, mut b) = (f64::INFINITY, f64::NEG_INFINITY);
    for (point, (px, py)) in hull.points.iter().zip(&flat) {
        let aside = (px - x) * (px - x) + (py - y) * (py - y);
        let cap = (radius * radius - aside).max(0.0).sqrt();
        let height = point.dot(axis);
        (a, b) = (a.min(height + cap), b.max(height - cap));
    }
    if a > b {
        // A ball encloses it: any centre between does.
        (a, b) = (0.5 * (a + b), 0.5 * (a + b));
    }
    let centre = u * x + v * y;
    Capsule { a: centre + axis * a, b: centre + axis * b, radius }
}

/// Steps towards the smallest circle.
const CIRCLE_STEPS: usize = 40;

/// Returns a circle round points that is hardly larger than the smallest one (Bădoiu and Clarkson, 2003).
fn circle(points: &[(f64, f64)]) -> (f64, f64, f64) {
    let count = points.len().max(1) as f64;
    let mut x = points.iter().map(|at| at.0).sum::<f64>() / count;
    let mut y = points.iter().map(|at| at.1).sum::<f64>() / count;
    let mut best = (x, y, f64::INFINITY);
    for step in 0..CIRCLE_STEPS {
        let (mut far, mut most) = ((x, y), 0.0);
        for at in points {
            let (dx, dy) = (at.0 - x, at.1 - y);
            let squared = dx * dx + dy * dy;
            if squared > most {
                (far, most) = (*at, squared);
            }
        }
        if most < best.2 {
            best = (x, y, most);
        }
        let share = 1.0 / (step as f64 + 2.0);
        (x, y) = (x + (far.0 - x) * share, y + (far.1 - y) * share);
    }
    (best.0, best.1, best.2.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on the surface of a capsule, turned and moved.
    fn rod(length: f64, radius: f64) -> Vec<Vector3<f64>> {
        let b = Vector3::new(1.0, 2.0, -0.5).normalize() * length + Vector3::new(0.3, 0.1, 0.2);
        let own = Capsule { a: Vector3::new(0.3, 0.1, 0.2), b, radius };
        own.surface(800).collect()
    }

    #[test]
    fn capsule_round_a_rod_is_the_rod() {
        let hull = Hull::new(&rod(0.5, 0.08)).unwrap();
        let found = enclosing(&hull, 2);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].radius - 0.08).abs() < 0.004, "{found:?}");
        assert!(((found[0].b - found[0].a).norm() - 0.5).abs() < 0.02, "{found:?}");
        let left_out = hull.points.iter().map(|at| found[0].distance(at)).fold(f64::MIN, f64::max);
        assert!(left_out < 1e-9, "{left_out}");
    }

    #[test]
    fn long_wedge_gets_two_capsules_that_leave_nothing_out() {
        let mut corners = Vec::new();
        for (x, half) in [(0.0, 0.02), (0.6, 0.15)] {
            for (sy, sz) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                corners.push(Vector3::new(x, sy * half, sz * half));
            }
        }
        let hull = Hull::new(&corners).unwrap();
        let found = enclosing(&hull, 1);
        assert_eq!(found.len(), 2, "{found:?}");
        for t in 0..=10 {
            // Along each edge, so that the cut is covered, too.
            for k in 0..4 {
                let point = corners[k] + (corners[k + 4] - corners[k]) * (f64::from(t) / 10.0);
                let out = found.iter().map(|own| own.distance(&point)).fold(f64::MAX, f64::min);
                assert!(out < 1e-9, "{point:?}: {out}");
            }
        }
    }
}
