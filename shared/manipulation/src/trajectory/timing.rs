//! The fastest way along a path within velocity and acceleration limits.
//!
//! Time-optimal path parameterisation by reachability analysis (Pham and Pham, 2018): a backward
//! pass finds, at every grid point, the greatest squared path speed from which the end can still
//! be reached; a forward pass then takes the greatest acceleration that stays below it.
//!
//! The limits hold at every instant and not only on the grid. Over one interval the path
//! acceleration is constant, the path is a cubic and the squared speed is linear, so every joint's
//! acceleration is a quadratic in `s`; its three Bernstein coefficients are bounded, and the
//! quadratic lies between them. Velocities are bounded by the coefficients of the path's slope.

use crate::kinematics::limb::Joints;
use crate::kinematics::limits::MotionLimits;
use crate::trajectory::path::{Path, Piece};

/// A grid point of a timed path: from here to the next the path acceleration is constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knot {
    /// Seconds since the start.
    pub(crate) time: f64,
    /// Path length since the piece's start.
    pub(crate) s: f64,
    /// Path length per second.
    pub(crate) speed: f64,
    /// Path length per second squared, until the next knot.
    pub(crate) acceleration: f64,
    pub(crate) piece: usize,
}

/// Times a path from rest to rest with at least `intervals_min` grid intervals.
pub(crate) fn fastest(path: &Path, limits: &MotionLimits, intervals_min: usize) -> Vec<Knot> {
    let intervals = intervals(path, limits, intervals_min);
    let reachable = backward(&intervals);
    forward(path, &intervals, &reachable)
}

/// One grid interval: `|slopeₖ u + bendₖ x| ≤ limit` for its Bernstein coefficients, with `x` the
/// squared speed at its start and `u` its path acceleration.
struct Interval {
    piece: usize,
    /// Past the piece's start.
    s: f64,
    length: f64,
    /// The greatest squared speed that keeps every joint's velocity within its limit here.
    squared_max: f64,
    rows: Vec<Row>,
}

/// `u` lies within `half` of `slope · x`.
#[derive(Clone, Copy)]
struct Row {
    slope: f64,
    half: f64,
}

fn intervals(path: &Path, limits: &MotionLimits, intervals_min: usize) -> Vec<Interval> {
    let total = path.length();
    let mut grid = Vec::new();
    for (k, piece) in path.pieces().iter().enumerate() {
        if piece.length > 0.0 {
            let share = (intervals_min as f64 * piece.length / total).ceil();
            let count = (share as usize).max(2);
            let length = piece.length / count as f64;
            let at = |i: usize| Interval::new(piece, k, i as f64 * length, length, limits);
            grid.extend((0..count).map(at));
        }
    }
    grid
}

impl Interval {
    fn new(piece: &Piece, index: usize, s: f64, length: f64, limits: &MotionLimits) -> Self {
        let h = length;
        let (slope, bend) = (piece.slope(s), piece.bend(s));
        let (slope_end, bend_end) = (piece.slope(s + h), piece.bend(s + h));
        let mut squared_max = f64::INFINITY;
        let mut rows = Vec::with_capacity(21);
        for j in 0..7 {
            let twist = (bend_end[j] - bend[j]) / h;
            let steepest =
                slope[j].abs().max((slope[j] + 0.5 * h * bend[j]).abs()).max(slope_end[j].abs());
            squared_max = squared_max.min((limits.velocity[j] / steepest).powi(2));
            for (of_u, of_x) in [
                (slope[j], bend[j]),
                (slope[j] + 1.5 * h * bend[j], bend[j] + 0.5 * h * twist),
                (slope_end[j] + 2.0 * h * bend_end[j], bend_end[j]),
            ] {
                let limit = limits.acceleration[j];
                if of_u.abs() > 1e-9 {
                    rows.push(Row { slope: -of_x / of_u, half: limit / of_u.abs() });
                } else if of_x.abs() > 1e-12 {
                    squared_max = squared_max.min(limit / of_x.abs());
                }
            }
        }
        Self { piece: index, s, length, squared_max: squared_max.min(1e12), rows }
    }

    /// Greatest path acceleration at squared speed `x`.
    fn upper(&self, x: f64) -> f64 {
        let (_, upper) = self.tightest(x);
        upper.slope * x + upper.half
    }

    /// Returns the rows that give the lower and the upper bound at `x`.
    fn tightest(&self, x: f64) -> (Row, Row) {
        let mut lower = FREE;
        let mut upper = FREE;
        for row in &self.rows {
            if row.slope * x - row.half > lower.slope * x - lower.half {
                lower = *row;
            }
            if row.slope * x + row.half < upper.slope * x + upper.half {
                upper = *row;
            }
        }
        (lower, upper)
    }

    /// Returns the greatest squared speed, at most `most`, from which one interval leads to at most
    /// `next`.
    ///
    /// The room between the bounds on `u` is concave in `x` and not negative at 0, so Newton's
    /// method from the right comes down to its root in finitely many steps.
    fn greatest(&self, next: f64, most: f64) -> f64 {
        let reach = 0.5 / self.length;
        let mut x = most;
        for _ in 0..64 {
            let (lower, upper) = self.tightest(x);
            let (mut top, mut top_slope) = (upper.slope * x + upper.half, upper.slope);
            if (next - x) * reach < top {
                (top, top_slope) = ((next - x) * reach, -reach);
            }
            let room = top - (lower.slope * x - lower.half);
            if room >= 0.0 {
                break;
            }
            let falling = lower.slope - top_slope;
            x = if falling > 0.0 { (x + room / falling).max(0.0) } else { 0.0 };
        }
        x
    }
}

/// A row that binds nothing.
const FREE: Row = Row { slope: 0.0, half: 1e12 };

/// Returns the greatest squared speed at every grid point from which the end can be reached at
/// rest.
fn backward(intervals: &[Interval]) -> Vec<f64> {
    let n = intervals.len();
    let mut reachable = vec![0.0; n + 1];
    for i in (0..n).rev() {
        let before = if i == 0 { f64::INFINITY } else { intervals[i - 1].squared_max };
        let most = intervals[i].squared_max.min(before);
        reachable[i] = intervals[i].greatest(reachable[i + 1], most);
    }
    reachable
}

/// Takes the greatest acceleration that stays below what is reachable, interval by interval.
fn forward(path: &Path, intervals: &[Interval], reachable: &[f64]) -> Vec<Knot> {
    let mut knots = Vec::with_capacity(intervals.len() + 1);
    let (mut time, mut speed) = (0.0, 0.0);
    for (i, interval) in intervals.iter().enumerate() {
        let squared = speed * speed;
        let room = (reachable[i + 1] - squared) / (2.0 * interval.length);
        let acceleration = interval.upper(squared).min(room);
        knots.push(Knot { time, s: interval.s, speed, acceleration, piece: interval.piece });
        let next = (squared + 2.0 * interval.length * acceleration).max(0.0).sqrt();
        time += 2.0 * interval.length / (speed + next);
        speed = next;
    }
    let last = path.pieces().len() - 1;
    knots.push(Knot { time, s: path.pieces()[last].length, speed, acceleration: 0.0, piece: last });
    knots
}

/// `q`, `q̇` and `q̈` at `s` past the start of a piece, for a path speed and acceleration.
pub(crate) fn motion_at(
    path: &Path,
    (piece, s): (usize, f64),
    speed: f64,
    acceleration: f64,
) -> [Joints; 3] {
    let (slope, bend) = (path.pieces()[piece].slope(s), path.pieces()[piece].bend(s));
    [
        path.position(piece, s),
        slope.map(|d| d * speed),
        std::array::from_fn(|j| slope[j] * acceleration + bend[j] * speed * speed),
    ]
}
