//! The parameters of the observation model.

use serde::{Deserialize, Serialize};

/// `p_l`, `ε` and `α` of section 3.6. The default is what section 4 tests with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Probability of hearing an utterance, eq. (4), (6), (7); strictly between 0 and 1.
    pub p_l: f64,
    /// Probability that a question is answered wrongly, eq. (6), (7); strictly between 0 and 0.5.
    pub epsilon: f64,
    /// Smoothing of the words, eq. (5); above 0.
    pub alpha: f64,
}

/// What is wrong with one setting: its key, the fault, and the fix.
pub type Fault = (&'static str, String, &'static str);

impl Default for Params {
    fn default() -> Self {
        Self { p_l: 0.95, epsilon: 0.01, alpha: 0.2 }
    }
}

impl Params {
    /// Every parameter that is out of range; empty if the model can be built from them.
    ///
    /// The open ends matter: at `p_l` or `ε` of 0 or 1 a single utterance would rule objects out
    /// for ever, and at `ε = 0.5` an answer would mean nothing.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if !(self.p_l > 0.0 && self.p_l < 1.0) {
            faults.push(("p_l", format!("{} is not a probability", self.p_l), PROBABILITY));
        }
        if !(self.epsilon > 0.0 && self.epsilon < 0.5) {
            let what = format!("{} is not an error rate", self.epsilon);
            faults.push(("epsilon", what, "use a number above 0 and below 0.5, e.g. 0.01"));
        }
        if !(self.alpha > 0.0 && self.alpha.is_finite()) {
            let what = format!("{} is not a smoothing weight", self.alpha);
            faults.push(("alpha", what, "use a number above 0, e.g. 0.2"));
        }
        faults
    }
}

const PROBABILITY: &str = "use a number above 0 and below 1, e.g. 0.95";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_usable() {
        assert_eq!(Params::default().check(), Vec::new());
    }

    #[test]
    fn every_fault_is_told_at_once() {
        let keys = |p_l, epsilon, alpha| -> Vec<_> {
            Params { p_l, epsilon, alpha }.check().into_iter().map(|fault| fault.0).collect()
        };
        assert_eq!(keys(0.0, 0.5, 0.0), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(1.0, 0.0, f64::INFINITY), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(f64::NAN, f64::NAN, f64::NAN), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(0.95, -0.1, 0.2), ["epsilon"]);
    }
}
