//! Joint-space paths: geometry without time.
//!
//! A path is a chain of cubic pieces over a path length `s`, once continuously differentiable. The
//! rounded polyline stays inside the convex hull of its waypoints, so inside the joint limits if
//! they are.

use crate::kinematics::limb::{Joints, distance};

#[cfg(test)]
mod tests;

/// One cubic of a path, `q(s) = Σ cᵢ (s − start)ⁱ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub(crate) start: f64,
    pub(crate) length: f64,
    /// Coefficients of 1, s, s², s³, each per joint.
    pub(crate) coefficients: [Joints; 4],
}

/// A once continuously differentiable path in joint space.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    pieces: Vec<Piece>,
    /// The last waypoint, to the last bit; the last piece ends there but for rounding.
    end: Joints,
}

/// Waypoints closer together than this, in any joint, are one, radians.
const SAME_RAD: f64 = 1e-9;

impl Path {
    /// Straight lines through the waypoints, corners rounded by parabolas that begin at most
    /// `blend_rad` before a waypoint and end as far after it (Euclidean joint distance, never more
    /// than half a line). With `blend_rad` infinite it is the quadratic B-spline of the waypoints.
    ///
    /// One waypoint, or several equal ones, make a path of no length.
    pub fn rounded(waypoints: &[Joints], blend_rad: f64) -> Self {
        let points = distinct(waypoints);
        let lines: Vec<Line> = points.windows(2).map(|w| Line::between(&w[0], &w[1])).collect();
        let mut pieces = Pieces::default();
        let mut entered = 0.0;
        for (i, line) in lines.iter().enumerate() {
            let corner = lines.get(i + 1).map_or(0.0, |next| {
                blend_rad.max(0.0).min(0.5 * line.length).min(0.5 * next.length)
            });
            let from = along(&line.from, &line.direction, entered);
            pieces.line(from, line.direction, line.length - entered - corner);
            if let Some(next) = lines.get(i + 1) {
                let from = along(&line.from, &line.direction, line.length - corner);
                pieces.parabola(from, line.direction, next.direction, 2.0 * corner);
            }
            entered = corner;
        }
        let end = waypoints.last().copied().unwrap_or([0.0; 7]);
        if pieces.0.is_empty() {
            pieces.rest(end);
        }
        Self { pieces: pieces.0, end }
    }

    /// Returns the natural cubic spline through the waypoints, knots evenly spaced on [0, 1]. It
    /// may leave the waypoints' hull: check it against the limits.
    pub fn spline(waypoints: &[Joints]) -> Self {
        let mut pieces = Pieces::default();
        let end = waypoints.last().copied().unwrap_or([0.0; 7]);
        if waypoints.len() < 2 {
            pieces.rest(end);
            return Self { pieces: pieces.0, end };
        }
        let h = 1.0 / (waypoints.len() - 1) as f64;
        let curvature = natural_spline_curvature(waypoints, h);
        for (i, (ends, bend)) in waypoints.windows(2).zip(curvature.windows(2)).enumerate() {
            let coefficients = [
                ends[0],
                each(|j| (ends[1][j] - ends[0][j]) / h - h * (2.0 * bend[0][j] + bend[1][j]) / 6.0),
                each(|j| 0.5 * bend[0][j]),
                each(|j| (bend[1][j] - bend[0][j]) / (6.0 * h)),
            ];
            pieces.0.push(Piece { start: i as f64 * h, length: h, coefficients });
        }
        Self { pieces: pieces.0, end }
    }

    /// Returns the path that `pieces`, each beginning where the one before ends, make up to `end`.
    ///
    /// # Panics
    /// Without a piece.
    pub(crate) fn of_pieces(pieces: Vec<Piece>, end: Joints) -> Self {
        assert!(!pieces.is_empty(), "a path has at least one piece");
        Self { pieces, end }
    }

    /// Returns whether it is one line, and longer than nothing.
    pub(crate) fn is_straight(&self) -> bool {
        let [piece] = &self.pieces[..] else { return false };
        piece.length > 0.0 && piece.coefficients[2..].iter().flatten().all(|c| *c == 0.0)
    }

    /// Its first point.
    pub(crate) fn start(&self) -> Joints {
        self.pieces[0].coefficients[0]
    }

    /// Its last point.
    pub(crate) fn end(&self) -> Joints {
        self.end
    }

    /// Length of the path parameter; 0 for a path that goes nowhere.
    pub fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.start + piece.length)
    }

    /// Position on `piece` at `s` past its start.
    pub(crate) fn position(&self, piece: usize, s: f64) -> Joints {
        let is_end = piece + 1 == self.pieces.len() && s >= self.pieces[piece].length;
        if is_end { self.end } else { self.pieces[piece].position(s) }
    }

    pub(crate) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}

impl Piece {
    /// Position at `s` past the piece's start.
    pub(crate) fn position(&self, s: f64) -> Joints {
        let [c0, c1, c2, c3] = &self.coefficients;
        each(|j| c0[j] + s * (c1[j] + s * (c2[j] + s * c3[j])))
    }

    /// First derivative by `s`.
    pub(crate) fn slope(&self, s: f64) -> Joints {
        let [_, c1, c2, c3] = &self.coefficients;
        each(|j| c1[j] + s * (2.0 * c2[j] + s * 3.0 * c3[j]))
    }

    /// Second derivative by `s`.
    pub(crate) fn bend(&self, s: f64) -> Joints {
        let [_, _, c2, c3] = &self.coefficients;
        each(|j| 2.0 * c2[j] + 6.0 * s * c3[j])
    }
}

fn each(f: impl FnMut(usize) -> f64) -> Joints {
    std::array::from_fn(f)
}

fn along(from: &Joints, direction: &Joints, length: f64) -> Joints {
    each(|j| from[j] + direction[j] * length)
}

fn distinct(waypoints: &[Joints]) -> Vec<Joints> {
    let mut points: Vec<Joints> = Vec::with_capacity(waypoints.len());
    for q in waypoints {
        let same = |p: &Joints| p.iter().zip(q).all(|(a, b)| (a - b).abs() <= SAME_RAD);
        if !points.last().is_some_and(same) {
            points.push(*q);
        }
    }
    points
}

struct Line {
    from: Joints,
    /// Of unit length, so that the path parameter is joint distance.
    direction: Joints,
    length: f64,
}

impl Line {
    fn between(from: &Joints, to: &Joints) -> Self {
        let length = distance(from, to);
        Self { from: *from, direction: each(|j| (to[j] - from[j]) / length), length }
    }
}

/// The pieces of a path under construction.
#[derive(Default)]
struct Pieces(Vec<Piece>);

impl Pieces {
    fn end(&self) -> f64 {
        self.0.last().map_or(0.0, |piece| piece.start + piece.length)
    }

    fn push(&mut self, length: f64, coefficients: [Joints; 4]) {
        self.0.push(Piece { start: self.end(), length, coefficients });
    }

    fn line(&mut self, from: Joints, direction: Joints, length: f64) {
        if length > 1e-12 {
            self.push(length, [from, direction, [0.0; 7], [0.0; 7]]);
        }
    }

    /// From `direction` to `next` over `length`, tangent to both.
    fn parabola(&mut self, from: Joints, direction: Joints, next: Joints, length: f64) {
        if length > 1e-12 {
            let bend = each(|j| (next[j] - direction[j]) / (2.0 * length));
            self.push(length, [from, direction, bend, [0.0; 7]]);
        }
    }

    fn rest(&mut self, at: Joints) {
        self.push(0.0, [at, [0.0; 7], [0.0; 7], [0.0; 7]]);
    }
}

/// Second derivatives at the knots of the natural cubic spline, by Thomas's algorithm.
fn natural_spline_curvature(points: &[Joints], h: f64) -> Vec<Joints> {
    let n = points.len();
    let mut curvature = vec![[0.0; 7]; n];
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        curvature[i] = each(|j| {
            let right = 6.0 * (points[i + 1][j] - 2.0 * points[i][j] + points[i - 1][j]) / (h * h);
            (right - curvature[i - 1][j]) / pivot
        });
    }
    for i in (1..n - 1).rev() {
        let next = curvature[i + 1];
        for j in 0..7 {
            curvature[i][j] -= upper[i] * next[j];
        }
    }
    curvature
}
