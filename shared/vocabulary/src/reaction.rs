//! How long a person takes to begin an answer.

use serde::{Deserialize, Serialize};

/// A log-normal reaction time whose two parameters are not known: a normal-inverse-gamma posterior
/// over mean and variance of the logarithm, so that the time to come follows a Student
/// distribution on that scale.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reaction {
    /// Expected logarithm of the seconds.
    mean: f64,
    /// How many times the mean is worth.
    count: f64,
    /// Shape of the variance.
    shape: f64,
    /// Scale of the variance.
    scale: f64,
}

/// Median of people's reaction to a spoken question, seconds, and the deviation of its logarithm.
pub const SPOKEN: (f64, f64) = (0.9, 0.55);
/// Reaction to a question on the screen with a typed answer. Estimated, not measured.
pub const TYPED: (f64, f64) = (3.0, 0.9);
/// Shape of the prior; its count is as large. Worth a handful of times seen.
const SHAPE: f64 = 3.0;
/// `Γ(3.5) / Γ(3)`.
const GAMMA_RATIO: f64 = 1.661_675_445_222_153_8;
/// The least spread of the logarithm: no person is more regular.
const SPREAD_MIN: f64 = 0.1;
/// Even of the most willing, some questions stay unanswered.
const ANSWERED_MAX: f64 = 0.999;
/// Range to which reaction times are limited: nobody reacts faster, and typing at leisure is not a
/// reaction.
const SECONDS: std::ops::RangeInclusive<f64> = 0.05..=60.0;

/// Times of one person that are remembered in full: beyond it the latest of them count more than
/// the earliest.
const SEEN_MAX: f64 = 200.0;

impl Default for Reaction {
    /// People who speak.
    fn default() -> Self {
        Self::new(SPOKEN.0, SPOKEN.1)
    }
}

impl Reaction {
    /// Prior for people in general: median, seconds, and standard deviation of the logarithm.
    pub fn new(median_s: f64, log_sd: f64) -> Self {
        let scale = log_sd * log_sd * (SHAPE - 1.0);
        Self { mean: median_s.ln(), count: SHAPE, shape: SHAPE, scale }
    }

    /// Takes in a reaction time, seconds.
    pub fn see(&mut self, seconds: f64) {
        if !seconds.is_finite() {
            return;
        }
        let log = seconds.clamp(*SECONDS.start(), *SECONDS.end()).ln();
        let surprise = log - self.mean;
        self.scale += 0.5 * self.count / (self.count + 1.0) * surprise * surprise;
        self.mean += surprise / (self.count + 1.0);
        if self.count < SHAPE + SEEN_MAX {
            self.count += 1.0;
            self.shape += 0.5;
        } else {
            // As if one that was seen were forgotten.
            self.scale *= self.shape / (self.shape + 0.5);
        }
    }

    /// How many times were taken in.
    pub fn seen(&self) -> u32 {
        (self.count - SHAPE).round() as u32
    }

    /// Median of the time to come, seconds.
    pub fn median_s(&self) -> f64 {
        self.mean.exp()
    }

    /// Logarithm of the density of a reaction time, per second; −∞ before the question has ended.
    pub fn log_density(&self, seconds: f64) -> f64 {
        if seconds <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let spread = self.spread();
        let freedom = 2.0 * self.shape;
        let t = (seconds.ln() - self.mean) / spread;
        self.gamma_ratio().ln()
            - 0.5 * (freedom * std::f64::consts::PI).ln()
            - spread.ln()
            - (self.shape + 0.5) * (t * t / freedom).ln_1p()
            - seconds.ln()
    }

    /// Probability that a person who answers has begun to within `seconds`.
    pub fn share_begun(&self, seconds: f64) -> f64 {
        if seconds <= 0.0 {
            return 0.0;
        }
        let t = (seconds.ln() - self.mean) / self.spread();
        0.5 + 0.5 * t.signum() * student_within(t.abs(), (2.0 * self.shape).round() as u32)
    }

    /// Answers that begin per second, `seconds` after a question that has not been answered yet: `p
    /// f(t) / (1 − p F(t))` if a share `p` of questions is answered at all.
    pub fn rate(&self, seconds: f64, answered: f64) -> f64 {
        let (soonest, answered) = (seconds.max(*SECONDS.start()), answered.min(ANSWERED_MAX));
        answered * self.log_density(soonest).exp() / (1.0 - answered * self.share_begun(soonest))
    }

    /// Seconds within which all but a few in a thousand reactions begin: three spreads, for a
    /// distribution whose tails are a little heavier than normal.
    pub fn patience_s(&self) -> f64 {
        (self.mean + 3.0 * self.spread()).exp()
    }

    fn spread(&self) -> f64 {
        (self.scale * (self.count + 1.0) / (self.shape * self.count)).sqrt().max(SPREAD_MIN)
    }

    /// `Γ(a + ½) / Γ(a)` for the shape, which grows in halves from [`SHAPE`]: with `R(a)` for it,
    /// `R(a + ½) = a / R(a)`.
    fn gamma_ratio(&self) -> f64 {
        let steps = (2.0 * (self.shape - SHAPE)).round() as u32;
        (0..steps).fold(GAMMA_RATIO, |ratio, step| (SHAPE + 0.5 * f64::from(step)) / ratio)
    }
}

/// `P(|T| ≤ t)` of Student's distribution with `freedom` degrees: Abramowitz and Stegun, 26.7.3 and
/// 26.7.4, finite sums in the angle `atan(t / √ν)`.
fn student_within(t: f64, freedom: u32) -> f64 {
    let angle = (t / f64::from(freedom).sqrt()).atan();
    let (sin, cos) = angle.sin_cos();
    let odd = freedom % 2 == 1;
    let (mut term, mut sum) = (if odd { cos } else { 1.0 }, 0.0);
    let mut k = if odd { 3 } else { 2 };
    while k <= freedom {
        sum += term;
        term *= cos * cos * f64::from(k - 1) / f64::from(k);
        k += 2;
    }
    if !odd {
        sin * sum
    } else if freedom == 1 {
        2.0 * angle / std::f64::consts::PI
    } else {
        2.0 / std::f64::consts::PI * (angle + sin * sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    #[test]
    fn reaction_times_are_learned() {
        let mut rng = Rng::new(23);
        // A slow person: median 2.5 s, deviation 0.3.
        let mut reaction = Reaction::default();
        assert!((reaction.median_s() - 0.9).abs() < 1e-12);
        let before = reaction.patience_s();
        for _ in 0..200 {
            let normal: f64 = (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
            reaction.see(2.5 * (0.3 * normal).exp());
        }
        assert!((2.3..2.7).contains(&reaction.median_s()), "{reaction:?}");
        assert!((5.0..8.0).contains(&reaction.patience_s()), "{reaction:?} before {before}");
        reaction.see(f64::NAN);
        assert!(reaction.median_s().is_finite());
    }

    #[test]
    fn the_density_of_reaction_times_is_one() {
        let mut reaction = Reaction::default();
        for times in [0, 1, 7, 3_000] {
            (0..times).for_each(|_| reaction.see(1.3));
            let step = 1e-3;
            let density =
                |n: i32| reaction.log_density(f64::from(n).mul_add(step, 0.5 * step)).exp();
            let mass: f64 = (0..400_000).map(density).sum::<f64>() * step;
            assert!((mass - 1.0).abs() < 2e-2, "after {times}: {mass}");
            assert_eq!(reaction.log_density(0.0), f64::NEG_INFINITY);
        }
    }
}
