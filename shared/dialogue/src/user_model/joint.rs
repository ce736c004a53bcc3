//! Joint belief about the wanted object and the person's error rate.

use scene::{Question, Reading};
use serde::{Deserialize, Serialize};
use vocabulary::Params;

use super::{ERROR_RATES, Person};
use crate::observation::log_mixture;
use crate::{Answer, Belief, BeliefError, Model};

/// A belief over objects for every error rate, and how probable each error rate is.
///
/// `P(D, ε | o) ∝ P(o | D, ε) P(D | ε) P(ε)`: contradicting answers make a high error rate
/// probable, and under a high error rate they say less about the object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    person: Person,
    /// Given each of [`ERROR_RATES`].
    beliefs: Vec<Belief>,
}

impl Joint {
    /// Joint belief at the beginning of an interaction: object and error rate are independent.
    pub fn new(prior: Belief, person: Person) -> Self {
        Self { person, beliefs: vec![prior; ERROR_RATES.len()] }
    }

    /// The person as learned so far, for the next interaction.
    pub fn person(&self) -> &Person {
        &self.person
    }

    /// The person, for updates that say nothing about the object.
    pub fn person_mut(&mut self) -> &mut Person {
        &mut self.person
    }

    /// The belief over objects, whatever the error rate.
    pub fn belief(&self) -> Belief {
        let rates = self.person.error_probabilities();
        let mut sum = vec![0.0; self.beliefs[0].len()];
        for (rate, belief) in rates.iter().zip(&self.beliefs) {
            for (sum, probability) in sum.iter_mut().zip(belief.probabilities()) {
                *sum += rate * probability;
            }
        }
        // The probabilities of a belief sum to 1, so there is always something to normalise.
        Belief::from_probabilities(&sum).unwrap_or_else(|_| self.beliefs[0].clone())
    }

    /// Updates by Bayes' rule, as [`Belief::update_mixture`], for every error rate. The model's own
    /// error rate plays no part.
    ///
    /// # Panics
    /// As [`Belief::update_mixture`].
    pub fn update_mixture(&mut self, model: &Model, heard: &[(f64, Question, Reading)]) {
        for (j, rate) in ERROR_RATES.into_iter().enumerate() {
            let model = model.with_params(Params { epsilon: rate, ..model.params() });
            let Some(log) = log_mixture(&model, heard) else { return };
            self.take(j, &log);
        }
    }

    /// Bayes' rule with evidence that does not depend on how people answer, such as a gesture:
    /// logarithms of its likelihood, by hypothesis.
    ///
    /// # Panics
    /// If there is not one for every hypothesis.
    pub fn weigh(&mut self, log_likelihood: &[f64]) {
        for j in 0..ERROR_RATES.len() {
            self.take(j, log_likelihood);
        }
    }

    /// Probability of an answer, whatever object and error rate.
    ///
    /// # Panics
    /// If the question is not about the model's scene.
    pub fn probability(&self, model: &Model, question: Question, answer: Answer) -> f64 {
        let rates = self.person.error_probabilities();
        let mut sum = 0.0;
        for ((rate, belief), epsilon) in rates.iter().zip(&self.beliefs).zip(ERROR_RATES) {
            let model = model.with_params(Params { epsilon, ..model.params() });
            let objects = belief.probabilities().into_iter().enumerate();
            sum += rate
                * objects
                    .map(|(i, p)| p * answer.probability(&model, question, i.into()))
                    .sum::<f64>();
        }
        sum
    }

    /// Appends numbers that are equal for beliefs that differ by rounding alone, in planners'
    /// terms: the person's error rates and counts, then the belief under each error rate.
    pub fn key_into(&self, key: &mut Vec<i64>) {
        self.person.key_into(key);
        for belief in &self.beliefs {
            key.extend(belief.key());
        }
    }

    /// Returns the representative of all beliefs with this one's key.
    ///
    /// # Errors
    /// Never for a key of its own.
    pub fn rounded(&self) -> Result<Self, BeliefError> {
        let beliefs = self.beliefs.iter().map(|belief| Belief::from_key(&belief.key()));
        Ok(Self { person: self.person.rounded(), beliefs: beliefs.collect::<Result<_, _>>()? })
    }

    fn take(&mut self, j: usize, log_likelihood: &[f64]) {
        let belief = &mut self.beliefs[j];
        let probabilities = belief.probabilities();
        let greatest = log_likelihood.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let evidence: f64 = (probabilities.iter().zip(log_likelihood))
            .map(|(p, log)| p * (log - greatest).exp())
            .sum();
        self.person.log_errors[j] += greatest + evidence.max(f64::MIN_POSITIVE).ln();
        belief.weigh(log_likelihood);
    }
}
