//! The first solution, and all of them.

use std::f64::consts::FRAC_PI_2;

use super::closer::Nearly;
use super::goal::Goal;
use super::posture::{Branch, Posture};
use super::refine::{Refined, distance, refine};
use super::slice::{NARROW_RAD, Slice, WIDE_RAD};
use super::{IkSolution, SAMPLES};
use crate::limb::Joints;
use crate::limits::{self, POSITION_LIMITS};

/// Intervals into which the sweep divides s0: 0.053 rad each.
const CELLS: u32 = 64;

/// Intervals of the second sweep, for targets that the first nearly reached.
const FINE: usize = 60;

/// How far the second sweep looks either side of where the first came nearest, radians of s0.
const WINDOW_RAD: f64 = 0.15;

/// Error twist below which the second sweep is worth its time, metres and radians: what the first
/// leaves of a target in reach. More with a straight wrist, whose other fixed points lie further.
const NEAR_MISS: f64 = 2e-3;
const NEAR_MISS_STRAIGHT: f64 = 5e-3;

/// |w1| below which the wrist counts as straight, radians.
const STRAIGHT_RAD: f64 = 0.3;

/// Postures refined in the second sweep, least violating first.
const PATIENT: usize = 24;

/// Refinement steps for each of them: along a fold or a limit they are short.
const STEPS_PATIENT: usize = 60;

/// Postures nearer to each other than this end in the same place, radians.
const APART_RAD: f64 = 0.02;

/// Refinement steps for a posture whose joints fit but whose wrist has not settled.
const POLISH: usize = 4;

/// The first posture that reaches the goal, or the nearest that was found.
pub(crate) fn first(goal: &Goal) -> Result<IkSolution, Refined> {
    if !goal.is_finite() {
        return Err(Refined::at(goal, limits::middle()));
    }
    if let Some(answer) = sweep(goal) {
        return Ok(answer);
    }
    between(goal).or_else(|nearest| {
        let straight = nearest.q[5].abs() < STRAIGHT_RAD;
        let near_miss = if straight { NEAR_MISS_STRAIGHT } else { NEAR_MISS };
        if nearest.error() < near_miss { patiently(goal, nearest) } else { Err(nearest) }
    })
}

/// A solution at one of the sweep's samples of s0.
fn sweep(goal: &Goal) -> Option<IkSolution> {
    let mut answer = None;
    for cell in bit_reversed(CELLS) {
        Slice::new(goal, s0_of(cell, CELLS)).postures(NARROW_RAD, |_, posture| {
            answer = exact(goal, &posture);
            answer.is_some()
        });
        if answer.is_some() {
            break;
        }
    }
    answer
}

/// A solution between two samples of s0, found from what nearly fits at them.
fn between(goal: &Goal) -> Result<IkSolution, Refined> {
    let mut nearly = Nearly::new(CELLS);
    for cell in 0..=CELLS {
        Slice::glimpse(goal, s0_of(cell, CELLS)).postures(WIDE_RAD, |branch, posture| {
            nearly.add(cell, branch, posture);
            false
        });
    }
    nearly.look_closer(goal)
}

/// The last resort, for one target in a million: the arm is at a limit, its wrist nearly straight
/// or its elbow at the end of its travel, and what is feasible is narrower than a cell or on
/// another of the wrist's fixed points.
fn patiently(goal: &Goal, nearest: Refined) -> Result<IkSolution, Refined> {
    let mut starts = vec![(0.0, nearest.q)];
    let (lower, upper) = POSITION_LIMITS[0];
    for k in 0..=FINE {
        let aside = WINDOW_RAD * (2.0 * k as f64 / FINE as f64 - 1.0);
        let slice = Slice::roughly(goal, (nearest.q[0] + aside).clamp(lower, upper));
        for (branch, quarter) in Branch::all().flat_map(|b| (0..4).map(move |q| (b, q))) {
            let posture = slice.posture_from(branch, f64::from(quarter) * FRAC_PI_2);
            let near = posture.filter(|posture| posture.violation < NARROW_RAD);
            starts.extend(near.map(|posture| (posture.violation, posture.q)));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut tried: Vec<Joints> = Vec::with_capacity(PATIENT);
    for (_, q) in starts {
        if tried.len() == PATIENT {
            break;
        }
        if tried.iter().all(|other| distance(other, &q) > APART_RAD) {
            tried.push(q);
            if let Some(answer) = IkSolution::accept(&refine(goal, &q, STEPS_PATIENT)) {
                return Ok(answer);
            }
        }
    }
    Err(nearest)
}

/// Every posture at [`SAMPLES`] positions of s0.
pub(crate) fn all(goal: &Goal) -> Vec<Joints> {
    let mut found = Vec::new();
    if !goal.is_finite() {
        return found;
    }
    for k in 0..SAMPLES {
        Slice::new(goal, sample(k)).postures(NARROW_RAD, |_, posture| {
            found.extend(exact(goal, &posture).map(|solution| solution.q));
            false
        });
    }
    if found.is_empty() {
        found.extend(first(goal).ok().map(|solution| solution.q));
    }
    found
}

/// The posture as an answer, if forward kinematics agrees that it is one.
pub(crate) fn exact(goal: &Goal, posture: &Posture) -> Option<IkSolution> {
    if posture.violation > 0.0 {
        return None;
    }
    if posture.settled {
        return IkSolution::accept(&Refined::at(goal, posture.q));
    }
    // The wrist is nearly straight and its fixed point slow; Newton finishes in a step or two.
    IkSolution::accept(&refine(goal, &posture.q, POLISH))
}

/// The `k`th of [`SAMPLES`] positions of s0, spread evenly over its limits.
pub(crate) fn sample(k: usize) -> f64 {
    s0_at(k as f64 / (SAMPLES - 1) as f64)
}

/// s0 at the lower bound of a cell.
fn s0_of(cell: u32, cells: u32) -> f64 {
    s0_at(f64::from(cell) / f64::from(cells))
}

/// s0 at a fraction of its range; 0 and 1 are the limits themselves.
fn s0_at(fraction: f64) -> f64 {
    let (lower, upper) = POSITION_LIMITS[0];
    (lower + (upper - lower) * fraction).clamp(lower, upper)
}

/// 0..=cells in bit-reversed order: the middle, the quarters, the eighths, … so that a wide range
/// of solutions is hit early. The two limits come last.
fn bit_reversed(cells: u32) -> impl Iterator<Item = u32> {
    let unused = 32 - cells.trailing_zeros();
    (1..cells).map(move |k| k.reverse_bits() >> unused).chain([0, cells])
}
