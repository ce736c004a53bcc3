//! Meshes of simple bodies about the origin.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Vector3;

use crate::mesh::{Mesh, Paint, Triangle};

/// Flat faces round a full turn.
const ROUND: usize = 40;
/// Rows of faces from a ball's rim to its pole.
const ROWS: usize = 10;

/// A point of an outline that is turned about z: distance from z, height, and the surface's
/// direction outwards and up.
type Turned = (f64, f64, f64, f64);

impl Mesh {
    /// A box with these edges.
    pub fn cuboid(size: &Vector3<f64>, paint: Paint) -> Self {
        let mut mesh = Self::default();
        let half = 0.5 * size;
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let corner = |u: f64, v: f64| {
                    let mut corner = Vector3::zeros();
                    corner[axis] = side * half[axis];
                    corner[(axis + 1) % 3] = side * u * half[(axis + 1) % 3];
                    corner[(axis + 2) % 3] = v * half[(axis + 2) % 3];
                    corner
                };
                let [a, b] = [corner(-1.0, -1.0), corner(1.0, -1.0)];
                let [c, d] = [corner(1.0, 1.0), corner(-1.0, 1.0)];
                mesh.flat([a, b, c], paint);
                mesh.flat([a, c, d], paint);
            }
        }
        mesh
    }

    /// A cylinder about z.
    pub fn cylinder(radius: f64, length: f64, paint: Paint) -> Self {
        let half = 0.5 * length;
        Self::turned(
            &[
                &[(0.0, -half, 0.0, -1.0), (radius, -half, 0.0, -1.0)],
                &[(radius, -half, 1.0, 0.0), (radius, half, 1.0, 0.0)],
                &[(radius, half, 0.0, 1.0), (0.0, half, 0.0, 1.0)],
            ],
            paint,
        )
    }

    /// A cylinder about z with a half ball on either end; `length` without these.
    pub fn capsule(radius: f64, length: f64, paint: Paint) -> Self {
        let half = 0.5 * length;
        let ball = |row: usize, end: f64| {
            let (z, r) = (FRAC_PI_2 * row as f64 / ROWS as f64).sin_cos();
            (radius * r, end * (half + radius * z), r, end * z)
        };
        let below = (0..=ROWS).rev().map(|row| ball(row, -1.0));
        let outline: Vec<Turned> = below.chain((0..=ROWS).map(|row| ball(row, 1.0))).collect();
        Self::turned(&[&outline], paint)
    }

    /// A ball.
    pub fn ball(radius: f64, paint: Paint) -> Self {
        Self::capsule(radius, 0.0, paint)
    }

    /// An open bowl about z that stands on `-height/2`: outer radius at the rim, height, and how
    /// thick its wall is.
    pub fn bowl(radius: f64, height: f64, wall: f64, paint: Paint) -> Self {
        let (foot, half) = (0.5 * radius, 0.5 * height);
        // A quarter of an ellipse from the foot's edge to the rim.
        let shell = |row: usize, inset: f64, side: f64| {
            let (s, c) = (FRAC_PI_2 * row as f64 / ROWS as f64).sin_cos();
            let (width, depth) = (radius - inset - foot, height - inset);
            let (r, z) = (foot + width * s, half - depth * c);
            // Across the ellipse's tangent.
            let (out, up) = (depth * s, -width * c);
            let norm = out.hypot(up).max(1e-12);
            (r, z, side * out / norm, side * up / norm)
        };
        let outer: Vec<Turned> = (0..=ROWS).map(|row| shell(row, 0.0, 1.0)).collect();
        let inner: Vec<Turned> = (0..=ROWS).rev().map(|row| shell(row, wall, -1.0)).collect();
        let floor = half - (height - wall);
        Self::turned(
            &[
                &[(0.0, -half, 0.0, -1.0), (foot, -half, 0.0, -1.0)],
                &outer,
                &[(radius, half, 0.0, 1.0), (radius - wall, half, 0.0, 1.0)],
                &inner,
                &[(foot, floor, 0.0, 1.0), (0.0, floor, 0.0, 1.0)],
            ],
            paint,
        )
    }

    /// A rope along a line.
    pub fn tube(line: &[Vector3<f64>], radius: f64, paint: Paint) -> Self {
        let mut mesh = Self::default();
        for pair in line.windows(2) {
            let Some(along) = (pair[1] - pair[0]).try_normalize(1e-9) else { continue };
            let side = if along.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
            let u = along.cross(&side).normalize();
            let v = along.cross(&u);
            let ring = |k: usize| {
                let (s, c) = (TAU * k as f64 / 12.0).sin_cos();
                u * c + v * s
            };
            for k in 0..12 {
                let (a, b) = (ring(k), ring(k + 1));
                mesh.quad(
                    [pair[0] + a * radius, pair[0] + b * radius],
                    [pair[1] + a * radius, pair[1] + b * radius],
                    ([a, b], [a, b]),
                    paint,
                );
            }
        }
        mesh
    }

    /// Outlines turned about z.
    fn turned(outlines: &[&[Turned]], paint: Paint) -> Self {
        let mut mesh = Self::default();
        let turn = |(r, z, out, up): Turned, k: usize| {
            let (s, c) = (2.0 * PI * (k % ROUND) as f64 / ROUND as f64).sin_cos();
            (Vector3::new(r * c, r * s, z), Vector3::new(out * c, out * s, up))
        };
        for pair in outlines.iter().flat_map(|outline| outline.windows(2)) {
            for k in 0..ROUND {
                let [(a, na), (b, nb)] = [turn(pair[0], k), turn(pair[0], k + 1)];
                let [(c, nc), (d, nd)] = [turn(pair[1], k), turn(pair[1], k + 1)];
                mesh.quad([a, b], [c, d], ([na, nb], [nc, nd]), paint);
            }
        }
        mesh
    }

    /// Two triangles between two edges.
    fn quad(
        &mut self,
        [a, b]: [Vector3<f64>; 2],
        [c, d]: [Vector3<f64>; 2],
        ([na, nb], [nc, nd]): ([Vector3<f64>; 2], [Vector3<f64>; 2]),
        paint: Paint,
    ) {
        let pieces = [([a, b, d], [na, nb, nd]), ([a, d, c], [na, nd, nc])];
        for (corners, normals) in pieces {
            let area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
            if area > 1e-14 {
                self.triangles.push(Triangle { corners, normals, paint, part: 0 });
            }
        }
    }
}
