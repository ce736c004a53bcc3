//! The parameters of the observation model.

use scene::Question;
use serde::{Deserialize, Serialize};

/// `p_l`, `ε` and `α` of section 3.6. The default has the values tested in section 4.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Probability of hearing an utterance, eq. (4), (6), (7); strictly between 0 and 1.
    pub p_l: f64,
    /// Probability that a question is answered wrongly, eq. (6), (7); strictly between 0 and 0.5.
    pub epsilon: f64,
    /// Smoothing of the words, eq. (5); above 0.
    pub alpha: f64,
    /// Answers to open questions; none: `p_l` and `ε` hold of them too, as in section 4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub open: Option<Reliability>,
    /// Answers to choice questions; none: `p_l` and `ε` hold of them too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<Reliability>,
}

/// How well answers to one kind of question come through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reliability {
    /// Probability of hearing an answer; strictly between 0 and 1.
    pub p_l: f64,
    /// Probability of a wrong answer; strictly between 0 and 0.5.
    pub epsilon: f64,
}

/// A wrong setting: its key, the fault, and the fix.
pub type Fault = (&'static str, String, &'static str);

impl Default for Params {
    fn default() -> Self {
        Self { p_l: 0.95, epsilon: 0.01, alpha: 0.2, open: None, choice: None }
    }
}

impl Params {
    /// Reliability of the answers to a question.
    pub fn of(&self, question: Question) -> Reliability {
        let own = match question {
            Question::Which(_) => self.open,
            Question::Choice(..) => self.choice,
            Question::None | Question::Point(_) | Question::Attribute(..) => None,
        };
        own.unwrap_or(Reliability { p_l: self.p_l, epsilon: self.epsilon })
    }

    /// The parameters with answers to questions of every kind wrong more often by `rate`.
    #[must_use]
    pub fn with_more_errors(self, rate: f64) -> Self {
        let more = |epsilon: f64| (epsilon + rate).min(EPSILON_MAX);
        let own = |of: Option<Reliability>| {
            of.map(|own| Reliability { epsilon: more(own.epsilon), ..own })
        };
        let (open, choice) = (own(self.open), own(self.choice));
        Self { epsilon: more(self.epsilon), open, choice, ..self }
    }

    /// Every parameter that is out of range; empty if the model can be built from them.
    ///
    /// The open ends matter: at `p_l` or `ε` of 0 or 1 a single utterance would rule objects out
    /// for ever, and at `ε = 0.5` an answer would mean nothing.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = Reliability { p_l: self.p_l, epsilon: self.epsilon }.check();
        let own = [("open", self.open), ("choice", self.choice)];
        faults.extend(own.into_iter().filter_map(|(key, own)| {
            let (part, what, help) = own?.check().into_iter().next()?;
            Some((key, format!("{part}: {what}"), help))
        }));
        if !(self.alpha > 0.0 && self.alpha.is_finite()) {
            let what = format!("{} is not a smoothing weight", self.alpha);
            faults.push(("alpha", what, "use a number above 0, e.g. 0.2"));
        }
        faults
    }
}

impl Reliability {
    /// Every number that is out of range.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if !(self.p_l > 0.0 && self.p_l < 1.0) {
            faults.push(("p_l", format!("{} is not a probability", self.p_l), PROBABILITY));
        }
        if !(self.epsilon > 0.0 && self.epsilon < 0.5) {
            let what = format!("{} is not an error rate", self.epsilon);
            faults.push(("epsilon", what, "use a number above 0 and below 0.5, e.g. 0.01"));
        }
        faults
    }
}

/// Largest error rate with which an answer still says something.
const EPSILON_MAX: f64 = 0.499;

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
            Params { p_l, epsilon, alpha, ..Params::default() }
                .check()
                .into_iter()
                .map(|fault| fault.0)
                .collect()
        };
        assert_eq!(keys(0.0, 0.5, 0.0), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(1.0, 0.0, f64::INFINITY), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(f64::NAN, f64::NAN, f64::NAN), ["p_l", "epsilon", "alpha"]);
        assert_eq!(keys(0.95, -0.1, 0.2), ["epsilon"]);
        let (open, choice) =
            (Reliability { p_l: 1.0, epsilon: 0.1 }, Reliability { p_l: 0.9, epsilon: 0.6 });
        let own = Params { open: Some(open), choice: Some(choice), ..Params::default() };
        let keys: Vec<_> = own.check().into_iter().map(|fault| fault.0).collect();
        assert_eq!(keys, ["open", "choice"]);
    }

    #[test]
    fn kinds_of_questions_have_a_reliability_of_their_own_where_it_is_set() {
        let (k, plain) = (scene::AttributeId(0), Params::default());
        let usual = Reliability { p_l: plain.p_l, epsilon: plain.epsilon };
        let options = scene::Options::new(&[0, 1].map(scene::ValueId)).unwrap();
        let (open, choice) = (Question::Which(k), Question::Choice(k, options));
        assert_eq!((plain.of(open), plain.of(choice)), (usual, usual));
        let own = Reliability { p_l: 0.8, epsilon: 0.05 };
        let careful = Params { choice: Some(own), ..plain };
        assert_eq!((careful.of(open), careful.of(choice)), (usual, own));
    }
}
