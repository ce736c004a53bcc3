//! Pairs of links whose collisions need not be checked, by sampling postures, with the criteria of MoveIt's setup assistant.
//!
//! One differs: a pair that never touches but comes nearer than 20 mm stays checked. Only pairs with a link of the arm
//! are looked at, so that few postures suffice.

use std::collections::BTreeSet;

use crate::points::Hull;
use crate::report::PairCounts;
use crate::source::Source;
use crate::structure::Arm;

/// Random postures in all, and in a round that looks for pairs that always touch.
const POSTURES: usize = 10_000;
const ROUND: usize = 200;

/// Share of a round in which a pair that always touches does so.
const ALWAYS: f64 = 0.95;

/// Pairs that come nearer stay checked, metres.
const NEAR_M: f64 = 0.02;

pub(crate) type Pair = (usize, usize);

/// Pairs of links by the reason for which they may touch; the smaller number first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    pub(crate) all: usize,
    pub(crate) adjacent: BTreeSet<Pair>,
    pub(crate) default: BTreeSet<Pair>,
    pub(crate) always: BTreeSet<Pair>,
    pub(crate) never: BTreeSet<Pair>,
    /// Never in contact, but near: they stay checked.
    pub(crate) near: BTreeSet<Pair>,
}

/// Random numbers, the same in every run (Marsaglia, 2003).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Returns a number of at least 0 and below 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Looks at the hulls of links in random postures.
struct Sampler<'a> {
    source: &'a Source,
    hulls: &'a [Vec<Hull>],
    /// Joints that move.
    moving: Vec<usize>,
    still: Vec<f64>,
    random: Random,
}

impl Sampler<'_> {
    /// Returns the hulls of every link in a random posture.
    fn posture(&mut self) -> Vec<Vec<Hull>> {
        let mut q = self.still.clone();
        for joint in &self.moving {
            let (low, high) = self.source.joints[*joint].span();
            q[*joint] = low + (high - low) * self.random.unit();
        }
        self.placed(&q)
    }

    fn placed(&self, q: &[f64]) -> Vec<Vec<Hull>> {
        let poses = self.source.poses(q);
        let all = self.hulls.iter().zip(&poses);
        all.map(|(own, pose)| own.iter().map(|hull| hull.at(pose)).collect()).collect()
    }
}

fn distance(placed: &[Vec<Hull>], (a, b): Pair, within: f64) -> f64 {
    let all =
        placed[a].iter().flat_map(|own| placed[b].iter().map(move |it| own.distance(it, within)));
    all.fold(f64::INFINITY, f64::min)
}

/// Returns the pairs of links with shapes of which one at least moves with the arm.
fn candidates(source: &Source, arm: &Arm, hulls: &[Vec<Hull>]) -> Vec<Pair> {
    let first = source.joints[arm.joints[0]].child;
    let solid: Vec<usize> =
        (0..source.links.len()).filter(|link| !hulls[*link].is_empty()).collect();
    let is_own = |link: usize| source.is_below(link, first);
    let pairs = solid
        .iter()
        .enumerate()
        .flat_map(|(at, a)| solid[at + 1..].iter().map(move |b| (*a.min(b), *a.max(b))));
    pairs.filter(|(a, b)| is_own(*a) || is_own(*b)).collect()
}

/// Sorts the pairs; `still` has the positions of joints that belong to neither arm nor gripper.
pub(crate) fn sample(
    source: &Source,
    arm: &Arm,
    hulls: &[Vec<Hull>],
    still: &[f64],
    seed: u64,
) -> Pairs {
    let all = candidates(source, arm, hulls);
    let moving = arm.joints.iter().chain(&arm.fingers).copied();
    let moving = moving.filter(|joint| source.joints[*joint].follows.is_none()).collect();
    let mut sampler =
        Sampler { source, hulls, moving, still: still.to_vec(), random: Random::new(seed) };
    let mut found = Pairs { all: all.len(), ..Pairs::default() };
    let mut rest = Vec::new();
    for pair in all {
        if solid_ancestor(source, hulls, pair.1) == Some(pair.0)
            || solid_ancestor(source, hulls, pair.0) == Some(pair.1)
        {
            found.adjacent.insert(pair);
        } else {
            rest.push(pair);
        }
    }
    let zero = sampler.placed(still);
    take(&mut rest, &mut found.default, |pair| distance(&zero, pair, 0.0) <= 0.0);
    always(&mut sampler, &mut rest, &mut found.always);
    by_distance(&mut sampler, rest, &mut found);
    found
}

/// Sorts the rest by how near the links come to each other.
fn by_distance(sampler: &mut Sampler<'_>, rest: Vec<Pair>, found: &mut Pairs) {
    let mut least = vec![f64::INFINITY; rest.len()];
    for _ in 0..POSTURES {
        let placed = sampler.posture();
        for (pair, least) in rest.iter().zip(&mut least) {
            if *least > 0.0 {
                *least = least.min(distance(&placed, *pair, NEAR_M.min(*least)));
            }
        }
    }
    for (pair, least) in rest.into_iter().zip(least) {
        match least {
            touch if touch <= 0.0 => false,
            near if near < NEAR_M => found.near.insert(pair),
            _ => found.never.insert(pair),
        };
    }
}

fn take(rest: &mut Vec<Pair>, into: &mut BTreeSet<Pair>, is_in: impl Fn(Pair) -> bool) {
    rest.retain(|pair| {
        let is_in = is_in(*pair);
        if is_in {
            into.insert(*pair);
        }
        !is_in
    });
}

/// Takes the pairs that touch in almost every posture of a round, until a round finds no more.
fn always(sampler: &mut Sampler<'_>, rest: &mut Vec<Pair>, into: &mut BTreeSet<Pair>) {
    loop {
        let mut count = vec![0usize; rest.len()];
        for _ in 0..ROUND {
            let placed = sampler.posture();
            for (pair, count) in rest.iter().zip(&mut count) {
                *count += usize::from(distance(&placed, *pair, 0.0) <= 0.0);
            }
        }
        let before = rest.len();
        let often: BTreeSet<Pair> = rest
            .iter()
            .zip(&count)
            .filter(|(_, count)| **count as f64 > ALWAYS * ROUND as f64)
            .map(|(pair, _)| *pair)
            .collect();
        take(rest, into, |pair| often.contains(&pair));
        if rest.len() == before {
            return;
        }
    }
}

/// The nearest link towards the root that has a shape.
fn solid_ancestor(source: &Source, hulls: &[Vec<Hull>], link: usize) -> Option<usize> {
    let mut at = source.joints[source.links[link].carrier?].parent;
    while hulls[at].is_empty() {
        at = source.joints[source.links[at].carrier?].parent;
    }
    Some(at)
}

impl Pairs {
    /// Every pair that MoveIt's criteria disable: those of which published files consist.
    fn by_moveit(&self) -> BTreeSet<Pair> {
        let sets = [&self.adjacent, &self.default, &self.always, &self.never, &self.near];
        sets.into_iter().flatten().copied().collect()
    }

    /// Pairs that may touch, with the reason.
    pub(crate) fn excused(&self) -> impl Iterator<Item = (Pair, &'static str)> + '_ {
        let of = |set: &'_ BTreeSet<Pair>, reason| {
            set.iter().map(move |pair| (*pair, reason)).collect::<Vec<_>>()
        };
        let all = [
            of(&self.adjacent, "Adjacent"),
            of(&self.default, "Default"),
            of(&self.always, "Always"),
            of(&self.never, "Never"),
        ];
        all.into_iter().flatten()
    }

    /// Counts for the owner, compared with the pairs of a published SRDF.
    pub(crate) fn counts(&self, published: &BTreeSet<Pair>) -> PairCounts {
        let own = self.by_moveit();
        let common = own.intersection(published).count() as f64;
        let share = |of: usize| (!published.is_empty() && of > 0).then(|| common / of as f64);
        PairCounts {
            all: self.all,
            postures: POSTURES,
            adjacent: self.adjacent.len(),
            default: self.default.len(),
            always: self.always.len(),
            never: self.never.len(),
            near: self.near.len(),
            fat: Vec::new(),
            precision: share(own.len()),
            recall: share(published.len()),
        }
    }
}
