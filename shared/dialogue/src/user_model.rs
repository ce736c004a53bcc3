//! Model of how one person answers: a posterior that continues from one interaction to the next.
//!
//! The paper takes `ε` and `p_l` as known. Here they are beliefs (after Abbasnejad et al., who put
//! questions under uncertainty about the model that they are to inform): `p_l` by counting answered
//! and unanswered questions, `ε` together with the wanted object, because an answer is only known
//! to be wrong once the object is known ([`Joint`]), and the time to react by the times seen
//! ([`Reaction`](vocabulary::reaction::Reaction)).

mod joint;

pub use joint::Joint;

use serde::{Deserialize, Serialize};

use vocabulary::Params;

/// The values of `ε` that a person may have.
pub const ERROR_RATES: [f64; 10] = [0.003, 0.01, 0.02, 0.04, 0.07, 0.1, 0.14, 0.2, 0.28, 0.38];

/// One person, as far as they are known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Person {
    /// Logarithm of the weight of each of [`ERROR_RATES`], up to a constant.
    log_errors: Vec<f64>,
    /// Questions that were answered and that were not, with those that the prior is worth.
    answered: f64,
    unanswered: f64,
}

/// How many questions the configured `p_l` is worth.
const CONFIDENCE: f64 = 20.0;
/// Units of a key in a probability of 1, and in a question that was answered.
const KEY_UNITS: f64 = 1e9;
/// How fast the prior falls with the distance of an error rate from the configured one, per nat:
/// at 1.5 a user who errs ten times as often is thirty times less likely.
const STEEPNESS: f64 = 1.5;

impl Person {
    /// A user of whom nothing is known beyond the configuration.
    pub fn new(params: Params) -> Self {
        let distance = |rate: f64| (rate / params.epsilon).ln().abs();
        Self {
            log_errors: ERROR_RATES.iter().map(|rate| -STEEPNESS * distance(*rate)).collect(),
            answered: CONFIDENCE * params.p_l,
            unanswered: CONFIDENCE * (1.0 - params.p_l),
        }
    }

    /// Probability of each of [`ERROR_RATES`].
    pub fn error_probabilities(&self) -> Vec<f64> {
        let greatest = self.log_errors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = self.log_errors.iter().map(|log| (log - greatest).exp()).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|weight| weight / sum).collect()
    }

    /// The expected parameters of this person; `α` is not a person's.
    pub fn params(&self, configured: Params) -> Params {
        let rates = self.error_probabilities().into_iter().zip(ERROR_RATES);
        Params {
            p_l: self.answered / (self.answered + self.unanswered),
            epsilon: rates.map(|(probability, rate)| probability * rate).sum(),
            ..configured
        }
    }

    /// Takes in that a question was answered, or was not although there was time.
    pub fn see_answer(&mut self, answered: bool) {
        if answered {
            self.answered += 1.0;
        } else {
            self.unanswered += 1.0;
        }
    }

    /// Error rates and counts in whole units; a user's reaction time changes no decision.
    fn key_into(&self, key: &mut Vec<i64>) {
        key.clear();
        key.extend(self.error_probabilities().iter().map(|p| (p * KEY_UNITS).round() as i64));
        key.extend([self.answered, self.unanswered].map(|count| (count * KEY_UNITS) as i64));
    }

    /// The person with error rates in whole units.
    fn rounded(&self) -> Self {
        let log = |p: f64| ((p * KEY_UNITS).round().max(0.1) / KEY_UNITS).ln();
        Self {
            log_errors: self.error_probabilities().into_iter().map(log).collect(),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests;
