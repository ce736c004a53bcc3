//! The solution nearest to a given posture.

use super::goal::Aim;
use super::line_search;
use super::posture::{Branch, Posture};
use super::refine::{Refined, drift, refine};
use super::slice::{NARROW_RAD, Slice};
use super::solve::{SAMPLE_RAD, exact, first, samples};
use super::{IkSolution, Unreachable};
use crate::kinematics::limb::{Joints, distance};

/// Curves of solutions that are followed to their nearest point.
const FOLLOWED: usize = 3;

/// Closed forms spent on each; they narrow s0 to 2e-3 rad, and drifting does the rest.
const LOOKS: usize = 8;

/// Refinement steps from the seed itself.
const BESIDE: usize = 12;

/// Rounds of drifting from the best answer towards the seed.
const DRIFTS: usize = 4;

/// See [`crate::Chain::nearest`].
pub(crate) fn nearest(aim: &Aim<'_>, seed: &Joints) -> Result<IkSolution, Unreachable> {
    if !aim.goal.is_finite() || seed.iter().any(|q| !q.is_finite()) {
        return first(aim).map_err(Unreachable::from);
    }
    let mut found = samples_from(aim, seed);
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    // From the seed itself, for a target that is only a small motion away.
    let beside = refine(&aim.goal, seed, BESIDE);
    let best = first_of_each_curve(&found)
        .filter_map(|near| {
            let followed = follow(aim, seed, &near);
            exact(aim, &followed.posture).or_else(|| exact(aim, &near.posture))
        })
        .chain(IkSolution::accept(&aim.goal, &beside))
        .min_by(|a, b| distance(&a.q, seed).total_cmp(&distance(&b.q, seed)));
    match best {
        Some(answer) => Ok(drifted(aim, answer, seed)),
        None => first(aim).map(|answer| drifted(aim, answer, seed)).map_err(Unreachable::from),
    }
}

/// Returns the answer moved along its own curve to the point nearest to the seed.
fn drifted(aim: &Aim<'_>, answer: IkSolution, seed: &Joints) -> IkSolution {
    let from = Refined::at(&aim.goal, answer.q);
    IkSolution::accept(&aim.goal, &drift(&aim.goal, from, seed, DRIFTS)).unwrap_or(answer)
}

/// A solution and how far from the seed it is.
#[derive(Clone, Copy)]
struct Near {
    branch: Branch,
    posture: Posture,
    distance: f64,
}

/// Solutions at the samples of s0, nearest to the seed's s0 first, until no further sample can
/// hold a nearer one.
fn samples_from(aim: &Aim<'_>, seed: &Joints) -> Vec<Near> {
    let mut order: Vec<f64> = samples(aim).collect();
    order.sort_by(|a, b| (a - seed[0]).abs().total_cmp(&(b - seed[0]).abs()));
    let mut found = Vec::with_capacity(64);
    let mut best = f64::INFINITY;
    for s0 in order {
        if (s0 - seed[0]).abs() > best + SAMPLE_RAD {
            break;
        }
        Slice::roughly(aim, s0).postures(NARROW_RAD, |branch, posture| {
            if posture.violation == 0.0 {
                let distance = distance(&posture.q, seed);
                best = best.min(distance);
                found.push(Near { branch, posture, distance });
            }
            false
        });
    }
    found
}

/// Returns the nearest samples, without those that lie beside a nearer one on the same curve.
fn first_of_each_curve(sorted: &[Near]) -> impl Iterator<Item = Near> {
    let mut chosen: Vec<Near> = Vec::with_capacity(FOLLOWED);
    for near in sorted {
        let beside = |other: &Near| {
            other.branch == near.branch
                && (other.posture.q[0] - near.posture.q[0]).abs() < 1.5 * SAMPLE_RAD
        };
        if chosen.len() < FOLLOWED && !chosen.iter().any(beside) {
            chosen.push(*near);
        }
    }
    chosen.into_iter()
}

/// Returns the nearest point of the sample's curve, between its neighbours.
fn follow(aim: &Aim<'_>, seed: &Joints, from: &Near) -> Near {
    let (lower, upper) = aim.limits(0);
    let s0 = from.posture.q[0];
    // The sample was only roughly settled: its distance counts only once refined.
    let mut best = Near { distance: f64::INFINITY, ..*from };
    let mut look = |at: f64| match Slice::new(aim, at).posture(from.branch) {
        Some(posture) if posture.violation == 0.0 => {
            let distance = distance(&posture.q, seed);
            if distance < best.distance {
                best = Near { posture, distance, ..best };
            }
            distance
        }
        // Off the curve's end: further from it is worse, so that the search turns back.
        _ => 1e3 + (at - s0).abs(),
    };
    look(s0);
    line_search::narrow(
        ((s0 - SAMPLE_RAD).max(lower), (s0 + SAMPLE_RAD).min(upper)),
        LOOKS,
        f64::INFINITY,
        look,
    );
    best
}
