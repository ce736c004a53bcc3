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
const MEDIAN_S: f64 = 0.9;
const DEVIATION: f64 = 0.55;
/// Shape of the prior; its count is as large. Worth a handful of times seen.
const SHAPE: f64 = 3.0;
/// `Γ(3.5) / Γ(3)`.
const GAMMA_RATIO: f64 = 1.661_675_445_222_153_8;
/// Times are cut off here: nobody reacts within, and typing at leisure is no reaction.
const SECONDS: std::ops::RangeInclusive<f64> = 0.05..=60.0;

impl Default for Reaction {
    fn default() -> Self {
        let scale = DEVIATION * DEVIATION * (SHAPE - 1.0);
        Self { mean: MEDIAN_S.ln(), count: SHAPE, shape: SHAPE, scale }
    }
}

impl Reaction {
    /// Takes in a reaction time, seconds.
    pub fn see(&mut self, seconds: f64) {
        if !seconds.is_finite() {
            return;
        }
        let log = seconds.clamp(*SECONDS.start(), *SECONDS.end()).ln();
        let surprise = log - self.mean;
        self.scale += 0.5 * self.count / (self.count + 1.0) * surprise * surprise;
        self.mean += surprise / (self.count + 1.0);
        self.count += 1.0;
        self.shape += 0.5;
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

    /// Seconds within which all but a few in a thousand reactions begin: three spreads, for a
    /// distribution whose tails are a little heavier than normal.
    pub fn patience_s(&self) -> f64 {
        (self.mean + 3.0 * self.spread()).exp()
    }

    fn spread(&self) -> f64 {
        (self.scale * (self.count + 1.0) / (self.shape * self.count)).sqrt()
    }

    /// `Γ(a + ½) / Γ(a)` for the shape, which grows in halves from [`SHAPE`]: with `R(a)` for it,
    /// `R(a + ½) = a / R(a)`.
    fn gamma_ratio(&self) -> f64 {
        let steps = (2.0 * (self.shape - SHAPE)).round() as u32;
        if steps > 1_000 {
            // The ratio tends to √a; the next term of the series is exact enough here.
            return self.shape.sqrt() * (1.0 - 0.125 / self.shape);
        }
        (0..steps).fold(GAMMA_RATIO, |ratio, step| (SHAPE + 0.5 * f64::from(step)) / ratio)
    }
}
