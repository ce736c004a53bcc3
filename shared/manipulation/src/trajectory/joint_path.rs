//! Ways through joint space that touch nothing.

use std::iter;

use crate::kinematics::limb::{Joints, distance};
use crate::kinematics::limits::PositionLimits;
use crate::random::Random;

/// Joint distance between two checks along a line, the largest joint's change, radians. The
/// gripper moves less than 6 cm between them and half of that from the nearer one.
const CHECK_RAD: f64 = 0.05;

/// Longest edge of the search trees, radians.
const REACH_RAD: f64 = 0.4;

/// Nodes that both search trees may have together.
const NODES_MAX: usize = 3000;

/// Random postures tried before giving up, when nearly every edge is blocked.
const SAMPLES_MAX: usize = 3000;

/// Distance from the straight line between two postures that is searched first, radians.
const BESIDE_RAD: f64 = 0.6;

/// Attempts to cut corners off a way that was found by searching.
const SHORTCUTS: usize = 60;

/// Waypoints from `from` to `to` such that `clear` holds along the straight lines between them:
/// the direct line, or the shortest over one of `via_postures`.
pub(crate) fn simple(
    from: &Joints,
    to: &Joints,
    via_postures: &[Joints],
    clear: &impl Fn(&Joints) -> bool,
) -> Option<Vec<Joints>> {
    if line_clear(from, to, clear) {
        return Some(vec![*from, *to]);
    }
    let mut ways: Vec<[Joints; 3]> = via_postures.iter().map(|via| [*from, *via, *to]).collect();
    ways.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let is_clear =
        |[from, via, to]: &[Joints; 3]| line_clear(from, via, clear) && line_clear(via, to, clear);
    ways.into_iter().find(is_clear).map(Vec::from)
}

/// Returns the same, found by growing random trees from both ends (RRT-Connect, Kuffner and LaValle
/// 2000), then shortened. The random numbers are the same every time.
pub(crate) fn searched(
    from: &Joints,
    to: &Joints,
    limits: &PositionLimits,
    clear: &impl Fn(&Joints) -> bool,
) -> Option<Vec<Joints>> {
    if clear(from) && clear(to) { Trees::new(*from, *to).run(limits, clear) } else { None }
}

/// Returns the first thing that `blocked` finds along the straight line.
pub(crate) fn blocking<G>(
    from: &Joints,
    to: &Joints,
    blocked: &impl Fn(&Joints) -> Option<G>,
) -> Option<G> {
    let steps = steps(from, to);
    (0..=steps).find_map(|k| blocked(&mix(from, to, k as f64 / steps as f64)))
}

/// Returns whether `clear` holds along the straight line, both ends included. The postures between them are looked at
/// from the middle on, ever closer: where a line is blocked, it mostly is over a good part of its length.
fn line_clear(from: &Joints, to: &Joints, clear: &impl Fn(&Joints) -> bool) -> bool {
    let steps = steps(from, to);
    let is_clear = |k: usize| clear(&mix(from, to, k as f64 / steps as f64));
    let strides = iter::successors(Some(steps.next_power_of_two()), |stride| Some(stride / 2));
    let mut strides = strides.take_while(|stride| *stride > 0);
    is_clear(0)
        && is_clear(steps)
        && strides.all(|stride| {
            // Odd multiples: the even ones were those of a longer stride.
            (stride..steps).step_by(2 * stride).all(is_clear)
        })
}

/// Steps of a straight line between the postures that are looked at.
fn steps(from: &Joints, to: &Joints) -> usize {
    (largest_change(from, to) / CHECK_RAD).ceil().max(1.0) as usize
}

/// Returns the largest change of any joint, radians.
pub(crate) fn largest_change(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn length(points: &[Joints]) -> f64 {
    points.windows(2).map(|w| distance(&w[0], &w[1])).sum()
}

fn mix(a: &Joints, b: &Joints, share: f64) -> Joints {
    if share >= 1.0 {
        return *b;
    }
    std::array::from_fn(|j| a[j] + (b[j] - a[j]) * share)
}

/// A node of a tree: a posture and the node it was reached from.
type Tree = Vec<(Joints, usize)>;

struct Trees {
    trees: [Tree; 2],
    random: Random,
}

impl Trees {
    fn new(from: Joints, to: Joints) -> Self {
        Self { trees: [vec![(from, 0)], vec![(to, 0)]], random: Random::seeded(1) }
    }

    /// Grows the trees in turn towards random postures and each other.
    fn run(
        mut self,
        limits: &PositionLimits,
        clear: &impl Fn(&Joints) -> bool,
    ) -> Option<Vec<Joints>> {
        let (mut growing, mut samples) = (0, 0);
        while self.trees[0].len() + self.trees[1].len() < NODES_MAX {
            samples += 1;
            if samples > SAMPLES_MAX {
                break;
            }
            // Most ways need only a bend: every second sample is beside the straight line.
            let sample = match samples % 2 {
                0 => self.random.beside(&self.trees[0][0].0, &self.trees[1][0].0, limits),
                _ => self.random.within(limits),
            };
            if let Some(reached) = extend(&mut self.trees[growing], &sample, clear) {
                let other = 1 - growing;
                while let Some(node) = extend(&mut self.trees[other], &reached, clear) {
                    if node == reached {
                        return Some(self.joined(clear));
                    }
                }
            }
            growing = 1 - growing;
        }
        None
    }

    /// Returns the way through the newest node of both trees, from start to goal, shortened.
    fn joined(&mut self, clear: &impl Fn(&Joints) -> bool) -> Vec<Joints> {
        let mut way = to_root(&self.trees[0]);
        way.reverse();
        way.extend(to_root(&self.trees[1]).into_iter().skip(1));
        for _ in 0..SHORTCUTS {
            if way.len() < 3 {
                break;
            }
            let mut below = |n: usize| ((self.random.unit() * n as f64) as usize).min(n - 1);
            let i = below(way.len() - 2);
            let j = i + 2 + below(way.len() - i - 2);
            if line_clear(&way[i], &way[j], clear) {
                way.drain(i + 1..j);
            }
        }
        way
    }
}

/// Adds a node one edge from the nearest towards `target`; the new posture, if the edge is clear.
fn extend(tree: &mut Tree, target: &Joints, clear: &impl Fn(&Joints) -> bool) -> Option<Joints> {
    let (index, near) = tree
        .iter()
        .enumerate()
        .min_by(|a, b| distance(&a.1.0, target).total_cmp(&distance(&b.1.0, target)))
        .map(|(i, node)| (i, node.0))?;
    let length = distance(&near, target);
    if length < 1e-9 {
        return None;
    }
    let next = mix(&near, target, (REACH_RAD / length).min(1.0));
    line_clear(&near, &next, clear).then(|| {
        tree.push((next, index));
        next
    })
}

fn to_root(tree: &Tree) -> Vec<Joints> {
    let mut index = tree.len() - 1;
    let mut way = vec![tree[index].0];
    while index != 0 {
        index = tree[index].1;
        way.push(tree[index].0);
    }
    way
}

impl Random {
    /// Returns a posture within [`BESIDE_RAD`] of the line between two, in every joint.
    fn beside(&mut self, a: &Joints, b: &Joints, limits: &PositionLimits) -> Joints {
        let share = self.unit();
        let on_line = mix(a, b, share);
        limits.clamp(&on_line.map(|q| q + BESIDE_RAD * (2.0 * self.unit() - 1.0)))
    }

    fn within(&mut self, limits: &PositionLimits) -> Joints {
        let share = std::array::from_fn(|_| self.unit());
        limits.at(&share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::full;

    /// Returns a wall across the first two joints with a gap at the far end of the second.
    fn walled(q: &Joints) -> bool {
        !((q[0] - 0.3).abs() < 0.1 && q[1] > -1.5)
    }

    const FROM: Joints = [-0.5, 0.5, 0.0, 1.0, 0.0, 0.5, 0.0];
    const TO: Joints = [1.0, 0.5, 0.0, 1.0, 0.0, 0.5, 0.0];

    #[test]
    fn every_posture_of_a_line_is_looked_at_once() {
        for steps in 1..40_usize {
            let to = [(steps as f64 - 0.5) * CHECK_RAD, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            let looked = std::cell::RefCell::new(Vec::new());
            let clear = |q: &Joints| {
                looked.borrow_mut().push(q[0]);
                true
            };
            assert!(line_clear(&[0.0; 7], &to, &clear));
            let mut looked = looked.into_inner();
            looked.sort_by(f64::total_cmp);
            assert_eq!((looked.len(), looked[0], looked[steps]), (steps + 1, 0.0, to[0]));
            let gaps = looked.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(gaps.into_iter().all(|gap| gap > 0.0 && gap <= CHECK_RAD), "{looked:?}");
        }
    }

    #[test]
    fn the_direct_line_is_preferred() {
        let via_posture = [0.0; 7];
        assert_eq!(simple(&FROM, &TO, &[via_posture], &|_| true), Some(vec![FROM, TO]));
    }

    #[test]
    fn joint_path_uses_a_via_posture_beyond_the_wall() {
        let (useless, open) = ([0.0; 7], [0.3, -2.0, 0.0, 1.0, 0.0, 0.5, 0.0]);
        // The straight lines to the gap's middle still cut the wall's corner; the bend of a wider
        // gap does not.
        let clear = |q: &Joints| !((q[0] - 0.3).abs() < 0.02 && q[1] > -1.5);
        assert_eq!(simple(&FROM, &TO, &[useless, open], &clear), Some(vec![FROM, open, TO]));
        assert_eq!(simple(&FROM, &TO, &[useless], &clear), None);
    }

    #[test]
    fn a_search_finds_the_gap_and_is_the_same_every_time() {
        let way = searched(&FROM, &TO, &full().position, &walled).expect("there is a gap");
        assert_eq!((way[0], way[way.len() - 1]), (FROM, TO));
        for pair in way.windows(2) {
            for k in 0..=200 {
                assert!(walled(&mix(&pair[0], &pair[1], f64::from(k) / 200.0)), "{way:?}");
            }
        }
        assert_eq!(searched(&FROM, &TO, &full().position, &walled), Some(way));
    }

    #[test]
    fn joint_path_reports_a_missing_path() {
        assert_eq!(searched(&FROM, &TO, &full().position, &|q| (q[0] - 0.3).abs() > 0.1), None);
        assert_eq!(searched(&FROM, &TO, &full().position, &|q| *q != TO), None);
    }
}
