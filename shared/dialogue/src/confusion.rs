//! Probabilities of confusing a scene's words.

use scene::WordId;

/// `κ(u | w)`: if `w` was heard and not said, the probability that `u` was said. A row for each
/// word heard.
#[derive(Clone, Debug, PartialEq)]
pub struct Confusion {
    rows: Vec<Vec<f64>>,
}

/// Reason why numbers are not a confusion model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("row {row} of the confusion model is no distribution over the other words")]
pub struct NotAConfusion {
    /// The word heard.
    pub row: usize,
}

impl Confusion {
    /// Nothing is known: every other word is as likely. A word that has no other may have been any
    /// sound, which says nothing.
    pub fn even(words: usize) -> Self {
        let other = if words > 1 { 1.0 / (words - 1) as f64 } else { 0.0 };
        let row = |w: usize| (0..words).map(|u| if u == w { 0.0 } else { other }).collect();
        Self { rows: (0..words).map(row).collect() }
    }

    /// The model with these rows: by word heard, then by word said.
    ///
    /// # Errors
    /// The first row that does not fit: of another length, with a share of the word itself, or one
    /// that does not sum to 1 (to 0 without another word).
    pub fn from_rows(rows: Vec<Vec<f64>>) -> Result<Self, NotAConfusion> {
        const ROUNDING: f64 = 1e-9;
        let words = rows.len();
        let wanted = if words > 1 { 1.0 } else { 0.0 };
        let fits = |row: usize, shares: &[f64]| {
            shares.len() == words
                && shares.iter().all(|share| (0.0..=1.0).contains(share))
                && shares[row] == 0.0
                && (shares.iter().sum::<f64>() - wanted).abs() < ROUNDING
        };
        match rows.iter().enumerate().position(|(row, shares)| !fits(row, shares)) {
            Some(row) => Err(NotAConfusion { row }),
            None => Ok(Self { rows }),
        }
    }

    /// The model about the first `words` words, or with more, of which nothing is known.
    #[must_use]
    pub(crate) fn resized(mut self, words: usize) -> Self {
        if words == self.rows.len() {
            return self;
        }
        let mut all = Self::even(words);
        self.rows.truncate(words);
        for (row, mut known) in all.rows.iter_mut().zip(self.rows) {
            known.resize(words, 0.0);
            let sum: f64 = known.iter().sum();
            if sum > 0.0 {
                *row = known.into_iter().map(|share| share / sum).collect();
            }
        }
        all
    }

    /// Number of words in the model.
    pub fn words(&self) -> usize {
        self.rows.len()
    }

    /// Words that may have been said if `heard` was heard with this doubt: the word itself with `1
    /// − doubt`, and words mistaken for it.
    pub(crate) fn said_instead(
        &self,
        heard: WordId,
        doubt: f64,
    ) -> impl Iterator<Item = (WordId, f64)> + '_ {
        let shares = self.rows[heard.index()].iter().enumerate();
        let others = shares.map(move |(u, share)| (WordId::from(u), doubt * share));
        std::iter::once((heard, 1.0 - doubt)).chain(others.filter(|(_, share)| *share > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, heard};
    use crate::{Belief, Model, log_likelihood};
    use scene::{Doubt, Question, Reading, Response, Scene};
    use vocabulary::Params;

    fn doubted(scene: &Scene, word: &str, doubt: f64) -> Reading {
        let doubt = Doubt { base: vec![doubt], ..Doubt::default() };
        Reading { doubt, ..heard(scene, &[word], Response::None) }
    }

    fn model(scene: &Scene) -> Model {
        Model::new(scene, Params::default())
    }

    #[test]
    fn a_doubt_of_nearly_nothing_is_nearly_the_plain_word() {
        let scene = bowls();
        let model = model(&scene);
        for word in scene.words() {
            let plain = heard(&scene, &[word], Response::None);
            let plain = log_likelihood(&model, Question::None, &plain);
            let little = log_likelihood(&model, Question::None, &doubted(&scene, word, 1e-12));
            let same = plain.iter().zip(&little).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(same, "{word}: {plain:?} {little:?}");
        }
    }

    /// If all objects have equally many words, the likelihood of all words sums to 1.
    #[test]
    fn doubted_words_are_a_distribution() {
        let scene = bowls();
        let model = model(&scene);
        let mut sums = vec![0.0; scene.objects().len()];
        for word in scene.words() {
            let log = log_likelihood(&model, Question::None, &doubted(&scene, word, 0.3));
            sums.iter_mut().zip(log).for_each(|(sum, log)| *sum += log.exp());
        }
        // The factor of the response, 1/3 without a question, and p_l.
        let expected = model.params().p_l / 3.0;
        assert!(sums.iter().all(|sum| (sum - expected).abs() < 1e-12), "{sums:?}");
    }

    #[test]
    fn the_more_doubt_the_less_a_word_or_an_answer_says() {
        let scene = bowls();
        let model = model(&scene);
        let color = scene.attribute_named("color").unwrap();
        let white = scene.value_named(color, "white").unwrap();
        let asked = Question::Attribute(color, white);
        let entropy = |doubt: f64| {
            let mut by_word = Belief::uniform(6);
            by_word.update(&model, Question::None, &doubted(&scene, "clear", doubt));
            let mut by_answer = Belief::uniform(6);
            let unsure = Doubt { response: doubt, ..Doubt::default() };
            let yes = heard(&scene, &[], Response::Yes);
            by_answer.update(&model, asked, &Reading { doubt: unsure, ..yes });
            let mut by_denial = Belief::uniform(6);
            let word = scene.word_named("clear").unwrap();
            let unsure = Doubt { excluded: vec![doubt], ..Doubt::default() };
            let denied =
                Reading { excluded: vec![vec![word]], doubt: unsure, ..Reading::default() };
            by_denial.update(&model, Question::None, &denied);
            [by_word, by_answer, by_denial]
                .map(|belief| belief.probabilities().iter().map(|p| -p * p.log2()).sum::<f64>())
        };
        let steps: Vec<[f64; 3]> = (0..=10).map(|n| entropy(f64::from(n) / 10.0)).collect();
        for pair in steps.windows(2).take(8) {
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a < b), "{pair:?}");
        }
        assert!((steps[10][1] - 6.0_f64.log2()).abs() < 1e-12, "a full doubt says nothing");
    }

    #[test]
    fn a_doubted_word_points_at_what_sounds_like_it() {
        let scene = bowls();
        let (metal, plastic) =
            (scene.word_named("metal").unwrap(), scene.word_named("plastic").unwrap());
        let words = scene.words().len();
        let mut rows: Vec<Vec<f64>> = Confusion::even(words).rows;
        rows[metal.index()] = vec![0.0; words];
        rows[metal.index()][plastic.index()] = 1.0;
        let confused = model(&scene).with_confusion(Confusion::from_rows(rows).unwrap());
        let log = log_likelihood(&confused, Question::None, &doubted(&scene, "metal", 0.9));
        let material = scene.attribute_named("material").unwrap();
        let is = |i: usize, word| {
            scene.objects()[i].values[material.index()].is_some_and(|v| {
                scene.attributes()[material.index()].values[v.index()].word == word
            })
        };
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            assert!(!(is(i, plastic) && is(j, metal)) || log[i] > log[j], "{i} {j} {log:?}");
        }
    }

    #[test]
    fn what_is_no_confusion_model_is_refused() {
        let even = Confusion::even(4);
        assert_eq!(Confusion::from_rows(even.rows.clone()), Ok(even.clone()));
        assert_eq!(Confusion::from_rows(vec![vec![0.0]]), Ok(Confusion::even(1)));
        for (row, column, value) in [(1, 1, 0.1), (2, 0, 0.9), (3, 0, f64::NAN), (0, 1, -0.1)] {
            let mut rows = even.rows.clone();
            rows[row][column] = value;
            assert_eq!(Confusion::from_rows(rows), Err(NotAConfusion { row }));
        }
    }
}
