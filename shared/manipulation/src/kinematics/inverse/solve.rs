//! The first solution, and all of them.

use std::f64::consts::FRAC_PI_2;

use super::IkSolution;
use super::closer::{Missed, Nearly};
use super::goal::Aim;
use super::posture::{Branch, Posture};
use super::refine::{Refined, refine};
use super::slice::{NARROW_RAD, Slice, WIDE_RAD};
use crate::kinematics::limb::{Joints, distance};

/// The sweep divides s0 into intervals of at most this, radians: 64 on Baxter.
const CELL_RAD: f64 = 0.0535;

/// Intervals of the second sweep, for targets that the first nearly reached.
const FINE: usize = 120;

/// Greatest distance of the positions of s0 at which all solutions are looked for, radians: 40 on
/// Baxter.
pub(crate) const SAMPLE_RAD: f64 = 0.0875;

/// Range of the second sweep around the nearest samples of the first, radians of s0.
const WINDOW_RAD: f64 = 0.15;

/// Places about which it looks.
const WINDOWS: usize = 3;

/// Error twist below which the second sweep is worth its time, metres and radians: what the first
/// leaves of a target in reach. More with a straight wrist, whose other fixed points lie further.
const NEAR_MISS: f64 = 2e-3;
const NEAR_MISS_STRAIGHT: f64 = 1e-2;

/// Postures refined in the second sweep, least violating first.
const PATIENT: usize = 80;

/// Refinement steps for each of them: along a fold or a limit they are short.
const STEPS_PATIENT: usize = 60;

/// Postures nearer to each other than this end in the same place, radians.
const APART_RAD: f64 = 0.02;

/// Refinement steps for a posture whose joints fit but whose wrist has not settled.
const POLISH: usize = 4;

/// Returns the first posture that reaches the goal, or the nearest that was found.
pub(crate) fn first(aim: &Aim<'_>) -> Result<IkSolution, Refined> {
    if !aim.goal.is_finite() {
        return Err(Refined::at(&aim.goal, aim.goal.chain.limits().middle()));
    }
    if let Some(answer) = sweep(aim) {
        return Ok(answer);
    }
    between(aim).or_else(|Missed { nearest, straight }| {
        let error = nearest.error();
        let hidden = error < NEAR_MISS || error < NEAR_MISS_STRAIGHT && !straight.is_empty();
        if hidden { patiently(aim, nearest, &straight) } else { Err(nearest) }
    })
}

/// Returns a solution at one of the sweep's samples of s0.
fn sweep(aim: &Aim<'_>) -> Option<IkSolution> {
    let cells = cells(aim);
    let mut answer = None;
    for cell in bit_reversed(cells) {
        Slice::new(aim, s0_of(aim, cell, cells)).postures(NARROW_RAD, |_, posture| {
            answer = exact(aim, &posture);
            answer.is_some()
        });
        if answer.is_some() {
            break;
        }
    }
    answer
}

/// Returns a solution between two samples of s0, found from what nearly fits at them.
fn between(aim: &Aim<'_>) -> Result<IkSolution, Missed> {
    let cells = cells(aim);
    let mut nearly = Nearly::new(aim, cells);
    for cell in 0..=cells {
        Slice::glimpse(aim, s0_of(aim, cell, cells)).postures(WIDE_RAD, |branch, posture| {
            nearly.add(cell, branch, posture);
            false
        });
    }
    nearly.look_closer(aim)
}

/// The last resort, for one target in a million: the arm is at a limit, its wrist nearly straight
/// or its elbow at the end of its travel, and what is feasible is narrower than a cell or on
/// another of the wrist's fixed points.
fn patiently(aim: &Aim<'_>, nearest: Refined, places: &[f64]) -> Result<IkSolution, Refined> {
    let mut starts = vec![(0.0, nearest.q)];
    let (lower, upper) = aim.limits(0);
    for (place, k) in
        apart(nearest.q[0], places).into_iter().flat_map(|p| (0..=FINE).map(move |k| (p, k)))
    {
        let aside = WINDOW_RAD * (2.0 * k as f64 / FINE as f64 - 1.0);
        let slice = Slice::roughly(aim, (place + aside).clamp(lower, upper));
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
            if let Some(answer) =
                IkSolution::accept(&aim.goal, &refine(&aim.goal, &q, STEPS_PATIENT))
            {
                return Ok(answer);
            }
        }
    }
    Err(nearest)
}

/// Returns the first and those of the others that lie apart from each other, at most [`WINDOWS`].
fn apart(first: f64, others: &[f64]) -> Vec<f64> {
    let mut places = vec![first];
    for other in others {
        if places.len() < WINDOWS && places.iter().all(|p| (p - other).abs() > WINDOW_RAD) {
            places.push(*other);
        }
    }
    places
}

/// Every posture at samples of s0.
pub(crate) fn all(aim: &Aim<'_>) -> Vec<Joints> {
    let mut found = Vec::new();
    if !aim.goal.is_finite() {
        return found;
    }
    for s0 in samples(aim) {
        Slice::new(aim, s0).postures(NARROW_RAD, |_, posture| {
            found.extend(exact(aim, &posture).map(|solution| solution.q));
            false
        });
    }
    if found.is_empty() {
        found.extend(first(aim).ok().map(|solution| solution.q));
    }
    found
}

/// Returns the posture as an answer, if forward kinematics agrees that it is one.
pub(crate) fn exact(aim: &Aim<'_>, posture: &Posture) -> Option<IkSolution> {
    if posture.violation > 0.0 {
        return None;
    }
    if posture.settled {
        return IkSolution::accept(&aim.goal, &Refined::at(&aim.goal, posture.q));
    }
    // The wrist is nearly straight and its fixed point slow; Newton finishes in a step or two.
    IkSolution::accept(&aim.goal, &refine(&aim.goal, &posture.q, POLISH))
}

/// Positions of s0 at which all solutions and the nearest one are looked for, spread evenly over its
/// limits.
pub(crate) fn samples(aim: &Aim<'_>) -> impl Iterator<Item = f64> {
    let (lower, upper) = aim.limits(0);
    let count = ((upper - lower) / SAMPLE_RAD).ceil().clamp(1.0, 1024.0);
    (0..=count as usize).map(move |k| s0_at(aim, k as f64 / count))
}

/// Intervals of the sweep: a power of two.
fn cells(aim: &Aim<'_>) -> u32 {
    let (lower, upper) = aim.limits(0);
    (((upper - lower) / CELL_RAD).ceil().clamp(2.0, 1024.0) as u32).next_power_of_two()
}

/// s0 at the lower bound of a cell.
fn s0_of(aim: &Aim<'_>, cell: u32, cells: u32) -> f64 {
    s0_at(aim, f64::from(cell) / f64::from(cells))
}

/// s0 at a fraction of its range; 0 and 1 are the limits themselves.
fn s0_at(aim: &Aim<'_>, fraction: f64) -> f64 {
    let (lower, upper) = aim.limits(0);
    (lower + (upper - lower) * fraction).clamp(lower, upper)
}

/// 0..=cells in bit-reversed order: the middle, the quarters, the eighths, … so that a wide range
/// of solutions is hit early. The two limits come last.
fn bit_reversed(cells: u32) -> impl Iterator<Item = u32> {
    let unused = 32 - cells.trailing_zeros();
    (1..cells).map(move |k| k.reverse_bits() >> unused).chain([0, cells])
}
