//! Postures that reach a pose, any one or that nearest to a seed: how often, how fast, how far from the
//! seed.

use super::damped::Damped;
use super::targets::{Judge, Rule, Target, apart, middle};
use super::{Effort, arm, mean, timed};
use crate::report::{Report, percentile};
use dialogue::Rng;
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use std::time::Instant;

/// Something that looks for a posture from a seed.
pub(super) trait Solver {
    /// Its name, and what it may take per call.
    fn name(&self) -> String;
    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints>;
}

/// From which posture solvers begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seed {
    Middle,
    Random,
}

impl Seed {
    pub(super) fn of(self, target: &Target) -> Joints {
        match self {
            Self::Middle => middle(target.limb),
            Self::Random => target.seed,
        }
    }
}

/// Results of a solver.
#[derive(Debug)]
pub(super) struct Outcome {
    pub(super) name: String,
    pub(super) targets: usize,
    /// Share of the targets.
    pub(super) solved: f64,
    /// Processor time of every call, failed ones too, of all its threads.
    pub(super) micros: Vec<f64>,
    /// Elapsed time of every call.
    elapsed: Vec<f64>,
    /// Mean over the solved, radians.
    pub(super) distance: f64,
}

impl Outcome {
    /// Judges answers, each with its microseconds of processor and elapsed.
    pub(super) fn of(
        name: String,
        targets: &[Target],
        seed: Seed,
        answers: impl Iterator<Item = (Option<Joints>, [f64; 2])>,
        rule: Rule,
    ) -> Self {
        let judge = Judge::new();
        let (mut micros, mut elapsed, mut distances) = (Vec::new(), Vec::new(), Vec::new());
        for (target, (answer, times)) in targets.iter().zip(answers) {
            micros.push(times[0]);
            elapsed.push(times[1]);
            let accepted = answer.filter(|q| judge.accepts(target, q, rule));
            distances.extend(accepted.map(|q| apart(&q, &seed.of(target))));
        }
        let solved = distances.len() as f64 / micros.len().max(1) as f64;
        Self { name, targets: micros.len(), solved, micros, elapsed, distance: mean(&distances) }
    }

    pub(super) fn mean(&self) -> f64 {
        mean(&self.micros)
    }

    /// Cells of a table's row; `ours` is the mean that the last cell compares with.
    pub(super) fn cells(&self, ours: f64) -> Vec<String> {
        let micros = |value: f64| format!("{value:.1}");
        vec![
            self.name.clone(),
            self.targets.to_string(),
            format!("{:.2} %", self.solved * 100.0),
            micros(self.mean()),
            micros(percentile(&self.micros, 0.5)),
            micros(percentile(&self.micros, 0.99)),
            micros(mean(&self.elapsed)),
            format!("{:.3}", self.distance),
            format!("{:.1}", self.mean() / ours),
        ]
    }
}

/// The heads of [`Outcome::cells`].
const HEADS: [&str; 9] = [
    "solver",
    "targets",
    "solved",
    "mean µs of processor",
    "median",
    "p99",
    "mean µs elapsed",
    "distance to seed, rad",
    "× ours",
];

/// Has a solver answer the targets.
fn run(solver: &mut dyn Solver, targets: &[Target], seed: Seed, rule: Rule) -> Outcome {
    let name = solver.name();
    let answers = targets.iter().map(|target| {
        let from = seed.of(target);
        let started = Instant::now();
        let (answer, micros) = timed(|| solver.solve(target.limb, &target.pose, &from));
        (answer, [micros, started.elapsed().as_secs_f64() * 1e6])
    });
    Outcome::of(name, targets, seed, answers, rule)
}

/// This project's solver: any answer, or the one nearest to the seed.
pub(super) enum Own {
    First,
    Nearest,
}

impl Solver for Own {
    fn name(&self) -> String {
        "**whichone**, one thread, to 1e-6".to_owned()
    }

    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints> {
        let seed = match self {
            Self::First => None,
            Self::Nearest => Some(seed),
        };
        arm(limb).chain.inverse(pose, seed).ok().map(|answer| answer.q)
    }
}

pub(super) fn measure(
    report: &mut Report,
    targets: &[Target],
    python: &super::python::Measured,
    effort: Effort,
) {
    let few = &targets[..effort.peers];
    let own = run(&mut Own::First, targets, Seed::Middle, Rule::OWN);
    let mut peers = vec![run(&mut Damped(Rng::new(11)), few, Seed::Middle, Rule::PEER)];
    #[cfg(feature = "peers")]
    for solver in super::k_crate::solvers() {
        let mut solver = solver;
        peers.push(run(&mut solver, few, Seed::Middle, Rule::PEER));
    }
    peers.extend(python.outcomes(targets, false, Seed::Middle));
    let best = peers
        .iter()
        .filter(|peer| peer.solved >= 0.99)
        .min_by(|a, b| a.mean().total_cmp(&b.mean()))
        .map_or("No other solves 99 %.".to_owned(), |best| {
            let (ours, theirs) = (own.mean(), best.mean());
            let ratio = theirs / ours;
            format!("Fastest other that solves 99 %: {}, {ratio:.1} times our mean.", best.name)
        });
    let mut note = format!(
        "Poses of both limbs that are forward kinematics of random postures; seed: the middle of \
         the limits. Times are of every call, failed ones too: processor time of all threads, and \
         elapsed, with the way from Python and back where a package of it is named. \
         Ours must come within 1e-6 m and rad and keep the limits to the last bit; peers stop at \
         1e-5 and are accepted at 2e-5. On a busy machine those that look at the clock solve \
         less. {best}"
    );
    for line in &python.left_out {
        note += &format!(" {line}");
    }
    if !cfg!(feature = "peers") {
        note += " Built without the feature `peers`: the crate k is left out.";
    }
    let ours = own.mean();
    let rows = std::iter::once(&own).chain(&peers).map(|outcome| outcome.cells(ours)).collect();
    report.table("Inverse kinematics", note, HEADS, rows);
}

/// The posture nearest to a seed: how near, and how fast.
pub(super) fn measure_nearest(
    report: &mut Report,
    targets: &[Target],
    python: &super::python::Measured,
    effort: Effort,
) {
    let few = &targets[..effort.peers];
    let mut rows = Vec::new();
    for (seed, from) in [(Seed::Middle, "middle"), (Seed::Random, "random")] {
        let own = run(&mut Own::Nearest, few, seed, Rule::OWN);
        let peers = python.outcomes(targets, true, seed);
        rows.extend(std::iter::once(&own).chain(&peers).map(|outcome| {
            let mut cells = outcome.cells(own.mean());
            cells.insert(1, from.to_owned());
            cells
        }));
    }
    let mut heads = HEADS.to_vec();
    heads.insert(1, "seed");
    let note = "The same targets; distances are means over what was solved. Peers look for better \
                answers until their time is up.";
    report.table("Inverse kinematics nearest to a seed", note, heads, rows);
}
