//! Solids as what lies inside them, and points all over their surfaces. Shares no code with the
//! planner's distances.

use nalgebra::{Isometry3, Point3, Vector3};
use robot_model::Shape;

/// Distance between neighbouring points of a surface, metres.
const SPACING_M: f64 = 0.02;

/// Interior of a solid, in its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Inside {
    /// Within `radius` of the segment.
    Round { a: Vector3<f64>, b: Vector3<f64>, radius: f64 },
    /// Within half the extents of the origin.
    Box { half: Vector3<f64> },
}

/// A solid in its own frame.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    pub(crate) name: String,
    inside: Inside,
    points: Vec<Point3<f64>>,
    /// A ball that holds all of it.
    centre: Point3<f64>,
    reach: f64,
}

impl Solid {
    /// Returns a shape of a description and its pose in the frame of its link. Cylinders have round ends
    /// here.
    pub(crate) fn described(name: &str, body: &robot_model::Body) -> (Self, Isometry3<f64>) {
        let along = |length: f64, radius: f64| {
            let end = Vector3::z() * (0.5 * length);
            Self::round(name, -end, end, radius)
        };
        let solid = match &body.shape {
            Shape::Capsule { radius, length } | Shape::Cylinder { radius, length } => {
                along(*length, *radius)
            }
            Shape::Sphere { radius } => along(0.0, *radius),
            Shape::Box { size } => Self::cuboid(name, (*size).into()),
            Shape::Mesh { file } => panic!("{file}: no mesh is supported"),
        };
        (solid, body.origin)
    }

    pub(crate) fn round(name: &str, a: Vector3<f64>, b: Vector3<f64>, radius: f64) -> Self {
        let along = b - a;
        let axis = if along.norm() > 1e-9 { along.normalize() } else { Vector3::z() };
        let side = axis.cross(&if axis.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() });
        let (u, v) = (side.normalize(), axis.cross(&side.normalize()));
        let turns = (2.0 * std::f64::consts::PI * radius / SPACING_M).ceil() as usize;
        let mut points = Vec::new();
        let mut ring = |centre: Vector3<f64>, out: f64, up: f64| {
            for k in 0..turns {
                let (s, c) = (2.0 * std::f64::consts::PI * k as f64 / turns as f64).sin_cos();
                points.push(Point3::from(centre + (u * c + v * s) * out + axis * up));
            }
        };
        let rings = (along.norm() / SPACING_M).ceil() as usize;
        for k in 0..=rings {
            ring(a + along * (k as f64 / rings.max(1) as f64), radius, 0.0);
        }
        let caps = (0.5 * std::f64::consts::PI * radius / SPACING_M).ceil() as usize;
        for k in 1..=caps {
            let (s, c) = (0.5 * std::f64::consts::PI * k as f64 / caps as f64).sin_cos();
            ring(b, radius * c, radius * s);
            ring(a, radius * c, -radius * s);
        }
        let centre = Point3::from((a + b) * 0.5);
        let reach = 0.5 * along.norm() + radius;
        Self {
            name: name.to_owned(),
            inside: Inside::Round { a, b, radius },
            points,
            centre,
            reach,
        }
    }

    pub(crate) fn cuboid(name: &str, size: [f64; 3]) -> Self {
        let half = Vector3::from(size) * 0.5;
        let counts = size.map(|edge| (edge / SPACING_M).ceil().clamp(1.0, 60.0) as usize);
        let mut points = Vec::new();
        for i in 0..=counts[0] {
            for j in 0..=counts[1] {
                for k in 0..=counts[2] {
                    let at = [i, j, k];
                    if (0..3).any(|n| at[n] == 0 || at[n] == counts[n]) {
                        points.push(Point3::from(Vector3::from_fn(|n, _| {
                            half[n] * (2.0 * at[n] as f64 / counts[n] as f64 - 1.0)
                        })));
                    }
                }
            }
        }
        let (inside, reach) = (Inside::Box { half }, half.norm());
        Self { name: name.to_owned(), inside, points, centre: Point3::origin(), reach }
    }

    /// Returns the same without points of its own: for what is large and has no edges in reach.
    pub(crate) fn without_points(self) -> Self {
        Self { points: Vec::new(), ..self }
    }

    /// Returns the depth of a point of its own frame, metres; not positive outside.
    fn depth(&self, p: &Point3<f64>) -> f64 {
        match self.inside {
            Inside::Round { a, b, radius } => {
                let along = b - a;
                let share = (p.coords - a).dot(&along) / along.norm_squared().max(1e-18);
                radius - (p.coords - a - along * share.clamp(0.0, 1.0)).norm()
            }
            Inside::Box { half } => {
                (0..3).map(|n| half[n] - p[n].abs()).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Returns the overlap depth of this solid at `pose` and `other` at `there`, metres, as far as
    /// points of their surfaces show; 0 if they do not overlap.
    pub(crate) fn overlap(
        &self,
        pose: &Isometry3<f64>,
        other: &Self,
        there: &Isometry3<f64>,
    ) -> f64 {
        let apart = (pose * self.centre - there * other.centre).norm();
        if apart > self.reach + other.reach {
            return 0.0;
        }
        let seen = there.inv_mul(pose);
        self.deepest(other, &seen).max(other.deepest(self, &seen.inverse()))
    }

    /// Returns the deepest of this solid's points in `other`, which sees this one at `seen`.
    fn deepest(&self, other: &Self, seen: &Isometry3<f64>) -> f64 {
        // As far outside as this one's ball is wide, and nothing of it is inside.
        if other.depth(&(seen * self.centre)) < -self.reach {
            return 0.0;
        }
        let matrix = seen.to_matrix();
        let depth = |p: &Point3<f64>| other.depth(&matrix.transform_point(p));
        self.points.iter().map(depth).fold(0.0, f64::max)
    }
}
