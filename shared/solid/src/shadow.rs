//! What the light reaches: the scene's depths as seen from the light.

use nalgebra::{Rotation3, Vector3};

use crate::mesh::Triangle;

/// Depths along parallel rays of light.
#[derive(Debug)]
pub(crate) struct Shadow {
    turn: Rotation3<f64>,
    low: (f64, f64),
    /// Cells a metre.
    scale: f64,
    depths: Vec<f64>,
}

/// Cells along either side.
const SIDE: usize = 1600;
/// How much nearer to the light something must be to shade, metres.
const SLACK: f64 = 0.012;
/// Cells round a place that are asked, to either side: soft edges.
const SOFT: i64 = 2;

impl Shadow {
    /// Looks from the light, which comes from the direction `sun`.
    pub(crate) fn new<'a>(
        sun: &Vector3<f64>,
        casters: impl Iterator<Item = &'a Triangle> + Clone,
    ) -> Self {
        let right = sun.cross(&Vector3::z()).try_normalize(1e-6).unwrap_or(Vector3::x());
        let up = right.cross(sun).normalize();
        let turn = Rotation3::from_basis_unchecked(&[right, up, -sun.normalize()]).inverse();
        let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
        for corner in casters.clone().flat_map(|triangle| &triangle.corners) {
            let seen = turn * corner;
            low = (low.0.min(seen.x), low.1.min(seen.y));
            high = (high.0.max(seen.x), high.1.max(seen.y));
        }
        if low.0 > high.0 {
            return Self { turn, low: (0.0, 0.0), scale: 0.0, depths: Vec::new() };
        }
        let span = (high.0 - low.0).max(high.1 - low.1).max(1e-3);
        let scale = (SIDE - 4) as f64 / span;
        let low = (low.0 - 2.0 / scale, low.1 - 2.0 / scale);
        let mut shadow = Self { turn, low, scale, depths: vec![f64::MAX; SIDE * SIDE] };
        casters.for_each(|triangle| shadow.cast(triangle));
        shadow
    }

    /// Share of the light that reaches a place on a surface, 0 to 1.
    pub(crate) fn lit(&self, place: &Vector3<f64>) -> f64 {
        let seen = self.turn * place;
        let (x, y) = self.cell(&seen);
        let (mut lit, mut asked) = (0_u32, 0_u32);
        for dy in -SOFT..=SOFT {
            for dx in -SOFT..=SOFT {
                let depth = self.depth(x as i64 + dx, y as i64 + dy);
                lit += u32::from(depth > seen.z - SLACK);
                asked += 1;
            }
        }
        f64::from(lit) / f64::from(asked)
    }

    fn cell(&self, seen: &Vector3<f64>) -> (f64, f64) {
        ((seen.x - self.low.0) * self.scale, (seen.y - self.low.1) * self.scale)
    }

    fn depth(&self, x: i64, y: i64) -> f64 {
        let side = SIDE as i64;
        let inside = (0..side).contains(&x) && (0..side).contains(&y);
        if inside && !self.depths.is_empty() {
            self.depths[(y * side + x) as usize]
        } else {
            f64::MAX
        }
    }

    fn cast(&mut self, triangle: &Triangle) {
        let seen = triangle.corners.map(|corner| self.turn * corner);
        let flat = seen.map(|corner| self.cell(&corner));
        let depths = seen.map(|corner| corner.z);
        for_pixels(&flat, (SIDE, SIDE), |index, [a, b, c]| {
            let depth = a * depths[0] + b * depths[1] + c * depths[2];
            self.depths[index] = self.depths[index].min(depth);
        });
    }
}

/// Calls for every pixel whose middle lies in the triangle: its index and the weights of the three
/// corners.
pub(crate) fn for_pixels(
    [a, b, c]: &[(f64, f64); 3],
    (width, height): (usize, usize),
    mut draw: impl FnMut(usize, [f64; 3]),
) {
    let area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    if area.abs() < 1e-12 {
        return;
    }
    let range = |low: f64, high: f64, end: usize| {
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let last = ((high - 0.5).floor() + 1.0).clamp(0.0, end as f64) as usize;
        first..last
    };
    let xs = range(a.0.min(b.0).min(c.0), a.0.max(b.0).max(c.0), width);
    for y in range(a.1.min(b.1).min(c.1), a.1.max(b.1).max(c.1), height) {
        let py = y as f64 + 0.5;
        for x in xs.clone() {
            let px = x as f64 + 0.5;
            let first = ((b.0 - px) * (c.1 - py) - (b.1 - py) * (c.0 - px)) / area;
            let second = ((c.0 - px) * (a.1 - py) - (c.1 - py) * (a.0 - px)) / area;
            let weights = [first, second, 1.0 - first - second];
            if weights.iter().all(|weight| *weight >= 0.0) {
                draw(y * width + x, weights);
            }
        }
    }
}
