//! Postures that reach a pose, any one or that nearest to a seed: how often, how fast, how far from the
//! seed.

use super::damped::Damped;
use super::python::{Kind, Measured};
use super::subject::Subject;
use super::targets::{Judge, Rule, Target, apart};
use super::{Effort, mean, timed};
use crate::report::{Report, percentile};
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use serde::Deserialize;
use std::time::Instant;
use vocabulary::Rng;

/// Something that looks for a posture from a seed.
pub(super) trait Solver {
    /// Its name, and what it may take per call.
    fn name(&self) -> String;
    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints>;
}

/// From which posture solvers begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Seed {
    Middle,
    Random,
}

impl Seed {
    pub(super) fn of(self, subject: &Subject, target: &Target) -> Joints {
        match self {
            Self::Middle => subject.middle(target.limb),
            Self::Random => target.seed,
        }
    }
}

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The answer reaches the pose within the limits.
    Reached,
    /// It does not.
    Wrong,
    /// There was none.
    Rejected,
}

/// Results of a solver.
#[derive(Debug)]
pub(super) struct Outcome {
    pub(super) name: String,
    /// One for each target.
    pub(super) verdicts: Vec<Verdict>,
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
        subject: &Subject,
        targets: &[Target],
        seed: Seed,
        answers: impl Iterator<Item = (Option<Joints>, [f64; 2])>,
        rule: Rule,
    ) -> Self {
        let judge = Judge::new(subject);
        let (mut micros, mut elapsed) = (Vec::new(), Vec::new());
        let (mut verdicts, mut distances) = (Vec::new(), Vec::new());
        for (target, (answer, times)) in targets.iter().zip(answers) {
            micros.push(times[0]);
            elapsed.push(times[1]);
            verdicts.push(match answer {
                None => Verdict::Rejected,
                Some(q) if judge.accepts(target, &q, rule) => {
                    distances.push(apart(&q, &seed.of(subject, target)));
                    Verdict::Reached
                }
                Some(_) => Verdict::Wrong,
            });
        }
        Self { name, verdicts, micros, elapsed, distance: mean(&distances) }
    }

    /// Share of the targets that it reached.
    pub(super) fn solved(&self) -> f64 {
        self.count(Verdict::Reached) as f64 / self.verdicts.len().max(1) as f64
    }

    pub(super) fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|own| **own == verdict).count()
    }

    pub(super) fn mean(&self) -> f64 {
        mean(&self.micros)
    }

    /// Cells of a table's row; `ours` is the mean that the last cell compares with.
    pub(super) fn cells(&self, ours: f64) -> Vec<String> {
        let micros = |value: f64| format!("{value:.1}");
        vec![
            self.name.clone(),
            self.verdicts.len().to_string(),
            format!("{:.2} %", self.solved() * 100.0),
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
pub(super) fn run(
    solver: &mut dyn Solver,
    subject: &Subject,
    targets: &[Target],
    seed: Seed,
    rule: Rule,
) -> Outcome {
    let name = solver.name();
    let answers = targets.iter().map(|target| {
        let from = seed.of(subject, target);
        let started = Instant::now();
        let (answer, micros) = timed(|| solver.solve(target.limb, &target.pose, &from));
        (answer, [micros, started.elapsed().as_secs_f64() * 1e6])
    });
    Outcome::of(name, subject, targets, seed, answers, rule)
}

/// This project's solver: any answer, or the one nearest to the seed.
pub(super) struct Own<'a> {
    pub(super) subject: &'a Subject,
    pub(super) nearest: bool,
}

impl Solver for Own<'_> {
    fn name(&self) -> String {
        "**whichone**, one thread, to 1e-6".to_owned()
    }

    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints> {
        let seed = self.nearest.then_some(seed);
        self.subject.arm(limb).chain.inverse(pose, seed).ok().map(|answer| answer.q)
    }
}

pub(super) fn measure(
    report: &mut Report,
    subject: &'static Subject,
    targets: &[Target],
    python: &Measured,
    effort: Effort,
) {
    let few = &targets[..effort.peers];
    let run = |solver: &mut dyn Solver, targets: &[Target], rule: Rule| {
        run(solver, subject, targets, Seed::Middle, rule)
    };
    let own = run(&mut Own { subject, nearest: false }, targets, Rule::OWN);
    let mut peers = vec![run(&mut Damped { subject, rng: Rng::new(11) }, few, Rule::PEER)];
    peers.extend(python.outcomes(subject, targets, Kind::Reachable, false, Seed::Middle));
    let best = peers
        .iter()
        .filter(|peer| peer.solved() >= 0.99)
        .min_by(|a, b| a.mean().total_cmp(&b.mean()))
        .map_or("No other solves 99 %.".to_owned(), |best| {
            let (ours, theirs) = (own.mean(), best.mean());
            let ratio = theirs / ours;
            format!("Fastest other that solves 99 %: {}, {ratio:.1} times our mean.", best.name)
        });
    let mut note = format!(
        "Poses of its limbs that are forward kinematics of random postures; seed: the middle of \
         the limits. Times are of every call, failed ones too: processor time of all threads, and \
         elapsed, with the way from Python and back where a package of it is named. \
         Ours must come within 1e-6 m and rad and keep the limits to the last bit; peers stop at \
         1e-5 and are accepted at 2e-5. On a busy machine those that look at the clock solve \
         less. {best}"
    );
    for line in &python.left_out {
        note += &format!(" {line}");
    }
    let ours = own.mean();
    let rows = std::iter::once(&own).chain(&peers).map(|outcome| outcome.cells(ours)).collect();
    report.table(format!("Inverse kinematics: {}", subject.name), note, HEADS, rows);
}

/// The posture nearest to a seed: how near, and how fast.
pub(super) fn measure_nearest(
    report: &mut Report,
    subject: &'static Subject,
    targets: &[Target],
    python: &Measured,
    effort: Effort,
) {
    let few = &targets[..effort.peers];
    let mut rows = Vec::new();
    for (seed, from) in [(Seed::Middle, "middle"), (Seed::Random, "random")] {
        let own = run(&mut Own { subject, nearest: true }, subject, few, seed, Rule::OWN);
        let peers = python.outcomes(subject, targets, Kind::Reachable, true, seed);
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
    let title = format!("Inverse kinematics nearest to a seed: {}", subject.name);
    report.table(title, note, heads, rows);
}
