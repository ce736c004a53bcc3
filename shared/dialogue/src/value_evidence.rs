//! Evidence of an utterance about the values of an attribute that are in doubt: a camera is not
//! sure of them, or the user may take one for another ([`Model::with_misperceptions`]).
//!
//! Words and answers about one attribute are independent only given its value: a user who has said
//! no to "is it white?" of an object that may be white, or that the user believes to be grey, says
//! no again. So all of them count by value first, and the probabilities of the values come last:
//!
//! `P(o₁ … o_n | D) = Π_k Σ_m P(m_k = m | D) Π_j P(o_j | m)`.

use scene::{AttributeId, Question, Reading, Response, ValueId, WordId};
use serde::{Deserialize, Serialize};

use crate::observation::named_answer;
use crate::{CERTAIN_DOUBT, Model, Naming};

/// Likelihood of the words about one attribute, by the object's value of it.
#[derive(Clone, Debug)]
pub(crate) struct ValueEvidence {
    /// Likelihood by value.
    by_value: Vec<f64>,
    /// Likelihood for an object that lacks the attribute.
    lacking: f64,
    /// Likelihood for the absent object.
    unknown: f64,
}

impl ValueEvidence {
    fn none(values: usize) -> Self {
        Self { by_value: vec![1.0; values], lacking: 1.0, unknown: 1.0 }
    }

    /// The words of a reading about attribute `k`, if there are any and a value of it is in doubt.
    pub(crate) fn of_words(
        model: &Model,
        k: AttributeId,
        question: Question,
        reading: &Reading,
    ) -> Option<Self> {
        let answer = named_answer(model, question, &reading.base).filter(|(of, _)| *of == k);
        let answering = answer.map(|(k, v)| model.word(k, v));
        let is_about = |word: &WordId| model.doubtful_attribute(*word) == Some(k);
        let mut evidence = Self::none(model.values(k));
        let mut says = false;
        for (at, &word) in reading.base.iter().enumerate().filter(|(_, word)| is_about(word)) {
            let first = reading.base.iter().position(|it| *it == word) == Some(at);
            let doubt = reading.doubt.of_word(at);
            match answer {
                Some((_, v)) if Some(word) == answering => {
                    if let Some(law) = Naming::of(model, question).filter(|_| first) {
                        evidence.add_named(law.doubted(doubt), Some(v));
                    }
                }
                _ => evidence.add_word(model, k, (word, doubt)),
            }
            says = true;
        }
        for (at, group) in reading.excluded.iter().enumerate() {
            if let [word] = group.as_slice()
                && is_about(word)
            {
                let wrong = model.error_rate(reading.doubt.of_group(at));
                evidence.add([1.0 - wrong; 2], |m| {
                    if model.word(k, m) == *word { wrong } else { 1.0 - wrong }
                });
                says = true;
            }
        }
        says.then_some(evidence)
    }

    /// All that a reading says about attribute `k`.
    fn of(model: &Model, k: AttributeId, question: Question, reading: &Reading) -> Option<Self> {
        let words = Self::of_words(model, k, question, reading);
        let doubt = reading.doubt.response;
        let all = |words: Option<Self>| words.unwrap_or_else(|| Self::none(model.values(k)));
        match (question, reading.response) {
            (Question::Attribute(asked, v), Response::Yes | Response::No) if asked == k => {
                let wrong = model.error_rate(doubt);
                let yes = reading.response == Response::Yes;
                let of = |is_own: bool| if is_own == yes { 1.0 - wrong } else { wrong };
                let unknown = model.unknown_yes(k);
                let unknown = if yes { unknown } else { 1.0 - unknown };
                let mut all = all(words);
                all.add([of(false), unknown], |m| of(m == v));
                Some(all)
            }
            (Question::Choice(asked, _), Response::No)
                if asked == k && named_answer(model, question, &reading.base).is_none() =>
            {
                let Some(law) = Naming::of(model, question).filter(|law| law.neither) else {
                    return words;
                };
                let mut all = all(words);
                all.add_named(law.doubted(doubt), None);
                Some(all)
            }
            _ => words,
        }
    }

    /// Adds evidence: its likelihood by value, for an object that lacks the attribute, and for the
    /// absent one.
    fn add(&mut self, [lacking, unknown]: [f64; 2], of: impl Fn(ValueId) -> f64) {
        self.lacking *= lacking;
        self.unknown *= unknown;
        for (m, likelihood) in self.by_value.iter_mut().enumerate() {
            *likelihood *= of(ValueId::from(m));
        }
    }

    /// Eq. (5) without its denominator, relative to a value's own word. Words of other attributes
    /// that may have been said instead count by the share of hypotheses that have them.
    fn add_word(&mut self, model: &Model, k: AttributeId, (word, doubt): (WordId, f64)) {
        let alpha = model.smoothing(doubt <= CERTAIN_DOUBT);
        let mut said = vec![0.0; model.values(k)];
        let mut elsewhere = alpha;
        for (u, share) in model.said_instead(word, doubt) {
            let own = model.meanings(u).iter().find(|(of, _)| *of == k);
            match own {
                Some((_, v)) => said[v.index()] += share,
                None => elsewhere += share * model.mean_word_chance(u),
            }
        }
        self.add([elsewhere / (1.0 + alpha); 2], |m| (said[m.index()] + elsewhere) / (1.0 + alpha));
    }

    fn add_named(&mut self, law: Naming, named: Option<ValueId>) {
        self.add(law.without_value(named), |m| law.of_value(named, m));
    }

    /// Probabilities of the values after this, given those before it.
    pub(crate) fn condition(&self, chances: &[f64]) -> Vec<f64> {
        let all = self.mean(chances);
        chances.iter().zip(&self.by_value).map(|(p, it)| p * it / all).collect()
    }

    fn mean(&self, chances: &[f64]) -> f64 {
        chances.iter().zip(&self.by_value).map(|(p, it)| p * it).sum()
    }

    /// Likelihood for an object without the attribute, seen with a value of these probabilities.
    fn of_lacking(&self, chances: &[f64]) -> f64 {
        chances
            .split_last()
            .map_or(self.lacking, |(lacks, of)| self.mean(of) + lacks * self.lacking)
    }

    /// Adds the logarithm of the likelihood to every entry, but for a constant that is returned. No
    /// entry rises.
    pub(crate) fn weigh(&self, model: &Model, k: AttributeId, log: &mut [f64]) -> f64 {
        let column = model.column(k);
        let in_doubt: Vec<f64> =
            model.all_chances(k).iter().map(|chances| self.mean(chances).ln()).collect();
        let known: Vec<f64> = self.by_value.iter().map(|it| it.ln()).collect();
        let factor = |entry: u16| match entry {
            Model::LACKS => self.of_lacking(model.lacking(k)).ln(),
            Model::UNKNOWN => self.unknown.ln(),
            entry if entry >= Model::DOUBTFUL => in_doubt[usize::from(entry - Model::DOUBTFUL)],
            entry => known[usize::from(entry)],
        };
        let greatest = column.iter().map(|entry| factor(*entry)).fold(f64::NEG_INFINITY, f64::max);
        log.iter_mut().zip(column).for_each(|(log, entry)| *log += factor(*entry) - greatest);
        greatest
    }
}

/// Units of a key in a likelihood of 1.
const KEY_UNITS: f64 = 1e9;

/// Evidence of an interaction about attributes with values in doubt: logarithms of the likelihood
/// by value, up to a constant; that of an object that lacks the attribute, if there is one, comes
/// last.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ValueLikelihoods(Vec<(AttributeId, Vec<f64>)>);

impl ValueLikelihoods {
    /// Adds uncertain words; `model` is the one after all earlier words.
    pub(crate) fn hear(&mut self, model: &Model, heard: &[(f64, Question, Reading)]) {
        for k in (0..model.attributes()).map(AttributeId::from) {
            let Some(likelihood) = model.said_of(k, heard) else { continue };
            let at = self.0.iter().position(|(of, _)| *of == k).unwrap_or_else(|| {
                self.0.push((k, vec![0.0; likelihood.len()]));
                self.0.len() - 1
            });
            let sums = &mut self.0[at].1;
            sums.iter_mut().zip(&likelihood).for_each(|(sum, p)| *sum += p.ln());
            let greatest = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            sums.iter_mut().for_each(|sum| *sum -= greatest);
        }
    }

    /// Returns whether all evidence is missing.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Likelihood by value of all words about attribute `k`, relative to the greatest. `None` if
    /// there are none.
    pub fn of(&self, k: AttributeId) -> Option<Vec<f64>> {
        let (_, log) = self.0.iter().find(|(of, _)| *of == k)?;
        Some(log.iter().map(|log| log.exp()).collect())
    }

    /// Appends whole numbers that are equal for evidence that differs by rounding alone.
    pub(crate) fn key_into(&self, key: &mut Vec<i64>) {
        let mut all: Vec<&(AttributeId, Vec<f64>)> = self.0.iter().collect();
        all.sort_by_key(|(k, _)| *k);
        for (k, log) in all {
            key.push(k.index() as i64);
            key.extend(log.iter().map(|log| (log.exp() * KEY_UNITS).round() as i64));
        }
    }

    /// The likelihoods that represent all of one key.
    pub(crate) fn rounded(&self) -> Self {
        let whole = |log: &f64| ((log.exp() * KEY_UNITS).round().max(0.1) / KEY_UNITS).ln();
        let of = |(k, log): &(AttributeId, Vec<f64>)| (*k, log.iter().map(whole).collect());
        let mut all: Vec<(AttributeId, Vec<f64>)> = self.0.iter().map(of).collect();
        all.sort_by_key(|(k, _)| *k);
        Self(all)
    }

    /// The model of objects as the user takes them after this.
    pub fn in_model(&self, model: &Model) -> Model {
        let mut model = model.clone();
        for (k, _) in &self.0 {
            let likelihood = self.of(*k).unwrap_or_default();
            model.weigh_doubts(*k, &likelihood);
        }
        model
    }
}

impl Model {
    /// Whether any value of an object is in doubt.
    pub(crate) fn has_doubts(&self) -> bool {
        (0..self.attributes()).any(|k| self.is_doubtful(k.into()))
    }

    /// The attribute with values in doubt that a word is about, if it is about no other one.
    pub(crate) fn doubtful_attribute(&self, word: WordId) -> Option<AttributeId> {
        match self.meanings(word) {
            [(k, _)] if self.is_doubtful(*k) => Some(*k),
            _ => None,
        }
    }

    /// Appends the probabilities of values in doubt in whole units.
    pub fn doubts_into(&self, key: &mut Vec<i64>) {
        for k in (0..self.attributes()).map(AttributeId::from) {
            let all = self.all_chances(k).iter().flatten();
            key.extend(all.map(|p| (p * KEY_UNITS).round() as i64));
        }
    }

    /// Updates the probabilities of values in doubt by Bayes' rule with uncertain words.
    pub(crate) fn learn(&mut self, heard: &[(f64, Question, Reading)]) {
        for k in (0..self.attributes()).map(AttributeId::from) {
            if let Some(likelihood) = self.said_of(k, heard) {
                self.weigh_doubts(k, &likelihood);
            }
        }
    }

    /// Likelihood by value of all readings about attribute `k`, if one says anything of it; that of
    /// an object that lacks the attribute comes last, if there is one. A reading that says nothing
    /// of it counts as likely as one that does is on average.
    fn said_of(&self, k: AttributeId, heard: &[(f64, Question, Reading)]) -> Option<Vec<f64>> {
        if !self.is_doubtful(k) {
            return None;
        }
        let mut says = false;
        let values = self.values(k);
        let mut likelihood = vec![0.0; values];
        likelihood.extend(self.lacking(k).last().map(|_| 0.0));
        for (weight, question, reading) in heard {
            let evidence = ValueEvidence::of(self, k, *question, reading);
            says |= evidence.is_some();
            let evidence = evidence.unwrap_or_else(|| ValueEvidence::none(values));
            let mean = evidence.by_value.iter().sum::<f64>() / values as f64;
            let all = evidence.by_value.iter().chain([&evidence.lacking]);
            likelihood.iter_mut().zip(all).for_each(|(sum, p)| *sum += weight * p / mean);
        }
        (says && likelihood[..values].iter().any(|p| *p > 0.0)).then_some(likelihood)
    }
}

#[cfg(test)]
mod tests;
