//! Convex hulls as sets of points: extreme points, distances, cuts.

use nalgebra::{Isometry3, Matrix3, Vector3};

/// Directions in which extreme points are kept. What is left out of the hull so is below a millimetre or two for the
/// links of an arm, and is measured.
const DIRECTIONS: usize = 320;

/// Steps of a distance before its last lower bound is taken.
const STEPS_MAX: usize = 40;

/// A convex hull: the points that are extreme in many directions, and a ball round them.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    pub(crate) points: Vec<Vector3<f64>>,
    pub(crate) centre: Vector3<f64>,
    pub(crate) radius: f64,
}

/// Directions that are spread evenly over the sphere (a Fibonacci lattice).
pub(crate) fn directions(count: usize) -> impl Iterator<Item = Vector3<f64>> {
    let golden = std::f64::consts::PI * (5.0f64.sqrt() - 1.0);
    (0..count).map(move |k| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / count as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    })
}

impl Hull {
    /// Returns the hull of some points; none of none.
    pub(crate) fn new(points: &[Vector3<f64>]) -> Option<Self> {
        let axes = (0..3).flat_map(|axis| {
            let mut unit = Vector3::zeros();
            unit[axis] = 1.0;
            [unit, -unit]
        });
        let mut kept: Vec<usize> = directions(DIRECTIONS)
            .chain(axes)
            .filter_map(|direction| farthest(points, &direction))
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let points: Vec<_> = kept.into_iter().map(|at| points[at]).collect();
        let low = points.iter().copied().reduce(|low, at| low.inf(&at))?;
        let high = points.iter().copied().reduce(|high, at| high.sup(&at))?;
        let centre = (low + high) * 0.5;
        let radius = points.iter().map(|at| (at - centre).norm()).fold(0.0, f64::max);
        Some(Self { points, centre, radius })
    }

    /// The same at a pose.
    pub(crate) fn at(&self, pose: &Isometry3<f64>) -> Self {
        let moved = |at: &Vector3<f64>| pose.rotation * at + pose.translation.vector;
        let points = self.points.iter().map(moved).collect();
        Self { points, centre: moved(&self.centre), radius: self.radius }
    }

    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        farthest(&self.points, direction).map_or(self.centre, |at| self.points[at])
    }

    /// Extent along a direction.
    pub(crate) fn extent(&self, direction: &Vector3<f64>) -> (f64, f64) {
        let along = self.points.iter().map(|at| at.dot(direction));
        along.fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)))
    }

    /// Returns the distance to another hull, 0 where they meet, and a lower bound of it above `within`: of no more
    /// interest (Gilbert, Johnson and Keerthi, 1988).
    pub(crate) fn distance(&self, other: &Self, within: f64) -> f64 {
        let apart = (self.centre - other.centre).norm() - self.radius - other.radius;
        if apart > within {
            return apart;
        }
        let difference = |v: &Vector3<f64>| self.support(&-v) - other.support(v);
        let mut nearest = self.centre - other.centre;
        let mut simplex: Vec<Vector3<f64>> = Vec::with_capacity(4);
        for _ in 0..STEPS_MAX {
            let norm = nearest.norm();
            if norm < 1e-9 {
                return 0.0;
            }
            let next = difference(&nearest);
            let bound = next.dot(&nearest) / norm;
            if bound > within || norm - bound < 1e-6 && !simplex.is_empty() {
                return if bound > within { bound } else { norm };
            }
            simplex.push(next);
            nearest = reduce(&mut simplex);
            if simplex.len() == 4 {
                return 0.0;
            }
        }
        nearest.norm()
    }

    /// Returns the parts of the hull below and above a plane.
    pub(crate) fn cut(&self, normal: &Vector3<f64>, at: f64) -> [Option<Self>; 2] {
        let height = |point: &Vector3<f64>| point.dot(normal) - at;
        let (low, high): (Vec<Vector3<f64>>, Vec<Vector3<f64>>) =
            self.points.iter().copied().partition(|point| height(point) <= 0.0);
        let mut edge = Vec::with_capacity(low.len() * high.len());
        for a in &low {
            for b in &high {
                let (below, above) = (height(a), height(b));
                edge.push(a + (b - a) * (below / (below - above)));
            }
        }
        // The section is reduced first: it is a point per pair.
        let edge = Self::new(&edge).map(|hull| hull.points).unwrap_or_default();
        [low, high].map(|mut part| {
            part.extend(&edge);
            Self::new(&part)
        })
    }
}

fn farthest(points: &[Vector3<f64>], direction: &Vector3<f64>) -> Option<usize> {
    let mut best = None;
    let mut most = f64::NEG_INFINITY;
    for (index, point) in points.iter().enumerate() {
        let along = point.dot(direction);
        if along > most {
            (most, best) = (along, Some(index));
        }
    }
    best
}

/// Returns the point of a simplex that is nearest to the origin, and keeps the corners that it lies between; all four
/// where the origin is inside.
fn reduce(simplex: &mut Vec<Vector3<f64>>) -> Vector3<f64> {
    let mut best = (f64::INFINITY, Vector3::zeros(), 0usize);
    for mask in 1..1usize << simplex.len() {
        let corners: Vec<&Vector3<f64>> =
            (0..simplex.len()).filter(|i| mask >> i & 1 == 1).map(|i| &simplex[i]).collect();
        if let Some(point) = within(&corners) {
            let norm = point.norm_squared();
            // Fewer corners win where the point is the same.
            if norm < best.0 - 1e-18 {
                best = (norm, point, mask);
            }
        }
    }
    let mut index = 0;
    simplex.retain(|_| {
        index += 1;
        best.2 >> (index - 1) & 1 == 1
    });
    best.1
}

/// Returns the point nearest to the origin of what some corners span, if it lies between them.
fn within(corners: &[&Vector3<f64>]) -> Option<Vector3<f64>> {
    let a = corners[0];
    let side = |i: usize| corners[i] - a;
    match corners.len() {
        1 => Some(*a),
        2 => {
            let u = side(1);
            let t = -a.dot(&u) / u.norm_squared();
            (t > 0.0 && t < 1.0).then(|| a + u * t)
        }
        3 => {
            let (u, v) = (side(1), side(2));
            let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
            let area = uu * vv - uv * uv;
            if area < 1e-24 {
                return None;
            }
            let (s, t) = (-a.dot(&u), -a.dot(&v));
            let (s, t) = ((s * vv - t * uv) / area, (t * uu - s * uv) / area);
            (s > 0.0 && t > 0.0 && s + t < 1.0).then(|| a + u * s + v * t)
        }
        _ => {
            let solved = Matrix3::from_columns(&[side(1), side(2), side(3)]).try_inverse()? * -a;
            let inside = solved.iter().all(|share| *share > 0.0) && solved.sum() < 1.0;
            inside.then(Vector3::zeros)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    fn cube(edge: f64) -> Hull {
        let side = |k: usize, i: usize| if k >> i & 1 == 1 { 0.5 * edge } else { -0.5 * edge };
        let corners: Vec<_> =
            (0..8).map(|k| Vector3::new(side(k, 0), side(k, 1), side(k, 2))).collect();
        Hull::new(&corners).unwrap()
    }

    #[test]
    fn cubes_are_as_far_apart_as_their_faces_edges_and_corners() {
        let (a, far) = (cube(1.0), f64::INFINITY);
        for (to, expected) in [
            ([1.5, 0.0, 0.0], 0.5),
            ([1.5, 1.5, 0.2], 0.5f64.sqrt()),
            ([2.0, 2.0, 2.0], 3.0f64.sqrt()),
            ([0.9, 0.3, 0.0], 0.0),
            ([0.1, 0.0, 0.0], 0.0),
        ] {
            let [x, y, z] = to;
            let b = cube(1.0).at(&Isometry3::translation(x, y, z));
            let found = a.distance(&b, far);
            assert!((found - expected).abs() < 1e-5, "{to:?}: {found}");
            assert!((b.distance(&a, far) - expected).abs() < 1e-5);
        }
        // A corner that points at a face.
        let turn = UnitQuaternion::rotation_between(&Vector3::repeat(1.0), &Vector3::x()).unwrap();
        let b = cube(1.0).at(&Isometry3::from_parts(Vector3::new(-2.0, 0.0, 0.0).into(), turn));
        let found = a.distance(&b, far);
        assert!((found - (1.5 - 0.5 * 3.0f64.sqrt())).abs() < 1e-5, "{found}");
    }

    #[test]
    fn parts_of_a_cut_hull_are_what_lies_on_either_side() {
        let [low, high] = cube(1.0).cut(&Vector3::x(), 0.2).map(Option::unwrap);
        let extent = |hull: &Hull| hull.extent(&Vector3::x());
        assert!((extent(&low).1 - 0.2).abs() < 1e-12 && (extent(&high).0 - 0.2).abs() < 1e-12);
        assert_eq!(low.extent(&Vector3::y()), (-0.5, 0.5));
        assert_eq!(high.extent(&Vector3::z()), (-0.5, 0.5));
    }
}
