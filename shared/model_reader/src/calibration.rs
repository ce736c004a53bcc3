//! Calibration of a model's weights to probabilities: an exponent, and a share of the built-in
//! reader, fitted to labelled utterances by maximum likelihood.

use crate::Calibration;
use scene::Reading;

/// Probability with which a meaning counts that no reading has: a log loss is finite.
pub const LOSS_FLOOR: f64 = 0.001;
/// Standard deviation of the exponent's logarithm before anything is known: a small set must not
/// drive it to its bound.
const PRIOR_LOG_SD: f64 = 1.0;
/// Steps of the search along each value, and how often the grid is refined.
const STEPS: usize = 25;
const REFINEMENTS: usize = 4;

/// Combines the readings of the model for one question with those of the built-in reader, whose
/// weights add up to one. Returns at most `at_most`, likeliest first; their weights sum to 1.
/// Without readings of the model the built-in reader's count.
pub fn calibrated(
    calibration: Calibration,
    model: &[(f64, Reading)],
    built_in: &[(f64, Reading)],
    at_most: usize,
) -> Vec<(f64, Reading)> {
    if model.is_empty() {
        return built_in.iter().take(at_most).cloned().collect();
    }
    let mut all: Vec<(f64, Reading)> = Vec::new();
    model.iter().for_each(|(weight, reading)| add(&mut all, *weight, reading));
    let weights: Vec<f64> = all.iter().map(|(weight, _)| *weight).collect();
    let shares = powers(&weights, calibration.power);
    for ((weight, _), share) in all.iter_mut().zip(shares) {
        *weight = (1.0 - calibration.built_in) * share;
    }
    if calibration.built_in > 0.0 {
        built_in.iter().for_each(|(weight, reading)| {
            add(&mut all, calibration.built_in * weight, reading);
        });
    }
    all.retain(|(weight, _)| *weight > 0.0);
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.truncate(at_most);
    let total: f64 = all.iter().map(|(weight, _)| weight).sum();
    all.iter_mut().for_each(|(weight, _)| *weight /= total);
    all
}

/// Adds a reading; one that is equal but for its doubts takes the weight.
fn add(all: &mut Vec<(f64, Reading)>, weight: f64, reading: &Reading) {
    match all.iter_mut().find(|(_, known)| known.says_the_same(reading)) {
        Some((known, _)) => *known += weight,
        None => all.push((weight, reading.clone())),
    }
}

/// `w^power`, normalised; relative to the largest, so that nothing under- or overflows.
fn powers(weights: &[f64], power: f64) -> Vec<f64> {
    let most = weights.iter().copied().fold(0.0, f64::max);
    let raised: Vec<f64> = weights.iter().map(|weight| (weight / most).powf(power)).collect();
    let total: f64 = raised.iter().sum();
    raised.into_iter().map(|weight| weight / total).collect()
}

/// A labelled utterance: weights of the distinct readings that each reader gave, and whether the
/// label accepts them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Weights by the model, not normalised.
    pub model: Vec<(f64, bool)>,
    /// Weights by the built-in reader; they sum to 1.
    pub built_in: Vec<(f64, bool)>,
}

impl Case {
    /// Probability of the labelled meaning.
    fn probability(&self, calibration: Calibration) -> f64 {
        let built_in: f64 = right(self.built_in.iter().copied());
        if self.model.is_empty() {
            return built_in;
        }
        let weights: Vec<f64> = self.model.iter().map(|(weight, _)| *weight).collect();
        let shares = powers(&weights, calibration.power);
        let model = right(shares.into_iter().zip(self.model.iter().map(|(_, is_right)| *is_right)));
        (1.0 - calibration.built_in) * model + calibration.built_in * built_in
    }
}

fn right(weights: impl Iterator<Item = (f64, bool)>) -> f64 {
    weights.filter(|(_, is_right)| *is_right).map(|(weight, _)| weight).sum()
}

/// Mean log loss of the labelled meanings, natural logarithm: lower is better, 0 is perfect. A
/// probability below [`LOSS_FLOOR`] counts as that. 0 for no cases.
pub fn log_loss(cases: &[Case], calibration: Calibration) -> f64 {
    let loss = |case: &Case| -case.probability(calibration).clamp(LOSS_FLOOR, 1.0).ln();
    // An empty sum is -0.
    cases.iter().map(loss).sum::<f64>().abs() / cases.len().max(1) as f64
}

/// Fits a calibration to labelled utterances: the least log loss, with a weak preference for an
/// exponent near 1. The same cases give the same result.
pub fn fit(cases: &[Case]) -> Calibration {
    let (least, most) = (Calibration::POWER.start().ln(), Calibration::POWER.end().ln());
    let (mut powers, mut shares) = ((least, most), (0.0, 1.0));
    let mut best = (f64::INFINITY, 0.0, 0.0);
    for _ in 0..=REFINEMENTS {
        for log_power in grid(powers) {
            for share in grid(shares) {
                let loss = penalised(cases, log_power, share);
                // A tie goes to the smaller correction.
                if loss < best.0 - 1e-12 {
                    best = (loss, log_power, share);
                }
            }
        }
        powers = around(best.1, powers, (least, most));
        shares = around(best.2, shares, (0.0, 1.0));
    }
    let rounded = |value: f64| (value * 1e3).round() / 1e3;
    let (_, log_power, built_in) = best;
    Calibration { power: rounded(log_power.exp()), built_in: rounded(built_in) }
}

/// Mean log loss if the calibration of each fifth of the cases is fitted to the others: an estimate
/// for utterances outside the set.
pub fn held_out_loss(cases: &[Case]) -> f64 {
    const PARTS: usize = 5;
    let of_part = |part: usize| {
        let split = |is_own: bool| -> Vec<Case> {
            let numbered = cases.iter().enumerate();
            numbered.filter(|(n, _)| (n % PARTS == part) == is_own).map(|it| it.1.clone()).collect()
        };
        let own = split(true);
        log_loss(&own, fit(&split(false))) * own.len() as f64
    };
    (0..PARTS).map(of_part).sum::<f64>() / cases.len().max(1) as f64
}

fn penalised(cases: &[Case], log_power: f64, built_in: f64) -> f64 {
    let calibration = Calibration { power: log_power.exp(), built_in };
    let penalty = 0.5 * (log_power / PRIOR_LOG_SD).powi(2) / cases.len().max(1) as f64;
    log_loss(cases, calibration) + penalty
}

fn grid((from, to): (f64, f64)) -> impl Iterator<Item = f64> {
    (0..=STEPS).map(move |step| from + (to - from) * step as f64 / STEPS as f64)
}

/// Two steps of the grid to each side, within the bounds.
fn around(best: f64, (from, to): (f64, f64), (least, most): (f64, f64)) -> (f64, f64) {
    let reach = 2.0 * (to - from) / STEPS as f64;
    ((best - reach).max(least), (best + reach).min(most))
}
