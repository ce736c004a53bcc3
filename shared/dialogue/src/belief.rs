//! The belief: how probable it is, for every object, that it is the one that is wanted.

use std::sync::OnceLock;

use scene::{ObjectId, Question, Reading};
use serde::{Deserialize, Serialize};

use crate::Model;
use crate::observation::{log_mixture, weigh, weighty};

/// A distribution over the hypotheses of a model: the objects of a scene, and perhaps that the
/// wanted one is not here.
///
/// It is held as the natural logarithms of weights, so that neither thousands of utterances nor
/// hundreds of objects can under- or overflow, and an object that was all but ruled out can always
/// come back. An update is one pass over them; the normalising constant is computed when a
/// probability is requested. The logarithms are the whole state: stored and restored by
/// [`Belief::log_weights`] and [`Belief::from_log`], it continues bit for bit as before.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub struct Belief {
    log: Vec<f64>,
    /// Logarithm of the sum of the weights, once computed.
    log_sum: OnceLock<f64>,
}

/// Why numbers are not a belief.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BeliefError {
    /// The belief has no object.
    #[error("a belief needs at least one object")]
    Empty,
    /// The entry is negative, infinite or not a number.
    #[error("entry {index} of the belief is {value}, not a probability")]
    NotAProbability {
        /// Position in the list.
        index: usize,
        /// Value at the position.
        value: f64,
    },
    /// Every entry is zero.
    #[error("every entry of the belief is zero")]
    AllZero,
}

impl Belief {
    /// Every object alike.
    ///
    /// # Panics
    /// If `objects` is 0; a scene has at least one.
    pub fn uniform(objects: usize) -> Self {
        assert!(objects > 0, "a belief needs at least one object");
        Self::of(vec![-(objects as f64).ln(); objects])
    }

    /// The belief with these probabilities, or with weights in these proportions. Zero is allowed
    /// and final: no observation brings such an object back.
    ///
    /// # Errors
    /// On no entry, an entry that is negative or not finite, or zeros alone.
    pub fn from_probabilities(probabilities: &[f64]) -> Result<Self, BeliefError> {
        if probabilities.is_empty() {
            return Err(BeliefError::Empty);
        }
        let wrong = probabilities.iter().position(|p| !p.is_finite() || *p < 0.0);
        if let Some(index) = wrong {
            return Err(BeliefError::NotAProbability { index, value: probabilities[index] });
        }
        if probabilities.iter().all(|p| *p == 0.0) {
            return Err(BeliefError::AllZero);
        }
        let mut belief = Self::of(probabilities.iter().map(|p| p.ln()).collect());
        let log_sum = belief.log_sum();
        belief.log.iter_mut().for_each(|l| *l -= log_sum);
        Ok(Self::of(belief.log))
    }

    fn of(log: Vec<f64>) -> Self {
        Self { log, log_sum: OnceLock::new() }
    }

    /// The belief with exactly these logarithms, as [`Belief::log_weights`] gave them.
    ///
    /// # Errors
    /// If there are none, one is not a number or infinite, or all are −∞.
    pub fn from_log(log: Vec<f64>) -> Result<Self, BeliefError> {
        if log.is_empty() {
            return Err(BeliefError::Empty);
        }
        if let Some(index) = log.iter().position(|l| l.is_nan() || *l == f64::INFINITY) {
            return Err(BeliefError::NotAProbability { index, value: log[index] });
        }
        if log.iter().all(|l| *l == f64::NEG_INFINITY) {
            return Err(BeliefError::AllZero);
        }
        Ok(Self::of(log))
    }

    /// Natural logarithm of the weight of every hypothesis, −∞ if it is zero. Weights are
    /// proportional to probabilities; their sum is not 1 in general.
    pub fn log_weights(&self) -> &[f64] {
        &self.log
    }

    /// Every object's probability, in the scene's order.
    pub fn probabilities(&self) -> Vec<f64> {
        let log_sum = self.log_sum();
        self.log.iter().map(|l| (l - log_sum).exp()).collect()
    }

    /// The probability that object `i` is wanted.
    pub fn probability(&self, i: ObjectId) -> f64 {
        (self.log[i.index()] - self.log_sum()).exp()
    }

    /// The most probable object; of several the first.
    pub fn most_likely(&self) -> ObjectId {
        let first = (self.log.iter().enumerate())
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
            .map_or(0, |(i, _)| i);
        ObjectId::from(first)
    }

    /// The probabilities in units of 10⁻¹², rounded: equal for beliefs that differ by rounding
    /// errors alone, so that they can be counted, or decided upon, as one.
    pub fn key(&self) -> Vec<i64> {
        let mut key = Vec::with_capacity(self.log.len());
        self.key_into(&mut key);
        key
    }

    /// [`Belief::key`] into `key`, whose memory is used again.
    pub fn key_into(&self, key: &mut Vec<i64>) {
        key.clear();
        let log_sum = self.log_sum();
        key.extend(self.log.iter().map(|l| ((l - log_sum).exp() * KEY_UNITS).round() as i64));
    }

    /// The belief that represents all with the given key.
    ///
    /// # Errors
    /// If the key is not the key of a belief.
    pub fn from_key(key: &[i64]) -> Result<Self, BeliefError> {
        let weights: Vec<f64> = key.iter().map(|units| *units as f64).collect();
        Self::from_probabilities(&weights)
    }

    /// How many objects the belief is about.
    #[expect(clippy::len_without_is_empty, reason = "a belief is never empty")]
    pub fn len(&self) -> usize {
        self.log.len()
    }

    /// Bayes' rule with an utterance that answers `question`: `b'(D) ∝ P(l_b, l_r | D, Q) b(D)`.
    ///
    /// An utterance that is as likely whatever is wanted, silence among them, leaves the belief
    /// unchanged bit for bit.
    ///
    /// # Panics
    /// If belief, question and reading are not about the model's scene.
    pub fn update(&mut self, model: &Model, question: Question, reading: &Reading) {
        weigh(model, question, reading, &mut self.log);
        self.log_sum.take();
    }

    /// Updates by Bayes' rule if the words, or the question that they answer, are uncertain: `P(o |
    /// D) = Σ_j w_j P(o_j | D, Q_j)`.
    ///
    /// Weights are relative; hypotheses of weight zero are left out, and without any other the
    /// belief stays as it is.
    ///
    /// # Panics
    /// If a weight is negative or not finite, or anything is not about the model's scene.
    pub fn update_mixture(&mut self, model: &Model, heard: &[(f64, Question, Reading)]) {
        let mut counting = weighty(heard);
        if let (Some((_, question, reading)), None) = (counting.next(), counting.next()) {
            self.update(model, *question, reading);
        } else if let Some(mixture) = log_mixture(model, heard) {
            self.weigh(&mixture);
        }
    }

    /// Bayes' rule with any other evidence: the logarithm of its likelihood by hypothesis, up to a
    /// constant. The greatest is taken as 1, so that weights only fall; evidence that is as likely
    /// whatever is wanted changes no bit.
    ///
    /// # Panics
    /// If there is not one for every hypothesis.
    pub fn weigh(&mut self, log_likelihood: &[f64]) {
        assert_eq!(self.log.len(), log_likelihood.len(), "belief and model are of one scene");
        let (least, greatest) = extremes(log_likelihood);
        if least == greatest {
            return;
        }
        for (weight, likelihood) in self.log.iter_mut().zip(log_likelihood) {
            *weight += likelihood - greatest;
        }
        self.log_sum.take();
    }

    /// The largest term is taken out first, so that at least one exponential is 1 and none
    /// overflows.
    fn log_sum(&self) -> f64 {
        *self.log_sum.get_or_init(|| {
            let largest = self.log.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            largest + self.log.iter().map(|l| (l - largest).exp()).sum::<f64>().ln()
        })
    }
}

impl PartialEq for Belief {
    fn eq(&self, other: &Self) -> bool {
        self.log == other.log
    }
}

/// The least and the greatest number, in lanes that need not wait for each other.
fn extremes(numbers: &[f64]) -> (f64, f64) {
    const LANES: usize = 8;
    let mut least = [f64::INFINITY; LANES];
    let mut greatest = [f64::NEG_INFINITY; LANES];
    let mut see = |lane: usize, number: f64| {
        least[lane] = if number < least[lane] { number } else { least[lane] };
        greatest[lane] = if number > greatest[lane] { number } else { greatest[lane] };
    };
    let (whole, rest) = numbers.as_chunks::<LANES>();
    whole.iter().for_each(|chunk| (0..LANES).for_each(|lane| see(lane, chunk[lane])));
    rest.iter().for_each(|number| see(0, *number));
    let of_all = |lanes: [f64; LANES], pick: fn(f64, f64) -> f64| {
        lanes.into_iter().reduce(pick).unwrap_or(f64::NAN)
    };
    (of_all(least, f64::min), of_all(greatest, f64::max))
}

/// Units of a belief's key in a probability of 1.
const KEY_UNITS: f64 = 1e12;

impl TryFrom<Vec<f64>> for Belief {
    type Error = BeliefError;

    fn try_from(log: Vec<f64>) -> Result<Self, BeliefError> {
        Self::from_log(log)
    }
}

impl From<Belief> for Vec<f64> {
    fn from(belief: Belief) -> Self {
        belief.log
    }
}

#[cfg(test)]
mod golden;
#[cfg(test)]
mod tests;
